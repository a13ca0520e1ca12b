/* gl_mesh.c - see gl_mesh.h. Vertices and indices: gl_mesh_vertices.h; vertex array objects: gl_attributes.h. */
#include "gl/scene/gl_mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "gl/core/gl_api.h"
#include "gl/core/gl_program.h"
#include "gl/scene/gl_attributes.h"

struct gl_mesh_set {
    facet_allocator allocator;
    gl_vertex_store store;
    uint64_t revision, generation; /* of the scene; 0: there are no batches */
    uint32_t count;
    gl_batch *batches; /* sorted by pass */
    uint32_t first[GL_PASS_COUNT + 1];
    gl_instance *instances; /* as uploaded: the instances of a batch are contiguous */
    uint32_t *instance_geometries;
    gl_vertex_array *arrays; /* of the batches, in the order of creation */
    size_t array_count, array_capacity;
    uint32_t instance_buffer;
    uint64_t sprite_feature; /* of GL_MAIN_SURFACE */
};

/* Two for each of the eight positions along the outline of a sprite: surface.vert. */
enum { SPRITE_VERTICES = 16 };
facet_result gl_mesh_create(gl_context *context, const facet_allocator *allocator, gl_mesh_set **out,
                            facet_error *error)
{
    *out = mem_zalloc(allocator, 1, sizeof **out);
    if (!*out)
        return fail_memory(error, "geometry", sizeof **out);
    (*out)->allocator = allocator ? *allocator : (facet_allocator){0};
    (*out)->store = (gl_vertex_store){.context = context, .allocator = (*out)->allocator};
    (*out)->sprite_feature = gl_program_feature(GL_MAIN_SURFACE, "IS_SPRITE");
    glGenBuffers(1, &(*out)->instance_buffer);
    return FACET_OK;
}

/* Frees the batches of a pose; keeps what the next pose can reuse. */
static void clear(gl_mesh_set *set)
{
    mem_free(set->batches);
    mem_free(set->instances);
    mem_free(set->instance_geometries);
    set->batches = NULL;
    set->instances = NULL;
    set->instance_geometries = NULL;
    set->count = 0;
    set->revision = 0;
    memset(set->first, 0, sizeof set->first);
}

void gl_mesh_destroy(gl_mesh_set *set)
{
    if (!set)
        return;
    clear(set);
    for (size_t i = 0; i < set->array_count; i++)
        glDeleteVertexArrays(1, &set->arrays[i].name);
    mem_free(set->arrays);
    gl_vertex_store_destroy(&set->store);
    glDeleteBuffers(1, &set->instance_buffer);
    mem_free(set);
}

/* ---- instances ---- */

void gl_mesh_instance_box(const scene_instance *instance, float low[3], float high[3])
{
    for (int row = 0; row < 3; row++) {
        float middle = instance->world.m[12 + row], extent = 0.0f;
        for (int k = 0; k < 3; k++) {
            float m = instance->world.m[4 * k + row];
            middle += m * 0.5f * (instance->bounds_min[k] + instance->bounds_max[k]);
            extent += fabsf(m) * 0.5f * (instance->bounds_max[k] - instance->bounds_min[k]);
        }
        low[row] = middle - extent;
        high[row] = middle + extent;
    }
}

static void add_bounds(const scene_instance *instance, gl_batch *b)
{
    float low[3], high[3];
    gl_mesh_instance_box(instance, low, high);
    for (int i = 0; i < 3; i++) {
        b->bounds_min[i] = fminf(b->bounds_min[i], low[i]);
        b->bounds_max[i] = fmaxf(b->bounds_max[i], high[i]);
    }
}

/* ---- batches ---- */

static gl_pass pass_of(const render_geometry *g, const material_plan *plan)
{
    if (g->is_see_through && (g->legacy || g->material->alpha_mode == SCENE_ALPHA_BLEND))
        return GL_PASS_BLENDED;
    return plan->lets_rays_through ? GL_PASS_TRANSMISSIVE : GL_PASS_OPAQUE;
}

static bool may_share(const render_geometry *a, const render_geometry *b)
{
    return a->primitive == b->primitive && a->positions == b->positions && a->normals == b->normals &&
           a->tangents == b->tangents && a->material_id == b->material_id &&
           a->is_mirrored == b->is_mirrored && a->primitive->mode == SCENE_TRIANGLES;
}

static uint64_t hash_of(const render_geometry *g)
{
    uint64_t hash = (uint64_t)(uintptr_t)g->primitive * 0x9e3779b97f4a7c15u;
    hash = (hash ^ (uint64_t)(uintptr_t)g->positions ^ (hash >> 31)) * 0x9e3779b97f4a7c15u;
    hash ^= (uint64_t)g->material_id << 1 ^ (uint64_t)g->is_mirrored;
    hash *= 0x9e3779b97f4a7c15u;
    return hash ^ hash >> 32;
}

/* Groups instances into batches by hashing. batch_of: per geometry. slots: a power of two of them, more than
 * geometries. */
static void group(gl_mesh_set *set, const gl_scene *scene, uint32_t *batch_of, uint32_t *slots,
                  size_t slot_count)
{
    const render_geometry_set *geometries = &scene->geometries;
    for (uint32_t i = 0; i < geometries->count; i++) {
        const render_geometry *g = &geometries->items[i];
        size_t slot = hash_of(g) & (slot_count - 1);
        while (slots[slot] && !may_share(set->batches[slots[slot] - 1].geometry, g))
            slot = (slot + 1) & (slot_count - 1);
        if (!slots[slot]) {
            slots[slot] = ++set->count;
            set->batches[set->count - 1] = (gl_batch){.geometry = g,
                                                      .plan = &scene->plans.items[i],
                                                      .is_sprites = g->primitive->mode != SCENE_TRIANGLES,
                                                      .bounds_min = {INFINITY, INFINITY, INFINITY},
                                                      .bounds_max = {-INFINITY, -INFINITY, -INFINITY}};
        }
        gl_batch *b = &set->batches[slots[slot] - 1];
        batch_of[i] = slots[slot] - 1;
        b->instance_count++;
        add_bounds(&scene->pose.instances[i], b);
    }
}

/* Makes the instances of each batch contiguous. */
static void place_instances(gl_mesh_set *set, const gl_scene *scene, const uint32_t *batch_of)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < set->count; i++) {
        set->batches[i].first_instance = count;
        count += set->batches[i].instance_count;
        set->batches[i].instance_count = 0;
    }
    for (uint32_t i = 0; i < scene->geometries.count; i++) {
        gl_batch *b = &set->batches[batch_of[i]];
        uint32_t place = b->first_instance + b->instance_count++;
        gl_instance_load(&scene->geometries.items[i], i, &set->instances[place]);
        set->instance_geometries[place] = i;
    }
}

static facet_result make_batches(gl_mesh_set *set, const gl_scene *scene, facet_error *error)
{
    uint32_t count = scene->geometries.count;
    size_t slot_count = 16;
    while (slot_count < 2 * (size_t)count)
        slot_count *= 2;
    set->batches = mem_zalloc(&set->allocator, count, sizeof *set->batches);
    set->instances = mem_alloc(&set->allocator, count, sizeof *set->instances);
    set->instance_geometries = mem_alloc(&set->allocator, count, sizeof *set->instance_geometries);
    uint32_t *batch_of = mem_alloc(&set->allocator, count, sizeof *batch_of);
    uint32_t *slots = mem_zalloc(&set->allocator, slot_count, sizeof *slots);
    bool has_memory = set->batches && set->instances && set->instance_geometries && batch_of && slots;
    if (has_memory) {
        group(set, scene, batch_of, slots, slot_count);
        place_instances(set, scene, batch_of);
    }
    mem_free(batch_of);
    mem_free(slots);
    return has_memory ? FACET_OK : fail_memory(error, "geometry", count * sizeof *set->batches);
}

static facet_result make_arrays(gl_mesh_set *set, facet_error *error)
{
    if (!mem_reserve(&set->allocator, (void **)&set->arrays, &set->array_capacity, set->count,
                     sizeof *set->arrays))
        return fail_memory(error, "geometry", set->count * sizeof *set->arrays);
    for (; set->array_count < set->count; set->array_count++)
        memset(&set->arrays[set->array_count], 0, sizeof *set->arrays);
    for (uint32_t i = 0; i < set->count; i++)
        gl_vertex_array_use(&set->arrays[i], &set->batches[i], set->instance_buffer);
    glBindVertexArray(0);
    return FACET_OK;
}

/* ---- updates ---- */

static facet_result upload_batch(gl_mesh_set *set, gl_batch *b, facet_error *error)
{
    TRY(gl_vertex_store_use(&set->store, b->geometry, &b->vertices, error));
    if (b->is_sprites) {
        b->mode = GL_TRIANGLE_STRIP;
        b->element_count = SPRITE_VERTICES;
        b->instance_count =
            b->geometry->primitive->index_count / (b->geometry->primitive->mode == SCENE_LINES ? 2 : 1);
    } else {
        b->mode = GL_TRIANGLES;
        b->has_elements = true;
        b->element_count = b->vertices.elements.count;
    }
    return FACET_OK;
}

static int compare_passes(const void *a, const void *b)
{
    const gl_batch *x = a, *y = b;
    gl_pass p = pass_of(x->geometry, x->plan), q = pass_of(y->geometry, y->plan);
    return p != q ? (p > q) - (p < q) : (x->geometry > y->geometry) - (x->geometry < y->geometry);
}

static void find_passes(gl_mesh_set *set)
{
    if (set->count)
        qsort(set->batches, set->count, sizeof *set->batches, compare_passes);
    for (uint32_t i = 0; i < set->count; i++)
        for (gl_pass p = pass_of(set->batches[i].geometry, set->batches[i].plan); p < GL_PASS_COUNT; p++)
            set->first[p + 1] = i + 1;
}

static void warn(const gl_mesh_set *set, const gl_scene *scene, const facet_log *log)
{
    uint32_t sets[GL_TEXCOORD_SETS];
    for (uint32_t i = 0; i < set->count; i++) {
        const render_geometry *g = set->batches[i].geometry;
        uint32_t most = set->batches[i].is_sprites ? 2 : GL_TEXCOORD_SETS;
        bool fits = gl_texcoord_sets(g->material, sets);
        for (scene_texture_slot slot = 0; fits && slot < SCENE_TEXTURE_SLOT_COUNT; slot++)
            fits = !scene_material_has(g->material, slot) ||
                   gl_texcoord_attribute(g->material, g->material->textures[slot].texcoord) < most;
        if (fits)
            continue;
        log_warning(
            log,
            "%s: material \"%s\": reads more sets of texture coordinates than the %u that OpenGL gets; the "
            "others are 0",
            scene->scene->source, g->material->name ? g->material->name : "", most);
        return;
    }
}

facet_result gl_mesh_update(gl_mesh_set *set, const gl_scene *scene, const facet_log *log, facet_error *error)
{
    if (set->revision && set->revision == scene->revision)
        return FACET_OK;
    clear(set);
    if (set->generation != scene->generation)
        gl_vertex_store_destroy(&set->store);
    set->generation = scene->generation;
    set->store.source = scene->scene->source;
    gl_vertex_store_begin(&set->store);
    facet_result result = make_batches(set, scene, error);
    for (uint32_t i = 0; i < set->count && result == FACET_OK; i++)
        result = upload_batch(set, &set->batches[i], error);
    if (result == FACET_OK) {
        size_t bytes = scene->geometries.count * sizeof *set->instances;
        glBindBuffer(GL_ARRAY_BUFFER, set->instance_buffer);
        glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)bytes, set->instances, GL_DYNAMIC_DRAW);
        set->store.stats.bytes += bytes;
        set->store.stats.uploads++;
        result = make_arrays(set, error);
    }
    if (result == FACET_OK)
        result = gl_context_check(set->store.context, "geometry", error);
    if (result != FACET_OK) {
        clear(set);
        return result;
    }
    find_passes(set);
    warn(set, scene, log);
    set->revision = scene->revision;
    return FACET_OK;
}

const gl_batch *gl_mesh_batches(const gl_mesh_set *set, gl_pass pass, uint32_t *count)
{
    *count = set->first[pass + 1] - set->first[pass];
    return set->batches + set->first[pass];
}

gl_upload_stats gl_mesh_uploads(const gl_mesh_set *set)
{
    return set->store.stats;
}

/* ---- drawing ---- */

uint64_t gl_mesh_features(const gl_mesh_set *set, const gl_batch *b)
{
    return b->is_sprites ? set->sprite_feature : 0;
}

uint32_t gl_mesh_instance_geometry(const gl_mesh_set *set, uint32_t instance)
{
    return set->instance_geometries[instance];
}

void gl_mesh_set_constants(const gl_mesh_set *set, const gl_batch *b, uint32_t instance)
{
    gl_attributes_set_constants(b, &set->instances[instance]);
}

facet_result gl_mesh_reorder(gl_mesh_set *set, const gl_batch *b, const uint32_t *order, gl_vertices *out,
                             facet_error *error)
{
    return gl_vertex_store_reorder(&set->store, b->geometry, order, out, error);
}

void gl_mesh_draw(const gl_mesh_set *set, const gl_batch *b)
{
    glBindVertexArray(b->vertex_array);
    gl_attributes_set_constants(b, b->is_sprites ? &set->instances[b->first_instance] : NULL);
    if (b->has_elements)
        glDrawElementsInstanced(b->mode, (GLsizei)b->element_count, GL_UNSIGNED_INT, NULL,
                                (GLsizei)b->instance_count);
    else
        glDrawArraysInstanced(b->mode, 0, (GLsizei)b->element_count, (GLsizei)b->instance_count);
}

/* ---- order ---- */

/* Whether the box is entirely beyond one side of the image. Sprites extend a pixel further. */
bool gl_mesh_is_outside(const gl_batch *b, const gl_frame_block *frame)
{
    const float *m = frame->view_projection;
    const float margin = 1.0f + 0.01f; /* over half the image: one pixel of 200 */
    for (int side = 0; side < 4; side++) {
        int row = side >> 1;
        float sign = side & 1 ? -1.0f : 1.0f, most = margin * m[15] + sign * m[12 + row];
        for (int k = 0; k < 3; k++) {
            float n = margin * m[4 * k + 3] + sign * m[4 * k + row];
            float farthest = n > 0.0f ? b->bounds_max[k] : b->bounds_min[k];
            most += n * (farthest - frame->eye[k]);
        }
        if (most < 0.0f)
            return true;
    }
    return false;
}

/* Widens low and high by the box in normalized device coordinates; false where a corner is not in front of the eye. */
static bool widen_by_box(const gl_batch *b, const gl_frame_block *frame, float low[2], float high[2])
{
    const float *m = frame->view_projection;
    for (int corner = 0; corner < 8; corner++) {
        float at[4] = {m[12], m[13], 0.0f, m[15]}; /* clip coordinates without depth */
        for (int k = 0; k < 3; k++) {
            float p = (corner >> k & 1 ? b->bounds_max[k] : b->bounds_min[k]) - frame->eye[k];
            at[0] += m[4 * k] * p;
            at[1] += m[4 * k + 1] * p;
            at[3] += m[4 * k + 3] * p;
        }
        if (!(at[3] > 1e-6f))
            return false;
        for (int i = 0; i < 2; i++) {
            low[i] = fminf(low[i], at[i] / at[3]);
            high[i] = fmaxf(high[i], at[i] / at[3]);
        }
    }
    return true;
}

void gl_mesh_area(const gl_mesh_set *set, const gl_frame_block *frame, bool is_top_down, uint32_t width,
                  uint32_t height, int area[4])
{
    const int size[2] = {(int)width, (int)height};
    float low[2] = {1.0f, 1.0f}, high[2] = {-1.0f, -1.0f};
    memcpy(area, (int[4]){0, 0, size[0], size[1]}, 4 * sizeof *area);
    for (gl_pass pass = GL_PASS_OPAQUE; pass < GL_PASS_COUNT; pass++) {
        uint32_t count;
        const gl_batch *batches = gl_mesh_batches(set, pass, &count);
        if (count && pass != GL_PASS_OPAQUE)
            return;
        for (uint32_t i = 0; i < count; i++)
            if (batches[i].is_sprites ||
                (!batches[i].is_outside && !widen_by_box(&batches[i], frame, low, high)))
                return;
    }
    for (int i = 0; i < 2; i++) {
        bool is_flipped = i == 1 && is_top_down;
        float from = is_flipped ? -high[i] : low[i], to = is_flipped ? -low[i] : high[i];
        float half = 0.5f * (float)size[i];
        /* a pixel more on either side: samples lie beside the middle, and bounds are rounded */
        int begin = (int)floorf((fminf(fmaxf(from, -1.0f), 1.0f) + 1.0f) * half) - 1;
        int end = (int)ceilf((fminf(fmaxf(to, -1.0f), 1.0f) + 1.0f) * half) + 1;
        area[i] = begin > 0 ? begin : 0;
        area[2 + i] = (end < size[i] ? end : size[i]) - area[i];
        if (area[2 + i] < 1)
            area[2 + i] = 1;
    }
}

static float depth_of(const gl_batch *b, const gl_frame_block *frame)
{
    float depth = 0.0f;
    for (int k = 0; k < 3; k++)
        depth += frame->forward[k] * (0.5f * (b->bounds_min[k] + b->bounds_max[k]) - frame->eye[k]);
    return depth;
}

static int by_geometry(const gl_batch *a, const gl_batch *b)
{
    return (a->geometry > b->geometry) - (a->geometry < b->geometry);
}

/* Changing programs costs more than a hidden pixel saves. */
static int by_program(const void *x, const void *y)
{
    const gl_batch *a = x, *b = y;
    if (a->features != b->features)
        return a->features < b->features ? -1 : 1;
    if (a->depth < b->depth || a->depth > b->depth)
        return a->depth < b->depth ? -1 : 1;
    return by_geometry(a, b);
}

void gl_mesh_order(gl_mesh_set *set, const gl_frame_block *frame, const struct gl_material_set *materials,
                   gl_mesh_features_function *features_of)
{
    for (uint32_t i = 0; i < set->count; i++) {
        gl_batch *b = &set->batches[i];
        b->features = features_of(materials, b) | gl_mesh_features(set, b);
        b->depth = depth_of(b, frame);
        b->is_outside = gl_mesh_is_outside(b, frame);
    }
    for (int pass = 0; pass < GL_PASS_BLENDED; pass++) {
        uint32_t count = set->first[pass + 1] - set->first[pass];
        if (count > 1)
            qsort(set->batches + set->first[pass], count, sizeof *set->batches, by_program);
    }
}
