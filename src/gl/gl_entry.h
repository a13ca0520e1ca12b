/* gl_entry.h - the interface between libfacet and its OpenGL module, which is loaded when an image is
 * rendered with OpenGL. Programs that render on the CPU load no driver. */
#ifndef GL_GL_ENTRY_H
#define GL_GL_ENTRY_H

#include "facet/facet.h"
#include "film/film.h"

typedef struct gl_renderer gl_renderer;
typedef struct gl_sea gl_sea;
struct water_frame;

/* Functions of libfacet that the module calls. It has its own copy of everything else that it uses. */
typedef struct gl_host {
    facet_result (*renderer_create)(const facet_scene *scene, const facet_allocator *allocator,
                                    facet_renderer **renderer, facet_error *error);
    facet_result (*renderer_render)(facet_renderer *renderer, const facet_render_desc *desc,
                                    facet_image **image, facet_error *error);
    void (*renderer_destroy)(facet_renderer *renderer);
    /* Renders desc as facet_render() does, to the same bytes, with a renderer of the caller. */
    facet_result (*render_gl)(gl_renderer *renderer, const facet_render_desc *desc, facet_image **image,
                              facet_error *error);
    uint32_t (*image_get_layer_count)(const facet_image *image);
    facet_image_view (*image_get_layer)(const facet_image *image, uint32_t layer);
    facet_result (*image_save)(const facet_image *image, const char *path, const facet_image_save_desc *desc,
                               facet_error *error);
    void (*image_destroy)(facet_image *image);
    facet_result (*image_create)(const facet_image_view *pixels, const facet_allocator *allocator,
                                 facet_image **image, facet_error *error);
    void (*scene_destroy)(facet_scene *scene);
    void (*environment_destroy)(facet_environment *environment);
    facet_result (*camera_from_scene)(const facet_scene *scene, const facet_pose_desc *pose, uint32_t index,
                                      facet_camera *camera, facet_error *error);
} gl_host;

/* Whether a channel is radiance, which is exposed and tone-mapped. The other channels are data, drawn over
 * black. */
static inline bool gl_channel_is_light(facet_channel channel)
{
    return channel == FACET_CHANNEL_LIGHT ||
           (channel >= FACET_CHANNEL_DIFFUSE && channel <= FACET_CHANNEL_EMISSION);
}

typedef struct gl_entry {
    /* Creates an off-screen context and the renderer of a scene. The scene outlives it. Fails with
     * FACET_ERROR_SYSTEM where there is no OpenGL, FACET_ERROR_MEMORY. */
    facet_result (*create)(const facet_scene *scene, const facet_allocator *allocator, gl_renderer **out,
                           facet_error *error);
    /* As preview_render_prepared(): desc is resolved, except for its camera, which may be NULL. Calls may
     * come from different threads, one at a time. */
    facet_result (*render)(gl_renderer *renderer, const facet_render_desc *desc, film *target,
                           facet_render_stats *stats, facet_error *error);
    void (*destroy)(gl_renderer *renderer); /* NULL is allowed */
    /* Creates the renderer of seas, with a context of its own. It keeps programs and textures from image
     * to image: gl_sea.h. */
    facet_result (*create_sea)(const facet_allocator *allocator, gl_sea **out, facet_error *error);
    facet_result (*draw_sea)(gl_sea *sea, const struct water_frame *frame, film *target,
                             facet_render_stats *stats, facet_error *error);
    void (*destroy_sea)(gl_sea *sea); /* NULL is allowed */
    /* Writes one line: renderer and version, or the reason why there is no OpenGL. */
    void (*report)(char *out, size_t size);
    /* facet_view() with a desc in which every function is set. */
    facet_result (*view)(const gl_host *host, const facet_view_desc *desc, facet_error *error);
} gl_entry;

/* Defined in src/view, which is linked into the module; in view_none.c where GLFW was missing at build time. */
facet_result view_run(const gl_host *host, const facet_view_desc *desc, facet_error *error);

/* The module's only exported symbol. build: the caller's GL_ENTRY_BUILD. NULL where the module is of another
 * build, whose structures may differ. */
FACET_API const gl_entry *facet_gl_entry(const char *build);
typedef const gl_entry *gl_entry_function(const char *build);

#endif
