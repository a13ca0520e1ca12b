/* facet/view.h - an interactive window that shows models. */
#ifndef FACET_VIEW_H
#define FACET_VIEW_H

#include "base.h"
#include "camera.h"
#include "environment.h"
#include "render.h"
#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A model and its initial state in the window. */
typedef struct facet_view_model {
    facet_scene *scene;                        /* owned by the window from now on */
    facet_pose_desc pose;                      /* without animations: */
    uint32_t first_animation, animation_count; /* consecutive ones that play together */
    bool is_playing;
    facet_orbit orbit; /* the view, unless has_camera or has_eye */
    bool has_camera;   /* a camera of the file */
    uint32_t camera;
    bool has_eye; /* any other camera; roll is ignored */
    facet_camera eye;
} facet_view_model;

/* What a window shows, as the arguments of facet_render() for the same image. */
typedef struct facet_view_image {
    const char *model;               /* its path; NULL: the built-in scene */
    const char *environment;         /* the name that load_environment() received */
    const facet_render_desc *render; /* complete */
    const facet_orbit *orbit;        /* with radius and target; NULL: a camera of the file */
    uint32_t camera;                 /* of the file */
    double origin[3];                /* facet_scene_get_origin() of the model */
} facet_view_image;

/* Callbacks of a window; NULL: the library's own behavior. load_model and load_environment are called from
 * a separate thread, one at a time, the others from the thread of facet_view(). */
typedef struct facet_view_source {
    void *user;
    /* Loads a model; path NULL: the built-in scene. */
    facet_result (*load_model)(void *user, const char *path, facet_view_model *model, facet_error *error);
    /* Loads an environment; name NULL: the initial one or the model's own. *environment NULL: no light. */
    facet_result (*load_environment)(void *user, const char *name, const facet_view_model *model,
                                     facet_environment **environment, facet_error *error);
    /* The command line that renders the image, a block of malloc(); NULL: there is none. */
    char *(*describe)(void *user, const facet_view_image *image);
    /* Prints a line. */
    void (*print)(void *user, const char *text);
} facet_view_source;

/* {0}: the built-in scene. */
typedef struct facet_view_desc {
    facet_allocator allocator;
    facet_log log;
    facet_view_source source;
    const char *const *paths; /* models, and folders of models */
    uint32_t path_count;
    /* names to choose from, beside the files in the folder of a named file */
    const char *const *environments;
    uint32_t environment_count;
    const char *environment; /* the initial one; NULL: load_environment() decides */
    /* Initial size (0: 1024 x 768), background, exposure, ..; the renderer is GL or PATH. allocator, log,
     * progress, pose, camera, environment and crop are not read. */
    facet_render_desc render;
    uint32_t path_samples; /* per pixel, after which path tracing stops; 0: 4096 */
    /* file of input events that is played with a clock of its own (docs/view.md); NULL: none */
    const char *script;
} facet_view_desc;

/* Opens a window and returns when it is closed. Call it on the first thread of the process. desc NULL:
 * {0}. FACET_ERROR_SYSTEM: display, GLFW or OpenGL is missing; FACET_ERROR_ARGUMENT: of the script; or as
 * loading the first model fails. */
FACET_API facet_result facet_view(const facet_view_desc *desc, facet_error *error);

#ifdef __cplusplus
}
#endif

#endif
