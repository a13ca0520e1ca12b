/* prepared_fixture.h - scenes at rest and in motion, rendered with a prepared scene, for its tests. */
#ifndef CPU_PREPARED_FIXTURE_H
#define CPU_PREPARED_FIXTURE_H

#include "cpu/prepared_scene.h"
#include "cpu/preview_fixture.h"

facet_result prepared_try(const fixture *f, prepared_scene *p, film *rendered, facet_render_stats *stats,
                          facet_error *error);
/* Renders with the prepared scene, and separately: both are the same. */
facet_render_stats prepared_compare(fixture *f, prepared_scene *p);

/* Textured spheres, lines, points, transparency. */
fixture prepared_still_scene(void);
void prepared_orbit(fixture *f, float angle, float distance);

/* Large enough that keeping the static part pays: a child rotates with its parent. */
fixture prepared_moving_scene(void);
scene_channel prepared_rotation_of(uint32_t node);
/* Keys of a rotation: quaternions at 0, 1 and 2 s. */
extern const float prepared_rotations[12];
/* Rotates a node (or animates its weight, or the color of a material) by keys, from 0 to 2 s. */
void prepared_animate(fixture *f, scene_channel channel);

#endif
