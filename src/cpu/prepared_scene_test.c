/* Tests of data kept from image to image: each image is bit for bit that of a separate render, and
 * unchanged data are not rebuilt. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "base/memory.h"
#include "cpu/preview_fixture.h"

static facet_render_desc resolved_desc(const fixture *f)
{
    facet_render_desc desc = f->desc;
    desc.camera = &f->camera;
    desc.environment = f->environment;
    if (!desc.crop[2]) {
        desc.crop[2] = desc.width;
        desc.crop[3] = desc.height;
    }
    return desc;
}

static facet_result try_prepared(const fixture *f, prepared_scene *p, film *rendered,
                                 facet_render_stats *stats, facet_error *error)
{
    facet_render_desc desc = resolved_desc(f);
    facet_result result =
        film_create(&desc.allocator, desc.crop[2], desc.crop[3], desc.aovs, rendered, error);
    return result == FACET_OK ? preview_render_prepared(p, &desc, rendered, stats, error) : result;
}

static void assert_same_film(const film *a, const film *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_int_equal(a->layer_count, b->layer_count);
    for (uint32_t i = 0; i < a->layer_count; i++)
        assert_memory_equal(a->layers[i].pixels, b->layers[i].pixels,
                            (size_t)a->width * a->height * a->layers[i].channel_count * sizeof(float));
}

/* Renders with the prepared scene, and separately. */
static facet_render_stats compare(fixture *f, prepared_scene *p)
{
    film kept;
    facet_render_stats stats;
    facet_error error = {0};
    if (try_prepared(f, p, &kept, &stats, &error) != FACET_OK)
        fail_msg("%s", error.message);
    film fresh = fixture_render(f);
    assert_same_film(&kept, &fresh);
    film_destroy(&kept);
    film_destroy(&fresh);
    return stats;
}

/* ---- scenes ---- */

static uint32_t add_material(fixture *f, bool is_unlit, uint32_t seed)
{
    enum { SIZE = 256 };
    static unsigned char texels[4 * SIZE * SIZE];
    uint32_t textures[2];
    for (uint32_t k = 0; k < 2; k++) {
        for (uint32_t i = 0; i < SIZE * SIZE; i++) {
            uint32_t noise = (i * 2654435761u ^ (seed + k)) * 2246822519u;
            const unsigned char normal[4] = {(unsigned char)(100 + (noise >> 26)), 140, 240, 255};
            const unsigned char color[4] = {(unsigned char)(noise >> 24), (unsigned char)i,
                                            (unsigned char)(i >> 8), 255};
            memcpy(texels + 4 * i, k ? normal : color, 4);
        }
        textures[k] = fixture_add_texture(f, SIZE, SIZE, texels);
    }
    scene_material m = scene_material_default();
    m.extensions = is_unlit ? SCENE_UNLIT : 0;
    m.textures[SCENE_BASE_COLOR_TEXTURE].texture = textures[0];
    m.textures[SCENE_NORMAL_TEXTURE].texture = is_unlit ? SCENE_NONE : textures[1];
    m.perceptual_roughness = 0.3f;
    return fixture_add_material(f, m);
}

/* Textured spheres, lines, points, transparency. */
static fixture still_scene(void)
{
    static const float places[12] = {-1, -1, 0.5f, 1, 1, 0.3f, -1, 1, 0.2f, 1, -1, 0.1f};
    fixture f = fixture_create();
    uint32_t ball = fixture_add_sphere(&f, 32, add_material(&f, false, 1));
    uint32_t wall = fixture_add_quad(&f, add_material(&f, true, 2));
    scene_material glass = scene_material_default();
    glass.alpha_mode = SCENE_ALPHA_BLEND;
    glass.base_color[3] = 0.5f;
    uint32_t pane = fixture_add_quad(&f, fixture_add_material(&f, glass));
    fixture_place(&f, ball, -0.3f, 0.2f, 0.0f, 0.5f);
    fixture_place(&f, ball, 0.5f, -0.2f, 0.1f, 0.3f);
    fixture_place(&f, wall, 0.0f, 0.0f, -0.7f, 0.9f);
    fixture_place(&f, pane, 0.3f, 0.3f, 0.7f, 0.4f);
    fixture_place(&f, fixture_add_sprites(&f, SCENE_LINES, places, 4, SCENE_NONE), 0, 0, 0, 0.8f);
    fixture_place(&f, fixture_add_sprites(&f, SCENE_POINTS, places, 4, SCENE_NONE), 0, 0, 0, 0.5f);
    scene_light light = {.type = SCENE_LIGHT_POINT, .color = {1, 0.5f, 0.2f}, .intensity = 20.0f};
    fixture_add_light(&f, light, 2, 2, 2);
    f.desc.aovs = FACET_AOV_DEPTH | FACET_AOV_NORMAL | FACET_AOV_ALBEDO;
    return f;
}

static void orbit(fixture *f, float angle, float distance)
{
    f->camera.eye[0] = distance * sinf(angle);
    f->camera.eye[1] = 0.2f * distance;
    f->camera.eye[2] = distance * cosf(angle);
    f->camera.fov_y_rad = 0.5f;
}

/* ---- views ---- */

static void turntables_keep_all_but_the_camera(void **state)
{
    (void)state;
    for (int has_sprites = 0; has_sprites < 2; has_sprites++) {
        fixture f = still_scene();
        if (!has_sprites)
            f.scene->node_count -= 3; /* lines, points, the light */
        prepared_scene p;
        prepared_scene_init(&p, f.scene, NULL);
        RTCScene first = NULL;
        for (int i = 0; i < 8; i++) {
            orbit(&f, 0.8f * (float)i, 5.0f);
            facet_render_stats stats = compare(&f, &p);
            assert_true(i == 0 || stats.decoded_texels == 0);
            first = i ? first : p.embree.scene;
            assert_true(has_sprites || p.embree.scene == first);
            assert_int_equal(p.tangents.count, 1);
        }
        prepared_scene_clear(&p);
        fixture_destroy(&f);
    }
}

/* Moving closer decodes finer mips; moving back reads the coarser ones again. */
static void textures_are_as_fine_as_each_picture_wants_them(void **state)
{
    (void)state;
    static const float distances[9] = {40.0f, 10.0f, 3.0f, 40.0f, 10.0f, 3.0f, 80.0f, 5.0f, 3.0f};
    fixture f = still_scene();
    prepared_scene p;
    prepared_scene_init(&p, f.scene, NULL);
    for (int i = 0; i < 9; i++) {
        orbit(&f, 0.3f, distances[i]);
        facet_render_stats stats = compare(&f, &p);
        if (i == 1 || i == 2)
            assert_true(stats.decoded_texels > 0);
        if (i == 3 || i == 4 || i == 5 || i == 7)
            assert_int_equal(stats.decoded_texels, 0);
    }
    prepared_scene_clear(&p);
    fixture_destroy(&f);
}

static void settings_may_change_between_pictures(void **state)
{
    (void)state;
    fixture f = still_scene();
    facet_environment *other;
    float radiance[3] = {0.2f, 0.5f, 1.0f};
    assert_int_equal(facet_environment_create_constant(radiance, NULL, &other, NULL), FACET_OK);
    facet_environment *first = f.environment;
    prepared_scene p;
    prepared_scene_init(&p, f.scene, NULL);
    for (uint32_t i = 0; i < 24; i++) {
        orbit(&f, 0.1f * (float)i, 5.0f);
        f.desc.width = i % 2 ? 90 : 50;
        f.desc.height = i % 3 ? 50 : 80;
        f.desc.samples = i % 5 == 1 ? 16 : i % 5 == 3 ? 1 : 4;
        f.desc.quality = i % 4 == 2 ? FACET_QUALITY_FINAL : FACET_QUALITY_NORMAL;
        f.desc.thread_count = 1 + i % 3;
        f.desc.aovs = i % 2 ? FACET_AOV_NORMAL | FACET_AOV_UV : 0;
        f.desc.background = i % 3 == 1 ? FACET_BACKGROUND_ENVIRONMENT : FACET_BACKGROUND_TRANSPARENT;
        f.desc.energy = i % 2 ? FACET_ENERGY_CONSERVING : FACET_ENERGY_GLTF;
        f.desc.ignores_scene_lights = i % 4 == 0;
        f.desc.exposure_ev = (float)(i % 3);
        f.environment = i % 4 == 3 ? NULL : i % 2 ? other : first;
        memset(f.desc.crop, 0, sizeof f.desc.crop);
        if (i % 6 == 5) {
            const uint32_t crop[4] = {7, 9, 30, 20};
            memcpy(f.desc.crop, crop, sizeof crop);
        }
        compare(&f, &p);
    }
    prepared_scene_clear(&p);
    f.environment = first;
    facet_environment_destroy(other);
    fixture_destroy(&f);
}

/* A plane of squares, each hit by a ray on its diagonal: which triangle it hits depends on the quality of
 * the BVH, and that on the number of rays. */
static void hierarchies_are_as_good_as_each_picture_wants_them(void **state)
{
    (void)state;
    enum { SIDE = 64 };
    fixture f = fixture_create();
    uint32_t mesh = fixture_add_sphere(&f, SIDE, SCENE_NONE);
    scene_primitive *p = fixture_primitive(&f, mesh);
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        float *position = (float *)(uintptr_t)p->positions + 3 * i;
        position[0] = (float)(i % (SIDE + 1)) / (SIDE / 2) - 1.0f;
        position[1] = (float)(i / (SIDE + 1)) / (SIDE / 2) - 0.5f;
        position[2] = 0.0f;
    }
    scene_material material = scene_material_default();
    material.is_double_sided = true;
    p->material = fixture_add_material(&f, material);
    fixture_place(&f, mesh, 0, 0, 0, 1.0f);
    f.desc.aovs = FACET_AOV_UV | FACET_AOV_NORMAL;
    prepared_scene prepared;
    prepared_scene_init(&prepared, f.scene, NULL);
    for (int i = 0; i < 4; i++) {
        f.desc.samples = i % 2 ? 16 : 4;
        compare(&f, &prepared);
        assert_int_equal(prepared.embree.quality, i % 2 ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_LOW);
    }
    prepared_scene_clear(&prepared);
    fixture_destroy(&f);
}

static void scenes_and_variants_may_change(void **state)
{
    (void)state;
    static const uint32_t nodes[2][2] = {{0, 1}, {2, 3}};
    static const scene_root roots[2] = {
        {.name = "", .node_count = 2, .nodes = nodes[0], .image_light = SCENE_NONE},
        {.name = "", .node_count = 2, .nodes = nodes[1], .image_light = SCENE_NONE}};
    fixture f = still_scene();
    const char *names[2] = {"as it is", "red"};
    scene_material red = scene_material_default();
    red.base_color[1] = 0.0f;
    /* with a normal texture, along another set of coordinates than the primitive's own material */
    red.textures[SCENE_NORMAL_TEXTURE] = f.scene->materials[0].textures[SCENE_NORMAL_TEXTURE];
    const uint32_t variants[2] = {SCENE_NONE, fixture_add_material(&f, red)};
    fixture_primitive(&f, 0)->variant_materials = variants;
    f.scene->variants = names;
    f.scene->variant_count = 2;
    f.scene->scenes = (scene_root *)(uintptr_t)roots;
    f.scene->scene_count = 2;
    prepared_scene p;
    prepared_scene_init(&p, f.scene, NULL);
    for (uint32_t i = 0; i < 16; i++) {
        f.desc.pose = (facet_pose_desc){
            .has_scene_index = i & 1, .scene_index = i >> 1 & 1, .has_variant = i & 4, .variant = i >> 3 & 1};
        compare(&f, &p);
    }
    prepared_scene_clear(&p);
    fixture_destroy(&f);
}

/* ---- motion ---- */

static const float key_times[3] = {0.0f, 1.0f, 2.0f};
static const float key_rotations[12] = {0, 0, 0, 1, 0, 0.6f, 0, 0.8f, 0, 0, 0.8f, 0.6f};
static const float key_weights[3] = {0.0f, 1.0f, 0.3f};
static const float key_colors[12] = {1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1};
static const uint32_t first_animation = 0;

/* Rotates a node (or animates its weight, or the color of a material) by keys. */
static void animate(fixture *f, scene_channel channel)
{
    scene_sampler *sampler = arena_zalloc(f->scene->arena, 1, sizeof *sampler);
    scene_channel *kept = arena_zalloc(f->scene->arena, 1, sizeof *kept);
    scene_animation *animation = arena_zalloc(f->scene->arena, 1, sizeof *animation);
    assert_true(sampler && kept && animation);
    *sampler = (scene_sampler){.interpolation = SCENE_LINEAR, .key_count = 3, .times = key_times};
    sampler->width = channel.kind == SCENE_TARGET_WEIGHTS ? 1 : 4;
    sampler->values = channel.kind == SCENE_TARGET_WEIGHTS    ? key_weights
                      : channel.kind == SCENE_TARGET_MATERIAL ? key_colors
                                                              : key_rotations;
    *kept = channel;
    kept->scale = 1.0f;
    *animation = (scene_animation){.name = "",
                                   .channel_count = 1,
                                   .sampler_count = 1,
                                   .channels = kept,
                                   .samplers = sampler,
                                   .end_s = 2.0f};
    f->scene->animations = animation;
    f->scene->animation_count = 1;
    f->desc.pose.animation_count = 1;
    f->desc.pose.animations = &first_animation;
}

static scene_channel rotation_of(uint32_t node)
{
    return (scene_channel){.kind = SCENE_TARGET_NODE,
                           .index = node,
                           .offset = offsetof(scene_node, rotation),
                           .is_rotation = true};
}

/* Large enough that keeping the static part pays: a child rotates with its parent. */
static fixture moving_scene(void)
{
    fixture f = fixture_create();
    uint32_t material = add_material(&f, false, 3);
    uint32_t balls[3];
    for (int i = 0; i < 3; i++)
        balls[i] = fixture_add_sphere(&f, 128, material);
    fixture_place(&f, balls[0], -0.5f, 0.0f, 0.0f, 0.5f);
    fixture_place(&f, balls[1], 0.5f, 0.3f, 0.0f, 0.4f);
    fixture_place(&f, balls[2], 1.0f, -0.5f, 0.4f, 0.5f);
    fixture_place(&f, fixture_add_quad(&f, material), 0.0f, 0.0f, -0.5f, 1.0f);
    uint32_t *child = arena_zalloc(f.scene->arena, 1, sizeof *child);
    assert_non_null(child);
    *child = 2;
    f.scene->nodes[1].child_count = 1;
    f.scene->nodes[1].children = child;
    f.scene->nodes[2].parent = 1;
    f.desc.aovs = FACET_AOV_DEPTH | FACET_AOV_NORMAL;
    return f;
}

static void rigid_parts_move_in_a_hierarchy_that_stays(void **state)
{
    (void)state;
    fixture f = moving_scene();
    animate(&f, rotation_of(1));
    prepared_scene p;
    prepared_scene_init(&p, f.scene, NULL);
    RTCScene still = NULL;
    RTCScene shape = NULL;
    for (int i = 0; i < 7; i++) {
        f.desc.pose.time_s = 0.3 * i;
        orbit(&f, 0.2f * (float)(i / 2), 6.0f);
        compare(&f, &p);
        assert_int_equal(p.geometries.shape_count, 2);
        assert_true(p.geometries.is_animated && p.embree.still.scene && p.embree.shapes[0].scene);
        assert_true(i == 0 || (p.embree.still.scene == still && p.embree.shapes[0].scene == shape));
        still = p.embree.still.scene;
        shape = p.embree.shapes[0].scene;
    }
    /* At rest, without animations, all is flat again. */
    f.desc.pose.animation_count = 0;
    compare(&f, &p);
    assert_int_equal(p.geometries.shape_count, 0);
    prepared_scene_clear(&p);
    fixture_destroy(&f);
}

/* An image of frames is that of flat vertices, but for rounding: animated and, at the same place, not. */
static void frames_show_what_stands_there(void **state)
{
    (void)state;
    fixture f = moving_scene();
    animate(&f, rotation_of(1));
    f.desc.pose.time_s = 1.0;
    film moving = fixture_render(&f);
    f.desc.pose.animation_count = 0;
    memcpy(f.scene->nodes[1].rotation, key_rotations + 4, 4 * sizeof(float));
    film flat = fixture_render(&f);
    uint32_t others = 0;
    for (uint32_t i = 0; i < 64 * 64 * 4; i++)
        others += fabsf(moving.layers[0].pixels[i] - flat.layers[0].pixels[i]) > 1.0f / 255.0f;
    assert_true(others <= 8);
    film_destroy(&moving);
    film_destroy(&flat);
    fixture_destroy(&f);
}

static void small_animations_are_flat(void **state)
{
    (void)state;
    fixture f = still_scene();
    animate(&f, rotation_of(0));
    prepared_scene p;
    prepared_scene_init(&p, f.scene, NULL);
    for (int i = 0; i < 5; i++) {
        f.desc.pose.time_s = 0.5 * i;
        compare(&f, &p);
        assert_false(p.embree.has_instances);
    }
    prepared_scene_clear(&p);
    fixture_destroy(&f);
}

/* Morph targets: the sphere becomes pointed; tangents follow, other meshes stay. */
static void deformed_meshes_are_made_anew(void **state)
{
    (void)state;
    for (int is_large = 0; is_large < 2; is_large++) {
        fixture f = is_large ? moving_scene() : still_scene();
        scene_primitive *ball = fixture_primitive(&f, 0);
        scene_morph_target *target = arena_zalloc(f.scene->arena, 1, sizeof *target);
        float *moves = arena_zalloc(f.scene->arena, ball->vertex_count, 3 * sizeof *moves);
        float *turns = arena_zalloc(f.scene->arena, ball->vertex_count, 3 * sizeof *turns);
        float *weights = arena_zalloc(f.scene->arena, 1, sizeof *weights);
        assert_true(target && moves && turns && weights);
        for (uint32_t i = 0; i < 3 * ball->vertex_count; i++) {
            moves[i] = 0.5f * ball->positions[i] * fabsf(ball->positions[i]);
            turns[i] = i % 3 == 1 ? 0.2f : 0.0f;
        }
        *target = (scene_morph_target){.positions = moves, .normals = turns};
        ball->target_count = 1;
        ball->targets = target;
        f.scene->meshes[0].weight_count = 1;
        f.scene->meshes[0].weights = weights;
        animate(&f, (scene_channel){.kind = SCENE_TARGET_WEIGHTS, .index = 0});
        prepared_scene p;
        prepared_scene_init(&p, f.scene, NULL);
        RTCScene still = NULL;
        for (int i = 0; i < 6; i++) {
            f.desc.pose.time_s = i == 3 ? 0.0 : 0.4 * i;
            compare(&f, &p);
            assert_true(p.geometries.is_animated == is_large);
            assert_true(i == 0 || p.embree.still.scene == still);
            still = p.embree.still.scene;
            assert_true(p.tangents.count <= 5); /* of four meshes at rest, and one as it is now */
        }
        prepared_scene_clear(&p);
        fixture_destroy(&f);
    }
}

/* Only a color changes: the geometry is that of the frame before. */
static void animated_materials_keep_the_geometry(void **state)
{
    (void)state;
    fixture f = still_scene();
    animate(&f, (scene_channel){.kind = SCENE_TARGET_MATERIAL,
                                .index = 0,
                                .offset = offsetof(scene_material, base_color)});
    prepared_scene p;
    prepared_scene_init(&p, f.scene, NULL);
    RTCScene first = NULL;
    for (int i = 0; i < 5; i++) {
        f.desc.pose.time_s = 0.4 * i;
        facet_render_stats stats = compare(&f, &p);
        first = i ? first : p.embree.scene;
        assert_true(p.embree.scene == first);
        assert_true(i == 0 || stats.decoded_texels == 0);
    }
    prepared_scene_clear(&p);
    fixture_destroy(&f);
}

/* ---- failures ---- */

static bool refuse(void *user, const char *stage, double fraction)
{
    (void)stage;
    (void)fraction;
    int *left = user;
    return (*left)-- > 0;
}

static void what_is_cancelled_can_be_drawn_again(void **state)
{
    (void)state;
    fixture f = still_scene();
    prepared_scene p;
    prepared_scene_init(&p, f.scene, NULL);
    for (int calls = 0; calls < 6; calls++) {
        orbit(&f, (float)calls, 5.0f);
        film rendered;
        facet_render_stats stats;
        facet_error error;
        int left = calls;
        f.desc.progress = (facet_progress){.user = &left, .report = refuse};
        assert_int_equal(try_prepared(&f, &p, &rendered, &stats, &error), FACET_ERROR_CANCELLED);
        film_destroy(&rendered);
        f.desc.progress = (facet_progress){0};
        f.desc.time_limit_s = 1e-9;
        assert_int_equal(try_prepared(&f, &p, &rendered, &stats, &error), FACET_ERROR_LIMIT);
        film_destroy(&rendered);
        f.desc.time_limit_s = 0.0;
        if (calls % 2)
            compare(&f, &p);
    }
    prepared_scene_clear(&p);
    fixture_destroy(&f);
}

static void wrong_arguments_harm_nothing(void **state)
{
    (void)state;
    fixture f = still_scene();
    prepared_scene p;
    prepared_scene_init(&p, f.scene, NULL);
    for (int i = 0; i < 4; i++) {
        film rendered;
        facet_render_stats stats;
        facet_error error;
        if (i)
            compare(&f, &p);
        f.desc.pose = (facet_pose_desc){.has_scene_index = true, .scene_index = 7};
        assert_int_equal(try_prepared(&f, &p, &rendered, &stats, &error), FACET_ERROR_ARGUMENT);
        film_destroy(&rendered);
        f.desc.pose = (facet_pose_desc){0};
        facet_camera camera = f.camera;
        memcpy(f.camera.eye, f.camera.target, sizeof f.camera.eye);
        assert_int_equal(try_prepared(&f, &p, &rendered, &stats, &error), FACET_ERROR_ARGUMENT);
        film_destroy(&rendered);
        f.camera = camera;
    }
    prepared_scene_clear(&p);
    fixture_destroy(&f);
}

/* Refuses each allocation of the second frame in turn. After releasing the kept data there is enough
 * memory. */
static void running_out_of_memory_starts_again(void **state)
{
    (void)state;
    fixture f = moving_scene();
    animate(&f, rotation_of(1));
    f.desc.width = f.desc.height = 24;
    f.desc.thread_count = 1;
    f.desc.pose.time_s = 1.0;
    film expected = fixture_render(&f);
    failing_allocator memory = {.fail_at = -1};
    facet_allocator allocator = failing_allocator_get(&memory);
    for (long at = 0;; at = next_failure(at)) {
        memory = (failing_allocator){.fail_at = -1};
        prepared_scene p;
        prepared_scene_init(&p, f.scene, &allocator);
        film rendered;
        facet_render_stats stats;
        facet_error error;
        f.desc.pose.time_s = 0.0;
        assert_int_equal(try_prepared(&f, &p, &rendered, &stats, &error), FACET_OK);
        film_destroy(&rendered);
        f.desc.pose.time_s = 1.0;
        memory.fail_at = atomic_load(&memory.calls) + at;
        assert_int_equal(try_prepared(&f, &p, &rendered, &stats, &error), FACET_OK);
        bool was_refused = atomic_load(&memory.calls) > memory.fail_at;
        assert_same_film(&rendered, &expected);
        film_destroy(&rendered);
        prepared_scene_clear(&p);
        assert_int_equal(memory.blocks, 0);
        if (!was_refused) {
            assert_true(at > 10);
            break;
        }
    }
    film_destroy(&expected);
    fixture_destroy(&f);
}

/* Every budget is respected: images fail or are correct, and a renderer that failed works with more
 * memory. */
static void budgets_are_kept(void **state)
{
    (void)state;
    fixture f = moving_scene();
    animate(&f, rotation_of(1));
    bool has_failed = false;
    bool has_worked = false;
    for (uint64_t limit = 1 << 16; limit < 64 << 20; limit += limit / 2) {
        facet_budget *budget;
        assert_int_equal(facet_budget_create(limit, &budget, NULL), FACET_OK);
        facet_allocator allocator = facet_budget_allocator(budget);
        prepared_scene p;
        prepared_scene_init(&p, f.scene, &allocator);
        for (int i = 0; i < 3; i++) {
            film rendered = {0};
            facet_render_stats stats;
            facet_error error;
            f.desc.pose.time_s = 0.7 * i;
            facet_result result = try_prepared(&f, &p, &rendered, &stats, &error);
            assert_true(result == FACET_OK || result == FACET_ERROR_MEMORY);
            has_failed = has_failed || result != FACET_OK;
            has_worked = has_worked || result == FACET_OK;
            assert_true(result != FACET_ERROR_MEMORY || facet_budget_used_bytes(budget) == 0);
            film_destroy(&rendered);
        }
        prepared_scene_clear(&p);
        assert_int_equal(facet_budget_used_bytes(budget), 0);
        facet_budget_destroy(budget);
    }
    assert_true(has_failed && has_worked);
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(turntables_keep_all_but_the_camera),
        cmocka_unit_test(textures_are_as_fine_as_each_picture_wants_them),
        cmocka_unit_test(settings_may_change_between_pictures),
        cmocka_unit_test(hierarchies_are_as_good_as_each_picture_wants_them),
        cmocka_unit_test(scenes_and_variants_may_change),
        cmocka_unit_test(rigid_parts_move_in_a_hierarchy_that_stays),
        cmocka_unit_test(frames_show_what_stands_there),
        cmocka_unit_test(small_animations_are_flat),
        cmocka_unit_test(deformed_meshes_are_made_anew),
        cmocka_unit_test(animated_materials_keep_the_geometry),
        cmocka_unit_test(what_is_cancelled_can_be_drawn_again),
        cmocka_unit_test(wrong_arguments_harm_nothing),
        cmocka_unit_test(running_out_of_memory_starts_again),
        cmocka_unit_test(budgets_are_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
