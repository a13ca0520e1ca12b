/* water_exposure.c - see water_exposure.h. */
#include "water/water_exposure.h"

#include <math.h>

#include "base/result.h"
#include "film/meter.h"
#include "water/water_render.h"

static const double DARKEST = 1e-3; /* cd/m^2 */
enum { METER_SIZE = 64 };           /* pixels along the longer edge */

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
    r->renderer = FACET_RENDERER_KIND_PREVIEW;
    r->exposure_ev = 0.0f;
    r->progress = (facet_progress){0};
    d.shading = (facet_sea_shading){.omits_glints = true};
    return d;
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
        double L = film_log_average(&f, 1e-6);
        if (L < DARKEST)
            log_warning(
                &d.render.log,
                "sea: there is hardly any light, and the picture dark: say what the exposure is to be");
        *ev100 = meter_ev100(fmax(L, DARKEST));
    }
    film_destroy(&f);
    return result;
}
