/* stl.h - STL files, text and binary. */
#ifndef IO_STL_H
#define IO_STL_H

#include "scene/scene.h"

/* Whether bytes are an STL file: "solid" followed by facets, or the length that follows from a binary
 * file's number of triangles (its header may begin with "solid", too). */
bool stl_detect(const void *bytes, size_t size);

/* Reads an STL file as a scene: an object per solid, with the neutral material of obj_soup.h. Corners at
 * the same position are merged, and smooth where edges bend less than 45 degrees (desc->obj_normals). The
 * file's normals are ignored, and so are colors in binary files, for which VisCAM and Magics have
 * different conventions. */
facet_result stl_load_memory(const void *bytes, size_t size, const char *name, const facet_scene_desc *desc,
                             facet_scene **scene, facet_error *error);

#endif
