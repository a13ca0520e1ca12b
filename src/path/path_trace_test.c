/* Tests of single paths: transmission, termination, features. Images of known light are in *_truth_test.c. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "cpu/preview_fixture.h"
#include "cpu/ray_trace.h"

#include "path/path.h"

/* ---- a scene that paths go through ---- */

typedef struct stage {
    fixture f;
    facet_render_desc desc;
    facet_render_stats stats;
    prepared_scene prepared;
    render_setup setup;
    path_lights *lights;
    path_scene scene;
} stage;

/* Nothing emits; glTF's energy, box filter, 8 x 8 pixels. */
static void stage_begin(stage *s)
{
    memset(s, 0, sizeof *s);
    s->f = fixture_create();
    facet_environment_destroy(s->f.environment);
    s->f.environment = NULL;
    s->f.desc = (facet_render_desc){.width = 8,
                                    .height = 8,
                                    .samples = 16,
                                    .thread_count = 1,
                                    .renderer = FACET_RENDERER_KIND_PATH,
                                    .path = {.filter = FACET_FILTER_BOX, .max_depth = 64}};
    s->f.camera = (facet_camera){.eye = {0.0f, 0.0f, 0.5f}, .ortho_height = 0.01f};
}

/* The scene is complete. */
static void stage_prepare(stage *s)
{
    s->desc = s->f.desc;
    s->desc.camera = &s->f.camera;
    s->desc.environment = s->f.environment;
    s->desc.crop[2] = s->desc.width;
    s->desc.crop[3] = s->desc.height;
    prepared_scene_init(&s->prepared, s->f.scene, &s->desc.allocator);
    s->setup = (render_setup){.prepared = &s->prepared,
                              .desc = &s->desc,
                              .stats = &s->stats,
                              .reads_everywhere = true,
                              .samples_light = true};
    assert_int_equal(render_setup_create(&s->setup, NULL), FACET_OK);
    assert_int_equal(path_lights_create(&s->setup, &s->lights, NULL), FACET_OK);
    s->scene = (path_scene){.setup = &s->setup,
                            .lights = s->lights,
                            .draws_background = s->desc.background == FACET_BACKGROUND_ENVIRONMENT};
}

static void stage_clear(stage *s)
{
    path_lights_destroy(s->lights);
    render_setup_destroy(&s->setup);
    prepared_scene_clear(&s->prepared);
    s->lights = NULL;
}

static void stage_end(stage *s)
{
    stage_clear(s);
    fixture_destroy(&s->f);
}

static void set_sky(stage *s, float radiance)
{
    float rgb[3] = {radiance, radiance, radiance};
    assert_int_equal(facet_environment_create_constant(rgb, NULL, &s->f.environment, NULL), FACET_OK);
}

/* The mean of all samples of all pixels. */
typedef struct mean {
    double radiance[3], opacity, lit, open, albedo[3], normal[3], square;
} mean;

static mean trace_all(const stage *s)
{
    mean m = {.opacity = 0.0};
    double count = (double)s->desc.width * s->desc.height * s->desc.samples;
    for (uint32_t y = 0; y < s->desc.height; y++)
        for (uint32_t x = 0; x < s->desc.width; x++)
            for (uint32_t i = 0; i < s->desc.samples; i++) {
                path_sample sample;
                path_trace(&s->scene, x, y, i, &sample);
                assert_true(sample.rays > 0);
                m.opacity += (double)sample.opacity / count;
                m.lit += (double)sample.ground_lit[0] / count;
                m.open += (double)sample.ground_open[0] / count;
                m.square += (double)sample.radiance[0] * (double)sample.radiance[0] / count;
                for (int c = 0; c < 3; c++) {
                    m.radiance[c] += (double)sample.radiance[c] / count;
                    m.albedo[c] += (double)sample.albedo[c] / count;
                    m.normal[c] += (double)sample.normal[c] / count;
                }
            }
    return m;
}

static mean measure(stage *s)
{
    stage_prepare(s);
    mean m = trace_all(s);
    stage_clear(s);
    return m;
}

#define PI_DOUBLE 3.14159265358979323846

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.9g, expected %.9g +- %.2g", value, expected, tolerance);
}

/* ---- materials ---- */

static uint32_t lambert(stage *s, float r, float g, float b)
{
    scene_material m = scene_material_default();
    m.extensions |= SCENE_SPECULAR;
    m.specular = 0.0f;
    m.metallic = 0.0f;
    m.base_color[0] = r;
    m.base_color[1] = g;
    m.base_color[2] = b;
    return fixture_add_material(&s->f, m);
}

static scene_material clear_wall(float base_color)
{
    scene_material m = scene_material_default();
    m.extensions |= SCENE_TRANSMISSION | SCENE_IOR;
    m.metallic = m.perceptual_roughness = 0.0f;
    m.transmission = 1.0f;
    m.ior = 1.0f;
    m.is_double_sided = true;
    for (int c = 0; c < 3; c++)
        m.base_color[c] = base_color;
    return m;
}

static scene_material glass(float ior, float attenuation)
{
    scene_material m = clear_wall(1.0f);
    m.extensions |= SCENE_VOLUME;
    m.is_double_sided = false;
    m.ior = ior;
    m.thickness = 1.0f;
    m.attenuation_distance = 1.0f;
    for (int c = 0; c < 3; c++)
        m.attenuation_color[c] = attenuation;
    return m;
}

/* Directional, 3 lx, from +Z. */
static void add_light(stage *s)
{
    fixture_add_light(
        &s->f,
        (scene_light){
            .name = "", .type = SCENE_LIGHT_DIRECTIONAL, .color = {1.0f, 1.0f, 1.0f}, .intensity = 3.0f},
        0.0f, 0.0f, 0.0f);
}

/* Radiance of a white floor that faces the light. */
static const double LIT = 3.0 / PI_DOUBLE;

static void add_floor(stage *s, float z)
{
    fixture_place(&s->f, fixture_add_quad(&s->f, lambert(s, 1.0f, 1.0f, 1.0f)), 0.0f, 0.0f, z, 1.0f);
}

/* ---- alpha ---- */

/* More layers than one traversal keeps: 40 spheres, two walls each. */
static void all_layers_count(void **state)
{
    (void)state;
    stage s;
    stage_begin(&s);
    scene_material m = scene_material_default();
    m.extensions |= SCENE_UNLIT;
    m.alpha_mode = SCENE_ALPHA_BLEND;
    m.base_color[3] = 0.03f;
    m.is_double_sided = true;
    uint32_t sphere = fixture_add_sphere(&s.f, 64, fixture_add_material(&s.f, m));
    for (int i = 0; i < 40; i++)
        fixture_place(&s.f, sphere, 0.0f, 0.0f, 0.0f, 1.0f + 0.01f * (float)i);
    s.f.camera.eye[2] = 5.0f;
    stage_prepare(&s);
    double transmittance = pow(0.97, 80.0);
    mean measured = trace_all(&s);
    assert_near(measured.opacity, 1.0 - transmittance, 1e-5);
    assert_near(measured.radiance[1], 1.0 - transmittance, 1e-5);
    shading_ray ray = {.origin = {0.1f, 0.2f, 5.0f}, .direction = {0.0f, 0.0f, -1.0f}, .far_t = INFINITY};
    assert_near((double)ray_trace_transmittance(&s.setup.shading, &ray, NULL), transmittance, 1e-6);
    double hit_share = 0.0;
    for (uint32_t i = 0; i < 4000; i++) {
        visibility_hit hit;
        hit_share += ray_trace_nearest(&s.setup.shading, &ray, hash_uint(i), &hit) ? 1.0 / 4000.0 : 0.0;
    }
    assert_near(hit_share, 1.0 - transmittance, 0.02);
    stage_end(&s);
}

/* The nearer of two half-opaque walls is hit twice as often. */
static void blended_layers_count_by_their_visibility(void **state)
{
    (void)state;
    stage s;
    stage_begin(&s);
    for (int i = 0; i < 2; i++) {
        scene_material m = scene_material_default();
        m.extensions |= SCENE_UNLIT;
        m.alpha_mode = SCENE_ALPHA_BLEND;
        m.base_color[3] = 0.5f;
        m.base_color[i] = 0.0f;
        fixture_place(&s.f, fixture_add_quad(&s.f, fixture_add_material(&s.f, m)), 0.0f, 0.0f,
                      0.1f * (float)i, 1.0f);
    }
    s.f.desc.samples = 64;
    mean m = measure(&s);
    assert_near(m.opacity, 0.75, 1e-6);
    assert_near(m.radiance[2], 0.75, 1e-5);
    assert_near(m.radiance[0], 0.5, 0.01);
    assert_near(m.radiance[1], 0.25, 0.01);
    fixture_destroy(&s.f);
}

/* ---- occlusion ---- */

static mean below_wall(scene_material material, float turn, float width)
{
    stage s;
    stage_begin(&s);
    add_floor(&s, 0.0f);
    add_light(&s);
    uint32_t wall = fixture_add_quad(&s.f, fixture_add_material(&s.f, material));
    scene_node *n = fixture_place(&s.f, wall, 0.0f, 0.0f, 1.0f, width);
    n->rotation[0] = turn;
    n->rotation[3] = 1.0f - turn;
    mean m = measure(&s);
    fixture_destroy(&s.f);
    return m;
}

/* A wall of which the camera sees one side only blocks light from either side. */
static void culled_sides_cast_shadows(void **state)
{
    (void)state;
    scene_material m = scene_material_default();
    assert_near(below_wall(m, 0.0f, 0.0f).radiance[0], LIT, 1e-5);
    assert_true(below_wall(m, 0.0f, 1.0f).radiance[0] < 1e-7);
    assert_true(below_wall(m, 1.0f, 1.0f).radiance[0] < 1e-7);

    stage s;
    stage_begin(&s);
    add_floor(&s, 0.0f);
    s.f.camera.eye[2] = -1.0f;
    assert_true(measure(&s).opacity == 0.0);
    fixture_destroy(&s.f);
}

static void unlit_surfaces_are_visible_and_cast_shadows(void **state)
{
    (void)state;
    scene_material m = scene_material_default();
    m.extensions |= SCENE_UNLIT;
    m.base_color[0] = 0.25f;
    assert_true(below_wall(m, 0.0f, 1.0f).radiance[0] < 0.25 + 1e-6); /* what bounces off it */
    stage s;
    stage_begin(&s);
    fixture_place(&s.f, fixture_add_quad(&s.f, fixture_add_material(&s.f, m)), 0.0f, 0.0f, 0.0f, 1.0f);
    mean measured = measure(&s);
    assert_near(measured.radiance[0], 0.25, 1e-7);
    assert_near(measured.radiance[1], 1.0, 1e-7);
    assert_true(measured.opacity == 1.0);
    fixture_destroy(&s.f);
}

/* ---- straight through ---- */

/* Light without size through more walls than one traversal notes: without noise. */
static void shadow_rays_pass_clear_walls(void **state)
{
    (void)state;
    stage s;
    stage_begin(&s);
    add_floor(&s, 0.0f);
    add_light(&s);
    uint32_t sphere = fixture_add_sphere(&s.f, 64, fixture_add_material(&s.f, clear_wall(0.98f)));
    for (int i = 0; i < 40; i++)
        fixture_place(&s.f, sphere, 0.0f, 0.0f, 0.0f, 2.0f + 0.01f * (float)i);
    s.f.desc.path.max_depth = 1;
    double expected = LIT * pow(0.98, 40.0);
    mean m = measure(&s);
    assert_near(m.radiance[0], expected, 1e-4 * expected);
    assert_near(m.square, expected * expected, 1e-4);
    fixture_destroy(&s.f);
}

/* An area light behind a window is counted once by every strategy. */
static void windows_are_counted_once(void **state)
{
    (void)state;
    double means[3];
    for (int sampling = 0; sampling < 3; sampling++) {
        stage s;
        stage_begin(&s);
        add_floor(&s, 0.0f);
        scene_material emitter = scene_material_default();
        emitter.base_color[0] = emitter.base_color[1] = emitter.base_color[2] = 0.0f;
        emitter.metallic = 0.0f;
        emitter.extensions |= SCENE_SPECULAR;
        emitter.specular = 0.0f;
        for (int c = 0; c < 3; c++)
            emitter.emissive[c] = 1.0f;
        scene_node *n = fixture_place(&s.f, fixture_add_quad(&s.f, fixture_add_material(&s.f, emitter)), 0.0f,
                                      0.0f, 2.0f, 1.0f);
        n->rotation[0] = 1.0f;
        n->rotation[3] = 0.0f;
        scene_material wall = clear_wall(0.7f);
        wall.ior = 1.5f;
        fixture_place(&s.f, fixture_add_sphere(&s.f, 32, fixture_add_material(&s.f, wall)), 0.0f, 0.0f, 0.0f,
                      1.2f);
        s.f.desc.samples = 256;
        s.f.desc.path.max_depth = 1;
        s.f.desc.path.light_sampling = (facet_light_sampling)sampling;
        means[sampling] = measure(&s).radiance[0];
        fixture_destroy(&s.f);
    }
    assert_true(means[0] > 0.05);
    assert_near(means[1], means[0], 0.03 * means[0]);
    assert_near(means[2], means[0], 0.03 * means[0]);
}

/* 2 m of glass of transmittance 0.25 per m between light and floor, as if it did not refract. */
static void straight_shadows_are_tinted(void **state)
{
    (void)state;
    for (int is_straight = 0; is_straight < 2; is_straight++) {
        stage s;
        stage_begin(&s);
        add_floor(&s, -2.0f);
        add_light(&s);
        fixture_place(&s.f, fixture_add_sphere(&s.f, 128, fixture_add_material(&s.f, glass(1.5f, 0.25f))),
                      0.0f, 0.0f, 0.0f, 1.0f);
        s.f.camera.eye[2] = -1.5f;
        s.f.camera.target[2] = -2.0f;
        s.f.desc.path.max_depth = 1;
        s.f.desc.path.has_straight_shadows = is_straight;
        double expected = is_straight ? LIT * 0.0625 * 0.96 * 0.96 : 0.0;
        assert_near(measure(&s).radiance[0], expected, 0.002 * expected + 1e-7);
        fixture_destroy(&s.f);
    }
}

/* ---- media ---- */

static void media_around_a_point_are_found(void **state)
{
    (void)state;
    stage s;
    stage_begin(&s);
    uint32_t outer = fixture_add_sphere(&s.f, 32, fixture_add_material(&s.f, glass(1.3f, 1.0f)));
    uint32_t inner = fixture_add_sphere(&s.f, 32, fixture_add_material(&s.f, glass(1.5f, 1.0f)));
    fixture_place(&s.f, outer, 0.0f, 0.0f, 0.0f, 1.0f);
    fixture_place(&s.f, inner, 0.3f, 0.0f, 0.0f, 0.4f);
    fixture_place(&s.f, fixture_add_quad(&s.f, fixture_add_material(&s.f, glass(1.5f, 1.0f))), 0.0f, 0.0f,
                  2.0f, 1.0f);
    stage_prepare(&s);
    static const struct {
        float P[3];
        uint32_t count;
    } points[] = {{{0.3f, 0.0f, 0.0f}, 2},
                  {{-0.5f, 0.0f, 0.1f}, 1},
                  {{0.9f, 0.9f, 0.9f}, 0},
                  {{0.0f, 0.0f, 1.5f}, 0},
                  {{9.0f, 0.0f, 0.0f}, 0}};
    for (size_t i = 0; i < sizeof points / sizeof *points; i++) {
        media m = {.count = 0};
        media_at(&s.setup.shading, points[i].P, &m);
        assert_int_equal(m.count, points[i].count);
    }
    stage_end(&s);
}

/* From the middle of a ball of fog that only absorbs. */
static void cameras_may_be_inside_a_volume(void **state)
{
    (void)state;
    stage s;
    stage_begin(&s);
    set_sky(&s, 2.0f);
    fixture_place(&s.f, fixture_add_sphere(&s.f, 128, fixture_add_material(&s.f, glass(1.0f, 0.25f))), 0.0f,
                  0.0f, 0.0f, 1.0f);
    s.f.camera.eye[2] = 0.0f;
    s.f.camera.target[2] = -1.0f;
    s.f.desc.background = FACET_BACKGROUND_ENVIRONMENT;
    mean m = measure(&s);
    assert_near(m.radiance[0], 0.5, 0.002);
    assert_true(m.opacity == 1.0);
    fixture_destroy(&s.f);
}

/* A ball inside another one of the same material is a null interface, and BSDF-sampled light behind it has
 * weight 1. */
static void overlapping_volumes_are_one(void **state)
{
    (void)state;
    double means[2];
    for (int has_inner = 0; has_inner < 2; has_inner++) {
        stage s;
        stage_begin(&s);
        set_sky(&s, 1.0f);
        scene_material fog = glass(1.0f, 0.2f);
        fog.extensions |= SCENE_VOLUME_SCATTER;
        for (int c = 0; c < 3; c++)
            fog.multiscatter_color[c] = 0.1f;
        uint32_t sphere = fixture_add_sphere(&s.f, 32, fixture_add_material(&s.f, fog));
        fixture_place(&s.f, sphere, 0.0f, 0.0f, 0.0f, 1.0f);
        if (has_inner)
            fixture_place(&s.f, sphere, 0.1f, 0.0f, 0.0f, 0.6f);
        s.f.camera.eye[2] = 3.0f;
        s.f.desc.samples = 512;
        means[has_inner] = measure(&s).radiance[0];
        fixture_destroy(&s.f);
    }
    assert_true(means[0] > 0.1 && means[0] < 0.4);
    assert_near(means[1], means[0], 0.003);
}

/* White light that a prism parts is white again in a white room. */
static void dispersion_conserves_energy(void **state)
{
    (void)state;
    stage s;
    stage_begin(&s);
    set_sky(&s, 1.0f);
    scene_material m = glass(1.6f, 1.0f);
    m.extensions |= SCENE_DISPERSION;
    m.dispersion = 2.0f;
    fixture_place(&s.f, fixture_add_sphere(&s.f, 64, fixture_add_material(&s.f, m)), 0.0f, 0.0f, 0.0f, 1.0f);
    s.f.camera.eye[2] = 3.0f;
    s.f.camera.ortho_height = 1.5f;
    s.f.desc.energy = FACET_ENERGY_CONSERVING;
    s.f.desc.samples = 512;
    mean measured = measure(&s);
    for (int c = 0; c < 3; c++)
        assert_near(measured.radiance[c], 1.0, 0.01);
    fixture_destroy(&s.f);
}

/* ---- scale ---- */

static const struct {
    float scale, x;
} SCALES[] = {{1.0f, 0.0f}, {1e-4f, 0.0f}, {1e5f, 0.0f}, {1.0f, 1e4f}, {1e-2f, 100.0f}};
enum { SCALE_COUNT = sizeof SCALES / sizeof *SCALES };

/* A closed sphere blocks all light. */
static void closed_surfaces_block_all_light(void **state)
{
    (void)state;
    for (int i = 0; i < SCALE_COUNT; i++) {
        stage s;
        stage_begin(&s);
        set_sky(&s, 1e6f);
        scene_material m = scene_material_default();
        m.is_double_sided = true;
        m.perceptual_roughness = 0.3f;
        float scale = SCALES[i].scale;
        float x = SCALES[i].x;
        fixture_place(&s.f, fixture_add_sphere(&s.f, 48, fixture_add_material(&s.f, m)), x, 0.0f, 0.0f,
                      scale);
        s.f.camera =
            (facet_camera){.eye = {x, 0.0f, 0.0f}, .target = {x, 0.1f * scale, -scale}, .fov_y_rad = 2.0f};
        s.f.desc.samples = 16;
        mean measured = measure(&s);
        assert_true(measured.radiance[0] == 0.0 && measured.opacity == 1.0);
        fixture_destroy(&s.f);
    }
}

/* A clear sphere in a white room is invisible. */
static void clear_volumes_lose_no_light(void **state)
{
    (void)state;
    for (int i = 0; i < SCALE_COUNT; i++) {
        stage s;
        stage_begin(&s);
        set_sky(&s, 1.0f);
        s.f.desc.background = FACET_BACKGROUND_ENVIRONMENT;
        float scale = SCALES[i].scale;
        float x = SCALES[i].x;
        fixture_place(&s.f, fixture_add_sphere(&s.f, 48, fixture_add_material(&s.f, glass(1.5f, 1.0f))), x,
                      0.0f, 0.0f, scale);
        s.f.camera = (facet_camera){
            .eye = {x, 0.0f, 3.0f * scale}, .target = {x, 0.0f, 0.0f}, .ortho_height = 1.3f * scale};
        s.f.desc.energy = FACET_ENERGY_CONSERVING;
        s.f.desc.samples = 128;
        assert_near(measure(&s).radiance[0], 1.0, 1e-3);
        fixture_destroy(&s.f);
    }
}

/* Glass lacks the opacity with which it shows the background: over light of the environment's radiance it looks as in
 * front of the environment, rough or not. */
static void glass_shows_the_background(void **state)
{
    (void)state;
    for (int is_rough = 0; is_rough < 2; is_rough++) {
        mean means[2];
        for (int is_clear = 0; is_clear < 2; is_clear++) {
            stage s;
            stage_begin(&s);
            set_sky(&s, 1.0f);
            scene_material m = glass(1.5f, 0.6f);
            m.perceptual_roughness = is_rough ? 0.4f : 0.0f;
            fixture_place(&s.f, fixture_add_sphere(&s.f, 48, fixture_add_material(&s.f, m)), 0.0f, 0.0f, 0.0f,
                          1.0f);
            s.f.camera =
                (facet_camera){.eye = {0.0f, 0.0f, 3.0f}, .target = {0.0f, 0.0f, 0.0f}, .ortho_height = 1.3f};
            s.f.desc.background = is_clear ? FACET_BACKGROUND_TRANSPARENT : FACET_BACKGROUND_ENVIRONMENT;
            s.f.desc.energy = FACET_ENERGY_CONSERVING;
            s.f.desc.samples = 256;
            means[is_clear] = measure(&s);
            fixture_destroy(&s.f);
        }
        assert_true(means[0].opacity == 1.0);
        assert_true(means[1].opacity > 0.1 && means[1].opacity < 0.8);
        assert_near(means[1].radiance[0] + 1.0 - means[1].opacity, means[0].radiance[0], 0.01);
    }
}

/* ---- the ground ---- */

static void add_ground_view(stage *s)
{
    set_sky(s, 1.0f);
    add_light(s);
    s->f.camera.eye[1] = 3.0f;
    s->f.camera.eye[2] = 4.0f;
    s->f.camera.ortho_height = 0.5f;
}

static mean measure_ground(stage *s)
{
    stage_prepare(s);
    s->scene.has_ground = true;
    mean m = trace_all(s);
    stage_end(s);
    return m;
}

/* A surface flat on the ground occludes nothing: the result is the same to the bit. One above the ground
 * does. */
static void ground_is_darkened_by_occluders_only(void **state)
{
    (void)state;
    stage s;
    stage_begin(&s);
    add_ground_view(&s);
    scene_node *n =
        fixture_place(&s.f, fixture_add_quad(&s.f, lambert(&s, 0.5f, 0.5f, 0.5f)), 9.0f, 0.0f, 0.0f, 1.0f);
    n->rotation[0] = -0.70710678f;
    n->rotation[3] = 0.70710678f;
    mean m = measure_ground(&s);
    assert_true(m.opacity == 0.0 && m.radiance[0] == 0.0);
    assert_near(m.open, 1.0, 0.01);
    assert_true(m.lit == m.open);

    stage_begin(&s);
    add_ground_view(&s);
    fixture_place(&s.f, fixture_add_sphere(&s.f, 32, lambert(&s, 0.0f, 0.0f, 0.0f)), 0.0f, 2.0f, 0.0f, 1.0f);
    s.f.camera.eye[1] = 0.5f;
    s.f.camera.eye[2] = 10.0f;
    s.f.camera.ortho_height = 0.01f;
    m = measure_ground(&s);
    /* A sphere of radius 1 at height 2 occludes 1 / 4 of the light on the ground; shadows fade out at the border. */
    double fade = 0.0;
    for (int i = 0; i < 64; i++)
        fade += (double)ground_fade(vec2((float)(i % 8) + 0.5f, (float)(i / 8) + 0.5f) / 8.0f) / 64.0;
    assert_near((1.0 - m.lit / m.open) / fade, 0.25, 0.03);
}

static void ground_is_visible_from_above_only(void **state)
{
    (void)state;
    stage s;
    stage_begin(&s);
    add_ground_view(&s);
    add_floor(&s, 50.0f);
    s.f.camera.eye[1] = -3.0f;
    mean m = measure_ground(&s);
    assert_true(m.open == 0.0 && m.opacity == 0.0);
}

/* ---- the camera ---- */

/* Rays from all points of the lens meet in the plane of focus. */
static void lens_rays_meet_in_focus(void **state)
{
    (void)state;
    for (int is_orthographic = 0; is_orthographic < 2; is_orthographic++) {
        stage s;
        stage_begin(&s);
        add_floor(&s, -3.0f);
        s.f.camera = (facet_camera){.eye = {0.0f, 0.0f, 1.0f},
                                    .target = {0.0f, 0.0f, -3.0f},
                                    .fov_y_rad = is_orthographic ? 0.0f : 0.1f,
                                    .ortho_height = 0.4f,
                                    .lens_radius_m = 0.2f,
                                    .focus_m = is_orthographic ? 0.0f : 2.0f};
        stage_prepare(&s);
        float focus = is_orthographic ? 4.0f : 2.0f;
        float pixel = camera_rays_pixel_size(&s.setup.camera, focus);
        double farthest = 0.0;
        for (uint32_t i = 0; i < 256; i++) {
            path_sampler sampler = path_sampler_start(0, 4, 4, i);
            path_camera_ray r;
            vec2 u_pixel = path_sampler_pair(&sampler);
            path_sample_camera_ray(&s.scene, u_pixel, path_sampler_pair(&sampler), 4, 4, &r);
            vec3 D = load3(r.ray.direction);
            vec3 P = load3(r.ray.origin);
            assert_near((double)length(D), 1.0, 1e-6);
            vec3 X = P + D * ((1.0f - focus - P[2]) / D[2]);
            assert_near((double)X[0], 0.5 * (double)pixel, 0.5 * (double)pixel + 1e-5);
            assert_near((double)X[1], -0.5 * (double)pixel, 0.5 * (double)pixel + 1e-5);
            vec3 middle = is_orthographic ? vec3(X[0], X[1], P[2]) : vec3(0.0f, 0.0f, P[2]);
            farthest = fmax(farthest, (double)length(P - middle));
        }
        assert_true(farthest > 0.19 && farthest < 0.2001);
        stage_end(&s);
    }
}

/* ---- features for the denoiser ---- */

/* A mirror at 45 degrees shows a red wall. */
static void guides_follow_specular_reflections(void **state)
{
    (void)state;
    stage s;
    stage_begin(&s);
    scene_material mirror = scene_material_default();
    mirror.metallic = 1.0f;
    mirror.perceptual_roughness = 0.0f;
    scene_node *n = fixture_place(&s.f, fixture_add_quad(&s.f, fixture_add_material(&s.f, mirror)), 0.0f,
                                  0.0f, 0.0f, 1.0f);
    n->rotation[0] = -0.38268343f;
    n->rotation[3] = 0.92387953f;
    n = fixture_place(&s.f, fixture_add_quad(&s.f, lambert(&s, 0.8f, 0.1f, 0.2f)), 0.0f, 2.0f, 0.0f, 1.0f);
    n->rotation[0] = 0.70710678f;
    n->rotation[3] = 0.70710678f;
    mean m = measure(&s);
    assert_near(m.albedo[0], 0.8, 1e-6);
    assert_near(m.albedo[2], 0.2, 1e-6);
    assert_near(m.normal[1], -1.0, 1e-6);
    fixture_destroy(&s.f);
}

/* A tinted mirror shows the sky, whose albedo is 1, with the mirror's own normal. */
static void guides_of_the_environment_are_white(void **state)
{
    (void)state;
    stage s;
    stage_begin(&s);
    set_sky(&s, 3.0f);
    scene_material mirror = scene_material_default();
    mirror.metallic = 1.0f;
    mirror.perceptual_roughness = 0.0f;
    mirror.base_color[1] = 0.5f;
    scene_node *n = fixture_place(&s.f, fixture_add_quad(&s.f, fixture_add_material(&s.f, mirror)), 0.0f,
                                  0.0f, 0.0f, 1.0f);
    n->rotation[0] = -0.38268343f;
    n->rotation[3] = 0.92387953f;
    mean m = measure(&s);
    assert_near(m.albedo[0], 1.0, 1e-3);
    assert_near(m.albedo[1], m.radiance[1] / 3.0, 1e-5);
    assert_true(m.albedo[1] > 0.49 && m.albedo[1] < 0.52);
    assert_near(m.normal[1], sqrt(0.5), 1e-6);
    fixture_destroy(&s.f);
}

/* No contribution of more than one bounce is above the clamp; direct light stays. */
static void clamp_cuts_indirect_light(void **state)
{
    (void)state;
    double means[3];
    for (int i = 0; i < 3; i++) {
        stage s;
        stage_begin(&s);
        add_floor(&s, 0.0f);
        add_light(&s);
        scene_node *n = fixture_place(&s.f, fixture_add_quad(&s.f, lambert(&s, 1.0f, 1.0f, 1.0f)), 0.3f, 0.0f,
                                      0.0f, 1.0f);
        n->rotation[1] = -0.5f; /* leans over the floor */
        n->rotation[3] = 0.8660254f;
        s.f.desc.path.clamp = i == 0 ? 0.0f : i == 1 ? 1e-3f : 1e6f;
        s.f.desc.samples = 64;
        means[i] = measure(&s).radiance[0];
        fixture_destroy(&s.f);
    }
    assert_true(means[0] > LIT + 0.02);
    assert_true(means[2] == means[0]);
    assert_true(means[1] >= LIT - 1e-5 && means[1] < LIT + 0.01);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_layers_count),
        cmocka_unit_test(blended_layers_count_by_their_visibility),
        cmocka_unit_test(culled_sides_cast_shadows),
        cmocka_unit_test(unlit_surfaces_are_visible_and_cast_shadows),
        cmocka_unit_test(shadow_rays_pass_clear_walls),
        cmocka_unit_test(windows_are_counted_once),
        cmocka_unit_test(straight_shadows_are_tinted),
        cmocka_unit_test(media_around_a_point_are_found),
        cmocka_unit_test(cameras_may_be_inside_a_volume),
        cmocka_unit_test(overlapping_volumes_are_one),
        cmocka_unit_test(dispersion_conserves_energy),
        cmocka_unit_test(closed_surfaces_block_all_light),
        cmocka_unit_test(clear_volumes_lose_no_light),
        cmocka_unit_test(glass_shows_the_background),
        cmocka_unit_test(ground_is_darkened_by_occluders_only),
        cmocka_unit_test(ground_is_visible_from_above_only),
        cmocka_unit_test(lens_rays_meet_in_focus),
        cmocka_unit_test(guides_follow_specular_reflections),
        cmocka_unit_test(guides_of_the_environment_are_white),
        cmocka_unit_test(clamp_cuts_indirect_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
