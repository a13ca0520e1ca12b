/* ply.h - PLY files: text, and binary of either byte order. */
#ifndef IO_PLY_H
#define IO_PLY_H

#include "scene/scene.h"

/* Whether bytes begin as one. */
bool ply_detect(const void *bytes, size_t size);

/* Reads one as a scene, with the neutral material of obj_soup.h: faces and triangle strips, without these its points.
 * Normals, colors (8 or 16 bits, or floats to 1, as a screen shows them unless desc->legacy says linear; the constant part
 * of Gaussian splats) and texture coordinates of vertices, texture coordinates of faces, and the image that a comment
 * "TextureFile" names. folder: of the file; NULL: from memory. */
facet_result ply_load_memory(const void *bytes, size_t size, const char *name, const char *folder,
                             const facet_scene_desc *desc, facet_scene **scene, facet_error *error);

#endif
