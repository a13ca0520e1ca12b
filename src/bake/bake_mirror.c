/* bake_mirror.c - cube maps seen in a mirror across the plane x = 0. */
#include "bake/bake.h"

#include <string.h>

#include "base/memory.h"
#include "base/result.h"

static const facet_allocator default_allocator;

/* (1, -t, -s) becomes (-1, -t, -s), which is position (-s, t) of -X; of the others s changes its sign, too. */
static void mirror_level(const cube *from, cube *to)
{
    static const uint32_t others[6] = {1, 0, 2, 3, 4, 5};
    const int n = (int)from->size;
    for (uint32_t face = 0; face < 6; face++)
        for (int y = -1; y <= n; y++) /* the borders with it */
            for (int x = -1; x <= n; x++)
                *cube_texel(to, others[face], n - 1 - x, y) = *cube_texel(from, face, x, y);
}

facet_result facet_cube_create_mirrored(const facet_cube *c, const facet_allocator *allocator,
                                        facet_cube **out, facet_error *error)
{
    allocator = allocator ? allocator : &default_allocator;
    *out = NULL;
    facet_cube *mirrored = mem_alloc(allocator, 1, sizeof *mirrored);
    if (!mirrored)
        return fail_memory(error, "cube map", sizeof *mirrored);
    *mirrored = *c;
    mirrored->allocator = *allocator;
    memset(mirrored->levels, 0, sizeof mirrored->levels);
    for (uint32_t level = 0; level < c->level_count; level++) {
        facet_result result = cube_create(c->levels[level].size, allocator, &mirrored->levels[level], error);
        if (result != FACET_OK) {
            facet_cube_destroy(mirrored);
            return result;
        }
        mirror_level(&c->levels[level], &mirrored->levels[level]);
    }
    *out = mirrored;
    return FACET_OK;
}
