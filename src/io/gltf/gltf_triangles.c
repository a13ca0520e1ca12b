/* gltf_triangles.c - the index list of a primitive (glTF 2.0 section 3.7.2.1): read or counted, checked,
 * strips, fans and loops unrolled to lists, without the elements that use lost or missing vertices; and
 * normals that the file lacks: flat ones, and replacements for normals of length 0. */
#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "io/gltf/gltf_reader.h"

/* ---- indices ---- */

enum { POINTS, LINES, LINE_LOOP, LINE_STRIP, TRIANGLES, TRIANGLE_STRIP, TRIANGLE_FAN, MODE_COUNT };

/* 0, 1, .. count - 1; one array is shared by all primitives. */
static const uint32_t *get_iota(io_reader *r, uint32_t count)
{
    if (r->gltf->iota && r->gltf->iota_count >= count)
        return r->gltf->iota;
    uint32_t capacity = r->gltf->iota_count > UINT32_MAX / 2 || 2 * r->gltf->iota_count < count
                            ? count
                            : 2 * r->gltf->iota_count;
    uint32_t *iota = io_alloc_raw(r, "indices", capacity, sizeof *iota);
    if (!iota)
        return NULL;
    for (uint32_t i = 0; i < capacity; i++)
        iota[i] = i;
    r->gltf->iota = iota;
    r->gltf->iota_count = capacity;
    return iota;
}

/* ---- modes ---- */

/* Whether elements share vertices, so that the list has to be unrolled. */
static bool is_connected(unsigned mode)
{
    return mode == LINE_LOOP || mode == LINE_STRIP || mode == TRIANGLE_STRIP || mode == TRIANGLE_FAN;
}

/* The length of the list that in indices of a mode unroll to. */
static uint64_t list_length(unsigned mode, uint32_t in)
{
    switch (mode) {
    case LINES:
        return in - in % 2;
    case LINE_LOOP:
        return in < 2 ? 0 : 2 * (uint64_t)in;
    case LINE_STRIP:
        return in < 2 ? 0 : 2 * (uint64_t)(in - 1);
    case TRIANGLES:
        return in - in % 3;
    case TRIANGLE_STRIP:
    case TRIANGLE_FAN:
        return in < 3 ? 0 : 3 * (uint64_t)(in - 2);
    default:
        return in;
    }
}

static void unroll(unsigned mode, const uint32_t *in, uint32_t in_count, uint32_t *out, size_t out_count)
{
    if (mode == LINE_LOOP || mode == LINE_STRIP)
        for (size_t i = 0; 2 * i < out_count; i++) {
            out[2 * i] = in[i];
            out[2 * i + 1] = in[(i + 1) % in_count];
        }
    else if (mode == TRIANGLE_STRIP) /* every second triangle is reversed, to keep the winding */
        for (size_t i = 0; 3 * i < out_count; i++) {
            out[3 * i] = in[i];
            out[3 * i + 1] = in[i + 1 + i % 2];
            out[3 * i + 2] = in[i + 2 - i % 2];
        }
    else
        for (size_t i = 0; 3 * i < out_count; i++) {
            out[3 * i] = in[i + 1];
            out[3 * i + 1] = in[i + 2];
            out[3 * i + 2] = in[0];
        }
}

/* ---- primitive restart ---- */

/* The indices of the accessor. */
typedef struct index_source {
    const uint32_t *indices;
    uint32_t count;
    uint32_t largest;
    uint32_t restart; /* the largest value of the component type */
    bool has_restarts;
} index_source;

/* The end of the strip, loop or fan that begins at the index: a restart or the end of the indices. */
static uint32_t find_end(const index_source *s, uint32_t begin)
{
    uint32_t end = begin;
    while (end < s->count && !(s->has_restarts && s->indices[end] == s->restart))
        end++;
    return end;
}

/* The length of the list that all strips, loops or fans of the source unroll to. */
static uint64_t total_length(unsigned mode, const index_source *s)
{
    uint64_t total = 0;
    if (!s->has_restarts)
        return list_length(mode, s->count);
    for (uint32_t begin = 0; begin < s->count;) {
        uint32_t end = find_end(s, begin);
        total += list_length(mode, end - begin);
        begin = end + 1;
    }
    return total;
}

static void unroll_all(unsigned mode, const index_source *s, uint32_t *out)
{
    for (uint64_t begin = 0; begin < s->count;) {
        uint32_t end = find_end(s, (uint32_t)begin);
        uint32_t length = end - (uint32_t)begin;
        size_t count = (size_t)list_length(mode, length);
        unroll(mode, s->indices + begin, length, out, count);
        out += count;
        begin = (uint64_t)end + 1;
    }
}

/* The largest value of a component type is not an index in glTF 2.0, but older exporters wrote it as one:
 * in lists it is an index. In strips, loops and fans it restarts the primitive if there is no such vertex,
 * or if the file has EXT_mesh_primitive_restart. (That extension itself groups ordinary primitives, which
 * are drawn.) */
static void find_restarts(io_reader *r, const json_place *at, unsigned mode, uint32_t vertex_count,
                          index_source *s)
{
    if (s->count == 0 || s->largest != s->restart)
        return;
    s->has_restarts = is_connected(mode) && (s->restart >= vertex_count ||
                                             gltf_is_extension_listed(r, "EXT_mesh_primitive_restart"));
    if (s->has_restarts)
        io_warn(r, at, "indices", "has the index %u, which is read as a primitive restart", s->restart);
    else if (s->restart < vertex_count)
        io_warn(r, at, "indices",
                "has the index %u, which glTF keeps for primitive restart; it is drawn as that vertex",
                s->restart);
}

/* ---- vertices that are lost or not there ---- */

/* Removes elements of a list, of `corners` corners each, that use lost or missing vertices; is_lost: NULL:
 * none. False: an error is recorded. */
static bool drop_unusable(io_reader *r, scene_primitive *p, size_t corners, const uint8_t *is_lost)
{
    uint32_t *out = io_alloc_raw(r, "indices", p->index_count, sizeof *out);
    if (!out)
        return false;
    uint32_t kept = 0;
    for (size_t i = 0; i + corners <= p->index_count; i += corners) {
        bool is_whole = true;
        for (size_t k = 0; k < corners; k++) {
            uint32_t vertex = p->indices[i + k];
            is_whole &= vertex < p->vertex_count && !(is_lost && is_lost[vertex]);
        }
        if (is_whole) {
            memcpy(out + kept, p->indices + i, corners * sizeof *out);
            kept += (uint32_t)corners;
        }
    }
    p->indices = out;
    p->index_count = kept;
    return true;
}

static void warn_missing_vertex(io_reader *r, const json_place *at, const index_source *s,
                                uint32_t vertex_count)
{
    uint32_t i = 0;
    while (s->indices[i] < vertex_count || (s->has_restarts && s->indices[i] == s->restart))
        if (++i == s->count)
            return;
    io_warn(r, at, "indices",
            "index %u is %u, but there are %u vertices; elements that use such indices are left out", i,
            s->indices[i], vertex_count);
}

/* ---- the primitive ---- */

/* The indices of a primitive; indices NULL: an error is recorded. If a bitstream has faces, *mode becomes
 * that of a list, whatever mode they were stored in, with a vertex per corner. */
static index_source find_indices(io_reader *r, const json_place *at, uint32_t vertex_count, unsigned *mode)
{
    uint32_t accessor = gltf_get_accessor(r, at, "indices");
    index_source s = {.count = vertex_count};
    if (r->gltf->faces) {
        s.indices = r->gltf->faces;
        s.count = 3 * r->gltf->face_count;
        *mode = TRIANGLES;
    } else if (accessor == SCENE_NONE) {
        s.indices = get_iota(r, vertex_count);
    } else {
        json_place place = {.parent = at, .key = "indices"};
        gltf_component c = r->gltf->accessors[accessor].component;
        s.indices = gltf_get_accessor_indices(r, &place, accessor, &s.largest);
        s.count = r->gltf->accessors[accessor].count;
        s.restart = c == GLTF_U8 ? UINT8_MAX : c == GLTF_U16 ? UINT16_MAX : UINT32_MAX;
        if (s.indices)
            find_restarts(r, at, *mode, vertex_count, &s);
    }
    return s;
}

bool gltf_read_primitive_indices(io_reader *r, const json_place *at, scene_primitive *p,
                                 const uint8_t *is_lost)
{
    unsigned mode = (unsigned)io_get_uint(r, at, "mode", MODE_COUNT - 1, TRIANGLES);
    index_source in = find_indices(r, at, p->vertex_count, &mode);
    if (!io_is_ok(r))
        return false;

    static const uint8_t corners[MODE_COUNT] = {1, 2, 2, 2, 3, 3, 3};
    uint64_t count = total_length(mode, &in);
    p->mode = mode == POINTS ? SCENE_POINTS : mode < TRIANGLES ? SCENE_LINES : SCENE_TRIANGLES;
    if ((mode == LINES || mode == TRIANGLES) ? count != in.count : count == 0)
        io_note(r, at, NULL, "%u vertices do not make whole %s", in.count,
                p->mode == SCENE_LINES ? "lines" : "triangles");
    if (!io_spend(r, at, count)) /* later work is linear in it as well: bounds, flat normals */
        return false;
    p->index_count = (uint32_t)count;
    p->indices = in.indices;
    if (is_connected(mode)) {
        uint32_t *list = io_alloc_raw(r, "indices", count, sizeof *list);
        if (!list)
            return false;
        unroll_all(mode, &in, list);
        p->indices = list;
    }
    bool is_beyond = in.count > 0 && in.largest >= p->vertex_count;
    if (is_beyond)
        warn_missing_vertex(r, at, &in, p->vertex_count);
    return !(is_beyond || is_lost) || drop_unusable(r, p, corners[mode], is_lost);
}

/* ---- normals ---- */

enum { GRAIN = 1 << 14 };

/* Twice the area times the normal, in double, so that tiny and huge triangles keep a direction. */
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

/* A vector without direction, as of a triangle without area, becomes +Y; it is not visible. */
static void store_unit(const double v[3], float out[3])
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++)
        out[k] = length > 0.0 ? (float)(v[k] / length) : k == 1 ? 1.0f : 0.0f;
}

/* An array of a primitive that is unshared: every corner gets its own element. */
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

/* One case per common size, so that the compiler makes each a loop of plain moves. */
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

/* Adds an array of elements of size bytes to the arrays that are unshared. Returns its copy; NULL: in is
 * NULL, or an error is recorded. */
static void *add_stream(io_reader *r, spreading *s, const void *in, size_t size)
{
    void *out = in ? io_alloc_raw(r, "vertices", s->in->index_count, size) : NULL;
    if (out)
        s->streams[s->stream_count++] = (stream){in, out, size};
    return out;
}

/* All arrays of the primitive but normals and tangents, which flat shading replaces. */
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
