/* gl_transparency_set.h - what the three ways to blend share. */
#ifndef GL_GL_TRANSPARENCY_SET_H
#define GL_GL_TRANSPARENCY_SET_H

#include "gl/scene/gl_transparency.h"

/* The order of gl_sort.h in OpenGL's memory. */
typedef struct gl_sorted {
    gl_sort sort;
    uint64_t revision; /* of the scene, that arrays belong to */
    uint32_t elements; /* buffer: indices of the triangles of each unit behind each other */
    uint32_t batch_count;
    uint32_t *arrays;      /* array objects, per batch */
    size_t *first_element; /* per unit */
    gl_vertices *sprites;  /* per unit */
    uint32_t unit_count;
} gl_sorted;

/* Textures as large as the target, and framebuffers of them. */
typedef struct gl_layers {
    facet_transparency mode;
    uint32_t width, height, samples;
    uint32_t sum, layer;       /* peeled: what was put together so far, one layer; weighted: light, weights */
    uint32_t depths[2];        /* peeled: of the last layer and of this one, in turns */
    uint32_t renderbuffers[2]; /* weighted, several samples: of sum and layer */
    /* peeled: a layer with either depth, sum; weighted: both, sum, layer resolved */
    uint32_t framebuffers[3];
} gl_layers;

struct gl_transparency {
    gl_context *context;
    facet_allocator allocator;
    gl_sorted sorted;
    gl_layers layers;
    uint32_t empty_array;
    uint32_t query;
    uint64_t weighted_feature, peeled_feature;
};

/* Makes a batch's program, with those features too, and its material current. */
facet_result gl_transparency_use(const gl_transparency_view *view, const gl_batch *batch, uint64_t features,
                                 facet_error *error);
/* Draws all batches, in any order. */
facet_result gl_transparency_draw_all(const gl_transparency_view *view, uint64_t features,
                                      facet_error *error);
/* Blends a texture of the layers over the framebuffer that is bound, with the blend function that is set: one layer, the sum
 * of them, a weighted mean. */
typedef enum gl_compose { GL_COMPOSE_LAYER, GL_COMPOSE_SUM, GL_COMPOSE_WEIGHTED } gl_compose;
facet_result gl_transparency_compose(gl_transparency *t, const gl_transparency_view *view, gl_compose what,
                                     facet_error *error);

facet_result gl_sorted_draw(gl_transparency *t, const gl_transparency_view *view, facet_error *error);
void gl_sorted_destroy(gl_sorted *s);
/* Layers for the mode and target of view. */
facet_result gl_layers_update(gl_transparency *t, const gl_transparency_view *view, facet_error *error);
void gl_layers_destroy(gl_layers *l);
/* Binds a texture of the layers, with its own parameters in place of a material's sampler. */
void gl_layers_bind(uint32_t unit, uint32_t texture);
facet_result gl_peeled_draw(gl_transparency *t, const gl_transparency_view *view, facet_error *error);
facet_result gl_weighted_draw(gl_transparency *t, const gl_transparency_view *view, facet_error *error);

#endif
