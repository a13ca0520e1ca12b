/* sphere.c - see sphere.h. */
#include "scene/sphere.h"

#include <math.h>
#include <string.h>

typedef struct sphere_arrays {
    float *positions, *normals, *uvs;
    const float **sets;
    uint32_t *indices;
} sphere_arrays;

static void fill_vertices(const sphere_arrays *a, uint32_t segments, uint32_t rings)
{
    const double pi = 3.14159265358979323846;
    size_t at = 0;
    for (uint32_t ring = 0; ring <= rings; ring++)
        for (uint32_t segment = 0; segment <= segments; segment++, at++) {
            double polar = pi * ring / rings;
            double azimuth = 2.0 * pi * (segment % segments) / segments;
            double radius = ring == 0 || ring == rings ? 0.0 : sin(polar);
            float *normal = a->normals + 3 * at;
            normal[0] = (float)(-radius * sin(azimuth));
            normal[1] = (float)cos(polar);
            normal[2] = (float)(-radius * cos(azimuth));
            memcpy(a->positions + 3 * at, normal, 3 * sizeof *normal);
            a->uvs[2 * at] = (float)segment / (float)segments;
            a->uvs[2 * at + 1] = (float)ring / (float)rings;
        }
}

/* Triangles at the poles have one corner there. Returns the number of indices. */
static uint32_t fill_indices(uint32_t *indices, uint32_t segments, uint32_t rings)
{
    uint32_t count = 0;
    for (uint32_t ring = 0; ring < rings; ring++)
        for (uint32_t segment = 0; segment < segments; segment++) {
            uint32_t above = ring * (segments + 1) + segment;
            uint32_t below = above + segments + 1;
            const uint32_t quad[6] = {above, below, below + 1, above, below + 1, above + 1};
            uint32_t begin = ring == rings - 1 ? 3 : 0;
            uint32_t end = ring == 0 ? 3 : 6;
            for (uint32_t k = begin; k < end; k++)
                indices[count++] = quad[k];
        }
    return count;
}

/* Bounds narrower than 1 where no segment points along an axis. */
static void find_bounds(scene_primitive *p)
{
    for (int k = 0; k < 3; k++) {
        p->bounds_min[k] = p->bounds_max[k] = p->positions[k];
        for (size_t i = 0; i < p->vertex_count; i++) {
            p->bounds_min[k] = fminf(p->bounds_min[k], p->positions[3 * i + (size_t)k]);
            p->bounds_max[k] = fmaxf(p->bounds_max[k], p->positions[3 * i + (size_t)k]);
        }
    }
}

bool scene_make_sphere(arena *memory, uint32_t segments, uint32_t rings, scene_primitive *out)
{
    uint32_t count = (segments + 1) * (rings + 1);
    const sphere_arrays a = {.positions = arena_alloc(memory, count, 3 * sizeof(float)),
                             .normals = arena_alloc(memory, count, 3 * sizeof(float)),
                             .uvs = arena_alloc(memory, count, 2 * sizeof(float)),
                             .sets = arena_alloc(memory, 1, sizeof(float *)),
                             .indices =
                                 arena_alloc(memory, (size_t)6 * segments * (rings - 1), sizeof(uint32_t))};
    if (!a.positions || !a.normals || !a.uvs || !a.sets || !a.indices)
        return false;
    fill_vertices(&a, segments, rings);
    a.sets[0] = a.uvs;
    *out = (scene_primitive){.mode = SCENE_TRIANGLES,
                             .vertex_count = count,
                             .index_count = fill_indices(a.indices, segments, rings),
                             .indices = a.indices,
                             .positions = a.positions,
                             .normals = a.normals,
                             .texcoord_count = 1,
                             .texcoords = a.sets,
                             .material = SCENE_NONE};
    find_bounds(out);
    return true;
}
