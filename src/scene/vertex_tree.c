/* vertex_tree.c - see vertex_tree.h. */
#include "scene/vertex_tree.h"

#include "base/memory.h"
#include "base/hash.h"
#include "scene/unseen.h"

enum {
    LEAF = 256,     /* vertices of a leaf */
    MAX_DEPTH = 64, /* halves of 2^32 vertices are leaves long before */
    USES = 32,      /* instances examined in full before a tree is built, which costs about as much */
    FEW = 24        /* indices that are as fast to examine directly */
};

/* ---- one tree ---- */

typedef struct builder {
    const float *positions;
    uint32_t *vertices; /* vertices in use, each once */
    vertex_tree *tree;
    uint32_t node_count, block_count;
} builder;

static box bounds_of(const builder *b, uint32_t begin, uint32_t end)
{
    box out = box_empty();
    for (uint32_t i = begin; i < end; i++)
        box_add(&out, b->positions + 3 * (size_t)b->vertices[i]);
    return out;
}

/* By coordinate, then by index, so that the order is unique. */
static bool is_before(const builder *b, uint32_t u, uint32_t v, int axis)
{
    float x = b->positions[3 * (size_t)u + (size_t)axis];
    float y = b->positions[3 * (size_t)v + (size_t)axis];
    return x < y || (!(x > y) && u < v);
}

static void swap(uint32_t *a, uint32_t *b)
{
    uint32_t kept = *a;
    *a = *b;
    *b = kept;
}

/* Quickselect (Hoare 1961, algorithm 65): puts the vertex of rank `middle` there, smaller ones before it.
 * The pivot is chosen by a hash, so that no order of vertices in practice is slow. */
static void select_middle(builder *b, uint32_t begin, uint32_t end, uint32_t middle, int axis)
{
    uint32_t *v = b->vertices;
    while (end - begin > 1) {
        uint32_t pivot = v[begin + (uint32_t)(mix64(begin + ((uint64_t)end << 32)) % (end - begin))];
        uint32_t low = begin;
        uint32_t high = end - 1;
        for (;;) {
            while (is_before(b, v[low], pivot, axis))
                low++;
            while (is_before(b, pivot, v[high], axis))
                high--;
            if (low >= high)
                break;
            swap(&v[low], &v[high]);
        }
        if (low == middle)
            return;
        if (middle < low)
            end = low;
        else
            begin = low + 1;
    }
}

static void fill_blocks(builder *b, vertex_node *node, uint32_t begin, uint32_t end)
{
    node->begin = b->block_count;
    for (uint32_t i = begin; i < end; i += VERTEX_LANES) {
        vertex_block *block = &b->tree->blocks[b->block_count++];
        for (uint32_t lane = 0; lane < VERTEX_LANES; lane++) {
            const float *p = b->positions + 3 * (size_t)b->vertices[i + lane < end ? i + lane : end - 1];
            for (int k = 0; k < 3; k++)
                block->xyz[k][lane] = p[k];
        }
    }
    node->end = b->block_count;
}

/* The depth is bounded, as each child has half of the vertices. */
static void build(builder *b, uint32_t begin, uint32_t end)
{
    uint32_t number = b->node_count++;
    vertex_node *node = &b->tree->nodes[number];
    *node = (vertex_node){.bounds = bounds_of(b, begin, end)};
    if (end - begin <= LEAF) {
        fill_blocks(b, node, begin, end);
        return;
    }
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (node->bounds.maximum[k] - node->bounds.minimum[k] >
            node->bounds.maximum[axis] - node->bounds.minimum[axis])
            axis = k;
    uint32_t middle = begin + (end - begin) / 2;
    select_middle(b, begin, end, middle, axis);
    build(b, begin, middle);
    b->tree->nodes[number].right = b->node_count;
    build(b, middle, end);
}

/* The vertices in use, each once; *count of them. */
static uint32_t *list_vertices(const scene_primitive *p, const facet_allocator *allocator, uint32_t *count)
{
    uint32_t *list = mem_alloc(allocator, p->vertex_count, sizeof *list);
    bool *is_listed = mem_zalloc(allocator, p->vertex_count, sizeof *is_listed);
    *count = 0;
    for (uint32_t i = 0; list && is_listed && i < p->index_count; i++) {
        uint32_t v = p->indices[i];
        if (is_listed[v] ||
            (p->has_flat_triangles && unseen_is_flat(p->positions, p->indices + (size_t)(i / 3) * 3)))
            continue;
        is_listed[v] = true;
        list[(*count)++] = v;
    }
    mem_free(is_listed);
    return list;
}

bool vertex_tree_create(const scene_primitive *p, const facet_allocator *allocator, vertex_tree *out)
{
    uint32_t count;
    builder b = {.positions = p->positions, .vertices = list_vertices(p, allocator, &count), .tree = out};
    *out = (vertex_tree){.nodes = NULL};
    /* Halves of more than LEAF vertices have at least LEAF / 2, a tree has one node less than twice its
     * leaves, and one block per leaf is not full. */
    size_t leaf_count = count / (LEAF / 2) + 1;
    if (count) {
        out->nodes = mem_alloc(allocator, 2 * leaf_count, sizeof *out->nodes);
        out->blocks = mem_alloc(allocator, count / VERTEX_LANES + leaf_count, sizeof *out->blocks);
    }
    bool is_ok = out->nodes && out->blocks;
    if (is_ok)
        build(&b, 0, count);
    else
        vertex_tree_destroy(out);
    mem_free(b.vertices);
    return is_ok;
}

void vertex_tree_destroy(vertex_tree *tree)
{
    mem_free(tree->nodes);
    mem_free(tree->blocks);
    *tree = (vertex_tree){0};
}

/* The child with the larger bound goes first: it leaves less of the other to examine. */
void vertex_tree_visit(const vertex_tree *tree, const vertex_visitor *visitor)
{
    uint32_t stack[MAX_DEPTH];
    uint32_t depth = 0;
    stack[depth++] = 0;
    while (depth) {
        uint32_t number = stack[--depth];
        const vertex_node *node = &tree->nodes[number];
        if (!(visitor->gain(visitor->context, &node->bounds) > 0.0))
            continue;
        if (node->right) {
            uint32_t left = number + 1;
            bool is_left_first = visitor->gain(visitor->context, &tree->nodes[left].bounds) >
                                 visitor->gain(visitor->context, &tree->nodes[node->right].bounds);
            stack[depth++] = is_left_first ? node->right : left;
            stack[depth++] = is_left_first ? left : node->right;
            continue;
        }
        visitor->visit(visitor->context, tree->blocks + node->begin, node->end - node->begin);
    }
}

/* ---- those of a pose ---- */

static bool begin(vertex_trees *t)
{
    uint32_t count = 0;
    if (t->first)
        return false; /* an earlier allocation failed */
    t->first = mem_alloc(t->allocator, t->scene->mesh_count, sizeof *t->first);
    for (uint32_t i = 0; t->first && i < t->scene->mesh_count; i++) {
        t->first[i] = count;
        count += t->scene->meshes[i].primitive_count;
    }
    if (t->first)
        t->items = mem_zalloc(t->allocator, count, sizeof *t->items);
    t->item_count = t->items ? count : 0;
    return t->items != NULL;
}

void vertex_trees_destroy(vertex_trees *t)
{
    for (uint32_t i = 0; i < t->item_count; i++)
        vertex_tree_destroy(&t->items[i].tree);
    mem_free(t->items);
    mem_free(t->first);
    *t = (vertex_trees){0};
}

const vertex_tree *vertex_trees_get(vertex_trees *t, const scene_instance *instance)
{
    if (!t->scene || instance->is_deformed || instance->primitive->index_count <= FEW ||
        (!t->items && !begin(t)))
        return NULL;
    struct vertex_trees_item *item = &t->items[t->first[instance->mesh] + instance->primitive_index];
    if (item->tree.nodes)
        return &item->tree;
    if (item->has_failed || ++item->use_count <= USES)
        return NULL;
    item->has_failed = !vertex_tree_create(instance->primitive, t->allocator, &item->tree);
    return item->has_failed ? NULL : &item->tree;
}
