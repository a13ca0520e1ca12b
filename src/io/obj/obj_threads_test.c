/* Large files: the same scene with any number of threads and wherever the text is cut, and the right one. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/support/support.h"
#include "io/obj/obj_test_support.h"

enum { WIDTH = 330 };

typedef struct growing {
    char *bytes;
    size_t length, room;
} growing;

static void add(growing *g, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void add(growing *g, const char *format, ...)
{
    if (g->room - g->length < 1024) {
        g->room = 2 * g->room + (1 << 16);
        g->bytes = realloc(g->bytes, g->room);
        assert_non_null(g->bytes);
    }
    va_list arguments;
    va_start(arguments, format);
    int written = vsnprintf(g->bytes + g->length, g->room - g->length, format, arguments);
    va_end(arguments);
    assert_true(written >= 0 && written < 1024);
    g->length += (size_t)written;
}

static double height(int x, int y)
{
    return 3.0 * sin(0.05 * x) * cos(0.07 * y);
}

/* A sheet of WIDTH x WIDTH vertices in several objects and materials, with all kinds of statements in
 * turn. */
static char *make_sheet(const char *head)
{
    growing g = {0};
    add(&g, "%s", head);
    for (int y = 0; y < WIDTH; y++) {
        if (y % 100 == 0)
            add(&g, "o rows %d\n", y);
        for (int x = 0; x < WIDTH; x++) {
            add(&g, "v %d %.5f %d", x, height(x, y), y);
            add(&g, (x + y) % 5 ? "\n" : " 0.5 0.25 %.2f\n", 0.01 * (x % 100));
            add(&g, "vt %.4f %.4f\nvn 0 1 %.3f\n", x / 330.0, y / 330.0, 0.001 * x);
        }
        for (int x = 0; y > 0 && x + 1 < WIDTH; x++) {
            int a = (y - 1) * WIDTH + x + 1;
            int b = a + WIDTH;
            if (x % 50 == 0)
                add(&g, "usemtl m%d\ns %d\n", x / 100, x / 50 % 3);
            if (y % 7 == 3)
                add(&g, "f %d/%d/%d %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a, a, b, b, b, b + 1, b + 1, b + 1,
                    a + 1, a + 1, a + 1);
            else if (y % 7 == 4)
                add(&g, "f %d %d %d\nf %d// %d %d\n", a, b, b + 1, a, b + 1, a + 1);
            else if (y % 7 == 5)
                add(&g, "f %d//%d %d//%d \\\n %d//%d\nf %d/1 %d/2 %d/3\n", a, a, b, b, b + 1, b + 1, a, b + 1,
                    a + 1);
            else if (x % 3 == 0 && x + 2 < WIDTH && y % 7 == 6) {
                add(&g, "f %d %d %d %d %d %d\n", a, b, b + 1, b + 2, a + 2, a + 1);
                x++;
            } else
                add(&g, "f %d %d %d %d\n", x - 2 * WIDTH, x - WIDTH, x - WIDTH + 1, x - 2 * WIDTH + 1);
        }
        if (y % 50 == 1)
            add(&g, "l %d %d -1\np 1\nf 0 0 0\ng%s\nv nan 0 0\nv 0 0 0\n", y, y + 1, y % 100 ? " x" : "");
    }
    return g.bytes;
}

static facet_scene *load(const char *bytes, uint32_t threads, facet_obj_normals normals)
{
    const facet_scene_desc desc = {.thread_count = threads, .obj_normals = normals};
    return obj_load_text(bytes, &desc);
}

static void results_do_not_depend_on_threads(void **state)
{
    (void)state;
    static const uint32_t threads[] = {2, 3, 7};
    char *bytes = make_sheet("# sheet\nmtllib none.mtl\n");
    for (int normals = 0; normals < 3; normals += IS_SLOW ? 2 : 1) {
        facet_scene *expected = load(bytes, 1, (facet_obj_normals)normals);
        assert_true(expected->mesh_count >= 4);
        for (size_t i = 0; i < sizeof threads / sizeof *threads; i++) {
            facet_scene *scene = load(bytes, threads[i], (facet_obj_normals)normals);
            obj_assert_equal(scene, expected);
            scene_destroy(scene);
        }
        scene_destroy(expected);
    }
    free(bytes);
}

/* Wherever pieces of the text begin. */
static void results_do_not_depend_on_chunks(void **state)
{
    (void)state;
    facet_scene *expected = NULL;
    for (int shift = 0; shift < 60; shift += IS_SLOW ? 21 : 7) {
        char head[128];
        snprintf(head, sizeof head, "#%*s\n", shift, "");
        char *bytes = make_sheet(head);
        facet_scene *scene = load(bytes, 2, FACET_OBJ_NORMALS_AUTO);
        free(bytes);
        if (!expected) {
            expected = scene;
            continue;
        }
        obj_assert_equal(scene, expected);
        scene_destroy(scene);
    }
    scene_destroy(expected);
}

/* One primitive that is processed in blocks: each corner has the position, texture coordinate and normal
 * of the file, and no vertex exists twice. */
static void blocks_of_a_large_primitive_share_vertices(void **state)
{
    (void)state;
    enum { EDGE = IS_SLOW ? 200 : 400 };
    growing g = {0};
    for (int i = 0; i < EDGE * EDGE; i++) {
        int k = (int)((int64_t)i * 7919 % (EDGE * EDGE)); /* positions in no order */
        add(&g, "v %d %d 1\nvt %d 0\n", k % EDGE, k / EDGE, i);
    }
    add(&g, "vn 1 0 0\nvn 0 1 0\n");
    uint32_t *numbers = malloc(sizeof *numbers * EDGE * EDGE);
    assert_non_null(numbers);
    for (int i = 0; i < EDGE * EDGE; i++)
        numbers[(int64_t)i * 7919 % (EDGE * EDGE)] = (uint32_t)i;
    for (int y = 0; y + 1 < EDGE; y++)
        for (int x = 0; x + 1 < EDGE; x++) {
            uint32_t a = numbers[y * EDGE + x] + 1;
            uint32_t b = numbers[y * EDGE + x + 1] + 1;
            uint32_t c = numbers[(y + 1) * EDGE + x] + 1;
            add(&g, "f %u/%u/%d %u/%u/1 %u/%u/1\n", a, a, 1 + (x & y & 1), b, b, c, c);
        }
    facet_scene *scene = load(g.bytes, 2, FACET_OBJ_NORMALS_AUTO);
    const scene_primitive *p = obj_only_primitive(scene);
    assert_int_equal(p->index_count, 3 * (EDGE - 1) * (EDGE - 1));
    size_t corner = 0;
    for (int y = 0; y + 1 < EDGE; y++)
        for (int x = 0; x + 1 < EDGE; x++)
            for (int k = 0; k < 3; k++, corner++) {
                const float *at = obj_position(p, corner);
                int column = x + (k == 1);
                int row = y + (k == 2);
                assert_true(at[0] == (float)column && at[1] == (float)row);
                assert_true(obj_texcoord(p, corner)[0] == (float)numbers[row * EDGE + column]);
                assert_true(obj_normal(p, corner)[k == 0 && (x & y & 1)] == 1.0f);
            }
    /* All vertices but the last one; those with odd x and y have two normals, unless no other triangle
     * uses them. */
    size_t twice = 0;
    for (int y = 1; y + 1 < EDGE; y += 2)
        for (int x = 1; x + 1 < EDGE; x += 2)
            twice++;
    assert_int_equal(p->vertex_count, EDGE * EDGE - 1 + twice);
    scene_destroy(scene);
    free(numbers);
    free(g.bytes);
}

/* Memory that runs out now and then among several threads. */
static void failed_allocations_are_reported(void **state)
{
    (void)state;
    char *bytes = make_sheet("");
    size_t size = strlen(bytes);
    long calls = 1;
    for (long at = 0; at < calls; at += 1 + at / (IS_SLOW ? 2 : 6)) {
        failing_allocator failing = {.fail_at = at};
        const facet_scene_desc desc = {.allocator = failing_allocator_get(&failing), .thread_count = 3};
        facet_scene *scene = NULL;
        facet_error error = {0};
        facet_result result = obj_load_memory(bytes, size, "test.obj", &desc, &scene, &error);
        assert_true(result == FACET_OK || (result == FACET_ERROR_MEMORY && !scene && error.message[0]));
        calls = atomic_load(&failing.calls) > calls ? atomic_load(&failing.calls) : calls;
        scene_destroy(scene);
        assert_int_equal(atomic_load(&failing.blocks), 0);
    }
    free(bytes);
}

/* At most three times the memory of the scene, for a file of one large mesh. */
static void memory_is_three_times_the_scene_at_most(void **state)
{
    (void)state;
    enum { EDGE = 500 };
    growing g = {0};
    for (int i = 0; i < EDGE * EDGE; i++)
        add(&g, "v %d %d %d\nvt %d %d\nvn 0 0 1\n", i % EDGE, i / EDGE, i % 7, i % EDGE, i / EDGE);
    for (int i = 1; i < EDGE * (EDGE - 1); i++)
        add(&g, "f %d/%d/%d %d/%d/%d %d/%d/%d\nf %d/%d/%d %d/%d/%d %d/%d/%d\n", i, i, i, i + 1, i + 1, i + 1,
            i + EDGE, i + EDGE, i + EDGE, i + 1, i + 1, i + 1, i + EDGE + 1, i + EDGE + 1, i + EDGE + 1,
            i + EDGE, i + EDGE, i + EDGE);
    facet_budget *budget = NULL;
    assert_int_equal(facet_budget_create(0, &budget, NULL), FACET_OK);
    const facet_scene_desc desc = {.allocator = facet_budget_allocator(budget), .thread_count = 2};
    facet_scene *scene = obj_load_text(g.bytes, &desc);
    double kept = (double)facet_budget_used_bytes(budget);
    double peak = (double)facet_budget_peak_bytes(budget);
    if (peak > 3.5 * kept)
        fail_msg("the peak is %.2f times the memory of the scene", peak / kept);
    scene_destroy(scene);
    facet_budget_destroy(budget);
    free(g.bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(results_do_not_depend_on_threads),
        cmocka_unit_test(results_do_not_depend_on_chunks),
        cmocka_unit_test(blocks_of_a_large_primitive_share_vertices),
        cmocka_unit_test(failed_allocations_are_reported),
        cmocka_unit_test(memory_is_three_times_the_scene_at_most),
    };
    return cmocka_run_group_tests_name("obj_threads", tests, NULL, NULL);
}
