/* bake_ktx.c - cube maps and LUTs as KTX 2 files, and cube maps with harmonics as KTX 1 files for Filament. */
#include "bake/bake.h"

#include "base/result.h"
#include "base/text.h"
#include "image/ktx_write.h"

static const facet_ktx2_desc default_desc;

static ktx2_write_desc make_desc(const facet_ktx2_desc *desc)
{
    return (ktx2_write_desc){.allocator = desc->allocator,
                             .thread_count = desc->thread_count,
                             .format = desc->format,
                             .zstd_level = desc->zstd_level,
                             .writer = "facet " FACET_VERSION};
}

facet_result facet_cube_encode_ktx2(const facet_cube *c, const facet_ktx2_desc *desc, unsigned char **bytes,
                                    size_t *size, facet_error *error)
{
    facet_image_view faces[FACET_CUBE_MAX_LEVELS * 6];
    for (uint32_t i = 0; i < 6 * c->level_count; i++)
        faces[i] = facet_cube_get_face(c, i / 6, i % 6);
    ktx2_write_desc d = make_desc(desc ? desc : &default_desc);
    d.level_count = c->level_count;
    d.face_count = 6;
    d.images = faces;
    d.is_opaque = true; /* the fourth lane is undefined */
    return ktx2_write(&d, bytes, size, error);
}

facet_result bake_image_ktx2(const image *panorama, const facet_ktx2_desc *desc, unsigned char **bytes,
                             size_t *size, facet_error *error)
{
    const facet_image_view view = {.name = "",
                                   .width = panorama->width,
                                   .height = panorama->height,
                                   .channel_count = panorama->channel_count,
                                   .pixels = panorama->pixels,
                                   .row_stride_bytes = image_row_size(panorama)};
    ktx2_write_desc d = make_desc(desc ? desc : &default_desc);
    d.level_count = 1;
    d.face_count = 1;
    d.images = &view;
    return ktx2_write(&d, bytes, size, error);
}

/* ---- KTX 1 ---- */

static const facet_ktx1_desc default_ktx1_desc;

/* In the format of cmgen, a line for each coefficient. */
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
    desc = desc ? desc : &default_ktx1_desc;
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
                                                    .images = faces,
                                                    .key = desc->harmonics ? "sh" : NULL,
                                                    .value = harmonics.data},
                                 bytes, size, error);
    text_destroy(&harmonics);
    return result;
}
