/* render_geometry.c - see render_geometry.h. All is flattened into world space: one level of BVH is traversed
 * quicker than two, and a model whose meshes are drawn often is rare. */
#include "cpu/render_geometry.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "base/result.h"

enum { VERTEX_GRAIN = 1 << 15 };

/* Half the width of lines and the radius of points in pixels: with these, one sample in the middle of each pixel
 * misses no line in the columns (or rows) that it crosses, and no point. */
static const float LINE_RADIUS = 0.5f;
static const float POINT_RADIUS = 0.70710678f;

static bool has_vertex_alpha(const scene_primitive *primitive)
{
    for (uint32_t i = 0; primitive->colors && i < primitive->vertex_count; i++)
        if (primitive->colors[4 * (size_t)i + 3] < 1.0f)
            return true;
    return false;
}

/* Whether some hit may let light through. A BLEND material without texture whose factor is 1 is opaque. */
static bool may_see_through(const scene_primitive *primitive, const scene_material *material)
{
    if (material->alpha_mode == SCENE_ALPHA_OPAQUE)
        return false;
    return material->textures[SCENE_BASE_COLOR_TEXTURE].texture != SCENE_NONE ||
           material->base_color[3] < 1.0f || has_vertex_alpha(primitive);
}

static void set_transform(render_geometry *g, const scene_instance *instance)
{
    float scale = cbrtf(fabsf(mat4_determinant3(instance->world)));
    float vector_scale = scale > 0.0f ? 1.0f / scale : 1.0f;
    float normal_scale = vector_scale * vector_scale;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            g->normal_matrix[3 * row + column] = instance->normal_matrix[3 * row + column] * normal_scale;
            g->tangent_matrix[3 * row + column] = instance->world.m[4 * column + row] * vector_scale;
        }
    g->is_mirrored = instance->is_mirrored;
    g->bitangent_sign = instance->is_mirrored ? -1.0f : 1.0f;
}

facet_result render_geometry_create(const facet_scene *scene, const scene_pose *pose,
                                    const facet_allocator *allocator, render_geometry_set *set,
                                    facet_error *error)
{
    *set = (render_geometry_set){.count = pose->instance_count};
    set->items = mem_zalloc(allocator, set->count, sizeof *set->items);
    set->vertex_blocks = mem_alloc(allocator, set->count, sizeof *set->vertex_blocks);
    set->tangent_blocks = mem_alloc(allocator, set->count, sizeof *set->tangent_blocks);
    if (!set->items || !set->vertex_blocks || !set->tangent_blocks) {
        render_geometry_destroy(set);
        return fail_memory(error, "instances", pose->instance_count * sizeof *set->items);
    }
    for (uint32_t i = 0; i < set->count; i++) {
        const scene_instance *instance = &pose->instances[i];
        const scene_primitive *primitive = instance->primitive;
        render_geometry *g = &set->items[i];
        g->primitive = primitive;
        g->material = scene_pose_material(scene, pose, instance);
        g->material_id = instance->material == SCENE_NONE ? 0 : instance->material + 1;
        g->is_double_sided = g->material->is_double_sided || primitive->mode != SCENE_TRIANGLES;
        g->is_lit = !(g->material->extensions & SCENE_UNLIT) && instance->normals;
        g->is_see_through = may_see_through(primitive, g->material);
        g->normals = instance->normals;
        g->tangents = instance->tangents;
        set_transform(g, instance);
    }
    return FACET_OK;
}

void render_geometry_destroy(render_geometry_set *set)
{
    for (uint32_t i = 0; i < set->vertex_block_count; i++)
        mem_free(set->vertex_blocks[i]);
    for (uint32_t i = 0; i < set->tangent_block_count; i++)
        mem_free(set->tangent_blocks[i]);
    mem_free(set->vertex_blocks);
    mem_free(set->tangent_blocks);
    mem_free(set->items);
    *set = (render_geometry_set){0};
}

/* ---- vertices ---- */

typedef struct transform_job {
    const scene_instance *instance;
    const camera_rays *camera;
    float *out;
} transform_job;

static void transform_vertices(void *context, size_t begin, size_t end)
{
    const transform_job *job = context;
    const float *positions = job->instance->positions;
    for (size_t i = begin; i < end; i++)
        mat4_transform_point(&job->instance->world, positions + 3 * i, job->out + 3 * i);
}

/* One vertex per index, so that neighbours in the array are neighbours on the line. */
static void place_sprites(void *context, size_t begin, size_t end)
{
    const transform_job *job = context;
    const camera_rays *camera = job->camera;
    const scene_primitive *primitive = job->instance->primitive;
    float radius = primitive->mode == SCENE_POINTS ? POINT_RADIUS : LINE_RADIUS;
    for (size_t i = begin; i < end; i++) {
        float *p = job->out + 4 * i;
        mat4_transform_point(&job->instance->world,
                             job->instance->positions + 3 * (size_t)primitive->indices[i], p);
        float depth = 0.0f;
        for (int axis = 0; axis < 3; axis++)
            depth += (p[axis] - camera->origin[axis]) * camera->direction[axis];
        p[3] = radius * camera_rays_pixel_size(camera, depth);
    }
}

static bool shares_vertices(const scene_instance *a, const scene_instance *b)
{
    return a->node == b->node && a->positions == b->positions &&
           a->primitive->vertex_count == b->primitive->vertex_count &&
           a->primitive->mode == SCENE_TRIANGLES && b->primitive->mode == SCENE_TRIANGLES;
}

facet_result render_geometry_transform(render_geometry_set *set, const scene_pose *pose,
                                       const camera_rays *camera, const facet_allocator *allocator,
                                       uint32_t thread_count, facet_error *error)
{
    for (uint32_t i = 0; i < set->count; i++) {
        const scene_instance *instance = &pose->instances[i];
        render_geometry *g = &set->items[i];
        if (i > 0 && shares_vertices(instance, instance - 1)) {
            g->vertices = g[-1].vertices;
            continue;
        }
        bool is_mesh = g->primitive->mode == SCENE_TRIANGLES;
        size_t count = is_mesh ? g->primitive->vertex_count : g->primitive->index_count;
        /* One vertex more: Embree reads 16 bytes for the last three floats. */
        float *vertices = mem_alloc(allocator, count + 1, (is_mesh ? 3 : 4) * sizeof(float));
        if (!vertices)
            return fail_memory(error, "vertices in world space", count * 3 * sizeof(float));
        set->vertex_blocks[set->vertex_block_count++] = vertices;
        g->vertices = vertices;
        transform_job job = {.instance = instance, .camera = camera, .out = vertices};
        parallel_for(thread_count, count, VERTEX_GRAIN, is_mesh ? transform_vertices : place_sprites, &job);
    }
    return FACET_OK;
}

/* ---- tangents ---- */

static bool needs_tangents(const render_geometry *g)
{
    const scene_material *material = g->material;
    return g->primitive->mode == SCENE_TRIANGLES && g->is_lit && !g->tangents &&
           material->textures[SCENE_NORMAL_TEXTURE].texture != SCENE_NONE &&
           material->textures[SCENE_NORMAL_TEXTURE].texcoord < g->primitive->texcoord_count;
}

typedef struct tangent_jobs {
    const facet_allocator *allocator;
    const scene_primitive **primitives; /* sorted, each once */
    const scene_material **materials;
    float **tangents;
    _Atomic int result; /* the first facet_result that was not FACET_OK */
} tangent_jobs;

static void make_tangents(void *context, size_t begin, size_t end)
{
    tangent_jobs *jobs = context;
    for (size_t i = begin; i < end; i++) {
        const scene_primitive *primitive = jobs->primitives[i];
        float *tangents = mem_alloc(jobs->allocator, primitive->index_count, 4 * sizeof(float));
        facet_result result = FACET_ERROR_MEMORY;
        if (tangents)
            result = scene_generate_tangents(primitive,
                                             jobs->materials[i]->textures[SCENE_NORMAL_TEXTURE].texcoord,
                                             jobs->allocator, tangents, NULL);
        if (result == FACET_OK) {
            jobs->tangents[i] = tangents;
        } else {
            mem_free(tangents);
            atomic_store(&jobs->result, result);
        }
    }
}

/* A primitive has one material, so it needs one set of tangents. */
static int compare_geometries(const void *a, const void *b)
{
    uintptr_t x = (uintptr_t)(*(render_geometry *const *)a)->primitive;
    uintptr_t y = (uintptr_t)(*(render_geometry *const *)b)->primitive;
    return (x > y) - (x < y);
}

facet_result render_geometry_make_tangents(render_geometry_set *set, const facet_allocator *allocator,
                                           uint32_t thread_count, facet_error *error)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < set->count; i++)
        count += needs_tangents(&set->items[i]);
    if (count == 0)
        return FACET_OK;

    render_geometry **users = mem_alloc(allocator, count, sizeof *users);
    tangent_jobs jobs = {.allocator = allocator,
                         .primitives = mem_alloc(allocator, count, sizeof *jobs.primitives),
                         .materials = mem_alloc(allocator, count, sizeof *jobs.materials),
                         .tangents = mem_zalloc(allocator, count, sizeof *jobs.tangents),
                         .result = FACET_OK};
    facet_result result = FACET_OK;
    if (!users || !jobs.primitives || !jobs.materials || !jobs.tangents) {
        result = fail_memory(error, "tangents", count * sizeof *users);
        goto done;
    }
    uint32_t n = 0;
    for (uint32_t i = 0; i < set->count; i++)
        if (needs_tangents(&set->items[i]))
            users[n++] = &set->items[i];
    qsort(users, count, sizeof *users, compare_geometries);
    uint32_t unique = 0;
    for (uint32_t i = 0; i < count; i++)
        if (i == 0 || users[i]->primitive != users[i - 1]->primitive) {
            jobs.primitives[unique] = users[i]->primitive;
            jobs.materials[unique++] = users[i]->material;
        }

    parallel_for(thread_count, unique, 1, make_tangents, &jobs);

    uint32_t k = 0;
    for (uint32_t i = 0; i < count; i++) {
        k += i > 0 && users[i]->primitive != users[i - 1]->primitive;
        users[i]->tangents = jobs.tangents[k];
        users[i]->has_corner_tangents = true;
    }
    for (k = 0; k < unique; k++)
        set->tangent_blocks[set->tangent_block_count++] = jobs.tangents[k];
    result = (facet_result)atomic_load(&jobs.result);
    if (result != FACET_OK)
        result = fail_memory(error, "tangents", (size_t)unique * sizeof(float));
done:
    mem_free(users);
    mem_free(jobs.primitives);
    mem_free(jobs.materials);
    mem_free(jobs.tangents);
    return result;
}
