/* bvh4.c - see bvh4.h. A node takes the place of a binary one and of those below it with the largest surfaces. */
#include "cpu/bvh4.h"

#include <math.h>
#include <string.h>

#include "base/result.h"

typedef struct converter {
    const bvh_tree *tree;
    bvh4 *out;
    int32_t *leaves;
} converter;

static float half_area(const bvh_child *c)
{
    const float x = c->hi[0] - c->lo[0];
    const float y = c->hi[1] - c->lo[1];
    const float z = c->hi[2] - c->lo[2];
    return x * y + y * z + z * x;
}

/* Replaces the largest inner node of the children by its own, until there are four. */
static int gather(const bvh_tree *tree, const bvh_node *node, bvh_child children[4])
{
    int count = 2;
    memcpy(children, node->children, sizeof node->children);
    while (count < 4) {
        int largest = -1;
        float area = -1.0f;
        for (int i = 0; i < count; i++)
            if (!bvh_is_leaf(children[i].child) && half_area(&children[i]) > area) {
                area = half_area(&children[i]);
                largest = i;
            }
        if (largest < 0)
            break;
        const bvh_node *inner = &tree->nodes[children[largest].child];
        children[largest] = inner->children[0];
        children[count++] = inner->children[1];
    }
    return count;
}

static int32_t convert(converter *c, int32_t child);

static void fill_node(converter *c, uint32_t number, const bvh_child *children, int count)
{
    for (int i = 0; i < 4; i++) {
        const bool is_there = i < count;
        for (int axis = 0; axis < 3; axis++) {
            c->out->nodes[number].planes[2 * axis][i] = is_there ? children[i].lo[axis] : INFINITY;
            c->out->nodes[number].planes[2 * axis + 1][i] = is_there ? children[i].hi[axis] : -INFINITY;
        }
        c->out->nodes[number].children[i] = is_there ? convert(c, children[i].child) : BVH_EMPTY;
    }
}

/* Recursion ends at BVH_MAX_DEPTH. */
static int32_t convert(converter *c, int32_t child)
{
    if (bvh_is_leaf(child)) {
        c->leaves[c->out->leaf_count] = child;
        return ~(int32_t)c->out->leaf_count++;
    }
    bvh_child children[4];
    const int count = gather(c->tree, &c->tree->nodes[child], children);
    const uint32_t number = c->out->node_count++;
    memset(c->out->nodes[number].unused, 0, sizeof c->out->nodes[number].unused);
    fill_node(c, number, children, count);
    return (int32_t)number;
}

static size_t count_nodes(const bvh_tree *tree, int32_t child)
{
    if (bvh_is_leaf(child))
        return 0;
    bvh_child children[4];
    const int count = gather(tree, &tree->nodes[child], children);
    size_t sum = 1;
    for (int i = 0; i < count; i++)
        sum += count_nodes(tree, children[i].child);
    return sum;
}

facet_result bvh4_create(const bvh_tree *tree, const facet_allocator *allocator, bvh4 *out, int32_t **leaves,
                         facet_error *error)
{
    *out = (bvh4){.root = tree->root};
    *leaves = NULL;
    if (tree->root.child == BVH_EMPTY)
        return FACET_OK;
    out->nodes = mem_alloc(allocator, count_nodes(tree, tree->root.child), sizeof *out->nodes);
    *leaves = mem_alloc(allocator, (size_t)tree->node_count + 1, sizeof **leaves);
    if (!out->nodes || !*leaves) {
        bvh4_destroy(out);
        mem_free(*leaves);
        *leaves = NULL;
        return fail(error, FACET_ERROR_MEMORY, "out of memory: bounding volume hierarchy");
    }
    converter c = {.tree = tree, .out = out, .leaves = *leaves};
    out->root.child = convert(&c, tree->root.child);
    return FACET_OK;
}

void bvh4_destroy(bvh4 *tree)
{
    mem_free(tree->nodes);
    *tree = (bvh4){.root = {.child = BVH_EMPTY}};
}
