/* gltf_animation_pointer.c - the target of a JSON pointer (RFC 6901) of KHR_animation_pointer: translates
 * a location in the file to the location of floats in the scene, by the names of Khronos' object model. */
#include <stddef.h>
#include <string.h>

#include "io/gltf/gltf_reader.h"
#include "scene/material_table.h"

static const char NOTHING[] = "does not name an animatable property";

/* ---- the pointer as tokens ---- */

enum { MAX_TOKENS = 12 };

typedef struct pointer_path {
    char text[512];
    const char *tokens[MAX_TOKENS];
    size_t count;
} pointer_path;

/* Splits at '/', and undoes ~1 (a '/') and ~0 (a '~'). False: not a pointer, or longer than any with a
 * meaning. */
static bool split(const char *pointer, pointer_path *out)
{
    size_t used = 0;
    out->count = 0;
    if (pointer[0] != '/' || strlen(pointer) >= sizeof out->text)
        return false;
    for (const char *at = pointer; *at; at++) {
        if (*at == '/') {
            if (at > pointer)
                out->text[used++] = 0;
            if (out->count == MAX_TOKENS)
                return false;
            out->tokens[out->count++] = out->text + used;
        } else if (*at != '~') {
            out->text[used++] = *at;
        } else if (at[1] == '0' || at[1] == '1') {
            out->text[used++] = *++at == '0' ? '~' : '/';
        } else {
            return false;
        }
    }
    out->text[used] = 0;
    return true;
}

/* Whether the tokens from `from` on are exactly these; NULL matches any token. */
static bool matches(const pointer_path *p, size_t from, const char *const *names, size_t name_count)
{
    for (size_t i = 0; i < name_count; i++) {
        if (!names[i])
            continue;
        if (from >= p->count || strcmp(p->tokens[from], names[i]) != 0)
            return false;
        from++;
    }
    return from == p->count;
}

/* A token as an index below count, in the syntax of JSON pointers. */
static bool get_number(const pointer_path *p, size_t token, uint32_t count, uint32_t *out)
{
    const char *text = token < p->count ? p->tokens[token] : "";
    uint64_t number = 0;
    size_t length = strlen(text);
    if (length == 0 || length > 10 || (text[0] == '0' && length > 1))
        return false;
    for (size_t i = 0; i < length; i++) {
        if (text[i] < '0' || text[i] > '9')
            return false;
        number = 10 * number + (uint64_t)(text[i] - '0');
    }
    *out = (uint32_t)number;
    return number < count;
}

static void set(gltf_target *out, scene_target_kind kind, uint32_t index, size_t offset, uint32_t width)
{
    *out = (gltf_target){.channel = {.kind = kind, .index = index, .offset = offset, .scale = 1.0f},
                         .width = width};
}

/* ---- weights ---- */

/* All weights or one of them; index: of the node or the mesh. */
static const char *resolve_weights(const facet_scene *scene, const pointer_path *p, uint32_t index,
                                   uint32_t mesh, gltf_target *out)
{
    uint32_t count = mesh == SCENE_NONE ? 0 : scene->meshes[mesh].weight_count;
    uint32_t weight = 0;
    if (count == 0)
        return "names weights of a mesh without morph targets";
    if (p->count == 4 && !get_number(p, 3, count, &weight))
        return "names a weight that does not exist";
    if (p->count > 4)
        return NOTHING;
    set(out, SCENE_TARGET_WEIGHTS, index, weight, p->count == 3 ? count : 1);
    return NULL;
}

static const char *resolve_mesh(io_reader *r, const pointer_path *p, gltf_target *out)
{
    uint32_t index;
    if (!get_number(p, 1, r->scene->mesh_count, &index))
        return "names a mesh that does not exist";
    if (p->count < 3 || strcmp(p->tokens[2], "weights") != 0)
        return NOTHING;
    const char *message = resolve_weights(r->scene, p, index, index, out);
    out->is_of_mesh = true;
    return message;
}

/* ---- nodes ---- */

static const char *resolve_node(io_reader *r, const pointer_path *p, gltf_target *out)
{
    static const struct {
        const char *name;
        size_t offset;
        uint32_t width;
    } members[] = {{"translation", offsetof(scene_node, translation), 3},
                   {"rotation", offsetof(scene_node, rotation), 4},
                   {"scale", offsetof(scene_node, scale), 3}};
    static const char *const visible[] = {"extensions", "KHR_node_visibility", "visible"};
    uint32_t index;
    if (!get_number(p, 1, r->gltf->file_node_count, &index))
        return "names a node that does not exist";
    if (p->count >= 3 && strcmp(p->tokens[2], "weights") == 0)
        return resolve_weights(r->scene, p, index, r->scene->nodes[index].mesh, out);
    for (size_t i = 0; i < sizeof members / sizeof *members; i++)
        if (matches(p, 2, &members[i].name, 1)) {
            set(out, SCENE_TARGET_NODE, index, members[i].offset, members[i].width);
            out->channel.is_rotation = i == 1;
            return NULL;
        }
    if (!matches(p, 2, visible, 3))
        return NOTHING;
    set(out, SCENE_TARGET_VISIBLE, index, offsetof(scene_node, is_hidden), 1);
    out->needs_steps = true;
    return NULL;
}

/* ---- materials ---- */

/* Whether a material has the parameters of a table row. KHR_materials_pbrSpecularGlossiness replaces
 * metallic- roughness. */
static bool has_object(const scene_material *m, uint32_t extension, const char *object)
{
    if (extension)
        return (m->extensions & extension) != 0;
    return !*object || !(m->extensions & SCENE_SPECULAR_GLOSSINESS);
}

/* A texture of a material by the object and the key in the JSON. */
static scene_texture_slot find_slot(uint32_t extension, const char *object, const char *key)
{
    size_t slot = 0;
    while (slot < SCENE_TEXTURE_SLOT_COUNT && (material_textures[slot].extension != extension ||
                                               strcmp(material_textures[slot].object, object) != 0 ||
                                               strcmp(material_textures[slot].key, key) != 0))
        slot++;
    return (scene_texture_slot)slot;
}

static const char *resolve_parameter(const scene_material *m, const pointer_path *p, uint32_t index,
                                     gltf_target *out)
{
    for (size_t i = 0; i < MATERIAL_PARAMETER_COUNT; i++) {
        const material_parameter *row = &material_parameters[i];
        const char *names[] = {row->extension ? "extensions" : NULL, *row->object ? row->object : NULL,
                               row->texture, row->key};
        if (!matches(p, 2, names, 4))
            continue;
        if (!has_object(m, row->extension, row->object))
            return "names a property that the material lacks";
        if (row->texture && !scene_material_has(m, find_slot(row->extension, row->object, row->texture)))
            return "names a texture that the material lacks";
        if (row->extension == SCENE_IOR && m->ior == 0.0f)
            return "names an index of refraction of 0, which cannot be animated";
        set(out, SCENE_TARGET_MATERIAL, index, row->offset, row->count);
        return NULL;
    }
    return NOTHING;
}

/* KHR_texture_transform of one texture, at object and key in the JSON. */
static const char *resolve_transform(const scene_material *m, const pointer_path *p, uint32_t index,
                                     const material_texture *row, scene_texture_slot slot, gltf_target *out)
{
    static const struct {
        const char *name;
        size_t offset;
        uint32_t width;
    } members[] = {{"offset", offsetof(scene_texture_ref, offset), 2},
                   {"rotation", offsetof(scene_texture_ref, rotation_rad), 1},
                   {"scale", offsetof(scene_texture_ref, scale), 2}};
    for (size_t i = 0; i < sizeof members / sizeof *members; i++) {
        const char *names[] = {row->extension ? "extensions" : NULL,
                               *row->object ? row->object : NULL,
                               row->key,
                               "extensions",
                               "KHR_texture_transform",
                               members[i].name};
        if (!matches(p, 2, names, 6))
            continue;
        if (!has_object(m, row->extension, row->object) || !scene_material_has(m, slot))
            return "names a texture that the material lacks";
        set(out, SCENE_TARGET_MATERIAL, index,
            offsetof(scene_material, textures) + slot * sizeof(scene_texture_ref) + members[i].offset,
            members[i].width);
        return NULL;
    }
    return NOTHING;
}

static const char *resolve_material(io_reader *r, const pointer_path *p, gltf_target *out)
{
    static const material_texture diffuse = {SCENE_SPECULAR_GLOSSINESS, "KHR_materials_pbrSpecularGlossiness",
                                             "diffuseTexture", true};
    uint32_t index;
    if (!get_number(p, 1, r->scene->material_count, &index))
        return "names a material that does not exist";
    const scene_material *m = &r->scene->materials[index];
    const char *message = resolve_parameter(m, p, index, out);
    for (int slot = 0; message == NOTHING && slot < SCENE_TEXTURE_SLOT_COUNT; slot++)
        message = resolve_transform(m, p, index, &material_textures[slot], (scene_texture_slot)slot, out);
    return message == NOTHING ? resolve_transform(m, p, index, &diffuse, SCENE_BASE_COLOR_TEXTURE, out)
                              : message;
}

/* ---- lights and cameras ---- */

static const char *resolve_light(io_reader *r, const pointer_path *p, gltf_target *out)
{
    static const struct {
        const char *object, *name;
        size_t offset;
        uint32_t width;
    } members[] = {{NULL, "color", offsetof(scene_light, color), 3},
                   {NULL, "intensity", offsetof(scene_light, intensity), 1},
                   {NULL, "range", offsetof(scene_light, range), 1},
                   {"spot", "innerConeAngle", offsetof(scene_light, inner_cone_rad), 1},
                   {"spot", "outerConeAngle", offsetof(scene_light, outer_cone_rad), 1}};
    uint32_t index;
    if (!get_number(p, 3, r->scene->light_count, &index))
        return "names a light that does not exist";
    for (size_t i = 0; i < sizeof members / sizeof *members; i++) {
        const char *names[] = {members[i].object, members[i].name};
        if (!matches(p, 4, names, 2))
            continue;
        if (members[i].object && r->scene->lights[index].type != SCENE_LIGHT_SPOT)
            return "names the cone of a light without one";
        set(out, SCENE_TARGET_LIGHT, index, members[i].offset, members[i].width);
        return NULL;
    }
    return NOTHING;
}

static const char *resolve_camera(io_reader *r, const pointer_path *p, gltf_target *out)
{
    static const struct {
        const char *object, *name;
        size_t offset;
        float scale;
    } members[] = {{"perspective", "yfov", offsetof(scene_camera, fov_y_rad), 1},
                   {"perspective", "aspectRatio", offsetof(scene_camera, aspect), 1},
                   {"perspective", "znear", offsetof(scene_camera, near_m), 1},
                   {"perspective", "zfar", offsetof(scene_camera, far_m), 1},
                   {"orthographic", "xmag", offsetof(scene_camera, ortho_width), 2},
                   {"orthographic", "ymag", offsetof(scene_camera, ortho_height), 2},
                   {"orthographic", "znear", offsetof(scene_camera, near_m), 1},
                   {"orthographic", "zfar", offsetof(scene_camera, far_m), 1}};
    uint32_t index;
    if (!get_number(p, 1, r->scene->camera_count, &index))
        return "names a camera that does not exist";
    for (size_t i = 0; i < sizeof members / sizeof *members; i++) {
        const char *names[] = {members[i].object, members[i].name};
        if (!matches(p, 2, names, 2))
            continue;
        if ((strcmp(members[i].object, "orthographic") == 0) != r->scene->cameras[index].is_orthographic)
            return "names a lens that the camera lacks";
        set(out, SCENE_TARGET_CAMERA, index, members[i].offset, 1);
        out->channel.scale = members[i].scale;
        return NULL;
    }
    return NOTHING;
}

/* ---- the pointer ---- */

static const char *resolve_tokens(io_reader *r, const pointer_path *p, gltf_target *out)
{
    if (strcmp(p->tokens[0], "nodes") == 0)
        return resolve_node(r, p, out);
    if (strcmp(p->tokens[0], "meshes") == 0)
        return resolve_mesh(r, p, out);
    if (strcmp(p->tokens[0], "materials") == 0)
        return resolve_material(r, p, out);
    if (strcmp(p->tokens[0], "cameras") == 0)
        return resolve_camera(r, p, out);
    if (p->count > 3 && strcmp(p->tokens[0], "extensions") == 0 &&
        strcmp(p->tokens[1], "KHR_lights_punctual") == 0 && strcmp(p->tokens[2], "lights") == 0)
        return resolve_light(r, p, out);
    return NOTHING;
}

const char *gltf_resolve_pointer(io_reader *r, const char *pointer, gltf_target *out)
{
    pointer_path path;
    *out = (gltf_target){0};
    if (!split(pointer, &path))
        return "is not a JSON pointer";
    const char *message = resolve_tokens(r, &path, out);
    if (message)
        return message;
    out->channel.pointer = arena_strdup(r->scene->arena, pointer);
    if (!out->channel.pointer)
        io_fail_memory(r, "animation", strlen(pointer));
    return out->channel.pointer ? NULL : NOTHING;
}
