/* fuzz_draco.c - Draco bitstreams through the shim, and all queries of the result. */
#include "fuzz_support.h"

#include "io/gltf/draco_shim.h"

static void use_mesh(const draco_mesh *mesh)
{
    uint32_t faces = draco_shim_face_count(mesh);
    uint32_t points = draco_shim_point_count(mesh);
    uint32_t *corners = malloc(3 * (size_t)faces * sizeof *corners + 1);
    if (!corners)
        abort();
    draco_shim_copy_faces(mesh, corners);
    for (size_t i = 0; i < 3 * (size_t)faces; i++)
        if (corners[i] >= points)
            abort();
    free(corners);
    for (uint32_t id = 0; id < 8; id++) {
        size_t components = draco_shim_component_count(mesh, id);
        for (int type = DRACO_I8; components && type <= DRACO_F32; type++) {
            void *values = malloc(components * points * sizeof(float) + 1);
            if (!values)
                abort();
            draco_shim_copy_attribute(mesh, id, (draco_type)type, values);
            free(values);
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    facet_budget *budget = fuzz_begin((uint64_t)64 << 20);
    facet_allocator allocator = facet_budget_allocator(budget);
    const draco_limits limits = {.face_count = 10000, .point_count = 30000, .value_count = 1000000};
    char message[DRACO_MESSAGE] = "";
    draco_mesh *mesh = NULL;
    if (draco_shim_decode(data, size, &limits, &allocator, &mesh, message) == FACET_OK)
        use_mesh(mesh);
    else if (message[0] == 0)
        abort();
    draco_shim_destroy(mesh);
    fuzz_end(budget);
    return 0;
}
