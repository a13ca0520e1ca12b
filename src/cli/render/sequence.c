/* sequence.c - see sequence.h. Frames count from 1: frame n is (n - 1) / fps after the start of the
 * animation. An animation's frames are those before its end, so that a loop does not repeat its first
 * pose. */
#include "cli/render/sequence.h"

#include "cli/shared/failure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Chooses the animations: the named one, else the first one if a time or frames are given. */
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
    uint32_t count = all ? there : 1;
    out->animations = calloc(count, sizeof *out->animations);
    if (!out->animations)
        return fail(error, FACET_ERROR_MEMORY, "out of memory: animations");
    for (uint32_t i = 0; i < count; i++)
        out->animations[i] = i;
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
