/* picture.h - small pictures of real models for tests that look at what a material, a codec or an animation does to the
 * picture. Models come from the folder that FACET_TEST_DATA names; functions abort the test where they fail. */
#ifndef TESTS_PICTURE_H
#define TESTS_PICTURE_H

#include "facet/facet.h"

/* Prints a line and returns NULL where there are no test data; the caller skips. path: below models/. */
facet_scene *model_load(const char *path);
/* The same model with text in its JSON replaced, all places; a .glb. The test fails where there is no such text. */
facet_scene *model_load_edited(const char *path, const char *text, const char *by);

/* The bytes of a model, for free(); NULL as above. */
unsigned char *model_read(const char *path, size_t *size);

/* A view along -Z without perspective: what is the same, moved sideways, looks the same. */
typedef struct view {
    float x, y, height; /* middle and height of the picture, m; height 0: the default orbit */
    float back;         /* m from z = 0 to the eye; 0: 10 */
} view;

/* Linear RGBA, premultiplied, and the material of the nearest surface, -1 for none. */
typedef struct picture {
    uint32_t width, height, count; /* count: of pixels */
    float *rgba;
    int *material;
} picture;

/* 64 x 64 pixels unless desc (NULL: {0}) has a size. Without an environment in desc: the studio. */
picture picture_take(const facet_scene *scene, const view *v, const facet_render_desc *desc);
/* The sphere of radius 0.5 at (x, 0, 0) of a model; text: what is replaced in the model's JSON first, NULL: nothing.
 * A picture without pixels where there are no test data. */
picture picture_of_sphere(const char *path, float x, const facet_render_desc *desc, const char *text,
                          const char *by);
void picture_destroy(picture *p);

/* Rec.709 luminance of a pixel; its chroma: largest minus smallest channel. */
double picture_luminance(const picture *p, uint32_t i);
double picture_chroma(const picture *p, uint32_t i);

/* Over the pixels of a material (-1: of any): number, means, luminance that a share (0 to 1) of them lies below. */
uint32_t picture_pixels(const picture *p, int material);
double picture_mean(const picture *p, int material, int channel);
double picture_mean_luminance(const picture *p, int material);
double picture_mean_chroma(const picture *p, int material);
double picture_percentile(const picture *p, int material, double share);
/* Mean difference of luminance from the pixel at the right, below, both of that material. */
double picture_detail(const picture *p, int material);

/* Distance of a pixel from the middle of the picture of a sphere, 1 at the sphere's rim; the cosine between the normal
 * there and the direction to the eye. */
double picture_radius(const picture *p, uint32_t i);
double picture_cosine(const picture *p, uint32_t i);
/* Mean of a channel over a ring of the sphere, where that material is. */
double picture_ring(const picture *p, int material, int channel, double from, double to);
/* How many of 12 equal parts of the circle of hues have at least 2 % of the material's pixels, those without color
 * (chroma below 0.05) aside. */
uint32_t picture_hues(const picture *p, int material);

/* Root mean square of the difference over that of a; any material, all channels of RGBA (facet_comparison's nrmse). */
double picture_distance(const picture *a, const picture *b);

#endif
