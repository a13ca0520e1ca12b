/* plot_api_test.c - plots, through the public headers only. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "facet/facet.h"

/* A metal, a glossy paint of the specular-glossiness kind, and cloth under a coat. */
static const char materials[] =
    "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_materials_sheen\",\"KHR_materials_"
    "clearcoat\","
    "\"KHR_materials_iridescence\",\"KHR_materials_anisotropy\",\"KHR_materials_specular\",\"KHR_materials_"
    "ior\"],"
    "\"materials\":["
    "{\"name\":\"gold\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0.75,0.25,1],\"roughnessFactor\":0."
    "25}},"
    "{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.5},\"extensions\":{"
    "\"KHR_materials_specular\":{\"specularFactor\":0.5,\"specularColorFactor\":[1,0.5,0.25]},"
    "\"KHR_materials_ior\":{\"ior\":1.25},"
    "\"KHR_materials_sheen\":{\"sheenColorFactor\":[0.5,0.25,0.125],\"sheenRoughnessFactor\":0.75},"
    "\"KHR_materials_clearcoat\":{\"clearcoatFactor\":1,\"clearcoatRoughnessFactor\":0.125},"
    "\"KHR_materials_iridescence\":{\"iridescenceFactor\":0.5,\"iridescenceIor\":1.75,"
    "\"iridescenceThicknessMinimum\":100,\"iridescenceThicknessMaximum\":500},"
    "\"KHR_materials_anisotropy\":{\"anisotropyStrength\":0.5,\"anisotropyRotation\":0.25}}}]}";

static facet_scene *load(void)
{
    facet_scene *scene = NULL;
    facet_error error = {0};
    if (facet_scene_load_memory(materials, strlen(materials), "materials.gltf", NULL, &scene, &error) !=
        FACET_OK)
        fail_msg("%s", error.message);
    return scene;
}

static void expect(const float *values, size_t count, const float *expected)
{
    for (size_t i = 0; i < count; i++)
        assert_float_equal(values[i], expected[i], 1e-6f);
}

static void factors_are_taken_from_scenes(void **state)
{
    (void)state;
    facet_scene *scene = load();
    facet_plot_material m;
    assert_int_equal(facet_plot_material_from_scene(scene, 0, FACET_PLOT_MODEL_PBR, &m, NULL), FACET_OK);
    assert_string_equal(m.label, "gold");
    expect(m.base_color, 3, (float[]){1, 0.75f, 0.25f});
    expect(&m.metallic, 1, (float[]){1});
    expect(&m.perceptual_roughness, 1, (float[]){0.25f});
    expect(&m.clearcoat, 1, (float[]){0});
    assert_int_equal(facet_plot_material_from_scene(scene, 1, FACET_PLOT_MODEL_PBR, &m, NULL), FACET_OK);
    assert_null(m.label);
    expect(&m.ior, 1, (float[]){1.25f});
    expect(&m.specular, 1, (float[]){0.5f});
    expect(m.specular_color, 3, (float[]){1, 0.5f, 0.25f});
    expect(m.sheen_color, 3, (float[]){0.5f, 0.25f, 0.125f});
    expect(&m.sheen_roughness, 1, (float[]){0.75f});
    expect(&m.clearcoat, 1, (float[]){1});
    expect(&m.clearcoat_roughness, 1, (float[]){0.125f});
    expect(&m.iridescence, 1, (float[]){0.5f});
    expect(&m.iridescence_ior, 1, (float[]){1.75f});
    expect(&m.iridescence_thickness_nm, 1, (float[]){500});
    expect(&m.anisotropy, 1, (float[]){0.5f});
    expect(&m.anisotropy_rotation_rad, 1, (float[]){0.25f});
    facet_scene_destroy(scene);
}

static void what_a_scene_has_not_is_refused(void **state)
{
    (void)state;
    facet_scene *scene = load();
    facet_plot_material m;
    facet_error error;
    assert_int_equal(facet_plot_material_from_scene(scene, 2, FACET_PLOT_MODEL_PBR, &m, &error),
                     FACET_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "material 2"));
    assert_int_equal(facet_plot_material_from_scene(scene, 0, FACET_PLOT_MODEL_OGL1, &m, &error),
                     FACET_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "OpenGL 1"));
    assert_int_equal(facet_plot_material_from_scene(scene, 0, FACET_PLOT_MODEL_MERL, &m, &error),
                     FACET_ERROR_ARGUMENT);
    facet_scene_destroy(scene);
}

/* A conversion puts an OpenGL 1 material beside each. */
static void converted_materials_are_taken(void **state)
{
    (void)state;
    facet_scene *scene = load();
    facet_plot_material m;
    facet_error error = {0};
    if (facet_scene_convert_materials(scene, FACET_MATERIAL_MODEL_OGL1, NULL, NULL, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_int_equal(facet_plot_material_from_scene(scene, 0, FACET_PLOT_MODEL_OGL1, &m, &error), FACET_OK);
    assert_int_equal(m.model, FACET_PLOT_MODEL_OGL1);
    assert_string_equal(m.label, "gold");
    assert_true(m.shininess > 20.0f && m.shininess <= 128.0f);
    assert_true(m.ogl1_specular[0] > 0.9f && m.ogl1_specular[0] <= 1.0f);
    facet_scene_destroy(scene);
}

/* The numbers of the vignette's plots, as text; every format, or a sentence that says why not. */
static void plots_are_files(void **state)
{
    (void)state;
    unsigned char *bytes;
    size_t size;
    facet_error error = {0};
    if (facet_plot_encode(NULL, FACET_PLOT_FORMAT_CSV, &bytes, &size, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_true(size > 1000);
    assert_non_null(strstr((const char *)bytes, "phi"));
    facet_bytes_destroy(bytes);
    for (int format = 0; format <= FACET_PLOT_FORMAT_CSV; format++) {
        static const char *const magic[] = {"<?xml", "%PDF-", "\x89PNG", ""};
        facet_plot_desc desc = {.kind = FACET_PLOT_KIND_TONE};
        facet_result result = facet_plot_encode(&desc, (facet_plot_format)format, &bytes, &size, &error);
        if (result == FACET_ERROR_SYSTEM) { /* no cairo: CSV does without */
            assert_int_not_equal(format, FACET_PLOT_FORMAT_CSV);
            assert_null(bytes);
            continue;
        }
        if (result != FACET_OK)
            fail_msg("%s", error.message);
        assert_memory_equal(bytes, magic[format], strlen(magic[format]));
        facet_bytes_destroy(bytes);
    }
    assert_int_equal(facet_plot_encode(NULL, (facet_plot_format)17, &bytes, &size, &error),
                     FACET_ERROR_ARGUMENT);
    assert_null(bytes);
    assert_int_equal(facet_plot_encode(&(facet_plot_desc){.kind = (facet_plot_kind)-1}, FACET_PLOT_FORMAT_CSV,
                                       &bytes, &size, &error),
                     FACET_ERROR_ARGUMENT);
    assert_null(bytes);
    assert_int_equal(size, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(factors_are_taken_from_scenes),
        cmocka_unit_test(what_a_scene_has_not_is_refused),
        cmocka_unit_test(converted_materials_are_taken),
        cmocka_unit_test(plots_are_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
