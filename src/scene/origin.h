/* origin.h - models far from the origin of their file, as maps and plants have them.
 *
 * A float has 24 bits: at 1e6 m its steps are 1/16 m. So that such a model is drawn as it would be at the origin, all that
 * is drawn is relative to facet_scene.origin, a point near the model, which is subtracted in double before anything
 * becomes a float:
 *
 *   file's world = scene.origin + world        what a pose has: instances, lights, cameras, bounds; and facet_camera
 *   position in the file = mesh.origin + position        by mesh, as what is far may also be the vertices themselves
 *
 * Nodes keep the doubles of the file (scene_node), and hierarchy.h composes them in double where scene.is_far. Readers
 * and writers of numbers that people know (the command line, reports, files) add or subtract the origin.
 *
 * Near models have the origins 0 and worlds composed in float: near is what is not farther out than FAR_RATIO times its
 * size, where the steps of floats are 1/524288 of the model at most. */
#ifndef SCENE_ORIGIN_H
#define SCENE_ORIGIN_H

#include "scene/scene.h"

/* Sets the origins of a scene by the vertices that a pose shows (NULL: {0}, for a scene that was just read), but for what lies
 * apart from nine tenths of them, and makes positions relative to that of their mesh; their arrays are new then. The
 * origin of a scene that was placed stays. Warns, once, where positions have lost detail in the file. Fails as
 * scene_pose_create(). */
facet_result scene_settle_origin(facet_scene *scene, const facet_pose_desc *desc, const facet_log *log,
                                 facet_error *error);

/* The same for readers whose files have more digits than a float: where count positions, rounded to floats, lie. Non-zero:
 * what is to be subtracted from the file's numbers before they are rounded. False: nothing is, or no memory. */
bool scene_find_origin(const float *positions, size_t count, const facet_allocator *allocator,
                       double origin[3]);

#endif
