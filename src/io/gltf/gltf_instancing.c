/* gltf_instancing.c - EXT_mesh_gpu_instancing: where a node's mesh is drawn, again and again. Attributes of the file's
 * own (_ID, ..) say nothing that is drawn. */
#include <math.h>
#include <string.h>

#include "io/gltf/gltf_reader.h"

/* The accessor of one attribute, whose count must be that of the others; SCENE_NONE: none, or an error is recorded. */
static uint32_t get_instances(io_reader *r, const json_place *attributes, const char *name, gltf_type type,
                              uint32_t *count)
{
    uint32_t index = gltf_get_accessor(r, attributes, name);
    if (index == SCENE_NONE)
        return SCENE_NONE;
    const gltf_accessor *a = &r->gltf->accessors[index];
    bool is_signed = a->is_normalized && (a->component == GLTF_I8 || a->component == GLTF_I16);
    if (a->type != type || !(a->component == GLTF_F32 || (type == GLTF_VEC4 && is_signed))) {
        io_fail(r, attributes, name, FACET_ERROR_INVALID,
                "accessor %u has a type and componentType that %s of instances cannot have", index, name);
        return SCENE_NONE;
    }
    if (*count != SCENE_NONE && a->count != *count) {
        io_fail(r, attributes, name, FACET_ERROR_INVALID,
                "accessor %u has %u elements, but there are %u instances", index, a->count, *count);
        return SCENE_NONE;
    }
    *count = a->count;
    return index;
}

/* Unit quaternions, in a copy where some are not. */
static const float *get_rotations(io_reader *r, const json_place *at, uint32_t index)
{
    const gltf_accessor *a = &r->gltf->accessors[index];
    const float *in = gltf_get_finite(r, at, index, "rotations");
    if (!in || !io_spend(r, at, a->count))
        return NULL;
    bool is_unit = true;
    for (size_t i = 0; i < a->count && is_unit; i++) {
        const float *q = in + 4 * i;
        is_unit = fabsf(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1.0f) <= 1e-5f;
    }
    if (is_unit)
        return in;
    float *out = io_alloc_raw(r, "rotations", a->count, 4 * sizeof *out);
    if (!out)
        return NULL;
    memcpy(out, in, 4 * (size_t)a->count * sizeof *out);
    size_t far_off = 0;
    for (size_t i = 0; i < a->count; i++)
        far_off += fabs(gltf_normalize_rotation(out + 4 * i) - 1.0) > 0.01;
    if (far_off)
        io_warn(r, at, NULL, "%zu rotations of accessor %u are not of length 1", far_off, index);
    return out;
}

const scene_instancing *gltf_read_instancing(io_reader *r, const json_place *node)
{
    json_place extension = io_get_extension(r, node, "EXT_mesh_gpu_instancing");
    json_place attributes = io_get_object(r, &extension, "attributes");
    if (!extension.value || !io_is_ok(r))
        return NULL;
    uint32_t count = SCENE_NONE;
    uint32_t translation = get_instances(r, &attributes, "TRANSLATION", GLTF_VEC3, &count);
    uint32_t rotation = get_instances(r, &attributes, "ROTATION", GLTF_VEC4, &count);
    uint32_t scale = get_instances(r, &attributes, "SCALE", GLTF_VEC3, &count);
    if (!io_is_ok(r))
        return NULL;
    if (count == SCENE_NONE) {
        io_warn(r, &extension, "attributes", "has no TRANSLATION, ROTATION or SCALE; it is ignored");
        return NULL;
    }
    const uint32_t accessors[3] = {translation, rotation, scale};
    for (int i = 0; i < 3; i++)
        if (accessors[i] != SCENE_NONE && !gltf_has_accessor_source(r, accessors[i])) {
            io_warn(r, &attributes, NULL, "are in a buffer without bytes; the mesh is drawn once");
            return NULL;
        }
    scene_instancing *out = io_alloc(r, "instances", 1, sizeof *out);
    if (!out)
        return NULL;
    bool has_data = false;
    for (int i = 0; i < 3; i++)
        has_data |= accessors[i] != SCENE_NONE && !gltf_is_zero_accessor(r, accessors[i]);
    if (!has_data) { /* all zeros: where the node is, or of size 0 */
        static const float zeros[3] = {0, 0, 0};
        if (count > 1)
            io_warn(r, &attributes, NULL, "%u instances without data are at one place; one is drawn", count);
        *out = (scene_instancing){.count = count ? 1 : 0, .scales = scale != SCENE_NONE ? zeros : NULL};
        return out;
    }
    out->count = count;
    if (translation != SCENE_NONE)
        out->translations = gltf_get_finite(r, &attributes, translation, "translations");
    if (rotation != SCENE_NONE)
        out->rotations = get_rotations(r, &attributes, rotation);
    if (scale != SCENE_NONE)
        out->scales = gltf_get_finite(r, &attributes, scale, "scales");
    return io_is_ok(r) ? out : NULL;
}
