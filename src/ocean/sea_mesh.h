/* sea_mesh.h - a square of the sea and what lies below it as a scene, for programs that draw meshes. */
#ifndef OCEAN_SEA_MESH_H
#define OCEAN_SEA_MESH_H

#include "ocean/sea.h"

/* See facet_sea_create_mesh(). */
facet_result sea_mesh_create(const facet_sea *sea, const facet_sea_mesh_desc *desc, facet_scene **out,
                             facet_error *error);

#endif
