/* gl_transparency_test.c - blended surfaces in the three modes: layers with a known result in any order of
 * the scene, and what only peeling solves, against the preview. Exits with 77 where there is no OpenGL. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "gl/scene/gl_camera.h"
#include "gl/scene/gl_fixture_test.h"
#include "gl/scene/gl_sort.h"
#include "gl/scene/gl_transparency.h"

static gl_fixture_contexts contexts;

/* Layers of the test quads, the nearest first. */
enum { LAYERS = 5 };
static const float layers[LAYERS][4] = {{0.9f, 0.1f, 0.2f, 0.3f},
                                        {0.2f, 0.8f, 0.1f, 0.5f},
                                        {0.1f, 0.3f, 0.9f, 0.25f},
                                        {0.7f, 0.7f, 0.1f, 0.6f},
                                        {0.3f, 0.9f, 0.9f, 0.4f}};

static const facet_transparency modes[] = {FACET_TRANSPARENCY_SORTED, FACET_TRANSPARENCY_PEELED,
                                           FACET_TRANSPARENCY_WEIGHTED};

/* The over operator: Porter and Duff 1984. */
static void blend(const float (*list)[4], int count, float out[4])
{
    float passes = 1.0f;
    memset(out, 0, 4 * sizeof *out);
    for (int i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++)
            out[c] += passes * list[i][3] * list[i][c];
        passes *= 1.0f - list[i][3];
    }
    out[3] = 1.0f - passes;
}

/* A white texture, which comes with a sampler of its own. */
static uint32_t add_white(fixture *f)
{
    unsigned char white[4 * 4 * 4];
    memset(white, 255, sizeof white);
    return fixture_add_texture(f, 4, 4, white);
}

/* Quads from z = 0 back, submitted in the order of the permutation. */
static fixture layered_fixture(const int *permutation, int count)
{
    fixture f = fixture_create();
    uint32_t texture = add_white(&f);
    for (int i = 0; i < count; i++) {
        int k = permutation[i];
        scene_material m = gl_fixture_unlit(layers[k][0], layers[k][1], layers[k][2], layers[k][3]);
        m.textures[SCENE_BASE_COLOR_TEXTURE].texture = texture;
        uint32_t material = fixture_add_material(&f, m);
        fixture_place(&f, fixture_add_quad(&f, material), 0.0f, 0.0f, -0.25f * (float)k, 2.0f);
    }
    return f;
}

static const int permutations[][LAYERS] = {
    {0, 1, 2, 3, 4}, {4, 3, 2, 1, 0}, {2, 4, 0, 3, 1}, {3, 0, 4, 1, 2}};

static void sorted_layers_blend_in_any_scene_order(void **state)
{
    (void)state;
    float wanted[4];
    blend(layers, LAYERS, wanted);
    for (int c = 0; c < contexts.count; c++)
        for (int m = 0; m < 2; m++)
            for (int p = 0; p < (c == 0 ? 4 : 2); p++) {
                fixture f = layered_fixture(permutations[p], LAYERS);
                f.desc.gl.transparency = modes[m];
                film image = gl_fixture_render(&f, &contexts.items[c]);
                for (uint32_t i = 0; i < 64; i += 9)
                    gl_fixture_assert_pixel(&image, i, 63 - i, wanted, 2e-3f);
                film_destroy(&image);
                fixture_destroy(&f);
            }
}

static void weighted_blending_ignores_order(void **state)
{
    (void)state;
    float wanted[4];
    blend(layers, LAYERS, wanted);
    for (int c = 0; c < contexts.count; c++) {
        film first = {0};
        for (int p = 0; p < (c == 0 ? 4 : 2); p++) {
            fixture f = layered_fixture(permutations[p], LAYERS);
            f.desc.gl.transparency = FACET_TRANSPARENCY_WEIGHTED;
            film image = gl_fixture_render(&f, &contexts.items[c]);
            const float *pixel = fixture_pixel(&image, "", 20, 30);
            assert_true(fabsf(pixel[3] - wanted[3]) < 2e-3f); /* transmittance is exact */
            if (p == 0) {
                first = image;
            } else {
                image_difference d = gl_fixture_compare(&first, &image, 2e-3f);
                assert_true(d.share <= 0.0);
                film_destroy(&image);
            }
            fixture_destroy(&f);
        }
        film_destroy(&first);
    }
}

/* A single layer is its own mean. */
static void a_single_layer_is_exact(void **state)
{
    (void)state;
    float wanted[4];
    blend(&layers[1], 1, wanted);
    static const int only[1] = {1};
    for (int c = 0; c < contexts.count; c++)
        for (int m = 0; m < 3; m++) {
            fixture f = layered_fixture(only, 1);
            f.desc.gl.transparency = modes[m];
            film image = gl_fixture_render(&f, &contexts.items[c]);
            gl_fixture_assert_pixel(&image, 32, 32, wanted, 1e-3f);
            film_destroy(&image);
            fixture_destroy(&f);
        }
}

/* Opaque surfaces hide what is behind them and show through what is in front. */
static void opaque_surfaces_occlude_and_show_through(void **state)
{
    (void)state;
    const float list[3][4] = {{0.9f, 0.1f, 0.2f, 0.3f}, {0.2f, 0.8f, 0.1f, 0.5f}, {0.25f, 0.5f, 0.75f, 1.0f}};
    float wanted[4];
    blend(list, 3, wanted);
    for (int c = 0; c < contexts.count; c++)
        for (int m = 0; m < 2; m++) {
            fixture f = layered_fixture(permutations[2], LAYERS); /* the first two are in front of it */
            uint32_t wall = fixture_add_material(&f, gl_fixture_unlit(0.25f, 0.5f, 0.75f, 1.0f));
            fixture_place(&f, fixture_add_quad(&f, wall), 0.0f, 0.0f, -0.3f, 2.0f);
            f.desc.gl.transparency = modes[m];
            film image = gl_fixture_render(&f, &contexts.items[c]);
            gl_fixture_assert_pixel(&image, 32, 32, wanted, 2e-3f);
            film_destroy(&image);
            fixture_destroy(&f);
        }
}

/* Two meshes with interleaved triangles: neither is entirely in front. */
static void interleaved_triangles_of_meshes_are_sorted(void **state)
{
    (void)state;
    const float list[4][4] = {{1.0f, 0.0f, 0.0f, 0.5f},
                              {0.0f, 1.0f, 0.0f, 0.5f},
                              {1.0f, 0.0f, 0.0f, 0.5f},
                              {0.0f, 1.0f, 0.0f, 0.5f}};
    float wanted[4];
    blend(list, 4, wanted);
    for (int c = 0; c < contexts.count; c++) {
        fixture f = fixture_create();
        uint32_t red = fixture_add_material(&f, gl_fixture_unlit(1.0f, 0.0f, 0.0f, 0.5f));
        uint32_t green = fixture_add_material(&f, gl_fixture_unlit(0.0f, 1.0f, 0.0f, 0.5f));
        uint32_t red_mesh = fixture_add_quad(&f, red), green_mesh = fixture_add_quad(&f, green);
        fixture_place(&f, green_mesh, 0.0f, 0.0f, -0.9f, 2.0f); /* two instances of each batch */
        fixture_place(&f, red_mesh, 0.0f, 0.0f, 0.0f, 2.0f);
        fixture_place(&f, red_mesh, 0.0f, 0.0f, -0.6f, 2.0f);
        fixture_place(&f, green_mesh, 0.0f, 0.0f, -0.3f, 2.0f);
        film image = gl_fixture_render(&f, &contexts.items[c]);
        gl_fixture_assert_pixel(&image, 40, 20, wanted, 2e-3f);
        film_destroy(&image);
        fixture_destroy(&f);
    }
}

/* Two intersecting quads: the preview orders each sample, peeling each pixel. */
static fixture crossed_fixture(void)
{
    fixture f = fixture_create();
    for (int i = 0; i < 2; i++) {
        scene_material m = gl_fixture_unlit(i ? 1.0f : 0.0f, 0.2f, i ? 0.0f : 1.0f, 0.6f);
        m.is_double_sided = true;
        scene_node *node =
            fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, m)), 0.0f, 0.0f, 0.0f, 0.9f);
        gl_fixture_turn(node, 0.0f, i ? sinf(0.4f) : -sinf(0.4f), 0.0f, cosf(0.4f));
    }
    return f;
}

static void crossed_surfaces_are_peeled(void **state)
{
    (void)state;
    fixture f = crossed_fixture();
    film preview = fixture_render(&f);
    for (int c = 0; c < contexts.count; c++) {
        f.desc.gl.transparency = FACET_TRANSPARENCY_PEELED;
        film peeled = gl_fixture_render(&f, &contexts.items[c]);
        f.desc.gl.transparency = FACET_TRANSPARENCY_SORTED;
        film sorted = gl_fixture_render(&f, &contexts.items[c]);
        image_difference d = gl_fixture_compare(&peeled, &preview, 4.0f / 255.0f);
        image_difference sorted_d = gl_fixture_compare(&sorted, &preview, 4.0f / 255.0f);
        assert_true(d.share < 0.05);        /* edges: other samples */
        assert_true(sorted_d.share > 0.25); /* sorting gets half of it wrong: the test can fail */
        film_destroy(&peeled);
        film_destroy(&sorted);
    }
    film_destroy(&preview);
    fixture_destroy(&f);
}

/* More layers than are peeled: the farthest are missing, which costs at most what the others transmit. */
static void layers_beyond_the_limit_cost_their_transmittance(void **state)
{
    (void)state;
    enum { MANY = 12 };
    fixture f = fixture_create();
    uint32_t material = fixture_add_material(&f, gl_fixture_unlit(1.0f, 1.0f, 1.0f, 0.5f));
    uint32_t quad = fixture_add_quad(&f, material);
    for (int i = 0; i < MANY; i++)
        fixture_place(&f, quad, 0.0f, 0.0f, -0.1f * (float)i, 2.0f);
    f.desc.gl.transparency = FACET_TRANSPARENCY_PEELED;
    film image = gl_fixture_render(&f, &contexts.items[0]);
    float passes = powf(0.5f, GL_TRANSPARENCY_LAYERS),
          wanted[4] = {1.0f - passes, 1.0f - passes, 1.0f - passes, 1.0f - passes};
    gl_fixture_assert_pixel(&image, 32, 32, wanted, 1e-3f);
    film_destroy(&image);
    fixture_destroy(&f);
}

/* A sphere's own triangles overlap. */
static void blended_spheres_match_the_preview(void **state)
{
    (void)state;
    fixture f = fixture_create();
    scene_material m = gl_fixture_unlit(0.2f, 0.6f, 0.9f, 0.4f);
    m.is_double_sided = true;
    uint32_t sphere = fixture_add_sphere(&f, 32, fixture_add_material(&f, m));
    fixture_place(&f, sphere, -0.3f, 0.1f, 0.0f, 0.5f);
    fixture_place(&f, sphere, 0.3f, -0.1f, -1.2f, 0.5f);
    film preview = fixture_render(&f);
    for (int c = 0; c < contexts.count; c++)
        for (int mode = 0; mode < 2; mode++) {
            f.desc.gl.transparency = modes[mode];
            film image = gl_fixture_render(&f, &contexts.items[c]);
            image_difference d = gl_fixture_compare(&image, &preview, 4.0f / 255.0f);
            assert_true(d.mean < 1.0 / 255.0);
            assert_true(d.share < 0.06);
            film_destroy(&image);
        }
    film_destroy(&preview);
    fixture_destroy(&f);
}

/* Points and lines are blended as in the preview. */
static void blended_sprites_match_the_preview(void **state)
{
    (void)state;
    fixture f = fixture_create();
    f.camera = (facet_camera){.eye = {0.0f, 0.0f, 10.0f}, .ortho_height = 0.1f}; /* a pixel is 1/640 */
    f.desc.width = f.desc.height = 16;
    float positions[8 * 3];
    for (int i = 0; i < 8; i++) { /* behind each other, in no order */
        positions[3 * i] = 0.0f;
        positions[3 * i + 1] = 0.0f;
        positions[3 * i + 2] = -0.1f * (float)(i * 5 % 8);
    }
    uint32_t mesh = fixture_add_sprites(&f, SCENE_POINTS, positions, 8,
                                        fixture_add_material(&f, gl_fixture_unlit(1.0f, 1.0f, 1.0f, 0.5f)));
    float colors[8 * 4];
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 4; k++)
            colors[4 * i + k] = k == 3 ? 1.0f : k == i % 3 ? 1.0f : 0.1f * (float)i;
    fixture_primitive(&f, mesh)->colors = colors;
    fixture_place(&f, mesh, 0.003f, 0.003f, 0.0f, 1.0f);
    film preview = fixture_render(&f);
    for (int c = 0; c < contexts.count; c++) {
        film image = gl_fixture_render(&f, &contexts.items[c]);
        double sums[2][4] = {{0.0}};
        for (size_t i = 0; i < 4 * 16 * 16; i++) {
            sums[0][i % 4] += (double)preview.layers[0].pixels[i];
            sums[1][i % 4] += (double)image.layers[0].pixels[i];
        }
        assert_true(sums[0][3] > 1.0);
        for (int k = 0; k < 4; k++) /* samples may differ, colors may not */
            assert_true(fabs(sums[0][k] / sums[0][3] - sums[1][k] / sums[1][3]) < 2e-3);
        film_destroy(&image);
    }
    film_destroy(&preview);
    fixture_destroy(&f);
}

/* An oblique alpha edge is as smooth as a triangle's, and what remains is opaque. */
static void mask_edges_are_antialiased(void **state)
{
    (void)state;
    static const float colors[16] = {0.2f, 0.5f, 0.9f, 0.1f,  0.2f, 0.5f, 0.9f, 0.6f,
                                     0.2f, 0.5f, 0.9f, 0.45f, 0.2f, 0.5f, 0.9f, 0.95f};
    fixture f = fixture_create();
    scene_material m = gl_fixture_unlit(1.0f, 1.0f, 1.0f, 1.0f);
    m.alpha_mode = SCENE_ALPHA_MASK;
    m.alpha_cutoff = 0.5f;
    uint32_t quad = fixture_add_quad(&f, fixture_add_material(&f, m));
    fixture_primitive(&f, quad)->colors = colors;
    fixture_place(&f, quad, 0.0f, 0.0f, 0.0f, 2.0f);
    film preview = fixture_render(&f);
    for (int c = 0; c < contexts.count; c++) {
        film image = gl_fixture_render(&f, &contexts.items[c]);
        double partial = 0.0, sums[2] = {0.0, 0.0};
        for (size_t i = 0; i < 64 * 64; i++) {
            const float *p = image.layers[0].pixels + 4 * i;
            partial += p[3] > 0.0f && p[3] < 1.0f;
            sums[0] += (double)preview.layers[0].pixels[4 * i + 3];
            sums[1] += (double)p[3];
            assert_true(fabsf(p[2] - 0.9f * p[3]) < 1e-4f);
        }
        assert_true(fabs(sums[1] / sums[0] - 1.0) < 0.01);
        assert_true(gl_fixture_compare(&image, &preview, 0.51f).share < (partial > 0.0 ? 0.005 : 0.03));
        assert_true(partial > 40.0 || contexts.items[c].is_es); /* where alpha-to-coverage is available */
        film_destroy(&image);
    }
    film_destroy(&preview);
    fixture_destroy(&f);
}

/* ---- the order ---- */

typedef struct order_bench {
    gl_context *context;
    gl_scene scene;
    gl_mesh_set *meshes;
    gl_frame_block frame;
    gl_sort sort;
} order_bench;

static void order_of(fixture *f, order_bench *b)
{
    camera_rays camera;
    bool is_new;
    facet_render_desc desc = f->desc;
    memset(b, 0, sizeof *b);
    b->context = &contexts.items[0];
    assert_int_equal(gl_context_make_current(b->context, NULL), FACET_OK);
    gl_scene_init(&b->scene, f->scene, NULL);
    assert_int_equal(gl_scene_update(&b->scene, &desc, NULL), FACET_OK);
    assert_int_equal(gl_mesh_create(b->context, NULL, &b->meshes, NULL), FACET_OK);
    assert_int_equal(gl_mesh_update(b->meshes, &b->scene, NULL, NULL), FACET_OK);
    assert_int_equal(camera_rays_create(&f->camera, desc.width, desc.height, &camera, NULL), FACET_OK);
    const gl_view all = {.scale = 1, .width = desc.width, .height = desc.height};
    gl_camera_set(b->context, &camera, b->scene.pose.bounds_min, b->scene.pose.bounds_max, desc.width,
                  desc.height, &all, &b->frame);
    assert_int_equal(gl_sort_update(&b->sort, b->meshes, &b->scene, &b->frame, 2, &is_new, NULL), FACET_OK);
    assert_true(is_new);
    assert_int_equal(gl_sort_update(&b->sort, b->meshes, &b->scene, &b->frame, 2, &is_new, NULL), FACET_OK);
    assert_false(is_new);
}

static void close_order(order_bench *b)
{
    gl_sort_destroy(&b->sort);
    gl_mesh_destroy(b->meshes);
    gl_scene_clear(&b->scene);
    gl_context_release(b->context);
}

static float depth_of(const order_bench *b, uint32_t item)
{
    const float *p = b->sort.middles + 3 * (size_t)item;
    return (p[0] - b->frame.eye[0]) * b->frame.forward[0] + (p[1] - b->frame.eye[1]) * b->frame.forward[1] +
           (p[2] - b->frame.eye[2]) * b->frame.forward[2];
}

/* Each triangle once; within a unit the farthest first. */
static void assert_all_are_drawn(const order_bench *b)
{
    const gl_sort *s = &b->sort;
    uint32_t drawn[64] = {0};
    assert_true(s->unit_count <= 64);
    for (uint32_t i = 0; i < s->run_count; i++) {
        assert_int_equal(s->runs[i].first, drawn[s->runs[i].unit]);
        drawn[s->runs[i].unit] += s->runs[i].count;
    }
    for (uint32_t u = 0; u < s->unit_count; u++) {
        const gl_sort_unit *unit = &s->units[u];
        uint64_t sum = 0;
        assert_int_equal(drawn[u], unit->count);
        for (uint32_t i = 0; i < unit->count; i++) {
            sum += s->order[unit->first + i];
            if (i > 0)
                assert_true(depth_of(b, unit->first + s->order[unit->first + i - 1]) >=
                            depth_of(b, unit->first + s->order[unit->first + i]));
        }
        assert_int_equal(sum, (uint64_t)unit->count * (unit->count - 1) / 2);
    }
}

static fixture spheres_fixture(const float (*places)[3], int count, uint32_t columns)
{
    fixture f = fixture_create();
    uint32_t sphere =
        fixture_add_sphere(&f, columns, fixture_add_material(&f, gl_fixture_unlit(1.0f, 1.0f, 1.0f, 0.5f)));
    for (int i = 0; i < count; i++)
        fixture_place(&f, sphere, places[i][0], places[i][1], places[i][2], 0.3f);
    return f;
}

static void separate_instances_are_not_interleaved(void **state)
{
    (void)state;
    static const float beside[3][3] = {{-0.6f, 0.0f, 0.0f}, {0.6f, 0.0f, 0.0f}, {-0.6f, 0.1f, -2.0f}};
    fixture f = spheres_fixture(beside, 3, 16);
    order_bench b;
    order_of(&f, &b);
    assert_int_equal(b.sort.unit_count, 3);
    assert_int_equal(b.sort.run_count, 3);
    assert_all_are_drawn(&b);
    assert_true(b.sort.units[b.sort.runs[0].unit].box[0][2] < -1.0f); /* the one behind comes first */
    close_order(&b);
    fixture_destroy(&f);
}

static void overlapping_instances_are_interleaved(void **state)
{
    (void)state;
    static const float inside[2][3] = {{0.0f, 0.0f, 0.0f}, {0.1f, 0.0f, 0.05f}};
    fixture f = spheres_fixture(inside, 2, 16);
    order_bench b;
    order_of(&f, &b);
    assert_true(b.sort.run_count > 20);
    assert_all_are_drawn(&b);
    float last = INFINITY;
    uint32_t at[2] = {0, 0};
    for (uint32_t i = 0; i < b.sort.run_count; i++)
        for (uint32_t k = 0; k < b.sort.runs[i].count; k++) {
            const gl_sort_unit *unit = &b.sort.units[b.sort.runs[i].unit];
            float depth = depth_of(&b, unit->first + b.sort.order[unit->first + at[b.sort.runs[i].unit]++]);
            assert_true(depth <= last);
            last = depth;
        }
    close_order(&b);
    fixture_destroy(&f);
}

/* 2 x 16384 triangles that would change the batch at nearly each of them. */
static void slices_limit_the_number_of_calls(void **state)
{
    (void)state;
    static const float inside[2][3] = {{0.0f, 0.0f, 0.0f}, {0.1f, 0.0f, 0.001f}};
    fixture f = spheres_fixture(inside, 2, 128);
    order_bench b;
    order_of(&f, &b);
    assert_true(b.sort.run_count <= 4100);
    assert_all_are_drawn(&b);
    float slice = 0.7f / 1000.0f, last = INFINITY; /* of a depth of 0.6 */
    uint32_t at[2] = {0, 0};
    for (uint32_t i = 0; i < b.sort.run_count; i++)
        for (uint32_t k = 0; k < b.sort.runs[i].count; k++) {
            const gl_sort_unit *unit = &b.sort.units[b.sort.runs[i].unit];
            float depth = depth_of(&b, unit->first + b.sort.order[unit->first + at[b.sort.runs[i].unit]++]);
            assert_true(depth <= last + slice);
            last = fminf(last, depth);
        }
    close_order(&b);
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sorted_layers_blend_in_any_scene_order),
        cmocka_unit_test(weighted_blending_ignores_order),
        cmocka_unit_test(a_single_layer_is_exact),
        cmocka_unit_test(opaque_surfaces_occlude_and_show_through),
        cmocka_unit_test(interleaved_triangles_of_meshes_are_sorted),
        cmocka_unit_test(crossed_surfaces_are_peeled),
        cmocka_unit_test(layers_beyond_the_limit_cost_their_transmittance),
        cmocka_unit_test(blended_spheres_match_the_preview),
        cmocka_unit_test(blended_sprites_match_the_preview),
        cmocka_unit_test(mask_edges_are_antialiased),
        cmocka_unit_test(separate_instances_are_not_interleaved),
        cmocka_unit_test(overlapping_instances_are_interleaved),
        cmocka_unit_test(slices_limit_the_number_of_calls),
    };
    if (!gl_fixture_open(&contexts))
        return 77;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    gl_fixture_close(&contexts);
    return failed;
}
