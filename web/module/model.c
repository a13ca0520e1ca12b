/* model.c - opens models out of the table of files. */
#include <stdlib.h>
#include <string.h>

#include "base/result.h"
#include "files.h"
#include "scene/scene.h"
#include "viewer.h"

static facet_result load(viewer *v, const char *path, facet_shading shading, facet_scene **scene,
                         facet_error *error)
{
    const facet_scene_desc desc = {.log = web_viewer_log(v),
                                   .root = ".",
                                   .files = web_files_source(),
                                   .legacy = {.keeps_materials = shading == FACET_SHADING_OGL1}};
    v->message[0] = 0;
    TRY(*path ? facet_scene_load(path, &desc, scene, error)
              : facet_scene_create_builtin(&desc, scene, error));
    facet_result result = FACET_OK;
    if (shading == FACET_SHADING_OGL1)
        result =
            facet_scene_convert_materials(*scene, FACET_MATERIAL_MODEL_OGL1, &desc.legacy, &desc.log, error);
    if (result != FACET_OK)
        facet_scene_destroy(*scene);
    return result;
}

static facet_result find_bounds(const facet_scene *scene, const facet_pose_desc *desc, float low[3],
                                float high[3], facet_error *error)
{
    scene_pose pose;
    TRY(scene_pose_create(scene, desc, NULL, 1, &pose, error));
    memcpy(low, pose.bounds_min, sizeof pose.bounds_min);
    memcpy(high, pose.bounds_max, sizeof pose.bounds_max);
    scene_pose_destroy(&pose);
    return FACET_OK;
}

facet_result web_model_find_bounds(viewer *v, facet_error *error)
{
    return find_bounds(v->scene, &v->state.pose, v->state.low, v->state.high, error);
}

/* Begins to show a scene. The one before, and its renderer, are the caller's; where it fails nothing has changed. */
static facet_result show(viewer *v, facet_scene *scene, bool keeps_view, facet_error *error)
{
    float low[3], high[3];
    gl_renderer *renderer = NULL;
    const facet_view_model model = {.scene = scene, .orbit = scene_orbit_default()};
    const facet_pose_desc rest = {.has_scene_index = false};
    TRY(find_bounds(scene, keeps_view ? &v->state.pose : &rest, low, high, error));
    if (!v->context->is_lost)
        TRY(gl_renderer_create(scene, v->context, NULL, &renderer, error));
    v->renderer = renderer;
    v->scene = scene;
    view_state_set_model(&v->state, &model, low, high, keeps_view);
    return FACET_OK;
}

/* What a viewer shows; replaced as a whole. */
typedef struct shown {
    facet_scene *scene;
    gl_renderer *renderer;
    char *path;
    view_state state;
} shown;

static shown get_shown(const viewer *v)
{
    return (shown){v->scene, v->renderer, v->path, v->state};
}

static void destroy(shown *s)
{
    gl_renderer_destroy(s->renderer);
    facet_scene_destroy(s->scene);
    free(s->path);
}

static void put_back(viewer *v, shown *old)
{
    shown failed = get_shown(v);
    v->scene = old->scene;
    v->renderer = old->renderer;
    v->path = old->path;
    v->state = old->state;
    destroy(&failed);
}

facet_result web_model_open(viewer *v, const char *path, facet_error *error)
{
    facet_scene *scene;
    shown old = get_shown(v);
    char *copy = strdup(path);
    if (!copy)
        return fail_memory(error, "path", strlen(path));
    facet_result result = load(v, path, v->state.render.shading, &scene, error);
    if (result == FACET_OK) {
        result = show(v, scene, false, error);
        if (result != FACET_OK)
            facet_scene_destroy(scene);
    }
    if (result != FACET_OK) {
        free(copy);
        return result;
    }
    v->path = copy;
    result = web_options_open(v, error);
    if (result == FACET_OK)
        destroy(&old);
    else
        put_back(v, &old);
    return result;
}

facet_result web_model_reload(viewer *v, facet_shading shading, facet_error *error)
{
    facet_scene *scene;
    shown old = get_shown(v);
    if (!v->scene)
        return FACET_OK;
    TRY(load(v, v->path, shading, &scene, error));
    facet_result result = show(v, scene, true, error);
    if (result != FACET_OK) {
        facet_scene_destroy(scene);
        return result;
    }
    old.path = NULL; /* stays */
    destroy(&old);
    return FACET_OK;
}

void web_model_close(viewer *v)
{
    shown last = get_shown(v);
    v->renderer = NULL;
    v->scene = NULL;
    v->path = NULL;
    destroy(&last);
}
