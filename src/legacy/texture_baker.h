/* texture_baker.h - reads and bakes textures for conversions: statistics of images, texels of one size,
 * bakes of rows in parallel, and the resulting PNG files, each made once. The caller defines what the
 * values mean. */
#ifndef LEGACY_TEXTURE_BAKER_H
#define LEGACY_TEXTURE_BAKER_H

#include "image/srgb.h"
#include "scene/scene.h"

/* Histograms of 8-bit codes. */
enum { TEXTURE_RED, TEXTURE_GREEN, TEXTURE_BLUE, TEXTURE_ALPHA, TEXTURE_GREY, TEXTURE_CHANNELS };
typedef struct texture_statistics {
    bool is_readable;
    bool has_alpha; /* a texel is not opaque */
    uint32_t width, height;
    uint32_t texel_count;
    uint32_t histogram[TEXTURE_CHANNELS][256]; /* TEXTURE_GREY: texture_grey() */
} texture_statistics;

/* The grey of a texel as in rgl: the mean of red, green and blue. */
static inline uint8_t texture_grey(const uint8_t *texel)
{
    return (uint8_t)((texel[0] + texel[1] + texel[2] + 1) / 3);
}

double texture_mean(const texture_statistics *s, int channel,
                    const float values[256]);                                      /* mean of values[code] */
int texture_percentile(const texture_statistics *s, int channel, double fraction); /* a code */

typedef struct texture_baker texture_baker;
facet_result texture_baker_create(facet_scene *scene, texture_baker **out, facet_error *error);
void texture_baker_destroy(texture_baker *baker); /* NULL is allowed */

const srgb_tables *texture_baker_srgb(const texture_baker *baker);

/* Reads all images of the marked textures (one flag per texture of the scene), several at once; large JPEG
 * files at an eighth of their size. An image that cannot be read is a warning; fails with
 * FACET_ERROR_MEMORY, and with _LIMIT if one exceeds the size limit of the scene. */
facet_result texture_baker_survey(texture_baker *baker, const bool *is_wanted, const facet_log *log,
                                  facet_error *error);
/* NULL: the texture was not surveyed, or its image cannot be read. */
const texture_statistics *texture_baker_statistics(const texture_baker *baker, uint32_t texture);

/* One row of a bake. in: RGBA texels of each input, as wide as the bake; NULL where the input is
 * SCENE_NONE. out: channel_count values per texel. */
typedef void texture_row(const void *parameters, uint32_t width, const uint8_t *const *in, uint8_t *out);

enum { TEXTURE_INPUTS = 4 };
typedef struct texture_bake {
    const char *name; /* of the resulting image */
    /* textures; SCENE_NONE: none. At least one; wrapped as their samplers say */
    uint32_t inputs[TEXTURE_INPUTS];
    uint32_t input_count;
    uint32_t channel_count; /* 1, 3 or 4 */
    texture_row *row;
    const void *parameters; /* without undefined padding and without pointers to what may move */
    size_t parameter_size;
} texture_bake;

/* Makes a texture of the size of the largest input with the sampler of the first, or finds an equal one.
 * *texture: its index in the scene after texture_baker_finish(); SCENE_NONE: an input cannot be decoded.
 * Fails with FACET_ERROR_MEMORY. */
facet_result texture_baker_bake(texture_baker *baker, const texture_bake *bake, uint32_t *texture,
                                facet_error *error);

/* A normal map of the heights in a texture. weights: of red, green, blue, alpha, whose sum is the height
 * in [0, 1]; slope: rise of the whole range over the width of the image. 16-bit heights keep their
 * precision. */
typedef struct texture_relief {
    const char *name;
    uint32_t texture;
    float weights[4];
    float base, gain; /* height = base + gain value */
    float slope;
} texture_relief;
facet_result texture_baker_relief(texture_baker *baker, const texture_relief *relief, uint32_t *texture,
                                  facet_error *error);

/* Appends the new images and textures to the scene. Fails with FACET_ERROR_MEMORY; the scene is then
 * unchanged. */
facet_result texture_baker_finish(texture_baker *baker, facet_error *error);

/* The number of new textures, and of requests that found an equal one. */
uint32_t texture_baker_made(const texture_baker *baker);
uint32_t texture_baker_shared(const texture_baker *baker);

#endif
