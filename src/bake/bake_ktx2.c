/* bake_ktx2.c - cube maps and tables as KTX2 files. */
#include "bake/bake.h"

#include "image/ktx2_write.h"

#define WRITER "facet " FACET_VERSION

static const facet_ktx2_desc default_desc;

static ktx2_write_desc make_desc(const facet_ktx2_desc *desc)
{
    return (ktx2_write_desc){.allocator = desc->allocator,
                             .thread_count = desc->thread_count,
                             .format = desc->format,
                             .zstd_level = desc->zstd_level,
                             .writer = WRITER};
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
    d.pictures = faces;
    d.is_opaque = true; /* the lane behind RGB is undefined */
    return ktx2_write(&d, bytes, size, error);
}

facet_result bake_image_ktx2(const image *picture, const facet_ktx2_desc *desc, unsigned char **bytes,
                             size_t *size, facet_error *error)
{
    const facet_image_view view = {.name = "",
                                   .width = picture->width,
                                   .height = picture->height,
                                   .channel_count = picture->channel_count,
                                   .pixels = picture->pixels,
                                   .row_stride_bytes = image_row_size(picture)};
    ktx2_write_desc d = make_desc(desc ? desc : &default_desc);
    d.level_count = 1;
    d.face_count = 1;
    d.pictures = &view;
    return ktx2_write(&d, bytes, size, error);
}
