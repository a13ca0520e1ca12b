/* model_image.h - small images of real models for tests of materials, codecs or animations. Models come from the
 * folder FACET_TEST_DATA; functions abort the test on failure. */
#ifndef TESTS_MODEL_IMAGE_H
#define TESTS_MODEL_IMAGE_H

#include "facet/facet.h"

/* Prints a line and returns NULL without test data; the caller skips. path: below models/. */
facet_scene *model_load(const char *path);
/* The same model with text in its JSON replaced everywhere; a .glb. The test fails if the text is missing. */
facet_scene *model_load_edited(const char *path, const char *text, const char *by);

/* The bytes of a model, for free(); NULL as above. */
unsigned char *model_read(const char *path, size_t *size);

/* An orthographic view along -Z: equal objects at different places look equal. */
typedef struct view {
    float x, y, height; /* center and height of the image, m; height 0: the default orbit */
    float back;         /* m from z = 0 to the eye; 0: 10 */
} view;

/* Linear RGBA, premultiplied, and the material of the nearest surface, -1 for none. */
typedef struct model_image {
    uint32_t width, height, count; /* count: of pixels */
    float *rgba;
    int *material;
} model_image;

/* 64 x 64 pixels unless desc (NULL: {0}) has a size. Without an environment in desc: the studio. */
model_image model_image_render(const facet_scene *scene, const view *v, const facet_render_desc *desc);
/* The sphere of radius 0.5 at (x, 0, 0) of a model; text: replacements in the model's JSON, NULL: none. An
 * image without pixels without test data. */
model_image model_image_of_sphere(const char *path, float x, const facet_render_desc *desc, const char *text,
                                  const char *by);
void model_image_destroy(model_image *p);

/* Rec.709 luminance of a pixel; its chroma: largest minus smallest channel. */
double model_image_luminance(const model_image *p, uint32_t i);
double model_image_chroma(const model_image *p, uint32_t i);

/* Statistics over the pixels of a material (-1: any): number, means, quantile (0 to 1) of luminance. */
uint32_t model_image_pixels(const model_image *p, int material);
double model_image_mean(const model_image *p, int material, int channel);
double model_image_mean_luminance(const model_image *p, int material);
double model_image_mean_chroma(const model_image *p, int material);
double model_image_percentile(const model_image *p, int material, double share);
/* Mean difference of luminance to the pixel at the right and below, both of that material. */
double model_image_detail(const model_image *p, int material);

/* Distance of a pixel from the center of a sphere's image, 1 at the rim; the cosine between the normal there
 * and the direction to the eye. */
double model_image_radius(const model_image *p, uint32_t i);
double model_image_cosine(const model_image *p, uint32_t i);
/* Mean of a channel over a ring of the sphere, within that material. */
double model_image_ring(const model_image *p, int material, int channel, double from, double to);
/* Number of hues, of 12 sectors, with at least 2 % of the material's pixels; chroma below 0.05 does not
 * count. */
uint32_t model_image_hues(const model_image *p, int material);

/* Root mean square of the difference over that of a; any material, all channels of RGBA
 * (facet_comparison's nrmse). */
double model_image_distance(const model_image *a, const model_image *b);

#endif
