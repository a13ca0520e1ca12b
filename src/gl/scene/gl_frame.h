/* gl_frame.h - the passes of one view in their order, and what they draw with. */
#ifndef GL_GL_FRAME_H
#define GL_GL_FRAME_H

#include "gl/scene/gl_light.h"
#include "gl/scene/gl_material.h"
#include "gl/core/gl_pyramid.h"
#include "gl/scene/gl_scene.h"
#include "gl/core/gl_target.h"
#include "gl/core/gl_timers.h"
#include "gl/scene/gl_transparency.h"

/* All that a scene has in OpenGL's memory; lives as long as its context. */
typedef struct gl_frame {
    gl_context *context;
    gl_programs *programs;
    gl_mesh_set *meshes;
    gl_material_set *materials;
    gl_light *light;
    gl_pyramid opaque, bloom;
    gl_phong *phong; /* NULL: no picture had materials of OpenGL 1 */
    gl_transparency *transparency;
    const gl_scene *scene; /* of the last update */
    gl_timers timers;
    uint32_t frame_buffer; /* of the block */
    uint32_t empty_array;  /* vertices of what covers the picture */
} gl_frame;

/* Its context is current, as for all of this. Fails with FACET_ERROR_MEMORY; gl_frame_destroy() whatever comes back. */
facet_result gl_frame_create(gl_frame *frame, gl_context *context, const facet_scene *scene,
                             const facet_allocator *allocator, facet_error *error);
void gl_frame_destroy(gl_frame *frame); /* {0} is allowed; leaves {0} */

/* Uploads what the picture needs and is not there, and has its programs compiled, all of them at once. Adds to the times of
 * stats. */
facet_result gl_frame_update(gl_frame *frame, const gl_scene *scene, const camera_rays *camera,
                             const facet_render_desc *desc, facet_render_stats *stats, facet_error *error);

/* Of a pixel of a target; the frame is up to date. */
uint32_t gl_frame_max_samples(const gl_frame *frame, const facet_render_desc *desc);
/* Draws a view into a target and resolves it. block: gl_camera_set() was called; the rest is filled in. */
facet_result gl_frame_draw(gl_frame *frame, const gl_target *target, const facet_render_desc *desc,
                           gl_frame_block *block, facet_error *error);
/* The AOVs of the nearest surfaces into the layers of a GL_TARGET_LAYERED: normal and depth (m; 0: nothing is there); base
 * color and occlusion; number of the geometry, texture coordinates, opacity. */
facet_result gl_frame_draw_layers(gl_frame *frame, const gl_target *target, const facet_render_desc *desc,
                                  gl_frame_block *block, facet_error *error);
/* A resolved picture as a window's numbers into the framebuffer that is bound, its lower left corner at x, y. */
facet_result gl_frame_present(gl_frame *frame, const gl_target *target, const facet_render_desc *desc, int x,
                              int y, facet_error *error);

#endif
