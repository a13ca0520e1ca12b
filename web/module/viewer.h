/* viewer.h - the state of one viewer, for the files of this module. What pages call: viewer.c. */
#ifndef WEB_VIEWER_H
#define WEB_VIEWER_H

#include "cli/view/view_command.h"
#include "gl/scene/gl_renderer.h"
#include "light.h"
#include "view/view_rig.h"
#include "view/view_state.h"

typedef struct viewer {
    struct viewer *next; /* of all viewers */
    gl_context *context; /* shared by all */
    char *path;          /* of the model; "": the built-in scene; NULL: none yet */
    facet_scene *scene;
    gl_renderer *renderer; /* NULL: no scene, or the context is lost */
    web_light *light;
    web_light *file_light; /* of the last file of --env, which the table may not have any more; NULL: none */
    view_state state;
    view_rig rig;        /* places the orbit of the state, once a page has framed the model */
    facet_orbit placed;  /* by the rig */
    bool frames_tightly; /* an unmoved camera is that of facet render */
    facet_orbit tight_home;
    view_pace pace;
    float framed_aspect; /* of the image for which the orbit was found */

    /* the options as they were accepted last; the state has changed since, where keys or the pointer did */
    view_options given; /* texts of line */
    command_line line;
    render_options options;

    facet_render_stats stats;                                         /* of the last frame */
    uint32_t side_texture, side_framebuffer, side_width, side_height; /* right of the divider */
    char message[512];                                                /* the last warning */
} viewer;

facet_log web_viewer_log(viewer *v);

facet_error *web_error(void); /* of facet_web_error() */

/* ---- options.c: the state as options of the command, and back ---- */

facet_result web_options_create(viewer *v, facet_error *error); /* the defaults */
void web_options_destroy(viewer *v);
/* text NULL: the default. Where it fails nothing has changed. */
facet_result web_options_set(viewer *v, const char *name, const char *text, facet_error *error);
/* After another model was opened: the options that are no matter of one model stay. */
facet_result web_options_open(viewer *v, facet_error *error);
/* Appends the options of the present state; is_whole: the camera is written in full, as a command line needs it that
 * does not know how this image was framed. */
void web_options_list(const viewer *v, uint32_t width, uint32_t height, bool is_whole, view_options *out);
/* A malloc() block; NULL: no memory. */
char *web_options_command(const viewer *v, uint32_t width, uint32_t height);

/* ---- model.c: models, and what is drawn of them ---- */

/* path: "" is the built-in scene. Where it fails the last model stays. */
facet_result web_model_open(viewer *v, const char *path, facet_error *error);
/* The same model with the materials of that shading. */
facet_result web_model_reload(viewer *v, facet_shading shading, facet_error *error);
/* After a change of the pose that may have moved the origin. */
facet_result web_model_find_bounds(viewer *v, facet_error *error);
void web_model_close(viewer *v);

/* ---- camera.c: the camera of <facet-viewer> ---- */

/* Before a frame of that size, so long after the last one. */
facet_result web_camera_advance(viewer *v, uint32_t width, uint32_t height, double seconds,
                                facet_error *error);
/* Before the camera is read between frames: an orbit that an option has set is taken over, as the next frame would do. */
facet_result web_camera_settle(viewer *v, facet_error *error);
bool web_camera_is_moving(const viewer *v);
/* The camera was not moved: every viewer shows the model like this unless an option says otherwise. */
bool web_camera_is_home(const viewer *v);

/* ---- draw.c ---- */

/* What is to be drawn, resolved. Finds the orbit where it is left to framing. */
facet_result web_draw_desc(viewer *v, uint32_t width, uint32_t height, facet_camera *camera,
                           facet_render_desc *out, facet_error *error);
facet_result web_draw(viewer *v, uint32_t width, uint32_t height, bool is_draft, facet_error *error);
/* RGBA8, rows from the top, straight alpha: a malloc() block. */
facet_result web_draw_read(viewer *v, uint32_t width, uint32_t height, void **rgba, facet_error *error);
/* facet_web_pick(), facet_web_project(). */
facet_result web_draw_pick(viewer *v, double x, double y, double out[8], facet_error *error);
facet_result web_draw_project(viewer *v, const double position[3], double out[4], facet_error *error);
/* The exposure that a light meter gives this view, stops. */
facet_result web_draw_meter(viewer *v, float *stops, facet_error *error);

/* ---- describe.c: text for the page, malloc() blocks; NULL: no memory ---- */

char *web_describe_options(const viewer *v);
char *web_describe_state(const viewer *v);

/* The comparison of that name, "" for none. False: there is no such one. */
bool web_comparison_find(const char *name, view_comparison *out);

#endif
