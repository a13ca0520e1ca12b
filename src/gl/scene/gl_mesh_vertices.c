/* gl_mesh_vertices.c - see gl_mesh_vertices.h. */
#include "gl/scene/gl_mesh_vertices.h"

#include <limits.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "gl/core/gl_api.h"

/* ---- keys: the arrays of a geometry ---- */

static const uint32_t widths[GL_VERTEX_ARRAYS] = {3, 3, 4, 4, 2, 2, 2, 2};

static bool reads_beyond(const scene_material *m)
{
    for (scene_texture_slot slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++)
        if (scene_material_has(m, slot) && m->textures[slot].texcoord >= GL_TEXCOORD_SETS)
            return true;
    return false;
}

bool gl_texcoord_sets(const scene_material *m, uint32_t sets[GL_TEXCOORD_SETS])
{
    uint32_t count = 0;
    bool fits = true;
    for (uint32_t i = 0; i < GL_TEXCOORD_SETS; i++)
        sets[i] = i;
    if (!reads_beyond(m))
        return true;
    for (scene_texture_slot slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++) {
        if (!scene_material_has(m, slot))
            continue;
        uint32_t set = m->textures[slot].texcoord, i = 0;
        while (i < count && sets[i] != set)
            i++;
        if (i == GL_TEXCOORD_SETS)
            fits = false;
        else if (i == count)
            sets[count++] = set;
    }
    while (count < GL_TEXCOORD_SETS)
        sets[count++] = SCENE_NONE;
    return fits;
}

uint32_t gl_texcoord_attribute(const scene_material *m, uint32_t set)
{
    uint32_t sets[GL_TEXCOORD_SETS], i = 0;
    gl_texcoord_sets(m, sets);
    while (i < GL_TEXCOORD_SETS && sets[i] != set)
        i++;
    return i;
}

/* The arrays of a geometry in the scene, which identify its buffers. */
typedef struct vertex_key {
    const float *arrays[GL_VERTEX_ARRAYS]; /* NULL: absent */
    const uint32_t *indices;               /* of generated vertices, or of elements alone */
    uint32_t vertex_count, index_count;
    scene_mode mode;
    uint32_t has_corner_tangents;
} vertex_key;

static vertex_key all_of(const render_geometry *g)
{
    const scene_primitive *p = g->primitive;
    uint32_t sets[GL_TEXCOORD_SETS];
    vertex_key key;
    memset(&key, 0, sizeof key); /* padding is compared, too */
    key.arrays[GL_ATTRIBUTE_POSITION] = g->positions;
    key.arrays[GL_ATTRIBUTE_NORMAL] = g->normals;
    if (p->mode == SCENE_TRIANGLES)
        key.arrays[GL_ATTRIBUTE_TANGENT] = g->tangents;
    key.arrays[GL_ATTRIBUTE_COLOR] = p->colors;
    gl_texcoord_sets(g->material, sets);
    for (uint32_t i = 0; i < GL_TEXCOORD_SETS; i++)
        if (sets[i] < p->texcoord_count)
            key.arrays[GL_ATTRIBUTE_TEXCOORD + i] = p->texcoords[sets[i]];
    key.vertex_count = p->vertex_count;
    key.index_count = p->index_count;
    key.indices = p->indices;
    key.mode = p->mode;
    key.has_corner_tangents = g->has_corner_tangents;
    return key;
}

/* ---- hash tables of buffers by key ---- */

typedef struct vertex_entry {
    vertex_key key;
    gl_vertices vertices;
    gl_elements elements;
    uint32_t *kept_indices; /* owned block behind elements.indices, where they were generated */
} vertex_entry;

typedef struct gl_vertex_table {
    facet_allocator allocator;
    vertex_entry *entries;
    size_t count, capacity; /* entries beyond count have reusable buffers */
    size_t made;
    uint32_t *slots; /* index of an entry plus 1; 0: free */
    size_t slot_count;
} gl_vertex_table;

static size_t hash_key(const vertex_key *key)
{
    uint64_t hash = 0xcbf29ce484222325u, word;
    const unsigned char *bytes = (const unsigned char *)key;
    for (size_t i = 0; i + sizeof word <= sizeof *key; i += sizeof word) {
        memcpy(&word, bytes + i, sizeof word);
        hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return (size_t)hash;
}

/* The slot of the key, or where it would go. */
static uint32_t *find_slot(const gl_vertex_table *table, const vertex_key *key)
{
    size_t i = hash_key(key) & (table->slot_count - 1);
    while (table->slots[i] && memcmp(&table->entries[table->slots[i] - 1].key, key, sizeof *key) != 0)
        i = (i + 1) & (table->slot_count - 1);
    return &table->slots[i];
}

static bool grow_slots(gl_vertex_table *table)
{
    if (2 * (table->count + 1) <= table->slot_count)
        return true;
    size_t count = table->slot_count ? 2 * table->slot_count : 64;
    uint32_t *slots = mem_zalloc(&table->allocator, count, sizeof *slots);
    if (!slots)
        return false;
    mem_free(table->slots);
    table->slots = slots;
    table->slot_count = count;
    for (size_t i = 0; i < table->count; i++)
        *find_slot(table, &table->entries[i].key) = (uint32_t)i + 1;
    return true;
}

/* Finds or adds the entry of a key. *is_new: it was added, possibly with a reusable buffer. NULL: no memory. */
static vertex_entry *get_entry(gl_vertex_table *table, const vertex_key *key, bool *is_new)
{
    *is_new = false;
    if (!grow_slots(table))
        return NULL;
    uint32_t *slot = find_slot(table, key);
    if (*slot)
        return &table->entries[*slot - 1];
    if (!mem_reserve(&table->allocator, (void **)&table->entries, &table->capacity, table->count + 1,
                     sizeof *table->entries))
        return NULL;
    if (table->count == table->made)
        table->entries[table->made++] = (vertex_entry){.kept_indices = NULL};
    *is_new = true;
    *slot = (uint32_t)++table->count;
    vertex_entry *e = &table->entries[table->count - 1];
    e->key = *key;
    return e;
}

/* Removes the last added entry, whose upload failed. */
static void drop_last(gl_vertex_table *table)
{
    *find_slot(table, &table->entries[table->count - 1].key) = 0; /* nothing was added since */
    table->count--;
}

static void clear_table(gl_vertex_table *table)
{
    table->count = 0;
    if (table->slots)
        memset(table->slots, 0, table->slot_count * sizeof *table->slots);
}

static void destroy_table(gl_vertex_table *table)
{
    for (size_t i = 0; table && i < table->made; i++) {
        glDeleteBuffers(1, &table->entries[i].vertices.buffer);
        glDeleteBuffers(1, &table->entries[i].elements.buffer);
        mem_free(table->entries[i].kept_indices);
    }
    if (table) {
        mem_free(table->entries);
        mem_free(table->slots);
    }
    mem_free(table);
}

static bool make_table(const gl_vertex_store *store, gl_vertex_table **table)
{
    if (!*table)
        *table = mem_zalloc(&store->allocator, 1, sizeof **table);
    if (*table)
        (*table)->allocator = store->allocator;
    return *table != NULL;
}

void gl_vertex_store_destroy(gl_vertex_store *store)
{
    destroy_table(store->fixed);
    destroy_table(store->streamed);
    store->fixed = NULL;
    store->streamed = NULL;
}

void gl_vertex_store_begin(gl_vertex_store *store)
{
    if (store->streamed)
        clear_table(store->streamed);
}

/* ---- generated vertices ---- */

/* Source vertices of the uploaded ones. NULL: the same. */
typedef struct vertex_choice {
    uint32_t count;
    uint32_t *vertices;
    uint32_t *corners; /* of tangents; NULL: as vertices */
    uint32_t *indices; /* new indices; NULL: none */
} vertex_choice;

static void free_choice(vertex_choice *c)
{
    mem_free(c->vertices);
    mem_free(c->corners);
    mem_free(c->indices);
    *c = (vertex_choice){0};
}

/* Merges the corners of a vertex that have the same tangent. */
static bool weld(const vertex_key *key, const facet_allocator *allocator, vertex_choice *out)
{
    const float *tangents = key->arrays[GL_ATTRIBUTE_TANGENT];
    size_t corners = key->index_count;
    uint32_t *first = mem_zalloc(allocator, key->vertex_count, sizeof *first); /* plus 1; 0: none yet */
    uint32_t *next = mem_alloc(allocator, corners, sizeof *next);
    *out = (vertex_choice){.vertices = mem_alloc(allocator, corners, sizeof *out->vertices),
                           .corners = mem_alloc(allocator, corners, sizeof *out->corners),
                           .indices = mem_alloc(allocator, corners, sizeof *out->indices)};
    bool has_memory = first && next && out->vertices && out->corners && out->indices;
    for (uint32_t i = 0; has_memory && i < key->index_count; i++) {
        uint32_t vertex = key->indices[i], at = first[vertex];
        const float *tangent = tangents + 4 * (size_t)i;
        while (at && memcmp(tangents + 4 * (size_t)out->corners[at - 1], tangent, 4 * sizeof *tangent) != 0)
            at = next[at - 1];
        if (!at) {
            out->vertices[out->count] = vertex;
            out->corners[out->count] = i;
            next[out->count] = first[vertex];
            at = first[vertex] = ++out->count;
        }
        out->indices[i] = at - 1;
    }
    mem_free(first);
    mem_free(next);
    if (!has_memory)
        free_choice(out);
    return has_memory;
}

/* One vertex per index. */
static bool follow_indices(const vertex_key *key, const facet_allocator *allocator, vertex_choice *out)
{
    *out = (vertex_choice){.count = key->index_count,
                           .vertices = mem_alloc(allocator, key->index_count, sizeof *out->vertices)};
    if (out->vertices)
        memcpy(out->vertices, key->indices, key->index_count * sizeof *key->indices);
    return out->vertices != NULL;
}

static void gather(const float *from, uint32_t width, const uint32_t *indices, uint32_t count, float *to)
{
    for (size_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < width; k++)
            to[width * i + k] = from[width * (size_t)indices[i] + k];
}

/* ---- uploads ---- */

static facet_result check_size(const gl_vertex_store *store, const char *what, uint64_t bytes,
                               facet_error *error)
{
    if (bytes <= INT_MAX)
        return FACET_OK;
    return fail(error, FACET_ERROR_LIMIT, "%s: a mesh has %llu bytes of %s; OpenGL draws at most %d",
                store->source, (unsigned long long)bytes, what, INT_MAX);
}

static GLuint fill_buffer(gl_vertex_store *store, GLuint buffer, GLenum target, size_t bytes,
                          const void *data, bool changes)
{
    if (!buffer)
        glGenBuffers(1, &buffer);
    glBindVertexArray(0); /* otherwise it would become part of the bound vertex array object */
    glBindBuffer(target, buffer);
    glBufferData(target, (GLsizeiptr)bytes, data, changes ? GL_STREAM_DRAW : GL_STATIC_DRAW);
    if (data) {
        store->stats.bytes += bytes;
        store->stats.uploads++;
    }
    return buffer;
}

static facet_result upload_vertices(gl_vertex_store *store, const vertex_key *key,
                                    const vertex_choice *choice, bool changes, gl_vertices *v,
                                    facet_error *error)
{
    uint64_t bytes = 0;
    v->count = choice->vertices ? choice->count : key->vertex_count;
    v->arrays = 0;
    for (int i = 0; i < GL_VERTEX_ARRAYS; i++) {
        v->offsets[i] = (size_t)bytes;
        if (key->arrays[i])
            bytes += (uint64_t)v->count * widths[i] * sizeof(float);
        v->arrays |= key->arrays[i] ? 1u << i : 0;
    }
    facet_result result = check_size(store, "vertices", bytes, error);
    if (result != FACET_OK || !v->arrays)
        return result;
    float *chosen = NULL;
    if (choice->vertices && !(chosen = mem_alloc(&store->allocator, v->count, 4 * sizeof *chosen)))
        return fail_memory(error, "vertices", v->count * (4 * sizeof *chosen));
    v->buffer = fill_buffer(store, v->buffer, GL_ARRAY_BUFFER, (size_t)bytes, NULL, changes);
    for (int i = 0; i < GL_VERTEX_ARRAYS; i++) {
        const float *data = key->arrays[i];
        size_t size = (size_t)v->count * widths[i] * sizeof(float);
        if (!data || !size)
            continue;
        bool is_of_corners = i == GL_ATTRIBUTE_TANGENT && choice->corners;
        if (chosen) {
            gather(data, widths[i], is_of_corners ? choice->corners : choice->vertices, v->count, chosen);
            data = chosen;
        }
        glBufferSubData(GL_ARRAY_BUFFER, (GLintptr)v->offsets[i], (GLsizeiptr)size, data);
        store->stats.bytes += size;
    }
    store->stats.uploads++;
    mem_free(chosen);
    return gl_context_check(store->context, "vertices", error);
}

static facet_result upload_elements(gl_vertex_store *store, const uint32_t *indices, uint32_t count,
                                    bool changes, gl_elements *e, facet_error *error)
{
    uint64_t bytes = (uint64_t)count * sizeof *indices;
    TRY(check_size(store, "indices", bytes, error));
    e->buffer = fill_buffer(store, e->buffer, GL_ELEMENT_ARRAY_BUFFER, (size_t)bytes, indices, changes);
    e->count = count;
    e->indices = indices;
    return gl_context_check(store->context, "indices", error);
}

/* Uploads an entry's vertices, and its own elements where there are any. */
static facet_result fill_entry(gl_vertex_store *store, vertex_entry *e, bool is_made, bool changes,
                               facet_error *error)
{
    vertex_choice choice = {0};
    bool is_welded = is_made && e->key.mode == SCENE_TRIANGLES;
    if (is_made && !(is_welded ? weld(&e->key, &store->allocator, &choice)
                               : follow_indices(&e->key, &store->allocator, &choice)))
        return fail_memory(error, "vertices", e->key.index_count * (3 * sizeof *choice.vertices));
    facet_result result = upload_vertices(store, &e->key, &choice, changes, &e->vertices, error);
    if (result == FACET_OK && is_welded) {
        result = upload_elements(store, choice.indices, e->key.index_count, changes, &e->elements, error);
        mem_free(e->kept_indices);
        e->kept_indices = choice.indices;
        choice.indices = NULL;
    }
    free_choice(&choice);
    return result;
}

static facet_result use_entry(gl_vertex_store *store, gl_vertex_table *table, const vertex_key *key,
                              bool is_made, vertex_entry **out, facet_error *error)
{
    bool is_new;
    *out = get_entry(table, key, &is_new);
    if (!*out)
        return fail_memory(error, "vertices", sizeof **out);
    if (!is_new)
        return FACET_OK;
    facet_result result = fill_entry(store, *out, is_made, table == store->streamed, error);
    if (result != FACET_OK)
        drop_last(table);
    return result;
}

static facet_result use_indices(gl_vertex_store *store, const vertex_key *all, gl_elements *out,
                                facet_error *error)
{
    vertex_key key;
    memset(&key, 0, sizeof key);
    key.indices = all->indices;
    key.index_count = all->index_count;
    bool is_new;
    vertex_entry *e = get_entry(store->fixed, &key, &is_new);
    facet_result result = e ? FACET_OK : fail_memory(error, "indices", sizeof *e);
    if (e && is_new) {
        result = upload_elements(store, key.indices, key.index_count, false, &e->elements, error);
        if (result != FACET_OK)
            drop_last(store->fixed);
    }
    if (result == FACET_OK)
        *out = e->elements;
    return result;
}

static bool is_deformed(const render_geometry *g)
{
    return g->positions != g->primitive->positions || g->normals != g->primitive->normals ||
           (g->tangents && !g->has_corner_tangents && g->tangents != g->primitive->tangents);
}

facet_result gl_vertex_store_use(gl_vertex_store *store, const render_geometry *g, gl_vertex_use *use,
                                 facet_error *error)
{
    if (!make_table(store, &store->fixed) || !make_table(store, &store->streamed))
        return fail_memory(error, "vertices", sizeof *store->fixed);
    bool is_made = g->has_corner_tangents || g->primitive->mode != SCENE_TRIANGLES;
    vertex_key all = all_of(g), still = all, moved = all;
    vertex_entry *entry;
    facet_result result = FACET_OK;
    *use = (gl_vertex_use){0};
    if (is_deformed(g) && !is_made) {
        for (int i = 0; i < GL_VERTEX_ARRAYS; i++)
            if (i <= GL_ATTRIBUTE_TANGENT)
                still.arrays[i] = NULL;
            else
                moved.arrays[i] = NULL;
    }
    if (!is_made) { /* shared vertex buffers may have different indices */
        still.indices = moved.indices = NULL;
        still.index_count = moved.index_count = 0;
    }
    if (is_deformed(g)) {
        result = use_entry(store, store->streamed, &moved, is_made, &entry, error);
        if (result == FACET_OK) {
            use->streamed = entry->vertices;
            use->elements = entry->elements;
        }
    }
    if (result == FACET_OK && !(is_deformed(g) && is_made)) {
        result = use_entry(store, store->fixed, &still, is_made, &entry, error);
        if (result == FACET_OK) {
            use->fixed = entry->vertices;
            if (is_made)
                use->elements = entry->elements;
        }
    }
    if (result == FACET_OK && !is_made)
        result = use_indices(store, &all, &use->elements, error);
    return result;
}

facet_result gl_vertex_store_reorder(gl_vertex_store *store, const render_geometry *g, const uint32_t *order,
                                     gl_vertices *out, facet_error *error)
{
    vertex_key key = all_of(g);
    vertex_choice choice;
    uint32_t ends = g->primitive->mode == SCENE_LINES ? 2 : 1;
    if (!follow_indices(&key, &store->allocator, &choice))
        return fail_memory(error, "vertices", key.index_count * sizeof *choice.vertices);
    for (uint32_t i = 0; i < key.index_count; i++)
        choice.vertices[i] = key.indices[ends * order[i / ends] + i % ends];
    facet_result result = upload_vertices(store, &key, &choice, true, out, error);
    free_choice(&choice);
    return result;
}
