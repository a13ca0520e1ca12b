/* gltf_flat.c - normals that the file does not have: flat ones (glTF 2.0 section 3.7.2.1), and stand-ins for normals
 * of length 0. */
#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "io/gltf_reader.h"

enum { GRAIN = 1 << 14 };

/* Twice the area times the normal, in double: tiny and huge triangles keep a direction. */
static void face_vector(const scene_primitive *p, const uint32_t corners[3], double out[3])
{
    const float *a = p->positions + 3 * (size_t)corners[0];
    const float *b = p->positions + 3 * (size_t)corners[1];
    const float *c = p->positions + 3 * (size_t)corners[2];
    double u[3];
    double v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = (double)b[k] - (double)a[k];
        v[k] = (double)c[k] - (double)a[k];
    }
    out[0] = u[1] * v[2] - u[2] * v[1];
    out[1] = u[2] * v[0] - u[0] * v[2];
    out[2] = u[0] * v[1] - u[1] * v[0];
}

/* Something without direction, as a triangle without area, gets +Y: nobody sees it. */
static void store_unit(const double v[3], float out[3])
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++)
        out[k] = length > 0.0 ? (float)(v[k] / length) : k == 1 ? 1.0f : 0.0f;
}

/* One primitive before and after, and a component count for each array that is spread. */
typedef struct spreading {
    const scene_primitive *in;
    float *positions, *normals, *colors;
    float **texcoords;
} spreading;

static void spread(void *context, size_t begin, size_t end)
{
    const spreading *s = context;
    const scene_primitive *in = s->in;
    for (size_t triangle = begin; triangle < end; triangle++) {
        const uint32_t *corners = in->indices + 3 * triangle;
        double vector[3];
        float normal[3];
        face_vector(in, corners, vector);
        store_unit(vector, normal);
        for (size_t k = 0; k < 3; k++) {
            size_t to = 3 * triangle + k;
            size_t from = corners[k];
            memcpy(s->normals + 3 * to, normal, sizeof normal);
            memcpy(s->positions + 3 * to, in->positions + 3 * from, 3 * sizeof(float));
            if (in->colors)
                memcpy(s->colors + 4 * to, in->colors + 4 * from, 4 * sizeof(float));
            for (uint32_t set = 0; set < in->texcoord_count; set++)
                memcpy(s->texcoords[set] + 2 * to, in->texcoords[set] + 2 * from, 2 * sizeof(float));
        }
    }
}

bool make_flat(reader *r, const json_place *at, scene_primitive *p)
{
    size_t count = p->index_count;
    const scene_primitive in = *p;
    if (!reader_spend(r, at, count * (2 + in.texcoord_count)))
        return false;
    spreading s = {.in = &in,
                   .positions = reader_alloc_raw(r, "positions", count, 3 * sizeof(float)),
                   .normals = reader_alloc_raw(r, "normals", count, 3 * sizeof(float)),
                   .texcoords = reader_alloc(r, "texture coordinates", in.texcoord_count, sizeof(float *))};
    if (in.colors)
        s.colors = reader_alloc_raw(r, "colors", count, 4 * sizeof(float));
    for (uint32_t set = 0; set < in.texcoord_count && s.texcoords; set++)
        s.texcoords[set] = reader_alloc_raw(r, "texture coordinates", count, 2 * sizeof(float));
    uint32_t *indices = reader_alloc_raw(r, "indices", count, sizeof *indices);
    if (!reader_is_ok(r))
        return false;
    parallel_for(r->thread_count, count / 3, GRAIN, spread, &s);
    for (size_t i = 0; i < count; i++)
        indices[i] = (uint32_t)i;
    p->vertex_count = (uint32_t)count;
    p->indices = indices;
    p->positions = s.positions;
    p->normals = s.normals;
    p->colors = s.colors;
    p->texcoords = (const float *const *)s.texcoords;
    p->tangents = NULL;
    p->has_flat_normals = true;
    return true;
}

bool fill_missing_normals(reader *r, const json_place *at, scene_primitive *p)
{
    double *sums = mem_zalloc(r->allocator, p->vertex_count, 3 * sizeof *sums);
    float *normals = reader_alloc_raw(r, "normals", p->vertex_count, 3 * sizeof *normals);
    if (!sums || !normals || !reader_spend(r, at, p->vertex_count)) {
        mem_free(sums);
        return reader_fail_memory(r, "normals", (size_t)p->vertex_count * 3 * sizeof *sums);
    }
    for (size_t i = 0; p->mode == SCENE_TRIANGLES && i < p->index_count; i += 3) {
        double vector[3];
        face_vector(p, p->indices + i, vector);
        for (size_t k = 0; k < 3; k++)
            for (size_t axis = 0; axis < 3; axis++)
                sums[3 * (size_t)p->indices[i + k] + axis] += vector[axis];
    }
    memcpy(normals, p->normals, (size_t)p->vertex_count * 3 * sizeof *normals);
    for (size_t i = 0; i < p->vertex_count; i++) {
        float *normal = normals + 3 * i;
        if (normal[0] == 0.0f && normal[1] == 0.0f && normal[2] == 0.0f)
            store_unit(sums + 3 * i, normal);
    }
    mem_free(sums);
    p->normals = normals;
    return true;
}
