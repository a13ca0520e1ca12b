/* gltf_skins.c - the joints and weights of vertices, in any number of sets of four (glTF 2.0 section
 * 3.7.3.3), and skins (sections 3.7.3, 5.28): joints and their inverse bind matrices. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/parallel.h"
#include "io/gltf/gltf_components.h"

/* ---- influences of a vertex ---- */

enum { GRAIN = 1 << 14, MAX_SETS = 64 };

/* Tolerance for the sum of weights, within which they are used unchanged. */
static const double SUM_TOLERANCE = 1e-4;
/* A larger deviation is reported. */
static const double FAR_OFF = 0.01;

typedef struct gathering {
    uint32_t set_count;
    const float *joints[MAX_SETS], *weights[MAX_SETS]; /* 4 per vertex */
    uint16_t *out_joints;
    float *out_weights;
    size_t *far_off, *without; /* per work item: vertices whose weights do not sum to 1, or are all 0 */
} gathering;

/* A vertex without weights would stay at the origin: as in other viewers the first joint moves it. */
static void gather_vertex(const gathering *g, size_t vertex, size_t range)
{
    size_t count = 4 * (size_t)g->set_count;
    uint16_t *joints = g->out_joints + count * vertex;
    float *weights = g->out_weights + count * vertex;
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        float weight = g->weights[i / 4][4 * vertex + i % 4];
        weights[i] = weight > 0.0f && weight <= SCENE_FARTHEST ? weight : 0.0f;
        joints[i] = (uint16_t)g->joints[i / 4][4 * vertex + i % 4];
        sum += (double)weights[i];
    }
    g->far_off[range] += fabs(sum - 1.0) > FAR_OFF && sum > 0.0 ? 1u : 0u;
    g->without[range] += sum > 0.0 ? 0u : 1u;
    if (!(sum > 0.0))
        weights[0] = 1.0f;
    else if (fabs(sum - 1.0) > SUM_TOLERANCE)
        for (size_t i = 0; i < count; i++)
            weights[i] = (float)((double)weights[i] / sum);
    for (size_t i = 0; i < count; i++) /* a joint of weight 0 may have any index in the file */
        joints[i] = weights[i] > 0.0f ? joints[i] : 0;
}

static void gather(void *context, size_t begin, size_t end)
{
    const gathering *g = context;
    for (size_t vertex = begin; vertex < end; vertex++)
        gather_vertex(g, vertex, begin / GRAIN);
}

/* The arrays of all sets. False: an error is recorded, or (set_count 0) the file has none. */
static bool get_sets(io_reader *r, const json_place *attributes, uint32_t vertex_count, gathering *g)
{
    uint32_t joint_sets = gltf_count_sets(attributes, "JOINTS_");
    uint32_t weight_sets = gltf_count_sets(attributes, "WEIGHTS_");
    g->set_count = joint_sets < weight_sets ? joint_sets : weight_sets;
    if (joint_sets != weight_sets)
        io_warn(r, attributes, NULL,
                "has %u sets of JOINTS_n, but %u of WEIGHTS_n; those without the other are ignored",
                joint_sets, weight_sets);
    for (uint32_t i = 0; i < g->set_count && io_is_ok(r); i++) {
        char name[32];
        snprintf(name, sizeof name, "JOINTS_%u", i);
        uint32_t joints = gltf_get_attribute(r, attributes, name, GLTF_JOINTS, vertex_count);
        snprintf(name, sizeof name, "WEIGHTS_%u", i);
        uint32_t weights = gltf_get_attribute(r, attributes, name, GLTF_WEIGHTS, vertex_count);
        if (joints == SCENE_NONE || weights == SCENE_NONE)
            return false;
        g->joints[i] = gltf_get_accessor_floats(r, attributes, joints);
        g->weights[i] = gltf_get_accessor_floats(r, attributes, weights);
    }
    return io_is_ok(r) && g->set_count > 0;
}

bool gltf_read_influences(io_reader *r, const json_place *attributes, scene_primitive *p)
{
    gathering g = {0};
    if (!get_sets(r, attributes, p->vertex_count, &g))
        return io_is_ok(r);
    uint32_t count = 4 * g.set_count;
    size_t ranges = p->vertex_count / GRAIN + 1;
    if (!io_spend(r, attributes, (uint64_t)p->vertex_count * g.set_count))
        return false;
    g.out_joints = io_alloc_raw(r, "joints", p->vertex_count, count * sizeof *g.out_joints);
    g.out_weights = io_alloc_raw(r, "weights", p->vertex_count, count * sizeof *g.out_weights);
    g.far_off = mem_zalloc(r->allocator, 2 * ranges, sizeof *g.far_off);
    if (!g.far_off)
        io_fail_memory(r, "weights", 2 * ranges * sizeof *g.far_off);
    if (io_is_ok(r)) {
        g.without = g.far_off + ranges;
        parallel_for(r->thread_count, p->vertex_count, GRAIN, gather, &g);
        size_t far_off = 0;
        size_t without = 0;
        for (size_t i = 0; i < ranges; i++) {
            far_off += g.far_off[i];
            without += g.without[i];
        }
        if (far_off)
            io_warn(r, attributes, NULL, "weights of %zu vertices do not sum to 1; they are scaled", far_off);
        if (without)
            io_warn(r, attributes, NULL,
                    "weights of %zu vertices are all 0; the first joint of each moves it", without);
        p->influence_count = count;
        p->joints = g.out_joints;
        p->weights = g.out_weights;
    }
    mem_free(g.far_off);
    return io_is_ok(r);
}

/* ---- skins ---- */

/* ---- the nodes above joints ---- */

/* The root above each node; a block of mem_alloc(), NULL: an error is recorded. */
static uint32_t *find_roots(io_reader *r)
{
    const facet_scene *scene = r->scene;
    uint32_t *roots = mem_alloc(r->allocator, scene->node_count, sizeof *roots);
    if (!roots) {
        io_fail_memory(r, "nodes", scene->node_count * sizeof *roots);
        return NULL;
    }
    memset(roots, 0xff, scene->node_count * sizeof *roots);
    for (uint32_t i = 0; i < scene->node_count; i++) {
        uint32_t top = i;
        while (roots[top] == SCENE_NONE && scene->nodes[top].parent != SCENE_NONE)
            top = scene->nodes[top].parent;
        uint32_t root = roots[top] == SCENE_NONE ? top : roots[top];
        for (uint32_t node = i; node != SCENE_NONE && roots[node] == SCENE_NONE;
             node = scene->nodes[node].parent)
            roots[node] = root;
    }
    return roots;
}

/* ---- one skin ---- */

static void read_joints(io_reader *r, const json_place *at, const uint32_t *roots, scene_skin *out)
{
    json_place array = io_get_array(r, at, "joints");
    if (io_is_ok(r) && !array.value)
        io_fail(r, at, "joints", FACET_ERROR_INVALID, "is missing");
    size_t count = io_get_count(&array);
    uint32_t *joints = io_alloc(r, "joints", count, sizeof *joints);
    bool has_several_roots = false;
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place element = io_get_element(&array, i);
        joints[i] = io_get_index_value(r, &element, r->gltf->file_node_count, "node");
        if (joints[i] != SCENE_NONE)
            has_several_roots |= roots[joints[i]] != roots[joints[0]];
    }
    if (has_several_roots)
        io_note(r, &array, NULL, "have no common root");
    out->joints = joints;
    out->joint_count = (uint32_t)count;
}

/* Whether a matrix is finite; *has_last_row: its last row is 0 0 0 1. */
static bool is_affine(const float m[16], bool *has_last_row)
{
    bool is_finite = true;
    for (int i = 0; i < 16; i++)
        is_finite &= fabsf(m[i]) <= SCENE_FARTHEST;
    *has_last_row = m[3] == 0.0f && m[7] == 0.0f && m[11] == 0.0f && m[15] == 1.0f;
    return is_finite;
}

/* Copies the file's matrices and repairs those that are not affine. */
static const mat4 *get_matrices(io_reader *r, const json_place *skin, uint32_t accessor, uint32_t count)
{
    const float *in = gltf_get_accessor_floats(r, skin, accessor);
    if (!in || !io_spend(r, skin, count))
        return NULL;
    mat4 *out = io_alloc_raw(r, "joints", count, sizeof *out);
    if (!out)
        return NULL;
    size_t lost = 0;
    size_t projecting = 0;
    memcpy(out, in, count * sizeof *out);
    for (size_t i = 0; i < count; i++) {
        bool has_last_row;
        bool is_finite = is_affine(out[i].m, &has_last_row);
        lost += !is_finite;
        projecting += is_finite && !has_last_row;
        if (!is_finite)
            out[i] = mat4_identity();
        out[i].m[3] = out[i].m[7] = out[i].m[11] = 0.0f;
        out[i].m[15] = 1.0f;
    }
    if (lost)
        io_warn(r, skin, "inverseBindMatrices", "%zu are not finite; the identity is used", lost);
    if (projecting)
        io_warn(r, skin, "inverseBindMatrices", "%zu have a last row other than 0 0 0 1, which is ignored",
                projecting);
    return out;
}

static void read_bind_matrices(io_reader *r, const json_place *skin, scene_skin *out)
{
    uint32_t index = gltf_get_accessor(r, skin, "inverseBindMatrices");
    if (index == SCENE_NONE)
        return;
    const gltf_accessor *a = &r->gltf->accessors[index];
    if (a->type != GLTF_MAT4 || !gltf_is_float(a->component))
        io_fail(r, skin, "inverseBindMatrices", FACET_ERROR_INVALID,
                "accessor %u must have MAT4 elements of floats", index);
    else if (a->count < out->joint_count)
        io_fail(r, skin, "inverseBindMatrices", FACET_ERROR_INVALID,
                "accessor %u has %u elements, but there are %u joints", index, a->count, out->joint_count);
    if (!io_is_ok(r))
        return;
    if (a->view != SCENE_NONE && r->gltf->views[a->view].stride)
        io_note(r, skin, "inverseBindMatrices", "is in a buffer view with byteStride");
    if (gltf_has_accessor_source(r, index))
        out->inverse_bind = get_matrices(r, skin, index, out->joint_count);
    else
        io_warn(r, skin, "inverseBindMatrices", "is in a buffer without bytes; identities are used");
}

/* A skin that cannot be read keeps its index, with a single joint if there is a node; it may not be
 * needed. */
static void make_unused_skin(io_reader *r, scene_skin *out)
{
    *out = (scene_skin){.name = out->name, .skeleton = SCENE_NONE};
    out->joints = io_alloc(r, "joints", 1, sizeof *out->joints);
    out->joint_count = r->scene->node_count > 0;
}

static void read_skin(io_reader *r, const json_place *at, const uint32_t *roots, scene_skin *out)
{
    out->name = io_get_name(r, at);
    read_joints(r, at, roots, out);
    out->skeleton = io_get_index(r, at, "skeleton", r->gltf->file_node_count, "node");
    if (io_is_ok(r))
        read_bind_matrices(r, at, out);
    out->meta = gltf_get_meta(r, at);
}

/* ---- the meshes that skins move ---- */

/* The largest joint index in a mesh, plus 1; 0: none. */
static uint32_t count_joints(const scene_mesh *mesh)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        const scene_primitive *p = &mesh->primitives[i];
        size_t joint_count = (size_t)p->vertex_count * p->influence_count;
        for (size_t k = 0; k < joint_count; k++)
            count = p->joints[k] >= count ? p->joints[k] + 1u : count;
    }
    return count;
}

/* The vertices of a mesh must refer to joints of the skins that are used with it. */
static void check_users(io_reader *r, const json_place *root, io_problem *problems)
{
    const facet_scene *scene = r->scene;
    json_place array = io_get_array(r, root, "nodes");
    uint32_t *joint_counts = mem_alloc(r->allocator, scene->mesh_count, sizeof *joint_counts);
    if (!joint_counts) {
        io_fail_memory(r, "meshes", scene->mesh_count * sizeof *joint_counts);
        return;
    }
    memset(joint_counts, 0xff, scene->mesh_count * sizeof *joint_counts);
    for (uint32_t i = 0; i < scene->node_count && io_is_ok(r); i++) {
        const scene_node *node = &scene->nodes[i];
        if (node->mesh == SCENE_NONE || node->skin == SCENE_NONE)
            continue;
        if (problems[node->skin].message)
            io_fail_deferred(r, &problems[node->skin]);
        else if (r->gltf->meshes[node->mesh].joints.message)
            io_fail_deferred(r, &r->gltf->meshes[node->mesh].joints);
        uint32_t *count = &joint_counts[node->mesh];
        if (*count == SCENE_NONE)
            *count = count_joints(&scene->meshes[node->mesh]);
        json_place at = io_get_element(&array, i);
        if (*count == 0)
            io_warn(r, &at, "skin", "has no effect: mesh %u has no JOINTS_0 and WEIGHTS_0", node->mesh);
        if (*count > scene->skins[node->skin].joint_count)
            io_fail(r, &at, "skin", FACET_ERROR_INVALID,
                    "a vertex of mesh %u is moved by joint %u, but skin %u has %u joints", node->mesh,
                    *count - 1, node->skin, scene->skins[node->skin].joint_count);
    }
    mem_free(joint_counts);
}

void gltf_read_skins(io_reader *r, const json_place *root)
{
    json_place array = io_get_array(r, root, "skins");
    size_t count = io_get_count(&array);
    if (count == 0)
        return;
    r->scene->skins = io_alloc(r, "skins", count, sizeof *r->scene->skins);
    io_problem *problems = io_alloc(r, "skins", count, sizeof *problems);
    uint32_t *roots = find_roots(r);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &array, i);
        read_skin(r, &at, roots, &r->scene->skins[i]);
        if (io_defer(r, &problems[i]))
            make_unused_skin(r, &r->scene->skins[i]);
        r->scene->skin_count = (uint32_t)(i + 1);
    }
    mem_free(roots);
    if (io_is_ok(r))
        check_users(r, root, problems);
    for (size_t i = 0; i < count && io_is_ok(r); i++)
        io_warn_deferred(r, &problems[i]);
}
