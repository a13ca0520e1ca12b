/* fuzz_scene.h - invariants of a scene with meshes; fuzz targets abort if one does not hold. */
#ifndef FUZZ_SCENE_H
#define FUZZ_SCENE_H

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/text.h"
#include "scene/scene.h"

/* Invariants of scene_primitive. */
static inline void fuzz_check_primitive(const facet_scene *scene, const scene_primitive *p)
{
    if (p->index_count == 0 || p->index_count % (p->mode == SCENE_TRIANGLES ? 3
                                                 : p->mode == SCENE_LINES   ? 2
                                                                            : 1))
        abort();
    if ((p->material != SCENE_NONE && p->material >= scene->material_count) ||
        (p->has_flat_normals && p->vertex_count != p->index_count) ||
        (p->normals != NULL) != (p->mode == SCENE_TRIANGLES))
        abort();
    for (size_t i = 0; i < p->index_count; i++) {
        size_t v = p->indices[i];
        if (v >= p->vertex_count)
            abort();
        for (size_t k = 0; k < 3; k++)
            if (!(p->positions[3 * v + k] >= p->bounds_min[k] &&
                  p->positions[3 * v + k] <= p->bounds_max[k]) ||
                !(fabsf(p->positions[3 * v + k]) <= SCENE_FARTHEST))
                abort();
        if (p->normals) {
            const float *n = p->normals + 3 * v;
            if (!(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1.0f) < 1e-4f))
                abort();
        }
        for (size_t k = 0; p->texcoord_count && k < 2; k++)
            if (!(fabsf(p->texcoords[0][2 * v + k]) < 1e31f))
                abort();
        for (size_t k = 0; p->colors && k < 4; k++)
            if (!(p->colors[4 * v + k] >= 0.0f && p->colors[4 * v + k] <= 1.0f))
                abort();
    }
}

static inline void fuzz_use_scene(const facet_scene *scene, const facet_allocator *allocator)
{
    if (scene->scene_count != 1 || scene->default_scene != 0)
        abort();
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++)
            fuzz_check_primitive(scene, &scene->meshes[i].primitives[k]);
    text t = {.allocator = *allocator};
    scene_describe_json(scene, &t);
    text_destroy(&t);
}

#endif
