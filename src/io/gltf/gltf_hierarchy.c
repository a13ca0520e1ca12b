/* gltf_hierarchy.c - parents and children of nodes, and copies. The specification allows a node one
 * parent; some exporters give it several and mean instances, so that the second parent and all after it
 * get copies of the node and its descendants. Copies follow the nodes of the file, whose indices stay.
 * Cycles are an error. EXT_mesh_gpu_instancing: the transforms of a node's instances. Custom attributes
 * (_ID, ..) affect no image. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/gltf/gltf_components.h"

/* Copies of copies can grow exponentially. The first path to a node is the node itself, and each other
 * path a copy; with MAX_PATHS paths there are too many copies. */
enum { MAX_COPIES = 1 << 16, MAX_PATHS = MAX_COPIES + 2 };

void gltf_read_children(io_reader *r, const json_place *at, uint32_t index, uint32_t node_count)
{
    json_place array = io_get_array(r, at, "children");
    size_t count = io_get_count(&array);
    uint32_t *children = io_alloc(r, "nodes", count, sizeof *children);
    uint32_t used = 0;
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place element = io_get_element(&array, i);
        uint32_t child = io_get_index_value(r, &element, node_count, "node");
        if (child == SCENE_NONE)
            return;
        if (r->scene->nodes[child].parent == index) { /* the last node that listed it as a child */
            io_note(r, &element, NULL, "node %u is listed twice", child);
            continue;
        }
        r->scene->nodes[child].parent = index;
        children[used++] = child;
    }
    r->scene->nodes[index].children = children;
    r->scene->nodes[index].child_count = used;
}

/* ---- the number of copies ---- */

typedef struct path_count {
    uint32_t *waiting, *queue; /* parents not visited yet; nodes without any */
    uint64_t *paths;           /* paths from roots to a node, at most MAX_PATHS */
} path_count;

/* Visits parents before children. Returns the number of nodes reached: all, if there are no cycles. */
static uint32_t count_paths(const scene_node *nodes, uint32_t count, path_count *w, uint64_t *total)
{
    uint32_t queued = 0;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < nodes[i].child_count; k++)
            w->waiting[nodes[i].children[k]]++;
    for (uint32_t i = 0; i < count; i++)
        if (w->waiting[i] == 0) {
            w->paths[i] = 1;
            w->queue[queued++] = i;
        }
    for (uint32_t i = 0; i < queued; i++) {
        const scene_node *node = &nodes[w->queue[i]];
        uint64_t paths = w->paths[w->queue[i]];
        *total += paths;
        for (uint32_t k = 0; k < node->child_count; k++) {
            uint32_t child = node->children[k];
            uint64_t sum = w->paths[child] + paths;
            w->paths[child] = sum < MAX_PATHS ? sum : MAX_PATHS;
            if (--w->waiting[child] == 0)
                w->queue[queued++] = child;
        }
    }
    return queued;
}

/* Counts nodes, each once per path from a root. False: an error is recorded. */
static bool count_nodes(io_reader *r, const json_place *array, uint64_t *total)
{
    uint32_t count = r->scene->node_count;
    path_count w = {.waiting = mem_zalloc(r->allocator, count, sizeof *w.waiting),
                    .queue = mem_alloc(r->allocator, count, sizeof *w.queue),
                    .paths = mem_zalloc(r->allocator, count, sizeof *w.paths)};
    *total = 0;
    if (!w.waiting || !w.queue || !w.paths) {
        io_fail_memory(r, "nodes", count * (2 * sizeof *w.queue + sizeof *w.paths));
    } else if (count_paths(r->scene->nodes, count, &w, total) < count) {
        uint32_t i = 0;
        while (w.waiting[i] == 0)
            i++;
        json_place at = io_get_element(array, i);
        io_fail(r, &at, NULL, FACET_ERROR_INVALID, "is its own ancestor");
    } else if (*total > (uint64_t)count + MAX_COPIES) {
        io_fail(r, array, NULL, FACET_ERROR_LIMIT, "with several parents make more than %d copies",
                (int)MAX_COPIES);
    }
    mem_free(w.waiting);
    mem_free(w.queue);
    mem_free(w.paths);
    return io_is_ok(r);
}

/* ---- copies ---- */

static void warn_shared(io_reader *r, const json_place *array, uint32_t parent, uint32_t k, uint32_t child)
{
    const json_place node = io_get_element(array, parent);
    const json_place children = {.parent = &node, .key = "children"};
    const json_place at = {.parent = &children, .index = k};
    io_warn(r, &at, NULL, "node %u is a child of node %u already; it is drawn under each parent", child,
            r->scene->nodes[child].parent);
}

/* A copy has no camera, since a camera is selected by node, and no skinned mesh, which would be drawn
 * again in the same place. */
static void make_copy(io_reader *r, uint32_t copy, uint32_t of, uint32_t parent)
{
    scene_node *node = &r->scene->nodes[copy];
    *node = r->scene->nodes[of];
    node->parent = parent;
    node->camera = SCENE_NONE;
    if (node->skin != SCENE_NONE)
        node->mesh = node->skin = SCENE_NONE;
    uint32_t original = of < r->gltf->file_node_count ? of : r->gltf->copy_of[of];
    r->gltf->copy_of[copy] = original;
    r->gltf->next_copy[copy] = r->gltf->next_copy[original];
    r->gltf->next_copy[original] = copy;
}

/* Sets the children of a node: those nodes of the file that have no parent yet, and copies of the others. */
static void adopt(io_reader *r, const json_place *array, uint32_t index, uint32_t *used)
{
    scene_node *nodes = r->scene->nodes;
    uint32_t count = nodes[index].child_count;
    uint32_t *children = io_alloc_raw(r, "nodes", count, sizeof *children);
    bool is_copy = index >= r->gltf->file_node_count;
    const uint32_t *originals = nodes[is_copy ? r->gltf->copy_of[index] : index].children;
    for (uint32_t k = 0; k < count && children; k++) {
        uint32_t child =
            originals[k] < r->gltf->file_node_count ? originals[k] : r->gltf->copy_of[originals[k]];
        if (!is_copy && nodes[child].parent == SCENE_NONE) {
            nodes[child].parent = index;
            children[k] = child;
            continue;
        }
        if (!is_copy)
            warn_shared(r, array, index, k, child);
        children[k] = *used;
        make_copy(r, (*used)++, child, index);
    }
    if (children)
        nodes[index].children = children;
}

void gltf_settle_hierarchy(io_reader *r, const json_place *array)
{
    uint64_t total;
    uint32_t count = r->scene->node_count;
    r->gltf->file_node_count = count;
    if (!count_nodes(r, array, &total))
        return;
    if (total > count) {
        scene_node *nodes = io_alloc_raw(r, "nodes", total, sizeof *nodes);
        r->gltf->copy_of = io_alloc(r, "nodes", total, sizeof *r->gltf->copy_of);
        r->gltf->next_copy = io_alloc(r, "nodes", total, sizeof *r->gltf->next_copy);
        if (!nodes || !r->gltf->copy_of || !r->gltf->next_copy)
            return;
        memcpy(nodes, r->scene->nodes, count * sizeof *nodes);
        r->scene->nodes = nodes;
    }
    uint32_t used = count;
    for (uint32_t i = 0; i < count; i++)
        r->scene->nodes[i].parent = SCENE_NONE;
    for (uint32_t i = 0; i < used && io_is_ok(r); i++)
        adopt(r, array, i, &used);
    r->scene->node_count = used;
}

uint32_t gltf_next_node_copy(const io_reader *r, uint32_t node)
{
    return r->gltf->next_copy && r->gltf->next_copy[node] ? r->gltf->next_copy[node] : SCENE_NONE;
}

/* ---- CESIUM_RTC ---- */

/* Inserts a node at the center above every root, whose own transform may be animated. */
void gltf_read_center(io_reader *r, const json_place *root)
{
    double center[3];
    json_place at = io_get_extension(r, root, "CESIUM_RTC");
    bool is_there = io_get_doubles(r, &at, "center", center, 3);
    facet_scene *scene = r->scene;
    if (io_leave_out(r, "the model is not moved") || !is_there || !io_is_ok(r))
        return;
    uint32_t count = scene->node_count;
    scene_node *nodes = io_alloc_raw(r, "nodes", 2 * (size_t)count, sizeof *nodes);
    uint32_t *children = io_alloc_raw(r, "nodes", count, sizeof *children);
    if (!nodes || !children)
        return;
    memcpy(nodes, scene->nodes, count * sizeof *nodes);
    for (uint32_t i = 0; i < count; i++) {
        if (nodes[i].parent != SCENE_NONE)
            continue;
        children[i] = i;
        scene_node *place = &nodes[scene->node_count];
        *place = scene_node_default("CESIUM_RTC");
        place->child_count = 1;
        place->children = &children[i];
        memcpy(place->translation, center, sizeof place->translation);
        nodes[i].parent = scene->node_count++;
    }
    scene->nodes = nodes;
    for (uint32_t i = 0; i < scene->scene_count; i++)
        for (uint32_t k = 0; k < scene->scenes[i].node_count; k++) {
            uint32_t *listed =
                (uint32_t *)(uintptr_t)&scene->scenes[i].nodes[k]; /* the reader made the list */
            uint32_t parent = nodes[*listed].parent;
            *listed = parent != SCENE_NONE && parent >= count ? parent : *listed;
        }
}

/* ---- instances of a mesh ---- */

/* The accessor of one attribute, whose count must equal that of the others; SCENE_NONE: none, or an error is
 * recorded. */
static uint32_t get_instances(io_reader *r, const json_place *attributes, const char *name, gltf_type type,
                              uint32_t *count)
{
    uint32_t index = gltf_get_accessor(r, attributes, name);
    if (index == SCENE_NONE)
        return SCENE_NONE;
    const gltf_accessor *a = &r->gltf->accessors[index];
    bool is_signed = a->is_normalized && (a->component == GLTF_I8 || a->component == GLTF_I16);
    if (a->type != type || !(gltf_is_float(a->component) || (type == GLTF_VEC4 && is_signed))) {
        io_fail(r, attributes, name, FACET_ERROR_INVALID,
                "accessor %u has a type and componentType that are not allowed for %s of instances", index,
                name);
        return SCENE_NONE;
    }
    if (*count != SCENE_NONE && a->count != *count) {
        io_fail(r, attributes, name, FACET_ERROR_INVALID,
                "accessor %u has %u elements, but there are %u instances", index, a->count, *count);
        return SCENE_NONE;
    }
    *count = a->count;
    return index;
}

/* Unit quaternions, copied where some need normalization. */
static const float *get_rotations(io_reader *r, const json_place *at, uint32_t index)
{
    const gltf_accessor *a = &r->gltf->accessors[index];
    const float *in = gltf_get_finite(r, at, index, "rotations");
    if (!in || !io_spend(r, at, a->count))
        return NULL;
    bool is_unit = true;
    for (size_t i = 0; i < a->count && is_unit; i++) {
        const float *q = in + 4 * i;
        is_unit = fabsf(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1.0f) <= 1e-5f;
    }
    if (is_unit)
        return in;
    float *out = io_alloc_raw(r, "rotations", a->count, 4 * sizeof *out);
    if (!out)
        return NULL;
    memcpy(out, in, 4 * (size_t)a->count * sizeof *out);
    size_t far_off = 0;
    for (size_t i = 0; i < a->count; i++)
        far_off += fabs(gltf_normalize_rotation(out + 4 * i) - 1.0) > 0.01;
    if (far_off)
        io_warn(r, at, NULL, "%zu rotations of accessor %u are not of length 1", far_off, index);
    return out;
}

const scene_instancing *gltf_read_instancing(io_reader *r, const json_place *node)
{
    json_place extension = io_get_extension(r, node, "EXT_mesh_gpu_instancing");
    json_place attributes = io_get_object(r, &extension, "attributes");
    if (!extension.value || !io_is_ok(r))
        return NULL;
    uint32_t count = SCENE_NONE;
    uint32_t translation = get_instances(r, &attributes, "TRANSLATION", GLTF_VEC3, &count);
    uint32_t rotation = get_instances(r, &attributes, "ROTATION", GLTF_VEC4, &count);
    uint32_t scale = get_instances(r, &attributes, "SCALE", GLTF_VEC3, &count);
    if (!io_is_ok(r))
        return NULL;
    if (count == SCENE_NONE) {
        io_warn(r, &extension, "attributes", "has no TRANSLATION, ROTATION or SCALE; it is ignored");
        return NULL;
    }
    const uint32_t accessors[3] = {translation, rotation, scale};
    for (int i = 0; i < 3; i++)
        if (accessors[i] != SCENE_NONE && !gltf_has_accessor_source(r, accessors[i])) {
            io_warn(r, &attributes, NULL, "are in a buffer without bytes; the mesh is drawn once");
            return NULL;
        }
    scene_instancing *out = io_alloc(r, "instances", 1, sizeof *out);
    if (!out)
        return NULL;
    bool has_data = false;
    for (int i = 0; i < 3; i++)
        has_data |= accessors[i] != SCENE_NONE && !gltf_is_zero_accessor(r, accessors[i]);
    if (!has_data) { /* all zeros: at the node, or of size 0 */
        static const float zeros[3] = {0, 0, 0};
        if (count > 1)
            io_warn(r, &attributes, NULL, "%u instances without data are in one place; one is drawn", count);
        *out = (scene_instancing){.count = count ? 1 : 0, .scales = scale != SCENE_NONE ? zeros : NULL};
        return out;
    }
    out->count = count;
    if (translation != SCENE_NONE)
        out->translations = gltf_get_finite(r, &attributes, translation, "translations");
    if (rotation != SCENE_NONE)
        out->rotations = get_rotations(r, &attributes, rotation);
    if (scale != SCENE_NONE)
        out->scales = gltf_get_finite(r, &attributes, scale, "scales");
    return io_is_ok(r) ? out : NULL;
}
