/* sky_gradient.c - an environment of three colors. */
#include <assert.h>
#include <math.h>

#include "base/result.h"
#include "ibl/environment.h"

enum { WIDTH = 2, HEIGHT = 512 };

/* Mean over a row of the ramp between two heights d.y, from low to high color. */
static void add_ramp(const float low[3], const float high[3], double from, double to, double share,
                     double sum[3])
{
    double t = 0.5 * (from + to);
    for (int i = 0; i < 3; i++)
        sum[i] += share * ((double)low[i] + ((double)high[i] - (double)low[i]) * t);
}

facet_result facet_environment_create_gradient(const float zenith[3], const float horizon[3],
                                               const float nadir[3], const facet_environment_desc *desc,
                                               facet_environment **environment, facet_error *error)
{
    assert(zenith && horizon && nadir && environment);
    static const facet_environment_desc default_desc;
    *environment = NULL;
    desc = desc ? desc : &default_desc;
    facet_environment *e = NULL;
    facet_result result = environment_create(desc, &e, error);
    if (result != FACET_OK)
        return result;
    result = image_create(&e->allocator, WIDTH, HEIGHT, 3, IMAGE_F32, &e->picture, error);
    if (result != FACET_OK) {
        environment_release(e);
        return result;
    }
    float *p = e->picture.pixels;
    for (int y = 0; y < HEIGHT;
         y++) { /* equal heights have equal solid angles, so that the mean over a row is linear in them */
        double top = cos(3.14159265358979323846 * y / HEIGHT);
        double bottom = cos(3.14159265358979323846 * (y + 1) / HEIGHT);
        double sum[3] = {0.0, 0.0, 0.0};
        if (2 * y < HEIGHT)
            add_ramp(horizon, zenith, bottom, top, 1.0, sum);
        else
            add_ramp(horizon, nadir, -top, -bottom, 1.0, sum);
        for (int i = 0; i < 3 * WIDTH; i++)
            p[3 * WIDTH * y + i] = (float)sum[i % 3];
    }
    environment_limit(e, desc->thread_count);
    environment_identify(e, e->picture.pixels, e->picture.height * image_row_size(&e->picture));
    *environment = e;
    return FACET_OK;
}
