/* obj_parse.c - vertices and elements of one chunk; other statements are in obj_statements.c. */
#include <math.h>

#include "base/number.h"
#include "io/obj/obj_parse.h"

/* ---- lists ---- */

static bool floats_grow(obj_chunk *c, obj_floats *list, size_t width, const facet_allocator *allocator)
{
    if (!mem_reserve(allocator, (void **)&list->data, &list->capacity,
                     2 * list->capacity > 256 ? 2 * list->capacity : 256, width * sizeof *list->data))
        c->has_failed = true;
    return !c->has_failed;
}

bool obj_indices_grow(obj_chunk *c, obj_indices *list, const facet_allocator *allocator)
{
    if (!mem_reserve(allocator, (void **)&list->data, &list->capacity,
                     2 * list->capacity > 256 ? 2 * list->capacity : 256, sizeof *list->data))
        c->has_failed = true;
    return !c->has_failed;
}

/* ---- text ---- */

const char *obj_skip_continuation(const char *p)
{
    if (p[0] == '\\' && p[1] == '\n')
        return p + 2;
    if (p[0] == '\\' && p[1] == '\r')
        return p + (p[2] == '\n' ? 3 : 2);
    return p;
}

const char *obj_skip_word(const char *p)
{
    while (!obj_is_blank(*p) && !obj_is_line_end(*p) && obj_skip_continuation(p) == p)
        p++;
    return p;
}

static void note(obj_chunk *c, obj_remark remark, const char *p)
{
    obj_note(&c->remarks, remark, c->offset + (size_t)(p - c->text));
}

/* ---- vertices ---- */

/* Reads at most that many numbers of a statement; *got: their count. An invalid one counts as not finite. */
static inline const char *read_numbers(obj_chunk *c, const char *p, float *out, unsigned most, unsigned *got)
{
    unsigned count = 0;
    for (;;) {
        p = obj_skip_blanks(p);
        if (obj_is_line_end(*p) || *p == '#' || count == most)
            break;
        const char *end = number_read_float(p, &out[count]);
        if (!end)
            out[count] = NAN;
        count++;
        if (!end || !obj_ends_word(end)) {
            note(c, OBJ_NOT_A_NUMBER, p);
            end = obj_skip_word(p);
        }
        p = end;
    }
    *got = count;
    return p;
}

/* Adds colors to the positions before, which had none. */
static void start_colors(obj_chunk *c, const facet_allocator *allocator)
{
    while (c->colors.count < c->positions.count) {
        if (c->colors.count == c->colors.capacity && !floats_grow(c, &c->colors, 4, allocator))
            return;
        for (size_t k = 0; k < 4; k++)
            c->colors.data[4 * c->colors.count + k] = -1.0f;
        c->colors.count++;
    }
}

/* Colors of the last position: numbers 4 to 6, with opacity as 7th; after a weight if there are 8. */
static void store_color(obj_chunk *c, const float *numbers, unsigned count, const facet_allocator *allocator)
{
    bool has_color = count >= 6;
    if (!has_color && c->colors.count == 0)
        return;
    start_colors(c, allocator);
    if (c->has_failed || !has_color)
        return;
    float *color = c->colors.data + 4 * (c->colors.count - 1);
    numbers += count >= 8 ? 4 : 3;
    color[3] = 1.0f;
    for (unsigned k = 0; k < (count >= 7 ? 4u : 3u); k++) {
        float x = numbers[k];
        color[k] = x > 0.0f ? x <= 1e30f ? x : 1e30f : 0.0f;
        c->color_maximum = fmaxf(c->color_maximum, color[k]);
        c->has_color_fractions |= color[k] != floorf(color[k]);
    }
}

/* The three numbers at p, relative to origin. */
static void read_far_position(const char *p, const double origin[3], float out[3])
{
    for (unsigned k = 0; k < 3; k++) {
        double value;
        p = obj_skip_blanks(p);
        const char *end = number_read_double(p, &value);
        if (end)
            out[k] = (float)(value - origin[k]);
        p = end && obj_ends_word(end) ? end : obj_skip_word(p);
    }
}

static const char *read_position(obj_chunk *c, const char *p, const facet_allocator *allocator)
{
    obj_floats *list = &c->positions;
    float numbers[8];
    unsigned count;
    if (list->count == list->capacity && !floats_grow(c, list, 3, allocator))
        return p;
    const char *end = read_numbers(c, p, numbers, 8, &count);
    if (c->origin && count >= 3)
        read_far_position(p, c->origin, numbers);
    for (; count < 3; count++) {
        note(c, OBJ_VERTEX_SHORT, p);
        numbers[count] = c->origin ? (float)-c->origin[count] : 0.0f;
    }
    float *out = list->data + 3 * list->count++;
    for (unsigned k = 0; k < 3; k++)
        out[k] = numbers[k];
    /* Below the largest float: what lies beyond SCENE_FARTHEST is not drawn. */
    if (!(fabsf(out[0]) <= SCENE_FARTHEST && fabsf(out[1]) <= SCENE_FARTHEST &&
          fabsf(out[2]) <= SCENE_FARTHEST)) {
        note(c, OBJ_VERTEX_NOT_FINITE, p);
        c->has_lost_positions = true;
    }
    if (count >= 6 || c->colors.count > 0)
        store_color(c, numbers, count, allocator);
    return end;
}

static const char *read_texcoord(obj_chunk *c, const char *p, const facet_allocator *allocator)
{
    obj_floats *list = &c->texcoords;
    float numbers[3] = {0.0f, 0.0f, 0.0f};
    unsigned count;
    if (list->count == list->capacity && !floats_grow(c, list, 2, allocator))
        return p;
    const char *end = read_numbers(c, p, numbers, 3, &count);
    float *out = list->data + 2 * list->count++;
    for (unsigned k = 0; k < 2; k++) {
        bool is_finite = fabsf(numbers[k]) <= 1e30f;
        out[k] = is_finite ? numbers[k] : 0.0f;
        if (!is_finite)
            note(c, OBJ_TEXCOORD_NOT_FINITE, p);
    }
    return end;
}

/* A normal without direction is stored as zeros; faces that use it count as without normals. */
static const char *read_normal(obj_chunk *c, const char *p, const facet_allocator *allocator)
{
    obj_floats *list = &c->normals;
    float numbers[3] = {0.0f, 0.0f, 0.0f};
    unsigned count;
    if (list->count == list->capacity && !floats_grow(c, list, 3, allocator))
        return p;
    const char *end = read_numbers(c, p, numbers, 3, &count);
    float *out = list->data + 3 * list->count++;
    float sum = fabsf(numbers[0]) + fabsf(numbers[1]) + fabsf(numbers[2]);
    bool has_direction = sum > 0.0f && sum <= 1e37f;
    for (unsigned k = 0; k < 3; k++)
        out[k] = has_direction ? numbers[k] : 0.0f;
    c->has_zero_normals |= !has_direction;
    return end;
}

/* ---- elements ---- */

/* A stored index; count: elements of the chunk's list so far. */
static inline const char *read_index(const char *p, size_t count, uint32_t *out)
{
    bool is_negative = *p == '-';
    const char *q = p + (*p == '-' || *p == '+');
    uint32_t value;
    unsigned digits = number_read_digits(q, &value);
    q += digits;
    uint64_t index = value;
    if (digits == 8)
        for (; *q >= '0' && *q <= '9'; q++)
            index = index < OBJ_MAX ? 10 * index + (uint64_t)(*q - '0') : index;
    *out = OBJ_WRONG;
    if (index == 0 || index > OBJ_MAX)
        return digits ? q : p;
    *out = is_negative ? (uint32_t)(OBJ_RELATIVE + OBJ_MAX + count - index) : (uint32_t)index - 1;
    return q;
}

/* Fills the list of an attribute that earlier corners lack. */
static bool start_indices(obj_chunk *c, obj_indices *list, const facet_allocator *allocator)
{
    while (list->capacity < c->v.capacity)
        if (!obj_indices_grow(c, list, allocator))
            return false;
    for (size_t i = 0; i < c->v.count; i++)
        list->data[i] = OBJ_ABSENT;
    list->count = c->v.count;
    return true;
}

static bool grow_corners(obj_chunk *c, const facet_allocator *allocator)
{
    return obj_indices_grow(c, &c->v, allocator) && (!c->t.data || obj_indices_grow(c, &c->t, allocator)) &&
           (!c->n.data || obj_indices_grow(c, &c->n, allocator));
}

static inline bool add_corner(obj_chunk *c, uint32_t v, uint32_t t, uint32_t n,
                              const facet_allocator *allocator)
{
    if (c->v.count == c->v.capacity && !grow_corners(c, allocator))
        return false;
    if (t != OBJ_ABSENT && !c->t.data && !start_indices(c, &c->t, allocator))
        return false;
    if (n != OBJ_ABSENT && !c->n.data && !start_indices(c, &c->n, allocator))
        return false;
    size_t i = c->v.count++;
    c->v.data[i] = v;
    if (c->t.data)
        c->t.data[c->t.count++] = t;
    if (c->n.data)
        c->n.data[c->n.count++] = n;
    return true;
}

/* v, v/t, v//n or v/t/n. */
static inline const char *read_corner(obj_chunk *c, const char *p, const facet_allocator *allocator)
{
    uint32_t v;
    uint32_t t = OBJ_ABSENT;
    uint32_t n = OBJ_ABSENT;
    const char *q = read_index(p, c->positions.count, &v);
    if (*q == '/') {
        q++;
        if (*q != '/' && !obj_ends_word(q))
            q = read_index(q, c->texcoords.count, &t);
        if (*q == '/') {
            q++;
            if (!obj_ends_word(q))
                q = read_index(q, c->normals.count, &n);
        }
    }
    if (!obj_ends_word(q)) {
        v = OBJ_WRONG;
        q = obj_skip_word(p);
    }
    return add_corner(c, v, t, n, allocator) ? q : p;
}

static const char *read_element(obj_chunk *c, const char *p, scene_mode mode,
                                const facet_allocator *allocator)
{
    if (c->sizes.count == c->sizes.capacity && !obj_indices_grow(c, &c->sizes, allocator))
        return p;
    if (c->sizes.count == c->wanted_element)
        c->found_offset = c->offset + (size_t)(p - c->text);
    if (c->mode != (int)mode) {
        c->mode = (int)mode;
        obj_add_event(c, (obj_event){.kind = OBJ_MODE, .value = mode}, allocator);
    }
    size_t before = c->v.count;
    for (;;) {
        p = obj_skip_blanks(p);
        if (obj_is_line_end(*p) || *p == '#' || c->has_failed)
            break;
        p = read_corner(c, p, allocator);
    }
    c->sizes.data[c->sizes.count++] = (uint32_t)(c->v.count - before);
    return p;
}

/* ---- lines ---- */

const char *obj_read_element(obj_chunk *c, const char *p, scene_mode mode, const facet_allocator *allocator)
{
    return read_element(c, p, mode, allocator);
}

const char *obj_read_vertex(obj_chunk *c, const char *p, char kind, const facet_allocator *allocator)
{
    return kind == 't'   ? read_texcoord(c, p, allocator)
           : kind == 'n' ? read_normal(c, p, allocator)
                         : read_position(c, p, allocator);
}

void obj_add_event(obj_chunk *c, obj_event event, const facet_allocator *allocator)
{
    if (!mem_reserve(allocator, (void **)&c->events, &c->event_capacity, c->event_count + 1,
                     sizeof *c->events)) {
        c->has_failed = true;
        return;
    }
    event.element = (uint32_t)c->sizes.count;
    event.corner = (uint32_t)c->v.count;
    c->events[c->event_count++] = event;
}

/* The fast path for the most common statements. */
static inline const char *parse_line(obj_chunk *c, const char *p, const facet_allocator *allocator)
{
    if (p[0] == 'v') {
        if (p[1] == ' ')
            return read_position(c, p + 2, allocator);
        if (p[1] == 't' && p[2] == ' ')
            return read_texcoord(c, p + 3, allocator);
        if (p[1] == 'n' && p[2] == ' ')
            return read_normal(c, p + 3, allocator);
    }
    if (p[0] == 'f' && p[1] == ' ')
        return read_element(c, p + 2, SCENE_TRIANGLES, allocator);
    return obj_parse_statement(c, p, allocator);
}

static void shrink(obj_chunk *c, void **data, size_t count, size_t size)
{
    if (!*data)
        return;
    void *smaller = mem_resize(*data, count, size);
    if (smaller)
        *data = smaller;
    else
        c->has_failed = true;
}

void obj_parse_chunk(obj_chunk *c, const facet_allocator *allocator)
{
    const char *end = c->text + c->size;
    c->mode = -1;
    for (const char *p = c->text; p < end && !c->has_failed;) {
        p = obj_skip_blanks(p);
        if (!obj_is_line_end(*p))
            p = parse_line(c, p, allocator);
        if (!obj_is_line_end(*p))
            p = obj_skip_statement(p);
        p++;
    }
    shrink(c, (void **)&c->positions.data, c->positions.count, 3 * sizeof(float));
    shrink(c, (void **)&c->colors.data, c->colors.count, 4 * sizeof(float));
    shrink(c, (void **)&c->texcoords.data, c->texcoords.count, 2 * sizeof(float));
    shrink(c, (void **)&c->normals.data, c->normals.count, 3 * sizeof(float));
    shrink(c, (void **)&c->sizes.data, c->sizes.count, sizeof(uint32_t));
    shrink(c, (void **)&c->v.data, c->v.count, sizeof(uint32_t));
    shrink(c, (void **)&c->t.data, c->t.count, sizeof(uint32_t));
    shrink(c, (void **)&c->n.data, c->n.count, sizeof(uint32_t));
    shrink(c, (void **)&c->events, c->event_count, sizeof *c->events);
}

size_t obj_find_element(const obj_chunk *c, size_t element, const facet_allocator *allocator)
{
    obj_chunk again = {.text = c->text, .size = c->size, .offset = c->offset, .wanted_element = element};
    again.found_offset = c->offset;
    obj_parse_chunk(&again, allocator);
    size_t offset = again.found_offset;
    obj_chunk_release(&again);
    return offset;
}
