/* Tests of memory.h: alignment, overflow, budgets, arenas. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"

static void blocks_are_aligned_and_keep_their_size(void **state)
{
    (void)state;
    for (size_t size = 0; size < 300; size += 7) {
        unsigned char *block = mem_alloc(NULL, size, 3);
        assert_non_null(block);
        assert_int_equal((uintptr_t)block % 64, 0);
        assert_int_equal(mem_size(block), 3 * size);
        memset(block, 0xa5, 3 * size);
        unsigned char tail[MEM_TAIL]; /* the address sanitizer would report it */
        memcpy(tail, block + 3 * size, sizeof tail);
        block = mem_resize(block, 2 * size, 3);
        for (size_t i = 0; i < 3 * size; i++)
            assert_int_equal(block[i], 0xa5);
        mem_free(block);
    }
}

/* Blocks on huge pages, if the system has them. */
static void large_blocks_behave_like_small_ones(void **state)
{
    (void)state;
    for (size_t size = (size_t)4 << 20; size < (size_t)10 << 20; size += ((size_t)1 << 20) + 4001) {
        unsigned char *block = mem_alloc(NULL, size, 1);
        assert_non_null(block);
        assert_int_equal((uintptr_t)block % 64, 0);
        memset(block, 0x5a, size);
        unsigned char tail[MEM_TAIL];
        memcpy(tail, block + size, sizeof tail);
        block = mem_resize(block, size + 5, 1);
        assert_int_equal(block[0], 0x5a);
        assert_int_equal(block[size - 1], 0x5a);
        mem_free(block);
    }
}

static void sizes_that_overflow_are_refused(void **state)
{
    (void)state;
    assert_null(mem_alloc(NULL, SIZE_MAX, 2));
    assert_null(mem_alloc(NULL, SIZE_MAX / 2, 1));
    assert_null(mem_zalloc(NULL, SIZE_MAX - 8, 1));
    arena *a = arena_create(NULL);
    assert_null(arena_alloc(a, SIZE_MAX / 4, 8));
    arena_destroy(a);
}

static void budgets_are_not_exceeded(void **state)
{
    (void)state;
    facet_budget *budget;
    assert_int_equal(facet_budget_create(10000, &budget, NULL), FACET_OK);
    facet_allocator allocator = facet_budget_allocator(budget);
    void *first = mem_alloc(&allocator, 6000, 1);
    assert_non_null(first);
    assert_null(mem_alloc(&allocator, 6000, 1));
    mem_free(first);
    assert_int_equal(facet_budget_used_bytes(budget), 0);
    assert_true(facet_budget_peak_bytes(budget) >= 6000 && facet_budget_peak_bytes(budget) <= 10000);
    void *second = mem_alloc(&allocator, 9000, 1);
    assert_non_null(second);
    assert_null(mem_resize(second, 20000, 1));
    mem_free(second);
    facet_budget_destroy(budget);
}

static void memory_of_libraries_counts_against_a_budget(void **state)
{
    (void)state;
    facet_budget *budget;
    assert_int_equal(facet_budget_create(1000, &budget, NULL), FACET_OK);
    facet_allocator allocator = facet_budget_allocator(budget);
    assert_true(mem_account(&allocator, 900));
    assert_false(mem_account(&allocator, 101));
    assert_int_equal(facet_budget_used_bytes(budget), 900);
    assert_true(mem_account(&allocator, -900));
    assert_int_equal(facet_budget_used_bytes(budget), 0);
    assert_int_equal(facet_budget_peak_bytes(budget), 900);
    facet_budget_destroy(budget);
    assert_true(mem_account(NULL, 1 << 30)); /* no budget */
}

static void arena_blocks_do_not_overlap(void **state)
{
    (void)state;
    facet_budget *budget;
    assert_int_equal(facet_budget_create(0, &budget, NULL), FACET_OK);
    facet_allocator allocator = facet_budget_allocator(budget);
    arena *a = arena_create(&allocator);
    unsigned char *blocks[200];
    size_t sizes[200];
    for (size_t i = 0; i < 200; i++) {
        sizes[i] = i % 17 == 0 ? 50000 + i : 13 * i;
        blocks[i] = arena_alloc(a, sizes[i], 1);
        assert_int_equal((uintptr_t)blocks[i] % 16, 0);
        memset(blocks[i], (int)i, sizes[i]);
    }
    for (size_t i = 0; i < 200; i++)
        for (size_t k = 0; k < sizes[i]; k++)
            assert_int_equal(blocks[i][k], i & 0xff);
    assert_string_equal(arena_strdup(a, "kept"), "kept");
    arena_destroy(a);
    assert_int_equal(facet_budget_used_bytes(budget), 0);
    facet_budget_destroy(budget);
}

static void reserve_grows_and_keeps_elements(void **state)
{
    (void)state;
    uint32_t *items = NULL;
    size_t capacity = 0;
    for (uint32_t i = 0; i < 5000; i++) {
        assert_true(mem_reserve(NULL, (void **)&items, &capacity, i + 1, sizeof *items));
        items[i] = i;
    }
    for (uint32_t i = 0; i < 5000; i++)
        assert_int_equal(items[i], i);
    assert_true(capacity < 10000);
    mem_free(items);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_are_aligned_and_keep_their_size),
        cmocka_unit_test(large_blocks_behave_like_small_ones),
        cmocka_unit_test(sizes_that_overflow_are_refused),
        cmocka_unit_test(budgets_are_not_exceeded),
        cmocka_unit_test(memory_of_libraries_counts_against_a_budget),
        cmocka_unit_test(arena_blocks_do_not_overlap),
        cmocka_unit_test(reserve_grows_and_keeps_elements),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
