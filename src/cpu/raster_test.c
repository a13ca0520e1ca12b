/* Tests of raster.h: its hits are those of rays. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "cpu/preview_fixture.h"
#include "cpu/raster.h"

enum { SIZE = 77 };

/* A scene as the raster and rays see it. */
typedef struct setup {
    fixture f;
    facet_allocator allocator;
    scene_pose pose;
    camera_rays camera;
    render_geometry_set set;
    ray_scene rays;
} setup;

/* Seen from (0, 0, 4) by a lens of 60 degrees. */
static setup setup_create(void)
{
    setup s = {.f = fixture_create()};
    s.f.camera.fov_y_rad = 1.0471976f;
    s.f.camera.eye[2] = 4.0f;
    return s;
}

static uint32_t add_material(setup *s, bool is_double_sided)
{
    scene_material material = scene_material_default();
    material.is_double_sided = is_double_sided;
    return fixture_add_material(&s->f, material);
}

static void prepare(setup *s)
{
    assert_int_equal(scene_pose_create(s->f.scene, NULL, &s->allocator, 1, &s->pose, NULL), FACET_OK);
    assert_int_equal(camera_rays_create(&s->f.camera, SIZE, SIZE, &s->camera, NULL), FACET_OK);
    assert_int_equal(render_geometry_create(s->f.scene, &s->pose, &s->allocator, &s->set, NULL), FACET_OK);
    assert_int_equal(render_geometry_transform(&s->set, &s->pose, &s->camera, &s->allocator, 1, NULL),
                     FACET_OK);
    const ray_scene_desc desc = {.ray_count = SIZE * SIZE * 4, .thread_count = 1};
    assert_int_equal(ray_tracer_choose(FACET_BVH_AUTO, &s->rays.tracer, NULL), FACET_OK);
    assert_int_equal(s->rays.tracer->create(&s->set, &desc, &s->allocator, &s->rays.bvh, NULL), FACET_OK);
}

static void setup_destroy(setup *s)
{
    ray_scene_destroy(&s->rays);
    render_geometry_destroy(&s->set);
    scene_pose_destroy(&s->pose);
    fixture_destroy(&s->f);
}

static raster *create_raster(setup *s, uint32_t sample_count, uint32_t thread_count)
{
    raster *r;
    const raster_desc desc = {.geometries = &s->set,
                              .camera = &s->camera,
                              .width = SIZE,
                              .height = SIZE,
                              .sample_count = sample_count,
                              .thread_count = thread_count};
    assert_int_equal(raster_create(&desc, &s->allocator, &r, NULL), FACET_OK);
    return r;
}

/* Hits of both, and how they differ. */
typedef struct comparison {
    uint32_t ray_count, hit_count, other_count; /* other: another triangle, or only one of both hits */
    float largest;                              /* relative difference of t, absolute one of weights */
} comparison;

static void compare_hits(const visibility_hit *a, const visibility_hit *b, comparison *c)
{
    c->ray_count++;
    c->hit_count += b->geometry != VISIBILITY_NONE;
    if (a->geometry != b->geometry || (a->geometry != VISIBILITY_NONE && a->primitive != b->primitive)) {
        c->other_count++;
        return;
    }
    if (a->geometry == VISIBILITY_NONE)
        return;
    c->largest = fmaxf(c->largest, fabsf(a->t - b->t) / b->t);
    c->largest = fmaxf(c->largest, fmaxf(fabsf(a->u - b->u), fabsf(a->v - b->v)));
    assert_memory_equal(a->normal, b->normal, sizeof a->normal);
}

/* raster_tile_read_one() against the hits of the pixels of a block. */
static void check_pixels(const raster_tile *tile, uint32_t block, uint32_t count, const visibility_hit *hits)
{
    for (uint32_t first = 0; first < VISIBILITY_BLOCK_PIXELS * count; first += count) {
        const visibility_hit *a = &hits[first];
        visibility_hit one;
        float t = 0.0f;
        bool is_one = true;
        for (uint32_t k = 0; k < count; k++) {
            t += a[k].geometry == VISIBILITY_NONE ? 0.0f : a[k].t;
            is_one = is_one && a[k].geometry == a->geometry &&
                     (a->geometry == VISIBILITY_NONE || a[k].primitive == a->primitive);
        }
        assert_int_equal(raster_tile_read_one(tile, block, first, count, &one), is_one);
        if (!is_one)
            continue;
        assert_int_equal(one.geometry, a->geometry);
        if (a->geometry == VISIBILITY_NONE)
            continue;
        assert_int_equal(one.primitive, a->primitive);
        assert_true(one.t == t / (float)count);
    }
}

static comparison compare_image(setup *s, const raster *r, uint32_t sample_count)
{
    enum { MOST = VISIBILITY_BLOCK_PIXELS * 16 };
    comparison c = {0};
    visibility_pattern pattern;
    visibility_hit traced[MOST], rastered[MOST];
    assert_true(visibility_pattern_create(&s->allocator, sample_count, &pattern));
    for (uint32_t y = 0; y < SIZE; y += RASTER_TILE)
        for (uint32_t x = 0; x < SIZE; x += RASTER_TILE) {
            raster_tile *tile = raster_tile_create(r, &pattern, x, y, &s->allocator);
            assert_non_null(tile);
            for (uint32_t i = 0; i < RASTER_TILE_BLOCKS * RASTER_TILE_BLOCKS; i++) {
                const uint32_t bx = x + i % RASTER_TILE_BLOCKS * VISIBILITY_BLOCK;
                const uint32_t by = y + i / RASTER_TILE_BLOCKS * VISIBILITY_BLOCK;
                if (bx + VISIBILITY_BLOCK > SIZE || by + VISIBILITY_BLOCK > SIZE)
                    continue;
                raster_tile_read(tile, i, rastered);
                check_pixels(tile, i, sample_count, rastered);
                visibility_trace_block(&s->rays, &s->camera, bx, by, &pattern, traced);
                for (uint32_t k = 0; k < VISIBILITY_BLOCK_PIXELS * sample_count; k++)
                    compare_hits(&rastered[k], &traced[k], &c);
            }
            raster_tile_destroy(tile);
        }
    visibility_pattern_destroy(&pattern);
    return c;
}

/* Rounding of reciprocals: Embree's are not divisions. */
static void assert_same(const comparison *c)
{
    assert_true(c->hit_count > c->ray_count / 8);
    assert_true(c->largest < 2e-6f);
}

static void hits_are_those_of_rays(void **state)
{
    static const uint32_t sample_counts[] = {2, 4, 5, 16};
    (void)state;
    setup s = setup_create();
    uint32_t material = add_material(&s, true);
    uint32_t sphere = fixture_add_sphere(&s.f, 16, material), quad = fixture_add_quad(&s.f, material);
    uint32_t coarse = fixture_add_sphere(&s.f, 4, material);
    fixture_place(&s.f, sphere, 0.3f, 0.1f, 0.0f, 1.0f);
    fixture_place(&s.f, sphere, -0.8f, -0.4f, -1.0f, 0.7f);
    fixture_place(&s.f, quad, 0.0f, 0.9f, -0.5f, 8.0f);   /* larger than the image */
    fixture_place(&s.f, coarse, 0.0f, -9.0f, 9.0f, 9.5f); /* some corners are behind the camera */
    fixture_place(&s.f, quad, 0.0f, 0.0f, 30.0f, 9.0f);   /* behind the camera */
    prepare(&s);
    for (size_t i = 0; i < sizeof sample_counts / sizeof *sample_counts; i++) {
        raster *r = create_raster(&s, sample_counts[i], 1);
        assert_non_null(r);
        comparison c = compare_image(&s, r, sample_counts[i]);
        assert_same(&c);
        assert_true(c.other_count * 1000 <= c.ray_count); /* at common edges either triangle is right */
        raster_destroy(r);
    }
    setup_destroy(&s);
}

static void a_single_side_lets_rays_pass_the_other(void **state)
{
    (void)state;
    setup s = setup_create();
    uint32_t quad = fixture_add_quad(&s.f, add_material(&s, false));
    fixture_place(&s.f, quad, 0.0f, 0.0f, -1.0f, 2.0f);
    scene_node *turned = fixture_place(&s.f, quad, 0.0f, 0.0f, 1.0f, 1.0f); /* in front, shows its back */
    turned->rotation[1] = 1.0f;
    turned->rotation[3] = 0.0f;
    scene_node *mirrored = fixture_place(&s.f, quad, 0.0f, 0.0f, 2.0f, 0.2f); /* shows its front */
    mirrored->scale[0] = -0.2f;
    prepare(&s);
    raster *r = create_raster(&s, 1, 1);
    visibility_pattern pattern;
    assert_true(visibility_pattern_create(&s.allocator, 1, &pattern));
    raster_tile *tile = raster_tile_create(r, &pattern, RASTER_TILE, RASTER_TILE, &s.allocator);
    visibility_hit hits[VISIBILITY_BLOCK_PIXELS];
    raster_tile_read(tile, RASTER_TILE_BLOCKS + 1, hits); /* the pixels around (38, 38), the middle */
    assert_int_equal(hits[0].geometry, 2);
    raster_tile_read(tile, 4 * RASTER_TILE_BLOCKS + 1, hits); /* below the small one */
    assert_int_equal(hits[0].geometry, 0);
    raster_tile_destroy(tile);
    visibility_pattern_destroy(&pattern);
    raster_destroy(r);
    setup_destroy(&s);
}

/* Of coincident surfaces the first is hit, whatever the number of threads. */
static void the_first_of_coincident_surfaces_is_hit(void **state)
{
    (void)state;
    setup s = setup_create();
    uint32_t sphere = fixture_add_sphere(&s.f, 96, add_material(&s, true));
    for (int i = 0; i < 3; i++)
        fixture_place(&s.f, sphere, 0.0f, 0.0f, 0.0f, 1.5f);
    prepare(&s);
    for (uint32_t threads = 1; threads <= 4; threads++) {
        raster *r = create_raster(&s, 16, threads);
        assert_non_null(r);
        visibility_pattern pattern;
        assert_true(visibility_pattern_create(&s.allocator, 16, &pattern));
        raster_tile *tile = raster_tile_create(r, &pattern, RASTER_TILE, RASTER_TILE, &s.allocator);
        visibility_hit hits[VISIBILITY_BLOCK_PIXELS * 16];
        raster_tile_read(tile, 0, hits);
        for (size_t i = 0; i < sizeof hits / sizeof *hits; i++)
            assert_int_equal(hits[i].geometry, 0);
        raster_tile_destroy(tile);
        visibility_pattern_destroy(&pattern);
        raster_destroy(r);
    }
    setup_destroy(&s);
}

/* Rays are traced where they are cheaper, and where triangles in perspective are not all there is. */
static void others_are_traced(void **state)
{
    static const float points[6] = {0.0f, 0.0f, 0.0f, 0.5f, 0.0f, 0.0f};
    (void)state;
    for (int i = 0; i < 3; i++) {
        setup s = setup_create();
        uint32_t material = add_material(&s, true);
        uint32_t sphere = fixture_add_sphere(&s.f, i == 2 ? 600 : 8, material);
        fixture_place(&s.f, sphere, 0, 0, 0, 1.0f);
        if (i == 0)
            s.f.camera.fov_y_rad = 0.0f;
        if (i == 1)
            fixture_place(&s.f, fixture_add_sprites(&s.f, SCENE_POINTS, points, 2, material), 0, 0, 0, 1.0f);
        prepare(&s);
        raster *r;
        const raster_desc desc = {.geometries = &s.set,
                                  .camera = &s.camera,
                                  .width = SIZE,
                                  .height = SIZE,
                                  .sample_count = 1,
                                  .thread_count = 1,
                                  .needs_hierarchy = true};
        assert_int_equal(raster_create(&desc, &s.allocator, &r, NULL), FACET_OK);
        assert_null(r);
        setup_destroy(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hits_are_those_of_rays), cmocka_unit_test(a_single_side_lets_rays_pass_the_other),
        cmocka_unit_test(the_first_of_coincident_surfaces_is_hit), cmocka_unit_test(others_are_traced)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
