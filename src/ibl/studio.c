/* studio.c - environments that are computed from a few numbers: the built-in studio of mean radiance 1
 * cd/m^2, uniform ones, gradients. */
#include "ibl/studio_draw.h"

#include <assert.h>
#include <math.h>

#include "base/result.h"
#include "ibl/cache.h"
#include "ibl/environment.h"

/* ---- the functions of facet.h ---- */

static const facet_environment_desc default_desc;

facet_result facet_environment_create_studio(const facet_environment_desc *desc,
                                             facet_environment **environment, facet_error *error)
{
    assert(environment);
    *environment = NULL;
    desc = desc ? desc : &default_desc;
    facet_environment *e = NULL;
    TRY(environment_create(desc, &e, error));
    facet_result result = studio_draw(&e->allocator, desc->thread_count, &e->panorama, error);
    e->is_studio = true;
    return cache_finish(result, e, environment);
}

static facet_result check_radiance(const float radiance[3], facet_error *error)
{
    for (int i = 0; i < 3; i++)
        if (!(radiance[i] >= 0.0f && isfinite(radiance[i])))
            return fail(error, FACET_ERROR_ARGUMENT,
                        "environment: a radiance of %g; finite and at least 0 was expected",
                        (double)radiance[i]);
    return FACET_OK;
}

facet_result facet_environment_create_constant(const float radiance[3], const facet_environment_desc *desc,
                                               facet_environment **environment, facet_error *error)
{
    assert(radiance && environment);
    *environment = NULL;
    TRY(check_radiance(radiance, error));
    desc = desc ? desc : &default_desc;
    facet_environment *e = NULL;
    TRY(environment_create(desc, &e, error));
    facet_result result = image_create(&e->allocator, 2, 1, 3, IMAGE_F32, &e->panorama, error);
    if (result != FACET_OK) {
        environment_release(e);
        return result;
    }
    float *p = e->panorama.pixels;
    for (int i = 0; i < 6; i++)
        p[i] = radiance[i % 3];
    environment_limit(e, 1);
    cache_identify(e, e->panorama.pixels, image_row_size(&e->panorama));
    *environment = e;
    return FACET_OK;
}

enum { GRADIENT_WIDTH = 2, GRADIENT_HEIGHT = 512 };

facet_result facet_environment_create_gradient(const float zenith[3], const float horizon[3],
                                               const float nadir[3], const facet_environment_desc *desc,
                                               facet_environment **environment, facet_error *error)
{
    assert(zenith && horizon && nadir && environment);
    *environment = NULL;
    TRY(check_radiance(zenith, error));
    TRY(check_radiance(horizon, error));
    TRY(check_radiance(nadir, error));
    desc = desc ? desc : &default_desc;
    facet_environment *e = NULL;
    TRY(environment_create(desc, &e, error));
    facet_result result =
        image_create(&e->allocator, GRADIENT_WIDTH, GRADIENT_HEIGHT, 3, IMAGE_F32, &e->panorama, error);
    if (result != FACET_OK) {
        environment_release(e);
        return result;
    }
    float *p = e->panorama.pixels;
    for (int y = 0; y < GRADIENT_HEIGHT; y++) {
        /* radiance is linear in d.y, which is uniform in area: a row's mean is the value at its middle */
        double top = cos(3.14159265358979323846 * y / GRADIENT_HEIGHT);
        double bottom = cos(3.14159265358979323846 * (y + 1) / GRADIENT_HEIGHT);
        double height = 0.5 * (top + bottom);
        const float *end = height > 0.0 ? zenith : nadir;
        for (int i = 0; i < 3 * GRADIENT_WIDTH; i++)
            p[3 * GRADIENT_WIDTH * y + i] =
                (float)((double)horizon[i % 3] +
                        ((double)end[i % 3] - (double)horizon[i % 3]) * fabs(height));
    }
    environment_limit(e, desc->thread_count);
    return cache_finish(FACET_OK, e, environment);
}
