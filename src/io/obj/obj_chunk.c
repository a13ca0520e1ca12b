/* obj_chunk.c - chunks of the text: how it is cut, the check of each chunk's indices, which become
 * zero-based, and the lists of all chunks together. Elements with invalid indices are removed. */
#include <math.h>
#include <string.h>

#include "base/number.h"
#include "base/parallel.h"
#include "image/srgb.h"
#include "io/obj/obj_parse.h"
#include "io/obj/obj_reader.h"

/* ---- the check of indices ---- */

/* The limits for one chunk, and the positions of the next corner and element that are kept. */
typedef struct checking {
    const obj_reader *r;
    obj_chunk *c;
    size_t corner, element; /* out */
    size_t number;          /* of the element, as parse counted */
    uint32_t triangle_count;
} checking;

/* Remarks store the index of the element; report_remarks() of obj_read.c finds its line. */
static void note(checking *k, obj_remark remark)
{
    obj_note(&k->c->remarks, remark, k->number);
}

/* Resolves a relative index; OBJ_WRONG if it is out of range. */
static uint32_t resolve(uint32_t index, size_t base, size_t count)
{
    if (index < count || index == OBJ_ABSENT)
        return index;
    if (index < OBJ_RELATIVE || index == OBJ_WRONG)
        return OBJ_WRONG;
    int64_t own = (int64_t)base + (int64_t)(index - OBJ_RELATIVE) - (int64_t)OBJ_MAX;
    return own >= 0 && own < (int64_t)count ? (uint32_t)own : OBJ_WRONG;
}

/* Whether all positions of the element exist and are finite. */
static bool check_positions(checking *k, size_t begin, size_t end)
{
    const obj_reader *r = k->r;
    uint32_t *v = k->c->v.data;
    for (size_t i = begin; i < end; i++) {
        if (v[i] >= r->position_count)
            v[i] = resolve(v[i], k->c->position_base, r->position_count);
        if (v[i] >= r->position_count) {
            note(k, OBJ_FACE_WRONG);
            return false;
        }
    }
    if (!r->has_lost_positions)
        return true;
    for (size_t i = 3 * begin; i < 3 * end; i++)
        if (!(fabsf(r->positions[3 * (size_t)v[i / 3] + i % 3]) <= SCENE_FARTHEST)) {
            note(k, OBJ_FACE_NOT_FINITE);
            return false;
        }
    return true;
}

/* An index out of range counts as absent. */
static void check_attributes(checking *k, obj_indices *list, size_t begin, size_t end, size_t base,
                             size_t count)
{
    for (size_t i = begin; i < end; i++) {
        uint32_t index = list->data[i];
        if (index >= count && index != OBJ_ABSENT) {
            index = resolve(index, base, count);
            if (index == OBJ_WRONG) {
                note(k, OBJ_ATTRIBUTE_WRONG);
                index = OBJ_ABSENT;
            }
            list->data[i] = index;
        }
    }
}

/* The file's normals are used if all corners of the element have one. */
static void check_normals(checking *k, size_t begin, size_t end)
{
    uint32_t *n = k->c->n.data;
    bool has_all = true;
    check_attributes(k, &k->c->n, begin, end, k->c->normal_base, k->r->normal_count);
    for (size_t i = begin; i < end; i++) {
        if (k->r->has_zero_normals && n[i] != OBJ_ABSENT) {
            const float *normal = k->r->normals + 3 * (size_t)n[i];
            if (normal[0] == 0.0f && normal[1] == 0.0f && normal[2] == 0.0f) {
                note(k, OBJ_NORMAL_ZERO);
                n[i] = OBJ_ABSENT;
            }
        }
        has_all &= n[i] != OBJ_ABSENT;
    }
    for (size_t i = begin; i < end && !has_all; i++)
        n[i] = OBJ_ABSENT;
}

/* Moves the corners to their place, those of a face without consecutive duplicates; returns how many are
 * kept. */
static uint32_t move_corners(checking *k, size_t begin, size_t end, bool is_face)
{
    const obj_chunk *c = k->c;
    size_t out = k->corner;
    for (size_t i = begin; i < end; i++) {
        if (is_face && out > k->corner && c->v.data[i] == c->v.data[out - 1])
            continue;
        c->v.data[out] = c->v.data[i];
        if (c->t.data)
            c->t.data[out] = c->t.data[i];
        if (c->n.data)
            c->n.data[out] = c->n.data[i];
        out++;
    }
    while (is_face && out - k->corner > 1 && c->v.data[out - 1] == c->v.data[k->corner])
        out--;
    return (uint32_t)(out - k->corner);
}

static void check_element(checking *k, scene_mode mode, size_t begin, size_t end)
{
    obj_chunk *c = k->c;
    uint32_t least = mode == SCENE_TRIANGLES ? 3 : mode == SCENE_LINES ? 2 : 1;
    if (!check_positions(k, begin, end))
        return;
    if (c->t.data)
        check_attributes(k, &c->t, begin, end, c->texcoord_base, k->r->texcoord_count);
    if (c->n.data)
        check_normals(k, begin, end);
    uint32_t count = move_corners(k, begin, end, mode == SCENE_TRIANGLES);
    if (count < least) {
        note(k, OBJ_FACE_SHORT);
        return;
    }
    c->sizes.data[k->element++] = count;
    k->corner += count;
    k->triangle_count += mode == SCENE_TRIANGLES ? count - 2 : mode == SCENE_LINES ? count - 1 : count;
}

void obj_check_chunk(obj_reader *r, obj_chunk *c)
{
    checking k = {.r = r, .c = c};
    scene_mode mode = SCENE_TRIANGLES;
    size_t event = 0;
    size_t begin = 0;
    for (; k.number < c->sizes.count; k.number++) {
        for (; event < c->event_count && c->events[event].element == k.number; event++) {
            obj_event *e = &c->events[event];
            mode = e->kind == OBJ_MODE ? (scene_mode)e->value : mode;
            e->element = (uint32_t)k.element;
            e->corner = (uint32_t)k.corner;
            e->triangle_count = k.triangle_count;
        }
        size_t end = begin + c->sizes.data[k.number];
        check_element(&k, mode, begin, end);
        begin = end;
    }
    for (; event < c->event_count; event++) {
        c->events[event].element = (uint32_t)k.element;
        c->events[event].corner = (uint32_t)k.corner;
        c->events[event].triangle_count = k.triangle_count;
    }
    c->sizes.count = k.element;
    c->v.count = k.corner;
    c->triangle_count = k.triangle_count;
}

/* Large enough to make the work per chunk negligible, small enough for a chunk's arrays to stay in a
 * core's cache until they are copied. */
enum { CHUNK_SIZE = 1 << 19 };

/* ---- pieces ---- */

/* The position behind the first line end at or after `at` that is not continued. */
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

/* The end of the chunk that begins at `begin`. The last chunk has at least NUMBER_TAIL bytes, so that the
 * others can be read that far beyond their ends. */
static size_t find_chunk_end(const char *bytes, size_t size, size_t begin)
{
    if (size - begin <= CHUNK_SIZE)
        return size;
    size_t end = find_cut(bytes, size, begin + CHUNK_SIZE - 1);
    return size - end < 2 * NUMBER_TAIL ? size : end;
}

/* Copies the last chunk and appends a line end, a second one if a backslash joins the first, and padding. */
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

/* The encoding of vertex colors. */
typedef struct color_scale {
    bool is_8bit, is_linear;
} color_scale;

static float to_linear(float x, color_scale scale)
{
    double c = (double)x / (scale.is_8bit ? 255.0 : 1.0);
    c = c < 1.0 ? c : 1.0;
    return (float)(scale.is_linear ? c : srgb_decode(c));
}

/* Integers above 1 can only be 8-bit values. */
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
    bool has_colors; /* of v statements; otherwise of ZBrush's comments, if any */
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

/* Where the lists of each chunk begin, and whether there are colors. */
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
    if (r->position_count > OBJ_MAX || r->texcoord_count > OBJ_MAX || r->normal_count > OBJ_MAX) {
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
