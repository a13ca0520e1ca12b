/* sky_gradient.c - an environment of three colors. */
#include <assert.h>
#include <math.h>

#include "base/result.h"
#include "ibl/environment.h"

enum { WIDTH = 2, HEIGHT = 512 };

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
    for (int y = 0; y < HEIGHT; y++) {
        /* equal steps of d.y hold equal parts of the sphere: a row's mean is its middle's */
        double top = cos(3.14159265358979323846 * y / HEIGHT);
        double bottom = cos(3.14159265358979323846 * (y + 1) / HEIGHT);
        double height = 0.5 * (top + bottom);
        const float *end = height > 0.0 ? zenith : nadir;
        for (int i = 0; i < 3 * WIDTH; i++)
            p[3 * WIDTH * y + i] = (float)((double)horizon[i % 3] +
                                           ((double)end[i % 3] - (double)horizon[i % 3]) * fabs(height));
    }
    environment_limit(e, desc->thread_count);
    environment_identify(e, e->picture.pixels, e->picture.height * image_row_size(&e->picture));
    *environment = e;
    return FACET_OK;
}
