/* view_app.h - the state that the viewer's files share: view.c (the loop), view_files.c (reading),
 * view_show.c and view_panels.c (drawing), view_shot.c (saving), view_play.c (scripts). */
#ifndef VIEW_VIEW_APP_H
#define VIEW_VIEW_APP_H

#include <pthread.h>
#include <stdatomic.h>

#include "gl/scene/gl_renderer.h"
#include "view/view_draw.h"
#include "view/view_load.h"
#include "view/view_overlay.h"
#include "view/view_state.h"
#include "view/view_script.h"
#include "view/view_trace.h"
#include "view/view_watch.h"
#include "view/view_window.h"

/* Names to step through: models, environments. */
typedef struct view_list {
    facet_allocator allocator;
    char **names; /* each a block of mem_alloc() */
    size_t count, capacity;
    size_t at; /* index of the current one; count: none of them */
} view_list;

/* A text panel and its source, so that it is redrawn only when that changes. */
typedef struct view_shown_panel {
    view_surface surface;
    char text[2048];
    float scale;
    uint32_t max_width, max_height;
    bool is_there;
} view_shown_panel;

/* The path traced image of one side. */
typedef struct view_traced {
    view_tracer *tracer;
    view_surface surface;
    bool is_current;  /* surface shows the current state */
    uint32_t samples; /* per pixel, of surface */
} view_traced;

typedef enum view_panel_id {
    VIEW_PANEL_HELP,
    VIEW_PANEL_VALUES,
    VIEW_PANEL_MESSAGE,
    VIEW_PANEL_SAMPLES,
    VIEW_PANEL_LEFT,
    VIEW_PANEL_RIGHT,
    VIEW_PANEL_COUNT
} view_panel_id;

typedef struct view_app {
    const gl_host *host;
    const facet_view_desc *desc;
    view_queue queue;
    _Atomic(view_window *) window; /* other threads wake it */
    gl_context context;
    view_draw *draw;
    view_state state;
    view_loader *loader;
    view_watcher *watcher;

    /* files */
    view_list models, environments;
    facet_scene *scene; /* displayed; NULL: nothing yet */
    char *path;         /* NULL: the built-in scene; blocks of malloc() */
    char *environment_name;
    facet_environment *environment;
    gl_renderer *renderer;
    bool is_reloading;
    uint32_t reload_count; /* models reloaded after their files changed */

    /* the image */
    view_surface sides[2], shot;
    view_traced traced[2]; /* left, right; without a divider the right one */
    double frame_s;        /* of the last frame; smoothed while something moves; 0: none yet */
    view_pace pace;
    uint32_t divisor;     /* of the resolution at which it was drawn */
    bool is_draft;        /* it was drawn with FACET_QUALITY_DRAFT */
    double moves_until_s; /* on the clock; the camera counts as moving until then */
    char variant[128];    /* label of a side */
    bool needs_image;     /* model, camera or light changed */
    bool needs_frame;     /* only the overlay changed */
    bool has_drawn;       /* by OpenGL, for the current frame */
    bool is_for_file;     /* with the quality of facet render, if slower */
    view_shown_panel panels[VIEW_PANEL_COUNT];
    bool has_no_text; /* there is no cairo */

    /* messages */
    char message[1024];
    double message_until_s;
    /* the message is the hint at the start, which disappears with the first input */
    bool is_hint;
    pthread_mutex_t warning_mutex; /* guards: */
    char warning[256],
        shown_warning[256]; /* the warning of a renderer, from any thread; the last one that was shown */

    /* the loop */
    double time_s; /* of animations and messages: the clock's, or the script's */
    double clock_s;
    bool is_shown, is_closing;
    view_script script;
    size_t script_at;
    double script_wait_s; /* clock time at which a step times out */
    uint32_t script_reload_count;
    facet_result result;
    facet_error error;
} view_app;

/* Shows text in the window for a while; without cairo reports it to the caller. */
void view_app_say(view_app *a, const char *text, double seconds);
/* Warnings of renderers are shown again if they still apply. */
void view_app_forget_warning(view_app *a);

/* view_files.c */
facet_result view_files_begin(view_app *a, facet_error *error);
void view_files_end(view_app *a);
void view_files_step_model(view_app *a, int steps);
void view_files_step_environment(view_app *a, int steps);
void view_files_drop(view_app *a, const char *path);
void view_files_reload(view_app *a, bool is_changed);
/* Takes what was read. Fails where the first model cannot be shown; later ones leave a message. */
facet_result view_files_update(view_app *a, facet_error *error);

/* view_show.c */
/* Draws the window; nothing where it has no size. */
facet_result view_show(view_app *a, facet_error *error);
/* Draws the image into a->shot, with or without the overlay. */
facet_result view_show_into(view_app *a, bool has_panels, facet_error *error);
void view_show_end(view_app *a);
/* The desc of what the window shows; with a divider of the right side. */
facet_render_desc view_show_desc(view_app *a, uint32_t width, uint32_t height, facet_camera *camera);

/* view_panels.c */
/* Renders the text of the panels where it has changed. */
void view_panels_make(view_app *a, uint32_t width, uint32_t height, const char *const labels[2]);
void view_panels_draw(view_app *a, uint32_t width, uint32_t height);

/* view_shot.c */
facet_result view_shot_save(view_app *a, const char *path, bool has_panels, facet_error *error);
void view_shot_key(view_app *a);   /* F12: to an unused name */
void view_shot_copy(view_app *a);  /* the command line to the clipboard, */
void view_shot_print(view_app *a); /* and to the caller */

/* view_play.c */
/* Advances the script as far as possible now. True: something was done, and the loop must not wait. */
bool view_play(view_app *a);

#endif
