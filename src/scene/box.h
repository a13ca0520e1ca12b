/* box.h - axis-aligned boxes. */
#ifndef SCENE_BOX_H
#define SCENE_BOX_H

#include <float.h>
#include <math.h>

#include "scene/scene.h"

typedef struct box {
    float minimum[3], maximum[3];
} box;

/* Minimum above maximum, so that adding a point yields that point. */
static inline box box_empty(void)
{
    return (box){{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
}
static inline void box_add(box *b, const float p[3])
{
    for (int axis = 0; axis < 3; axis++) {
        b->minimum[axis] = p[axis] < b->minimum[axis] ? p[axis] : b->minimum[axis];
        b->maximum[axis] = p[axis] > b->maximum[axis] ? p[axis] : b->maximum[axis];
    }
}
static inline bool box_is_empty(const box *b)
{
    return b->minimum[0] > b->maximum[0];
}
static inline void box_join(box *b, const box *other)
{
    if (box_is_empty(other))
        return;
    box_add(b, other->minimum);
    box_add(b, other->maximum);
}
/* Whether all of it is within SCENE_FARTHEST; an empty box is not. */
static inline bool box_is_near(const box *b)
{
    for (int axis = 0; axis < 3; axis++)
        if (!(fabsf(b->minimum[axis]) <= SCENE_FARTHEST && fabsf(b->maximum[axis]) <= SCENE_FARTHEST))
            return false;
    return true;
}

/* Whether p is inside or on the surface. */
static inline bool box_holds(const box *b, const float p[3])
{
    for (int axis = 0; axis < 3; axis++)
        if (!(p[axis] >= b->minimum[axis] && p[axis] <= b->maximum[axis]))
            return false;
    return true;
}
static inline double box_diagonal(const box *b)
{
    double sum = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        double size = (double)b->maximum[axis] - (double)b->minimum[axis];
        sum += size * size;
    }
    return sqrt(sum);
}

#endif
