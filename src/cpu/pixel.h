/* pixel.h - the color of a pixel from the hits of its samples. */
#ifndef CPU_PIXEL_H
#define CPU_PIXEL_H

#include "cpu/ray_trace.h"
#include "cpu/shading.h"
#include "film/matte.h"

struct scene_identity; /* scene/identity.h */

/* One surface hit by one sample; those of a sample are consecutive, front to back. */
typedef struct pixel_fragment {
    visibility_hit hit;
    uint32_t sample;
    uint32_t surface; /* index of its pixel_surface */
} pixel_fragment;

/* Fragments that are shaded once. */
typedef struct pixel_surface {
    uint32_t first;
    uint32_t fragment_count;
    float middle[2]; /* of its samples, pixels from the pixel's top left */
    float radiance[3];
    float opacity;
    float behind; /* share of the background that is seen through it */
} pixel_surface;

/* The state of one thread that resolves pixels one after the other. */
typedef struct pixel_resolver {
    const facet_allocator *allocator;
    const shading_scene *scene;
    const visibility_pattern *pattern;
    bool splits_quarters;  /* surfaces are shaded for each quarter of a pixel */
    bool has_visible_hits; /* the hits of opaque surfaces are on their visible side */
    bool draws_background;
    float background_blur; /* perceptual roughness */
    float scale;           /* of the radiance */
    pixel_fragment *fragments;
    pixel_surface *surfaces;
    size_t fragment_capacity, surface_capacity;
    size_t fragment_count, surface_count;
    uint64_t rays, shades;
    const struct ambient_image *ambient; /* of the pixels; NULL: none */
} pixel_resolver;

/* Radiance times scale, premultiplied, and coverage of pixel (x, y) of the whole image, whose samples hit
 * hits. False: no memory. */
bool pixel_resolve(pixel_resolver *resolver, uint32_t x, uint32_t y, const visibility_hit *hits,
                   float rgba[4]);
/* The same for a pixel whose samples all hit one triangle or nothing; hit: their mean. False: it takes all of its hits. */
bool pixel_resolve_one(pixel_resolver *resolver, uint32_t x, uint32_t y, const visibility_hit *hit,
                       float rgba[4]);
/* Adds the environment times scale where nothing covers the pixel. blur: perceptual roughness. */
void pixel_add_background(const shading_scene *scene, float blur, float scale, uint32_t x, uint32_t y,
                          float rgba[4]);
/* Adds the coverage of that pixel, which pixel_resolve() has just resolved successfully, to Cryptomatte's
 * layers. identities: per geometry. number: of the pixel in the layers. */
void pixel_add_mattes(const pixel_resolver *resolver, const struct scene_identity *identities,
                      const matte_layers *mattes, size_t number);
/* The nearest surface at the center of the pixel; false: none. depth_m along the camera's axis. */
bool pixel_nearest_surface(pixel_resolver *resolver, uint32_t x, uint32_t y, const visibility_hit *hit,
                           shading_description *result, float *depth_m, uint32_t *geometry);
void pixel_resolver_destroy(pixel_resolver *resolver);

#endif
