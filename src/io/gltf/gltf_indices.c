/* gltf_indices.c - the index list of a primitive: read or counted, checked, strips and fans and loops made lists
 * (glTF 2.0 section 3.7.2.1), what uses lost vertices left out. */
#include <string.h>

#include "io/gltf/gltf_reader.h"

enum { POINTS, LINES, LINE_LOOP, LINE_STRIP, TRIANGLES, TRIANGLE_STRIP, TRIANGLE_FAN, MODE_COUNT };

/* 0, 1, .. count - 1; one array serves all primitives. */
static const uint32_t *get_iota(reader *r, uint32_t count)
{
    if (r->iota && r->iota_count >= count)
        return r->iota;
    uint32_t capacity =
        r->iota_count > UINT32_MAX / 2 || 2 * r->iota_count < count ? count : 2 * r->iota_count;
    uint32_t *iota = reader_alloc_raw(r, "indices", capacity, sizeof *iota);
    if (!iota)
        return NULL;
    for (uint32_t i = 0; i < capacity; i++)
        iota[i] = i;
    r->iota = iota;
    r->iota_count = capacity;
    return iota;
}

/* ---- modes ---- */

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

/* ---- lost vertices ---- */

static bool drop_lost(reader *r, scene_primitive *p, size_t corners, const uint8_t *is_lost)
{
    uint32_t *out = reader_alloc_raw(r, "indices", p->index_count, sizeof *out);
    if (!out)
        return false;
    uint32_t kept = 0;
    for (size_t i = 0; i + corners <= p->index_count; i += corners) {
        bool is_whole = true;
        for (size_t k = 0; k < corners; k++)
            is_whole &= !is_lost[p->indices[i + k]];
        if (is_whole) {
            memcpy(out + kept, p->indices + i, corners * sizeof *out);
            kept += (uint32_t)corners;
        }
    }
    p->indices = out;
    p->index_count = kept;
    return true;
}

/* ---- the primitive ---- */

static bool fail_index(reader *r, const json_place *at, const uint32_t *indices, uint32_t vertex_count)
{
    size_t i = 0;
    while (indices[i] < vertex_count)
        i++;
    return reader_fail(r, at, "indices", FACET_ERROR_INVALID, "index %zu is %u, but there are %u vertices", i,
                       indices[i], vertex_count);
}

bool read_primitive_indices(reader *r, const json_place *at, scene_primitive *p, const uint8_t *is_lost)
{
    unsigned mode = (unsigned)get_uint(r, at, "mode", MODE_COUNT - 1, TRIANGLES);
    uint32_t accessor = get_index(r, at, "indices", r->accessor_count, "accessor");
    if (!reader_is_ok(r))
        return false;
    uint32_t in_count = p->vertex_count;
    const uint32_t *in;
    if (r->faces) { /* a list, whatever mode they were stored in; each corner is a vertex */
        in = r->faces;
        in_count = 3 * r->face_count;
        mode = TRIANGLES;
    } else if (accessor == SCENE_NONE) {
        in = get_iota(r, in_count);
    } else {
        uint32_t largest;
        json_place place = {.parent = at, .key = "indices"};
        in = get_accessor_indices(r, &place, accessor, &largest);
        in_count = r->accessors[accessor].count;
        gltf_component c = r->accessors[accessor].component;
        uint32_t restart = c == GLTF_U8 ? UINT8_MAX : c == GLTF_U16 ? UINT16_MAX : UINT32_MAX;
        if (in && in_count && largest == restart)
            return reader_fail(r, at, "indices", FACET_ERROR_INVALID,
                               "uses the index %u, which is reserved for primitive restart", restart);
        if (in && in_count && largest >= p->vertex_count)
            return fail_index(r, at, in, p->vertex_count);
    }
    if (!in)
        return false;

    static const uint8_t corners[MODE_COUNT] = {1, 2, 2, 2, 3, 3, 3};
    uint64_t count = list_length(mode, in_count);
    p->mode = mode == POINTS ? SCENE_POINTS : mode < TRIANGLES ? SCENE_LINES : SCENE_TRIANGLES;
    if ((mode == LINES || mode == TRIANGLES) ? count != in_count : count == 0)
        reader_warn(r, at, NULL, "%u vertices do not make whole %s", in_count,
                    p->mode == SCENE_LINES ? "lines" : "triangles");
    if (!reader_spend(r, at, count)) /* also what follows is linear in it: bounds, flat normals */
        return false;
    p->index_count = (uint32_t)count;
    p->indices = in;
    if (mode == LINE_LOOP || mode == LINE_STRIP || mode == TRIANGLE_STRIP || mode == TRIANGLE_FAN) {
        uint32_t *list = reader_alloc_raw(r, "indices", count, sizeof *list);
        if (!list)
            return false;
        unroll(mode, in, in_count, list, count);
        p->indices = list;
    }
    return !is_lost || drop_lost(r, p, corners[mode], is_lost);
}
