/* gltf_indices.c - the index list of a primitive: read or counted, checked, strips and fans and loops made lists
 * (glTF 2.0 section 3.7.2.1); what uses lost or missing vertices is left out. */
#include <string.h>

#include "io/gltf/gltf_reader.h"

enum { POINTS, LINES, LINE_LOOP, LINE_STRIP, TRIANGLES, TRIANGLE_STRIP, TRIANGLE_FAN, MODE_COUNT };

/* 0, 1, .. count - 1; one array serves all primitives. */
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

/* How many indices the list has that in indices in make. */
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
    else if (mode == TRIANGLE_STRIP) /* every second one turns round, to face the same way */
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

/* Indices as the accessor has them. */
typedef struct index_source {
    const uint32_t *indices;
    uint32_t count;
    uint32_t largest;
    uint32_t restart; /* the largest number of the component type */
    bool has_restarts;
} index_source;

/* The end of the strip, loop or fan that begins there: a restart or the end of the indices. */
static uint32_t find_end(const index_source *s, uint32_t begin)
{
    uint32_t end = begin;
    while (end < s->count && !(s->has_restarts && s->indices[end] == s->restart))
        end++;
    return end;
}

/* How many indices the list has that all strips, loops or fans of the source make. */
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

/* The largest number of a component type is no index in glTF 2.0, but was written as one before that rule came, and is:
 * lists know no restart. In strips, loops and fans it restarts where the vertex is not there, or the file has
 * EXT_mesh_primitive_restart. (That extension itself joins ordinary primitives, which are drawn.) */
static void find_restarts(io_reader *r, const json_place *at, unsigned mode, uint32_t vertex_count,
                          index_source *s)
{
    if (s->count == 0 || s->largest != s->restart)
        return;
    s->has_restarts = is_connected(mode) && (s->restart >= vertex_count ||
                                             gltf_is_extension_listed(r, "EXT_mesh_primitive_restart"));
    if (s->has_restarts)
        io_warn(r, at, "indices", "has the index %u, which is taken as a primitive restart", s->restart);
    else if (s->restart < vertex_count)
        io_warn(r, at, "indices",
                "has the index %u, which glTF keeps for primitive restart; it is drawn as that vertex",
                s->restart);
}

/* ---- vertices that are lost or not there ---- */

/* Leaves out the elements of a list, of so many corners each, that use such vertices; is_lost: NULL: none is. False: an
 * error is recorded. */
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
            "index %u is %u, but there are %u vertices; what uses it or others like it is left out", i,
            s->indices[i], vertex_count);
}

/* ---- the primitive ---- */

/* Where the indices come from; indices NULL: an error is recorded. *mode becomes that of a list where a bitstream has
 * faces, whatever mode they were stored in: each corner is a vertex. */
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
    if (!io_spend(r, at, count)) /* also what follows is linear in it: bounds, flat normals */
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
