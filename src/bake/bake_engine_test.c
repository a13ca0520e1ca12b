/* bake_engine_test.c - cube maps as engines want them: mirrored for three.js, KTX 1 with harmonics for
 * Filament. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "bake/bake.h"
#include "tests/support/support.h"
#include "base/memory.h"

/* A cube map of two levels of which every texel of the first differs from all others: its direction. */
static facet_cube *make(void)
{
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    facet_environment *environment;
    facet_cube *c;
    facet_error error;
    const facet_bake_desc desc = {.lobe = FACET_LOBE_NONE, .size = 8, .level_count = 2};
    if (facet_environment_create_constant(white, NULL, &environment, &error) != FACET_OK ||
        facet_cube_bake(environment, &desc, &c, &error) != FACET_OK)
        fail_msg("%s", error.message);
    facet_environment_destroy(environment);
    for (uint32_t level = 0; level < 2; level++) {
        const int n = 8 >> level;
        for (uint32_t face = 0; face < 6; face++)
            for (int y = 0; y < n; y++)
                for (int x = 0; x < n; x++) {
                    double d[3];
                    cube_direction(face, (2.0 * x + 1.0) / n - 1.0, (2.0 * y + 1.0) / n - 1.0, d);
                    *cube_texel(&c->levels[level], face, x, y) =
                        (rgbx){(float)d[0], (float)d[1], (float)d[2], 0.0f};
                }
        cube_fill_borders(&c->levels[level]);
    }
    return c;
}

static void mirrored_cube_maps_flip_x(void **state)
{
    (void)state;
    facet_cube *c = make(), *m, *back;
    facet_error error;
    assert_int_equal(facet_cube_create_mirrored(c, NULL, &m, &error), FACET_OK);
    for (uint32_t level = 0; level < 2; level++) {
        const int n = 8 >> level;
        cube with_borders;
        for (uint32_t face = 0; face < 6; face++)
            for (int y = 0; y < n; y++)
                for (int x = 0; x < n; x++) {
                    const rgbx here = *cube_texel(&m->levels[level], face, x, y);
                    const rgbx there = *cube_texel(&c->levels[level], face, x, y);
                    assert_float_equal(here[0], -there[0], 0.0f);
                    assert_float_equal(here[1], there[1], 0.0f);
                    assert_float_equal(here[2], there[2], 0.0f);
                }
        /* Borders follow from the faces. */
        assert_int_equal(cube_create((uint32_t)n, NULL, &with_borders, &error), FACET_OK);
        const size_t size = 6 * (size_t)(n + 2) * (size_t)(n + 2) * sizeof(rgbx);
        memcpy(with_borders.texels, m->levels[level].texels, size);
        cube_fill_borders(&with_borders);
        assert_memory_equal(with_borders.texels, m->levels[level].texels, size);
        cube_destroy(&with_borders);
    }
    assert_int_equal(facet_cube_create_mirrored(m, NULL, &back, &error), FACET_OK);
    assert_memory_equal(back->levels[0].texels, c->levels[0].texels, 6 * 10 * 10 * sizeof(rgbx));
    assert_int_equal(facet_cube_get_level_count(back), 2);
    facet_cube_destroy(back);
    facet_cube_destroy(m);
    facet_cube_destroy(c);
}

static void ktx1_files_hold_harmonics(void **state)
{
    (void)state;
    static const float harmonics[9][3] = {{1.0f, 0.5f, -0.25f}, {0.1f}};
    facet_cube *c = make();
    unsigned char *bytes;
    size_t size;
    facet_error error;
    const facet_ktx1_desc desc = {.harmonics = harmonics};
    assert_int_equal(facet_cube_encode_ktx1(c, &desc, &bytes, &size, &error), FACET_OK);
    const char *value = (const char *)bytes + 64 + 4 + 3;
    assert_string_equal((const char *)bytes + 68, "sh");
    const char *first_lines = "1 0.5 -0.25\n0.1 0 0\n0 0 0\n";
    assert_memory_equal(value, first_lines, strlen(first_lines));
    assert_int_equal(bytes[36], 8); /* texels along an edge */
    assert_int_equal(bytes[56], 2); /* levels */
    mem_free(bytes);
    assert_int_equal(facet_cube_encode_ktx1(c, NULL, &bytes, &size, &error), FACET_OK);
    assert_int_equal(size, 64 + 2 * 4 + 6 * 4 * (64 + 16));
    mem_free(bytes);
    facet_cube_destroy(c);
}

/* Each call that memory may be refused at leaves nothing behind. */
static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    static const float harmonics[9][3];
    facet_cube *c = make();
    facet_error error;
    for (long n = 0; n < 3; n++) {
        failing_allocator failing = {.fail_at = n};
        const facet_allocator allocator = failing_allocator_get(&failing);
        facet_cube *m = c;
        assert_int_equal(facet_cube_create_mirrored(c, &allocator, &m, &error), FACET_ERROR_MEMORY);
        assert_null(m);
        assert_int_equal(failing.blocks, 0);
    }
    for (long n = 0; n < 2; n++) {
        failing_allocator failing = {.fail_at = n};
        const facet_ktx1_desc desc = {.allocator = failing_allocator_get(&failing), .harmonics = harmonics};
        unsigned char *bytes;
        size_t size;
        assert_int_equal(facet_cube_encode_ktx1(c, &desc, &bytes, &size, &error), FACET_ERROR_MEMORY);
        assert_null(bytes);
        assert_int_equal(failing.blocks, 0);
    }
    facet_cube_destroy(c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mirrored_cube_maps_flip_x),
        cmocka_unit_test(ktx1_files_hold_harmonics),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
