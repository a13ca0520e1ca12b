/* view_pace.c - see view_pace.h. */
#include "view/view_pace.h"

#include <math.h>

static const double slow_s = 0.05;

uint32_t view_pace_divisor(const view_pace *p, bool is_moving)
{
    if (!is_moving || p->full_s <= slow_s)
        return 1;
    return p->full_s <= 4.0 * slow_s ? 2 : 4;
}

/* No frame takes more than its pixels times what a pixel of a coarse one took. The first frame, in which the driver compiles, is
 * corrected so. */
void view_pace_measure(view_pace *p, uint32_t divisor, double seconds)
{
    double most = seconds * divisor * divisor;
    p->full_s = divisor == 1 ? seconds : fmin(p->full_s, most);
}
