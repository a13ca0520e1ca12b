/* Tests of foam_plane.h: normal distributions whatever the size and at all scales, the same for all
 * threads, without seams. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "ocean/foam_plane.h"

enum { SIZE = 128 };

static void make(foam_plane *p, uint32_t size, int which, uint32_t thread_count)
{
    *p = (foam_plane){.size = 0};
    assert_true(foam_plane_create(&(facet_allocator){.allocate = NULL}, size, p));
    (which ? foam_pattern_clouds : foam_pattern_cells)(p, thread_count);
}

static void values_are_normal(void **state)
{
    (void)state;
    for (uint32_t size = 16; size <= SIZE; size *= 2)
        for (int which = 0; which < 2; which++) {
            foam_plane p;
            make(&p, size, which, 2);
            double count = (double)size * size, below[3] = {0.0}, square = 0.0;
            for (size_t i = 0; i < (size_t)size * size; i++) {
                double v = (double)p.levels[0][i];
                square += v * v / count;
                for (int k = 0; k < 3; k++)
                    below[k] += (v < (double)k - 1.0) / count;
            }
            assert_near(square, 1.0, 0.03);
            assert_near(below[0], 0.15866, 0.01);
            assert_near(below[1], 0.5, 0.01);
            assert_near(below[2], 0.84134, 0.01);
            assert_near(p.hidden[p.level_count - 1], square, 0.01);
            foam_plane_destroy(&p);
        }
}

/* Across the seam neighbours differ by no more than elsewhere. */
static void fields_repeat(void **state)
{
    (void)state;
    for (int which = 0; which < 2; which++) {
        foam_plane p;
        make(&p, SIZE, which, 1);
        double inside = 0.0, seam = 0.0;
        for (size_t i = 0; i < SIZE; i++) {
            const float *row = p.levels[0] + i * SIZE, *first = p.levels[0] + i,
                        *last = p.levels[0] + i + (size_t)SIZE * (SIZE - 1);
            seam += fabs((double)(row[SIZE - 1] - row[0])) + fabs((double)(*last - *first));
            inside += fabs((double)(row[i] - row[(i + 1) % SIZE]));
        }
        assert_true(seam < 2.0 * 1.5 * inside);
        foam_plane_destroy(&p);
    }
}

static void threads_change_nothing(void **state)
{
    (void)state;
    for (int which = 0; which < 2; which++) {
        foam_plane a, b;
        make(&a, SIZE, which, 1);
        make(&b, SIZE, which, 3);
        assert_memory_equal(a.levels[0], b.levels[0], SIZE * SIZE * sizeof(float));
        foam_plane_destroy(&a);
        foam_plane_destroy(&b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(values_are_normal), cmocka_unit_test(fields_repeat),
                                       cmocka_unit_test(threads_change_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
