/* gltf_formats.c - which accessors may be which attribute of a vertex, and what attributes may be called (glTF 2.0
 * section 3.7.2, KHR_mesh_quantization). */
#include <stdio.h>
#include <string.h>

#include "io/gltf/gltf_reader.h"

/* ---- formats ---- */

enum { /* or-ed: component types, each plain or normalised */
       F32 = 1,
       NORMALIZED_UNSIGNED = 2,
       NORMALIZED_SIGNED = 4,
       PLAIN_UNSIGNED = 8,
       PLAIN_SIGNED = 16,
       ANY_INTEGER = NORMALIZED_UNSIGNED | NORMALIZED_SIGNED | PLAIN_UNSIGNED | PLAIN_SIGNED
};

static const struct {
    gltf_type type, other_type;
    unsigned formats, quantized_formats;
} RULES[] = {
    [GLTF_POSITION] = {GLTF_VEC3, GLTF_VEC3, F32, ANY_INTEGER},
    [GLTF_NORMAL] = {GLTF_VEC3, GLTF_VEC3, F32, NORMALIZED_SIGNED},
    [GLTF_TANGENT] = {GLTF_VEC4, GLTF_VEC4, F32, NORMALIZED_SIGNED},
    [GLTF_TEXCOORD] = {GLTF_VEC2, GLTF_VEC2, F32 | NORMALIZED_UNSIGNED, ANY_INTEGER},
    [GLTF_COLOR] = {GLTF_VEC3, GLTF_VEC4, F32 | NORMALIZED_UNSIGNED, 0},
    [GLTF_JOINTS] = {GLTF_VEC4, GLTF_VEC4, PLAIN_UNSIGNED, 0},
    [GLTF_WEIGHTS] = {GLTF_VEC4, GLTF_VEC4, F32 | NORMALIZED_UNSIGNED, 0},
    [GLTF_POSITION_DELTA] = {GLTF_VEC3, GLTF_VEC3, F32, NORMALIZED_SIGNED | PLAIN_SIGNED},
    [GLTF_NORMAL_DELTA] = {GLTF_VEC3, GLTF_VEC3, F32, NORMALIZED_SIGNED},
    [GLTF_TANGENT_DELTA] = {GLTF_VEC3, GLTF_VEC3, F32, NORMALIZED_SIGNED},
};

static unsigned format_of(const gltf_accessor *a)
{
    switch (a->component) {
    case GLTF_F32:
        return F32;
    case GLTF_U8:
    case GLTF_U16:
        return a->is_normalized ? NORMALIZED_UNSIGNED : PLAIN_UNSIGNED;
    case GLTF_I8:
    case GLTF_I16:
        return a->is_normalized ? NORMALIZED_SIGNED : PLAIN_SIGNED;
    default:
        return 0;
    }
}

uint32_t gltf_get_attribute(io_reader *r, const json_place *attributes, const char *name,
                            gltf_attribute attribute, uint32_t vertex_count)
{
    uint32_t index = gltf_get_accessor(r, attributes, name);
    if (index == SCENE_NONE)
        return SCENE_NONE;
    gltf_accessor *a = &r->gltf->accessors[index];
    /* Colors as plain integers are a common slip; normalised is the only thing they can mean. */
    if (attribute == GLTF_COLOR && format_of(a) == PLAIN_UNSIGNED && !a->floats) {
        io_warn(r, attributes, name, "accessor %u must be normalized; it is taken as if", index);
        a->is_normalized = true;
    }
    unsigned format = format_of(a);
    if ((a->type != RULES[attribute].type && a->type != RULES[attribute].other_type) ||
        !(format & (RULES[attribute].formats | RULES[attribute].quantized_formats))) {
        io_fail(r, attributes, name, FACET_ERROR_INVALID,
                "accessor %u has a type and componentType that %s cannot have", index, name);
        return SCENE_NONE;
    }
    if (!(format & RULES[attribute].formats) && !r->gltf->has_quantization)
        io_note(r, attributes, name,
                "accessor %u has a componentType that needs KHR_mesh_quantization, which the file does not "
                "declare",
                index);
    if (a->count != vertex_count) {
        io_fail(r, attributes, name, FACET_ERROR_INVALID, "accessor %u has %u elements, but POSITION has %u",
                index, a->count, vertex_count);
        return SCENE_NONE;
    }
    return index;
}

uint32_t gltf_count_sets(const json_place *attributes, const char *prefix)
{
    enum { MOST = 64 };
    char name[32];
    for (uint32_t count = 0; count < MOST; count++) {
        snprintf(name, sizeof name, "%s%u", prefix, count);
        if (!io_has_member(attributes, name))
            return count;
    }
    return MOST;
}

/* ---- names ---- */

bool gltf_is_read_attribute(const char *name)
{
    static const char *const read[] = {"POSITION", "NORMAL", "TANGENT", "COLOR_0"};
    for (size_t i = 0; i < sizeof read / sizeof *read; i++)
        if (strcmp(name, read[i]) == 0)
            return true;
    return strncmp(name, "TEXCOORD_", 9) == 0 || strncmp(name, "JOINTS_", 7) == 0 ||
           strncmp(name, "WEIGHTS_", 8) == 0;
}

void gltf_check_attribute_names(io_reader *r, const json_place *attributes)
{
    static const char *const numbered[] = {"TEXCOORD_", "COLOR_", "JOINTS_", "WEIGHTS_"};
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)attributes->value, name, value)
    {
        bool is_known = name[0] == '_' || strcmp(name, "POSITION") == 0 || strcmp(name, "NORMAL") == 0 ||
                        strcmp(name, "TANGENT") == 0;
        for (size_t i = 0; i < sizeof numbered / sizeof *numbered; i++) {
            size_t length = strlen(numbered[i]);
            if (strncmp(name, numbered[i], length) != 0)
                continue;
            unsigned number = 0;
            int used = 0;
            is_known = sscanf(name + length, "%3u%n", &number, &used) == 1 &&
                       name[length + (size_t)used] == 0 && (name[length] != '0' || used == 1);
            char previous[32];
            snprintf(previous, sizeof previous, "%s%u", numbered[i], number - 1);
            if (is_known && number > 0 && !io_has_member(attributes, previous))
                io_warn(r, attributes, name, "is there without %s", previous);
        }
        if (!is_known)
            io_note(r, attributes, name, "is no attribute of glTF and is ignored");
        if (!gltf_is_read_attribute(name) && io_is_ok(r)) {
            gltf_get_accessor(r, attributes, name);
            io_leave_out(r, "nothing reads it");
        }
        uint32_t accessor = io_peek_index(attributes, name, r->gltf->accessor_count);
        if (accessor != SCENE_NONE && r->gltf->accessors[accessor].component == GLTF_U32)
            io_note(r, attributes, name, "accessor %u has componentType 5125, which attributes cannot have",
                    accessor);
    }
}
