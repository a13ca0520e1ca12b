/* scene.c - the scene as an object: creation, warnings, lookups, placement. pose.c evaluates it. */
#include "scene/scene.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/index_table.h"
#include "base/result.h"

scene_material scene_material_default(void)
{
    scene_material m = {
        .name = "",
        .base_color = {1, 1, 1, 1},
        .metallic = 1.0f,
        .perceptual_roughness = 1.0f,
        .normal_scale = 1.0f,
        .occlusion_strength = 1.0f,
        .emissive_strength = 1.0f,
        .alpha_cutoff = 0.5f,
        .ior = 1.5f,
        .specular = 1.0f,
        .specular_color = {1, 1, 1},
        .glossiness = 1.0f,
        .clearcoat_normal_scale = 1.0f,
        .attenuation_distance = INFINITY,
        .attenuation_color = {1, 1, 1},
        .iridescence_ior = 1.3f,
        .iridescence_thickness_minimum = 100.0f,
        .iridescence_thickness_maximum = 400.0f,
        .diffuse_transmission_color = {1, 1, 1},
    };
    for (int i = 0; i < SCENE_TEXTURE_SLOT_COUNT; i++)
        m.textures[i] =
            (scene_texture_ref){.texture = SCENE_NONE, .scale = {1, 1}, .transform = {1, 0, 0, 0, 1, 0}};
    return m;
}

scene_node scene_node_default(const char *name)
{
    return (scene_node){.name = name,
                        .parent = SCENE_NONE,
                        .rotation = {0, 0, 0, 1},
                        .scale = {1, 1, 1},
                        .mesh = SCENE_NONE,
                        .camera = SCENE_NONE,
                        .light = SCENE_NONE,
                        .skin = SCENE_NONE};
}

void scene_texture_ref_update(scene_texture_ref *ref)
{
    float c = (float)cos((double)ref->rotation_rad);
    float s = (float)sin((double)ref->rotation_rad);
    const float transform[6] = {c * ref->scale[0],  s * ref->scale[1], ref->offset[0],
                                -s * ref->scale[0], c * ref->scale[1], ref->offset[1]};
    const float identity[6] = {1, 0, 0, 0, 1, 0};
    ref->has_transform = false;
    for (int i = 0; i < 6; i++) {
        ref->transform[i] = fabsf(transform[i]) <= FLT_MAX ? transform[i] : identity[i];
        ref->has_transform |= ref->transform[i] != identity[i];
    }
}

/* The scene with its growing lists of warnings and files, and the default material, at fixed addresses. */
typedef struct scene_store {
    facet_scene scene; /* first, as the public pointer refers to it */
    scene_material default_material;
    size_t warning_capacity, note_capacity;
    size_t file_capacity;
    index_table kept_files; /* scene.files with open bytes, by device and inode */
} scene_store;

/* The directory entries examined in a second or two. */
enum { SEARCH_BUDGET = 1 << 20 };

facet_result scene_create(const facet_allocator *allocator, const char *source, facet_scene **out,
                          facet_error *error)
{
    *out = NULL;
    scene_store *store = mem_zalloc(allocator, 1, sizeof *store);
    if (!store)
        return fail_memory(error, "scene", sizeof *store);
    facet_scene *scene = &store->scene;
    if (allocator)
        scene->allocator = *allocator;
    scene->search_budget = SEARCH_BUDGET;
    scene->arena = arena_create(allocator);
    scene->source = scene->arena ? arena_strdup(scene->arena, source) : NULL;
    if (!scene->source) {
        scene_destroy(scene);
        return fail_memory(error, "scene", sizeof *store);
    }
    scene->generator = scene->version = scene->copyright = "";
    scene->default_scene = SCENE_NONE;
    store->default_material = scene_material_default();
    *out = scene;
    return FACET_OK;
}

void scene_destroy(facet_scene *scene)
{
    if (!scene)
        return;
    for (uint32_t i = 0; i < scene->file_count; i++)
        file_close(&scene->files[i]);
    mem_free(scene->files);
    index_table_release(&((scene_store *)scene)->kept_files);
    mem_free(scene->warnings);
    mem_free(scene->notes);
    arena_destroy(scene->arena);
    mem_free(scene);
}

static uint32_t hash_file(uint64_t device, uint64_t number)
{
    const uint64_t known_by[2] = {device, number};
    return index_table_hash(INDEX_TABLE_HASH, known_by, sizeof known_by);
}

bool scene_keep_file(facet_scene *scene, file_bytes *file)
{
    scene_store *store = (scene_store *)scene;
    if (!mem_reserve(&scene->allocator, (void **)&scene->files, &store->file_capacity,
                     (size_t)scene->file_count + 1, sizeof *scene->files) ||
        (file->number && file->data &&
         !index_table_add(&store->kept_files, &scene->allocator, hash_file(file->device, file->number),
                          scene->file_count)))
        return false;
    scene->files[scene->file_count++] = *file;
    *file = (file_bytes){0};
    return true;
}

uint32_t scene_find_file(const facet_scene *scene, uint64_t device, uint64_t number)
{
    const index_table *kept = &((const scene_store *)scene)->kept_files;
    size_t cursor = 0;
    uint32_t i;
    do
        i = index_table_next(kept, hash_file(device, number), &cursor);
    while (i != SCENE_NONE && (scene->files[i].device != device || scene->files[i].number != number));
    return i;
}

bool scene_note_file(facet_scene *scene, const file_bytes *file)
{
    file_bytes known = {.device = file->device, .number = file->number};
    return scene_keep_file(scene, &known);
}

bool scene_has_file(const facet_scene *scene, const char *path)
{
    for (uint32_t i = 0; i < scene->file_count; i++)
        if (file_is_at(&scene->files[i], path))
            return true;
    return false;
}

/* A list of messages without duplicates. */
typedef struct message_list {
    const char ***texts;
    uint32_t *count;
    size_t *capacity;
} message_list;

/* Adds a message. False: it is a duplicate, or the list is full. */
static bool keep_message(facet_scene *scene, const message_list *list, char *message, size_t size)
{
    /* A limit, since a broken file can repeat a message for each of a million elements. */
    enum { MAX_MESSAGES = 1000 };
    if (*list->count >= MAX_MESSAGES)
        return false;
    for (uint32_t i = 0; i < *list->count; i++)
        if (strcmp((*list->texts)[i], message) == 0)
            return false;
    if (*list->count + 1 == MAX_MESSAGES)
        snprintf(message, size, "%s: has more to warn about; this is the last one", scene->source);
    const char *copy = arena_strdup(scene->arena, message);
    if (copy && mem_reserve(&scene->allocator, (void **)list->texts, list->capacity, (size_t)*list->count + 1,
                            sizeof **list->texts))
        (*list->texts)[(*list->count)++] = copy;
    return true;
}

void scene_warn(facet_scene *scene, const facet_log *log, const char *format, ...)
{
    char message[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    const message_list list = {&scene->warnings, &scene->warning_count,
                               &((scene_store *)scene)->warning_capacity};
    if (keep_message(scene, &list, message, sizeof message))
        log_warning(log, "%s", message);
}

void scene_note(facet_scene *scene, const facet_log *log, const char *format, ...)
{
    char message[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    const message_list list = {&scene->notes, &scene->note_count, &((scene_store *)scene)->note_capacity};
    if (keep_message(scene, &list, message, sizeof message))
        log_message(log, FACET_LOG_LEVEL_DETAIL, "%s", message);
}

const scene_material *scene_get_material(const facet_scene *scene, uint32_t index)
{
    if (index == SCENE_NONE)
        return &((const scene_store *)scene)->default_material;
    return &scene->materials[index];
}

/* ---- a model's place: a node above the roots of its default scene ---- */

static bool is_affine(const float m[16])
{
    for (int i = 0; i < 16; i++)
        if (!isfinite(m[i]))
            return false;
    return m[3] == 0.0f && m[7] == 0.0f && m[11] == 0.0f && m[15] == 1.0f;
}

/* The roots of the default scene; a file without scenes shows all nodes without a parent. False: no memory. */
static bool find_roots(facet_scene *s, scene_root *out)
{
    if (s->scene_count) {
        *out = s->scenes[s->default_scene == SCENE_NONE ? 0 : s->default_scene];
        return true;
    }
    uint32_t *nodes = arena_alloc(s->arena, (size_t)s->node_count + 1, sizeof *nodes);
    if (!nodes)
        return false;
    *out = (scene_root){.name = "", .nodes = nodes, .image_light = SCENE_NONE};
    for (uint32_t i = 0; i < s->node_count; i++)
        if (s->nodes[i].parent == SCENE_NONE)
            nodes[out->node_count++] = i;
    return true;
}

static facet_result add_root(facet_scene *s, facet_error *error)
{
    scene_root roots;
    bool fits = find_roots(s, &roots);
    scene_node *nodes = arena_alloc(s->arena, (size_t)s->node_count + 1, sizeof *nodes);
    scene_root *scenes = arena_alloc(s->arena, (size_t)s->scene_count + 1, sizeof *scenes);
    uint32_t *list = arena_alloc(s->arena, 1, sizeof *list);
    if (!fits || !nodes || !scenes || !list)
        return fail_memory(error, "a place for a model", ((size_t)s->node_count + 1) * sizeof *nodes);
    uint32_t own = s->node_count, index = s->default_scene == SCENE_NONE ? 0 : s->default_scene;
    if (own)
        memcpy(nodes, s->nodes, own * sizeof *nodes);
    if (s->scene_count)
        memcpy(scenes, s->scenes, s->scene_count * sizeof *scenes);
    for (uint32_t i = 0; i < roots.node_count; i++)
        nodes[roots.nodes[i]].parent = own;
    nodes[own] = scene_node_default("place");
    nodes[own].child_count = roots.node_count;
    nodes[own].children = roots.nodes;
    nodes[own].has_matrix = true;
    *list = own;
    scenes[index] = roots;
    scenes[index].nodes = list;
    scenes[index].node_count = 1;
    s->nodes = nodes;
    s->node_count++;
    s->scenes = scenes;
    s->scene_count += s->scene_count == 0;
    s->is_placed = true;
    memcpy(s->placed_origin, s->origin, sizeof s->origin);
    memset(s->origin, 0, sizeof s->origin);
    return FACET_OK;
}

facet_result scene_place(facet_scene *scene, const float matrix[16], facet_error *error)
{
    if (!is_affine(matrix))
        return fail(error, FACET_ERROR_ARGUMENT, "%s: a matrix whose last row is 0 0 0 1 was expected",
                    scene->source);
    if (!scene->is_placed)
        TRY(add_root(scene, error));
    dmat4 place;
    for (int i = 0; i < 16; i++)
        place.m[i] = (double)matrix[i];
    const double back[3] = {-scene->placed_origin[0], -scene->placed_origin[1], -scene->placed_origin[2]};
    dmat4 to_world = dmat4_translation(back);
    scene->nodes[scene->node_count - 1].matrix = dmat4_multiply(&place, &to_world);
    return FACET_OK;
}
