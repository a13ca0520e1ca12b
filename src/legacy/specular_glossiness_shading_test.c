/* specular_glossiness_shading_test.c - a specular-glossiness material and its conversion are shaded
 * equally, to the last bit. */
#include "legacy/convert_test_support.h"

#include "shade/shade.h"

static vec3 load(const float c[3])
{
    return vec3(c[0], c[1], c[2]);
}

static Surface surface_of(const scene_material *m)
{
    vec3 N = vec3(0.0f, 0.0f, 1.0f);
    if (m->extensions & SCENE_SPECULAR_GLOSSINESS)
        return surface_from_specular_glossiness(N, load(m->base_color), load(m->specular_color),
                                                m->glossiness, 1.0f, vec3(0.0f));
    return surface_from_gltf(N, load(m->base_color), m->metallic, m->perceptual_roughness, m->ior,
                             m->specular, load(m->specular_color), 1.0f, vec3(0.0f));
}

static vec3 direction(float angle)
{
    return vec3(sin(angle), 0.0f, cos(angle));
}

static void shading_is_equal(void **state)
{
    (void)state;
    facet_scene *scene = gltf_scene(1);
    scene_material before = scene_material_default();
    before.extensions = SCENE_SPECULAR_GLOSSINESS;
    set_color(before.base_color, .6f, .3f, .2f);
    set_color(before.specular_color, .3f, .2f, .1f);
    before.glossiness = .7f;
    scene->materials[0] = before;
    convert(scene, &(facet_legacy_desc){0});
    assert_false(scene->materials[0].extensions & SCENE_SPECULAR_GLOSSINESS);
    Surface a = surface_of(&before);
    Surface b = surface_of(&scene->materials[0]);
    bool is_seen = false;
    for (int i = 0; i < 5; i++)
        for (int j = -5; j < 6; j++) {
            vec3 V = direction((float)i * 0.3f);
            vec3 L = direction((float)j * 0.28f);
            vec3 x = surface_brdf_cos(a, V, L);
            vec3 y = surface_brdf_cos(b, V, L);
            for (int k = 0; k < 3; k++)
                assert_true(x[k] == y[k]);
            is_seen = is_seen || x[0] > 0.1f;
        }
    assert_true(is_seen);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(shading_is_equal)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
