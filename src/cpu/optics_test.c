/* Tests of light in volumes: normals of boundaries, ray bundles, random numbers, media, diffuse transmission. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "cpu/media.h"

#include "cpu/boundary.h"
#include "cpu/preview_fixture.h"
#include "cpu/ray_samples.h"

/* ---- normals of boundaries ---- */

/* One triangle in world space, and a hit on it at weights u, v of its second and third corner. */
typedef struct triangle {
    float positions[9], normals[9];
    uint32_t indices[3];
    scene_primitive primitive;
    scene_material material;
    render_geometry geometry;
    visibility_hit hit;
    surface_point point;
} triangle;

static void set_triangle(triangle *t, const vec3 p[3], const vec3 n[3], float u, float v, vec3 V)
{
    *t = (triangle){.indices = {0, 1, 2}, .material = scene_material_default()};
    for (int i = 0; i < 3; i++) {
        store3(p[i], t->positions + 3 * i);
        store3(normalize(n[i]), t->normals + 3 * i);
    }
    t->primitive = (scene_primitive){.mode = SCENE_TRIANGLES, .vertex_count = 3, .index_count = 3};
    t->primitive.indices = t->indices;
    t->geometry = (render_geometry){.primitive = &t->primitive,
                                    .material = &t->material,
                                    .vertices = t->positions,
                                    .normals = t->normals,
                                    .normal_matrix = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    vec3 Ng = cross(p[1] - p[0], p[2] - p[0]);
    t->hit = (visibility_hit){.u = u, .v = v};
    store3(Ng, t->hit.normal);
    t->point = (surface_point){.is_front = dot(Ng, V) > 0.0f, .V = V};
    shading_hit *h = &t->point.hit;
    h->geometry = &t->geometry;
    h->weight[0] = 1.0f - u - v;
    h->weight[1] = u;
    h->weight[2] = v;
    h->corner[0] = 0;
    h->corner[1] = 1;
    h->corner[2] = 2;
    h->direction = -V;
    t->point.P = p[0] * h->weight[0] + p[1] * u + p[2] * v;
    vec3 N = normalize(n[0]) * h->weight[0] + normalize(n[1]) * u + normalize(n[2]) * v;
    t->point.m.base.N = normalize(N) * (t->point.is_front ? 1.0f : -1.0f);
}

/* The normals of a tessellated ball stay unchanged. */
static void normals_of_a_ball_stay(void **state)
{
    (void)state;
    static const float size[] = {0.05f, 0.2f, 0.5f};
    for (int i = 0; i < 3; i++) {
        float s = size[i];
        vec3 p[3] = {normalize(vec3(-s, -0.5f * s, 1.0f)), normalize(vec3(s, -s, 1.0f)),
                     normalize(vec3(0.3f * s, s, 1.0f))};
        for (int side = -1; side <= 1; side += 2) {
            triangle t;
            set_triangle(&t, p, p, 0.3f, 0.25f, normalize(vec3(0.2f, 0.1f, (float)side)));
            boundary_normal n = boundary_normal_at(&t.point, &t.hit);
            assert_true(dot(n.N, t.point.m.base.N) > 1.0f - 0.02f * s * s);
            assert_true(dot(n.Ng, t.point.V) > 0.0f && dot(n.N, t.point.V) > 0.0f);
        }
    }
}

/* A wall below a rim: the upper corners' normals lean up by 45 degrees, because they were averaged with
 * the rim's. */
static void normals_towards_a_rim_do_not_lean(void **state)
{
    (void)state;
    vec3 p[3] = {vec3(-0.1f, 0.0f, 0.0f), vec3(0.1f, 0.0f, 0.0f), vec3(0.1f, 1.0f, 0.0f)};
    vec3 n[3] = {vec3(-0.1f, 0.0f, 1.0f), vec3(0.1f, 0.0f, 1.0f), vec3(0.1f, 1.0f, 1.0f)};
    triangle t;
    set_triangle(&t, p, n, 0.2f, 0.7f, vec3(0.0f, 0.0f, 1.0f));
    assert_true(t.point.m.base.N[1] > 0.4f);
    boundary_normal b = boundary_normal_at(&t.point, &t.hit);
    assert_true(fabsf(b.N[1]) < 0.02f);
    assert_true(fabsf(b.N[0] - 0.08f) < 0.02f); /* it is a cylinder as before */
}

static void flat_normals_stay(void **state)
{
    (void)state;
    vec3 p[3] = {vec3(0.0f), vec3(1.0f, 0.0f, 0.2f), vec3(0.0f, 1.0f, -0.3f)};
    vec3 N = normalize(cross(p[1], p[2]));
    vec3 n[3] = {N, N, N};
    triangle t;
    set_triangle(&t, p, n, 0.3f, 0.3f, vec3(0.0f, 0.0f, 1.0f));
    boundary_normal b = boundary_normal_at(&t.point, &t.hit);
    assert_true(dot(b.N, N) > 1.0f - 1e-6f);
    assert_true(dot(b.dN_dx, b.dN_dx) < 1e-12f);
}

/* ---- bundles ---- */

/* A curved surface: N(P) = normalize(N0 + curvature P) around P = 0. */
static vec3 normal_at(vec3 P, float curvature)
{
    return normalize(vec3(0.0f, 0.0f, 1.0f) + vec3(P[0], P[1], 0.0f) * curvature);
}

static vec3 refracted(vec3 D, vec3 N, float eta)
{
    return refract(normalize(D), N, eta);
}

/* The differentials agree with neighboring rays that are traced one by one. */
static void bundles_follow_their_neighbours(void **state)
{
    (void)state;
    static const float etas[] = {1.0f / 1.5f, 1.5f, 0.0f}; /* 0: reflected */
    const float h = 1e-3f;
    const float curvature = 0.4f;
    vec3 D = normalize(vec3(0.3f, -0.2f, -1.0f));
    vec3 O = vec3(0.0f) - D * 2.0f;
    for (int i = 0; i < 3; i++) {
        ray_spread spread = {.direction_dx = {h, 0, 0}, .direction_dy = {0, h, 0}, .turns = true};
        shading_ray ray = {.spread = &spread, .footprint = 1.0f};
        store3(O, ray.origin);
        store3(D, ray.direction);
        surface_point s = {.V = -D, .P = vec3(0.0f)};
        vec3 N = vec3(0.0f, 0.0f, 1.0f);
        boundary_normal normal = {.N = N, .Ng = N};
        vec3 neighbours[2];
        for (int axis = 0; axis < 2; axis++) {
            vec3 d = D + vec3(axis ? 0.0f : h, axis ? h : 0.0f, 0.0f);
            vec3 P = O + d * (-O[2] / d[2]);
            vec3 there = normal_at(P, curvature);
            neighbours[axis] = etas[i] > 0.0f ? refracted(d, there, etas[i]) : reflect(normalize(d), there);
            if (axis)
                normal.dN_dy = there - N;
            else
                normal.dN_dx = there - N;
        }
        bundle_hit hit = ray_bundle_hit(&ray, &s, &normal);
        bundle_ray out;
        if (etas[i] > 0.0f)
            assert_true(ray_bundle_refract(&hit, N, etas[i], &out));
        else
            out = ray_bundle_reflect(&hit, N);
        vec3 direction = load3(out.ray.direction);
        vec3 expected = etas[i] > 0.0f ? refracted(D, N, etas[i]) : reflect(D, N);
        assert_true(length(direction - expected) < 1e-6f);
        assert_true(length(load3(out.spread.direction_dx) - (neighbours[0] - direction)) < 0.02f * h);
        assert_true(length(load3(out.spread.direction_dy) - (neighbours[1] - direction)) < 0.02f * h);
    }
    surface_point s = {.V = normalize(vec3(1.0f, 0.0f, 0.3f))};
    ray_spread none = {0};
    shading_ray ray = {.spread = &none, .footprint = 1.0f, .direction = {-1.0f, 0.0f, -0.3f}};
    boundary_normal flat = {.N = vec3(0.0f, 0.0f, 1.0f), .Ng = vec3(0.0f, 0.0f, 1.0f)};
    bundle_hit hit = ray_bundle_hit(&ray, &s, &flat);
    bundle_ray out;
    assert_false(ray_bundle_refract(&hit, flat.N, 1.5f, &out)); /* total reflection */
}

/* ---- sample numbers ---- */

/* 16 rays are one in each cell of every grid of 16 cells, for every bounce, in every pixel; so are those
 * of a square of pixels, in finer grids. */
static void rays_are_spread_evenly(void **state)
{
    (void)state;
    for (uint32_t bounce = 0; bounce < 4; bounce++)
        for (uint32_t block = 1; block <= 4; block *= 2) { /* pixels along an edge */
            uint32_t log_n = 4 + (block == 1 ? 0 : block == 2 ? 2 : 4);
            uint32_t n = 1u << log_n;
            for (uint32_t a = 0; a <= log_n; a++) {
                unsigned char cells[256] = {0};
                for (uint32_t p = 0; p < block * block; p++)
                    for (uint32_t i = 0; i < 16; i++) {
                        uint32_t place = ray_samples_place(40 + p % block, 72 + p / block);
                        vec2 u = ray_samples_at(place * 16 + i, bounce);
                        assert_true(u[0] >= 0.0f && u[0] < 1.0f && u[1] >= 0.0f && u[1] < 1.0f);
                        uint32_t column = (uint32_t)(u[0] * (float)(1u << a));
                        uint32_t row = (uint32_t)(u[1] * (float)(1u << (log_n - a)));
                        cells[column * (1u << (log_n - a)) + row]++;
                    }
                for (uint32_t c = 0; c < n; c++)
                    assert_int_equal(cells[c], 1);
            }
        }
}

static void every_pixel_has_its_place(void **state)
{
    (void)state;
    static bool taken[64 * 64];
    uint32_t first = ray_samples_place(128, 64) / (64 * 64);
    for (uint32_t i = 0; i < 64 * 64; i++) {
        uint32_t place = ray_samples_place(128 + i % 64, 64 + i / 64);
        assert_int_equal(place / (64 * 64), first);
        assert_false(taken[place % (64 * 64)]);
        taken[place % (64 * 64)] = true;
    }
}

/* Random numbers at one surface are independent of those at the next: their products average to a quarter. */
static void bounces_are_independent(void **state)
{
    (void)state;
    double sums[2] = {0.0, 0.0};
    for (uint32_t i = 0; i < 1 << 14; i++) {
        vec2 a = ray_samples_at(i, 1);
        vec2 b = ray_samples_at(i, 2);
        sums[0] += (double)(a[0] * b[0]);
        sums[1] += (double)(a[1] * b[0]);
    }
    assert_true(fabs(sums[0] / (1 << 14) - 0.25) < 5e-3 && fabs(sums[1] / (1 << 14) - 0.25) < 5e-3);
}

/* ---- media ---- */

static void media_are_left_in_any_order(void **state)
{
    (void)state;
    scene_material m[MEDIA_DEPTH + 2];
    media in = {0};
    assert_null(media_here(&in));
    media_leave(&in, &m[0]); /* a volume that was not entered */
    assert_null(media_here(&in));
    media_enter(&in, &m[0], 1.0f);
    media_enter(&in, &m[1], 1.0f);
    assert_ptr_equal(media_here(&in), &m[1]);
    media_leave(&in, &m[0]); /* the glass before the liquid that reaches into it */
    assert_ptr_equal(media_here(&in), &m[1]);
    media_enter(&in, &m[1], 1.0f);
    media_leave(&in, &m[1]); /* two volumes of one material */
    assert_ptr_equal(media_here(&in), &m[1]);
    media_leave(&in, &m[1]);
    assert_null(media_here(&in));
    for (int i = 0; i < MEDIA_DEPTH + 2; i++)
        media_enter(&in, &m[i], 1.0f);
    for (int i = MEDIA_DEPTH + 1; i >= 2; i--) {
        assert_ptr_equal(media_here(&in), &m[i]);
        media_leave(&in, &m[i]);
    }
    assert_null(media_here(&in)); /* the outermost were forgotten */
}

/* ---- diffuse transmission ---- */

/* Red of a quad that transmits diffusely: 0 a thin wall; 1 a volume without far side; 2 with one 0.2 m behind.
 * intensity: cd, of a point light behind it. */
static float leaf_red(int kind, bool has_environment, float intensity)
{
    fixture f = fixture_create();
    if (!has_environment)
        fixture_remove_environment(&f);
    scene_light light = {.name = "", .type = SCENE_LIGHT_POINT, .color = {1, 1, 1}, .intensity = intensity};
    fixture_add_light(&f, light, 0.0f, 0.0f, -3.0f);
    scene_material m = scene_material_default();
    m.metallic = 0.0f;
    m.specular = 0.0f;
    m.extensions = SCENE_DIFFUSE_TRANSMISSION | (kind ? SCENE_VOLUME : 0u);
    m.base_color[0] = 0.5f;
    m.diffuse_transmission = 0.25f;
    m.diffuse_transmission_color[0] = 0.8f;
    m.thickness = 0.3f;
    m.attenuation_distance = 0.1f;
    m.attenuation_color[0] = 0.7f;
    uint32_t mesh = fixture_add_quad(&f, fixture_add_material(&f, m));
    fixture_place(&f, mesh, 0, 0, 0, 1.0f);
    if (kind == 2) {
        scene_node *far = fixture_place(&f, mesh, 0, 0, -0.2f, 1.0f);
        far->rotation[1] = 1.0f;
        far->rotation[3] = 0.0f;
    }
    film rendered = fixture_render(&f);
    float red = fixture_pixel(&rendered, "", 20, 40)[0];
    film_destroy(&rendered);
    fixture_destroy(&f);
    return red;
}

/* With a far side the real thickness counts, otherwise that of the material. */
static float leaf_transmittance(int kind)
{
    return kind ? powf(0.7f, (kind == 2 ? 0.2f : 0.3f) / 0.1f) : 1.0f;
}

static void light_comes_through_leaves(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        float expected = 0.5f * 0.75f + 0.8f * 0.25f * leaf_transmittance(kind);
        assert_true(fabsf(leaf_red(kind, true, 0.0f) - expected) < 1e-3f);
    }
}

static void punctual_light_is_absorbed_like_an_environment(void **state)
{
    (void)state;
    for (int has_environment = 0; has_environment < 2; has_environment++) {
        float through_wall = leaf_red(0, has_environment, 90.0f) - leaf_red(0, has_environment, 0.0f);
        assert_true(through_wall > 0.1f);
        for (int kind = 1; kind < 3; kind++) {
            float red = leaf_red(kind, has_environment, 90.0f) - leaf_red(kind, has_environment, 0.0f);
            assert_true(fabsf(red / through_wall - leaf_transmittance(kind)) < 1e-4f);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normals_of_a_ball_stay),
        cmocka_unit_test(normals_towards_a_rim_do_not_lean),
        cmocka_unit_test(flat_normals_stay),
        cmocka_unit_test(bundles_follow_their_neighbours),
        cmocka_unit_test(rays_are_spread_evenly),
        cmocka_unit_test(every_pixel_has_its_place),
        cmocka_unit_test(bounces_are_independent),
        cmocka_unit_test(media_are_left_in_any_order),
        cmocka_unit_test(light_comes_through_leaves),
        cmocka_unit_test(punctual_light_is_absorbed_like_an_environment),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
