/* meshopt_indices.c - modes TRIANGLES and INDICES: lists of vertex numbers of 2 or 4 bytes. */
#include <string.h>

#include "io/gltf/meshopt.h"

enum { TRIANGLES_TAIL = 16, INDICES_TAIL = 4 };

static inline void put(uint8_t *out, size_t i, size_t size, uint32_t value)
{
    out += i * size;
    for (size_t k = 0; k < size; k++)
        out[k] = (uint8_t)(value >> (8 * k));
}

/* A number in groups of 7 bits, lowest first; at most 5 bytes. */
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

enum { FIFO = 16, UNWRITTEN = -1 /* no vertex has that number: glTF keeps it for primitive restart */ };

/* Edges and vertices that triangles lately used; at: where the next one goes, as a number that grows. */
typedef struct triangle_state {
    uint32_t edges[FIFO][2], vertices[FIFO];
    unsigned edge_at, vertex_at;
    uint32_t next; /* the vertex that has not been used yet */
    uint32_t last; /* the vertex that was written in full last */
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

/* back: 0 is the latest. */
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

/* The second or third vertex of a free triangle: 0 is the next one, 15 one in full, else one of those lately used. */
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
        if (how == 0) /* a mesh of its own begins */
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

/* A code takes at most 16 bytes of data, as many as the tail has: so one comparison for each is enough. */
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
    return is_known ? NULL : "refers to vertices before the first one";
}

/* Two bytes of the table are reserved, and no half of one is 15. */
static bool is_triangle_table(const uint8_t *table)
{
    bool is_valid = table[14] == 0 && table[15] == 0;
    for (int i = 0; i < 16; i++)
        is_valid &= table[i] >> 4 != 15 && (table[i] & 15) != 15;
    return is_valid;
}

const char *meshopt_decode_triangles(const meshopt_stream *s, uint8_t *out)
{
    if (s->size == 0 || s->bytes[0] != 0xe1)
        return MESHOPT_NO_HEADER;
    if (s->size < meshopt_smallest_size(s))
        return MESHOPT_TOO_SHORT;
    if (!is_triangle_table(s->bytes + s->size - TRIANGLES_TAIL))
        return "has a table of codes that is not valid";
    return s->stride == 2 ? decode_triangles(s, 2, out) : decode_triangles(s, 4, out);
}

/* ---- any indices ---- */

const char *meshopt_decode_indices(const meshopt_stream *s, uint8_t *out)
{
    if (s->size == 0 || s->bytes[0] != 0xd1)
        return MESHOPT_NO_HEADER;
    if (s->size < meshopt_smallest_size(s))
        return MESHOPT_TOO_SHORT;
    const uint8_t *end = s->bytes + s->size - INDICES_TAIL;
    const uint8_t *in = s->bytes + 1;
    uint32_t last[2] = {0, 0};
    for (size_t i = 0; i < s->count; i++) {
        if (in >= end) /* a number of 5 bytes ends within the tail */
            return MESHOPT_TOO_SHORT;
        uint32_t value = get_varint(&in);
        last[value & 1] += unzigzag(value >> 1);
        put(out, i, s->stride, last[value & 1]);
    }
    return in == end ? NULL : in > end ? MESHOPT_TOO_SHORT : MESHOPT_TOO_LONG;
}
