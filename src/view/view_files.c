/* view_files.c - models and environments of a window: the lists to step through, dropping, reloading, and updating
 * the state when they are read. */
#define _POSIX_C_SOURCE 200809L
#include "view/view_app.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/result.h"
#include "scene/scene.h"

/* ---- kinds of files ---- */

enum { MAX_NAMES = 10000, MAX_DEPTH = 2 };

static bool has_extension(const char *path, const char *const *extensions)
{
    const char *extension = path_extension(path);
    for (; *extensions; extensions++)
        if (strcasecmp(extension, *extensions) == 0)
            return true;
    return false;
}

static bool is_model(const char *path)
{
    return has_extension(path, (const char *const[]){"glb", "gltf", "obj", NULL});
}

static bool is_environment(const char *path)
{
    return has_extension(
        path, (const char *const[]){"hdr", "exr", "pfm", "ktx2", "png", "jpg", "jpeg", "webp", "avif", NULL});
}

/* Environment light has high dynamic range: images of eight bits in a folder are more likely textures. */
static bool is_light(const char *path)
{
    return has_extension(path, (const char *const[]){"hdr", "exr", "ktx2", NULL});
}

/* ---- lists ---- */

static void list_clear(view_list *l)
{
    for (size_t i = 0; i < l->count; i++)
        mem_free(l->names[i]);
    mem_free(l->names);
    *l = (view_list){.allocator = l->allocator};
}

/* Takes ownership of name. */
static bool list_add(view_list *l, char *name)
{
    bool fits =
        name && mem_reserve(&l->allocator, (void **)&l->names, &l->capacity, l->count + 1, sizeof *l->names);
    if (!fits) {
        mem_free(name);
        return false;
    }
    l->names[l->count++] = name;
    return true;
}

static char *copy_of(const view_list *l, const char *name)
{
    size_t size = strlen(name) + 1;
    char *copy = mem_alloc(&l->allocator, size, 1);
    if (copy)
        memcpy(copy, name, size);
    return copy;
}

static bool list_add_copy(view_list *l, const char *name)
{
    return list_add(l, copy_of(l, name));
}

/* Numbers in names sort by value: ball2 before ball10. */
static int compare_names(const void *a, const void *b)
{
    const char *x = *(char *const *)a;
    const char *y = *(char *const *)b;
    while (*x && *y) {
        bool are_figures = *x >= '0' && *x <= '9' && *y >= '0' && *y <= '9';
        if (are_figures) {
            size_t zeros_x = strspn(x, "0");
            size_t zeros_y = strspn(y, "0");
            size_t length_x = strspn(x + zeros_x, "0123456789");
            size_t length_y = strspn(y + zeros_y, "0123456789");
            if (length_x != length_y)
                return length_x < length_y ? -1 : 1;
            int order = strncmp(x + zeros_x, y + zeros_y, length_x);
            if (order)
                return order;
            x += zeros_x + length_x;
            y += zeros_y + length_y;
            continue;
        }
        if (*x != *y)
            return (unsigned char)*x < (unsigned char)*y ? -1 : 1;
        x++;
        y++;
    }
    return (*x != 0) - (*y != 0);
}

static bool is_folder(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

/* Appends the matching files of a folder, by name. depth: how many folders further down it looks where it
 * has none itself. */
static bool list_add_folder(view_list *l, const char *folder, bool (*is_wanted)(const char *), int depth)
{
    DIR *directory = opendir(folder);
    view_list folders = {.allocator = l->allocator};
    size_t first = l->count;
    bool fits = true;
    struct dirent *entry;
    while (fits && directory && l->count < MAX_NAMES && (entry = readdir(directory)) != NULL) {
        if (entry->d_name[0] == '.')
            continue;
        char *path = path_join(&l->allocator, folder, entry->d_name);
        if (path && is_folder(path))
            fits = list_add(&folders, path);
        else if (is_wanted(entry->d_name))
            fits = list_add(l, path);
        else
            mem_free(path);
    }
    if (directory)
        closedir(directory);
    if (l->count > first)
        qsort(l->names + first, l->count - first, sizeof *l->names, compare_names);
    else if (folders.count && depth > 0) {
        qsort(folders.names, folders.count, sizeof *folders.names, compare_names);
        for (size_t i = 0; fits && i < folders.count; i++)
            fits = list_add_folder(l, folders.names[i], is_wanted, depth - 1);
    }
    list_clear(&folders);
    return fits;
}

static bool is_same_file(const char *a, const char *b)
{
    struct stat x;
    struct stat y;
    return strcmp(a, b) == 0 ||
           (stat(a, &x) == 0 && stat(b, &y) == 0 && x.st_dev == y.st_dev && x.st_ino == y.st_ino);
}

static size_t list_find(const view_list *l, const char *path)
{
    for (size_t i = 0; i < l->count; i++)
        if (is_same_file(l->names[i], path))
            return i;
    return l->count;
}

/* The matching files in path's folder; path is among them whatever its extension is. */
static bool list_add_neighbours(view_list *l, const char *path, bool (*is_wanted)(const char *))
{
    char *folder = path_folder(&l->allocator, path);
    bool fits = folder && list_add_folder(l, folder, is_wanted, 0);
    mem_free(folder);
    l->at = list_find(l, path);
    if (!fits || l->at == l->count)
        return fits && list_add_copy(l, path);
    char *as_given = copy_of(l, path); /* not ./path */
    if (as_given) {
        mem_free(l->names[l->at]);
        l->names[l->at] = as_given;
    }
    return as_given != NULL;
}

/* From the given paths: models as they are; of folders the models in them, or where there are none those
 * one or two folders below, by name. For a single model: those of its folder, with it as the current one.
 * False: out of memory. */
static bool list_models(view_list *l, const char *const *paths, uint32_t path_count)
{
    list_clear(l);
    if (path_count == 1 && !is_folder(paths[0]))
        return strcmp(paths[0], "-") == 0 ? list_add_copy(l, paths[0])
                                          : list_add_neighbours(l, paths[0], is_model);
    bool fits = true;
    for (uint32_t i = 0; fits && i < path_count; i++)
        fits = is_folder(paths[i]) ? list_add_folder(l, paths[i], is_model, MAX_DEPTH)
                                   : list_add_copy(l, paths[i]);
    return fits;
}

/* The names, followed by the environments in the folder of path (NULL: none), which is the current one. */
static bool list_environments(view_list *l, const char *const *names, uint32_t name_count, const char *path)
{
    list_clear(l);
    bool fits = true;
    for (uint32_t i = 0; fits && i < name_count; i++)
        fits = list_add_copy(l, names[i]);
    l->at = path ? list_find(l, path) : 0;
    if (fits && path && l->at == l->count)
        fits = list_add_neighbours(l, path, is_light);
    return fits;
}

/* Moves by that many steps, wrapping around, and returns the name; NULL: the list is empty. */
static const char *list_step(view_list *l, int steps)
{
    if (l->count == 0)
        return NULL;
    size_t at = l->at;
    if (at >= l->count)
        at = steps > 0 ? l->count - 1 : 0;
    size_t count = l->count;
    size_t forward = steps >= 0 ? (size_t)steps % count : count - (size_t)-steps % count;
    l->at = (at + forward) % count;
    return l->names[l->at];
}

/* ---- requests ---- */

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
    if (!list_models(&a->models, d->paths, d->path_count) ||
        !list_environments(&a->environments, d->environments, d->environment_count, d->environment))
        return fail_memory(error, "names", 0);
    if (d->path_count && a->models.count == 0)
        return fail(error, FACET_ERROR_READ, "%s: there is no .glb, .gltf or .obj file in it", d->paths[0]);
    const char *first = list_step(&a->models, 0);
    if (!view_load_request(a->loader, &(view_request){.wants_model = true,
                                                      .path = first,
                                                      .wants_environment = true,
                                                      .environment = d->environment}))
        return fail_memory(error, "names", 0);
    return FACET_OK;
}

void view_files_step_model(view_app *a, int steps)
{
    const char *path = list_step(&a->models, steps);
    if (path)
        request_model(a, path);
    else
        view_app_say(a, "Drop a model or a folder of models here", 4.0);
}

void view_files_step_environment(view_app *a, int steps)
{
    const char *name = list_step(&a->environments, steps);
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
    if (is_environment(path)) {
        list_environments(&a->environments, a->desc->environments, a->desc->environment_count, path);
        request(a, &(view_request){.wants_environment = true, .environment = path});
        return;
    }
    view_list dropped = {.allocator = a->desc->allocator};
    if (is_folder(path)) {
        const char *const paths[] = {path};
        if (!list_models(&dropped, paths, 1) || dropped.count == 0) {
            char text[512];
            snprintf(text, sizeof text, "%.400s: there is no model in this folder", path_base_name(path));
            view_app_say(a, text, 6.0);
            list_clear(&dropped);
            return;
        }
        list_clear(&a->models);
        a->models = dropped;
        path = list_step(&a->models, 0);
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
        list_models(&a->models, paths, 1);
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
    list_clear(&a->models);
    list_clear(&a->environments);
    a->host->environment_destroy(a->environment);
    a->host->scene_destroy(a->scene);
    free(a->path);
    free(a->environment_name);
}
