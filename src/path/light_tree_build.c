/* light_tree_build.c - builds a light tree top down: see light_tree.h. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"

#include "path/light_tree_nodes.h"

enum {
    BINS = 12,
    MAX_UNEVEN_DEPTH = 40 /* binary splits by cost down a branch; halves from there on, at most 32 */
};

/* A light during the construction. */
typedef struct item {
    float center[3], radius;
    float normal[3]; /* axis times intensity; 0 for lights without one direction */
    float intensity;
    uint32_t light;
} item;

/* Sums over some items. */
typedef struct cluster {
    float low[3], high[3]; /* of the spheres */
    float normal[3], intensity;
    uint32_t count;
} cluster;

static const cluster EMPTY = {
    {INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, {0.0f, 0.0f, 0.0f}, 0.0f, 0};

/* Items begin .. end - 1, and their cost. */
typedef struct range {
    uint32_t begin, end;
    uint32_t depth; /* binary splits above */
    float cost;
} range;

typedef struct builder {
    const facet_allocator *allocator;
    const light_bounds *lights;
    item *items;
    light_tree *tree;
    size_t node_count, node_capacity;
} builder;

/* ---- cost ---- */

static void add_item(cluster *c, const item *it)
{
    for (int i = 0; i < 3; i++) {
        c->low[i] = min(c->low[i], it->center[i] - it->radius);
        c->high[i] = max(c->high[i], it->center[i] + it->radius);
        c->normal[i] += it->normal[i];
    }
    c->intensity += it->intensity;
    c->count++;
}

static void add_cluster(cluster *c, const cluster *other)
{
    for (int i = 0; i < 3; i++) {
        c->low[i] = min(c->low[i], other->low[i]);
        c->high[i] = max(c->high[i], other->high[i]);
        c->normal[i] += other->normal[i];
    }
    c->intensity += other->intensity;
    c->count += other->count;
}

/* The surface area orientation heuristic: intensity times area of the box times a measure of the
 * directions of emission (Conty Estevez and Kulla 2018, section 4.4). The latter, from pi for one
 * direction to 4 pi for all, follows from the length of the mean normal: a cap of half-angle t has R = (1
 * + cos t) / 2, and pi (4 - 3 R^2) is within 9 % of their integral. */
static float cost_of(const cluster *c)
{
    if (!(c->intensity > 0.0f))
        return 0.0f;
    float x = c->high[0] - c->low[0];
    float y = c->high[1] - c->low[1];
    float z = c->high[2] - c->low[2];
    float R2 = (c->normal[0] * c->normal[0] + c->normal[1] * c->normal[1] + c->normal[2] * c->normal[2]) /
               (c->intensity * c->intensity);
    return c->intensity * (x * y + y * z + z * x) * (4.0f - 3.0f * min(R2, 1.0f));
}

/* ---- splitting ---- */

typedef struct split {
    int axis; /* -1: in halves of their order */
    float origin, bins_per_m;
    int bin; /* the first of the right side */
    float cost, left_cost, right_cost;
} split;

static int bin_of(const item *it, int axis, float origin, float bins_per_m)
{
    int bin = (int)((it->center[axis] - origin) * bins_per_m);
    return bin < 0 ? 0 : bin < BINS ? bin : BINS - 1;
}

/* Updates *best by the splits between the bins of one axis. thinness: ratio of the longest axis to this
 * one. */
static void try_axis(int axis, const cluster bins[BINS], float thinness, split *best)
{
    float right_cost[BINS];
    cluster right = EMPTY;
    for (int i = BINS - 1; i > 0; i--) {
        add_cluster(&right, &bins[i]);
        right_cost[i] = right.count ? cost_of(&right) : -1.0f;
    }
    cluster left = EMPTY;
    for (int i = 1; i < BINS; i++) {
        add_cluster(&left, &bins[i - 1]);
        if (!left.count || right_cost[i] < 0.0f)
            continue;
        float left_cost = cost_of(&left);
        float cost = (left_cost + right_cost[i]) * thinness;
        if (cost < best->cost) {
            best->axis = axis;
            best->bin = i;
            best->cost = cost;
            best->left_cost = left_cost;
            best->right_cost = right_cost[i];
        }
    }
}

/* The bins of an axis; false: it has no extent. */
static bool place_bins(float low, float high, float *bins_per_m)
{
    *bins_per_m = (float)BINS / (high - low);
    return high > low && isfinite(*bins_per_m);
}

static split find_split(const builder *b, const range *r, const float low[3], const float high[3])
{
    cluster bins[3][BINS];
    float bins_per_m[3];
    bool has_bins[3];
    float widest = 0.0f;
    for (int axis = 0; axis < 3; axis++) {
        has_bins[axis] = place_bins(low[axis], high[axis], &bins_per_m[axis]);
        widest = max(widest, high[axis] - low[axis]);
        for (int i = 0; i < BINS; i++)
            bins[axis][i] = EMPTY;
    }
    for (uint32_t i = r->begin; i < r->end; i++)
        for (int axis = 0; axis < 3; axis++)
            if (has_bins[axis])
                add_item(&bins[axis][bin_of(&b->items[i], axis, low[axis], bins_per_m[axis])], &b->items[i]);
    split best = {.axis = -1, .cost = INFINITY};
    for (int axis = 0; axis < 3; axis++)
        if (has_bins[axis]) /* thin boxes are bad neighbours */
            try_axis(axis, bins[axis], widest / (high[axis] - low[axis]), &best);
    if (best.axis >= 0) {
        best.origin = low[best.axis];
        best.bins_per_m = bins_per_m[best.axis];
    }
    return best;
}

static cluster cluster_of(const builder *b, uint32_t begin, uint32_t end)
{
    cluster all = EMPTY;
    for (uint32_t i = begin; i < end; i++)
        add_item(&all, &b->items[i]);
    return all;
}

/* Partitions the items of r; neither side is empty. */
static void split_range(builder *b, const range *r, range *left, range *right)
{
    float low[3] = {INFINITY, INFINITY, INFINITY};
    float high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = r->begin; i < r->end; i++)
        for (int axis = 0; axis < 3; axis++) {
            low[axis] = min(low[axis], b->items[i].center[axis]);
            high[axis] = max(high[axis], b->items[i].center[axis]);
        }
    split best = {.axis = -1, .cost = INFINITY};
    if (r->depth < MAX_UNEVEN_DEPTH)
        best = find_split(b, r, low, high);
    uint32_t middle = r->begin + (r->end - r->begin) / 2;
    if (best.axis >= 0) {
        uint32_t end = r->end;
        middle = r->begin;
        while (middle < end)
            if (bin_of(&b->items[middle], best.axis, best.origin, best.bins_per_m) < best.bin) {
                middle++;
            } else {
                item moved = b->items[--end];
                b->items[end] = b->items[middle];
                b->items[middle] = moved;
            }
    } else {
        cluster sides[2] = {cluster_of(b, r->begin, middle), cluster_of(b, middle, r->end)};
        best.left_cost = cost_of(&sides[0]);
        best.right_cost = cost_of(&sides[1]);
    }
    *left = (range){r->begin, middle, r->depth + 1, best.left_cost};
    *right = (range){middle, r->end, r->depth + 1, best.right_cost};
}

/* Splits r into up to eight parts: the most expensive first. */
static int split_into_children(builder *b, const range *r, range children[WIDTH])
{
    int count = 1;
    children[0] = *r;
    while (count < WIDTH) {
        int most = -1;
        for (int i = 0; i < count; i++)
            if (children[i].end - children[i].begin > 1 &&
                (most < 0 || children[i].cost > children[most].cost))
                most = i;
        if (most < 0)
            break;
        range left;
        range right;
        split_range(b, &children[most], &left, &right);
        children[most] = left;
        children[count++] = right;
    }
    return count;
}

/* ---- bounds ---- */

/* The cone of all normals: around their mean, as wide as the farthest; normals of two-sided lights count
 * on the side of the first one's. Returns the length of the mean. */
static float bound_directions(const builder *b, const range *r, light_bounds *out)
{
    vec3 reference = b->lights[b->items[r->begin].light].axis;
    vec3 sum = vec3(0.0f);
    out->is_two_sided = false;
    for (uint32_t i = r->begin; i < r->end; i++) {
        const light_bounds *l = &b->lights[b->items[i].light];
        bool is_against = l->is_two_sided && dot(l->axis, reference) < 0.0f;
        sum += l->axis * (is_against ? -l->intensity : l->intensity);
        out->is_two_sided |= l->is_two_sided;
    }
    float length2 = dot(sum, sum);
    out->axis = vec3(0.0f);
    out->cos_spread = -1.0f;
    if (!(length2 > 1e-30f) || !isfinite(length2))
        return 0.0f;
    out->axis = sum * inversesqrt(length2);
    float mean = min(sqrt(length2) / out->intensity, 1.0f);
    float least = 1.0f;
    for (uint32_t i = r->begin; i < r->end; i++) {
        const light_bounds *l = &b->lights[b->items[i].light];
        if (!(l->cos_spread > 0.0f))
            return mean;
        float cosine = dot(out->axis, l->axis);
        least = min(least, l->is_two_sided ? abs(cosine) : cosine);
    }
    float widest = acos(max(least, -1.0f)) + 1e-3f; /* acos is inaccurate near 1 */
    out->cos_spread = widest < PI ? cos(widest) : -1.0f;
    return mean;
}

/* mean_normal: as in nodes. */
static light_bounds bounds_of(const builder *b, const range *r, float *mean_normal)
{
    const light_bounds *first = &b->lights[b->items[r->begin].light];
    *mean_normal = first->cos_spread > 0.0f ? 1.0f : 0.0f;
    if (r->end - r->begin == 1)
        return *first;
    cluster all = cluster_of(b, r->begin, r->end);
    light_bounds out = {
        .intensity = all.intensity, .dark = first->dark, .full = first->full, .slack = INFINITY};
    for (int axis = 0; axis < 3; axis++)
        out.center[axis] = 0.5f * all.low[axis] + 0.5f * all.high[axis];
    *mean_normal = bound_directions(b, r, &out);
    for (uint32_t i = r->begin; i < r->end; i++) {
        const light_bounds *l = &b->lights[b->items[i].light];
        float distance = length(l->center - out.center) * 1.000001f;
        out.radius = max(out.radius, distance + l->radius);
        out.reach = max(out.reach, distance + l->reach);
        out.dark = min(out.dark, l->dark);
        out.full = min(out.full, l->full);
    }
    return out;
}

/* ---- nodes ---- */

static void store_bounds(light_tree_node *node, int i, const light_bounds *l, float mean_normal)
{
    bool has_cosine_emission = l->dark >= 0.0f && l->full >= 1.0f;
    node->mean_normal[i] = mean_normal;
    node->bound_share[i] = has_cosine_emission ? BOUND_SHARE : 1.0f;
    node->x[i] = l->center[0];
    node->y[i] = l->center[1];
    node->z[i] = l->center[2];
    node->radius[i] = l->radius;
    node->axis_x[i] = l->axis[0];
    node->axis_y[i] = l->axis[1];
    node->axis_z[i] = l->axis[2];
    node->cos_spread[i] = l->cos_spread;
    node->sin_spread[i] = sqrt(max(1.0f - l->cos_spread * l->cos_spread, 0.0f));
    node->back[i] = l->is_two_sided ? -1.0f : 1.0f;
    node->dark[i] = l->dark;
    node->per_ramp[i] = 1.0f / max(l->full - l->dark, 1e-6f);
    node->slack[i] = l->slack;
    node->per_radius2[i] = 1.0f / max(l->radius * l->radius, 1e-30f);
    node->per_reach2[i] = 1.0f / (l->reach * l->reach);
    node->intensity[i] = l->intensity;
}

/* A new node without emission; NULL: no memory. */
static light_tree_node *new_node(builder *b, uint32_t place)
{
    void *nodes = b->tree->nodes;
    if (!mem_reserve(b->allocator, &nodes, &b->node_capacity, b->node_count + 1, sizeof *b->tree->nodes))
        return NULL;
    b->tree->nodes = nodes;
    light_tree_node *node = &b->tree->nodes[b->node_count++];
    *node = (light_tree_node){.place = place};
    const light_bounds dark = {.dark = 0.0f, .full = 1.0f, .reach = INFINITY};
    for (int i = 0; i < WIDTH; i++)
        store_bounds(node, i, &dark, 0.0f);
    return node;
}

/* False: no memory. Depth is bounded by the split's: each node is at least one of them farther down. */
static bool build(builder *b, const range *r, uint32_t place)
{
    uint32_t number = (uint32_t)b->node_count;
    if (!new_node(b, place))
        return false;
    range children[WIDTH];
    int count = split_into_children(b, r, children);
    for (int i = 0; i < count; i++) {
        float mean_normal;
        light_bounds bounds = bounds_of(b, &children[i], &mean_normal);
        store_bounds(&b->tree->nodes[number], i, &bounds, mean_normal);
        uint32_t here = WIDTH * number + (uint32_t)i;
        if (children[i].end - children[i].begin == 1) {
            uint32_t light = b->items[children[i].begin].light;
            b->tree->nodes[number].child[i] = LEAF | light;
            b->tree->places[light] = here;
            continue;
        }
        b->tree->nodes[number].child[i] = (uint32_t)b->node_count;
        if (!build(b, &children[i], here))
            return false;
    }
    return true;
}

static void fill_item(item *it, const light_bounds *l, uint32_t light)
{
    *it = (item){.radius = l->radius, .intensity = l->intensity, .light = light};
    for (int axis = 0; axis < 3; axis++) {
        it->center[axis] = l->center[axis];
        it->normal[axis] = l->is_two_sided ? 0.0f : l->axis[axis] * l->intensity;
    }
}

facet_result light_tree_create(const light_bounds *lights, uint32_t count, const facet_allocator *allocator,
                               light_tree **out, facet_error *error)
{
    *out = NULL;
    builder b = {.allocator = allocator, .lights = lights};
    b.tree = mem_zalloc(allocator, 1, sizeof *b.tree);
    b.items = mem_alloc(allocator, count, sizeof *b.items);
    if (b.tree)
        b.tree->places = mem_alloc(allocator, count, sizeof *b.tree->places);
    bool has_memory = b.tree && b.items && b.tree->places;
    if (has_memory) {
        for (uint32_t i = 0; i < count; i++)
            fill_item(&b.items[i], &lights[i], i);
        has_memory = build(&b, &(range){0, count, 0, 0.0f}, LIGHT_TREE_NONE);
    }
    mem_free(b.items);
    if (!has_memory) {
        light_tree_destroy(b.tree);
        return fail_memory(error, "light tree", (size_t)count * sizeof(light_tree_node) / WIDTH);
    }
    *out = b.tree;
    return FACET_OK;
}
