/* identity.c - see identity.h. */
#include "scene/identity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/result.h"
#include "base/text.h"

/* ---- hashes ---- */

static uint32_t hash_bits(const char *name)
{
    uint32_t bits = murmur3(name, strlen(name), 0);
    uint32_t exponent = bits >> 23 & 255;
    return exponent == 0 || exponent == 255 ? bits ^ 1u << 23 : bits;
}

float scene_identity_hash(const char *name)
{
    uint32_t bits = hash_bits(name);
    float id;
    memcpy(&id, &bits, sizeof id);
    return id;
}

/* ---- names ---- */

static uint32_t count_copies(const scene_node *node)
{
    if (node->mesh == SCENE_NONE)
        return 0;
    return node->instancing ? node->instancing->count : 1;
}

static void add_object_name(const facet_scene *scene, uint32_t index, text *t)
{
    const scene_node *node = &scene->nodes[index];
    if (node->name[0])
        text_add(t, node->name);
    else if (node->mesh != SCENE_NONE && scene->meshes[node->mesh].name[0])
        text_add(t, scene->meshes[node->mesh].name);
    else
        text_addf(t, "node %u", index);
}

static void add_material_name(const facet_scene *scene, uint32_t number, text *t)
{
    if (number == 0)
        text_add(t, "default material");
    else if (scene->materials[number - 1].name[0])
        text_add(t, scene->materials[number - 1].name);
    else
        text_addf(t, "material %u", number - 1);
}

static void add_instance_name(const facet_scene *scene, uint32_t node, uint32_t number, text *t)
{
    add_object_name(scene, node, t);
    text_addf(t, "#%u", number);
}

/* ---- of a pose ---- */

/* Returns the text's hash and clears the text. */
static float take_hash(text *name)
{
    float id = name->has_failed ? 0.0f : scene_identity_hash(name->data);
    name->length = 0;
    return id;
}

static void identify(const facet_scene *scene, const scene_instance *instance, uint32_t first, text *name,
                     scene_identity *out)
{
    uint32_t material = instance->material == SCENE_NONE ? 0 : instance->material + 1;
    uint32_t number = first + instance->copy + 1;
    out->numbers[SCENE_IDENTITY_OBJECT] = (float)(instance->node + 1);
    out->numbers[SCENE_IDENTITY_MATERIAL] = (float)material;
    out->numbers[SCENE_IDENTITY_INSTANCE] = (float)number;
    add_object_name(scene, instance->node, name);
    out->hashes[SCENE_IDENTITY_OBJECT] = take_hash(name);
    add_material_name(scene, material, name);
    out->hashes[SCENE_IDENTITY_MATERIAL] = take_hash(name);
    add_instance_name(scene, instance->node, number, name);
    out->hashes[SCENE_IDENTITY_INSTANCE] = take_hash(name);
}

facet_result scene_identities_create(const facet_scene *scene, const scene_pose *pose,
                                     const facet_allocator *allocator, scene_identity **out,
                                     facet_error *error)
{
    text name = {.allocator = allocator ? *allocator : (facet_allocator){0}};
    scene_identity *made = mem_alloc(allocator, pose->instance_count, sizeof *made);
    uint32_t *first = mem_alloc(allocator, scene->node_count, sizeof *first); /* instances of earlier nodes */
    *out = NULL;
    bool has_memory = made && first;
    for (uint32_t i = 0, count = 0; has_memory && i < scene->node_count; i++) {
        first[i] = count;
        count += count_copies(&scene->nodes[i]);
    }
    for (uint32_t i = 0; has_memory && i < pose->instance_count; i++)
        identify(scene, &pose->instances[i], first[pose->instances[i].node], &name, &made[i]);
    has_memory = has_memory && !name.has_failed;
    text_destroy(&name);
    mem_free(first);
    if (!has_memory) {
        mem_free(made);
        return fail_memory(error, "identities", pose->instance_count * sizeof *made);
    }
    *out = made;
    return FACET_OK;
}

/* ---- manifests ---- */

/* Names, each with its terminating 0, and their offsets. */
typedef struct name_list {
    text text;
    size_t *starts;
    const char **names;
    size_t count, capacity;
} name_list;

static void end_name(name_list *list)
{
    text_add_bytes(&list->text, "", 1);
    list->count++;
}

/* The buffer of the next name. False: no memory. */
static bool begin_name(name_list *list)
{
    if (list->text.has_failed || !mem_reserve(&list->text.allocator, (void **)&list->starts, &list->capacity,
                                              list->count + 1, sizeof *list->starts))
        return false;
    list->starts[list->count] = list->text.length;
    return true;
}

static bool list_nodes(const facet_scene *scene, bool is_instances, name_list *list)
{
    uint32_t number = 0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        uint32_t copies = count_copies(&scene->nodes[i]);
        uint32_t names = is_instances || !copies ? copies : 1;
        for (uint32_t k = 0; k < names && list->count < SCENE_IDENTITY_MAX_NAMES; k++) {
            if (!begin_name(list))
                return false;
            if (is_instances)
                add_instance_name(scene, i, number + k + 1, &list->text);
            else
                add_object_name(scene, i, &list->text);
            end_name(list);
        }
        number += copies;
    }
    return !list->text.has_failed;
}

static bool has_default_material(const facet_scene *scene)
{
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++)
            if (scene->meshes[i].primitives[k].material == SCENE_NONE)
                return true;
    return false;
}

static bool list_materials(const facet_scene *scene, name_list *list)
{
    for (uint32_t number = has_default_material(scene) ? 0 : 1; number <= scene->material_count; number++) {
        if (!begin_name(list))
            return false;
        add_material_name(scene, number, &list->text);
        end_name(list);
    }
    return !list->text.has_failed;
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Equal names are one entry, as their ID is the same. */
static void write_names(name_list *list, text *manifest)
{
    for (size_t i = 0; i < list->count; i++)
        list->names[i] = list->text.data + list->starts[i];
    qsort(list->names, list->count, sizeof *list->names, compare_names);
    text_json_begin_object(manifest, NULL);
    for (size_t i = 0; i < list->count; i++) {
        char digits[9];
        if (i > 0 && strcmp(list->names[i], list->names[i - 1]) == 0)
            continue;
        snprintf(digits, sizeof digits, "%08x", hash_bits(list->names[i]));
        text_json_string(manifest, list->names[i], digits);
    }
    text_json_end_object(manifest);
}

facet_result scene_identity_manifest(const facet_scene *scene, scene_identity_kind kind,
                                     struct text *manifest, facet_error *error)
{
    name_list list = {.text = {.allocator = manifest->allocator}};
    bool has_memory = kind == SCENE_IDENTITY_MATERIAL
                          ? list_materials(scene, &list)
                          : list_nodes(scene, kind == SCENE_IDENTITY_INSTANCE, &list);
    if (has_memory)
        list.names = mem_alloc(&manifest->allocator, list.count, sizeof *list.names);
    if (has_memory && list.names)
        write_names(&list, manifest);
    has_memory = has_memory && list.names && !manifest->has_failed;
    text_destroy(&list.text);
    mem_free(list.starts);
    mem_free(list.names);
    return has_memory ? FACET_OK : fail_memory(error, "manifest", manifest->length);
}
