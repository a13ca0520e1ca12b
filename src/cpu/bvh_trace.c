/* bvh_trace.c - rays through a bvh_scene. A traversal tests four boxes at a time, and four triangles in each leaf. */
#include <math.h>
#include <string.h>

#include "base/simd.h"
#include "cpu/bvh_scene.h"
#include "shade/lang/lang_c_load.h"

#define INLINE static inline __attribute__((always_inline))

/* Three children wait at each inner node on the way to a leaf. */
enum { STACK = 3 * BVH_MAX_DEPTH + 1 };

/* Far distances to boxes are that much larger: three roundings at either end (Ize 2013, "Robust BVH Ray Traversal"). */
static const float FAR_SLACK = 1.0f + 4e-7f;
/* Components of directions below this count as this: 0 / 0 has no sign. */
static const float LEAST_DIRECTION = 1e-18f;

/* A ray in the space of a tree. */
typedef struct tree_ray {
    float4 origin[3], inverse[3]; /* the same in all lanes */
    float direction[3];
    int near_plane[3], far_plane[3]; /* of bvh4_node */
    int axes[3];                     /* the last is that of the direction's largest component */
    float shear[2];                  /* the other components over that one */
} tree_ray;

/* A ray on its way. */
typedef struct search {
    const bvh_scene *scene;
    const ray_segment *ray;
    float far_t;
    ray_filter filter; /* NULL: none */
    void *context;
    bool has_hit;
    visibility_hit hit;
} search;

/* What a traversal is for; constants where it is inlined. */
typedef struct purpose {
    bool ends_at_first, has_filter;
} purpose;

/* Whether a ray can be traced: boxes tell nothing about infinities. */
INLINE bool is_finite_ray(const float origin[3], const float direction[3])
{
    const float sum = origin[0] + origin[1] + origin[2] + direction[0] + direction[1] + direction[2];
    return fabsf(sum) < INFINITY;
}

INLINE tree_ray make_tree_ray(const float origin[3], const float direction[3])
{
    tree_ray r;
    for (int i = 0; i < 3; i++) {
        const float d = direction[i];
        const float safe = fabsf(d) < LEAST_DIRECTION ? copysignf(LEAST_DIRECTION, d) : d;
        r.origin[i] = float4_all(origin[i]);
        r.inverse[i] = float4_all(1.0f / safe);
        r.direction[i] = d;
        r.near_plane[i] = 2 * i + (safe < 0.0f);
        r.far_plane[i] = 2 * i + !(safe < 0.0f);
    }
    const float size[3] = {fabsf(direction[0]), fabsf(direction[1]), fabsf(direction[2])};
    const int largest = size[0] >= size[1] ? (size[0] >= size[2] ? 0 : 2) : (size[1] >= size[2] ? 1 : 2);
    for (int i = 0; i < 3; i++)
        r.axes[i] = (largest + 1 + i) % 3;
    for (int i = 0; i < 2; i++)
        r.shear[i] = direction[r.axes[i]] / direction[largest];
    return r;
}

/* ---- hits ---- */

/* Whether a candidate is nearer than the hit so far. */
INLINE bool is_nearer(const search *s, float t, uint32_t geometry, uint32_t primitive)
{
    if (t < s->far_t)
        return true;
    if (!(t <= s->far_t))
        return false;
    if (!s->has_hit)
        return true;
    return geometry != s->hit.geometry ? geometry < s->hit.geometry : primitive < s->hit.primitive;
}

/* Takes a hit that is_nearer(). True: the ray ends. */
INLINE bool take(search *s, purpose p, const visibility_hit *hit)
{
    if (p.has_filter && !s->filter(s->context, hit))
        return false;
    s->hit = *hit;
    s->far_t = hit->t;
    s->has_hit = true;
    return p.ends_at_first;
}

/* ---- triangles ---- */

typedef struct triangle_hits {
    float4 t, u, v;
    float4 normal[3];
    uint32_t mask;
} triangle_hits;

/* A corner in the plane across the ray's largest component, along the ray, with the ray as origin. */
typedef struct seen_corner {
    float4 x, y;
} seen_corner;

INLINE seen_corner see_corner(const tree_ray *r, const float4 corner[3], float4 *z)
{
    *z = corner[r->axes[2]] - r->origin[r->axes[2]];
    return (seen_corner){corner[r->axes[0]] - r->origin[r->axes[0]] - *z * r->shear[0],
                         corner[r->axes[1]] - r->origin[r->axes[1]] - *z * r->shear[1]};
}

/* Twice the area that the origin and an edge enclose. Its sign is right, or it is 0: of two rounded products the larger is
 * not the smaller one of the exact ones. */
INLINE float4 edge_function(seen_corner b, seen_corner c)
{
    return c.x * b.y - c.y * b.x;
}

/* Whether 0 is among or between the three. */
INLINE int4 is_around(float4 a, float4 b, float4 c)
{
    return (float4_min(float4_min(a, b), c) <= 0.0f) & (float4_max(float4_max(a, b), c) >= 0.0f);
}

/* Watertight (Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection"): corners are sheared so that the ray is
 * the z axis, each once for all triangles that share it, and the ray passes a triangle where its edge functions have one
 * sign, or none. Where products are fused into sums, which C forbids here and shaders do not, signs are wrong by the
 * rounding of a product; a tolerance of 2 units in the last place of their sum covers that. Triangles that are tiny relative
 * to their distance from the ray have edge functions of 0: those that it passes by have no corners on both sides. */
INLINE triangle_hits intersect_triangles(const tree_ray *r, const bvh4_triangles *triangles, float near_t,
                                         float far_t)
{
    const float tolerance = 2.0f * 1.1920929e-7f;
    float4 z, e1[3], e2[3];
    const seen_corner a = see_corner(r, triangles->corners[0], &z);
    const seen_corner b = see_corner(r, triangles->corners[1], &z);
    const seen_corner c = see_corner(r, triangles->corners[2], &z);
    const float4 u = edge_function(c, a); /* of the second corner's weight */
    const float4 v = edge_function(a, b); /* of the third's */
    const float4 w = edge_function(b, c);
    const float4 sum = u + v + w;
    const int4 sign = {INT32_MIN, INT32_MIN, INT32_MIN, INT32_MIN};
    const float4 slack = (float4)((int4)sum & ~sign) * tolerance;
    const float4 least = float4_min(float4_min(u, v), w);
    const float4 most = float4_max(float4_max(u, v), w);
    triangle_hits h = {.mask = 0};
    /* A sum of 0: seen edge-on, or so small that its corners are one point relative to the origin. */
    const int4 is_inside = ((least >= -slack) | (most <= slack)) & (sum != 0.0f);
    if (!int4_bits(is_inside))
        return h;
    if (!int4_bits(is_inside))
        return h;
    for (int i = 0; i < 3; i++) {
        e1[i] = triangles->corners[1][i] - triangles->corners[0][i];
        e2[i] = triangles->corners[2][i] - triangles->corners[0][i];
    }
    for (int i = 0; i < 3; i++)
        h.normal[i] = e1[(i + 1) % 3] * e2[(i + 2) % 3] - e1[(i + 2) % 3] * e2[(i + 1) % 3];
    const float4 speed =
        h.normal[0] * r->direction[0] + h.normal[1] * r->direction[1] + h.normal[2] * r->direction[2];
    h.t = (h.normal[0] * (triangles->corners[0][0] - r->origin[0]) +
           h.normal[1] * (triangles->corners[0][1] - r->origin[1]) +
           h.normal[2] * (triangles->corners[0][2] - r->origin[2])) /
          speed;
    const int4 is_met = is_inside & is_around(a.x, b.x, c.x) & is_around(a.y, b.y, c.y) & (speed != 0.0f) &
                        (h.t >= near_t) & (h.t <= far_t);
    h.mask = int4_bits(is_met);
    h.u = float4_min(u / sum, float4_all(1.0f));
    h.v = float4_min(v / sum, float4_all(1.0f));
    return h;
}

/* instance: of the triangles' space; VISIBILITY_NONE: the world's. */
INLINE bool visit_triangles(search *s, purpose p, const tree_ray *r, const bvh4_triangles *block,
                            uint32_t instance)
{
    const triangle_hits h = intersect_triangles(r, block, s->ray->near_t, s->far_t);
    for (uint32_t mask = h.mask; mask; mask &= mask - 1) {
        const int lane = __builtin_ctz(mask);
        if (p.ends_at_first && !p.has_filter)
            return true;
        const uint32_t geometry = instance == VISIBILITY_NONE ? block->geometry[lane] : instance;
        if (!is_nearer(s, h.t[lane], geometry, block->primitive[lane]))
            continue;
        visibility_hit hit = {.t = h.t[lane],
                              .u = h.u[lane],
                              .v = h.v[lane],
                              .geometry = geometry,
                              .primitive = block->primitive[lane],
                              .normal = {h.normal[0][lane], h.normal[1][lane], h.normal[2][lane]}};
        if (instance != VISIBILITY_NONE)
            ray_leave_instance(s->scene->geometries, instance, &hit);
        if (take(s, p, &hit))
            return true;
    }
    return false;
}

/* ---- traversal ---- */

typedef struct waiting {
    float t;
    int32_t child;
} waiting;

/* Bits of the children that the ray passes in front of far_t; where, at least near_t. */
INLINE uint32_t intersect_boxes(const tree_ray *r, const bvh4_node *node, float near_t, float far_t,
                                float4 *t)
{
    float4 first = float4_all(near_t);
    float4 last = float4_all(far_t);
    for (int i = 0; i < 3; i++) {
        first = float4_max((node->planes[r->near_plane[i]] - r->origin[i]) * r->inverse[i], first);
        last = float4_min((node->planes[r->far_plane[i]] - r->origin[i]) * r->inverse[i] * FAR_SLACK, last);
    }
    *t = first;
    return int4_bits(first <= last);
}

/* Pushes the children but for the nearest, the farthest first, and returns that one. */
INLINE int32_t choose_nearest(const bvh4_node *node, uint32_t mask, float4 t, waiting *stack, int *count)
{
    const int first = __builtin_ctz(mask);
    int32_t nearest = node->children[first];
    mask &= mask - 1;
    if (!mask)
        return nearest;
    float nearest_t = t[first];
    const int base = *count;
    for (; mask; mask &= mask - 1) {
        const int lane = __builtin_ctz(mask);
        waiting next = {.t = t[lane], .child = node->children[lane]};
        if (next.t < nearest_t) {
            const waiting swap = {.t = nearest_t, .child = nearest};
            nearest_t = next.t;
            nearest = next.child;
            next = swap;
        }
        int place = (*count)++;
        while (place > base && stack[place - 1].t < next.t) {
            stack[place] = stack[place - 1];
            place--;
        }
        stack[place] = next;
    }
    return nearest;
}

/* Children that a traversal still has to visit. */
typedef struct walk {
    int count;
    waiting stack[STACK];
} walk;

INLINE void start(walk *w, const bvh4 *tree)
{
    w->stack[0] = (waiting){.t = -INFINITY, .child = tree->root.child};
    w->count = tree->root.child != BVH_EMPTY;
}

/* The next leaf that the ray passes in front of far_t, the near ones first as far as boxes tell. False: there is none. */
INLINE bool next_leaf(walk *w, const bvh4 *tree, const tree_ray *r, float near_t, float far_t, uint32_t *leaf)
{
    while (w->count > 0) {
        const waiting top = w->stack[--w->count];
        int32_t child = top.child;
        uint32_t mask = top.t <= far_t;
        while (mask && !bvh_is_leaf(child)) {
            const bvh4_node *node = &tree->nodes[child];
            float4 t;
            mask = intersect_boxes(r, node, near_t, far_t, &t);
            if (mask)
                child = choose_nearest(node, mask, t, w->stack, &w->count);
        }
        if (mask) {
            *leaf = (uint32_t)~child;
            return true;
        }
    }
    return false;
}

INLINE bool search_mesh(search *s, purpose p, const tree_ray *r, const bvh_mesh *mesh, uint32_t instance)
{
    walk w;
    uint32_t leaf;
    start(&w, &mesh->tree);
    while (next_leaf(&w, &mesh->tree, r, s->ray->near_t, s->far_t, &leaf))
        if (visit_triangles(s, p, r, &mesh->blocks[leaf], instance))
            return true;
    return false;
}

/* ---- lines and points ---- */

/* In the plane across the ray: a line has the width of its ends, mixed; a point is a disc. As Embree does, hits around the
 * ray's origin do not count: a surface does not hide itself. */
static bool intersect_line(const ray_segment *ray, const float *a, const float *b, visibility_hit *hit)
{
    const vec3 d = load3(ray->direction);
    const float speed2 = dot(d, d);
    const vec3 p = load3(a) - load3(ray->origin);
    const vec3 v = load3(b) - load3(a);
    const vec3 p_across = p - d * (dot(p, d) / speed2);
    const vec3 v_across = v - d * (dot(v, d) / speed2);
    const float v2 = dot(v_across, v_across);
    const float u = v2 > 0.0f ? clamp(-dot(p_across, v_across) / v2, 0.0f, 1.0f) : 0.0f;
    const vec3 nearest = p_across + v_across * u;
    const float radius = a[3] + (b[3] - a[3]) * u;
    hit->t = dot(p + v * u, d) / speed2;
    hit->u = u;
    hit->v = 0.0f;
    store3(v, hit->normal);
    return dot(nearest, nearest) <= radius * radius && hit->t >= ray->near_t &&
           hit->t > 2.0f * radius * inversesqrt(speed2);
}

static bool intersect_point(const ray_segment *ray, const float *a, visibility_hit *hit)
{
    const vec3 d = load3(ray->direction);
    const vec3 p = load3(a) - load3(ray->origin);
    hit->t = dot(p, d) / dot(d, d);
    hit->u = hit->v = 0.0f;
    store3(-d, hit->normal);
    const vec3 across = p - d * hit->t;
    const float radius2 = a[3] * a[3];
    return dot(across, across) <= radius2 && dot(p, p) > radius2 && hit->t >= ray->near_t;
}

static bool visit_sprites(search *s, purpose p, const bvh4_others *block)
{
    for (uint32_t i = 0; i < block->count; i++) {
        const render_geometry *g = &s->scene->geometries->items[block->geometry[i]];
        visibility_hit hit = {.geometry = block->geometry[i], .primitive = block->primitive[i]};
        const bool is_line = g->primitive->mode == SCENE_LINES;
        const float *a = g->vertices + (is_line ? 8 : 4) * (size_t)hit.primitive;
        if ((is_line ? intersect_line(s->ray, a, a + 4, &hit) : intersect_point(s->ray, a, &hit)) &&
            is_nearer(s, hit.t, hit.geometry, hit.primitive) && take(s, p, &hit))
            return true;
    }
    return false;
}

INLINE bool search_sprites(search *s, purpose p, const tree_ray *r)
{
    walk w;
    uint32_t leaf;
    start(&w, &s->scene->sprites.tree);
    while (next_leaf(&w, &s->scene->sprites.tree, r, s->ray->near_t, s->far_t, &leaf))
        if (visit_sprites(s, p, &s->scene->sprites.blocks[leaf]))
            return true;
    return false;
}

/* ---- instances ---- */

INLINE void enter_instance(const bvh_instance *place, const ray_segment *ray, float origin[3],
                           float direction[3])
{
    for (int i = 0; i < 3; i++) {
        const float *row = place->to_object + 4 * i;
        const float *o = ray->origin;
        const float *d = ray->direction;
        origin[i] = row[0] * o[0] + row[1] * o[1] + row[2] * o[2] + row[3];
        direction[i] = row[0] * d[0] + row[1] * d[1] + row[2] * d[2];
    }
}

INLINE bool visit_instances(search *s, purpose p, const bvh4_others *block)
{
    for (uint32_t i = 0; i < block->count; i++) {
        const uint32_t number = block->geometry[i];
        float origin[3], direction[3];
        enter_instance(&s->scene->places[number], s->ray, origin, direction);
        if (!is_finite_ray(origin, direction))
            continue;
        const tree_ray r = make_tree_ray(origin, direction);
        if (search_mesh(s, p, &r, &s->scene->shapes[s->scene->geometries->items[number].shape], number))
            return true;
    }
    return false;
}

INLINE bool search_instances(search *s, purpose p, const tree_ray *r)
{
    walk w;
    uint32_t leaf;
    start(&w, &s->scene->instances.tree);
    while (next_leaf(&w, &s->scene->instances.tree, r, s->ray->near_t, s->far_t, &leaf))
        if (visit_instances(s, p, &s->scene->instances.blocks[leaf]))
            return true;
    return false;
}

/* ---- rays ---- */

/* True: a hit ended the ray. */
INLINE bool run(search *s, purpose p)
{
    s->far_t = s->ray->far_t;
    s->has_hit = false;
    if (!is_finite_ray(s->ray->origin, s->ray->direction))
        return false;
    const tree_ray r = make_tree_ray(s->ray->origin, s->ray->direction);
    return search_mesh(s, p, &r, &s->scene->flat, VISIBILITY_NONE) ||
           search_mesh(s, p, &r, &s->scene->still, VISIBILITY_NONE) || search_sprites(s, p, &r) ||
           search_instances(s, p, &r);
}

DISPATCH_AVX2 static bool bvh_search_dispatched(search *s)
{
    run(s, (purpose){.ends_at_first = false});
    return s->has_hit;
}

DISPATCH_AVX2 static bool bvh_filtered_search_dispatched(search *s)
{
    run(s, (purpose){.has_filter = true});
    return s->has_hit;
}

DISPATCH_AVX2 static bool bvh_shadow_dispatched(search *s)
{
    return run(s, (purpose){.ends_at_first = true});
}

DISPATCH_AVX2 static bool bvh_filtered_shadow_dispatched(search *s)
{
    return run(s, (purpose){.ends_at_first = true, .has_filter = true});
}

bool bvh_nearest(const bvh_scene *scene, const ray_segment *ray, visibility_hit *hit)
{
    search s = {.scene = scene, .ray = ray};
    if (!bvh_search_dispatched(&s))
        return false;
    *hit = s.hit;
    return true;
}

bool bvh_nearest_filtered(const bvh_scene *scene, const ray_segment *ray, ray_filter filter, void *context,
                          visibility_hit *hit)
{
    search s = {.scene = scene, .ray = ray, .filter = filter, .context = context};
    if (!bvh_filtered_search_dispatched(&s))
        return false;
    *hit = s.hit;
    return true;
}

bool bvh_occluded(const bvh_scene *scene, const ray_segment *ray)
{
    search s = {.scene = scene, .ray = ray};
    return bvh_shadow_dispatched(&s);
}

bool bvh_occluded_filtered(const bvh_scene *scene, const ray_segment *ray, ray_filter filter, void *context)
{
    search s = {.scene = scene, .ray = ray, .filter = filter, .context = context};
    return bvh_filtered_shadow_dispatched(&s);
}
