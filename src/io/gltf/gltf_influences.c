/* gltf_influences.c - which joints move a vertex, and how much (glTF 2.0 section 3.7.3.3): the sets of four that the
 * file has, side by side, with weights that sum to 1. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/parallel.h"
#include "io/gltf/gltf_reader.h"

enum { GRAIN = 1 << 14, MAX_SETS = 64 };

/* A deviation of the sum from 1 that rounding explains; within it weights are used as they are. */
static const double SUM_TOLERANCE = 1e-4;
/* Beyond this it is worth a warning. */
static const double FAR_OFF = 0.01;

typedef struct gathering {
    uint32_t set_count;
    const float *joints[MAX_SETS], *weights[MAX_SETS]; /* 4 per vertex */
    uint16_t *out_joints;
    float *out_weights;
    size_t *far_off, *without; /* per GRAIN: vertices whose weights do not sum to 1, or are all 0 */
} gathering;

/* A vertex that no joint moves would stay behind at the origin: as in other viewers the first one takes it along. */
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
    for (size_t i = 0; i < count; i++) /* a joint that moves nothing may be any number in the file */
        joints[i] = weights[i] > 0.0f ? joints[i] : 0;
}

static void gather(void *context, size_t begin, size_t end)
{
    const gathering *g = context;
    for (size_t vertex = begin; vertex < end; vertex++)
        gather_vertex(g, vertex, begin / GRAIN);
}

/* The arrays of the sets. False: an error is recorded, or (set_count 0) the file has none. */
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
