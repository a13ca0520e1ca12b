/* sea_kept.h - what modules keep with a sea from picture to picture, so that frames pay for what moves only: the first member of it. */
#ifndef OCEAN_SEA_KEPT_H
#define OCEAN_SEA_KEPT_H

#include <stdatomic.h>
#include <stddef.h>

typedef struct sea_kept {
    void (*destroy)(struct sea_kept *kept);
} sea_kept;

/* Whoever takes it has it alone; others who come meanwhile find none, make one of their own, and the last to be put back stays. So several
 * threads may draw one sea. */
typedef sea_kept *_Atomic sea_kept_place;

static inline sea_kept *sea_kept_take(sea_kept_place *place)
{
    return atomic_exchange(place, NULL);
}

static inline void sea_kept_put(sea_kept_place *place, sea_kept *kept) /* NULL is allowed */
{
    sea_kept *other = atomic_exchange(place, kept);
    if (other)
        other->destroy(other);
}

#endif
