/* bake_ktx1.c - cube maps as KTX 1 files with harmonics, for Filament. */
#include "bake/bake.h"

#include "base/result.h"
#include "base/text.h"
#include "image/ktx1_write.h"

static const facet_ktx1_desc default_desc;

/* As cmgen writes them, a line for each. */
static void add_harmonics(text *t, const float (*c)[3])
{
    for (int i = 0; i < 9; i++) {
        char digits[3][TEXT_FLOAT_SIZE];
        for (int k = 0; k < 3; k++)
            text_shortest_float(c[i][k], digits[k]);
        text_addf(t, "%s %s %s\n", digits[0], digits[1], digits[2]);
    }
}

facet_result facet_cube_encode_ktx1(const facet_cube *c, const facet_ktx1_desc *desc, unsigned char **bytes,
                                    size_t *size, facet_error *error)
{
    facet_image_view faces[FACET_CUBE_MAX_LEVELS * 6];
    *bytes = NULL;
    *size = 0;
    desc = desc ? desc : &default_desc;
    for (uint32_t i = 0; i < 6 * c->level_count; i++)
        faces[i] = facet_cube_get_face(c, i / 6, i % 6);
    text harmonics = {.allocator = desc->allocator};
    if (desc->harmonics)
        add_harmonics(&harmonics, desc->harmonics);
    facet_result result = FACET_OK;
    if (harmonics.has_failed)
        result = fail_memory(error, "harmonics", 9 * 3 * TEXT_FLOAT_SIZE);
    if (result == FACET_OK)
        result = ktx1_write_cube(&(ktx1_write_desc){.allocator = desc->allocator,
                                                    .thread_count = desc->thread_count,
                                                    .level_count = c->level_count,
                                                    .pictures = faces,
                                                    .key = desc->harmonics ? "sh" : NULL,
                                                    .value = harmonics.data},
                                 bytes, size, error);
    text_destroy(&harmonics);
    return result;
}
