/* texture_bench.h - where textures are looked at, and made anew, while materials are converted: statistics of a scene's
 * images, texels of one size, bakes row by row in parallel, and the PNG files that come out, each made once. What the
 * numbers in a texel mean is the caller's affair. */
#ifndef LEGACY_TEXTURE_BENCH_H
#define LEGACY_TEXTURE_BENCH_H

#include "image/srgb.h"
#include "scene/scene.h"

/* Codes of 8 bits, counted. */
enum { TEXTURE_RED, TEXTURE_GREEN, TEXTURE_BLUE, TEXTURE_ALPHA, TEXTURE_GREY, TEXTURE_CHANNELS };
typedef struct texture_statistics {
    bool is_readable;
    bool has_alpha; /* some texel is not opaque */
    uint32_t width, height;
    uint32_t texel_count;
    uint32_t histogram[TEXTURE_CHANNELS][256]; /* TEXTURE_GREY: texture_grey() */
} texture_statistics;

/* The grey of a texel as rgl has it: the mean of red, green and blue. */
static inline uint8_t texture_grey(const uint8_t *texel)
{
    return (uint8_t)((texel[0] + texel[1] + texel[2] + 1) / 3);
}

double texture_mean(const texture_statistics *s, int channel,
                    const float values[256]);                                      /* of values by code */
int texture_percentile(const texture_statistics *s, int channel, double fraction); /* a code */
bool texture_is_two_valued(const texture_statistics *s, int channel);              /* only 0 and 255 */
int texture_highest(const texture_statistics *s, int channel);                     /* codes */
int texture_lowest(const texture_statistics *s, int channel);

typedef struct texture_bench texture_bench;
facet_result texture_bench_create(facet_scene *scene, texture_bench **out, facet_error *error);
void texture_bench_destroy(texture_bench *bench); /* NULL is allowed */

const srgb_tables *texture_bench_srgb(const texture_bench *bench);

/* Looks at all images of the textures that are marked (one flag per texture of the scene), several at once. Large JPEG
 * files are looked at in an eighth of their size. An image that cannot be read is a warning; fails with
 * FACET_ERROR_MEMORY, and with _LIMIT where one is larger than the scene may have. */
facet_result texture_bench_survey(texture_bench *bench, const bool *is_wanted, const facet_log *log,
                                  facet_error *error);
/* NULL: the texture was not surveyed, or its image cannot be read. */
const texture_statistics *texture_bench_statistics(const texture_bench *bench, uint32_t texture);

/* One row of a bake. in: RGBA texels of each input, all of the bake's width; NULL where the input is SCENE_NONE. out:
 * channel_count per texel. */
typedef void texture_row(const void *parameters, uint32_t width, const uint8_t *const *in, uint8_t *out);

enum { TEXTURE_INPUTS = 4 };
typedef struct texture_bake {
    const char *name; /* of the image that comes out */
    /* textures; SCENE_NONE: none. At least one; sampled as their images repeat */
    uint32_t inputs[TEXTURE_INPUTS];
    uint32_t input_count;
    uint32_t channel_count; /* 1, 3 or 4 */
    texture_row *row;
    const void *parameters; /* without padding that is undefined, without pointers to what may move */
    size_t parameter_size;
} texture_bake;

/* Makes a texture of the size of the largest input and with the sampler of the first, or finds the one that was made of
 * the same. *texture: its index in the scene as texture_bench_finish() leaves it; SCENE_NONE: an input cannot be
 * decoded. Fails with FACET_ERROR_MEMORY. */
facet_result texture_bench_bake(texture_bench *bench, const texture_bake *bake, uint32_t *texture,
                                facet_error *error);

/* A normal map of the heights in a texture. weights: of red, green, blue, alpha, whose sum is the height [0, 1];
 * slope: rise of the whole range over the width of the picture. Heights of 16 bits are read as such. */
typedef struct texture_relief {
    const char *name;
    uint32_t texture;
    float weights[4];
    float base, gain; /* height = base + gain value */
    float slope;
} texture_relief;
facet_result texture_bench_relief(texture_bench *bench, const texture_relief *relief, uint32_t *texture,
                                  facet_error *error);

/* Appends what was made to the scene's images and textures. Fails with FACET_ERROR_MEMORY; the scene is as it was. */
facet_result texture_bench_finish(texture_bench *bench, facet_error *error);

/* How many were made, and how many were asked for and there already. */
uint32_t texture_bench_made(const texture_bench *bench);
uint32_t texture_bench_shared(const texture_bench *bench);

#endif
