/* obj_check.c - elements of a chunk whose indices are right, counted from 0; the others go. */
#include <math.h>

#include "io/obj/obj_reader.h"

/* What one chunk is checked against, and where the next corner and element that stay are put. */
typedef struct checking {
    const obj_reader *r;
    obj_chunk *c;
    size_t corner, element; /* out */
    size_t number;          /* of the element, as parse counted */
    uint32_t triangle_count;
} checking;

/* Notes hold the number of the element; obj_warn_all() finds its line. */
static void note(checking *k, obj_remark remark)
{
    obj_note(&k->c->remarks, remark, k->number);
}

/* An index that is not simply one of count; OBJ_WRONG where there is nothing. */
static uint32_t resolve(uint32_t index, size_t base, size_t count)
{
    if (index < count || index == OBJ_ABSENT)
        return index;
    if (index < OBJ_RELATIVE || index == OBJ_WRONG)
        return OBJ_WRONG;
    int64_t own = (int64_t)base + (int64_t)(index - OBJ_RELATIVE) - (int64_t)OBJ_MOST;
    return own >= 0 && own < (int64_t)count ? (uint32_t)own : OBJ_WRONG;
}

/* Whether all positions of the element are there and finite. */
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

/* An index of nothing that is there counts as none. */
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

/* The file's normals count where all corners have one. */
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

/* Moves the corners to their place, those of a face without the ones that repeat the position before; returns how many
 * stay. */
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
