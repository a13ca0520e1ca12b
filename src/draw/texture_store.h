/* texture_store.h - decoded images of a scene with their mips, kept from one render to the next.
 *
 * A texel must not depend on what other renders wanted: a decoder that reduces (JPEG) does not give the
 * same texels as averaging the whole image. So an image is kept once for each requested reduction, each a
 * quarter as large as the one before. */
#ifndef DRAW_TEXTURE_STORE_H
#define DRAW_TEXTURE_STORE_H

#include "draw/texture_pyramid.h"
#include "scene/scene.h"

typedef struct texture_store texture_store;

/* An image that a render reads. */
typedef struct texture_want {
    uint32_t image;       /* each once */
    bool is_read[2];      /* as data, as color */
    float min_lod;        /* finest mip that will be read; negative or 0: all */
    uint32_t first_level; /* result: min_lod as a level */
    /* result: has first_level, and maybe finer levels; NULL: reads as white */
    const texture_pyramid *pyramid[2];
} texture_want;

/* Moves those of image_count wants, one per image, that are read to the front and sets their images;
 * returns their number. */
size_t texture_wants_compact(texture_want *wants, size_t image_count);

/* Fails with FACET_ERROR_MEMORY. scene outlives the store. */
facet_result texture_store_create(const facet_scene *scene, const facet_allocator *allocator,
                                  texture_store **out, facet_error *error);
void texture_store_destroy(texture_store *store); /* NULL is allowed */
/* Answers wants, and decodes what is missing, in parallel. Pyramids stay until the next call. An image
 * that cannot be decoded is a warning to log, once. Adds to *decoded_texels. Fails with FACET_ERROR_LIMIT
 * (an image larger than scene->max_texture_size), FACET_ERROR_MEMORY: the store keeps what it had. */
facet_result texture_store_get(texture_store *store, texture_want *wants, size_t count, const facet_log *log,
                               uint32_t thread_count, uint64_t *decoded_texels, facet_error *error);

#endif
