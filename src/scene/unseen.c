/* unseen.c - see unseen.h. */
#include "scene/unseen.h"

#include <string.h>

#include "base/parallel.h"
#include "scene/box.h"

/* ---- opacity ---- */

/* The largest opacity at the vertices in use. */
static float largest_alpha(const scene_primitive *p)
{
    float most = 0.0f;
    for (uint32_t i = 0; i < p->index_count && most < 1.0f; i++) {
        float alpha = p->colors[4 * (size_t)p->indices[i] + 3];
        most = alpha > most ? alpha : most;
    }
    return most;
}

bool unseen_is_transparent(const scene_primitive *primitive, const scene_material *material)
{
    if (material->alpha_mode == SCENE_ALPHA_OPAQUE)
        return false;
    float alpha = material->base_color[3] * (primitive->colors ? largest_alpha(primitive) : 1.0f);
    return material->alpha_mode == SCENE_ALPHA_MASK ? alpha < material->alpha_cutoff : !(alpha > 0.0f);
}

/* ---- area ---- */

static const double FLAT = 1e-7; /* ratio of a triangle's height to its longest edge */

static double edge(const float *a, const float *b, double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = (double)b[k] - (double)a[k];
    return out[0] * out[0] + out[1] * out[1] + out[2] * out[2];
}

bool unseen_is_flat(const float *positions, const uint32_t corners[3])
{
    const float *a = positions + 3 * (size_t)corners[0];
    const float *b = positions + 3 * (size_t)corners[1];
    const float *c = positions + 3 * (size_t)corners[2];
    double u[3];
    double v[3];
    double w[3];
    double longest2 = fmax(fmax(edge(a, b, u), edge(a, c, v)), edge(b, c, w));
    double x = u[1] * v[2] - u[2] * v[1];
    double y = u[2] * v[0] - u[0] * v[2];
    double z = u[0] * v[1] - u[1] * v[0];
    return !(x * x + y * y + z * z > FLAT * FLAT * longest2 * longest2);
}

enum { GRAIN = 1 << 14 }; /* triangles per work item */

typedef struct tighten_job {
    const scene_primitive *primitive;
    box *boxes; /* one per work item */
} tighten_job;

static void tighten_body(void *context, size_t begin, size_t end)
{
    const tighten_job *job = context;
    const scene_primitive *p = job->primitive;
    box b = box_empty();
    for (size_t i = begin; i < end; i++) {
        const uint32_t *corners = p->indices + 3 * i;
        if (unseen_is_flat(p->positions, corners))
            continue;
        for (int k = 0; k < 3; k++)
            box_add(&b, p->positions + 3 * (size_t)corners[k]);
    }
    job->boxes[begin / GRAIN] = b;
}

static void tighten(scene_primitive *p, box *boxes, uint32_t thread_count)
{
    size_t count = p->index_count / 3;
    tighten_job job = {.primitive = p, .boxes = boxes};
    parallel_for(thread_count, count, GRAIN, tighten_body, &job);
    box all = box_empty();
    for (size_t i = 0; i < (count + GRAIN - 1) / GRAIN; i++)
        box_join(&all, &boxes[i]);
    p->is_flat = box_is_empty(&all);
    if (p->is_flat)
        return;
    p->has_flat_triangles = memcmp(all.minimum, p->bounds_min, sizeof all.minimum) != 0 ||
                            memcmp(all.maximum, p->bounds_max, sizeof all.maximum) != 0;
    memcpy(p->bounds_min, all.minimum, sizeof all.minimum);
    memcpy(p->bounds_max, all.maximum, sizeof all.maximum);
}

static bool is_fixed(const scene_primitive *p)
{
    return p->mode == SCENE_TRIANGLES && p->index_count && !p->target_count && !p->influence_count;
}

void unseen_tighten_bounds(facet_scene *scene)
{
    size_t most = 0;
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++) {
            const scene_primitive *p = &scene->meshes[i].primitives[k];
            most = is_fixed(p) && p->index_count > most ? p->index_count : most;
        }
    box *boxes = mem_alloc(&scene->allocator, most / 3 / GRAIN + 1, sizeof *boxes);
    if (!boxes)
        return; /* the existing bounds contain everything as well */
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++)
            if (is_fixed(&scene->meshes[i].primitives[k]))
                tighten(&scene->meshes[i].primitives[k], boxes, scene->thread_count);
    mem_free(boxes);
}
