/* nearest_copies.h - of many instances of a mesh, those that decide how fine its textures have to be. */
#ifndef CPU_NEAREST_COPIES_H
#define CPU_NEAREST_COPIES_H

#include "draw/render_geometry.h"

/* Enough to cover the pixels that count, also where some are hidden or turned away. */
enum { NEAREST_COPIES = 64 };

/* Sets is_far_copy of instances of shapes that more than NEAREST_COPIES share: of those in the picture of
 * width x height pixels, that many whose surface is seen largest stay, at least one. Counting the triangles of 100 000 copies takes
 * seconds, and says no more. Fails with FACET_ERROR_MEMORY. */
facet_result nearest_copies_choose(render_geometry_set *set, const camera_rays *camera, uint32_t width,
                                   uint32_t height, const facet_allocator *allocator, facet_error *error);

#endif
