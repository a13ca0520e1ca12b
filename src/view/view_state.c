/* view_state.c - see view_state.h. */
#include "view/view_state.h"

#include <math.h>
#include <string.h>

#include "scene/scene.h"
#include "view/view_camera.h"

void view_state_create(view_state *s, const facet_view_desc *desc)
{
    *s = (view_state){.render = desc->render,
                      .path_samples = desc->path_samples,
                      .camera = VIEW_NO_CAMERA,
                      .speed = 1.0,
                      .help_pages = 1,
                      .scale = 1.0f,
                      .divider = {.position = 0.5},
                      .orbit = scene_orbit_default()};
    facet_render_desc *r = &s->render; /* what belongs to the window */
    r->allocator = desc->allocator;
    r->log = desc->log;
    r->progress = (facet_progress){0};
    r->camera = NULL;
    r->environment = NULL;
    r->pose = (facet_pose_desc){0};
    memset(r->crop, 0, sizeof r->crop);
    r->aovs = 0;
}

/* ---- the model ---- */

void view_state_set_animations(view_state *s, const uint32_t *animations, uint32_t count)
{
    count = count < VIEW_MAX_ANIMATIONS ? count : VIEW_MAX_ANIMATIONS;
    s->begin_s = HUGE_VAL;
    s->end_s = -HUGE_VAL;
    for (uint32_t i = 0; i < count; i++) {
        const scene_animation *a = &s->scene->animations[animations[i]];
        s->animations[i] = animations[i];
        s->begin_s = fmin(s->begin_s, (double)a->begin_s);
        s->end_s = fmax(s->end_s, (double)a->end_s);
    }
    s->pose.animation_count = count;
    s->pose.animations = s->animations;
}

/* The pose of a model that was shown before, as far as the one that was read now has what it refers to. */
static void keep_pose(view_state *s, const facet_pose_desc *old)
{
    const facet_scene_counts *c = &s->counts;
    uint32_t kept[VIEW_MAX_ANIMATIONS];
    uint32_t count = 0;
    for (uint32_t i = 0; i < old->animation_count; i++)
        if (s->animations[i] < c->animations)
            kept[count++] = s->animations[i];
    s->pose = *old;
    s->pose.has_variant = old->has_variant && old->variant < c->variants;
    s->pose.has_scene_index = old->has_scene_index && old->scene_index < c->scenes;
    view_state_set_animations(s, kept, count);
    s->is_playing = s->is_playing && count > 0;
    if (s->camera >= (int)c->cameras)
        s->camera = VIEW_NO_CAMERA;
}

void view_state_set_model(view_state *s, const facet_view_model *model, const float low[3],
                          const float high[3], bool keeps_view)
{
    facet_pose_desc old = s->pose;
    s->scene = model->scene;
    s->counts = scene_count(model->scene);
    memcpy(s->low, low, sizeof s->low);
    memcpy(s->high, high, sizeof s->high);
    if (keeps_view) {
        keep_pose(s, &old);
        return;
    }
    uint32_t animations[VIEW_MAX_ANIMATIONS];
    uint32_t count =
        model->animation_count < VIEW_MAX_ANIMATIONS ? model->animation_count : VIEW_MAX_ANIMATIONS;
    for (uint32_t i = 0; i < count; i++)
        animations[i] = model->first_animation + i;
    s->pose = model->pose;
    view_state_set_animations(s, animations, count);
    s->is_playing = model->is_playing && count > 0;
    s->orbit = s->home = model->orbit;
    s->camera = model->has_camera ? (int)model->camera : VIEW_NO_CAMERA;
    if (model->has_eye) {
        float middle[3];
        for (int i = 0; i < 3; i++)
            middle[i] = 0.5f * low[i] + 0.5f * high[i];
        s->orbit = view_camera_orbit(&model->eye, &model->orbit, middle);
        s->needs_framing = s->is_framed = false;
        return;
    }
    s->needs_framing = true;
}

/* ---- time, and the picture ---- */

bool view_state_advance(view_state *s, double seconds)
{
    if (!s->is_playing || !(seconds > 0.0))
        return false;
    double length = s->end_s - s->begin_s;
    double time = s->pose.time_s - s->begin_s + seconds * s->speed;
    s->pose.time_s = s->begin_s + (length > 0.0 ? fmod(time, length) : 0.0);
    return true;
}

facet_render_desc view_state_desc(const view_state *s, uint32_t width, uint32_t height, facet_camera *camera)
{
    facet_render_desc desc = s->render;
    desc.width = desc.crop[2] = width;
    desc.height = desc.crop[3] = height;
    desc.pose = s->pose;
    desc.pose.time_s = round(s->pose.time_s * 1e4) / 1e4;
    facet_orbit orbit = view_camera_round(&s->orbit);
    *camera = s->camera == VIEW_NO_CAMERA
                  ? view_camera_of(&orbit, (float)width / (float)height, s->low, s->high)
                  : s->file_camera;
    desc.camera = camera;
    return desc;
}
