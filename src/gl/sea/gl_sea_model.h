/* gl_sea_model.h - a model in a sea: images of it from the eye, from the eye's mirror image behind the
 * water, and, for an eye in the water, of what is above it. sea_model.glsl puts them behind the surface,
 * in front of it, and into what it reflects and refracts. Drawn as any model is (gl_frame.h), by the light
 * over the sea. */
#ifndef GL_GL_SEA_MODEL_H
#define GL_GL_SEA_MODEL_H

#include "gl/scene/gl_camera.h"
#include "gl/scene/gl_frame.h"
#include "gl/sea/gl_sea_block.h"
#include "scene/identity.h"
#include "water/water_frame.h"

typedef struct gl_sea_model {
    gl_context *context;
    facet_allocator allocator;
    gl_scene prepared;
    gl_frame frame;
    gl_target seen, layers, cuts[GL_SEA_CUTS];
    uint32_t contact; /* texture: sea_contact */
    facet_render_desc desc;
} gl_sea_model;

/* For an image with a model: uploads it, and draws its cuts and shadow maps. Anew for each image, as the
 * model may have moved. Fails as gl_renderer_render(). Call gl_sea_model_end() whatever it returns. */
facet_result gl_sea_model_begin(gl_sea_model *m, gl_context *context, const water_frame *frame,
                                const camera_rays *camera, gl_sea_block *block, facet_render_stats *stats,
                                facet_error *error);
/* Identities by the numbers in the layers (sea.frag): the water's, the bed's, those of the model's geometries.
 * A block of mem_alloc(). FACET_ERROR_MEMORY. m: {0} where there is no model. */
facet_result gl_sea_model_identify(const gl_sea_model *m, const water_frame *frame, scene_identity **out,
                                   uint32_t *count, facet_error *error);
/* The model as a view sees it. Changes OpenGL's bindings. */
facet_result gl_sea_model_draw(gl_sea_model *m, const water_frame *frame, const camera_rays *camera,
                               const gl_view *view, gl_sea_block *block, facet_error *error);
void gl_sea_model_bind(const gl_sea_model *m);
/* The same of the model's layers (gl_frame_draw_layers()). */
facet_result gl_sea_model_draw_layers(gl_sea_model *m, const water_frame *frame, const camera_rays *camera,
                                      const gl_view *view, facet_error *error);
void gl_sea_model_bind_layers(const gl_sea_model *m);
void gl_sea_model_end(gl_sea_model *m); /* {0} is allowed; leaves {0} */

#endif
