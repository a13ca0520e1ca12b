/* stray.c - see stray.h. A scene without stray parts costs a few hundred samples. */
#include "scene/stray.h"

#include <stdlib.h>

#include "scene/unseen.h"

enum { SAMPLES = 256, MAX_ROUNDS = 64 };
/* Stray parts are FAR_DIAGONALS diagonals of the core away, which has at least CORE_SHARE of the elements. */
static const double FAR_DIAGONALS = 30.0, CORE_SHARE = 0.75;

/* ---- elements ---- */

static uint32_t corner_count(const scene_primitive *p)
{
    return p->mode == SCENE_TRIANGLES ? 3 : p->mode == SCENE_LINES ? 2 : 1;
}

static uint64_t element_count(const scene_instance *instance)
{
    return instance->primitive->index_count / corner_count(instance->primitive);
}

/* The box around an element, in world space. False: it has no area. */
static bool element_box(const scene_instance *instance, uint64_t i, box *out)
{
    const scene_primitive *p = instance->primitive;
    uint32_t corners = corner_count(p);
    const uint32_t *indices = p->indices + i * corners;
    if (p->has_flat_triangles && unseen_is_flat(instance->positions, indices))
        return false;
    *out = box_empty();
    for (uint32_t k = 0; k < corners; k++) {
        float world[3];
        mat4_transform_point(&instance->world, instance->positions + 3 * (size_t)indices[k], world);
        box_add(out, world);
    }
    return true;
}

static double middle(const box *b, int axis)
{
    return 0.5 * ((double)b->minimum[axis] + (double)b->maximum[axis]);
}

/* ---- the core ---- */

typedef struct core {
    double center[3], radius; /* a cube */
} core;

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a;
    double y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The centers of up to SAMPLES elements, evenly spaced. */
static uint32_t sample(const scene_pose *pose, uint64_t whole, double middles[3][SAMPLES])
{
    uint64_t wanted = whole < SAMPLES ? whole : SAMPLES;
    uint64_t before = 0;
    uint64_t next = 0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < pose->instance_count && next < wanted; i++) {
        const scene_instance *instance = &pose->instances[i];
        uint64_t n = bounds_count(pose, instance) ? element_count(instance) : 0;
        for (; next < wanted && next * whole / wanted < before + n; next++) {
            box b;
            if (!element_box(instance, next * whole / wanted - before, &b))
                continue;
            for (int axis = 0; axis < 3; axis++)
                middles[axis][count] = middle(&b, axis);
            count++;
        }
        before += n;
    }
    return count;
}

static core find_core(double middles[3][SAMPLES], uint32_t count)
{
    double sorted[SAMPLES];
    core c;
    for (int axis = 0; axis < 3; axis++) {
        for (uint32_t i = 0; i < count; i++)
            sorted[i] = middles[axis][i];
        qsort(sorted, count, sizeof *sorted, compare);
        c.center[axis] = sorted[count / 2];
    }
    for (uint32_t i = 0; i < count; i++) {
        sorted[i] = 0.0;
        for (int axis = 0; axis < 3; axis++)
            sorted[i] = fmax(sorted[i], fabs(middles[axis][i] - c.center[axis]));
    }
    qsort(sorted, count, sizeof *sorted, compare);
    c.radius = sorted[(uint32_t)ceil(CORE_SHARE * count) - 1];
    return c;
}

/* ---- the kept box ---- */

/* The distance of two boxes; 0: they touch. */
static double distance(const wide_box *a, const box *b)
{
    double sum = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        double gap =
            fmax(a->minimum[axis] - (double)b->maximum[axis], (double)b->minimum[axis] - a->maximum[axis]);
        sum += gap > 0.0 ? gap * gap : 0.0;
    }
    return sqrt(sum);
}

static wide_box widen(const box *b)
{
    wide_box w;
    for (int axis = 0; axis < 3; axis++) {
        w.minimum[axis] = (double)b->minimum[axis];
        w.maximum[axis] = (double)b->maximum[axis];
    }
    return w;
}

static bool is_in_core(const core *c, const box *b)
{
    for (int axis = 0; axis < 3; axis++)
        if (!(fabs(middle(b, axis) - c->center[axis]) <= c->radius))
            return false;
    return true;
}

static box core_box(const scene_pose *pose, const core *c)
{
    box kept = box_empty();
    box cube;
    for (int axis = 0; axis < 3; axis++) {
        cube.minimum[axis] = (float)(c->center[axis] - c->radius);
        cube.maximum[axis] = (float)(c->center[axis] + c->radius);
    }
    for (uint32_t i = 0; i < pose->instance_count; i++) {
        const scene_instance *instance = &pose->instances[i];
        wide_box around = box_enclose(instance, instance->bounds_min, instance->bounds_max);
        bool is_near = bounds_count(pose, instance) && !(distance(&around, &cube) > c->radius);
        for (uint64_t k = 0; is_near && k < element_count(instance); k++) {
            box b;
            if (element_box(instance, k, &b) && is_in_core(c, &b))
                box_join(&kept, &b);
        }
    }
    return kept;
}

/* Joins elements within reach of `kept` to *grown, and counts both kinds. */
static void add_instance(const scene_instance *instance, const box *kept, double reach, box *grown,
                         stray_parts *out)
{
    uint64_t n = element_count(instance);
    wide_box around = box_enclose(instance, instance->bounds_min, instance->bounds_max);
    double nearest = distance(&around, kept);
    if (nearest > reach) { /* all of it */
        out->count += n;
        out->whole += n;
        out->distance_m = fmin(out->distance_m, nearest);
        return;
    }
    for (uint64_t k = 0; k < n; k++) {
        box b;
        if (!element_box(instance, k, &b))
            continue;
        wide_box w = widen(&b);
        double gap = distance(&w, kept);
        out->whole++;
        if (gap <= reach) {
            box_join(grown, &b);
            continue;
        }
        out->count++;
        out->distance_m = fmin(out->distance_m, gap);
    }
}

/* Whether a contains b. */
static bool contains(const box *a, const box *b)
{
    for (int axis = 0; axis < 3; axis++)
        if (a->minimum[axis] > b->minimum[axis] || a->maximum[axis] < b->maximum[axis])
            return false;
    return true;
}

/* Grows the kept box until nothing is within reach. False: too many rounds, as for chains of parts. */
static bool grow(const scene_pose *pose, stray_parts *out)
{
    for (int round = 0; round < MAX_ROUNDS; round++) {
        box grown = out->kept;
        double reach = FAR_DIAGONALS * box_diagonal(&out->kept);
        out->count = out->whole = 0;
        out->distance_m = HUGE_VAL;
        for (uint32_t i = 0; i < pose->instance_count; i++)
            if (bounds_count(pose, &pose->instances[i]))
                add_instance(&pose->instances[i], &out->kept, reach, &grown, out);
        if (out->count == 0)
            return false;
        if (contains(&out->kept, &grown))
            return true;
        out->kept = grown;
    }
    return false;
}

bool stray_find(const scene_pose *pose, stray_parts *out)
{
    double middles[3][SAMPLES];
    uint64_t whole = 0;
    for (uint32_t i = 0; i < pose->instance_count; i++)
        whole += bounds_count(pose, &pose->instances[i]) ? element_count(&pose->instances[i]) : 0;
    uint32_t count = sample(pose, whole, middles);
    if (count < 2)
        return false;
    core c = find_core(middles, count);
    box all;
    for (int axis = 0; axis < 3; axis++) {
        all.minimum[axis] = pose->bounds_min[axis];
        all.maximum[axis] = pose->bounds_max[axis];
    }
    if (!(FAR_DIAGONALS * 2.0 * c.radius < box_diagonal(&all)))
        return false;
    *out = (stray_parts){.kept = core_box(pose, &c)};
    if (!(box_diagonal(&out->kept) > 0.0) || !grow(pose, out))
        return false;
    out->diagonal_m = box_diagonal(&out->kept);
    return (double)(out->whole - out->count) >= CORE_SHARE * (double)out->whole;
}
