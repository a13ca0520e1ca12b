/* gltf_draco_none.c - replaces gltf_draco.c in builds without the Draco library: uncompressed data beside the
 * bitstream is read, as the extension allows. */
#include "io/gltf/gltf_reader.h"

static bool has_elements(const io_reader *r, uint32_t accessor)
{
    const gltf_accessor *a = &r->gltf->accessors[accessor];
    return a->view != SCENE_NONE || a->sparse_count > 0;
}

bool gltf_prepare_draco(io_reader *r, const json_place *primitive)
{
    json_place extension = io_get_extension(r, primitive, "KHR_draco_mesh_compression");
    if (!extension.value)
        return io_is_ok(r);
    json_place attributes = io_get_object(r, primitive, "attributes");
    uint32_t indices = gltf_get_accessor(r, primitive, "indices");
    bool has_all = indices == SCENE_NONE || has_elements(r, indices);
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)attributes.value, name, value)
    {
        uint32_t accessor = gltf_get_accessor(r, &attributes, name);
        has_all = has_all && (accessor == SCENE_NONE || has_elements(r, accessor));
    }
    if (!has_all)
        io_fail(r, primitive, NULL, FACET_ERROR_UNSUPPORTED,
                "is compressed with Draco and has no other data; this facet was built without libdraco");
    return io_is_ok(r);
}

void gltf_release_draco(io_reader *r)
{
    (void)r;
}
