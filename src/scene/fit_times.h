/* fit_times.h - the times at which to sample a motion. */
#ifndef SCENE_FIT_TIMES_H
#define SCENE_FIT_TIMES_H

#include "scene/scene.h"

/* Times in ascending order. */
typedef struct fit_times {
    uint32_t count;
    double times[SCENE_FIT_TIMES];
} fit_times;

/* Every key of desc's animations (at least one, all valid) and 24 even steps per second; SCENE_FIT_TIMES
 * even steps from the first to the last key if there would be more. */
void fit_times_list(const facet_scene *scene, const facet_pose_desc *desc, fit_times *list);

#endif
