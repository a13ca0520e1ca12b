/* bvh_tree_test.c - trees are complete, tight, of bounded depth, the same for every number of threads, whatever the items. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "cpu/bvh_tree.h"

enum { MANY = 150000, FEW = 3000 };

static const facet_allocator ALLOCATOR = {0};

static float uniform(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) * (1.0f / 16777216.0f);
}

/* ---- items ---- */

typedef void make_item(uint32_t i, uint32_t *state, bvh_item *item);

static void set_box(bvh_item *item, const float center[3], float size)
{
    for (int k = 0; k < 3; k++) {
        item->lo[k] = center[k] - size;
        item->hi[k] = center[k] + size;
    }
}

static void scattered(uint32_t i, uint32_t *state, bvh_item *item)
{
    (void)i;
    const float center[3] = {uniform(state), uniform(state), 0.1f * uniform(state)};
    set_box(item, center, 0.01f * uniform(state) * uniform(state));
}

static void in_one_place(uint32_t i, uint32_t *state, bvh_item *item)
{
    (void)state;
    set_box(item, (float[3]){1.0f, 2.0f, 3.0f}, (float)(i % 7));
}

/* Each is twice as far out as the last: a tree by area alone is a chain. */
static void in_a_chain(uint32_t i, uint32_t *state, bvh_item *item)
{
    (void)state;
    const float at = ldexpf(1.0f, -(int)(i % 120));
    set_box(item, (float[3]){at, at, 0.0f}, 0.1f * at);
}

static void huge(uint32_t i, uint32_t *state, bvh_item *item)
{
    (void)i;
    const float center[3] = {1e18f * uniform(state), -1e18f * uniform(state), 1e18f * uniform(state)};
    set_box(item, center, 4e17f);
}

static void tiny(uint32_t i, uint32_t *state, bvh_item *item)
{
    (void)state;
    set_box(item, (float[3]){FLT_MIN * (float)(i % 3), 1e-45f * (float)(i % 5), 0.0f}, 0.0f);
}

static void mixed(uint32_t i, uint32_t *state, bvh_item *item)
{
    static make_item *const kinds[] = {scattered, in_one_place, huge, tiny};
    kinds[i % 4](i, state, item);
}

static make_item *const makers[] = {scattered, in_one_place, in_a_chain, huge, tiny, mixed};
enum { MAKERS = sizeof makers / sizeof *makers };

static bvh_item *make_items(make_item *make, uint32_t count)
{
    uint32_t state = 5;
    bvh_item *items = test_malloc(count * sizeof *items);
    for (uint32_t i = 0; i < count; i++) {
        items[i] = (bvh_item){.geometry = i / 1000, .primitive = i};
        make(i, &state, &items[i]);
        assert_true(bvh_item_is_valid(&items[i]));
    }
    return items;
}

/* ---- trees ---- */

typedef struct survey {
    const bvh_tree *tree;
    const bvh_item *items;
    uint8_t *seen; /* per primitive */
    uint32_t count, depth;
} survey;

static void assert_encloses(const bvh_child *child, const float lo[3], const float hi[3])
{
    for (int k = 0; k < 3; k++)
        assert_true(child->lo[k] <= lo[k] && child->hi[k] >= hi[k]);
}

static void visit(survey *s, const bvh_child *child, uint32_t depth)
{
    s->depth = depth > s->depth ? depth : s->depth;
    if (!bvh_is_leaf(child->child)) {
        assert_true((uint32_t)child->child < s->tree->node_count);
        const bvh_node *node = &s->tree->nodes[child->child];
        for (int i = 0; i < 2; i++) {
            assert_true(bvh_is_leaf(node->children[i].child) || node->children[i].child > child->child);
            assert_encloses(child, node->children[i].lo, node->children[i].hi);
            visit(s, &node->children[i], depth + 1);
        }
        return;
    }
    const uint32_t count = bvh_leaf_count(child->child);
    assert_in_range(count, 1, BVH_LEAF_ITEMS);
    for (uint32_t i = 0; i < count; i++) {
        const bvh_item *item = &s->items[bvh_leaf_first(child->child) + i];
        assert_encloses(child, item->lo, item->hi);
        assert_false(s->seen[item->primitive]);
        s->seen[item->primitive] = 1;
        s->count++;
    }
}

static void trees_have_every_item_once(void **state)
{
    (void)state;
    static const uint32_t counts[] = {1, 4, 5, 9, FEW, MANY};
    for (int kind = 0; kind < MAKERS; kind++)
        for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
            bvh_item *items = make_items(makers[kind], counts[i]);
            bvh_tree tree;
            assert_int_equal(bvh_tree_build(items, counts[i], 2, &ALLOCATOR, &tree, NULL), FACET_OK);
            survey s = {.tree = &tree, .items = items, .seen = test_calloc(counts[i], 1)};
            visit(&s, &tree.root, 0);
            assert_int_equal(s.count, counts[i]);
            assert_in_range(s.depth, 0, BVH_MAX_DEPTH);
            test_free(s.seen);
            bvh_tree_destroy(&tree);
            test_free(items);
        }
}

static void threads_do_not_change_trees(void **state)
{
    (void)state;
    for (int kind = 0; kind < MAKERS; kind++) {
        bvh_item *items[2];
        bvh_tree trees[2];
        for (int i = 0; i < 2; i++) {
            items[i] = make_items(makers[kind], MANY);
            assert_int_equal(bvh_tree_build(items[i], MANY, i ? 7 : 1, &ALLOCATOR, &trees[i], NULL),
                             FACET_OK);
        }
        assert_int_equal(trees[0].node_count, trees[1].node_count);
        assert_memory_equal(&trees[0].root, &trees[1].root, sizeof trees[0].root);
        assert_memory_equal(trees[0].nodes, trees[1].nodes, trees[0].node_count * sizeof *trees[0].nodes);
        assert_memory_equal(items[0], items[1], MANY * sizeof *items[0]);
        for (int i = 0; i < 2; i++) {
            bvh_tree_destroy(&trees[i]);
            test_free(items[i]);
        }
    }
}

static void items_that_no_ray_hits_are_invalid(void **state)
{
    (void)state;
    const float bad[] = {NAN, INFINITY, -INFINITY, 2e18f, -2e18f};
    for (int k = 0; k < 3; k++)
        for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
            bvh_item item = {.lo = {0, 0, 0}, .hi = {1, 1, 1}};
            assert_true(bvh_item_is_valid(&item));
            item.lo[k] = bad[i];
            assert_false(bvh_item_is_valid(&item));
            item.lo[k] = 0.0f;
            item.hi[k] = bad[i];
            assert_false(bvh_item_is_valid(&item));
        }
}

static void no_items_are_an_empty_tree(void **state)
{
    (void)state;
    bvh_tree tree;
    bvh_item none;
    facet_error error;
    assert_int_equal(bvh_tree_build(&none, 0, 2, &ALLOCATOR, &tree, NULL), FACET_OK);
    assert_int_equal(tree.root.child, BVH_EMPTY);
    assert_int_equal(tree.node_count, 0);
    bvh_tree_destroy(&tree);
    assert_int_equal(bvh_tree_build(&none, (size_t)BVH_MAX_ITEMS + 1, 2, &ALLOCATOR, &tree, &error),
                     FACET_ERROR_LIMIT);
    assert_string_equal(error.message,
                        "bounding volume hierarchy: 268435457 triangles; at most 268435456 are supported");
}

/* The area of all boxes over that of the root: what rays pay. A tree of halves in the order of the items has a value of
 * some 10 000. */
static float cost_of(const bvh_tree *tree, const bvh_child *child)
{
    float d[3];
    for (int k = 0; k < 3; k++)
        d[k] = child->hi[k] - child->lo[k];
    float sum = d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
    for (int i = 0; i < 2 && !bvh_is_leaf(child->child); i++)
        sum += cost_of(tree, &tree->nodes[child->child].children[i]);
    return sum;
}

static void boxes_are_small(void **state)
{
    (void)state;
    bvh_item *items = make_items(scattered, MANY);
    bvh_tree tree;
    assert_int_equal(bvh_tree_build(items, MANY, 2, &ALLOCATOR, &tree, NULL), FACET_OK);
    bvh_child leafless = tree.root;
    leafless.child = -1;
    const float cost = cost_of(&tree, &tree.root) / cost_of(&tree, &leafless);
    assert_in_range((uintmax_t)cost, 10, 160);
    bvh_tree_destroy(&tree);
    test_free(items);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trees_have_every_item_once), cmocka_unit_test(threads_do_not_change_trees),
        cmocka_unit_test(items_that_no_ray_hits_are_invalid), cmocka_unit_test(no_items_are_an_empty_tree),
        cmocka_unit_test(boxes_are_small)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
