/* bvh_scene.c - see bvh_scene.h: which trees a scene has, and when they are built again. */
#include "cpu/bvh_scene.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/result.h"
#include "cpu/bvh_items.h"
#include "cpu/visibility.h"

/* Shapes of fewer triangles are built side by side, one thread each. */
enum { LARGE_SHAPE = 1 << 15 };

static facet_result fail_hierarchy(facet_error *error)
{
    return fail(error, FACET_ERROR_MEMORY, "out of memory: bounding volume hierarchy");
}

/* ---- meshes ---- */

static void destroy_mesh(bvh_mesh *mesh)
{
    bvh4_destroy(&mesh->tree);
    mem_free(mesh->blocks);
    mesh->blocks = NULL;
}

static void destroy_list(bvh_list *list)
{
    bvh4_destroy(&list->tree);
    mem_free(list->blocks);
    list->blocks = NULL;
}

/* The geometries of a role, triangles or sprites. */
static facet_result list_role(const bvh_scene *s, render_role role, bool is_triangles, bvh_source **sources,
                              uint32_t *count, facet_error *error)
{
    const render_geometry_set *set = s->geometries;
    *count = 0;
    *sources = mem_alloc(&s->allocator, set->count, sizeof **sources);
    if (!*sources)
        return fail_hierarchy(error);
    for (uint32_t i = 0; i < set->count; i++) {
        const render_geometry *g = &set->items[i];
        if (g->role == role && (g->primitive->mode == SCENE_TRIANGLES) == is_triangles)
            (*sources)[(*count)++] =
                (bvh_source){.primitive = g->primitive, .vertices = g->vertices, .geometry = i};
    }
    return FACET_OK;
}

static facet_result build_role(bvh_scene *s, render_role role, uint32_t threads, bvh_mesh *out,
                               facet_error *error)
{
    bvh_source *sources = NULL;
    uint32_t count = 0;
    facet_result result = list_role(s, role, true, &sources, &count, error);
    if (result == FACET_OK)
        result = bvh_build_mesh(sources, count, threads, &s->allocator, out, error);
    mem_free(sources);
    return result;
}

static facet_result build_sprites(bvh_scene *s, uint32_t threads, facet_error *error)
{
    bvh_source *sources = NULL;
    uint32_t count = 0;
    destroy_list(&s->sprites);
    if (!s->geometries->has_sprites)
        return FACET_OK;
    facet_result result = list_role(s, RENDER_FLAT, false, &sources, &count, error);
    if (result == FACET_OK)
        result = bvh_build_sprites(sources, count, threads, &s->allocator, &s->sprites, error);
    mem_free(sources);
    return result;
}

/* ---- shapes ---- */

typedef struct shapes_job {
    bvh_scene *scene;
    uint32_t threads; /* per shape */
    bool are_large;
    facet_error *errors; /* per shape */
    facet_result *results;
} shapes_job;

static void build_shape_range(void *context, size_t begin, size_t end)
{
    const shapes_job *job = context;
    bvh_scene *s = job->scene;
    for (size_t i = begin; i < end; i++) {
        const render_shape *shape = &s->geometries->shapes[i];
        const bool is_large = shape->primitive->index_count / 3 >= LARGE_SHAPE;
        if (s->has_shapes[i] || is_large != job->are_large)
            continue;
        bvh_source source = {.primitive = shape->primitive, .vertices = shape->vertices};
        job->results[i] =
            bvh_build_mesh(&source, 1, job->threads, &s->allocator, &s->shapes[i], &job->errors[i]);
        s->has_shapes[i] = job->results[i] == FACET_OK;
    }
}

static facet_result build_shapes(bvh_scene *s, uint32_t threads, facet_error *error)
{
    const uint32_t count = s->geometries->shape_count;
    if (count == 0)
        return FACET_OK;
    if (!s->shapes) {
        s->shapes = mem_zalloc(&s->allocator, count, sizeof *s->shapes);
        s->has_shapes = mem_zalloc(&s->allocator, count, 1);
        s->shape_count = s->shapes && s->has_shapes ? count : 0;
    }
    facet_error *errors = mem_alloc(&s->allocator, count, sizeof *errors);
    facet_result *results = mem_zalloc(&s->allocator, count, sizeof *results);
    facet_result result = FACET_OK;
    if (!s->shape_count || !errors || !results) {
        result = fail_hierarchy(error);
    } else {
        shapes_job job = {
            .scene = s, .threads = threads, .are_large = true, .errors = errors, .results = results};
        build_shape_range(&job, 0, count);
        job.threads = 1;
        job.are_large = false;
        parallel_for(threads, count, 1, build_shape_range, &job);
    }
    for (uint32_t i = 0; i < count && result == FACET_OK; i++)
        if (results[i] != FACET_OK) {
            result = results[i];
            if (error)
                *error = errors[i];
        }
    mem_free(errors);
    mem_free(results);
    return result;
}

/* ---- instances ---- */

/* The matrix's inverse, in double: its cofactors over the determinant. */
static bvh_instance invert(const mat4 *world)
{
    const float *m = world->m;
    double inverse[3][3];
    double determinant = 0.0;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            /* The cofactor of (column, row): rows and columns of the rest in cyclic order. */
            const int r1 = (column + 1) % 3, r2 = (column + 2) % 3;
            const int c1 = (row + 1) % 3, c2 = (row + 2) % 3;
            inverse[row][column] = (double)m[4 * c1 + r1] * (double)m[4 * c2 + r2] -
                                   (double)m[4 * c1 + r2] * (double)m[4 * c2 + r1];
        }
    for (int row = 0; row < 3; row++)
        determinant += (double)m[row] * inverse[0][row];
    bvh_instance out;
    for (int row = 0; row < 3; row++) {
        double shift = 0.0;
        for (int column = 0; column < 3; column++) {
            out.to_object[4 * row + column] = (float)(inverse[row][column] / determinant);
            shift -= inverse[row][column] / determinant * (double)m[12 + column];
        }
        out.to_object[4 * row + 3] = (float)shift;
    }
    return out;
}

/* The box of a shape in world space, widened by the rounding of rays in its own. */
static bvh_item instance_item(const mat4 *world, const bvh_child *shape, uint32_t number)
{
    const float slack = 4e-6f;
    bvh_item item = {.geometry = number};
    for (int axis = 0; axis < 3; axis++) {
        float lo = world->m[12 + axis];
        float hi = lo;
        float size = fabsf(lo);
        for (int k = 0; k < 3; k++) {
            const float a = world->m[4 * k + axis] * shape->lo[k];
            const float b = world->m[4 * k + axis] * shape->hi[k];
            lo += fminf(a, b);
            hi += fmaxf(a, b);
            size += fmaxf(fabsf(a), fabsf(b));
        }
        item.lo[axis] = lo - slack * size;
        item.hi[axis] = hi + slack * size;
    }
    return item;
}

static facet_result build_instances(bvh_scene *s, uint32_t threads, facet_error *error)
{
    const render_geometry_set *set = s->geometries;
    destroy_list(&s->instances);
    if (s->shape_count == 0)
        return FACET_OK;
    bvh_item *items = mem_alloc(&s->allocator, set->count, sizeof *items);
    mem_free(s->places);
    s->places = mem_alloc(&s->allocator, set->count, sizeof *s->places);
    if (!items || !s->places) {
        mem_free(items);
        return fail_hierarchy(error);
    }
    uint32_t count = 0;
    for (uint32_t i = 0; i < set->count; i++) {
        const render_geometry *g = &set->items[i];
        if (g->role != RENDER_INSTANCED || s->shapes[g->shape].tree.root.child == BVH_EMPTY)
            continue;
        s->places[i] = invert(g->world);
        items[count] = instance_item(g->world, &s->shapes[g->shape].tree.root, i);
        count += bvh_item_is_valid(&items[count]);
    }
    const facet_result result = bvh_build_list(items, count, threads, &s->allocator, &s->instances, error);
    mem_free(items);
    return result;
}

/* ---- the scene ---- */

static void destroy_shapes(bvh_scene *s)
{
    for (uint32_t i = 0; i < s->shape_count; i++)
        destroy_mesh(&s->shapes[i]);
    mem_free(s->shapes);
    mem_free(s->has_shapes);
    s->shapes = NULL;
    s->has_shapes = NULL;
    s->shape_count = 0;
}

static facet_result build(bvh_scene *s, uint32_t threads, facet_error *error)
{
    destroy_mesh(&s->flat);
    TRY(build_role(s, RENDER_FLAT, threads, &s->flat, error));
    if (!s->has_still && s->geometries->is_animated)
        TRY(build_role(s, RENDER_STILL, threads, &s->still, error));
    s->has_still = s->geometries->is_animated;
    TRY(build_shapes(s, threads, error));
    TRY(build_instances(s, threads, error));
    return build_sprites(s, threads, error);
}

/* Releases what has to be built again although it may be kept. */
static void drop(bvh_scene *s, render_likeness likeness)
{
    if (likeness == RENDER_OTHER) {
        destroy_mesh(&s->still);
        s->has_still = false;
        destroy_shapes(s);
        return;
    }
    for (uint32_t i = 0; i < s->shape_count; i++) {
        const render_shape *shape = &s->geometries->shapes[i];
        if (shape->positions == shape->primitive->positions)
            continue;
        destroy_mesh(&s->shapes[i]);
        s->has_shapes[i] = false;
    }
}

static void destroy(void *bvh)
{
    bvh_scene *s = bvh;
    destroy_mesh(&s->flat);
    destroy_mesh(&s->still);
    destroy_shapes(s);
    destroy_list(&s->sprites);
    destroy_list(&s->instances);
    mem_free(s->places);
    mem_free(s);
}

static facet_result create(const render_geometry_set *set, const ray_scene_desc *desc,
                           const facet_allocator *allocator, void **bvh, facet_error *error)
{
    bvh_scene *s = mem_zalloc(allocator, 1, sizeof *s);
    *bvh = NULL;
    if (!s)
        return fail_hierarchy(error);
    s->allocator = *allocator;
    s->geometries = set;
    s->flat.tree.root.child = s->still.tree.root.child = BVH_EMPTY;
    s->sprites.tree.root.child = s->instances.tree.root.child = BVH_EMPTY;
    const facet_result result = build(s, desc->thread_count, error);
    if (result != FACET_OK) {
        destroy(s);
        return result;
    }
    *bvh = s;
    return FACET_OK;
}

static facet_result update(void *bvh, const ray_scene_desc *desc, render_likeness likeness,
                           bool has_moved_sprites, facet_error *error)
{
    bvh_scene *s = bvh;
    if (likeness == RENDER_SAME)
        return has_moved_sprites ? build_sprites(s, desc->thread_count, error) : FACET_OK;
    drop(s, likeness);
    return build(s, desc->thread_count, error);
}

static void widen(const bvh_child *root, float minimum[3], float maximum[3])
{
    if (root->child == BVH_EMPTY)
        return;
    for (int i = 0; i < 3; i++) {
        minimum[i] = fminf(minimum[i], root->lo[i]);
        maximum[i] = fmaxf(maximum[i], root->hi[i]);
    }
}

static void bounds(const void *bvh, float minimum[3], float maximum[3])
{
    const bvh_scene *s = bvh;
    const bvh_child *roots[] = {&s->flat.tree.root, &s->still.tree.root, &s->sprites.tree.root,
                                &s->instances.tree.root};
    for (int i = 0; i < 3; i++) {
        minimum[i] = INFINITY;
        maximum[i] = -INFINITY;
    }
    for (size_t i = 0; i < sizeof roots / sizeof *roots; i++)
        widen(roots[i], minimum, maximum);
}

static bool nearest(const void *bvh, const ray_segment *ray, visibility_hit *hit)
{
    return bvh_nearest(bvh, ray, hit);
}

static bool nearest_filtered(const void *bvh, const ray_segment *ray, ray_filter filter, void *context,
                             visibility_hit *hit)
{
    return bvh_nearest_filtered(bvh, ray, filter, context, hit);
}

static bool occluded(const void *bvh, const ray_segment *ray)
{
    return bvh_occluded(bvh, ray);
}

static bool occluded_filtered(const void *bvh, const ray_segment *ray, ray_filter filter, void *context)
{
    return bvh_occluded_filtered(bvh, ray, filter, context);
}

static void block(const void *bvh, const camera_rays *camera, uint32_t x, uint32_t y,
                  const visibility_pattern *pattern, visibility_hit *hits)
{
    const uint32_t ray_count = VISIBILITY_BLOCK_PIXELS * pattern->sample_count;
    ray_segment ray = {.near_t = camera->near_m, .far_t = camera->far_m};
    for (uint32_t i = 0; i < ray_count; i++) {
        camera_rays_at(camera, (float)x + pattern->offset_x[i], (float)y + pattern->offset_y[i], ray.origin,
                       ray.direction);
        if (!bvh_nearest(bvh, &ray, &hits[i]))
            hits[i].geometry = VISIBILITY_NONE;
    }
}

const ray_tracer bvh_tracer = {.create = create,
                               .update = update,
                               .destroy = destroy,
                               .bounds = bounds,
                               .nearest = nearest,
                               .nearest_filtered = nearest_filtered,
                               .occluded = occluded,
                               .occluded_filtered = occluded_filtered,
                               .block = block};
