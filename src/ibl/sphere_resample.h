/* sphere_resample.h - radiance over the sphere from one picture or cube map to another, no light lost.
 *
 * A texel is the mean over its solid angle: of so many lookups, bilinear and seamless, that they are closer than the texels
 * of the source. That is a filter where the target is coarser and interpolation where it is finer; a constant stays
 * that, but for rounding. What is brighter than 16 times the mean, a sun of one texel maybe, would lose or gain some
 * thousandths, as few lookups weigh it: that part is scaled such that the solid angles which lookups take of it add up to
 * what it has in the source. So the mean over the sphere stays what it was, to 5e-5. */
#ifndef IBL_SPHERE_RESAMPLE_H
#define IBL_SPHERE_RESAMPLE_H

#include "ibl/sphere.h"

typedef struct sphere_turn {
    bool is_turned;
    float rows[3][3]; /* of a rotation or reflection: direction d of the target is rows d of the source */
    float scale;      /* of radiance */
    uint32_t
        parts; /* lookups per texel of the target in each direction; 0: closer than the texels of the source */
} sphere_turn;

/* Fills the texels of target (of a cube: not the borders; of pictures: the first three channels, a fourth becomes 1).
 * FACET_ERROR_MEMORY. */
facet_result sphere_resample(const sphere *source, const sphere_turn *turn /* NULL: as it is */,
                             const facet_allocator *allocator, uint32_t thread_count, const sphere *target,
                             facet_error *error);

#endif
