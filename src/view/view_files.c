/* view_files.c - models and environments of a window: stepping, dropping, reloading, and updating the
 * state when they are read. */
#include "view/view_app.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/result.h"
#include "scene/scene.h"

static void request(view_app *a, const view_request *r)
{
    if (!view_load_request(a->loader, r))
        view_app_say(a, "There is no memory", 4.0);
}

/* The environment is read together with a model, as the model may have its own: without a name it is that,
 * or the default one. */
static void request_model(view_app *a, const char *path)
{
    bool may_have_light = !a->environment_name;
    request(a, &(view_request){.wants_model = true, .path = path, .wants_environment = may_have_light});
}

facet_result view_files_begin(view_app *a, facet_error *error)
{
    const facet_view_desc *d = a->desc;
    a->models.allocator = a->environments.allocator = d->allocator;
    if (!view_list_models(&a->models, d->paths, d->path_count) ||
        !view_list_environments(&a->environments, d->environments, d->environment_count, d->environment))
        return fail_memory(error, "names", 0);
    if (d->path_count && a->models.count == 0)
        return fail(error, FACET_ERROR_READ, "%s: there is no .glb, .gltf or .obj file in it", d->paths[0]);
    const char *first = view_list_step(&a->models, 0);
    if (!view_load_request(a->loader, &(view_request){.wants_model = true,
                                                      .path = first,
                                                      .wants_environment = true,
                                                      .environment = d->environment}))
        return fail_memory(error, "names", 0);
    return FACET_OK;
}

void view_files_step_model(view_app *a, int steps)
{
    const char *path = view_list_step(&a->models, steps);
    if (path)
        request_model(a, path);
    else
        view_app_say(a, "Drop a model or a folder of models here", 4.0);
}

void view_files_step_environment(view_app *a, int steps)
{
    const char *name = view_list_step(&a->environments, steps);
    if (name)
        request(a, &(view_request){.wants_environment = true, .environment = name});
}

void view_files_reload(view_app *a, bool is_changed)
{
    if (!is_changed)
        view_app_say(a, "Reading the model again", 2.0);
    a->is_reloading = true;
    request_model(a, a->path);
}

void view_files_drop(view_app *a, const char *path)
{
    if (!path)
        return;
    if (view_path_is_environment(path)) {
        view_list_environments(&a->environments, a->desc->environments, a->desc->environment_count, path);
        request(a, &(view_request){.wants_environment = true, .environment = path});
        return;
    }
    view_list dropped = {.allocator = a->desc->allocator};
    if (view_path_is_folder(path)) {
        const char *const paths[] = {path};
        if (!view_list_models(&dropped, paths, 1) || dropped.count == 0) {
            char text[512];
            snprintf(text, sizeof text, "%.400s: there is no model in this folder", path_base_name(path));
            view_app_say(a, text, 6.0);
            view_list_clear(&dropped);
            return;
        }
        view_list_clear(&a->models);
        a->models = dropped;
        path = view_list_step(&a->models, 0);
    }
    request_model(a, path); /* added to the list only when it has been read */
}

/* ---- what was read ---- */

static void set_title(view_app *a)
{
    char title[512];
    const char *name = a->path ? path_base_name(a->path) : "built-in scene";
    if (a->models.count > 1)
        snprintf(title, sizeof title, "%.400s - facet (%zu of %zu)", name, a->models.at + 1, a->models.count);
    else
        snprintf(title, sizeof title, "%.400s - facet", name);
    view_window_set_title(a->window, title);
}

static void report_environment(view_app *a)
{
    char text[512];
    const view_list *l = &a->environments;
    const char *name = a->environment_name ? a->environment_name : "default";
    int used = snprintf(text, sizeof text, "Environment: %.400s", path_base_name(name));
    if (l->at < l->count && strcmp(l->names[l->at], name) == 0)
        snprintf(text + used, sizeof text - (size_t)used, " (%zu of %zu)", l->at + 1, l->count);
    view_app_say(a, text, 2.0);
}

/* Before the model or the environment that is being traced is released. */
static void stop_traces(view_app *a)
{
    for (int i = 0; i < 2; i++) {
        view_trace_stop(a->traced[i].tracer);
        a->traced[i].is_current = false;
    }
}

static void show_environment(view_app *a, view_loaded *l)
{
    if (!l->has_environment)
        return;
    stop_traces(a);
    a->host->environment_destroy(a->environment);
    a->environment = l->environment;
    l->environment = NULL;
    free(a->environment_name);
    a->environment_name = l->environment_name;
    l->environment_name = NULL;
    a->needs_image = true;
    view_app_forget_warning(a);
    if (!l->wanted_model)
        report_environment(a);
}

/* A dropped model makes the others of its folder the list. */
static void find_in_list(view_app *a)
{
    size_t i = 0;
    while (a->path && i < a->models.count && strcmp(a->models.names[i], a->path) != 0)
        i++;
    a->models.at = i;
    if (a->path && i == a->models.count) {
        const char *const paths[] = {a->path};
        view_list_models(&a->models, paths, 1);
    }
}

static const double HINT_S = 10.0; /* at the start, unless there is input before */

/* The first message also names the keys to begin with, and options that have no effect. */
static void report_model(view_app *a, bool is_again, bool is_first)
{
    char text[512];
    static const char hint[] =
        "H: help    R: path tracing    Tab: compare    Drag: orbit    Wheel: nearer, farther";
    if (is_again) {
        view_app_say(a, "The model was read again", 2.0);
    } else if (!a->path) {
        snprintf(text, sizeof text, "Drop a model here\n%s", hint);
        view_app_say(a, text, HINT_S);
    } else if (a->models.count > 1) {
        snprintf(text, sizeof text, "%.400s\t%zu of %zu%s%s", path_base_name(a->path), a->models.at + 1,
                 a->models.count, is_first ? "\n" : "", is_first ? hint : "");
        view_app_say(a, text, is_first ? HINT_S : 2.0);
    } else if (is_first) {
        view_app_say(a, hint, HINT_S);
    }
    a->is_hint = is_first;
    if (is_first && a->state.render.gl.has_shadows && !view_state_has_casters(&a->state))
        view_app_say(a, "--shadows: the model has no lights, and there is no --sun to cast any", 6.0);
}

static facet_result show_model(view_app *a, view_loaded *l, facet_error *error)
{
    gl_renderer *renderer = NULL;
    TRY(gl_renderer_create(l->model.scene, &a->context, &a->desc->allocator, &renderer, error));
    bool is_again = a->scene && a->is_reloading;
    bool is_first = !a->scene;
    stop_traces(a);
    gl_renderer_destroy(a->renderer);
    a->renderer = renderer;
    view_state_set_model(&a->state, &l->model, l->low, l->high, is_again);
    a->host->scene_destroy(a->scene);
    a->scene = l->model.scene;
    l->has_model = false;
    free(a->path);
    a->path = l->path;
    l->path = NULL;
    view_watch_set(a->watcher, a->scene, a->path);
    find_in_list(a);
    set_title(a);
    report_model(a, is_again, is_first);
    view_app_forget_warning(a);
    a->needs_image = true;
    return FACET_OK;
}

facet_result view_files_update(view_app *a, facet_error *error)
{
    view_loaded loaded;
    if (view_watch_take(a->watcher))
        view_files_reload(a, true);
    if (!view_load_take(a->loader, &loaded))
        return FACET_OK;
    facet_error why = loaded.error;
    facet_result result = why.result;
    if (result == FACET_OK && loaded.has_model)
        result = show_model(a, &loaded, &why);
    if (result == FACET_OK)
        show_environment(a, &loaded);
    if (loaded.wanted_model) {
        a->reload_count += a->is_reloading;
        a->is_reloading = false;
    }
    view_loaded_destroy(a->host, &loaded);
    if (result == FACET_OK)
        return FACET_OK;
    if (!a->scene) {
        if (error)
            *error = why;
        return result;
    }
    view_app_say(a, why.message, 8.0);
    return FACET_OK;
}

void view_files_end(view_app *a)
{
    view_list_clear(&a->models);
    view_list_clear(&a->environments);
    a->host->environment_destroy(a->environment);
    a->host->scene_destroy(a->scene);
    free(a->path);
    free(a->environment_name);
}
