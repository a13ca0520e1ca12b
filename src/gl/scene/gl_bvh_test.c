/* gl_bvh_test.c - every item is in one leaf, every box contains what is below it, subtrees end where they say, and are
 * not too deep. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "gl/scene/gl_bvh.h"

enum { MOST = 3000 };

/* Boxes in one place, ever closer to one, or anywhere: numbers of Lehmer's generator. */
static void fill(float *boxes, uint32_t count, int kind)
{
    uint64_t state = 1;
    for (uint32_t i = 0; i < 3 * count; i++) {
        state = state * 48271u % 2147483647u;
        float random = (float)state / 2147483647.0f;
        float at = kind == 0 ? 0.0f : kind == 1 ? 1.0f / (float)(1ull << (i / 3 % 60)) : random;
        boxes[6 * (i / 3) + i % 3] = at;
        boxes[6 * (i / 3) + 3 + i % 3] = at + 0.1f * random;
    }
}

static void check_item(const gl_bvh *bvh, const gl_bvh_node *node, const float *box, uint32_t *seen)
{
    for (uint32_t k = 0; k < node->count; k++) {
        uint32_t item = bvh->order[node->first + k];
        seen[item]++;
        for (int i = 0; i < 3; i++) {
            assert_true(node->low[i] <= box[6 * item + (uint32_t)i]);
            assert_true(node->high[i] >= box[6 * item + 3 + (uint32_t)i]);
        }
    }
}

/* Inner nodes above each other, at most. */
static uint32_t depth_of(const gl_bvh *bvh, uint32_t node)
{
    if (bvh->nodes[node].count)
        return 0;
    uint32_t near = depth_of(bvh, node + 1), far = depth_of(bvh, bvh->nodes[node + 1].next);
    return 1 + (near > far ? near : far);
}

static void leaves_partition_the_items(void **state)
{
    (void)state;
    float *boxes = malloc(sizeof(float) * 6 * MOST);
    for (int kind = 0; kind < 3; kind++)
        for (uint32_t count = 0; count < MOST; count = 2 * count + 1) {
            gl_bvh bvh;
            uint32_t *seen = calloc(MOST, sizeof *seen);
            assert_true(boxes && seen);
            fill(boxes, count, kind);
            assert_int_equal(gl_bvh_build(boxes, count, NULL, &bvh, NULL), FACET_OK);
            assert_true(!count || depth_of(&bvh, 0) <= GL_BVH_DEPTH);
            for (uint32_t i = 0; i < bvh.node_count; i++) {
                const gl_bvh_node *node = &bvh.nodes[i];
                assert_true(node->next > i && node->next <= bvh.node_count && node->count <= GL_BVH_LEAF);
                for (uint32_t k = i; k < node->next; k++)
                    for (int c = 0; c < 3; c++)
                        assert_true(node->low[c] <= bvh.nodes[k].low[c] &&
                                    node->high[c] >= bvh.nodes[k].high[c]);
                check_item(&bvh, node, boxes, seen);
            }
            for (uint32_t i = 0; i < count; i++)
                assert_int_equal(seen[i], 1);
            free(seen);
            gl_bvh_destroy(&bvh);
        }
    free(boxes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(leaves_partition_the_items)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
