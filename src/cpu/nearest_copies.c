/* nearest_copies.c - see nearest_copies.h. */
#include "cpu/nearest_copies.h"

#include <math.h>

#include "base/memory.h"
#include "base/result.h"

typedef struct sphere {
    float center[3], radius; /* world, m */
    float scale;             /* of world: the longest of its axes */
} sphere;

static float length3(const float v[3])
{
    return sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static float dot3(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static sphere bounding_sphere(const render_geometry *g)
{
    const scene_primitive *p = g->primitive;
    sphere s = {.scale = 0.0f};
    float middle[3];
    float half[3];
    for (int i = 0; i < 3; i++) {
        middle[i] = 0.5f * (p->bounds_min[i] + p->bounds_max[i]);
        half[i] = 0.5f * (p->bounds_max[i] - p->bounds_min[i]);
        s.scale = fmaxf(s.scale, length3(g->world->m + 4 * i));
    }
    mat4_transform_point(g->world, middle, s.center);
    s.radius = length3(half) * s.scale;
    return s;
}

/* Size of a pixel at the nearest point of the copy, in the units of its mesh; infinity: it is not in the picture. */
static float pixel_size(const render_geometry *g, const camera_rays *camera, uint32_t width, uint32_t height)
{
    const float *dx = camera->is_orthographic ? camera->origin_dx : camera->direction_dx;
    const float *dy = camera->is_orthographic ? camera->origin_dy : camera->direction_dy;
    sphere s = bounding_sphere(g);
    float d[3];
    for (int i = 0; i < 3; i++)
        d[i] = s.center[i] - camera->origin[i];
    float depth = dot3(d, camera->direction);
    if (depth + s.radius < camera->near_m)
        return INFINITY;
    float nearest = fmaxf(depth - s.radius, camera->near_m);
    float pixel = camera_rays_pixel_size(camera, nearest);
    if (!(pixel > 0.0f))
        return 0.0f; /* around the camera */
    float pixel2 = camera->pixel_size * camera->pixel_size * (camera->is_orthographic ? 1.0f : depth);
    float x = dot3(d, dx) / pixel2 + camera->middle[0];
    float y = dot3(d, dy) / pixel2 + camera->middle[1];
    float radius = s.radius / pixel;
    if (x + radius < 0.0f || y + radius < 0.0f || x - radius > (float)width || y - radius > (float)height)
        return INFINITY;
    return pixel / s.scale;
}

/* Keeps the NEAREST_COPIES smallest, sorted. */
static void insert(float *smallest, float value)
{
    int place = NEAREST_COPIES;
    if (!(value < smallest[NEAREST_COPIES - 1]))
        return;
    while (place > 0 && value < smallest[place - 1]) {
        if (place < NEAREST_COPIES)
            smallest[place] = smallest[place - 1];
        place--;
    }
    smallest[place] = value;
}

static bool has_many(const render_geometry_set *set, const render_geometry *g)
{
    return g->role == RENDER_INSTANCED && set->shapes[g->shape].use_count > NEAREST_COPIES;
}

facet_result nearest_copies_choose(render_geometry_set *set, const camera_rays *camera, uint32_t width,
                                   uint32_t height, const facet_allocator *allocator, facet_error *error)
{
    bool is_needed = false;
    for (uint32_t i = 0; i < set->shape_count; i++)
        is_needed = is_needed || set->shapes[i].use_count > NEAREST_COPIES;
    if (!is_needed)
        return FACET_OK;
    float *smallest = mem_alloc(allocator, (size_t)set->shape_count * NEAREST_COPIES, sizeof *smallest);
    float *sizes = mem_alloc(allocator, set->count, sizeof *sizes);
    bool has_memory = smallest && sizes;
    for (size_t i = 0; has_memory && i < (size_t)set->shape_count * NEAREST_COPIES; i++)
        smallest[i] = INFINITY;
    for (uint32_t i = 0; has_memory && i < set->count; i++) {
        const render_geometry *g = &set->items[i];
        if (!has_many(set, g))
            continue;
        sizes[i] = pixel_size(g, camera, width, height);
        insert(smallest + (size_t)g->shape * NEAREST_COPIES, sizes[i]);
    }
    for (uint32_t i = 0; has_memory && i < set->count; i++) {
        render_geometry *g = &set->items[i];
        if (!has_many(set, g))
            continue;
        float *of_shape = smallest + (size_t)g->shape * NEAREST_COPIES;
        g->is_far_copy = !(sizes[i] <= of_shape[NEAREST_COPIES - 1] && sizes[i] < INFINITY);
        if (of_shape[0] == INFINITY) { /* none is in the picture: the first stands for all */
            g->is_far_copy = false;
            of_shape[0] = 0.0f;
        }
    }
    mem_free(smallest);
    mem_free(sizes);
    return has_memory ? FACET_OK : fail_memory(error, "instances", set->count * sizeof *sizes);
}
