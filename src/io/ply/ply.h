/* ply.h - PLY files: text, and binary of either byte order. */
#ifndef IO_PLY_H
#define IO_PLY_H

#include "scene/scene.h"

/* Whether bytes begin like a PLY file. */
bool ply_detect(const void *bytes, size_t size);

/* Reads a PLY file as a scene, with the neutral material of obj_soup.h: faces and triangle strips, or,
 * without these, points. Reads normals, colors (8 or 16 bits, or floats to 1, sRGB unless desc->legacy
 * says linear; the constant term of Gaussian splats) and texture coordinates of vertices, texture
 * coordinates of faces, and the image of a comment "TextureFile". folder: of the file; NULL: from memory. */
facet_result ply_load_memory(const void *bytes, size_t size, const char *name, const char *folder,
                             const facet_scene_desc *desc, facet_scene **scene, facet_error *error);

#endif
