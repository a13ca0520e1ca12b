/* gl_mesh_test.c - geometry in GPU memory: what is uploaded and how often, which instances share a call,
 * and that triangles, points and lines are where the preview has them. Exits with 77 where there is no
 * OpenGL. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "gl/scene/gl_fixture_test.h"
#include "gl/scene/gl_mesh.h"

static gl_fixture_contexts contexts;

/* A scene and its geometry in GPU memory. */
typedef struct bench {
    gl_scene scene;
    gl_mesh_set *meshes;
} bench;

static bench bench_open(const fixture *f)
{
    bench b;
    assert_int_equal(gl_context_make_current(&contexts.items[0], NULL), FACET_OK);
    gl_scene_init(&b.scene, f->scene, NULL);
    assert_int_equal(gl_mesh_create(&contexts.items[0], NULL, &b.meshes, NULL), FACET_OK);
    return b;
}

static void bench_update(bench *b, const fixture *f)
{
    facet_error error = {0};
    if (gl_scene_update(&b->scene, &f->desc, &error) != FACET_OK ||
        gl_mesh_update(b->meshes, &b->scene, NULL, &error) != FACET_OK)
        fail_msg("%s", error.message);
}

static void bench_close(bench *b)
{
    gl_mesh_destroy(b->meshes);
    gl_scene_clear(&b->scene);
    gl_context_release(&contexts.items[0]);
}

static const gl_batch *only_batch(const bench *b, gl_pass pass, uint32_t wanted)
{
    uint32_t count;
    const gl_batch *batches = gl_mesh_batches(b->meshes, pass, &count);
    assert_int_equal(count, wanted);
    return batches;
}

/* ---- uploads ---- */

/* A quad: 4 vertices with positions, normals and texture coordinates; 6 indices; 25 floats per instance. */
enum { QUAD_BYTES = 4 * (12 + 12 + 8) + 6 * 4, INSTANCE_BYTES = 25 * 4 };

static void arrays_are_uploaded_once(void **state)
{
    (void)state;
    fixture f = fixture_create();
    uint32_t red = fixture_add_material(&f, gl_fixture_unlit(1.0f, 0.0f, 0.0f, 1.0f));
    uint32_t blue = fixture_add_material(&f, gl_fixture_unlit(0.0f, 0.0f, 1.0f, 1.0f));
    uint32_t quad = fixture_add_quad(&f, red), other = fixture_add_quad(&f, blue);
    scene_primitive *p = fixture_primitive(&f, other); /* the same arrays, another material */
    const scene_primitive *q = fixture_primitive(&f, quad);
    p->positions = q->positions;
    p->normals = q->normals;
    p->texcoords = q->texcoords;
    p->indices = q->indices;
    for (int i = 0; i < 5; i++)
        fixture_place(&f, i % 2 ? other : quad, (float)i, 0.0f, 0.0f, 0.3f);
    bench b = bench_open(&f);
    bench_update(&b, &f);
    assert_int_equal(gl_mesh_uploads(b.meshes).bytes, QUAD_BYTES + 5 * INSTANCE_BYTES);
    const gl_batch *batches = only_batch(&b, GL_PASS_OPAQUE, 2);
    assert_int_equal(batches[0].instance_count, 3);
    assert_int_equal(batches[1].instance_count, 2);
    assert_int_equal(batches[0].vertices.fixed.arrays,
                     1u << GL_ATTRIBUTE_POSITION | 1u << GL_ATTRIBUTE_NORMAL | 1u << GL_ATTRIBUTE_TEXCOORD);
    bench_update(&b, &f); /* the same pose */
    assert_int_equal(gl_mesh_uploads(b.meshes).bytes, QUAD_BYTES + 5 * INSTANCE_BYTES);
    f.desc.shading = FACET_SHADING_GLTF;
    bench_close(&b);
    fixture_destroy(&f);
}

/* Nothing for another camera; only instances for another pose. */
static void frames_upload_only_changes(void **state)
{
    (void)state;
    static const float times[2] = {0.0f, 1.0f}, places[6] = {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f};
    static const scene_sampler sampler = {
        .key_count = 2, .times = times, .width = 3, .values = places, .interpolation = SCENE_LINEAR};
    static const scene_channel channel = {
        .kind = SCENE_TARGET_NODE, .offset = offsetof(scene_node, translation), .scale = 1.0f};
    static scene_animation animation = {.name = "",
                                        .channel_count = 1,
                                        .sampler_count = 1,
                                        .channels = &channel,
                                        .samplers = &sampler,
                                        .end_s = 1.0f};
    static const uint32_t first = 0;
    fixture f = fixture_create();
    fixture_place(&f,
                  fixture_add_quad(&f, fixture_add_material(&f, gl_fixture_unlit(1.0f, 0.0f, 0.0f, 1.0f))),
                  0.0f, 0.0f, 0.0f, 0.5f);
    f.scene->animations = &animation;
    f.scene->animation_count = 1;
    f.desc.pose = (facet_pose_desc){.animation_count = 1, .animations = &first};
    bench b = bench_open(&f);
    bench_update(&b, &f);
    assert_int_equal(gl_mesh_uploads(b.meshes).bytes, QUAD_BYTES + INSTANCE_BYTES);
    uint32_t array = only_batch(&b, GL_PASS_OPAQUE, 1)->vertex_array;
    for (int frame = 1; frame <= 3; frame++) {
        f.desc.pose.time_s = 0.25 * frame;
        bench_update(&b, &f);
        assert_int_equal(gl_mesh_uploads(b.meshes).bytes, QUAD_BYTES + (1 + frame) * INSTANCE_BYTES);
        const gl_batch *batch = only_batch(&b, GL_PASS_OPAQUE, 1);
        assert_int_equal(batch->vertex_array, array);
        assert_true(fabsf(batch->bounds_max[0] - (0.5f + 0.25f * (float)frame)) < 1e-5f);
    }
    bench_close(&b);
    fixture_destroy(&f);
}

/* Morph targets: only positions are streamed, into the previous frame's buffer. */
static void deformed_vertices_are_streamed(void **state)
{
    (void)state;
    static const float moves[12] = {0.0f, 0.5f, 0.0f, 0.0f, 0.5f, 0.0f, 0.0f, 0.5f, 0.0f, 0.0f, 0.5f, 0.0f};
    static const scene_morph_target target = {.positions = moves};
    static const float times[2] = {0.0f, 1.0f}, weights[2] = {0.25f, 1.0f}, rest[1] = {0.0f};
    static const scene_sampler sampler = {
        .key_count = 2, .times = times, .width = 1, .values = weights, .interpolation = SCENE_LINEAR};
    static const scene_channel channel = {.kind = SCENE_TARGET_WEIGHTS, .scale = 1.0f};
    static scene_animation animation = {.name = "",
                                        .channel_count = 1,
                                        .sampler_count = 1,
                                        .channels = &channel,
                                        .samplers = &sampler,
                                        .end_s = 1.0f};
    static const uint32_t first = 0;
    fixture f = fixture_create();
    uint32_t quad = fixture_add_quad(&f, fixture_add_material(&f, gl_fixture_unlit(1.0f, 1.0f, 0.0f, 1.0f)));
    fixture_primitive(&f, quad)->target_count = 1;
    fixture_primitive(&f, quad)->targets = &target;
    f.scene->meshes[quad].weight_count = 1;
    f.scene->meshes[quad].weights = rest;
    fixture_place(&f, quad, 0.0f, 0.0f, 0.0f, 0.5f);
    f.scene->animations = &animation;
    f.scene->animation_count = 1;
    f.desc.pose = (facet_pose_desc){.animation_count = 1, .animations = &first};
    bench b = bench_open(&f);
    bench_update(&b, &f);
    uint64_t before = gl_mesh_uploads(b.meshes).bytes;
    uint32_t buffer = only_batch(&b, GL_PASS_OPAQUE, 1)->vertices.streamed.buffer;
    assert_true(buffer != 0);
    for (int frame = 1; frame <= 3; frame++) {
        f.desc.pose.time_s = 0.3 * frame;
        bench_update(&b, &f);
        const gl_batch *batch = only_batch(&b, GL_PASS_OPAQUE, 1);
        assert_int_equal(batch->vertices.streamed.buffer, buffer);
        assert_int_equal(batch->vertices.streamed.arrays & 1u << GL_ATTRIBUTE_TEXCOORD, 0);
        assert_int_equal(batch->vertices.fixed.arrays, 1u << GL_ATTRIBUTE_TEXCOORD);
    }
    uint64_t frame_bytes = (gl_mesh_uploads(b.meshes).bytes - before) / 3;
    assert_int_equal(frame_bytes,
                     4 * (12 + 12) + INSTANCE_BYTES); /* with the normals, which belong to the pose, too */
    bench_close(&b);
    film preview = fixture_render(&f);
    for (int c = 0; c < contexts.count; c++) {
        film image = gl_fixture_render(&f, &contexts.items[c]);
        assert_true(gl_fixture_compare(&image, &preview, 0.3f).share < 0.01);
        film_destroy(&image);
    }
    film_destroy(&preview);
    fixture_destroy(&f);
}

/* Corners of a smooth sphere are shared except along its seam and at its poles. */
static void corners_are_welded(void **state)
{
    (void)state;
    static const unsigned char bumps[16] = {128, 128, 255, 255, 160, 128, 240, 255,
                                            128, 160, 240, 255, 96,  128, 240, 255};
    fixture f = fixture_create();
    scene_material m = scene_material_default();
    m.textures[SCENE_NORMAL_TEXTURE].texture = fixture_add_texture(&f, 2, 2, bumps);
    enum { COLUMNS = 32, VERTICES = (COLUMNS + 1) * (COLUMNS / 2 + 1), CORNERS = 6 * COLUMNS * COLUMNS / 2 };
    fixture_place(&f, fixture_add_sphere(&f, COLUMNS, fixture_add_material(&f, m)), 0.0f, 0.0f, 0.0f, 0.9f);
    bench b = bench_open(&f);
    bench_update(&b, &f);
    const gl_batch *batch = only_batch(&b, GL_PASS_OPAQUE, 1);
    assert_true(batch->geometry->has_corner_tangents);
    assert_int_equal(batch->element_count, CORNERS);
    assert_true(batch->vertices.fixed.count >= VERTICES - 2 * COLUMNS);
    assert_true(batch->vertices.fixed.count < VERTICES + 4 * COLUMNS);
    bench_close(&b);
    fixture_destroy(&f);
}

/* ---- limits ---- */

static void meshes_beyond_2_gib_are_refused(void **state)
{
    (void)state;
    static const float nothing[4] = {0.0f};
    static const uint32_t index[3] = {0};
    assert_int_equal(gl_context_make_current(&contexts.items[0], NULL), FACET_OK);
    scene_material material = scene_material_default();
    scene_primitive primitive = {.mode = SCENE_TRIANGLES,
                                 .vertex_count = 200000000u, /* nothing of it is read */
                                 .index_count = 3,
                                 .indices = index,
                                 .positions = nothing,
                                 .normals = nothing};
    render_geometry g = {
        .primitive = &primitive, .material = &material, .positions = nothing, .normals = nothing};
    gl_vertex_store store = {.context = &contexts.items[0], .source = "huge.glb"};
    gl_vertex_use use;
    facet_error error = {0};
    assert_int_equal(gl_vertex_store_use(&store, &g, &use, &error), FACET_ERROR_LIMIT);
    assert_string_equal(error.message,
                        "huge.glb: a mesh has 4800000000 bytes of vertices; OpenGL draws at most 2147483647");
    primitive.vertex_count = 1;
    primitive.index_count = 900000000u;
    assert_int_equal(gl_vertex_store_use(&store, &g, &use, &error), FACET_ERROR_LIMIT);
    assert_string_equal(error.message,
                        "huge.glb: a mesh has 3600000000 bytes of indices; OpenGL draws at most 2147483647");
    primitive.index_count = 3; /* the store remains usable */
    assert_int_equal(gl_vertex_store_use(&store, &g, &use, &error), FACET_OK);
    assert_int_equal(use.elements.count, 3);
    gl_vertex_store_destroy(&store);
    gl_context_release(&contexts.items[0]);
}

static void the_material_selects_texture_coordinates(void **state)
{
    (void)state;
    scene_material material = scene_material_default();
    uint32_t sets[GL_TEXCOORD_SETS];
    material.textures[SCENE_NORMAL_TEXTURE] = (scene_texture_ref){.texture = 0, .texcoord = 3};
    assert_true(gl_texcoord_sets(&material, sets));
    assert_int_equal(gl_texcoord_attribute(&material, 3), 3);
    material.textures[SCENE_BASE_COLOR_TEXTURE] = (scene_texture_ref){.texture = 0, .texcoord = 6};
    assert_true(gl_texcoord_sets(&material, sets));
    assert_int_equal(gl_texcoord_attribute(&material, 6), 0);
    assert_int_equal(gl_texcoord_attribute(&material, 3), 1);
    assert_int_equal(gl_texcoord_attribute(&material, 0), GL_TEXCOORD_SETS);
    for (int slot = 0; slot < 5; slot++)
        material.textures[slot] = (scene_texture_ref){.texture = 0, .texcoord = 2 + (uint32_t)slot};
    assert_false(gl_texcoord_sets(&material, sets));
}

/* ---- images ---- */

static void assert_as_preview(const fixture *f, double mean, double share)
{
    film preview = fixture_render((fixture *)(uintptr_t)f);
    for (int c = 0; c < contexts.count; c++) {
        film image = gl_fixture_render(f, &contexts.items[c]);
        image_difference d = gl_fixture_compare(&image, &preview, 0.1f);
        if (d.mean > mean || d.share > share)
            fail_msg("context %d: mean %g, share %g", c, d.mean, d.share);
        film_destroy(&image);
    }
    film_destroy(&preview);
}

/* A seventh set of texture coordinates is read in place of the first four. */
static void high_texture_coordinate_sets_are_read(void **state)
{
    (void)state;
    static const unsigned char texels[16] = {255, 0, 0,   255, 0,   255, 0, 255,
                                             0,   0, 255, 255, 255, 255, 0, 255};
    static const float other[8] = {0.9f, 0.1f, 0.1f, 0.1f, 0.9f, 0.9f, 0.1f, 0.9f};
    const float *sets[7];
    fixture f = fixture_create();
    scene_material m = gl_fixture_unlit(1.0f, 1.0f, 1.0f, 1.0f);
    m.textures[SCENE_BASE_COLOR_TEXTURE].texture = fixture_add_texture(&f, 2, 2, texels);
    m.textures[SCENE_BASE_COLOR_TEXTURE].texcoord = 6;
    uint32_t quad = fixture_add_quad(&f, fixture_add_material(&f, m));
    scene_primitive *p = fixture_primitive(&f, quad);
    for (int i = 0; i < 7; i++)
        sets[i] = i == 6 ? other : p->texcoords[0];
    p->texcoords = sets;
    p->texcoord_count = 7;
    fixture_place(&f, quad, 0.0f, 0.0f, 0.0f, 0.9f);
    assert_as_preview(&f, 2e-3, 0.0);
    fixture_destroy(&f);
}

/* Instances of one call render as separate meshes do, except for rounding that depends on the drawing order. */
static void instances_match_separate_meshes(void **state)
{
    (void)state;
    film images[2];
    for (int c = 0; c < contexts.count; c++) {
        for (int is_shared = 0; is_shared < 2; is_shared++) {
            fixture f = fixture_create();
            scene_material m = scene_material_default();
            uint32_t material = fixture_add_material(&f, m), mesh = 0;
            for (int i = 0; i < 9; i++) {
                if (i == 0 || !is_shared)
                    mesh = fixture_add_sphere(&f, 12, material);
                scene_node *node = fixture_place(&f, mesh, 0.6f * (float)(i % 3 - 1),
                                                 0.6f * (float)(i / 3 - 1), 0.1f * (float)i, 0.25f);
                node->scale[1] = 0.1f + 0.05f * (float)i;
            }
            bench b = bench_open(&f);
            bench_update(&b, &f);
            only_batch(&b, GL_PASS_OPAQUE, is_shared ? 1 : 9);
            bench_close(&b);
            images[is_shared] = gl_fixture_render(&f, &contexts.items[c]);
            fixture_destroy(&f);
        }
        assert_true(gl_fixture_compare(&images[0], &images[1], 1e-6f).share <= 0.0);
        film_destroy(&images[0]);
        film_destroy(&images[1]);
    }
}

static void mirrored_instances_are_culled_correctly(void **state)
{
    (void)state;
    for (int is_double_sided = 0; is_double_sided < 2; is_double_sided++) {
        fixture f = fixture_create();
        scene_material m = gl_fixture_unlit(0.9f, 0.5f, 0.1f, 1.0f);
        m.is_double_sided = is_double_sided;
        uint32_t quad = fixture_add_quad(&f, fixture_add_material(&f, m));
        for (int i = 0; i < 4; i++) {
            scene_node *node =
                fixture_place(&f, quad, i & 1 ? 0.5f : -0.5f, i & 2 ? 0.5f : -0.5f, 0.0f, 0.4f);
            if (i & 1)
                node->scale[0] = -0.4f; /* its front remains its front */
            if (i & 2)
                gl_fixture_turn(node, 0.0f, 1.0f, 0.0f, 0.0f); /* shows its back */
        }
        film image = gl_fixture_render(&f, &contexts.items[0]);
        for (int i = 0; i < 4; i++) {
            float shown = !(i & 2) || is_double_sided ? 1.0f : 0.0f;
            const float wanted[4] = {0.9f * shown, 0.5f * shown, 0.1f * shown, shown};
            gl_fixture_assert_pixel(&image, i & 1 ? 48 : 16, i & 2 ? 16 : 48, wanted, 1e-3f);
        }
        film_destroy(&image);
        assert_as_preview(&f, 1e-3, 0.0);
        fixture_destroy(&f);
    }
}

/* A nearby object is as steady far from the origin as at it. */
static void distant_objects_do_not_jitter(void **state)
{
    (void)state;
    fixture f = fixture_create();
    uint32_t sphere = fixture_add_sphere(&f, 24, fixture_add_material(&f, scene_material_default()));
    fixture_place(&f, sphere, 1048576.0f, 0.0f, -2097152.0f, 0.125f);
    f.camera = (facet_camera){
        .eye = {1048576.0f, 0.0f, -2097151.0f}, .target = {1048576.0f, 0.0f, -2097152.0f}, .fov_y_rad = 0.4f};
    film there = gl_fixture_render(&f, &contexts.items[0]);
    for (int i = 0; i < 3; i++)
        f.scene->nodes[0].translation[i] = 0.0;
    f.camera = (facet_camera){.eye = {0.0f, 0.0f, 1.0f}, .fov_y_rad = 0.4f};
    film here = gl_fixture_render(&f, &contexts.items[0]);
    assert_true(gl_fixture_compare(&there, &here, 2e-3f).share < 0.005);
    film_destroy(&there);
    film_destroy(&here);
    fixture_destroy(&f);
}

/* ---- points and lines ---- */

enum { SPRITES = 40 };

static fixture sprite_fixture(scene_mode mode, bool is_orthographic)
{
    static float positions[2 * SPRITES][3], colors[2 * SPRITES][4];
    for (int i = 0; i < 2 * SPRITES; i++) {
        float angle = 2.399963f * (float)i, radius = sqrtf((float)i / (2.0f * SPRITES));
        positions[i][0] = radius * cosf(angle);
        positions[i][1] = radius * sinf(angle);
        positions[i][2] = 0.8f * sinf(7.0f * angle);
        colors[i][0] = 0.5f + 0.5f * sinf(angle);
        colors[i][1] = 1.0f;
        colors[i][2] = (float)(i % 2);
        colors[i][3] = 1.0f;
    }
    fixture f = fixture_create();
    uint32_t mesh = fixture_add_sprites(&f, mode, positions[0], 2 * SPRITES,
                                        fixture_add_material(&f, gl_fixture_unlit(1.0f, 1.0f, 1.0f, 1.0f)));
    fixture_primitive(&f, mesh)->colors = colors[0];
    fixture_place(&f, mesh, 0.0f, 0.0f, 0.0f, 0.9f);
    f.desc.width = 96;
    f.desc.height = 72;
    f.desc.samples = 16; /* to resolve the widths */
    if (!is_orthographic)
        f.camera = (facet_camera){.eye = {0.2f, 0.1f, 1.9f}, .fov_y_rad = 1.0f};
    return f;
}

static void sprites_are_a_pixel_wide(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        fixture f = sprite_fixture(i & 1 ? SCENE_LINES : SCENE_POINTS, i & 2);
        film preview = fixture_render(&f);
        for (int c = 0; c < contexts.count; c++) {
            film image = gl_fixture_render(&f, &contexts.items[c]);
            double sums[2][4] = {{0.0}};
            for (size_t k = 0; k < 4 * 96 * 72; k++) {
                sums[0][k % 4] += (double)preview.layers[0].pixels[k];
                sums[1][k % 4] += (double)image.layers[0].pixels[k];
            }
            for (int k = 0; k < 4; k++) /* coverage, and colors between the ends */
                if (!(fabs(sums[1][k] / sums[0][k] - 1.0) < 0.02))
                    fail_msg("%d: channel %d: %g for %g", i, k, sums[1][k], sums[0][k]);
            image_difference d = gl_fixture_compare(&image, &preview, 0.25f);
            if (d.share > 0.02 || d.mean > 0.05)
                fail_msg("%d: share %g, mean %g", i, d.share, d.mean);
            film_destroy(&image);
        }
        film_destroy(&preview);
        fixture_destroy(&f);
    }
}

/* Lines with normals are lit, also those of mirrored nodes. */
static void lines_with_normals_are_lit(void **state)
{
    (void)state;
    fixture f = sprite_fixture(SCENE_LINES, false);
    static float normals[2 * SPRITES][3];
    for (int i = 0; i < 2 * SPRITES; i++)
        memcpy(normals[i], (float[3]){0.6f, i % 2 ? 0.0f : 0.6f, 0.8f}, sizeof normals[i]);
    fixture_primitive(&f, 0)->normals = normals[0];
    f.scene->materials[0] = scene_material_default();
    f.scene->materials[0].metallic = 0.0f;
    f.scene->nodes[0].scale[0] = -0.9f;
    scene_light light = {.name = "",
                         .type = SCENE_LIGHT_DIRECTIONAL,
                         .color = {1.0f, 1.0f, 1.0f},
                         .intensity = 3.0f,
                         .outer_cone_rad = 0.7f};
    fixture_add_light(&f, light, 0.0f, 0.0f, 0.0f);
    film preview = fixture_render(&f), image = gl_fixture_render(&f, &contexts.items[0]);
    double sums[2] = {0.0, 0.0};
    for (size_t k = 1; k < 4 * 96 * 72; k += 4) {
        sums[0] += (double)preview.layers[0].pixels[k];
        sums[1] += (double)image.layers[0].pixels[k];
    }
    if (!(fabs(sums[1] / sums[0] - 1.0) < 0.03))
        fail_msg("%g for %g", sums[1], sums[0]);
    film_destroy(&preview);
    film_destroy(&image);
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arrays_are_uploaded_once),
        cmocka_unit_test(frames_upload_only_changes),
        cmocka_unit_test(deformed_vertices_are_streamed),
        cmocka_unit_test(corners_are_welded),
        cmocka_unit_test(meshes_beyond_2_gib_are_refused),
        cmocka_unit_test(the_material_selects_texture_coordinates),
        cmocka_unit_test(high_texture_coordinate_sets_are_read),
        cmocka_unit_test(instances_match_separate_meshes),
        cmocka_unit_test(mirrored_instances_are_culled_correctly),
        cmocka_unit_test(distant_objects_do_not_jitter),
        cmocka_unit_test(sprites_are_a_pixel_wide),
        cmocka_unit_test(lines_with_normals_are_lit),
    };
    if (!gl_fixture_open(&contexts))
        return 77;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    gl_fixture_close(&contexts);
    return failed;
}
