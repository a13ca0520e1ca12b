/* gltf_morph.c - morph targets (glTF 2.0 section 3.7.2.2): how much each moves positions, normals and tangents, and
 * with what weights. Targets may also move texture coordinates and colors, which viewers need not draw: a warning
 * names them. */
#include <string.h>

#include "io/gltf/gltf_reader.h"

static const struct {
    const char *name, *what;
    gltf_attribute attribute;
} DELTAS[3] = {
    {"POSITION", "changes of positions", GLTF_POSITION_DELTA},
    {"NORMAL", "changes of normals", GLTF_NORMAL_DELTA},
    {"TANGENT", "changes of tangents", GLTF_TANGENT_DELTA},
};

/* Every accessor that a target names must be there, and so must the attribute that it changes. */
static void check_target(io_reader *r, const json_place *target, const json_place *attributes)
{
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)target->value, name, value)
    {
        bool is_read = false;
        for (int i = 0; i < 3; i++)
            is_read |= strcmp(name, DELTAS[i].name) == 0;
        if (!is_read) {
            gltf_get_accessor(r, target, name);
            io_leave_out(r, "nothing reads it");
        }
        if (!io_has_member(attributes, name))
            io_note(r, target, name, "is not among the attributes of the primitive");
        else if (strncmp(name, "TEXCOORD_", 9) == 0 || strncmp(name, "COLOR_", 6) == 0)
            io_warn(r, target, name, "is not morphed");
        else if (!is_read && name[0] != '_')
            io_note(r, target, name, "is nothing that a morph target can change");
    }
}

static bool read_target(io_reader *r, const json_place *target, const scene_primitive *p,
                        scene_morph_target *out)
{
    const float **const arrays[3] = {&out->positions, &out->normals, &out->tangents};
    const bool is_used[3] = {true, p->normals != NULL, p->tangents != NULL};
    for (int i = 0; i < 3; i++) {
        uint32_t accessor =
            gltf_get_attribute(r, target, DELTAS[i].name, DELTAS[i].attribute, p->vertex_count);
        if (accessor == SCENE_NONE || !is_used[i] || gltf_is_zero_accessor(r, accessor))
            continue; /* what changes nothing takes no memory */
        if (!gltf_has_accessor_source(r, accessor))
            io_warn(r, target, DELTAS[i].name, "is in a buffer without bytes and changes nothing");
        else
            *arrays[i] = gltf_get_finite(r, target, accessor, DELTAS[i].what);
    }
    return io_is_ok(r);
}

bool gltf_read_targets(io_reader *r, const json_place *at, scene_primitive *p)
{
    json_place attributes = io_get_object(r, at, "attributes");
    json_place array = io_get_array(r, at, "targets");
    size_t count = io_get_count(&array);
    if (count == 0)
        return io_is_ok(r);
    scene_morph_target *targets = io_alloc(r, "morph targets", count, sizeof *targets);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place target = io_get_element_object(r, &array, i);
        check_target(r, &target, &attributes);
        if (io_is_ok(r))
            read_target(r, &target, p, &targets[i]);
        if (io_leave_out(r, "the morph target changes nothing"))
            targets[i] = (scene_morph_target){0};
    }
    p->targets = targets;
    p->target_count = (uint32_t)count;
    return io_is_ok(r);
}

const float *gltf_read_weights(io_reader *r, const json_place *object, uint32_t count)
{
    json_place array = io_get_array(r, object, "weights");
    if (!array.value)
        return NULL;
    size_t given = io_get_count(&array);
    if (given != count)
        io_warn(r, &array, NULL, "must be as many as there are morph targets, %u, but are %zu", count, given);
    if (count == 0 || !io_spend(r, &array, count))
        return NULL;
    float *all = mem_alloc(r->allocator, given, sizeof *all);
    float *out = io_alloc(r, "weights", count, sizeof *out);
    if (!all)
        io_fail_memory(r, "weights", given * sizeof *all);
    else if (out && io_get_floats(r, object, "weights", all, given))
        memcpy(out, all, (given < count ? given : count) * sizeof *out);
    mem_free(all);
    return out;
}
