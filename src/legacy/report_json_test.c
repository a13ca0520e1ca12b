/* report_json_test.c - members, order and summary of the report. */
#include "legacy/convert_test_support.h"

static char *report_of(const facet_scene *scene)
{
    text t = {.allocator = scene->allocator};
    legacy_report_json(scene, &t);
    assert_false(t.has_failed);
    char *copy = test_malloc(t.length + 1);
    memcpy(copy, t.data, t.length + 1);
    text_destroy(&t);
    return copy;
}

/* A report with all of those members, in that order. */
static void assert_in_order(const char *report, const char *const *parts)
{
    const char *at = report;
    for (; *parts; parts++) {
        const char *found = strstr(at, *parts);
        if (!found)
            fail_msg("%s is not in, or not where it should be in\n%s", *parts, report);
        at = found + strlen(*parts);
    }
}

static legacy_material of(const char *name, float diffuse, float specular, float shininess)
{
    legacy_material m = legacy_material_default();
    m.name = name;
    m.fields = LEGACY_DIFFUSE | LEGACY_SPECULAR | LEGACY_SHININESS | LEGACY_ILLUM;
    set_color(m.diffuse, diffuse, diffuse, diffuse);
    set_color(m.specular, specular, specular, specular);
    m.shininess = shininess;
    m.illum = 2;
    return m;
}

static void materials_are_listed_worst_first(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(4);
    scene->legacy->materials[0] = of("matte \"x\"", .8f, 0, 10);
    scene->legacy->materials[1] = of("rubber", .01f, .4f, 10);
    scene->legacy->materials[2] = of("kept", .01f, .4f, 10);
    scene->legacy->materials[2].is_gltf_restored = true;
    scene->legacy->materials[3] = of("plastic", .55f, .7f, 32);
    for (uint32_t i = 0; i < 4; i++)
        scene->materials[i].name = scene->legacy->materials[i].name;
    convert(scene, &(facet_legacy_desc){0});
    char *report = report_of(scene);
    const char *const order[] = {"\"to\":\"metallic-roughness\"",
                                 "\"light_scale\":3.14159",
                                 "\"materials\":[",
                                 "\"material\":\"rubber\"",
                                 "\"index\":1",
                                 "\"source\":\"mtl\"",
                                 "\"method\":\"closed\"",
                                 "\"profile\":\"specular+ior\"",
                                 "\"in\":{\"Kd\":[0.01,0.01,0.01]",
                                 "\"Ks\":[0.4,0.4,0.4]",
                                 "\"Ns\":10",
                                 "\"illum\":2",
                                 "\"dialect\":\"spec\"",
                                 "\"colors\":\"linear\"",
                                 "\"out\":{\"baseColor\":[",
                                 "\"metallic\":0",
                                 "\"roughness\":",
                                 "\"specularFactor\":",
                                 "\"specularColor\":",
                                 "\"ior\":0",
                                 "\"extensions\":[\"KHR_materials_ior\",\"KHR_materials_specular\"]",
                                 "\"error\":{\"E\":",
                                 "\"E_disp\":",
                                 "\"E_drawn\":",
                                 "\"naive_E\":",
                                 "\"core_E\":",
                                 "\"views\":[",
                                 "\"grade\":\"",
                                 "\"light_scale\":3.14159",
                                 "\"warnings\":[",
                                 "\"material\":\"plastic\"",
                                 "\"warnings\":[{\"code\":\"energy-gain\",\"text\":\"",
                                 "\"material\":\"matte \\\"x\\\"\"",
                                 "\"grade\":\"good\"",
                                 "\"material\":\"kept\"",
                                 "\"error\":{\"E\":null",
                                 "\"grade\":null",
                                 "\"warnings\":[{\"code\":\"legacy-light-pi\"",
                                 "\"code\":\"color-space-assumed\"",
                                 "\"summary\":{\"materials\":4",
                                 "\"grades\":{\"good\":1",
                                 "\"none\":1}",
                                 "\"mean_E\":0.",
                                 "\"worst\":{\"material\":\"rubber\",\"index\":1,\"E\":",
                                 NULL};
    assert_in_order(report, order);
    test_free(report);
    scene_destroy(scene);
}

static void the_other_directions_are_reported(void **state)
{
    (void)state;
    facet_scene *scene = gltf_scene(1);
    scene->materials[0].metallic = 0;
    convert_to(scene, FACET_MATERIAL_MODEL_OGL1, &(facet_legacy_desc){0});
    char *report = report_of(scene);
    const char *const ogl1[] = {"\"to\":\"ogl1\"",      "\"source\":\"metallic-roughness\"",
                                "\"profile\":\"ogl1\"", "\"in\":{\"baseColor\":[1,1,1,1]",
                                "\"out\":{\"Kd\":[",    "\"colors\":\"srgb\"",
                                "\"core_E\":null",      NULL};
    assert_in_order(report, ogl1);
    test_free(report);
    convert_to(scene, FACET_MATERIAL_MODEL_SPECULAR_GLOSSINESS, &(facet_legacy_desc){0});
    report = report_of(scene);
    const char *const glossy[] = {"\"to\":\"specular-glossiness\"",
                                  "\"method\":\"exact\"",
                                  "\"in\":{\"baseColor\":[1,1,1,1]",
                                  "\"out\":{\"diffuse\":[1,1,1,1]",
                                  "\"glossiness\":0",
                                  "\"E\":0,",
                                  NULL};
    assert_in_order(report, glossy);
    test_free(report);
    scene_destroy(scene);
}

static void scenes_without_materials_are_reported(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(0);
    convert(scene, &(facet_legacy_desc){0});
    char *report = report_of(scene);
    const char *const parts[] = {"\"materials\":[]", "\"summary\":{\"materials\":0", "\"mean_E\":null",
                                 "\"worst\":null", NULL};
    assert_in_order(report, parts);
    test_free(report);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(materials_are_listed_worst_first),
        cmocka_unit_test(the_other_directions_are_reported),
        cmocka_unit_test(scenes_without_materials_are_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
