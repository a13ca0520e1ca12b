/* obj_chunk.c - the text in pieces, and the lists of all pieces together. */
#include <math.h>
#include <string.h>

#include "base/number.h"
#include "base/parallel.h"
#include "image/srgb.h"
#include "io/obj/obj_parse.h"

/* So large that what is done once per chunk does not count, so small that what is read of one stays in the cache of a
 * core until it is copied to its place. */
enum { CHUNK_SIZE = 1 << 19 };

/* ---- pieces ---- */

/* Behind the first line end at or behind position at which is not joined with the next line. */
static size_t find_cut(const char *bytes, size_t size, size_t at)
{
    for (; at < size; at++) {
        if (!obj_is_line_end(bytes[at]))
            continue;
        size_t before = at > 0 && bytes[at] == '\n' && bytes[at - 1] == '\r' ? at - 1 : at;
        if (before == 0 || bytes[before - 1] != '\\')
            if (bytes[at] != '\r' || at + 1 >= size || bytes[at + 1] != '\n')
                return at + 1;
    }
    return size;
}

/* The end of the chunk that begins at begin. The last one is not shorter than NUMBER_TAIL, so that those before can be
 * read that far behind their ends. */
static size_t find_chunk_end(const char *bytes, size_t size, size_t begin)
{
    if (size - begin <= CHUNK_SIZE)
        return size;
    size_t end = find_cut(bytes, size, begin + CHUNK_SIZE - 1);
    return size - end < 2 * NUMBER_TAIL ? size : end;
}

/* The last chunk with a line end, and one more where a backslash joins that one, and room behind. */
static bool copy_tail(obj_reader *r, obj_chunk *last)
{
    size_t size;
    if (checked_add(last->size, 2 + NUMBER_TAIL, &size))
        r->tail = mem_alloc(r->allocator, size, 1);
    if (!r->tail)
        return obj_fail_memory(r, "text of an OBJ file", last->size);
    memcpy(r->tail, last->text, last->size);
    memset(r->tail + last->size, '\n', 2 + NUMBER_TAIL);
    last->text = r->tail;
    last->size += 2;
    return true;
}

void obj_cut_chunks(obj_reader *r, const char *bytes, size_t size)
{
    size_t capacity = 0;
    size_t begin = size >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    do {
        if (!mem_reserve(r->allocator, (void **)&r->chunks, &capacity, r->chunk_count + 1,
                         sizeof *r->chunks)) {
            obj_fail_memory(r, "chunks", (r->chunk_count + 1) * sizeof *r->chunks);
            return;
        }
        size_t end = find_chunk_end(bytes, size, begin);
        r->chunks[r->chunk_count++] = (obj_chunk){
            .text = bytes + begin, .size = end - begin, .offset = begin, .wanted_element = SIZE_MAX};
        begin = end;
    } while (begin < size);
    copy_tail(r, &r->chunks[r->chunk_count - 1]);
}

static void release_vertices(obj_chunk *c)
{
    mem_free(c->positions.data);
    mem_free(c->texcoords.data);
    mem_free(c->normals.data);
    mem_free(c->colors.data);
    mem_free(c->mrgb.data);
    c->positions = c->texcoords = c->normals = c->colors = (obj_floats){0};
    c->mrgb = (obj_indices){0};
}

void obj_chunk_release(obj_chunk *c)
{
    release_vertices(c);
    mem_free(c->sizes.data);
    mem_free(c->v.data);
    mem_free(c->t.data);
    mem_free(c->n.data);
    mem_free(c->events);
    c->sizes = c->v = c->t = c->n = (obj_indices){0};
    c->events = NULL;
}

/* ---- colors ---- */

/* How the numbers of vertex colors are read. */
typedef struct color_scale {
    bool is_8bit, is_linear;
} color_scale;

static float to_linear(float x, color_scale scale)
{
    double c = (double)x / (scale.is_8bit ? 255.0 : 1.0);
    c = c < 1.0 ? c : 1.0;
    return (float)(scale.is_linear ? c : srgb_decode(c));
}

/* Whole numbers above 1 can only be those of 8 bits. */
static color_scale find_color_scale(const obj_reader *r)
{
    float maximum = 0.0f;
    bool has_fractions = false;
    for (size_t i = 0; i < r->chunk_count; i++) {
        maximum = fmaxf(maximum, r->chunks[i].color_maximum);
        has_fractions |= r->chunks[i].has_color_fractions;
    }
    return (color_scale){.is_8bit = maximum > 1.0f && !has_fractions,
                         .is_linear = r->desc->legacy.colors == FACET_LEGACY_COLORS_LINEAR};
}

/* ---- lists of the whole file ---- */

typedef struct joining {
    obj_reader *r;
    color_scale scale;
    bool has_colors; /* of v statements; else of ZBrush's comments, if there are any */
} joining;

static void join_colors(const joining *j, const obj_chunk *c)
{
    float *out = j->r->colors + 4 * c->position_base;
    for (size_t i = 0; i < 4 * c->positions.count; i++)
        out[i] = -1.0f;
    for (size_t i = 0; i < c->colors.count; i++) {
        const float *in = c->colors.data + 4 * i;
        if (in[0] < 0.0f)
            continue;
        for (size_t k = 0; k < 3; k++)
            out[4 * i + k] = to_linear(in[k], j->scale);
        out[4 * i + 3] = fminf(j->scale.is_8bit && in[3] > 1.0f ? in[3] / 255.0f : in[3], 1.0f);
    }
}

static void join_mrgb(const joining *j, const obj_chunk *c)
{
    const color_scale scale = {.is_8bit = true, .is_linear = j->scale.is_linear};
    for (size_t i = 0; i < c->mrgb.count && c->mrgb_base + i < j->r->position_count; i++) {
        float *out = j->r->colors + 4 * (c->mrgb_base + i);
        for (unsigned k = 0; k < 3; k++)
            out[k] = to_linear((float)(c->mrgb.data[i] >> (16 - 8 * k) & 0xffu), scale);
        out[3] = 1.0f;
    }
}

static void copy_list(float *to, size_t base, const obj_floats *list, size_t width)
{
    if (list->count)
        memcpy(to + width * base, list->data, width * list->count * sizeof *to);
}

static void join_chunk(void *context, size_t begin, size_t end)
{
    const joining *j = context;
    obj_reader *r = j->r;
    for (size_t i = begin; i < end; i++) {
        obj_chunk *c = &r->chunks[i];
        copy_list(r->positions, c->position_base, &c->positions, 3);
        copy_list(r->texcoords, c->texcoord_base, &c->texcoords, 2);
        copy_list(r->normals, c->normal_base, &c->normals, 3);
        if (r->colors && j->has_colors)
            join_colors(j, c);
        else if (r->colors)
            join_mrgb(j, c);
        release_vertices(c);
    }
}

/* Where the lists of each chunk begin; whether there are colors. */
static size_t sum_up(obj_reader *r, bool *has_colors)
{
    size_t mrgb_count = 0;
    *has_colors = false;
    for (size_t i = 0; i < r->chunk_count; i++) {
        obj_chunk *c = &r->chunks[i];
        c->position_base = r->position_count;
        c->texcoord_base = r->texcoord_count;
        c->normal_base = r->normal_count;
        c->mrgb_base = mrgb_count;
        r->position_count += c->positions.count;
        r->texcoord_count += c->texcoords.count;
        r->normal_count += c->normals.count;
        mrgb_count += c->mrgb.count;
        *has_colors |= c->colors.count > 0;
        r->has_object |= c->has_object;
        r->has_smoothing |= c->has_smoothing;
        r->has_zero_normals |= c->has_zero_normals;
        r->has_lost_positions |= c->has_lost_positions;
    }
    return mrgb_count;
}

static float *take_list(obj_reader *r, const char *what, size_t count, size_t width)
{
    float *list = mem_alloc(r->allocator, count, width * sizeof *list);
    if (!list)
        obj_fail_memory(r, what, count * width * sizeof *list);
    return list;
}

void obj_join_chunks(obj_reader *r)
{
    joining j = {.r = r};
    size_t mrgb_count = sum_up(r, &j.has_colors);
    if (r->position_count > OBJ_MOST || r->texcoord_count > OBJ_MOST || r->normal_count > OBJ_MOST) {
        obj_fail_limit(r, "vertices");
        return;
    }
    j.scale = find_color_scale(r);
    r->positions = take_list(r, "positions", r->position_count, 3);
    r->texcoords = take_list(r, "texture coordinates", r->texcoord_count, 2);
    r->normals = take_list(r, "normals", r->normal_count, 3);
    if (j.has_colors || mrgb_count > 0)
        r->colors = take_list(r, "vertex colors", r->position_count, 4);
    if (!obj_is_ok(r))
        return;
    if (r->colors && !j.has_colors)
        for (size_t i = 0; i < 4 * r->position_count; i++)
            r->colors[i] = -1.0f;
    parallel_for(r->thread_count, r->chunk_count, 1, join_chunk, &j);
}
