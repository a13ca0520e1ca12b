/* fit_times.c - see fit_times.h. */
#include "scene/fit_times.h"

#include <math.h>
#include <string.h>

/* Adds a time unless one within `nearest` exists. False: the list is full. */
static bool add_time(fit_times *list, double time_s, double nearest)
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

static bool add_keys(fit_times *list, const scene_animation *animation)
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

void fit_times_list(const facet_scene *scene, const facet_pose_desc *desc, fit_times *list)
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
