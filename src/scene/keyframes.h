/* keyframes.h - animation samplers: the value at a point in time, and the times of all keys. */
#ifndef SCENE_KEYFRAMES_H
#define SCENE_KEYFRAMES_H

#include "scene/scene.h"

/* The value is the sum of factors times values of keys (pointers to sampler->width floats). */
typedef struct sampler_blend {
    uint32_t count; /* 1 to 4; 1: the value of a key, with factor 1 */
    const float *values[4];
    double factors[4];
} sampler_blend;

/* At time_s, finite: the first key's value before it, the last one's after it. is_rotation: values are
 * unit quaternions (width 4), linear keys are interpolated along the shorter great circle; the blend of
 * cubic keys is not unit. */
sampler_blend sampler_at(const scene_sampler *sampler, double time_s, bool is_rotation);

/* Component i of the value, [0, sampler->width). */
static inline double sampler_blend_value(const sampler_blend *blend, size_t i)
{
    double value = blend->factors[0] * (double)blend->values[0][i];
    for (uint32_t k = 1; k < blend->count; k++)
        value += blend->factors[k] * (double)blend->values[k][i];
    return value;
}

/* A rotation at time_s: a unit quaternion x y z w. False: the keys cancel. */
bool sampler_rotation_at(const scene_sampler *sampler, double time_s, float out[4]);

/* Times in ascending order. */
typedef struct keyframe_times {
    uint32_t count;
    double times[SCENE_FIT_TIMES];
} keyframe_times;

/* Every key of desc's animations (at least one, all valid) and 24 even steps per second; SCENE_FIT_TIMES
 * even steps from the first to the last key if there would be more. */
void keyframes_list_times(const facet_scene *scene, const facet_pose_desc *desc, keyframe_times *list);

#endif
