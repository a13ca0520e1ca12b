/* draco_shim.h - C functions around the Draco library, which is C++: no exception leaves them. Only built
 * where the library is installed. */
#ifndef IO_DRACO_SHIM_H
#define IO_DRACO_SHIM_H

#include "facet/facet.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { DRACO_MESSAGE = 256 };

/* Limits of a mesh, compared with the counts in the bitstream before memory is allocated. */
typedef struct draco_limits {
    uint32_t face_count, point_count;
    uint64_t value_count; /* corners of faces plus components of all attributes of all points */
} draco_limits;

typedef struct draco_mesh draco_mesh;

/* Decodes a mesh without keeping references to bytes. Memory that the library allocates is estimated and
 * accounted to allocator. Fails with FACET_ERROR_INVALID, _LIMIT, _UNSUPPORTED or _MEMORY and a reason, as
 * in "ends too early". */
facet_result draco_shim_decode(const unsigned char *bytes, size_t size, const draco_limits *limits,
                               const facet_allocator *allocator, draco_mesh **out,
                               char message[DRACO_MESSAGE]);
void draco_shim_destroy(draco_mesh *mesh); /* NULL is allowed */

uint32_t draco_shim_face_count(const draco_mesh *mesh);
uint32_t draco_shim_point_count(const draco_mesh *mesh);
/* Components per point; 0: there is no attribute of that unique id. */
uint32_t draco_shim_component_count(const draco_mesh *mesh, uint32_t unique_id);

typedef enum draco_type { DRACO_I8, DRACO_U8, DRACO_I16, DRACO_U16, DRACO_U32, DRACO_F32 } draco_type;

/* Copies an attribute of all points, as many components as it has, in order. Integers become floats,
 * scaled to [0, 1] or [-1, 1] if the attribute is normalized. False: a value cannot be converted. */
bool draco_shim_copy_attribute(const draco_mesh *mesh, uint32_t unique_id, draco_type type, void *out);
/* Three points per face, all below draco_shim_point_count(). */
void draco_shim_copy_faces(const draco_mesh *mesh, uint32_t *out);

#ifdef __cplusplus
}
#endif
#endif
