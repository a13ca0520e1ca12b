/* obj_triangulate.c - see obj_triangulate.h. */
#include "io/obj/obj_triangulate.h"

#include <math.h>

/* ---- quadrilaterals ---- */

static void edge(const float *from, const float *to, double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = (double)to[k] - (double)from[k];
}

static void cross(const double u[3], const double v[3], double out[3])
{
    out[0] = u[1] * v[2] - u[2] * v[1];
    out[1] = u[2] * v[0] - u[0] * v[2];
    out[2] = u[0] * v[1] - u[1] * v[0];
}

/* Whether u x v points to the side of normal. */
static bool turns_along(const double u[3], const double v[3], const double normal[3])
{
    double c[3];
    cross(u, v, c);
    return c[0] * normal[0] + c[1] * normal[1] + c[2] * normal[2] > 0.0;
}

const uint32_t *obj_split_quad(const float *a, const float *b, const float *c, const float *d)
{
    static const uint32_t along_ac[6] = {0, 1, 2, 0, 2, 3};
    static const uint32_t along_bd[6] = {0, 1, 3, 1, 2, 3};
    double ab[3];
    double ac[3];
    double ad[3];
    double bc[3];
    double bd[3];
    double normal[3]; /* Newell's normal, times 2: the cross product of the diagonals */
    edge(a, b, ab);
    edge(a, c, ac);
    edge(a, d, ad);
    edge(b, d, bd);
    cross(ac, bd, normal);
    if (turns_along(ab, ac, normal) && turns_along(ac, ad, normal))
        return along_ac;
    edge(b, c, bc);
    return turns_along(ab, ad, normal) && turns_along(bc, bd, normal) ? along_bd : along_ac;
}

/* ---- the plane ---- */

enum { IS_CONVEX = 1, IS_NO_EAR = 2, IS_CUT = 4, IS_SPIKE = 8 };

/* The state of one triangulation. */
typedef struct cutting {
    obj_polygon *p;
    uint32_t remaining; /* corners */
    uint32_t *out;
    size_t budget;         /* remaining work, in corners examined */
    double low[2], extent; /* the bounding square */
    double scale;          /* of the grid: cells per unit of length */
    double cells[2];       /* of the grid; 0: no grid, all corners are examined */
    uint32_t row;
} cutting;

/* Projected areas by Newell's formula around the first point, so that nothing cancels far from the origin. */
static void newell(const float *points, uint32_t count, double normal[3])
{
    normal[0] = normal[1] = normal[2] = 0.0;
    double u[3];
    edge(points, points + 3, u);
    for (uint32_t i = 2; i < count; i++) {
        double v[3];
        double c[3];
        edge(points, points + 3 * (size_t)i, v);
        cross(u, v, c);
        for (int k = 0; k < 3; k++) {
            normal[k] += c[k];
            u[k] = v[k];
        }
    }
}

/* Drops the axis of the largest projection, oriented counterclockwise: coordinates stay unchanged, and
 * with them the signs of areas. */
static void project(obj_polygon *p, uint32_t count)
{
    double normal[3];
    newell(p->points, count, normal);
    int axis = 2;
    for (int k = 0; k < 2; k++)
        if (fabs(normal[k]) > fabs(normal[axis]))
            axis = k;
    int u = (axis + 1) % 3;
    int v = (axis + 2) % 3;
    if (normal[axis] < 0.0) {
        int swapped = u;
        u = v;
        v = swapped;
    }
    for (size_t i = 0; i < count; i++) {
        p->plane[2 * i] = (double)p->points[3 * i + (size_t)u];
        p->plane[2 * i + 1] = (double)p->points[3 * i + (size_t)v];
    }
}

/* Twice the signed area of the triangle; > 0: counterclockwise. */
static double area(const double *a, const double *b, const double *c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static const double *at(const cutting *c, uint32_t corner)
{
    return c->p->plane + 2 * (size_t)corner;
}

static bool is_same(const double *a, const double *b)
{
    return a[0] == b[0] && a[1] == b[1];
}

static double corner_area(const cutting *c, uint32_t i)
{
    return area(at(c, c->p->previous[i]), at(c, i), at(c, c->p->next[i]));
}

/* Whether the polygon is convex: all corners turn left, and x has one minimum and one maximum (a spiral
 * has more). */
static bool is_convex(const cutting *c)
{
    int turns = 0;
    double last = 0.0;
    double first = 0.0;
    for (uint32_t i = 0; i < c->remaining; i++) {
        if (!(c->p->states[i] & IS_CONVEX))
            return false;
        double step = at(c, c->p->next[i])[0] - at(c, i)[0];
        if (step == 0.0)
            continue;
        turns += last != 0.0 && (step > 0.0) != (last > 0.0);
        last = step;
        first = first == 0.0 ? step : first;
    }
    turns += (last > 0.0) != (first > 0.0);
    return turns <= 2;
}

/* ---- a grid of the corners that can be in an ear ---- */

enum { FEW_CORNERS = 48, MAX_CELLS_ACROSS = 1024 };

static uint32_t cell_of(const cutting *c, int axis, double x)
{
    double cell = (x - c->low[axis]) * c->scale;
    return cell > 0.0 ? cell < c->cells[axis] - 1.0 ? (uint32_t)cell : (uint32_t)c->cells[axis] - 1 : 0;
}

static uint32_t cell_of_corner(const cutting *c, uint32_t i)
{
    return cell_of(c, 1, at(c, i)[1]) * c->row + cell_of(c, 0, at(c, i)[0]);
}

static void find_extent(cutting *c, uint32_t count, double high[2])
{
    c->low[0] = c->low[1] = HUGE_VAL;
    high[0] = high[1] = -HUGE_VAL;
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 2; k++) {
            c->low[k] = fmin(c->low[k], at(c, i)[k]);
            high[k] = fmax(high[k], at(c, i)[k]);
        }
    c->extent = fmax(high[0] - c->low[0], high[1] - c->low[1]);
}

/* About one corner per cell; cells are squares. */
static void make_grid(cutting *c, uint32_t count)
{
    obj_polygon *p = c->p;
    double high[2];
    find_extent(c, count, high);
    c->scale = fmin(floor(sqrt((double)count)), MAX_CELLS_ACROSS) / c->extent;
    if (count < FEW_CORNERS || !(c->extent > 0.0 && c->scale < 1e300))
        return;
    for (int k = 0; k < 2; k++)
        c->cells[k] = floor((high[k] - c->low[k]) * c->scale) + 1.0;
    c->row = (uint32_t)c->cells[0];
    uint32_t cells = c->row * (uint32_t)c->cells[1];
    for (uint32_t i = 0; i < cells; i++)
        p->cell_ends[i] = 0;
    for (uint32_t i = 0; i < count; i++)
        if (!(p->states[i] & IS_CONVEX))
            p->cell_ends[cell_of_corner(c, i)]++;
    for (uint32_t i = 0, sum = 0; i < cells; i++) {
        p->cell_begins[i] = sum;
        sum += p->cell_ends[i];
        p->cell_ends[i] = p->cell_begins[i];
    }
    for (uint32_t i = 0; i < count; i++)
        if (!(p->states[i] & IS_CONVEX))
            p->cell_corners[p->cell_ends[cell_of_corner(c, i)]++] = i;
}

/* ---- ears ---- */

/* The triangle at corner tip, with counterclockwise sides. */
typedef struct ear {
    const double *a, *b, *c;
    bool is_strict; /* points on its sides count as inside */
} ear;

/* Points that coincide with a corner of the ear never block it: they are the other side of a bridge, or
 * touch it. */
static bool is_blocked_by(const ear *e, const double *q)
{
    double ab = area(e->a, e->b, q);
    double bc = area(e->b, e->c, q);
    double ca = area(e->c, e->a, q);
    if (e->is_strict ? !(ab >= 0.0 && bc >= 0.0 && ca >= 0.0) : !(ab > 0.0 && bc > 0.0 && ca > 0.0))
        return false;
    return !is_same(q, e->a) && !is_same(q, e->b) && !is_same(q, e->c);
}

static void spend(cutting *c, size_t count)
{
    c->budget = c->budget > count ? c->budget - count : 0;
}

/* Corners that were cut or became convex are removed from the grid on the way. */
static bool is_blocked_in_cell(cutting *c, const ear *e, uint32_t cell)
{
    const obj_polygon *p = c->p;
    uint32_t *corners = p->cell_corners;
    uint32_t i = p->cell_begins[cell];
    spend(c, 1 + p->cell_ends[cell] - i);
    while (i < p->cell_ends[cell]) {
        uint32_t q = corners[i];
        if (p->states[q] & (IS_CONVEX | IS_CUT))
            corners[i] = corners[--p->cell_ends[cell]];
        else if (is_blocked_by(e, at(c, q)))
            return true;
        else
            i++;
    }
    return false;
}

/* Whether a reflex corner lies in the ear. If any corner does, a reflex one does, too. */
static bool is_blocked(cutting *c, const ear *e)
{
    const obj_polygon *p = c->p;
    if (c->cells[0] == 0.0) {
        uint32_t first = (uint32_t)((e->b - p->plane) / 2);
        spend(c, c->remaining);
        for (uint32_t q = p->next[first]; q != first; q = p->next[q])
            if (!(p->states[q] & IS_CONVEX) && is_blocked_by(e, at(c, q)))
                return true;
        return false;
    }
    uint32_t low[2];
    uint32_t high[2];
    for (int k = 0; k < 2; k++) {
        low[k] = cell_of(c, k, fmin(fmin(e->a[k], e->b[k]), e->c[k]));
        high[k] = cell_of(c, k, fmax(fmax(e->a[k], e->b[k]), e->c[k]));
    }
    for (uint32_t y = low[1]; y <= high[1]; y++)
        for (uint32_t x = low[0]; x <= high[0]; x++)
            if (is_blocked_in_cell(c, e, y * c->row + x))
                return true;
    return false;
}

static bool is_ear(cutting *c, uint32_t i, bool is_strict)
{
    const obj_polygon *p = c->p;
    spend(c, 1);
    if (!(p->states[i] & IS_CONVEX))
        return false;
    const ear e = {at(c, p->previous[i]), at(c, i), at(c, p->next[i]), is_strict};
    return !is_blocked(c, &e);
}

/* A degenerate corner can be cut at once, as nothing is inside. */
static void classify_corner(cutting *c, uint32_t i)
{
    const double *a = at(c, c->p->previous[i]);
    const double *b = at(c, i);
    const double *d = at(c, c->p->next[i]);
    bool is_spike = is_same(a, b) || is_same(b, d) || is_same(a, d);
    c->p->states[i] = is_spike ? IS_SPIKE : area(a, b, d) > 0.0 ? IS_CONVEX : 0;
}

/* Emits the triangle at corner i; returns the next corner. */
static uint32_t cut(cutting *c, uint32_t i)
{
    obj_polygon *p = c->p;
    uint32_t before = p->previous[i];
    uint32_t after = p->next[i];
    *c->out++ = before;
    *c->out++ = i;
    *c->out++ = after;
    p->next[before] = after;
    p->previous[after] = before;
    p->states[i] = IS_CUT;
    c->remaining--;
    classify_corner(c, before);
    classify_corner(c, after);
    return after;
}

static bool is_short(const cutting *c, uint32_t i, double limit)
{
    const double *a = at(c, c->p->previous[i]);
    const double *b = at(c, c->p->next[i]);
    return (b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]) <= limit;
}

/* Whether to cut corner i now. A corner that is not an ear is marked: it stays one until a neighbor is
 * cut, since its blocking corner cannot be cut before. */
static bool is_next(cutting *c, uint32_t i, double limit)
{
    uint8_t *state = &c->p->states[i];
    if (*state & IS_SPIKE)
        return true;
    if ((*state & (IS_CONVEX | IS_NO_EAR)) != IS_CONVEX || !is_short(c, i, limit))
        return false;
    if (is_ear(c, i, true))
        return true;
    *state |= IS_NO_EAR;
    return false;
}

/* Cuts ears whose new side has a squared length of at most limit until there are none; returns a remaining
 * corner. */
static uint32_t cut_short_ears(cutting *c, uint32_t i, double limit)
{
    for (uint32_t without = 0; c->remaining > 3 && without < c->remaining && c->budget > 0;) {
        if (is_next(c, i, limit)) {
            i = c->p->previous[cut(c, i)];
            without = 0;
        } else {
            i = c->p->next[i];
            without++;
        }
    }
    spend(c, c->remaining);
    return i;
}

/* Cuts ears, short ones first, for better triangles and fewer corners near each. */
static uint32_t cut_ears(cutting *c, uint32_t i)
{
    double side = 2.0 * c->extent / (double)c->remaining;
    for (double limit = side * side; limit < c->extent * c->extent && c->remaining > 3; limit *= 4.0)
        i = cut_short_ears(c, i, limit);
    return cut_short_ears(c, i, HUGE_VAL);
}

static bool is_any_ear(cutting *c, uint32_t i)
{
    return is_ear(c, i, true);
}
static bool is_touched_ear(cutting *c, uint32_t i)
{
    return is_ear(c, i, false);
}
static bool is_straight(cutting *c, uint32_t i)
{
    spend(c, 1);
    return corner_area(c, i) == 0.0;
}
static bool is_convex_corner(cutting *c, uint32_t i)
{
    spend(c, 1);
    return (c->p->states[i] & IS_CONVEX) != 0;
}

/* Cuts one corner where no ear is known, the least bad one: an ear that was overlooked, one with touched
 * sides, a degenerate corner, a convex one (the polygon crosses itself). */
static uint32_t cut_something(cutting *c, uint32_t start)
{
    bool (*const choices[])(cutting *, uint32_t) = {is_any_ear, is_touched_ear, is_straight,
                                                    is_convex_corner};
    for (size_t k = 0; k < sizeof choices / sizeof *choices; k++) {
        uint32_t i = start;
        do {
            if (choices[k](c, i))
                return cut(c, i);
            i = c->p->next[i];
        } while (i != start && c->budget > 0);
    }
    return cut(c, start);
}

static void cut_fan(cutting *c, uint32_t i)
{
    while (c->remaining > 2)
        i = c->p->previous[cut(c, c->p->next[i])];
}

/* The number of corners to examine: all pairs up to 1000 corners; up to some 60 000, 1000 per corner;
 * beyond, 64. With the grid, simple polygons take fewer than 10, combs of many teeth 300. */
static size_t find_budget(uint32_t count)
{
    size_t all = (size_t)1024 * count + ((size_t)1 << 16);
    size_t most = (size_t)64 * count + ((size_t)1 << 26);
    return all < most ? all : most;
}

void obj_triangulate(obj_polygon *p, uint32_t count, uint32_t *triangles)
{
    cutting c = {.p = p, .remaining = count, .out = triangles, .budget = find_budget(count)};
    p->is_rough = false;
    project(p, count);
    for (uint32_t i = 0; i < count; i++) {
        p->previous[i] = i ? i - 1 : count - 1;
        p->next[i] = i + 1 < count ? i + 1 : 0;
    }
    for (uint32_t i = 0; i < count; i++)
        classify_corner(&c, i);
    uint32_t i = 0;
    if (!is_convex(&c)) {
        make_grid(&c, count);
        i = cut_ears(&c, i);
        while (c.remaining > 3 && c.budget > 0)
            i = cut_short_ears(&c, cut_something(&c, i), HUGE_VAL);
        p->is_rough = c.remaining > 3;
    }
    cut_fan(&c, i);
}

/* ---- memory ---- */

void obj_polygon_release(obj_polygon *p)
{
    mem_free(p->points);
    mem_free(p->plane);
    mem_free(p->previous);
    mem_free(p->next);
    mem_free(p->states);
    mem_free(p->cell_begins);
    mem_free(p->cell_ends);
    mem_free(p->cell_corners);
    *p = (obj_polygon){.allocator = p->allocator};
}

bool obj_polygon_reserve(obj_polygon *p, uint32_t count)
{
    if (count <= p->capacity)
        return true;
    obj_polygon_release(p);
    uint32_t room = count < 64 ? 64 : count;
    p->points = mem_alloc(&p->allocator, room, 3 * sizeof *p->points);
    p->plane = mem_alloc(&p->allocator, room, 2 * sizeof *p->plane);
    p->previous = mem_alloc(&p->allocator, room, sizeof *p->previous);
    p->next = mem_alloc(&p->allocator, room, sizeof *p->next);
    p->states = mem_alloc(&p->allocator, room, sizeof *p->states);
    size_t across = (size_t)sqrt((double)room) + 1; /* maximal number of cells */
    p->cell_begins = mem_alloc(&p->allocator, across * across, sizeof *p->cell_begins);
    p->cell_ends = mem_alloc(&p->allocator, across * across, sizeof *p->cell_ends);
    p->cell_corners = mem_alloc(&p->allocator, room, sizeof *p->cell_corners);
    if (!p->points || !p->plane || !p->previous || !p->next || !p->states || !p->cell_begins ||
        !p->cell_ends || !p->cell_corners) {
        obj_polygon_release(p);
        return false;
    }
    p->capacity = room;
    return true;
}
