/* texture_texels.h - images of a scene as RGBA texels of 8 bits, decoded on demand, a few of them cached. */
#ifndef LEGACY_TEXTURE_TEXELS_H
#define LEGACY_TEXTURE_TEXELS_H

#include "image/image.h"
#include "legacy/texture_baker.h"

/* Decodes an image of the scene with its own type and channel count. Fails as image_decode() does. */
facet_result texels_decode_raw(const facet_scene *scene, uint32_t index, uint32_t max_reduction,
                               uint32_t thread_count, struct image *out, facet_error *error);

/* RGBA of 8 bits in another size: bilinear, wrapping as the texture does. */
facet_result texels_resize(const struct image *in, const scene_texture *texture, uint32_t width,
                           uint32_t height, uint32_t thread_count, const facet_allocator *allocator,
                           struct image *out, facet_error *error);

/* Counts the codes of an image as RGBA of 8 bits (texels_cache_get()), without decoding it whole where its
 * codec can do that. out is {0} on failure. */
facet_result texels_count(const facet_scene *scene, uint32_t image, uint32_t max_reduction,
                          uint32_t thread_count, texture_statistics *out, facet_error *error);

/* A cache of the last used decoded images, limited in bytes. */
typedef struct texels_cache texels_cache;
texels_cache *texels_cache_create(const facet_scene *scene); /* NULL: out of memory */
void texels_cache_destroy(texels_cache *cache);
/* RGBA of 8 bits: codes as in the file, floats sRGB-encoded. Valid until four others were requested. */
facet_result texels_cache_get(texels_cache *cache, uint32_t image, const struct image **out,
                              facet_error *error);

#endif
