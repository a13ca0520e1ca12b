/* pose_key.h - what a pose was made from, so that one that is kept is made again only where another one is asked for. */
#ifndef DRAW_POSE_KEY_H
#define DRAW_POSE_KEY_H

#include "facet/facet.h"

/* A facet_pose_desc with its own list. {0}: of no pose. */
typedef struct pose_key {
    bool is_set;
    facet_pose_desc desc;
    uint32_t *animations; /* what desc points to */
} pose_key;

/* Whether desc asks for the pose of the key. The time is that of no animation where there is none. */
bool pose_key_matches(const pose_key *key, const facet_pose_desc *desc);
/* Makes key that of desc. False: no memory, key is as it was. */
bool pose_key_set(pose_key *key, const facet_pose_desc *desc, const facet_allocator *allocator);
void pose_key_clear(pose_key *key); /* leaves {0} */

#endif
