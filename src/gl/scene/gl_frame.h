/* gl_frame.h - the passes of one view in their order, and their resources. */
#ifndef GL_GL_FRAME_H
#define GL_GL_FRAME_H

#include "gl/scene/gl_glass.h"
#include "gl/scene/gl_light.h"
#include "gl/scene/gl_material.h"
#include "gl/core/gl_pyramid.h"
#include "gl/scene/gl_rays.h"
#include "gl/scene/gl_scene.h"
#include "gl/core/gl_target.h"
#include "gl/core/gl_timers.h"
#include "gl/scene/gl_transparency.h"

/* What a frame is drawn for. */
typedef enum gl_frame_use {
    GL_FRAME_IMAGE,
    GL_FRAME_WINDOW, /* read by gl_frame_present() only: what is empty around the model is left out */
    GL_FRAME_CANVAS /* the same, of a page, with the same corner: opaque surfaces are drawn as displayed, if nothing else is
                      * in the image, which is then antialiased after tone mapping, as pages antialias everything */
} gl_frame_use;

/* Everything of a scene in GPU memory; lives as long as its context. */
typedef struct gl_frame {
    gl_context *context;
    gl_programs *programs;
    gl_mesh_set *meshes;
    gl_material_set *materials;
    gl_light *light;
    gl_pyramid opaque, bloom;
    gl_rays rays;    /* through transmissive surfaces */
    gl_glass glass;  /* the light that they found */
    gl_phong *phong; /* NULL: not used yet */
    gl_transparency *transparency;
    const gl_scene *scene; /* of the last update */
    gl_frame_use use;      /* of the next update, set by the caller */
    bool is_traced;        /* of the last update: transmissive surfaces trace rays; drafts do not */
    uint64_t
        display_features; /* of the last update: gl_program_display_features(), or 0: surfaces put out radiance */
    gl_timers timers;
    /* of the last drawing: {left, bottom, width, height} of the pixels of the target that were resolved */
    int area[4];
    uint32_t frame_buffer; /* buffer of the frame block */
    uint32_t empty_array;  /* vertex array of full-screen passes */
} gl_frame;

/* The context is current, as for all functions here. Fails with FACET_ERROR_MEMORY; call
 * gl_frame_destroy() in any case. */
facet_result gl_frame_create(gl_frame *frame, gl_context *context, const facet_scene *scene,
                             const facet_allocator *allocator, facet_error *error);
void gl_frame_destroy(gl_frame *frame); /* {0} is allowed; leaves {0} */

/* Uploads what the image needs and is missing, and requests its programs. Adds to the times of stats. */
facet_result gl_frame_update(gl_frame *frame, const gl_scene *scene, const camera_rays *camera,
                             const facet_render_desc *desc, facet_render_stats *stats, facet_error *error);

/* The kind of target for a window's image; the frame is up to date. */
gl_target_kind gl_frame_window_kind(const gl_frame *frame);
/* The most samples per pixel of a target; the frame is up to date. */
uint32_t gl_frame_max_samples(const gl_frame *frame, const facet_render_desc *desc);
/* Draws a view into a target and resolves it. block: filled by gl_camera_set(); the rest is filled in here. */
facet_result gl_frame_draw(gl_frame *frame, const gl_target *target, const facet_render_desc *desc,
                           gl_frame_block *block, facet_error *error);
/* Draws the AOVs of the nearest surfaces into the layers of a GL_TARGET_LAYERED target: normal and depth
 * (m; 0: none); base color and occlusion; index of the geometry, texture coordinates, opacity. */
facet_result gl_frame_draw_layers(gl_frame *frame, const gl_target *target, const facet_render_desc *desc,
                                  gl_frame_block *block, facet_error *error);
/* Tone-maps and encodes a resolved image into a framebuffer, lower left corner at (x, y), or resolves one that was drawn
 * as displayed. */
facet_result gl_frame_present(gl_frame *frame, const gl_target *target, const facet_render_desc *desc,
                              uint32_t framebuffer, int x, int y, facet_error *error);

#endif
