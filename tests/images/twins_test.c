/* twins_test.c - models whose images should be equal: compressed and plain, instanced and expanded, in
 * either material model, embedded and packed; and variants and times whose images should differ. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "model_image.h"

static const view FRAMED = {0};

static facet_scene *load(const char *path)
{
    facet_scene *scene = model_load(path);
    if (!scene)
        skip();
    return scene;
}

static model_image render_model(const char *path)
{
    facet_scene *scene = load(path);
    model_image p = model_image_render(scene, &FRAMED, NULL);
    facet_scene_destroy(scene);
    return p;
}

static double distance_between(const char *a, const char *b)
{
    model_image p = render_model(a), q = render_model(b);
    double distance = model_image_distance(&p, &q);
    print_message("%s and %s: %.2g apart\n", a, b, distance);
    model_image_destroy(&p);
    model_image_destroy(&q);
    return distance;
}

/* ---- other encodings ---- */

/* The box has integer coordinates, which every quantisation preserves; its normals are along the axes. */
static void compressed_boxes_look_like_the_plain_one(void **state)
{
    (void)state;
    assert_true(distance_between("core/Box.glb", "extensions/Box_Draco.glb") < 1e-3);
    assert_true(distance_between("core/Box.glb", "extensions/BoxMeshopt.glb") < 1e-3);
}

static void embedded_models_look_like_the_packed_ones(void **state)
{
    (void)state;
    assert_true(distance_between("animation/SimpleMorph.glb", "gltf/SimpleMorph-embedded.gltf") < 1e-6);
    assert_true(distance_between("core/TextureSettingsTest.glb", "gltf/TextureSettingsTest-embedded.gltf") <
                1e-6);
}

/* Rows of cubes, 4 m apart: the first is uncompressed, the others are compressed in four ways. In an
 * orthographic view the cubes of a column look equal; filters quantise colors and normals to 8 bits and
 * fewer. */
static void all_compressions_of_a_cube_look_alike(void **state)
{
    (void)state;
    facet_scene *scene = load("extensions/MeshoptCubeTest/MeshoptCubeTest.gltf");
    static const float tilts[2] = {0.0f, 0.7f};
    for (int column = 0; column < 5; column++)
        for (int tilt = 0; tilt < 2; tilt++) {
            model_image first = {0};
            for (int row = 0; row < 5; row++) {
                float x = 4.0f * (float)column, y = 16.0f - 4.0f * (float)row, away = tilts[tilt];
                facet_camera camera = {
                    .eye = {x + 5 * away, y + 5 * away, 10}, .target = {x, y, 0}, .ortho_height = 2.4f};
                model_image p = model_image_render(scene, &FRAMED, &(facet_render_desc){.camera = &camera});
                if (row == 0)
                    first = p;
                else if (model_image_distance(&first, &p) > 0.02)
                    fail_msg("column %d, row %d: %g from the plain one", column, row,
                             model_image_distance(&first, &p));
                if (row > 0)
                    model_image_destroy(&p);
            }
            model_image_destroy(&first);
        }
    facet_scene_destroy(scene);
}

/* Brushed metal with a normal map under a scaled node, seen from proportionally farther: its relief has the
 * same depth. */
static void scaled_nodes_look_the_same(void **state)
{
    (void)state;
    const char *path = "materials/CompareAnisotropy.glb", *name = "\"name\":\"Spheroid002\"";
    facet_scene *plain = load(path);
    facet_scene *large = model_load_edited(path, name, "\"scale\":[2,2,2]");
    facet_scene *small = model_load_edited(path, name, "\"scale\":[0.1,0.1,0.1]");
    model_image one = model_image_render(plain, &(view){.x = 0.5f, .height = 0.5f}, NULL),
                two = model_image_render(large, &(view){.x = 0.5f, .height = 1}, NULL),
                tenth = model_image_render(small, &(view){.x = 0.5f, .height = 0.05f}, NULL);
    assert_true(model_image_pixels(&one, -1) > one.count / 5);
    assert_true(model_image_distance(&one, &two) < 1e-3);
    assert_true(model_image_distance(&one, &tenth) < 0.02); /* rounding at its edges */
    model_image_destroy(&one);
    model_image_destroy(&two);
    model_image_destroy(&tenth);
    facet_scene_destroy(plain);
    facet_scene_destroy(large);
    facet_scene_destroy(small);
}

/* ---- instances ---- */

/* SimpleInstancing's 125 instances as nodes: translations, rotations and scales at these offsets of its
 * buffer. */
static char *write_nodes(const unsigned char *glb)
{
    enum { COUNT = 125, ROOM = COUNT * 256 };
    const unsigned char *bin = glb + 20 + (glb[12] | glb[13] << 8) + 8;
    static const size_t offsets[3] = {720, 2220, 4220};
    char *text = malloc(ROOM);
    assert_non_null(text);
    int n = snprintf(text, ROOM, "\"nodes\":[{\"children\":[");
    for (int i = 1; i <= COUNT; i++)
        n += snprintf(text + n, (size_t)(ROOM - n), "%d%s", i, i < COUNT ? "," : "]}");
    for (size_t i = 0; i < COUNT; i++) {
        float t[3], r[4], s[3];
        memcpy(t, bin + offsets[0] + 12 * i, 12);
        memcpy(r, bin + offsets[1] + 16 * i, 16);
        memcpy(s, bin + offsets[2] + 12 * i, 12);
        n += snprintf(text + n, (size_t)(ROOM - n),
                      ",{\"mesh\":0,\"translation\":[%.9g,%.9g,%.9g],\"rotation\":[%.9g,%.9g,%.9g,%.9g],"
                      "\"scale\":[%.9g,%.9g,%.9g]}",
                      (double)t[0], (double)t[1], (double)t[2], (double)r[0], (double)r[1], (double)r[2],
                      (double)r[3], (double)s[0], (double)s[1], (double)s[2]);
    }
    snprintf(text + n, (size_t)(ROOM - n), "]");
    return text;
}

static void instances_look_like_nodes(void **state)
{
    (void)state;
    const char *path = "extensions/SimpleInstancing.glb";
    size_t size;
    unsigned char *bytes = model_read(path, &size);
    if (!bytes)
        skip();
    char *nodes = write_nodes(bytes);
    facet_scene *instanced = load(path);
    facet_scene *spelled =
        model_load_edited(path,
                          "\"nodes\":[{\"extensions\":{\"EXT_mesh_gpu_instancing\":{"
                          "\"attributes\":{\"TRANSLATION\":3,\"ROTATION\":4,\"SCALE\":5}}},"
                          "\"mesh\":0}]",
                          nodes);
    assert_int_equal(facet_scene_get_counts(spelled).instances, 125);
    model_image a = model_image_render(instanced, &FRAMED, NULL),
                b = model_image_render(spelled, &FRAMED, NULL);
    uint32_t covered = 0;
    for (uint32_t i = 0; i < a.count; i++)
        covered += a.rgba[4 * i + 3] > 0.5f;
    assert_true(covered > a.count / 3);
    assert_true(model_image_distance(&a, &b) < 1e-4);
    model_image_destroy(&a);
    model_image_destroy(&b);
    facet_scene_destroy(instanced);
    facet_scene_destroy(spelled);
    free(nodes);
    free(bytes);
}

/* ---- materials ---- */

/* The same avocado in two material models. Its textures were authored separately (one has a
 * reflectance other than 0.04 in places), so that the images are similar, not equal. */
static void both_material_models_describe_the_avocado(void **state)
{
    (void)state;
    double distance = distance_between("core/Avocado.glb", "specgloss/Avocado-specgloss.glb");
    assert_true(distance > 1e-3 && distance < 0.15);
}

/* Every variant assigns another material to the shoe; the fabric and the wood of the chair change, its metal
 * and label do not. Without a variant the primitive's own material is drawn, here that of the first. */
static void variants_change_only_mapped_materials(void **state)
{
    (void)state;
    facet_scene *shoe = load("materials/MaterialsVariantsShoe.glb");
    model_image shoes[4];
    for (uint32_t i = 0; i < 4; i++) {
        facet_render_desc desc = {.pose = {.has_variant = i < 3, .variant = i}};
        shoes[i] = model_image_render(shoe, &FRAMED, &desc);
        assert_int_equal(model_image_pixels(&shoes[i], i < 3 ? (int)i : 0),
                         model_image_pixels(&shoes[i], -1));
    }
    for (int i = 0; i < 3; i++)
        assert_true(model_image_distance(&shoes[i], &shoes[(i + 1) % 3]) > 0.1);
    assert_true(model_image_distance(&shoes[0], &shoes[3]) == 0.0);
    for (int i = 0; i < 4; i++)
        model_image_destroy(&shoes[i]);
    facet_scene_destroy(shoe);

    facet_scene *chair = load("materials/SheenChair.glb");
    facet_render_desc desc = {.pose = {.has_variant = true, .variant = 0}};
    model_image mango = model_image_render(chair, &FRAMED, &desc);
    desc.pose.variant = 1;
    model_image peacock = model_image_render(chair, &FRAMED, &desc);
    assert_int_equal(model_image_pixels(&mango, 0), model_image_pixels(&peacock, 4));
    assert_int_equal(model_image_pixels(&mango, 1), model_image_pixels(&peacock, 5));
    assert_true(model_image_pixels(&mango, 4) == 0 && model_image_pixels(&peacock, 0) == 0);
    assert_true(model_image_mean(&mango, 0, 0) > 3.0 * model_image_mean(&mango, 0, 2));
    assert_true(model_image_mean(&peacock, 4, 2) > 1.5 * model_image_mean(&peacock, 4, 0));
    model_image_destroy(&mango);
    model_image_destroy(&peacock);
    facet_scene_destroy(chair);
}

/* Copper, by a JPEG of its color; brushed and dented, by KTX2 files. */
static void jpeg_and_ktx2_textures_mix_in_a_model(void **state)
{
    (void)state;
    model_image lamp = render_model("extensions/AnisotropyBarnLamp-ktx2/AnisotropyBarnLamp.gltf");
    assert_true(model_image_pixels(&lamp, -1) > lamp.count / 5);
    assert_true(model_image_mean(&lamp, -1, 0) > 1.3 * model_image_mean(&lamp, -1, 2));
    assert_true(model_image_detail(&lamp, -1) > 0.03);
    model_image_destroy(&lamp);
}

/* ---- motion ---- */

static model_image render_at(const facet_scene *scene, uint32_t animation, double time_s)
{
    facet_orbit orbit = facet_orbit_default();
    orbit.azimuth_rad = 0.9f;
    facet_camera camera;
    assert_int_equal(facet_camera_from_orbit(scene, NULL, &orbit, 1, &camera, NULL), FACET_OK);
    facet_render_desc desc = {.camera = &camera,
                              .pose = {.animation_count = 1, .animations = &animation, .time_s = time_s}};
    return model_image_render(scene, &FRAMED, &desc);
}

/* Models move, and these clips are loops. */
static void animated_models_move_and_loops_close(void **state)
{
    (void)state;
    static const struct {
        const char *path;
        uint32_t animation;
    } cases[] = {
        {"animation/Fox.glb", 0},          {"animation/Fox.glb", 1},
        {"animation/Fox.glb", 2},          {"animation/AnimatedTriangle.glb", 0},
        {"animation/BoxAnimated.glb", 0},  {"animation/AnimatedMorphCube.glb", 0},
        {"animation/RiggedSimple.glb", 0}, {"animation/SimpleMorph.glb", 0},
        {"animation/SimpleSkin.glb", 0},   {"animation/MorphStressTest.glb", 1},
        {"lights/LightVisibility.glb", 0}, {"animation/AnimatedColorsCube.glb", 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        facet_scene *scene = load(cases[i].path);
        facet_animation a = facet_scene_get_animation(scene, cases[i].animation);
        double length = a.end_s - a.begin_s;
        assert_true(length > 0.0);
        model_image begin = render_at(scene, cases[i].animation, a.begin_s),
                    some = render_at(scene, cases[i].animation, a.begin_s + 0.31 * length),
                    end = render_at(scene, cases[i].animation, a.end_s);
        if (!(model_image_distance(&begin, &some) > 0.05) || !(model_image_distance(&begin, &end) < 1e-4))
            fail_msg("%s, animation %s: %g after 31 %%, %g at the end", cases[i].path, a.name,
                     model_image_distance(&begin, &some), model_image_distance(&begin, &end));
        model_image_destroy(&begin);
        model_image_destroy(&some);
        model_image_destroy(&end);
        facet_scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(compressed_boxes_look_like_the_plain_one),
        cmocka_unit_test(embedded_models_look_like_the_packed_ones),
        cmocka_unit_test(all_compressions_of_a_cube_look_alike),
        cmocka_unit_test(scaled_nodes_look_the_same),
        cmocka_unit_test(instances_look_like_nodes),
        cmocka_unit_test(both_material_models_describe_the_avocado),
        cmocka_unit_test(variants_change_only_mapped_materials),
        cmocka_unit_test(jpeg_and_ktx2_textures_mix_in_a_model),
        cmocka_unit_test(animated_models_move_and_loops_close),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
