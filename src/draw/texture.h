/* texture.h - textures of a scene, decoded at the resolution an image needs, and sampled with filtering. */
#ifndef DRAW_TEXTURE_H
#define DRAW_TEXTURE_H

#include "scene/scene.h"

/* How one texture will be read by a render. */
typedef struct texture_use {
    bool is_read_as_color; /* decoded from sRGB (base color, emissive, specular color) */
    bool is_read_as_data;  /* linear; both may be set: the texture is then kept twice */
    /* finest mip level that will be read, in levels of the full image; finer ones need not be decoded.
     * Negative or 0: all */
    float min_lod;
} texture_use;

typedef struct texture_set texture_set;

/* Decodes, in parallel, the images of those scene->textures that uses[i] marks as read, and builds their
 * mips: colors averaged in linear light (alpha not premultiplied, as in other viewers). An image that
 * cannot be decoded is a warning to log and reads as white. Fails with FACET_ERROR_LIMIT (an image larger
 * than scene->max_texture_size), _MEMORY. */
facet_result texture_set_create(const facet_scene *scene, const texture_use *uses,
                                const facet_allocator *allocator, const facet_log *log, uint32_t thread_count,
                                texture_set **out, facet_error *error);
void texture_set_destroy(texture_set *set); /* NULL is allowed */
uint64_t texture_set_decoded_texels(const texture_set *set);

/* Width and height of the full image of a texture; false: it reads as white. Needs no texture_set: reads the
 * file's header. */
bool texture_full_size(const facet_scene *scene, uint32_t texture, float size[2]);

/* One texture to be sampled; texture may be any number. */
typedef struct texture_request {
    uint32_t texture;
    bool as_color;
    float texel[4]; /* the result: RGBA, color linear; white where there is no such texture */
} texture_request;

enum { TEXTURE_GROUP = 8 };

/* Samples up to TEXTURE_GROUP textures at uv with the derivatives of uv along the pixel's x and y (per
 * pixel). Wrap, magnification, minification and mip filter are the sampler's; trilinear minification is
 * anisotropic, up to 16 probes along the longer axis. Textures of one size and sampler cost little more
 * than one of them. */
void texture_sample_group(const texture_set *set, texture_request *requests, uint32_t count,
                          const float uv[2], const float duv_dx[2], const float duv_dy[2]);
/* The same for one texture. */
void texture_sample(const texture_set *set, uint32_t index, bool as_color, const float uv[2],
                    const float duv_dx[2], const float duv_dy[2], float out[4]);

#endif
