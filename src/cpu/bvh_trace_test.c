/* bvh_trace_test.c - facet's own BVH against Embree, ray by ray, and against lists of all hits. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "cpu/bvh_fixture.h"

static float uniform(uint32_t *state)
{
    *state = *state * 747796405u + 2891336453u;
    uint32_t word = ((*state >> ((*state >> 28) + 4)) ^ *state) * 277803737u;
    return (float)(((word >> 22) ^ word) >> 8) * (1.0f / 16777216.0f);
}

/* From a point in a box of twice the scene's, towards one in the scene's. */
static ray_segment random_ray(uint32_t *state, const float low[3], const float high[3])
{
    ray_segment ray = {.far_t = INFINITY};
    for (int i = 0; i < 3; i++) {
        const float middle = 0.5f * (low[i] + high[i]);
        const float size = high[i] - low[i];
        ray.origin[i] = middle + size * 2.0f * (uniform(state) - 0.5f);
        ray.direction[i] = middle + size * (uniform(state) - 0.5f) - ray.origin[i];
    }
    return ray;
}

static float length(const float v[3])
{
    return sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* The distance of a triangle's plane, in double. */
static double exact_distance(const bvh_fixture *f, const ray_segment *ray, const visibility_hit *hit)
{
    const render_geometry *g = &f->set.items[hit->geometry];
    const uint32_t *indices = render_geometry_triangle(g, hit->primitive);
    double p[3][3], n[3];
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++) {
            const float *v = g->vertices + 3 * (size_t)indices[c];
            p[c][k] = (double)v[k];
            if (g->world)
                p[c][k] = (double)g->world->m[k] * (double)v[0] + (double)g->world->m[4 + k] * (double)v[1] +
                          (double)g->world->m[8 + k] * (double)v[2] + (double)g->world->m[12 + k];
        }
    double above = 0.0, speed = 0.0;
    for (int k = 0; k < 3; k++) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        n[k] = (p[1][a] - p[0][a]) * (p[2][b] - p[0][b]) - (p[1][b] - p[0][b]) * (p[2][a] - p[0][a]);
        above += n[k] * (p[0][k] - (double)ray->origin[k]);
        speed += n[k] * (double)ray->direction[k];
    }
    return above / speed;
}

/* Up to rounding of coordinates relative to the ray's origin. */
static bool is_same_distance(const ray_segment *ray, double a, double b)
{
    const double speed = (double)length(ray->direction);
    return fabs(a - b) * speed <= 1e-6 * ((double)length(ray->origin) + fmax(a, b) * speed);
}

/* Counts of rays. */
typedef struct tally {
    uint32_t hits, ties; /* of Embree; of another triangle */
    uint32_t own_misses, own_extra;
    uint32_t own_inexact, embree_inexact; /* distances */
    uint32_t other_distance, other_place, other_normal, other_occluded;
} tally;

static bool is_triangle(const bvh_fixture *f, const visibility_hit *hit)
{
    return f->set.items[hit->geometry].primitive->mode == SCENE_TRIANGLES;
}

/* The same for what the weights of two hits on a triangle (or a line) mean. */
static bool is_same_place(const bvh_fixture *f, const ray_segment *ray, const visibility_hit *a,
                          const visibility_hit *b)
{
    if (!is_triangle(f, a))
        return fabsf(a->u - b->u) <= 1e-4f;
    const render_geometry *g = &f->set.items[a->geometry];
    const uint32_t *indices = render_geometry_triangle(g, a->primitive);
    float p[3][3], between[3];
    for (int c = 0; c < 3; c++)
        render_geometry_corner(g, indices[c], p[c]);
    for (int k = 0; k < 3; k++)
        between[k] = (a->u - b->u) * (p[1][k] - p[0][k]) + (a->v - b->v) * (p[2][k] - p[0][k]);
    return length(between) <= 4e-6f * (length(ray->origin) + a->t * length(ray->direction));
}

static void compare_hits(const bvh_fixture *f, const ray_segment *ray, const visibility_hit *a,
                         const visibility_hit *b, tally *t)
{
    if (is_triangle(f, a))
        t->own_inexact += is_same_distance(ray, (double)a->t, exact_distance(f, ray, a)) ? 0 : 1;
    if (is_triangle(f, b))
        t->embree_inexact += is_same_distance(ray, (double)b->t, exact_distance(f, ray, b)) ? 0 : 1;
    t->other_distance += is_same_distance(ray, (double)a->t, (double)b->t) ? 0 : 1;
    if (a->geometry != b->geometry || a->primitive != b->primitive) {
        t->ties++;
        return;
    }
    t->other_place += is_same_place(f, ray, a, b) ? 0 : 1;
    float dot = 0.0f;
    for (int i = 0; i < 3; i++)
        dot += a->normal[i] * b->normal[i];
    t->other_normal += dot >= 0.9999f * length(a->normal) * length(b->normal) ? 0 : 1;
}

static tally compare_rays(const bvh_fixture *f, uint32_t count)
{
    tally t = {0};
    float low[3], high[3];
    uint32_t state = 1;
    f->own.tracer->bounds(f->own.bvh, low, high);
    for (uint32_t i = 0; i < count; i++) {
        ray_segment ray = random_ray(&state, low, high);
        visibility_hit a, b;
        if (i % 4 == 3 && f->embree.tracer->nearest(f->embree.bvh, &ray, &a))
            for (int k = 0; k < 3; k++) { /* from near a surface, as bounces */
                ray.origin[k] += a.t * 0.9999f * ray.direction[k];
                ray.direction[k] = 2.0f * uniform(&state) - 1.0f;
            }
        const bool has_a = f->own.tracer->nearest(f->own.bvh, &ray, &a);
        const bool has_b = f->embree.tracer->nearest(f->embree.bvh, &ray, &b);
        t.hits += has_b;
        t.own_misses += !has_a && has_b;
        t.own_extra += has_a && !has_b;
        t.other_occluded += f->own.tracer->occluded(f->own.bvh, &ray) != has_a;
        if (has_a && has_b)
            compare_hits(f, &ray, &a, &b, &t);
    }
    return t;
}

/* Most of what differs, of a million hits. Slivers are thinner than the rounding of what they are computed from. */
typedef struct limits {
    uint32_t ties, hits, distances, places, normals;
} limits;

static const limits most[BVH_FIXTURES] = {[BVH_SPHERE] = {50, 0, 200, 0, 0},
                                          [BVH_SOUP] = {500, 10, 1000, 200, 0},
                                          [BVH_SLIVERS] = {2000, 2000, 200000, 700000, 0},
                                          [BVH_SPRITES] = {50, 20, 100, 100, 0},
                                          [BVH_INSTANCES] = {3000, 100, 5000, 20000, 50}};

static void assert_few(const char *fixture, const char *what, uint32_t count, uint32_t of_million,
                       uint32_t hits)
{
    if ((uint64_t)count * 1000000 > (uint64_t)of_million * hits)
        fail_msg("%s: %u of %u hits differ: %s", fixture, count, hits, what);
}

static void hits_are_those_of_embree(void **state)
{
    (void)state;
    for (int kind = 0; kind < BVH_FIXTURES; kind++) {
        bvh_fixture f;
        const char *name = bvh_fixture_name(kind);
        const limits *m = &most[kind];
        bvh_fixture_create(&f, kind, 2);
        const tally t = compare_rays(&f, 250000);
        print_message(
            "%s: %u hits; %u ties, %u missing, %u extra; inexact %u, Embree's %u; other distance %u, "
            "place %u, normal %u\n",
            name, t.hits, t.ties, t.own_misses, t.own_extra, t.own_inexact, t.embree_inexact,
            t.other_distance, t.other_place, t.other_normal);
        assert_in_range(t.hits, 5000, 250000);
        assert_int_equal(t.other_occluded, 0);
        assert_few(name, "another triangle", t.ties, m->ties, t.hits);
        assert_few(name, "hit or not", t.own_misses + t.own_extra, m->hits, t.hits);
        assert_few(name, "distance", t.other_distance, m->distances, t.hits);
        assert_few(name, "place on the triangle", t.other_place, m->places, t.hits);
        assert_few(name, "normal", t.other_normal, m->normals, t.hits);
        assert_true(t.own_inexact <= t.embree_inexact + t.embree_inexact / 4 + 5);
        bvh_fixture_destroy(&f);
    }
}

/* ---- filters ---- */

enum { MAX_SEEN = 512 };

typedef struct seen_hits {
    uint32_t count;
    visibility_hit hits[MAX_SEEN];
} seen_hits;

static bool see(void *context, const visibility_hit *hit)
{
    seen_hits *s = context;
    assert_true(s->count < MAX_SEEN);
    s->hits[s->count++] = *hit;
    return false;
}

static bool accept_every_third(void *context, const visibility_hit *hit)
{
    (void)context;
    return (hit->geometry + hit->primitive) % 3 == 0;
}

/* Of the hits that a filter accepts, the first in the order of distance, geometry and primitive. */
static void filters_see_every_hit(void **state)
{
    (void)state;
    static seen_hits all;
    for (int kind = 0; kind < BVH_FIXTURES; kind++) {
        bvh_fixture f;
        float low[3], high[3];
        uint32_t random = 3, accepted = 0;
        bvh_fixture_create(&f, kind, 2);
        const ray_tracer *own = f.own.tracer;
        own->bounds(f.own.bvh, low, high);
        for (uint32_t i = 0; i < 20000; i++) {
            const ray_segment ray = random_ray(&random, low, high);
            visibility_hit hit, plain;
            all.count = 0;
            assert_false(own->nearest_filtered(f.own.bvh, &ray, see, &all, &hit));
            const visibility_hit *first = NULL, *first_third = NULL;
            for (uint32_t k = 0; k < all.count; k++) {
                const visibility_hit *h = &all.hits[k];
                const visibility_hit **best[2] = {&first, &first_third};
                for (int b = 0; b < (accept_every_third(NULL, h) ? 2 : 1); b++)
                    if (!*best[b] || h->t < (*best[b])->t ||
                        (h->t <= (*best[b])->t &&
                         (h->geometry < (*best[b])->geometry ||
                          (h->geometry == (*best[b])->geometry && h->primitive < (*best[b])->primitive))))
                        *best[b] = h;
            }
            const bool has_hit = own->nearest(f.own.bvh, &ray, &plain);
            assert_int_equal(has_hit, first != NULL);
            if (has_hit)
                assert_memory_equal(&plain, first, sizeof plain);
            const bool has_third = own->nearest_filtered(f.own.bvh, &ray, accept_every_third, NULL, &hit);
            assert_int_equal(has_third, first_third != NULL);
            if (has_third)
                assert_memory_equal(&hit, first_third, sizeof hit);
            assert_int_equal(own->occluded_filtered(f.own.bvh, &ray, accept_every_third, NULL), has_third);
            accepted += has_third;
        }
        assert_true(accepted > 100);
        bvh_fixture_destroy(&f);
    }
}

/* ---- segments ---- */

/* Near and far distances belong to the segment; a ray along an axis has infinite reciprocals. */
static void segments_end_where_they_say(void **state)
{
    (void)state;
    bvh_fixture f;
    visibility_hit hit;
    bvh_fixture_create(&f, BVH_SPHERE, 1);
    const ray_tracer *own = f.own.tracer;
    for (int axis = 0; axis < 3; axis++)
        for (int sign = -1; sign <= 1; sign += 2) {
            ray_segment ray = {.far_t = INFINITY};
            ray.direction[axis] = (float)sign;
            assert_true(own->nearest(f.own.bvh, &ray, &hit));
            const float t = hit.t;
            assert_float_equal(t, 1.0f, 1e-2f);
            ray.far_t = t;
            assert_true(own->nearest(f.own.bvh, &ray, &hit) && own->occluded(f.own.bvh, &ray));
            ray.far_t = nextafterf(t, 0.0f);
            assert_false(own->nearest(f.own.bvh, &ray, &hit) || own->occluded(f.own.bvh, &ray));
            ray.far_t = INFINITY;
            ray.near_t = t;
            assert_true(own->nearest(f.own.bvh, &ray, &hit) && own->occluded(f.own.bvh, &ray));
            ray.near_t = t * 1.00001f; /* behind all triangles at a corner */
            assert_false(own->nearest(f.own.bvh, &ray, &hit) || own->occluded(f.own.bvh, &ray));
        }
    const float bad[] = {NAN, INFINITY, -INFINITY, 1e30f, 0.0f};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
            const ray_segment ray = {
                .origin = {bad[i], 0.1f, 0.2f}, .direction = {bad[k], bad[k], bad[k]}, .far_t = INFINITY};
            own->nearest(f.own.bvh, &ray, &hit); /* ends */
        }
    bvh_fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(hits_are_those_of_embree),
                                       cmocka_unit_test(filters_see_every_hit),
                                       cmocka_unit_test(segments_end_where_they_say)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
