/* stl.h - STL files, as text and binary. */
#ifndef IO_STL_H
#define IO_STL_H

#include "scene/scene.h"

/* Whether bytes are one: "solid" with facets behind it, or the length that a binary file's number of triangles asks for
 * (whose header may begin with "solid", too). */
bool stl_detect(const void *bytes, size_t size);

/* Reads one as a scene: an object per solid, with the neutral material of obj_soup.h. Corners at the same place are one, and
 * smooth where edges bend less than 45 degrees (desc->obj_normals). The file's normals do not count, nor do the colors that
 * VisCAM and Magics put into binary files, in different ways. */
facet_result stl_load_memory(const void *bytes, size_t size, const char *name, const facet_scene_desc *desc,
                             facet_scene **scene, facet_error *error);

#endif
