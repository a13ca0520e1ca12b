/* gl_rays.h - the triangles of a pose in a texture, with a hierarchy and a table of materials, for rays that shaders
 * trace through transmissive surfaces (rays.glsl, glass.glsl). Scenes without transmissive surfaces have none. */
#ifndef GL_GL_RAYS_H
#define GL_GL_RAYS_H

#include "gl/scene/gl_material.h"

/* More triangles are not traced: 160 bytes each in GPU memory. */
enum { GL_RAYS_MAX_TRIANGLES = 1 << 20 };

typedef struct gl_rays {
    gl_context *context;
    facet_allocator allocator;
    uint32_t texture; /* RGBA32F; 0: none */
    uint64_t revision;
    bool is_ready, is_reported; /* the last update made a texture; too many triangles were reported */
} gl_rays;

/* Builds what the scene's revision needs; materials are up to date. Warns where there are too many triangles. Fails
 * with FACET_ERROR_MEMORY, FACET_ERROR_SYSTEM. */
facet_result gl_rays_update(gl_rays *rays, const gl_scene *scene, const gl_material_set *materials,
                            bool is_needed, const facet_log *log, facet_error *error);
/* Features of programs that trace them, or that look up the light which those found; 0: there is no texture. */
uint64_t gl_rays_features(const gl_rays *rays, bool traces);
void gl_rays_bind(const gl_rays *rays); /* to GL_UNIT_RAYS */
/* Draws the depth of the surfaces of a pass before transmissive ones are drawn: rays behind what others hide cost nothing
 * then. Masked surfaces are left out, as they hide what is behind them in part. */
facet_result gl_rays_draw_depth(gl_programs *programs, const gl_mesh_set *meshes,
                                const gl_material_set *materials, gl_pass pass, facet_error *error);
void gl_rays_destroy(gl_rays *rays); /* {0} is allowed; keeps context and allocator */

#endif
