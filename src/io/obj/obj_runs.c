/* obj_runs.c - which object and material elements belong to: events of all chunks, one behind the other. */
#include <string.h>

#include "io/obj/obj_parse.h"

/* What the statements so far have set. Names are looked up when an element needs them. */
typedef struct state {
    obj_event object, group, material; /* text NULL: none */
    uint32_t smoothing;
    scene_mode mode;
    uint32_t object_number, material_number;
    bool is_object_known, is_material_known;
} state;

/* The arguments as one line: without backslashes that join lines, in place of which a blank stands. A block of
 * mem_alloc(). */
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

/* Looks up what the next element belongs to. */
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
        if (e->length == 0) { /* as the format has it */
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

/* Primitives by what they are made of. */
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
    run.out = p->count; /* until primitives have their places */
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

/* Triangles stand before lines, and those before points; in each the primitives as they come. */
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
        obj_names_get(&r->material_names, (uint32_t)i, &length);
    return length > 0;
}

/* Libraries first: usemtl may stand before mtllib. */
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

/* Elements before any usemtl have the material without a name: default values as well, since OBJ draws all surfaces from
 * both sides, which a primitive without a material would not be in glTF. */
static bool find_materials(obj_reader *r)
{
    size_t count = r->material_names.count;
    const char *first_unknown = NULL;
    size_t unknown = 0;
    r->material_numbers = mem_alloc(r->allocator, count, sizeof *r->material_numbers);
    if (!r->material_numbers)
        return obj_fail_memory(r, "materials", count * sizeof *r->material_numbers);
    for (size_t i = 0; i < count; i++) {
        size_t length;
        const char *name = obj_names_get(&r->material_names, (uint32_t)i, &length);
        r->material_numbers[i] = mtl_reader_find(r->materials, name, length);
        if (r->material_numbers[i] != SCENE_NONE)
            continue;
        r->material_numbers[i] = mtl_reader_add(r->materials, name, length);
        if (r->material_numbers[i] == SCENE_NONE)
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
