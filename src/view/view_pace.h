/* view_pace.h - how coarse a picture is drawn while the camera moves: where frames are slow, one that keeps up with the hand says
 * more than a sharp one that comes late. */
#ifndef VIEW_VIEW_PACE_H
#define VIEW_VIEW_PACE_H

#include <stdbool.h>
#include <stdint.h>

typedef struct view_pace {
    double full_s; /* that a frame in full resolution takes, or more; 0: unknown */
} view_pace;

/* By what width and height are divided: 1; 2 where frames take more than 50 ms, 4 where a half would, too. */
uint32_t view_pace_divisor(const view_pace *pace, bool is_moving);
/* A frame took this long. */
void view_pace_measure(view_pace *pace, uint32_t divisor, double seconds);

#endif
