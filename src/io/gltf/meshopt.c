/* meshopt.c - decodes index streams and applies filters: which modes, filters and strides are consistent,
 * and the sequence of decoder and filter for a stream. */
#include "io/gltf/meshopt.h"

#include <math.h>
#include <string.h>

/* ---- indices ---- */

enum { TRIANGLES_TAIL = 16, INDICES_TAIL = 4 };

static inline void put(uint8_t *out, size_t i, size_t size, uint32_t value)
{
    out += i * size;
    for (size_t k = 0; k < size; k++)
        out[k] = (uint8_t)(value >> (8 * k));
}

/* An integer in groups of 7 bits, lowest first; at most 5 bytes. */
static inline uint32_t get_varint(const uint8_t **in)
{
    const uint8_t *p = *in;
    uint32_t value = *p & 127;
    for (unsigned shift = 7; *p >= 128 && shift < 35; shift += 7)
        value |= (uint32_t)(*++p & 127) << shift;
    *in = p + 1;
    return value;
}

static inline uint32_t unzigzag(uint32_t v)
{
    return v >> 1 ^ (0 - (v & 1));
}

/* ---- triangles ---- */

enum { FIFO = 16, UNWRITTEN = -1 /* not a valid index: glTF reserves it for primitive restart */ };

/* FIFOs of recent edges and vertices; at: increasing index of the next slot. */
typedef struct triangle_state {
    uint32_t edges[FIFO][2], vertices[FIFO];
    unsigned edge_at, vertex_at;
    uint32_t next; /* the next new vertex */
    uint32_t last; /* the last vertex that was stored in full */
    const uint8_t *data;
} triangle_state;

static inline void push_edge(triangle_state *t, uint32_t a, uint32_t b)
{
    t->edges[t->edge_at % FIFO][0] = a;
    t->edges[t->edge_at % FIFO][1] = b;
    t->edge_at++;
}

static inline void push_vertex(triangle_state *t, uint32_t v)
{
    t->vertices[t->vertex_at++ % FIFO] = v;
}

/* back: 0 is the latest entry. */
static inline uint32_t get_vertex(const triangle_state *t, unsigned back)
{
    return t->vertices[(t->vertex_at - 1 - back) % FIFO];
}

static inline uint32_t get_delta(triangle_state *t)
{
    t->last += unzigzag(get_varint(&t->data));
    return t->last;
}

/* Codes 0x00 to 0xef: an edge and a vertex. */
static inline void decode_beside_edge(triangle_state *t, unsigned code, uint32_t triangle[3])
{
    const uint32_t *edge = t->edges[(t->edge_at - 1 - (code >> 4)) % FIFO];
    const uint32_t a = edge[0];
    const uint32_t b = edge[1];
    const unsigned how = code & 15;
    uint32_t c;
    if (how == 0)
        c = t->next++;
    else if (how < 13)
        c = get_vertex(t, how);
    else if (how < 15)
        c = t->last = t->last + (how == 13 ? UINT32_MAX : 1);
    else
        c = get_delta(t);
    push_edge(t, c, b);
    push_edge(t, a, c);
    if (how == 0 || how >= 13)
        push_vertex(t, c);
    triangle[0] = a;
    triangle[1] = b;
    triangle[2] = c;
}

/* The second or third vertex of a separate triangle: 0 is the next new vertex, 15 one stored in full,
 * others a recent one. */
static inline uint32_t get_corner(triangle_state *t, unsigned how)
{
    return how == 0 ? t->next++ : how == 15 ? get_delta(t) : get_vertex(t, how - 1);
}

/* Codes 0xf0 to 0xff: three vertices. */
static inline void decode_free(triangle_state *t, unsigned code, const uint8_t *table, uint32_t triangle[3])
{
    unsigned how;
    if (code < 0xfe) {
        how = table[code & 15];
    } else {
        how = *t->data++;
        if (how == 0) /* a restart of the vertex numbering */
            t->next = 0;
    }
    const uint32_t a = code == 0xff ? get_delta(t) : t->next++;
    const uint32_t b = get_corner(t, how >> 4);
    const uint32_t c = get_corner(t, how & 15);
    push_edge(t, b, a);
    push_edge(t, c, b);
    push_edge(t, a, c);
    push_vertex(t, a);
    if (how >> 4 == 0 || how >> 4 == 15)
        push_vertex(t, b);
    if ((how & 15) == 0 || (how & 15) == 15)
        push_vertex(t, c);
    triangle[0] = a;
    triangle[1] = b;
    triangle[2] = c;
}

/* A code takes at most 16 bytes of data, the size of the tail, so that one comparison per code suffices. */
static inline __attribute__((always_inline)) const char *decode_triangles(const meshopt_stream *s,
                                                                          size_t size, uint8_t *out)
{
    const size_t triangle_count = s->count / 3;
    const uint8_t *table = s->bytes + s->size - TRIANGLES_TAIL;
    const uint8_t *codes = s->bytes + 1;
    triangle_state t = {.data = codes + triangle_count};
    memset(t.edges, UNWRITTEN, sizeof t.edges);
    memset(t.vertices, UNWRITTEN, sizeof t.vertices);
    bool is_known = true;
    for (size_t i = 0; i < triangle_count; i++) {
        uint32_t triangle[3];
        if (t.data > table)
            return MESHOPT_TOO_SHORT;
        if (codes[i] < 0xf0)
            decode_beside_edge(&t, codes[i], triangle);
        else
            decode_free(&t, codes[i], table, triangle);
        for (size_t k = 0; k < 3; k++) {
            is_known &= triangle[k] != UINT32_MAX;
            put(out, 3 * i + k, size, triangle[k]);
        }
    }
    if (t.data != table)
        return t.data > table ? MESHOPT_TOO_SHORT : MESHOPT_TOO_LONG;
    return is_known ? NULL : "refers to vertices before the first";
}

/* Two bytes of the table are reserved, and none of its nibbles is 15. */
static bool is_triangle_table(const uint8_t *table)
{
    bool is_valid = table[14] == 0 && table[15] == 0;
    for (int i = 0; i < 16; i++)
        is_valid &= table[i] >> 4 != 15 && (table[i] & 15) != 15;
    return is_valid;
}

static const char *meshopt_decode_triangles(const meshopt_stream *s, uint8_t *out)
{
    if (s->size == 0 || s->bytes[0] != 0xe1)
        return MESHOPT_NO_HEADER;
    if (s->size < meshopt_smallest_size(s))
        return MESHOPT_TOO_SHORT;
    if (!is_triangle_table(s->bytes + s->size - TRIANGLES_TAIL))
        return "has an invalid table of codes";
    return s->stride == 2 ? decode_triangles(s, 2, out) : decode_triangles(s, 4, out);
}

/* ---- any indices ---- */

static const char *decode_indices(const meshopt_stream *s, uint8_t *out)
{
    if (s->size == 0 || s->bytes[0] != 0xd1)
        return MESHOPT_NO_HEADER;
    if (s->size < meshopt_smallest_size(s))
        return MESHOPT_TOO_SHORT;
    const uint8_t *end = s->bytes + s->size - INDICES_TAIL;
    const uint8_t *in = s->bytes + 1;
    uint32_t last[2] = {0, 0};
    for (size_t i = 0; i < s->count; i++) {
        if (in >= end) /* an integer of 5 bytes ends within the tail */
            return MESHOPT_TOO_SHORT;
        uint32_t value = get_varint(&in);
        last[value & 1] += unzigzag(value >> 1);
        put(out, i, s->stride, last[value & 1]);
    }
    return in == end ? NULL : in > end ? MESHOPT_TOO_SHORT : MESHOPT_TOO_LONG;
}

/* ---- filters ---- */

enum { BATCH = 64 };

/* Component k of element i of a batch is [k][i]. */
typedef float components[4][BATCH];

static void load_components(const uint8_t *in, size_t count, size_t stride, bool is_signed, components out)
{
    if (stride == 4)
        for (size_t i = 0; i < count; i++)
            for (size_t k = 0; k < 4; k++)
                out[k][i] = (float)(is_signed ? (int8_t)in[4 * i + k] : in[4 * i + k]);
    else
        for (size_t i = 0; i < count; i++)
            for (size_t k = 0; k < 4; k++) {
                const unsigned value = in[8 * i + 2 * k] | (unsigned)in[8 * i + 2 * k + 1] << 8;
                out[k][i] = (float)(is_signed ? (int16_t)value : (int)value);
            }
}

static inline void store_u32(uint8_t *p, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        p[i] = (uint8_t)(value >> (8 * i));
}

/* Signed integers. */
static void store_components(components c, size_t count, size_t stride, uint8_t *out)
{
    uint32_t words[2][BATCH];
    const uint32_t mask = stride == 4 ? 0xff : 0xffff;
    for (size_t i = 0; i < count; i++) {
        const uint32_t x = (uint32_t)(int)c[0][i] & mask;
        const uint32_t y = (uint32_t)(int)c[1][i] & mask;
        const uint32_t z = (uint32_t)(int)c[2][i] & mask;
        const uint32_t w = (uint32_t)(int)c[3][i] & mask;
        words[0][i] = stride == 4 ? x | y << 8 | z << 16 | w << 24 : x | y << 16;
        words[1][i] = z | w << 16;
    }
    if (stride == 4)
        for (size_t i = 0; i < count; i++)
            store_u32(out + 4 * i, words[0][i]);
    else
        for (size_t i = 0; i < count; i++) {
            store_u32(out + 8 * i, words[0][i]);
            store_u32(out + 8 * i + 4, words[1][i]);
        }
}

/* Rounds to the nearest integer, halves away from zero, clamped to [-limit, limit]; NaN, which only
 * damaged elements give, becomes -limit. */
static inline float round_within(float value, float limit)
{
    value += value < 0.0f ? -0.5f : 0.5f;
    value = value > -limit ? value : -limit;
    value = value < limit ? value : limit;
    return (float)(int)value;
}

/* Octahedral unit vectors: x, y, and an integer that stands for 1; the fourth component stays. scale: 1 in
 * the result. */
static void decode_octahedral(components c, size_t count, float scale)
{
    for (size_t i = 0; i < count; i++) {
        float x = c[0][i] / c[2][i];
        float y = c[1][i] / c[2][i];
        const float z = 1.0f - fabsf(x) - fabsf(y);
        const float t = z < 0.0f ? z : 0.0f; /* the corners are the lower hemisphere, folded outwards */
        x += x < 0.0f ? -t : t;
        y += y < 0.0f ? -t : t;
        const float to_scale = scale / sqrtf(x * x + y * y + z * z);
        c[0][i] = round_within(x * to_scale, scale);
        c[1][i] = round_within(y * to_scale, scale);
        c[2][i] = round_within(z * to_scale, scale);
    }
}

/* Unit quaternions: three components, scaled by sqrt(2) since the largest is omitted; the fourth has an
 * integer that stands for 1, and in its lowest two bits the index of the omitted one. */
static void decode_quaternion(components c, size_t count, float scale)
{
    const float range = 0.70710678f * scale;
    for (size_t i = 0; i < count; i++) {
        const int one = (int)c[3][i];
        const int largest = one & 3;
        const float to_scale = range / (float)(one | 3);
        const float x = c[0][i] * to_scale;
        const float y = c[1][i] * to_scale;
        const float z = c[2][i] * to_scale;
        const float rest = scale * scale - x * x - y * y - z * z;
        const float w = sqrtf(rest > 0.0f ? rest : 0.0f);
        for (int k = 0; k < 4; k++) {
            const int after = (k - largest) & 3; /* offset from the largest */
            const float value = after == 0 ? w : after == 1 ? x : after == 2 ? y : z;
            c[k][i] = round_within(value, scale);
        }
    }
}

/* YCoCg and alpha of K bits, alpha one bit less below a leading 1 that encodes K, to RGBA of limit. */
static void decode_color(components c, size_t count, float limit)
{
    for (size_t i = 0; i < count; i++) {
        const float alpha = c[3][i] > 1.0f ? c[3][i] : 1.0f; /* 0 has no leading 1 */
        uint32_t bits;
        memcpy(&bits, &alpha, sizeof bits);
        bits &= 0x7f800000;
        float leading;
        memcpy(&leading, &bits, sizeof leading);
        const float scale = limit / (2.0f * leading - 1.0f); /* K ones */
        const int low = (int)(alpha - leading);
        const float y = c[0][i];
        const float orange = c[1][i];
        const float green = c[2][i];
        const float rgba[4] = {y + orange - green, y + green, y - orange - green,
                               (float)(low << 1 | (low & 1))};
        for (int k = 0; k < 4; k++)
            c[k][i] = round_within(rgba[k] > 0.0f ? rgba[k] * scale : 0.0f, limit);
    }
}

/* Elements are little-endian: to the byte order of the machine, and back. */
static inline uint32_t native_32(uint32_t v)
{
    return __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? v : __builtin_bswap32(v);
}

/* 8 bits of exponent over 24 of mantissa, both signed: 2^e m. Exponents that encoders may not write
 * (beyond 100) stay within the range of floats. */
static void filter_exponential(uint32_t *words, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const uint32_t word = native_32(words[i]);
        const int32_t e = (int32_t)word >> 24;
        const int32_t m = (int32_t)(word << 8) >> 8;
        const uint32_t power_bits = (uint32_t)((e < -126 ? -126 : e) + 127) << 23;
        float power;
        memcpy(&power, &power_bits, sizeof power);
        const float value = power * (float)m;
        uint32_t bits;
        memcpy(&bits, &value, sizeof bits);
        words[i] = native_32(bits);
    }
}

void meshopt_apply_filter(meshopt_filter filter, uint8_t *elements, size_t count, size_t stride)
{
    if (filter == MESHOPT_NONE)
        return;
    if (filter == MESHOPT_EXPONENTIAL) {
        void *words = elements;
        filter_exponential(words, count * (stride / 4));
        return;
    }
    const float signed_limit = stride == 4 ? 127.0f : 32767.0f;
    components c;
    for (size_t i = 0; i < count; i += BATCH) {
        const size_t n = count - i < BATCH ? count - i : BATCH;
        uint8_t *at = elements + i * stride;
        load_components(at, n, stride, true, c);
        if (filter == MESHOPT_OCTAHEDRAL) {
            decode_octahedral(c, n, signed_limit);
        } else if (filter == MESHOPT_QUATERNION) {
            decode_quaternion(c, n, signed_limit);
        } else {
            components plain; /* luma and alpha are unsigned */
            load_components(at, n, stride, false, plain);
            memcpy(c[0], plain[0], sizeof c[0]);
            memcpy(c[3], plain[3], sizeof c[3]);
            decode_color(c, n, stride == 4 ? 255.0f : 65535.0f);
        }
        store_components(c, n, stride, at);
    }
}

/* ---- streams ---- */

enum { MIN_STRIDE = 4, MAX_STRIDE = 256 };

static const char *check_filter(meshopt_filter filter, size_t stride)
{
    switch (filter) {
    case MESHOPT_OCTAHEDRAL:
    case MESHOPT_COLOR:
        return stride == 4 || stride == 8 ? NULL : "byteStride must be 4 or 8 with this filter";
    case MESHOPT_QUATERNION:
        return stride == 8 ? NULL : "byteStride must be 8 with this filter";
    default:
        return NULL;
    }
}

const char *meshopt_check(const meshopt_stream *s)
{
    if (s->mode == MESHOPT_ATTRIBUTES) {
        if (s->stride < MIN_STRIDE || s->stride > MAX_STRIDE || s->stride % 4)
            return "byteStride must be one of 4, 8, .. 256 in this mode";
        return check_filter(s->filter, s->stride);
    }
    if (s->stride != 2 && s->stride != 4)
        return "byteStride must be 2 or 4 in this mode";
    if (s->filter != MESHOPT_NONE)
        return "this mode allows no filter";
    return s->mode == MESHOPT_TRIANGLES && s->count % 3 ? "count must be a multiple of 3 in this mode" : NULL;
}

const char *meshopt_decode(const meshopt_stream *s, uint8_t *out)
{
    if (s->mode == MESHOPT_TRIANGLES)
        return meshopt_decode_triangles(s, out);
    if (s->mode == MESHOPT_INDICES)
        return decode_indices(s, out);
    const char *problem = meshopt_decode_attributes(s, out);
    if (!problem)
        meshopt_apply_filter(s->filter, out, s->count, s->stride);
    return problem;
}
