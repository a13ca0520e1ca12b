/* origin.h - models far from the origin of their file, such as maps and plants.
 *
 * A float has 24 bits: at 1e6 m its steps are 1/16 m. So that such a model is rendered as if it were at
 * the origin, everything drawn is relative to facet_scene.origin, a point near the model that is
 * subtracted in double before anything becomes a float:
 *
 *     file's world = scene.origin + world        for a pose: instances, lights, cameras, bounds; and facet_camera
 *     position in the file = mesh.origin + position        per mesh, as the vertices themselves may be far
 *
 * Nodes keep the doubles of the file (scene_node), and hierarchy.h composes them in double if
 * scene.is_far. Code that shows or accepts coordinates (the command line, reports, files) adds or
 * subtracts the origin.
 *
 * Near models have origin 0 and worlds composed in float: near means within FAR_RATIO times the model's
 * size, where the steps of floats are at most 1/524288 of the model. */
#ifndef SCENE_ORIGIN_H
#define SCENE_ORIGIN_H

#include "scene/scene.h"

/* Sets the origins of a scene from the vertices that a pose shows (NULL: {0}, for a scene that was just
 * read), ignoring outliers beyond nine tenths of them, and makes positions relative to the origin of their
 * mesh, in new arrays. The origin of a scene that was placed stays. Warns, once, if positions have lost
 * detail in the file. Fails as scene_pose_create(). */
facet_result scene_settle_origin(facet_scene *scene, const facet_pose_desc *desc, const facet_log *log,
                                 facet_error *error);

/* The same for readers whose files have more digits than a float, from count positions rounded to floats.
 * Non-zero: the origin to subtract from the file's numbers before they are rounded. False: none, or no
 * memory. */
bool scene_find_origin(const float *positions, size_t count, const facet_allocator *allocator,
                       double origin[3]);

#endif
