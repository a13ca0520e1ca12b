/* scene.c - the scene as an object: creation, warnings, lookups. parts.c places it, pose.c evaluates it. */
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
    facet_scene *appended;  /* scenes whose arrays this one uses, destroyed with it: a list, .. */
    facet_scene *next;      /* .. of which this one is an element */
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
    facet_scene *next;
    for (facet_scene *s = ((scene_store *)scene)->appended; s; s = next) {
        next = ((scene_store *)s)->next;
        scene_destroy(s);
    }
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

bool scene_keep_file(facet_scene *scene, file_bytes *file, const char *path)
{
    scene_store *store = (scene_store *)scene;
    const char *kept_path = arena_strdup(scene->arena, path);
    if (!kept_path ||
        !mem_reserve(&scene->allocator, (void **)&scene->files, &store->file_capacity,
                     (size_t)scene->file_count + 1, sizeof *scene->files) ||
        (file->number && file->data &&
         !index_table_add(&store->kept_files, &scene->allocator, hash_file(file->device, file->number),
                          scene->file_count)))
        return false;
    scene->files[scene->file_count] = *file;
    scene->files[scene->file_count++].path = kept_path;
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

bool scene_note_file(facet_scene *scene, const file_bytes *file, const char *path)
{
    file_bytes known = {.device = file->device, .number = file->number};
    return scene_keep_file(scene, &known, path);
}

bool scene_has_file(const facet_scene *scene, const char *path)
{
    for (uint32_t i = 0; i < scene->file_count; i++)
        if (file_is_at(&scene->files[i], path))
            return true;
    for (const facet_scene *s = ((const scene_store *)scene)->appended; s; s = ((const scene_store *)s)->next)
        if (scene_has_file(s, path))
            return true;
    return false;
}

/* The path of file *index, which it reduces by the files before that one. */
static const char *find_file(const facet_scene *scene, uint32_t *index)
{
    for (uint32_t i = 0; i < scene->file_count; i++)
        if (scene->files[i].number && (*index)-- == 0)
            return scene->files[i].path;
    const char *found = NULL;
    const facet_scene *s = ((const scene_store *)scene)->appended;
    for (; s && !found; s = ((const scene_store *)s)->next)
        found = find_file(s, index);
    return found;
}

const char *scene_get_file(const facet_scene *scene, uint32_t index)
{
    return find_file(scene, &index);
}

/* A list of messages without duplicates. */
typedef struct message_list {
    const char ***texts;
    uint32_t *count;
    size_t *capacity;
} message_list;

/* Keeps and logs a message, unless it is a duplicate or the list is full. */
static void report_once(facet_scene *scene, const facet_log *log, facet_log_level level,
                        const message_list *list, const char *format, va_list arguments)
{
    /* A limit, since a broken file can repeat a message for each of a million elements. */
    enum { MAX_MESSAGES = 1000 };
    char message[1024];
    vsnprintf(message, sizeof message, format, arguments);
    if (*list->count >= MAX_MESSAGES)
        return;
    for (uint32_t i = 0; i < *list->count; i++)
        if (strcmp((*list->texts)[i], message) == 0)
            return;
    if (*list->count + 1 == MAX_MESSAGES)
        snprintf(message, sizeof message, "%s: has more to warn about; this is the last one", scene->source);
    const char *copy = arena_strdup(scene->arena, message);
    if (copy && mem_reserve(&scene->allocator, (void **)list->texts, list->capacity, (size_t)*list->count + 1,
                            sizeof **list->texts))
        (*list->texts)[(*list->count)++] = copy;
    log_message(log, level, "%s", message);
}

void scene_warn(facet_scene *scene, const facet_log *log, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const message_list list = {&scene->warnings, &scene->warning_count,
                               &((scene_store *)scene)->warning_capacity};
    report_once(scene, log, FACET_LOG_LEVEL_WARNING, &list, format, arguments);
    va_end(arguments);
}

void scene_note(facet_scene *scene, const facet_log *log, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const message_list list = {&scene->notes, &scene->note_count, &((scene_store *)scene)->note_capacity};
    report_once(scene, log, FACET_LOG_LEVEL_DETAIL, &list, format, arguments);
    va_end(arguments);
}

void scene_keep_scene(facet_scene *scene, facet_scene *other)
{
    static const facet_log silent = {0};
    scene_store *store = (scene_store *)scene;
    ((scene_store *)other)->next = store->appended;
    store->appended = other;
    other->is_appended = true;
    for (uint32_t i = 0; i < other->warning_count; i++)
        scene_warn(scene, &silent, "%s", other->warnings[i]);
    for (uint32_t i = 0; i < other->note_count; i++)
        scene_note(scene, &silent, "%s", other->notes[i]);
}

const scene_material *scene_get_material(const facet_scene *scene, uint32_t index)
{
    if (index == SCENE_NONE)
        return &((const scene_store *)scene)->default_material;
    return &scene->materials[index];
}
