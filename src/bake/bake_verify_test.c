/* bake_verify_test.c - cube maps against the reference: of real environments, and the reference's own word. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "bake/bake_fixture.h"

#include "bake/bake_reference.h"
#include "bake/bake_area.h"
#include "tests/support/support.h"

static void small_lights(const float d[3], float out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = 0.2f + (d[k] > 0.95f ? 40.0f : 0.0f) + 0.1f * d[(k + 1) % 3];
}

/* The reported error is the one that was added to the cube map. */
static void added_errors_are_found(void **state)
{
    (void)state;
    facet_environment *e = make_environment(IS_SLOW ? 64 : 128, IS_SLOW ? 32 : 64, small_lights);
    facet_bake_desc desc = {.size = 16, .level_count = 3, .rotation_rad = 1.0f};
    facet_cube *c = bake(e, desc);
    facet_cube_error before[3], after[3];
    assert_int_equal(facet_cube_verify(c, e, &desc, before, NULL), FACET_OK);
    for (uint32_t level = 0; level < 3; level++) {
        print_message("level %u: RMS %.2e, largest %.2e, energy %.6f of %u texels\n", level,
                      before[level].rms, before[level].max, before[level].energy, before[level].texels);
        assert_int_equal(before[level].texels, texel_count(&c->levels[level]));
        assert_true(before[level].rms < (level ? 2e-3 : 1e-2));
        assert_near(before[level].energy, 1.0, 2e-3); /* sums over few texels */
        for (uint32_t i = 0; i < texel_count(&c->levels[level]); i++)
            for (int k = 0; k < 3; k++)
                ((float *)(uintptr_t)texel_of(&c->levels[level], i))[k] *= 1.05f;
        ((float *)(uintptr_t)texel_of(&c->levels[level], 7))[0] += 1000.0f;
    }
    assert_int_equal(facet_cube_verify(c, e, &desc, after, NULL), FACET_OK);
    for (uint32_t level = 0; level < 3; level++) {
        double n = 3.0 * texel_count(&c->levels[level]);
        double root = 1000.0 / after[level].max; /* mean square of the reference, nearly */
        double expected = sqrt(0.05 * 0.05 + 1000.0 * 1000.0 / n / (root * root));
        assert_near(after[level].rms / expected, 1.0, 0.05);
        assert_true(after[level].energy > 1.04);
    }
    facet_error error;
    desc.level_count = 2;
    assert_int_equal(facet_cube_verify(c, e, &desc, after, &error), FACET_ERROR_ARGUMENT);
    facet_cube_destroy(c);
    facet_environment_destroy(e);
}

static double rms_of(facet_environment *e, facet_bake_desc desc)
{
    facet_cube *c = bake(e, desc);
    facet_cube_error errors[3];
    assert_int_equal(facet_cube_verify(c, e, &desc, errors, NULL), FACET_OK);
    facet_cube_destroy(c);
    return fmax(errors[1].rms, errors[2].rms);
}

static void sampling_converges(void **state)
{
    (void)state;
    facet_environment *e = make_environment(128, 64, small_lights);
    facet_bake_desc desc = {.method = FACET_BAKE_METHOD_SAMPLING, .size = 16, .level_count = 3};
    double rms[3];
    for (int i = 0; i < 3; i++) {
        desc.samples = 64u << (4 * i);
        rms[i] = rms_of(e, desc);
        print_message("%u samples: RMS %.2e\n", desc.samples, rms[i]);
    }
    assert_true(rms[1] < 0.4 * rms[0] && rms[2] < 0.5 * rms[1] && rms[1] < 0.02 && rms[2] < 0.006);
    facet_environment_destroy(e);
}

/* The reference itself is the lobe's: of bands 1 and 2 (by quadrature), and of the method that
 * fills whole levels. */
static void the_reference_filters_with_the_lobe(void **state)
{
    (void)state;
    facet_environment *e = make_environment(64, 32, small_lights);
    for (int lobe = 0; lobe < 3; lobe++) {
        facet_bake_desc desc = {
            .lobe = (facet_lobe)lobe, .method = FACET_BAKE_METHOD_REFERENCE, .size = 8, .level_count = 3};
        facet_cube *c = bake(e, desc);
        facet_cube_error errors[3];
        assert_int_equal(facet_cube_verify(c, e, &desc, errors, NULL), FACET_OK);
        for (uint32_t level = lobe ? 0 : 1; level < 3; level++)
            assert_true(errors[level].rms < 1e-6);
        facet_cube_destroy(c);
    }
    facet_environment_destroy(e);
}

/* In real environments harmonics are within 1 % of the reference, from smooth to diffuse. */
static void check_real(facet_environment *e, const char *name, facet_bake_desc desc, uint32_t count)
{
    facet_cube *c = bake(e, desc);
    bake_source source;
    bake_reference reference;
    desc.level_count = c->level_count;
    assert_int_equal(bake_source_create(e, &desc, &source, NULL), FACET_OK);
    assert_int_equal(bake_reference_create(&source, NULL, &reference, NULL), FACET_OK);
    for (uint32_t level = 0; level < c->level_count; level++) {
        const cube *texels = &c->levels[level];
        bake_reference_lobe lobe;
        bool is_sharp = bake_level_is_sharp(c, level);
        if (!is_sharp) {
            bake_lobe made = bake_lobe_create(c->lobe, c->roughness[level]);
            bake_reference_set_lobe(&made, &lobe);
        }
        double square = 0.0;
        double whole = 0.0;
        for (uint32_t i = 0; i < count; i++) {
            uint32_t n = texels->size;
            uint32_t texel = (uint32_t)((uint64_t)texel_count(texels) * (i * 2654435761u) >> 32);
            double d[3], expected[3];
            texel_direction(texels, texel, d);
            if (is_sharp)
                bake_reference_average(&reference, bake_sharp_is_interpolated(&source, n), n, texel / n / n,
                                       texel % n, texel / n % n, expected);
            else
                bake_reference_gather(&reference, &lobe, d, expected);
            for (int k = 0; k < 3; k++) {
                double error = (double)texel_of(texels, texel)[k] - expected[k];
                square += error * error;
                whole += expected[k] * expected[k];
            }
        }
        double mean[3];
        cube_mean(texels, mean);
        double rms = sqrt(square / whole);
        print_message("%s, %u of %u levels, lobe %d, roughness %.3f: RMS %.3f %%, energy %.5f\n", name, level,
                      c->level_count, (int)c->lobe, (double)c->roughness[level], 100.0 * rms,
                      mean[1] / source.mean[1]);
        assert_true(rms < 0.01);
        assert_near(mean[1] / source.mean[1], 1.0, texels->size < 8 ? 5e-3 : 2e-3);
    }
    bake_reference_destroy(&reference);
    bake_source_destroy(&source);
    facet_cube_destroy(c);
}

static void real_environments_are_baked_accurately(void **state)
{
    (void)state;
    static const char *const names[3] = {"leadenhall_market_1k", "qwantani_afternoon_puresky_1k",
                                         "studio_small_03_1k"};
    const char *folder = test_data();
    for (int i = 0; i < (IS_SLOW ? 1 : 3); i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/env/%s.hdr", folder, names[i]);
        facet_environment *e = NULL;
        assert_int_equal(facet_environment_load(path, NULL, &e, NULL), FACET_OK);
        check_real(e, names[i], (facet_bake_desc){.size = 256}, 32);
        if (i < 2)
            check_real(e, names[i],
                       (facet_bake_desc){.size = 256, .mapping = FACET_ROUGHNESS_MAPPING_FILAMENT}, 32);
        check_real(e, names[i], (facet_bake_desc){.size = 64, .level_count = 3, .lobe = FACET_LOBE_LAMBERT},
                   16);
        if (i == 1)
            check_real(e, names[i],
                       (facet_bake_desc){.size = 32, .level_count = 3, .lobe = FACET_LOBE_CHARLIE}, 16);
        if (i == 1)
            check_real(e, names[i],
                       (facet_bake_desc){
                           .size = 1024, .level_count = 9, .mapping = FACET_ROUGHNESS_MAPPING_FILAMENT},
                       16);
        facet_environment_destroy(e);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(added_errors_are_found),
        cmocka_unit_test(sampling_converges),
        cmocka_unit_test(the_reference_filters_with_the_lobe),
        cmocka_unit_test(real_environments_are_baked_accurately),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
