/* gl_layers.h - blended surfaces in layers beside the image, composed over it: depth peeling and weighted blending
 * (gl_transparency.h). */
#ifndef GL_GL_LAYERS_H
#define GL_GL_LAYERS_H

#include "gl/scene/gl_transparency.h"

/* Textures of the target's size, and their framebuffers. */
typedef struct gl_layers {
    gl_context *context;
    facet_transparency mode;
    uint32_t width, height, samples;
    uint32_t sum, layer;       /* peeled: the composite so far, one layer; weighted: light, weights */
    uint32_t depths[2];        /* peeled: of the last layer and of this one, alternating */
    uint32_t renderbuffers[2]; /* weighted, multisampled: of sum and layer */
    /* peeled: a layer with either depth, sum; weighted: both, then sum and layer resolved */
    uint32_t framebuffers[3];
    uint32_t empty_array, query;
    uint64_t weighted_feature, peeled_feature;
} gl_layers;

void gl_layers_create(gl_layers *layers, gl_context *context);
void gl_layers_destroy(gl_layers *layers); /* {0} is allowed */
/* Features of the programs of a mode. */
uint64_t gl_layers_features(const gl_layers *layers, facet_transparency mode);
/* Draws GL_PASS_BLENDED; the mode of the view is peeled or weighted. Leaves blending off, depth writes on. Fails as
 * gl_transparency_draw(). */
facet_result gl_layers_draw(gl_layers *layers, const gl_transparency_view *view, facet_error *error);

#endif
