/* codec_client_draco.c - draco_shim.h by calls of the functions of the same names in the module "draco". */
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "codec_client.h"
#include "io/gltf/draco_shim.h"

/* A mesh in the memory of an instance, which stays open as long. */
struct draco_mesh {
    int instance;
    codec_address mesh;
    uint32_t face_count, point_count;
};

static facet_result fail_instance(int instance, char message[DRACO_MESSAGE])
{
    char reason[200];
    codec_explain("draco", instance, reason, sizeof reason);
    snprintf(message, DRACO_MESSAGE, "was not decoded: %s", reason);
    return instance ? FACET_ERROR_INVALID : FACET_ERROR_UNSUPPORTED;
}

static facet_result fail_memory_of(size_t size, char message[DRACO_MESSAGE])
{
    snprintf(message, DRACO_MESSAGE, "needs more memory than is available (%zu bytes)", size);
    return FACET_ERROR_MEMORY;
}

/* bytes and parameters are blocks in the module's memory. */
static facet_result decode(int instance, codec_address bytes, size_t size, codec_address parameters,
                           codec_address *mesh, char message[DRACO_MESSAGE])
{
    const codec_address out = parameters + sizeof(draco_limits), text = out + sizeof *mesh;
    const uint32_t arguments[] = {bytes, (uint32_t)size, parameters, 0 /* malloc */, out, text};
    uint32_t result;
    if (!codec_call(instance, "draco_shim_decode", arguments, 6, &result))
        return fail_instance(instance, message);
    codec_get(instance, out, mesh, sizeof *mesh);
    codec_get(instance, text, message, DRACO_MESSAGE);
    return (facet_result)result;
}

/* Calls a function whose first argument is the mesh; 0: the instance has failed. */
static uint32_t call(const draco_mesh *m, const char *function, uint32_t second, uint32_t third,
                     uint32_t fourth)
{
    const uint32_t arguments[] = {m->mesh, second, third, fourth};
    uint32_t result;
    return codec_call(m->instance, function, arguments, 4, &result) ? result : 0;
}

facet_result draco_shim_decode(const unsigned char *bytes, size_t size, const draco_limits *limits,
                               const facet_allocator *allocator, draco_mesh **out,
                               char message[DRACO_MESSAGE])
{
    *out = NULL;
    message[0] = 0;
    const int instance = codec_open("draco");
    if (!instance)
        return fail_instance(0, message);
    unsigned char block[sizeof *limits + sizeof(codec_address) + DRACO_MESSAGE] = {0};
    memcpy(block, limits, sizeof *limits);
    draco_mesh *made = mem_alloc(allocator, 1, sizeof *made);
    const codec_address input = made ? codec_put(instance, bytes, size) : 0,
                        parameters = input ? codec_put(instance, block, sizeof block) : 0;
    codec_address mesh = 0;
    facet_result result = parameters ? decode(instance, input, size, parameters, &mesh, message)
                                     : fail_memory_of(size, message);
    codec_release(instance, parameters);
    codec_release(instance, input);
    if (result == FACET_OK) {
        *made = (draco_mesh){.instance = instance, .mesh = mesh};
        made->face_count = call(made, "draco_shim_face_count", 0, 0, 0);
        made->point_count = call(made, "draco_shim_point_count", 0, 0, 0);
        *out = made;
    } else {
        mem_free(made);
        codec_close(instance);
    }
    return result;
}

void draco_shim_destroy(draco_mesh *mesh)
{
    if (!mesh)
        return;
    call(mesh, "draco_shim_destroy", 0, 0, 0);
    codec_close(mesh->instance);
    mem_free(mesh);
}

uint32_t draco_shim_face_count(const draco_mesh *mesh)
{
    return mesh->face_count;
}

uint32_t draco_shim_point_count(const draco_mesh *mesh)
{
    return mesh->point_count;
}

uint32_t draco_shim_component_count(const draco_mesh *mesh, uint32_t unique_id)
{
    return call(mesh, "draco_shim_component_count", unique_id, 0, 0);
}

void draco_shim_copy_faces(const draco_mesh *mesh, uint32_t *out)
{
    const size_t size = (size_t)draco_shim_face_count(mesh) * 3 * sizeof *out;
    const codec_address block = codec_reserve(mesh->instance, size);
    memset(out, 0, size);
    if (block) {
        call(mesh, "draco_shim_copy_faces", block, 0, 0);
        codec_get(mesh->instance, block, out, size);
    }
    codec_release(mesh->instance, block);
}

bool draco_shim_copy_attribute(const draco_mesh *mesh, uint32_t unique_id, draco_type type, void *out)
{
    static const uint8_t sizes[] = {
        [DRACO_I8] = 1, [DRACO_U8] = 1, [DRACO_I16] = 2, [DRACO_U16] = 2, [DRACO_U32] = 4, [DRACO_F32] = 4};
    const size_t size =
        (size_t)draco_shim_point_count(mesh) * draco_shim_component_count(mesh, unique_id) * sizes[type];
    const codec_address block = codec_reserve(mesh->instance, size);
    const bool is_copied =
        block && call(mesh, "draco_shim_copy_attribute", unique_id, (uint32_t)type, block) & 1;
    if (is_copied)
        codec_get(mesh->instance, block, out, size);
    codec_release(mesh->instance, block);
    return is_copied;
}
