/* water_exposure.c - see water_exposure.h. */
#include "water/water_exposure.h"

#include <math.h>

#include "base/result.h"
#include "film/film.h"
#include "water/water_render.h"

static const double KEY = 0.22, SATURATION = 1.2, DARKEST = 1e-3; /* cd/m^2 */
enum { METER_SIZE = 64 };                                         /* pixels along the longer edge */

/* The same view, small. */
static facet_sea_render_desc meter_desc(const facet_sea_render_desc *desc)
{
    facet_sea_render_desc d = *desc;
    facet_render_desc *r = &d.render;
    double longer = r->width > r->height ? r->width : r->height;
    r->width = (uint32_t)ceil(METER_SIZE * r->width / longer);
    r->height = (uint32_t)ceil(METER_SIZE * r->height / longer);
    r->crop[0] = r->crop[1] = 0;
    r->crop[2] = r->width;
    r->crop[3] = r->height;
    r->samples = 1;
    r->quality = FACET_QUALITY_DRAFT;
    r->integrator = FACET_INTEGRATOR_PREVIEW;
    r->exposure_ev = 0.0f;
    r->progress = (facet_progress){0};
    d.look = (facet_sea_look){.no_glints = true};
    return d;
}

static double log_average(film *f)
{
    const float *p = film_find(f, "")->pixels;
    size_t count = (size_t)f->width * f->height;
    double sum = 0.0;
    for (size_t i = 0; i < count; i++, p += 4) {
        double L = 0.2126 * (double)p[0] + 0.7152 * (double)p[1] + 0.0722 * (double)p[2];
        sum += log(fmax(L, 1e-6));
    }
    return exp(sum / (double)count);
}

facet_result water_exposure_ev100(const facet_sea *sea, const facet_sea_render_desc *desc, double *ev100,
                                  facet_error *error)
{
    const facet_sea_render_desc d = meter_desc(desc);
    facet_render_stats stats;
    film f = {0};
    *ev100 = 0.0;
    facet_result result = film_create(&d.render.allocator, d.render.width, d.render.height, 0, &f, error);
    if (result == FACET_OK)
        result = water_render(sea, NULL, &d, &f, &stats, error);
    if (result == FACET_OK) {
        double L = log_average(&f);
        if (L < DARKEST)
            log_warning(
                &d.render.log,
                "sea: there is hardly any light, and the picture dark: say what the exposure is to be");
        *ev100 = log2(fmax(L, DARKEST) / (SATURATION * KEY));
    }
    film_destroy(&f);
    return result;
}

double water_exposure_ev(double ev100)
{
    return -ev100 - log2(SATURATION);
}
