/* pose_key.c - see pose_key.h. */
#include "draw/pose_key.h"

#include <string.h>

#include "base/memory.h"

bool pose_key_matches(const pose_key *key, const facet_pose_desc *desc)
{
    const facet_pose_desc *a = &key->desc;
    if (!key->is_set || a->has_scene_index != desc->has_scene_index || a->has_variant != desc->has_variant ||
        a->animation_count != desc->animation_count)
        return false;
    if ((a->has_scene_index && a->scene_index != desc->scene_index) ||
        (a->has_variant && a->variant != desc->variant))
        return false;
    if (a->animation_count == 0)
        return true;
    return memcmp(&a->time_s, &desc->time_s, sizeof a->time_s) == 0 &&
           memcmp(a->animations, desc->animations, a->animation_count * sizeof *a->animations) == 0;
}

bool pose_key_set(pose_key *key, const facet_pose_desc *desc, const facet_allocator *allocator)
{
    uint32_t *animations = NULL;
    if (desc->animation_count) {
        animations = mem_alloc(allocator, desc->animation_count, sizeof *animations);
        if (!animations)
            return false;
        memcpy(animations, desc->animations, desc->animation_count * sizeof *animations);
    }
    mem_free(key->animations);
    *key = (pose_key){.is_set = true, .desc = *desc, .animations = animations};
    key->desc.animations = animations;
    return true;
}

void pose_key_clear(pose_key *key)
{
    mem_free(key->animations);
    *key = (pose_key){0};
}
