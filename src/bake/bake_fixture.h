/* bake_fixture.h - for tests: environments of formulas, baked cube maps, their texels. Include after
 * cmocka.h. */
#ifndef BAKE_BAKE_FIXTURE_H
#define BAKE_BAKE_FIXTURE_H

#include <math.h>

#include "bake/bake.h"
#include "tests/support/support.h"
#include "ibl/light_fixture.h"

/* Rings take harmonics of a high degree, seconds where nothing is optimised: the tests of rings are enough
 * there. */
static inline bool is_slow_ring(int lobe, int method)
{
    return IS_SLOW && lobe == FACET_LOBE_CHARLIE && method == FACET_BAKE_METHOD_AUTO;
}

static inline facet_cube *bake(facet_environment *e, facet_bake_desc desc)
{
    facet_cube *c = NULL;
    facet_error error = {0};
    facet_result result = facet_cube_bake(e, &desc, &c, &error);
    if (result != FACET_OK)
        print_error("%s\n", error.message);
    assert_int_equal(result, FACET_OK);
    return c;
}

/* Unit direction of texel number i of a level, counted face by face, row by row. */
static inline void texel_direction(const cube *level, uint32_t i, double d[3])
{
    uint32_t n = level->size;
    cube_direction(i / n / n, (2.0 * (i % n) + 1.0) / n - 1.0, (2.0 * (i / n % n) + 1.0) / n - 1.0, d);
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int k = 0; k < 3; k++)
        d[k] /= length;
}

static inline const float *texel_of(const cube *level, uint32_t i)
{
    uint32_t n = level->size;
    return (const float *)cube_texel(level, i / n / n, (int)(i % n), (int)(i / n % n));
}

static inline uint32_t texel_count(const cube *level)
{
    return 6 * level->size * level->size;
}

#endif
