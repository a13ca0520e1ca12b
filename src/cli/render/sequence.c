/* sequence.c - see sequence.h. Frames count from 1: frame n is (n - 1) / fps after the start of the
 * animation. An animation's frames are those before its end, so that a loop does not repeat its first
 * pose. */
#include "cli/render/sequence.h"

#include "cli/shared/failure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Chooses the animations: the named one, else the first one, and those of external assets, if a time or frames are
 * given. */
static facet_result choose_animations(const facet_scene *scene, const char *name, const render_options *o,
                                      sequence *out, facet_error *error)
{
    bool wants_motion = o->animation || o->has_time || o->has_frames || o->has_fps;
    if (!wants_motion || (o->animation && strcmp(o->animation, "none") == 0))
        return FACET_OK;
    uint32_t there = facet_scene_get_counts(scene).animations;
    if (there == 0)
        return o->turntable && !o->animation
                   ? FACET_OK
                   : fail(error, FACET_ERROR_ARGUMENT, "%s: it has no animation for --%s", name,
                          o->animation  ? "animation"
                          : o->has_time ? "time"
                          : o->has_fps  ? "fps"
                                        : "frames");
    bool all = o->animation && strcmp(o->animation, "all") == 0;
    out->animations = calloc(there, sizeof *out->animations);
    if (!out->animations)
        return fail(error, FACET_ERROR_MEMORY, "out of memory: animations");
    uint32_t count = 0;
    for (uint32_t i = 0; i < there; i++)
        if (i == 0 || all || (!o->animation && facet_scene_get_animation(scene, i).is_external))
            out->animations[count++] = i;
    if (o->animation && !all) {
        facet_result result = facet_scene_find_animation(scene, o->animation, &out->animations[0], error);
        if (result != FACET_OK)
            return result;
    }
    out->pose.animation_count = count;
    out->pose.animations = out->animations;
    double begin = HUGE_VAL, end = -HUGE_VAL;
    for (uint32_t i = 0; i < count; i++) {
        facet_animation animation = facet_scene_get_animation(scene, out->animations[i]);
        begin = fmin(begin, animation.begin_s);
        end = fmax(end, animation.end_s);
    }
    out->begin_s = begin;
    out->duration_s = fmax(end - begin, 0.0);
    return FACET_OK;
}

static facet_result choose_frames(const char *name, const render_options *o, sequence *out,
                                  facet_error *error)
{
    out->turns = o->turntable;
    out->frame_s = 1.0 / o->fps;
    out->pose.time_s = o->has_time ? o->time_s : out->begin_s;
    out->moves = out->pose.animation_count && !o->has_time && o->is_sequence;
    double count = ceil(out->duration_s * o->fps - 1e-6);
    if (out->moves && !out->turns)
        out->frame_count_there = count > 1.0 ? (uint32_t)fmin(count, 4e9) : 1;
    if (o->has_frames)
        out->frames = o->frames;
    else if (o->turntable)
        out->frames = frame_list_all(1, o->turntable);
    else if (out->moves) {
        if (count > FRAME_LIST_FRAMES)
            return fail(
                error, FACET_ERROR_LIMIT,
                "%s: its animation takes %g s, which is more than %d frames at --fps %g; give --frames", name,
                out->duration_s, (int)FRAME_LIST_FRAMES, o->fps);
        out->frames = frame_list_all(1, out->turns ? out->turns : out->frame_count_there);
    } else {
        out->frames = frame_list_all(1, 1);
    }
    return FACET_OK;
}

facet_result sequence_create(facet_scene *scene, const char *name, const render_options *options,
                             sequence *out, facet_error *error)
{
    facet_result result = FACET_OK;
    *out = (sequence){
        .pose = {.has_scene_index = options->scene != NULL, .has_variant = options->variant != NULL}};
    if (options->scene)
        result = facet_scene_find_scene(scene, options->scene, &out->pose.scene_index, error);
    if (result == FACET_OK && options->variant)
        result = facet_scene_find_variant(scene, options->variant, &out->pose.variant, error);
    if (result == FACET_OK)
        result = choose_animations(scene, name, options, out, error);
    if (result == FACET_OK)
        result = choose_frames(name, options, out, error);
    if (result == FACET_OK && (options->scene || out->pose.animation_count > 0))
        result = facet_scene_choose_origin(scene, &out->pose, error);
    if (result != FACET_OK)
        sequence_destroy(out);
    return result;
}

void sequence_destroy(sequence *s)
{
    free(s->animations);
    *s = (sequence){0};
}

static sequence_frame frame_of(sequence *s, uint32_t number)
{
    sequence_frame frame = {.number = number};
    uint32_t passed = frame.number - 1;
    if (s->moves) {
        double time = passed * s->frame_s;
        /* the turntable sets the length: the animation repeats */
        if (s->turns && s->duration_s > 0.0)
            time = fmod(time, s->duration_s);
        s->pose.time_s = s->begin_s + time;
    }
    if (s->turns)
        frame.turn = (double)(passed % s->turns) / s->turns;
    return frame;
}

sequence_frame sequence_at(sequence *s, uint32_t index)
{
    return frame_of(s, frame_list_at(&s->frames, index));
}

sequence_frame sequence_first(sequence *s)
{
    return frame_of(s, 1);
}

/* ---- cameras ---- */

#define TWO_PI 6.283185307179586

static float aspect_of(const render_options *options)
{
    return (float)options->desc.width / (float)options->desc.height;
}

/* The target relative to the origin of the scene; coordinates that are not given are those of the
 * framing's center. */
static void resolve_target(const facet_scene *scene, const facet_pose_desc *pose,
                           const render_options *options, float target[3])
{
    facet_orbit orbit = options->orbit;
    facet_camera camera;
    double origin[3];
    orbit.has_target = false;
    orbit.is_orthographic = false;
    orbit.radius = 1.0f; /* only the center is needed */
    facet_camera_from_orbit(scene, pose, &orbit, aspect_of(options), &camera, NULL);
    facet_scene_get_origin(scene, origin);
    for (int i = 0; i < 3; i++)
        target[i] = options->has_target[i] ? (float)(options->target[i] - origin[i]) : camera.target[i];
}

facet_orbit render_orbit(const facet_scene *scene, const facet_pose_desc *pose, const render_options *options)
{
    facet_orbit orbit = options->orbit;
    orbit.has_target = options->has_target[0] || options->has_target[1] || options->has_target[2];
    if (orbit.has_target)
        resolve_target(scene, pose, options, orbit.target);
    return orbit;
}

static facet_orbit orbit_of_view(const facet_scene *scene, const render_view *view,
                                 const render_options *options)
{
    facet_orbit orbit = render_orbit(scene, view->pose, options);
    orbit.azimuth_rad += (float)(TWO_PI * view->turn);
    orbit.fits_all_azimuths = view->turns;
    orbit.fits_all_times = view->moves;
    return orbit;
}

static float distance(const float a[3], const float b[3])
{
    return hypotf(hypotf(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

/* A camera at --eye that looks at --target. */
static facet_result camera_from_eye(const facet_scene *scene, const facet_pose_desc *pose,
                                    const render_options *options, facet_camera *camera, facet_error *error)
{
    *camera = (facet_camera){.fov_y_rad = options->orbit.fov_y_rad};
    resolve_target(scene, pose, options, camera->target);
    double origin[3];
    facet_scene_get_origin(scene, origin);
    for (int i = 0; i < 3; i++)
        camera->eye[i] = (float)(options->eye[i] - origin[i]);
    float far_away = distance(camera->eye, camera->target);
    if (!(far_away > 0.0f))
        return fail(error, FACET_ERROR_ARGUMENT, "--eye: the camera is at its target (%.9g,%.9g,%.9g)",
                    options->eye[0], options->eye[1], options->eye[2]);
    if (options->orbit.is_orthographic) {
        camera->ortho_height = 2.0f * far_away * tanf(0.5f * camera->fov_y_rad);
        camera->fov_y_rad = 0.0f;
    }
    for (int i = 0; i < 3; i++)
        camera->up[i] = options->up[i];
    if (options->orbit.is_z_up) {
        bool looks_along_z = fabsf(camera->target[2] - camera->eye[2]) > 0.99999f * far_away;
        camera->up[looks_along_z ? 1 : 2] = 1.0f;
    }
    return FACET_OK;
}

facet_result render_camera(const facet_scene *scene, const render_view *view, const render_options *options,
                           facet_camera *camera, facet_error *error)
{
    if (options->camera) {
        uint32_t index;
        facet_result result = facet_scene_find_camera(scene, options->camera, &index, error);
        if (result != FACET_OK)
            return result;
        return facet_camera_from_scene(scene, view->pose, index, camera, error);
    }
    if (options->has_eye)
        return camera_from_eye(scene, view->pose, options, camera, error);
    facet_orbit orbit = orbit_of_view(scene, view, options);
    return facet_camera_from_orbit(scene, view->pose, &orbit, aspect_of(options), camera, error);
}

void render_keep_framing(render_options *options, const facet_scene *scene, const facet_camera *camera)
{
    facet_orbit *orbit = &options->orbit;
    double origin[3];
    if (options->camera || options->has_eye)
        return;
    facet_scene_get_origin(scene, origin);
    for (int i = 0; i < 3; i++) {
        options->target[i] = (double)camera->target[i] + origin[i];
        options->has_target[i] = true;
    }
    orbit->radius = orbit->is_orthographic ? 0.5f * camera->ortho_height / tanf(0.5f * orbit->fov_y_rad)
                                           : distance(camera->eye, camera->target);
}
