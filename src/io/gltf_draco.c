/* gltf_draco.c - KHR_draco_mesh_compression: the primitives whose attributes and indices are in a bitstream. */
#include "io/gltf_reader.h"

bool prepare_draco(reader *r, const json_place *primitive)
{
    (void)primitive;
    return reader_is_ok(r);
}
