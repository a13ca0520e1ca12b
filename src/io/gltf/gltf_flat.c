/* gltf_flat.c - normals that the file does not have: flat ones (glTF 2.0 section 3.7.2.1), and stand-ins for normals
 * of length 0. */
#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "io/gltf/gltf_reader.h"

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

/* An array of the primitive that is spread: every corner gets its own element. */
typedef struct stream {
    const void *in;
    void *out;
    size_t size; /* bytes per vertex */
} stream;

typedef struct spreading {
    const scene_primitive *in;
    float *normals;
    stream *streams;
    size_t stream_count;
} spreading;

/* One case per size that is common: the compiler makes each a loop of plain moves. */
static void spread_stream(const stream *s, const uint32_t *corners, size_t begin, size_t end)
{
    const char *in = s->in;
    char *out = s->out;
    switch (s->size) {
    case 8:
        for (size_t i = begin; i < end; i++)
            memcpy(out + 8 * i, in + 8 * (size_t)corners[i], 8);
        break;
    case 12:
        for (size_t i = begin; i < end; i++)
            memcpy(out + 12 * i, in + 12 * (size_t)corners[i], 12);
        break;
    case 16:
        for (size_t i = begin; i < end; i++)
            memcpy(out + 16 * i, in + 16 * (size_t)corners[i], 16);
        break;
    default:
        for (size_t i = begin; i < end; i++)
            memcpy(out + s->size * i, in + s->size * corners[i], s->size);
    }
}

static void spread(void *context, size_t begin, size_t end)
{
    const spreading *s = context;
    for (size_t triangle = begin; triangle < end; triangle++) {
        double vector[3];
        face_vector(s->in, s->in->indices + 3 * triangle, vector);
        store_unit(vector, s->normals + 9 * triangle);
        memcpy(s->normals + 9 * triangle + 3, s->normals + 9 * triangle, 3 * sizeof(float));
        memcpy(s->normals + 9 * triangle + 6, s->normals + 9 * triangle, 3 * sizeof(float));
    }
    for (size_t i = 0; i < s->stream_count; i++)
        spread_stream(&s->streams[i], s->in->indices, 3 * begin, 3 * end);
}

/* Adds an array of elements of size bytes to what is spread. Returns where it will be; NULL: in is NULL, or an error
 * is recorded. */
static void *add_stream(io_reader *r, spreading *s, const void *in, size_t size)
{
    void *out = in ? io_alloc_raw(r, "vertices", s->in->index_count, size) : NULL;
    if (out)
        s->streams[s->stream_count++] = (stream){in, out, size};
    return out;
}

/* All arrays of the primitive but normals and tangents, which a flat one has no use for. */
static void add_streams(io_reader *r, spreading *s, scene_primitive *out)
{
    const scene_primitive *in = s->in;
    const float **texcoords = io_alloc(r, "vertices", in->texcoord_count, sizeof *texcoords);
    scene_morph_target *targets = io_alloc(r, "morph targets", in->target_count, sizeof *targets);
    if (!texcoords || !targets)
        return;
    out->positions = add_stream(r, s, in->positions, 3 * sizeof(float));
    out->colors = add_stream(r, s, in->colors, 4 * sizeof(float));
    for (uint32_t i = 0; i < in->texcoord_count; i++)
        texcoords[i] = add_stream(r, s, in->texcoords[i], 2 * sizeof(float));
    out->joints = add_stream(r, s, in->joints, in->influence_count * sizeof *in->joints);
    out->weights = add_stream(r, s, in->weights, in->influence_count * sizeof *in->weights);
    for (uint32_t i = 0; i < in->target_count; i++)
        targets[i].positions = add_stream(r, s, in->targets[i].positions, 3 * sizeof(float));
    out->texcoords = texcoords;
    out->targets = in->target_count ? targets : NULL;
}

bool gltf_make_flat(io_reader *r, const json_place *at, scene_primitive *p)
{
    size_t count = p->index_count;
    const scene_primitive in = *p;
    size_t arrays = 4 + (size_t)in.texcoord_count + in.target_count;
    if (!io_spend(r, at, count * (1 + arrays + in.influence_count / 4)))
        return false;
    spreading s = {.in = &in, .streams = mem_alloc(r->allocator, arrays, sizeof *s.streams)};
    if (!s.streams)
        return io_fail_memory(r, "vertices", arrays * sizeof *s.streams);
    scene_primitive out = in;
    add_streams(r, &s, &out);
    out.normals = s.normals = io_alloc_raw(r, "normals", count, 3 * sizeof(float));
    uint32_t *indices = io_alloc_raw(r, "indices", count, sizeof *indices);
    if (io_is_ok(r)) {
        parallel_for(r->thread_count, count / 3, GRAIN, spread, &s);
        for (size_t i = 0; i < count; i++)
            indices[i] = (uint32_t)i;
        out.vertex_count = (uint32_t)count;
        out.indices = indices;
        out.tangents = NULL;
        out.has_flat_normals = true;
        *p = out;
    }
    mem_free(s.streams);
    return io_is_ok(r);
}

bool gltf_fill_missing_normals(io_reader *r, const json_place *at, scene_primitive *p)
{
    double *sums = mem_zalloc(r->allocator, p->vertex_count, 3 * sizeof *sums);
    float *normals = io_alloc_raw(r, "normals", p->vertex_count, 3 * sizeof *normals);
    if (!sums || !normals || !io_spend(r, at, p->vertex_count)) {
        mem_free(sums);
        return io_fail_memory(r, "normals", (size_t)p->vertex_count * 3 * sizeof *sums);
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
