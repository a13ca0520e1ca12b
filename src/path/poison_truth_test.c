/* Invalid numbers stay out of the film: vertices, normals, texture coordinates, material parameters,
 * lights, environments with NaN, infinities and huge numbers. The image is complete, in time, finite
 * everywhere, and dropped samples are counted. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "ibl/environment.h"
#include "path/path_fixture.h"

static const float POISONS[] = {NAN, INFINITY, -INFINITY, FLT_MAX, -FLT_MAX, 1e30f, -1.0f, 1e-45f};
enum { POISON_COUNT = sizeof POISONS / sizeof *POISONS };

/* A floor under an area light, a sphere, sky and a light; the last mesh and material are the ones to be
 * poisoned. */
static fixture healthy(void)
{
    fixture f = truth_create();
    f.desc.width = f.desc.height = 16;
    f.desc.samples = 8;
    f.desc.path.filter = FACET_FILTER_BLACKMAN_HARRIS;
    f.desc.aovs = FACET_AOV_ALBEDO | FACET_AOV_NORMAL | FACET_AOV_VARIANCE | FACET_AOV_SAMPLES;
    truth_set_constant_sky(&f, 0.5f, 0.5f, 0.5f);
    truth_add_floor(&f, fixture_add_material(&f, truth_lambert(0.5f)), -1.0f, 4.0f);
    truth_add_ceiling(&f, fixture_add_material(&f, truth_emitter(2.0f)), 2.0f, 1.0f);
    scene_light point = {.name = "", .type = SCENE_LIGHT_POINT, .color = {1, 1, 1}, .intensity = 3.0f};
    fixture_add_light(&f, point, 1.0f, 3.0f, 1.0f);
    fixture_place(&f,
                  fixture_add_sphere(&f, 16, fixture_add_material(&f, truth_metal(0.9f, 0.8f, 0.7f, 0.4f))),
                  0.0f, 0.0f, 0.0f, 1.0f);
    truth_set_camera(&f, 60.0, 0.0f, 0.0f, 3.0f);
    return f;
}

/* Draws it; every number is finite, the image is not black, the samples add up. The number dropped. */
static uint64_t check_render(fixture *f, const char *what, int poison)
{
    film rendered;
    facet_render_stats stats;
    facet_error error = {0};
    if (truth_try_render(f, &rendered, &stats, &error) != FACET_OK)
        fail_msg("%s, poison %d: %s", what, poison, error.message);
    double sum = 0.0;
    for (uint32_t i = 0; i < rendered.layer_count; i++)
        for (size_t k = 0; k < (size_t)rendered.width * rendered.height * rendered.layers[i].channel_count;
             k++) {
            float v = rendered.layers[i].pixels[k];
            if (!isfinite(v))
                fail_msg("%s, poison %d: layer \"%s\" has a %g", what, poison, rendered.layers[i].name,
                         (double)v);
            sum += i == 0 ? fabs((double)v) : 0.0;
        }
    if (!(sum > 0.0))
        fail_msg("%s, poison %d: the image is black", what, poison);
    assert_true(stats.samples == (uint64_t)rendered.width * rendered.height * f->desc.samples);
    assert_true(stats.dropped_samples <= stats.samples);
    film_destroy(&rendered);
    return stats.dropped_samples;
}

static void valid_scenes_drop_no_sample(void **state)
{
    (void)state;
    fixture f = healthy();
    assert_int_equal(check_render(&f, "healthy", -1), 0);
    fixture_destroy(&f);
}

/* Readers make vertices finite; a renderer that is given others does not fall over. */
static void poisoned_vertices_stay_finite(void **state)
{
    (void)state;
    for (int poison = 0; poison < POISON_COUNT; poison++)
        for (int kind = 0; kind < 3; kind++) {
            fixture f = healthy();
            scene_primitive *p = fixture_primitive(&f, f.scene->mesh_count - 1);
            float *values = (float *)(uintptr_t)(kind == 0   ? p->positions
                                                 : kind == 1 ? p->normals
                                                             : p->texcoords[0]);
            /* Positions: finite numbers only (scene.h: "finite"; the pose leaves out what is too far). */
            if (kind == 0 && !isfinite(POISONS[poison])) {
                fixture_destroy(&f);
                continue;
            }
            for (uint32_t i = 0; i < p->vertex_count; i += 5)
                values[(kind == 2 ? 2 : 3) * i + i % 2] = POISONS[poison];
            check_render(&f, kind == 0 ? "positions" : kind == 1 ? "normals" : "texture coordinates", poison);
            fixture_destroy(&f);
        }
}

static void poisoned_materials_stay_finite(void **state)
{
    (void)state;
    static const size_t members[] = {
        offsetof(scene_material, base_color),
        offsetof(scene_material, base_color) + 3 * sizeof(float),
        offsetof(scene_material, metallic),
        offsetof(scene_material, perceptual_roughness),
        offsetof(scene_material, emissive),
        offsetof(scene_material, emissive_strength),
        offsetof(scene_material, ior),
        offsetof(scene_material, specular),
        offsetof(scene_material, specular_color),
        offsetof(scene_material, clearcoat),
        offsetof(scene_material, clearcoat_roughness),
        offsetof(scene_material, sheen_color),
        offsetof(scene_material, sheen_roughness),
        offsetof(scene_material, transmission),
        offsetof(scene_material, thickness),
        offsetof(scene_material, attenuation_distance),
        offsetof(scene_material, attenuation_color),
        offsetof(scene_material, iridescence),
        offsetof(scene_material, iridescence_ior),
        offsetof(scene_material, iridescence_thickness_maximum),
        offsetof(scene_material, anisotropy),
        offsetof(scene_material, anisotropy_rotation),
        offsetof(scene_material, dispersion),
        offsetof(scene_material, diffuse_transmission),
        offsetof(scene_material, diffuse_transmission_color),
        offsetof(scene_material, multiscatter_color),
        offsetof(scene_material, scatter_anisotropy),
    };
    uint64_t dropped = 0;
    for (size_t member = 0; member < sizeof members / sizeof *members; member++)
        for (int poison = 0; poison < POISON_COUNT; poison++) {
            fixture f = healthy();
            f.desc.samples = 4;
            scene_material *m = &f.scene->materials[f.scene->material_count - 1];
            m->metallic = 0.2f;
            m->extensions = SCENE_EMISSIVE_STRENGTH | SCENE_IOR | SCENE_SPECULAR | SCENE_CLEARCOAT |
                            SCENE_SHEEN | SCENE_TRANSMISSION | SCENE_VOLUME | SCENE_IRIDESCENCE |
                            SCENE_ANISOTROPY | SCENE_DISPERSION | SCENE_DIFFUSE_TRANSMISSION |
                            SCENE_VOLUME_SCATTER;
            m->transmission = m->clearcoat = m->iridescence = m->anisotropy = m->diffuse_transmission = 0.5f;
            m->clearcoat_roughness = m->sheen_roughness = 0.5f;
            m->thickness = m->attenuation_distance = 1.0f;
            m->dispersion = 0.3f;
            m->emissive[0] = 0.1f;
            for (int c = 0; c < 3; c++) {
                m->sheen_color[c] = m->multiscatter_color[c] = 0.5f;
                m->attenuation_color[c] = 0.6f;
            }
            memcpy((char *)m + members[member], &POISONS[poison], sizeof(float));
            char what[32];
            snprintf(what, sizeof what, "material, member %zu", member);
            dropped += check_render(&f, what, poison);
            fixture_destroy(&f);
        }
    print_message("%llu samples were dropped\n", (unsigned long long)dropped);
    assert_true(dropped > 0); /* an emission without end is counted */
}

static void poisoned_lights_stay_finite(void **state)
{
    (void)state;
    static const size_t members[] = {offsetof(scene_light, color), offsetof(scene_light, intensity),
                                     offsetof(scene_light, range), offsetof(scene_light, inner_cone_rad),
                                     offsetof(scene_light, outer_cone_rad)};
    for (int type = 0; type < 3; type++)
        for (size_t member = 0; member < sizeof members / sizeof *members; member++)
            for (int poison = 0; poison < POISON_COUNT; poison++) {
                fixture f = healthy();
                f.scene->lights[0].type = (scene_light_type)type;
                f.scene->lights[0].outer_cone_rad = 0.5f;
                memcpy((char *)&f.scene->lights[0] + members[member], &POISONS[poison], sizeof(float));
                check_render(&f, "light", poison);
                fixture_destroy(&f);
            }
}

/* Files of environments are limited when they are read; what is in memory behind that is not believed
 * either. */
static void poisoned_environments_stay_finite(void **state)
{
    (void)state;
    for (int poison = 0; poison < POISON_COUNT; poison++) {
        fixture f = healthy();
        truth_set_sky(&f, 16, truth_sky_halves);
        float *texels = f.environment->panorama.pixels;
        texels[3 * (8 * 32 + 5)] = POISONS[poison];
        texels[3 * (2 * 32 + 9) + 1] = POISONS[poison];
        environment_limit(f.environment, 1);
        check_render(&f, "environment", poison);
        f.desc.sun = (facet_sun){.elevation_rad = 1.0f, .illuminance_lux = {1.0f, POISONS[poison], 1.0f}};
        check_render(&f, "sun", poison);
        fixture_destroy(&f);
    }
}

/* A film counts samples that are not finite: a light of the largest float in a mirror that doubles. */
static void paths_end(void **state)
{
    (void)state;
    /* Two lossless mirrors without an exit: the path ends at any requested depth. */
    fixture f = truth_create();
    f.desc.width = f.desc.height = 4;
    f.desc.samples = 4;
    f.desc.path.max_depth = UINT32_MAX;
    truth_add_box(&f, fixture_add_material(&f, truth_metal(1.0f, 1.0f, 1.0f, 0.0f)), 0.0f, -1.0f, -1.0f,
                  -1.0f);
    f.camera = (facet_camera){.eye = {0.1f, 0.2f, 0.3f}, .target = {0.7f, 0.5f, -0.4f}, .fov_y_rad = 1.0f};
    facet_render_stats stats;
    film rendered = truth_render(&f, &stats);
    for (size_t i = 0; i < 64; i++)
        assert_true(isfinite(rendered.layers[0].pixels[i]));
    film_destroy(&rendered);
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(valid_scenes_drop_no_sample),       cmocka_unit_test(poisoned_vertices_stay_finite),
        cmocka_unit_test(poisoned_materials_stay_finite),    cmocka_unit_test(poisoned_lights_stay_finite),
        cmocka_unit_test(poisoned_environments_stay_finite), cmocka_unit_test(paths_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
