/* keyframes.c - see keyframes.h. */
#include "scene/keyframes.h"

#include <math.h>
#include <string.h>

/* ---- values between keys: glTF 2.0, appendix C, "Animation Sampler Interpolation Modes" ---- */

/* The last key not after time_s; 0 if there is none. */
static uint32_t find_key(const scene_sampler *sampler, double time_s)
{
    uint32_t low = 0;
    uint32_t high = sampler->key_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if ((double)sampler->times[middle] <= time_s)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Values of a key; part 0, 1, 2: in-tangent, value, out-tangent of a cubic spline. */
static const float *key_value(const scene_sampler *sampler, uint32_t key, size_t part)
{
    size_t width = sampler->width;
    if (sampler->interpolation == SCENE_CUBIC_SPLINE)
        return sampler->values + (3 * (size_t)key + part) * width;
    return sampler->values + key * width;
}

/* Cubic Hermite spline through the values, C.5 of the specification; tangents are per second. */
static sampler_blend cubic(const scene_sampler *sampler, uint32_t key, double t, double seconds)
{
    double t2 = t * t;
    double t3 = t2 * t;
    return (sampler_blend){
        .count = 4,
        .values = {key_value(sampler, key, 1), key_value(sampler, key, 2), key_value(sampler, key + 1, 1),
                   key_value(sampler, key + 1, 0)},
        .factors = {2.0 * t3 - 3.0 * t2 + 1.0, seconds * (t3 - 2.0 * t2 + t), 3.0 * t2 - 2.0 * t3,
                    seconds * (t3 - t2)},
    };
}

/* Shoemake 1985: sin((1 - t) a) / sin a and sin(t a) / sin a, with a the angle between the quaternions;
 * the sign of the second factor selects the shorter path. The angle comes from sum and difference, which
 * is equally precise near 0 and near 180 degrees. */
static void slerp_factors(const float *a, const float *b, double t, double factors[2])
{
    double dot = 0.0;
    for (int i = 0; i < 4; i++)
        dot += (double)a[i] * (double)b[i];
    double sign = dot < 0.0 ? -1.0 : 1.0;
    double sum = 0.0;
    double difference = 0.0;
    for (int i = 0; i < 4; i++) {
        double plus = (double)a[i] + sign * (double)b[i];
        double minus = (double)a[i] - sign * (double)b[i];
        sum += plus * plus;
        difference += minus * minus;
    }
    double angle = 2.0 * atan2(sqrt(difference), sqrt(sum));
    bool is_line = angle < 1e-7; /* sin a equals a to float precision */
    factors[0] = is_line ? 1.0 - t : sin((1.0 - t) * angle) / sin(angle);
    factors[1] = sign * (is_line ? t : sin(t * angle) / sin(angle));
}

sampler_blend sampler_at(const scene_sampler *sampler, double time_s, bool is_rotation)
{
    uint32_t key = find_key(sampler, time_s);
    double begin = (double)sampler->times[key];
    if (key + 1 == sampler->key_count || time_s <= begin || sampler->interpolation == SCENE_STEP)
        return (sampler_blend){.count = 1, .values = {key_value(sampler, key, 1)}, .factors = {1.0}};
    double seconds = (double)sampler->times[key + 1] - begin;
    double t = (time_s - begin) / seconds;
    if (sampler->interpolation == SCENE_CUBIC_SPLINE)
        return cubic(sampler, key, t, seconds);
    sampler_blend blend = {.count = 2,
                           .values = {key_value(sampler, key, 1), key_value(sampler, key + 1, 1)},
                           .factors = {1.0 - t, t}};
    if (is_rotation)
        slerp_factors(blend.values[0], blend.values[1], t, blend.factors);
    return blend;
}

bool sampler_rotation_at(const scene_sampler *sampler, double time_s, float out[4])
{
    sampler_blend blend = sampler_at(sampler, time_s, true);
    double q[4];
    double length = 0.0;
    for (size_t i = 0; i < 4; i++) {
        q[i] = sampler_blend_value(&blend, i);
        length += q[i] * q[i];
    }
    length = sqrt(length);
    if (!(length > 1e-30 && length < 1e30))
        return false;
    /* A key that is unit to float precision is kept unchanged. */
    if (blend.count == 1 && fabs(length - 1.0) < 4e-7)
        length = 1.0;
    for (int i = 0; i < 4; i++)
        out[i] = (float)(q[i] / length);
    return true;
}

/* ---- times ---- */

/* Adds a time unless one within `nearest` exists. False: the list is full. */
static bool add_time(keyframe_times *list, double time_s, double nearest)
{
    uint32_t low = 0;
    uint32_t high = list->count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (list->times[middle] < time_s)
            low = middle + 1;
        else
            high = middle;
    }
    if ((low < list->count && list->times[low] - time_s <= nearest) ||
        (low > 0 && time_s - list->times[low - 1] <= nearest))
        return true;
    if (list->count == SCENE_FIT_TIMES)
        return false;
    memmove(list->times + low + 1, list->times + low, (list->count - low) * sizeof *list->times);
    list->times[low] = time_s;
    list->count++;
    return true;
}

static bool add_keys(keyframe_times *list, const scene_animation *animation)
{
    const float *last = NULL; /* the channels of an animation often share their times */
    for (uint32_t i = 0; i < animation->sampler_count; i++) {
        const scene_sampler *sampler = &animation->samplers[i];
        for (uint32_t k = 0; k < sampler->key_count && sampler->times != last; k++)
            if (!add_time(list, (double)sampler->times[k], 0.0))
                return false;
        last = sampler->times;
    }
    return true;
}

void keyframes_list_times(const facet_scene *scene, const facet_pose_desc *desc, keyframe_times *list)
{
    const double steps_per_second = 24.0;
    const double same = 1e-4; /* s; a grid of 24 per second in float deviates less from one in double */
    double begin = HUGE_VAL;
    double end = -HUGE_VAL;
    bool is_ok = true;
    list->count = 0;
    for (uint32_t i = 0; i < desc->animation_count; i++) {
        const scene_animation *animation = &scene->animations[desc->animations[i]];
        begin = fmin(begin, (double)animation->begin_s);
        end = fmax(end, (double)animation->end_s);
        is_ok = is_ok && add_keys(list, animation);
    }
    double steps = fmin(fmax(1.0, ceil((end - begin) * steps_per_second - same)), SCENE_FIT_TIMES);
    for (uint32_t i = 0; is_ok && i <= (uint32_t)steps; i++)
        is_ok = add_time(list, begin + (end - begin) * (double)i / steps, same);
    if (is_ok)
        return;
    list->count = SCENE_FIT_TIMES;
    for (uint32_t i = 0; i < list->count; i++)
        list->times[i] = begin + (end - begin) * (double)i / (double)(list->count - 1);
}
