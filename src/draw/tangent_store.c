/* tangent_store.c - see tangent_store.h. */
#include "draw/tangent_store.h"

#include <stdatomic.h>
#include <stdlib.h>

#include "base/parallel.h"
#include "base/result.h"

/* The set of texture coordinates that tangents follow; SCENE_NONE: none are needed. That of the normal
 * texture counts for all (KHR_materials_anisotropy, KHR_materials_clearcoat: one tangent space for a
 * material). */
static uint32_t tangent_texcoord(const render_geometry *g)
{
    if (g->legacy)
        return legacy_has_map(g->legacy, LEGACY_NORMAL_MAP) ? g->legacy->maps[LEGACY_NORMAL_MAP].ref.texcoord
                                                            : SCENE_NONE;
    const scene_material *m = g->material;
    if (scene_material_has(m, SCENE_NORMAL_TEXTURE))
        return m->textures[SCENE_NORMAL_TEXTURE].texcoord;
    if (scene_material_has(m, SCENE_CLEARCOAT_NORMAL_TEXTURE))
        return m->textures[SCENE_CLEARCOAT_NORMAL_TEXTURE].texcoord;
    if (!(m->extensions & SCENE_ANISOTROPY))
        return SCENE_NONE;
    return scene_material_has(m, SCENE_ANISOTROPY_TEXTURE) ? m->textures[SCENE_ANISOTROPY_TEXTURE].texcoord
                                                           : 0;
}

static bool needs_tangents(const render_geometry *g)
{
    return g->primitive->mode == SCENE_TRIANGLES && g->is_lit && (!g->tangents || g->has_corner_tangents) &&
           tangent_texcoord(g) < g->primitive->texcoord_count;
}

static tangent_entry key_of(const render_geometry *g)
{
    return (tangent_entry){.primitive = g->primitive,
                           .positions = g->positions,
                           .normals = g->normals,
                           .texcoord = tangent_texcoord(g)};
}

static int compare_entries(const void *a, const void *b)
{
    const tangent_entry *x = a;
    const tangent_entry *y = b;
    if (x->primitive != y->primitive)
        return (uintptr_t)x->primitive < (uintptr_t)y->primitive ? -1 : 1;
    if (x->positions != y->positions)
        return (uintptr_t)x->positions < (uintptr_t)y->positions ? -1 : 1;
    if (x->normals != y->normals)
        return (uintptr_t)x->normals < (uintptr_t)y->normals ? -1 : 1;
    return (x->texcoord > y->texcoord) - (x->texcoord < y->texcoord);
}

static tangent_entry *find(const tangent_store *store, const tangent_entry *key)
{
    if (store->count == 0)
        return NULL;
    return bsearch(key, store->entries, store->count, sizeof *key, compare_entries);
}

typedef struct tangent_jobs {
    const facet_allocator *allocator;
    tangent_entry *entries;
    _Atomic int result; /* the first facet_result that was not FACET_OK */
} tangent_jobs;

static void make_tangents(void *context, size_t begin, size_t end)
{
    tangent_jobs *jobs = context;
    for (size_t i = begin; i < end; i++) {
        tangent_entry *e = &jobs->entries[i];
        scene_primitive posed = *e->primitive;
        posed.positions = e->positions;
        posed.normals = e->normals;
        float *tangents = mem_alloc(jobs->allocator, posed.index_count, 4 * sizeof(float));
        facet_result result = FACET_ERROR_MEMORY;
        if (tangents)
            result = scene_generate_tangents(&posed, e->texcoord, jobs->allocator, tangents, NULL);
        if (result == FACET_OK) {
            e->tangents = tangents;
        } else {
            mem_free(tangents);
            atomic_store(&jobs->result, result);
        }
    }
}

/* Writes the missing entries, each once; returns their number. missing: room for all geometries that need
 * tangents. */
static size_t collect_missing(const tangent_store *store, const render_geometry_set *set,
                              tangent_entry *missing)
{
    size_t count = 0;
    for (uint32_t i = 0; i < set->count; i++) {
        if (!needs_tangents(&set->items[i]))
            continue;
        tangent_entry key = key_of(&set->items[i]);
        if (!find(store, &key))
            missing[count++] = key;
    }
    qsort(missing, count, sizeof *missing, compare_entries);
    size_t unique = 0;
    for (size_t i = 0; i < count; i++)
        if (i == 0 || compare_entries(&missing[i], &missing[unique - 1]) != 0)
            missing[unique++] = missing[i];
    return unique;
}

facet_result tangent_store_fill(tangent_store *store, render_geometry_set *set,
                                const facet_allocator *allocator, uint32_t thread_count, facet_error *error)
{
    size_t user_count = 0;
    for (uint32_t i = 0; i < set->count; i++)
        user_count += needs_tangents(&set->items[i]);
    if (user_count == 0)
        return FACET_OK;
    tangent_jobs jobs = {.allocator = allocator,
                         .entries = mem_alloc(allocator, user_count, sizeof *jobs.entries),
                         .result = FACET_OK};
    if (!jobs.entries)
        return fail_memory(error, "tangents", user_count * sizeof *jobs.entries);
    size_t missing_count = collect_missing(store, set, jobs.entries);
    if (!mem_reserve(allocator, (void **)&store->entries, &store->capacity, store->count + missing_count,
                     sizeof *store->entries)) {
        mem_free(jobs.entries);
        return fail_memory(error, "tangents", (store->count + missing_count) * sizeof *store->entries);
    }
    parallel_for(thread_count, missing_count, 1, make_tangents, &jobs);
    for (size_t i = 0; i < missing_count; i++)
        if (jobs.entries[i].tangents)
            store->entries[store->count++] = jobs.entries[i];
    mem_free(jobs.entries);
    if (store->count)
        qsort(store->entries, store->count, sizeof *store->entries, compare_entries);
    if (atomic_load(&jobs.result) != FACET_OK)
        return fail_memory(error, "tangents", missing_count * sizeof(float));
    for (uint32_t i = 0; i < set->count; i++) {
        if (!needs_tangents(&set->items[i]))
            continue;
        tangent_entry key = key_of(&set->items[i]);
        set->items[i].tangents = find(store, &key)->tangents;
        set->items[i].has_corner_tangents = true;
    }
    return FACET_OK;
}

void tangent_store_forget_deformed(tangent_store *store)
{
    size_t kept = 0;
    for (size_t i = 0; i < store->count; i++) {
        const tangent_entry *e = &store->entries[i];
        if (e->positions == e->primitive->positions && e->normals == e->primitive->normals)
            store->entries[kept++] = *e;
        else
            mem_free(e->tangents);
    }
    store->count = kept;
}

void tangent_store_destroy(tangent_store *store)
{
    for (size_t i = 0; i < store->count; i++)
        mem_free(store->entries[i].tangents);
    mem_free(store->entries);
    *store = (tangent_store){0};
}
