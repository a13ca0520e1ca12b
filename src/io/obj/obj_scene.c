/* obj_scene.c - objects and materials: the names in the file, numbered in order of appearance; the runs of
 * elements that belong to one object and material, from the events of all chunks in order; and at the end
 * nodes and meshes, one of each per object, with its primitives. */
#include <string.h>

#include "base/utf8.h"
#include "io/obj/obj_parse.h"
#include "io/obj/obj_reader.h"

/* ---- names ---- */

struct obj_name {
    size_t offset; /* in bytes */
    uint32_t size;
};

uint32_t obj_names_add(obj_names *names, const void *bytes, size_t size, bool *is_new)
{
    uint32_t hash = index_table_hash(INDEX_TABLE_HASH, bytes, size);
    size_t cursor = 0;
    *is_new = false;
    for (uint32_t i; (i = index_table_next(&names->table, hash, &cursor)) != INDEX_TABLE_NONE;)
        if (names->names[i].size == size && memcmp(names->bytes + names->names[i].offset, bytes, size) == 0)
            return i;
    if (names->count >= UINT32_MAX - 1 || size >= UINT32_MAX ||
        !mem_reserve(&names->allocator, (void **)&names->bytes, &names->byte_capacity, names->size + size + 1,
                     1) ||
        !mem_reserve(&names->allocator, (void **)&names->names, &names->capacity, names->count + 1,
                     sizeof *names->names) ||
        !index_table_add(&names->table, &names->allocator, hash, (uint32_t)names->count))
        return UINT32_MAX;
    names->names[names->count] = (struct obj_name){.offset = names->size, .size = (uint32_t)size};
    memcpy(names->bytes + names->size, bytes, size);
    names->size += size;
    names->bytes[names->size++] = 0;
    *is_new = true;
    return (uint32_t)names->count++;
}

static const char *names_get(const obj_names *names, uint32_t number, size_t *size)
{
    *size = names->names[number].size;
    return names->bytes + names->names[number].offset;
}

void obj_names_release(obj_names *names)
{
    mem_free(names->names);
    mem_free(names->bytes);
    index_table_release(&names->table);
    *names = (obj_names){.allocator = names->allocator};
}

/* ---- runs ---- */

/* The state that statements set. Names are looked up when an element needs them. */
typedef struct state {
    obj_event object, group, material; /* text NULL: none */
    uint32_t smoothing;
    scene_mode mode;
    uint32_t object_number, material_number;
    bool is_object_known, is_material_known;
} state;

/* The arguments as one line, with blanks in place of line continuations. A block of mem_alloc(). */
static char *join_lines(const obj_event *e, const facet_allocator *allocator, size_t *length)
{
    char *joined = mem_alloc(allocator, (size_t)e->length + 1, 1);
    *length = 0;
    for (const char *p = e->text; joined && p < e->text + e->length;) {
        const char *behind = *p == '\\' ? obj_skip_continuation(p) : p;
        joined[(*length)++] = behind == p ? *p : ' ';
        p = behind == p ? p + 1 : behind;
    }
    return joined;
}

static bool is_joined(const obj_event *e)
{
    return e->length && memchr(e->text, '\\', e->length) != NULL;
}

static bool number_name(obj_reader *r, obj_names *names, const obj_event *e, uint32_t *number)
{
    bool is_new;
    if (is_joined(e)) {
        size_t length;
        char *joined = join_lines(e, r->allocator, &length);
        *number = joined ? obj_names_add(names, joined, length, &is_new) : UINT32_MAX;
        mem_free(joined);
    } else {
        *number = obj_names_add(names, e->text ? e->text : "", e->length, &is_new);
    }
    return *number != UINT32_MAX || obj_fail_memory(r, "names", e->length);
}

/* Looks up object and material of the next element. */
static bool know_names(obj_reader *r, state *s)
{
    if (!s->is_object_known) {
        if (!number_name(r, &r->objects, r->has_object ? &s->object : &s->group, &s->object_number))
            return false;
        s->is_object_known = true;
    }
    if (!s->is_material_known) {
        if (!number_name(r, &r->material_names, &s->material, &s->material_number))
            return false;
        s->is_material_known = true;
    }
    return true;
}

static void apply(state *s, const obj_event *e)
{
    switch (e->kind) {
    case OBJ_OBJECT:
        s->object = *e;
        s->is_object_known = false;
        break;
    case OBJ_GROUP:
        s->group = *e;
        if (e->length == 0) { /* the default of the format */
            s->group.text = "default";
            s->group.length = 7;
        }
        s->is_object_known = false;
        break;
    case OBJ_MATERIAL:
        s->material = *e;
        s->is_material_known = false;
        break;
    case OBJ_SMOOTHING:
        s->smoothing = e->value;
        break;
    case OBJ_MODE:
        s->mode = (scene_mode)e->value;
        break;
    case OBJ_LIBRARY:
        break;
    }
}

static size_t corners_per(scene_mode mode)
{
    return mode == SCENE_TRIANGLES ? 3 : mode == SCENE_LINES ? 2 : 1;
}

/* ---- primitives ---- */

/* Primitives by object, material and mode. */
typedef struct primitive_key {
    uint32_t object, material, mode;
} primitive_key;

typedef struct listing {
    obj_reader *r;
    obj_names keys;
    size_t capacity;
} listing;

static bool find_primitive(listing *l, const state *s, uint32_t *number)
{
    obj_reader *r = l->r;
    const primitive_key key = {s->object_number, s->material_number, s->mode};
    bool is_new;
    *number = obj_names_add(&l->keys, &key, sizeof key, &is_new);
    if (*number == UINT32_MAX)
        return obj_fail_memory(r, "primitives", sizeof key);
    if (!is_new)
        return true;
    if (!mem_reserve(r->allocator, (void **)&r->primitives, &l->capacity, (size_t)r->primitive_count + 1,
                     sizeof *r->primitives))
        return obj_fail_memory(r, "primitives", ((size_t)r->primitive_count + 1) * sizeof *r->primitives);
    r->primitives[r->primitive_count++] = (obj_primitive){
        .object = key.object, .material = key.material, .mode = s->mode, .v_minimum = UINT32_MAX};
    return true;
}

/* Elements between two events. */
static bool add_run(listing *l, state *s, const obj_event *from, const obj_event *to)
{
    obj_reader *r = l->r;
    obj_run run = {.element = from->element, .element_end = to->element, .corner = from->corner};
    if (run.element == run.element_end)
        return true;
    if (!know_names(r, s) || !find_primitive(l, s, &run.primitive))
        return false;
    if (!mem_reserve(r->allocator, (void **)&r->runs, &r->run_capacity, r->run_count + 1, sizeof *r->runs))
        return obj_fail_memory(r, "groups", (r->run_count + 1) * sizeof *r->runs);
    obj_primitive *p = &r->primitives[run.primitive];
    run.smoothing = s->smoothing;
    run.out = p->count; /* until the order of primitives is known */
    p->count += corners_per(p->mode) * (size_t)(to->triangle_count - from->triangle_count);
    r->runs[r->run_count++] = run;
    return true;
}

static bool list_chunk(listing *l, obj_chunk *c, state *s)
{
    obj_event from = {.element = 0};
    const obj_event end = {.element = (uint32_t)c->sizes.count, .triangle_count = c->triangle_count};
    c->run_begin = l->r->run_count;
    for (size_t i = 0; i <= c->event_count; i++) {
        const obj_event *e = i < c->event_count ? &c->events[i] : &end;
        if (!add_run(l, s, &from, e))
            return false;
        if (i < c->event_count)
            apply(s, e);
        from = *e;
    }
    c->run_end = l->r->run_count;
    return true;
}

/* Orders primitives: triangles, lines, points; each in order of appearance. */
static bool place_primitives(obj_reader *r)
{
    static const scene_mode modes[] = {SCENE_TRIANGLES, SCENE_LINES, SCENE_POINTS};
    for (size_t m = 0; m < sizeof modes / sizeof *modes; m++) {
        for (uint32_t i = 0; i < r->primitive_count; i++)
            if (r->primitives[i].mode == modes[m]) {
                r->primitives[i].begin = r->corner_count;
                r->corner_count += r->primitives[i].count;
            }
        if (modes[m] == SCENE_TRIANGLES)
            r->triangle_corner_count = r->corner_count;
    }
    for (size_t i = 0; i < r->run_count; i++)
        r->runs[i].out += r->primitives[r->runs[i].primitive].begin;
    return r->corner_count < UINT32_MAX || obj_fail_limit(r, "corners of triangles");
}

/* ---- materials ---- */

static bool has_named_material(const obj_reader *r)
{
    size_t length = 0;
    for (size_t i = 0; i < r->material_names.count && length == 0; i++)
        names_get(&r->material_names, (uint32_t)i, &length);
    return length > 0;
}

/* Libraries first, since usemtl may precede mtllib. */
static bool load_libraries(obj_reader *r)
{
    for (size_t i = 0; i < r->chunk_count; i++)
        for (size_t k = 0; k < r->chunks[i].event_count; k++) {
            const obj_event *e = &r->chunks[i].events[k];
            if (e->kind != OBJ_LIBRARY || e->length == 0)
                continue;
            size_t length;
            char *joined = join_lines(e, r->allocator, &length);
            if (!joined)
                return obj_fail_memory(r, "names", e->length);
            facet_result result = mtl_reader_load(r->materials, joined, length, r->error);
            mem_free(joined);
            if (result != FACET_OK) {
                r->result = result;
                return false;
            }
        }
    r->result = mtl_reader_settle(r->materials, has_named_material(r), r->error);
    return obj_is_ok(r);
}

/* Elements before any usemtl have the material without a name, which has default values as well: OBJ draws
 * all surfaces two-sided, unlike a glTF primitive without a material. */
static bool find_materials(obj_reader *r)
{
    size_t count = r->material_names.count;
    const char *first_unknown = NULL;
    size_t unknown = 0;
    r->material_indices = mem_alloc(r->allocator, count, sizeof *r->material_indices);
    if (!r->material_indices)
        return obj_fail_memory(r, "materials", count * sizeof *r->material_indices);
    for (size_t i = 0; i < count; i++) {
        size_t length;
        const char *name = names_get(&r->material_names, (uint32_t)i, &length);
        r->material_indices[i] = mtl_reader_find(r->materials, name, length);
        if (r->material_indices[i] != SCENE_NONE)
            continue;
        r->material_indices[i] = mtl_reader_add(r->materials, name, length);
        if (r->material_indices[i] == SCENE_NONE)
            return obj_fail_memory(r, "materials", length);
        if (length > 0)
            first_unknown = unknown++ ? first_unknown : name;
    }
    if (unknown == 1)
        scene_warn(r->scene, &r->desc->log,
                   "%s: material \"%.200s\" is in no library; it gets default values", r->scene->source,
                   first_unknown);
    else if (unknown > 1)
        scene_warn(r->scene, &r->desc->log,
                   "%s: material \"%.200s\" and %zu more are in no library; they get default values",
                   r->scene->source, first_unknown, unknown - 1);
    return true;
}

void obj_make_runs(obj_reader *r)
{
    listing l = {.r = r, .keys = {.allocator = *r->allocator}};
    state s = {.object_number = 0};
    bool is_ok = true;
    for (size_t i = 0; i < r->chunk_count && is_ok; i++)
        is_ok = list_chunk(&l, &r->chunks[i], &s);
    obj_names_release(&l.keys);
    if (is_ok && place_primitives(r) && load_libraries(r))
        find_materials(r);
}

/* ---- nodes and meshes ---- */

static void *take(obj_reader *r, size_t count, size_t size)
{
    void *block = arena_zalloc(r->scene->arena, count, size);
    if (!block)
        obj_fail_memory(r, "nodes", count * size);
    return block;
}

char *obj_copy_name(obj_reader *r, const char *bytes, size_t size)
{
    const char *end = size ? memchr(bytes, 0, size) : NULL;
    size = end ? (size_t)(end - bytes) : size;
    char *copy = arena_alloc(r->scene->arena, 2 * size + 1, 1);
    if (copy)
        copy[utf8_from_latin1(bytes, size, copy)] = 0;
    else
        obj_fail_memory(r, "names", 2 * size + 1);
    return copy;
}

static scene_primitive make_primitive(const obj_reader *r, const obj_primitive *p, const float **texcoords)
{
    scene_primitive out = {
        .mode = p->mode,
        .vertex_count = p->vertex_count,
        .index_count = (uint32_t)p->count,
        .indices = r->indices + p->begin,
        .positions = p->positions,
        .normals = p->normals,
        .colors = p->colors,
        .material = p->material == SCENE_NONE ? SCENE_NONE : r->material_indices[p->material],
        .has_flat_normals = p->has_flat_normals,
    };
    memcpy(out.bounds_min, p->bounds_min, sizeof out.bounds_min);
    memcpy(out.bounds_max, p->bounds_max, sizeof out.bounds_max);
    if (p->texcoords) {
        *texcoords = p->texcoords;
        out.texcoord_count = 1;
        out.texcoords = texcoords;
    }
    return out;
}

/* The mesh of an object, in the order of first primitives; SCENE_NONE: it has none. */
static uint32_t *number_meshes(obj_reader *r)
{
    uint32_t *meshes = mem_alloc(r->allocator, r->objects.count, sizeof *meshes);
    if (!meshes) {
        obj_fail_memory(r, "meshes", r->objects.count * sizeof *meshes);
        return NULL;
    }
    memset(meshes, 0xff, r->objects.count * sizeof *meshes);
    for (uint32_t i = 0; i < r->primitive_count; i++) {
        uint32_t *mesh = &meshes[r->primitives[i].object];
        if (*mesh == SCENE_NONE)
            *mesh = r->scene->mesh_count++;
    }
    return meshes;
}

/* Groups the primitives by mesh, each group in order of appearance. */
static void make_meshes(obj_reader *r, const uint32_t *indices)
{
    facet_scene *scene = r->scene;
    scene->meshes = take(r, scene->mesh_count, sizeof *scene->meshes);
    scene_primitive *primitives = take(r, r->primitive_count, sizeof *primitives);
    const float **texcoords = take(r, r->primitive_count, sizeof *texcoords);
    if (!obj_is_ok(r))
        return;
    for (uint32_t i = 0; i < r->primitive_count; i++)
        scene->meshes[indices[r->primitives[i].object]].primitive_count++;
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        scene->meshes[i].primitives = primitives;
        primitives += scene->meshes[i].primitive_count;
        scene->meshes[i].primitive_count = 0;
    }
    for (uint32_t i = 0; i < r->primitive_count; i++) {
        const obj_primitive *p = &r->primitives[i];
        scene_mesh *mesh = &scene->meshes[indices[p->object]];
        mesh->primitives[mesh->primitive_count++] = make_primitive(r, p, texcoords++);
        if (!mesh->name) {
            size_t size;
            const char *name = names_get(&r->objects, p->object, &size);
            mesh->name = obj_copy_name(r, name, size);
            if (!mesh->name)
                return;
        }
    }
}

static void make_nodes(obj_reader *r)
{
    facet_scene *scene = r->scene;
    scene->nodes = take(r, scene->mesh_count, sizeof *scene->nodes);
    scene->scenes = take(r, 1, sizeof *scene->scenes);
    uint32_t *roots = take(r, scene->mesh_count, sizeof *roots);
    if (!obj_is_ok(r))
        return;
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        roots[i] = i;
        scene->nodes[i] = scene_node_default(scene->meshes[i].name);
        memcpy(scene->nodes[i].translation, r->origin, sizeof r->origin);
        scene->nodes[i].mesh = i;
    }
    scene->node_count = scene->mesh_count;
    scene->scenes[0] =
        (scene_root){.name = "", .node_count = scene->node_count, .nodes = roots, .image_light = SCENE_NONE};
    scene->scene_count = 1;
    scene->default_scene = 0;
}

void obj_make_scene(obj_reader *r)
{
    uint32_t *indices = number_meshes(r);
    if (indices)
        make_meshes(r, indices);
    if (obj_is_ok(r))
        make_nodes(r);
    mem_free(indices);
}
