/* tangents.c - tangent space per corner, as in MikkTSpace (Mikkelsen 2008, "Simulation of Wrinkled Surfaces
 * Revisited", chapter 3), so that normal maps baked elsewhere appear as intended.
 *
 * 1. Corners with equal position, normal and texture coordinates are one vertex.
 * 2. Each triangle gets the direction of increasing u, and an orientation: whether (u, v) is mirrored on it.
 * 3. Around each vertex, triangles connected by edges with equal orientation are a group.
 * 4. A group's tangent is the sum of its triangles' directions, each made perpendicular to the vertex normal and
 *    weighted by the triangle's angle there.
 *
 * Omitted: the splitting of groups by an angle between tangents, whose default of 180 degrees never
 * splits; and the tangent (1, 0, 0) for corners without one, for which a perpendicular one is better.
 *
 * The sign: B = w cross(N, T) must point up in the image, that is towards smaller v, because glTF's v
 * grows downwards and its normal maps have +Y up. MikkTSpace run on (u, 1 - v) gives exactly that. */
#include "scene/scene.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/result.h"

enum { GRAIN = 1 << 12 }; /* triangles per work item */

typedef struct triangle {
    uint32_t vertices[3];  /* welded */
    uint32_t neighbors[3]; /* across the edge from corner i to i + 1; SCENE_NONE: none */
    uint32_t groups[3];    /* of the corners; SCENE_NONE: none yet */
    float direction[3];    /* unit, along increasing u */
    bool is_mirrored;
    bool is_degenerate; /* two corners share a position */
    bool is_unclear;    /* no area in the texture: joins any group */
} triangle;

typedef struct tangent_space {
    const scene_primitive *primitive;
    const float *uvs;
    uint32_t triangle_count, group_count;
    uint32_t *welded; /* per vertex: the first equal one */
    triangle *triangles;
    float *tangents; /* 4 per group */
    float *out;      /* 4 per corner */
} tangent_space;

/* ---- vectors ---- */

static float dot3(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Normalizes v, in double only if the square of the length is out of float's comfortable range. */
static bool normalise(float v[3])
{
    float square = dot3(v, v);
    if (square > 1e-30f && square < 1e30f) {
        float scale = 1.0f / sqrtf(square);
        for (int k = 0; k < 3; k++)
            v[k] *= scale;
        return true;
    }
    double length =
        sqrt((double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] + (double)v[2] * (double)v[2]);
    if (!(length > (double)FLT_MIN && length <= (double)FLT_MAX))
        return false;
    for (int k = 0; k < 3; k++)
        v[k] = (float)((double)v[k] / length);
    return true;
}

/* Makes v perpendicular to the unit vector n, and normalizes it. False: they were parallel. */
static bool project(float v[3], const float n[3])
{
    float along = dot3(v, n);
    for (int k = 0; k < 3; k++)
        v[k] -= along * n[k];
    return normalise(v);
}

static void any_perpendicular(const float n[3], float out[3])
{
    int smallest = fabsf(n[0]) <= fabsf(n[1]) && fabsf(n[0]) <= fabsf(n[2]) ? 0
                   : fabsf(n[1]) <= fabsf(n[2])                             ? 1
                                                                            : 2;
    out[0] = out[1] = out[2] = 0.0f;
    out[smallest] = 1.0f;
    project(out, n);
}

/* ---- 1. welding ---- */

static uint32_t hash_floats(const float *values, size_t count, uint32_t hash)
{
    for (size_t i = 0; i < count; i++) {
        float value = values[i] + 0.0f; /* -0 equals 0 */
        uint32_t bits;
        memcpy(&bits, &value, sizeof bits);
        hash = (hash ^ bits) * 0x9e3779b1u;
        hash ^= hash >> 15;
    }
    return hash;
}

static bool equal_floats(const float *a, const float *b, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (a[i] != b[i])
            return false;
    return true;
}

static bool weld(tangent_space *space, const facet_allocator *allocator)
{
    const scene_primitive *p = space->primitive;
    size_t size = 16;
    while (size < 2 * (size_t)p->vertex_count)
        size *= 2;
    uint32_t *table = mem_alloc(allocator, size, sizeof *table);
    if (!table)
        return false;
    memset(table, 0xff, size * sizeof *table);
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        const float *position = p->positions + 3 * (size_t)i;
        const float *normal = p->normals + 3 * (size_t)i;
        const float *uv = space->uvs + 2 * (size_t)i;
        uint32_t hash = hash_floats(uv, 2, hash_floats(normal, 3, hash_floats(position, 3, 0x811c9dc5u)));
        size_t slot = hash & (size - 1);
        space->welded[i] = i;
        for (; table[slot] != SCENE_NONE; slot = (slot + 1) & (size - 1)) {
            size_t other = table[slot];
            if (equal_floats(position, p->positions + 3 * other, 3) &&
                equal_floats(normal, p->normals + 3 * other, 3) &&
                equal_floats(uv, space->uvs + 2 * other, 2)) {
                space->welded[i] = (uint32_t)other;
                break;
            }
        }
        if (space->welded[i] == i)
            table[slot] = i;
    }
    mem_free(table);
    return true;
}

/* ---- 2. triangles ---- */

/* The gradient of position by u over a triangle, up to a positive factor: with edges d1, d2 in space and
 * (u1, v1), (u2, v2) in the texture, (v2 d1 - v1 d2) times the sign of the texture's area. */
static void set_up_triangle(const tangent_space *space, const uint32_t *indices, triangle *t)
{
    const scene_primitive *p = space->primitive;
    const float *positions[3];
    const float *uvs[3];
    for (int k = 0; k < 3; k++) {
        t->vertices[k] = space->welded[indices[k]];
        t->neighbors[k] = t->groups[k] = SCENE_NONE;
        positions[k] = p->positions + 3 * (size_t)t->vertices[k];
        uvs[k] = space->uvs + 2 * (size_t)t->vertices[k];
    }
    t->is_degenerate = equal_floats(positions[0], positions[1], 3) ||
                       equal_floats(positions[1], positions[2], 3) ||
                       equal_floats(positions[2], positions[0], 3);
    float u1 = uvs[1][0] - uvs[0][0];
    float v1 = uvs[0][1] - uvs[1][1]; /* up */
    float u2 = uvs[2][0] - uvs[0][0];
    float v2 = uvs[0][1] - uvs[2][1];
    float area = u1 * v2 - v1 * u2;
    float along_v[3];
    for (int k = 0; k < 3; k++) {
        float d1 = positions[1][k] - positions[0][k];
        float d2 = positions[2][k] - positions[0][k];
        t->direction[k] = area < 0.0f ? v1 * d2 - v2 * d1 : v2 * d1 - v1 * d2;
        along_v[k] = u1 * d2 - u2 * d1;
    }
    t->is_mirrored = !(area > 0.0f);
    bool has_u = normalise(t->direction);
    bool has_v = fabsf(along_v[0]) > FLT_MIN || fabsf(along_v[1]) > FLT_MIN || fabsf(along_v[2]) > FLT_MIN;
    t->is_unclear = !(fabsf(area) > FLT_MIN) || !has_u || !has_v;
}

static void set_up_triangles(void *context, size_t begin, size_t end)
{
    const tangent_space *space = context;
    for (size_t i = begin; i < end; i++)
        set_up_triangle(space, space->primitive->indices + 3 * i, &space->triangles[i]);
}

/* ---- neighbors ---- */

/* A half edge, stored at its smaller vertex. */
typedef struct edge {
    uint32_t other;   /* the larger vertex */
    uint32_t corner;  /* 3 * triangle + its first corner */
    bool is_backward; /* from the larger to the smaller vertex */
} edge;

/* Sorts by (other, corner), the latter being the order of input. Heap sort, since a vertex may have any
 * number of edges, although most have six. */
static bool is_before(const edge *a, const edge *b)
{
    return a->other != b->other ? a->other < b->other : a->corner < b->corner;
}

static void sift_down(edge *edges, size_t root, size_t count)
{
    edge moved = edges[root];
    for (size_t child = 2 * root + 1; child < count; child = 2 * root + 1) {
        if (child + 1 < count && is_before(&edges[child], &edges[child + 1]))
            child++;
        if (!is_before(&moved, &edges[child]))
            break;
        edges[root] = edges[child];
        root = child;
    }
    edges[root] = moved;
}

static void sort_edges(edge *edges, size_t count)
{
    if (count <= 24) {
        for (size_t i = 1; i < count; i++) {
            edge moved = edges[i];
            size_t k = i;
            for (; k > 0 && is_before(&moved, &edges[k - 1]); k--)
                edges[k] = edges[k - 1];
            edges[k] = moved;
        }
        return;
    }
    for (size_t i = count / 2; i-- > 0;)
        sift_down(edges, i, count);
    for (size_t end = count - 1; end > 0; end--) {
        edge last = edges[end];
        edges[end] = edges[0];
        edges[0] = last;
        sift_down(edges, 0, end);
    }
}

/* Pairs edges between the same two vertices with opposite directions: the first unpaired one with the next
 * match. With more than two triangles at an edge the order of input decides. */
static void pair_edges(tangent_space *space, edge *edges, size_t count)
{
    sort_edges(edges, count);
    for (size_t begin = 0, end; begin < count; begin = end) {
        for (end = begin; end < count && edges[end].other == edges[begin].other;)
            end++;
        size_t waiting = begin; /* unpaired edges from here to i run like edges[waiting] */
        for (size_t i = begin; i < end; i++) {
            if (waiting == i || edges[i].is_backward == edges[waiting].is_backward)
                continue;
            uint32_t a = edges[waiting].corner;
            uint32_t b = edges[i].corner;
            space->triangles[a / 3].neighbors[a % 3] = b / 3;
            space->triangles[b / 3].neighbors[b % 3] = a / 3;
            edges[i].other = SCENE_NONE; /* paired; its direction is no longer used */
            do
                waiting++;
            while (waiting <= i && edges[waiting].other == SCENE_NONE);
        }
    }
}

static bool connect(tangent_space *space, const facet_allocator *allocator)
{
    uint32_t vertex_count = space->primitive->vertex_count;
    size_t *begins = mem_zalloc(allocator, (size_t)vertex_count + 2, sizeof *begins);
    edge *edges = mem_alloc(allocator, 3 * (size_t)space->triangle_count, sizeof *edges);
    bool is_done = begins && edges;
    /* Counts, sums, then places edges: begins[v + 1] advances from the begin of v to its end. */
    for (int pass = 0; pass < 2 && is_done; pass++) {
        for (uint32_t i = 0; i < space->triangle_count; i++) {
            const triangle *t = &space->triangles[i];
            for (uint32_t k = 0; k < 3 && !t->is_degenerate; k++) {
                uint32_t from = t->vertices[k];
                uint32_t to = t->vertices[(k + 1) % 3];
                uint32_t low = from < to ? from : to;
                if (pass == 0)
                    begins[low + 2]++;
                else
                    edges[begins[low + 1]++] =
                        (edge){.other = from < to ? to : from, .corner = 3 * i + k, .is_backward = to < from};
            }
        }
        for (uint32_t v = 0; v < vertex_count && pass == 0; v++)
            begins[v + 2] += begins[v + 1];
    }
    for (uint32_t v = 0; v < vertex_count && is_done; v++)
        pair_edges(space, edges + begins[v], begins[v + 1] - begins[v]);
    mem_free(begins);
    mem_free(edges);
    return is_done;
}

/* ---- 3. groups ---- */

/* Adds triangle i to a group at vertex, if it is allowed. A triangle without orientation takes that of the
 * first group that reaches any of its corners. Returns its corner, or -1. */
static int join(tangent_space *space, uint32_t i, uint32_t vertex, uint32_t group, bool is_mirrored)
{
    triangle *t = &space->triangles[i];
    int corner = t->vertices[0] == vertex ? 0 : t->vertices[1] == vertex ? 1 : 2;
    if (t->groups[corner] != SCENE_NONE)
        return -1;
    if (t->is_unclear && t->groups[0] == SCENE_NONE && t->groups[1] == SCENE_NONE &&
        t->groups[2] == SCENE_NONE)
        t->is_mirrored = is_mirrored;
    if (t->is_mirrored != is_mirrored)
        return -1;
    t->groups[corner] = group;
    return corner;
}

static void group_corners(tangent_space *space)
{
    for (uint32_t i = 0; i < space->triangle_count; i++) {
        const triangle *t = &space->triangles[i];
        for (int corner = 0; corner < 3 && !t->is_degenerate && !t->is_unclear; corner++) {
            if (t->groups[corner] != SCENE_NONE)
                continue;
            uint32_t vertex = t->vertices[corner];
            uint32_t group = space->group_count++;
            join(space, i, vertex, group, t->is_mirrored);
            /* Triangles around a vertex are a fan: walk to one end, then to the other. */
            for (int side = 0; side < 2; side++) {
                uint32_t at = i;
                int at_corner = corner;
                while (at_corner >= 0) {
                    at = space->triangles[at].neighbors[side == 0 ? at_corner : (at_corner + 2) % 3];
                    at_corner = at == SCENE_NONE ? -1 : join(space, at, vertex, group, t->is_mirrored);
                }
            }
        }
    }
}

/* ---- 4. tangents ---- */

/* The angle of a triangle at a corner, projected along the normal there. */
static float corner_angle(const tangent_space *space, const triangle *t, int corner, const float normal[3])
{
    const float *positions = space->primitive->positions;
    const float *here = positions + 3 * (size_t)t->vertices[corner];
    const float *next = positions + 3 * (size_t)t->vertices[(corner + 1) % 3];
    const float *previous = positions + 3 * (size_t)t->vertices[(corner + 2) % 3];
    float a[3];
    float b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = next[k] - here[k];
        b[k] = previous[k] - here[k];
    }
    if (!project(a, normal) || !project(b, normal))
        return 0.0f;
    float cosine = dot3(a, b);
    return acosf(cosine < -1.0f ? -1.0f : cosine > 1.0f ? 1.0f : cosine);
}

/* Marks a group's tangent as an unfinished sum, in place of the sign. */
static const float UNFINISHED = 2.0f;

/* Writes each corner's contribution to its group to out: the triangle's direction, perpendicular to the
 * normal there, times its angle. */
static void weigh_corners(void *context, size_t begin, size_t end)
{
    const tangent_space *space = context;
    for (size_t i = begin; i < end; i++) {
        const triangle *t = &space->triangles[i];
        for (int corner = 0; corner < 3; corner++) {
            float *share = space->out + 4 * (3 * i + (size_t)corner);
            const float *normal = space->primitive->normals + 3 * (size_t)t->vertices[corner];
            memcpy(share, t->direction, sizeof t->direction);
            bool is_used = t->groups[corner] != SCENE_NONE && !t->is_unclear && project(share, normal);
            float weight = is_used ? corner_angle(space, t, corner, normal) : 0.0f;
            for (int k = 0; k < 3; k++)
                share[k] = is_used ? weight * share[k] : 0.0f;
        }
    }
}

/* In the order of triangles, on one thread, so that sums do not depend on the number of threads. */
static void sum_tangents(tangent_space *space)
{
    for (size_t i = 0; i < space->triangle_count; i++) {
        const triangle *t = &space->triangles[i];
        for (size_t corner = 0; corner < 3; corner++) {
            if (t->groups[corner] == SCENE_NONE)
                continue;
            const float *share = space->out + 4 * (3 * i + corner);
            float *sum = space->tangents + 4 * (size_t)t->groups[corner];
            sum[3] = t->is_mirrored ? -UNFINISHED : UNFINISHED;
            for (int k = 0; k < 3; k++)
                sum[k] += share[k];
        }
    }
}

/* Finishes the sum of a group on first use. It is made perpendicular once more, since a long sum drifts. */
static void finish(float *tangent, const float normal[3])
{
    if (fabsf(tangent[3]) != UNFINISHED)
        return;
    tangent[3] = tangent[3] < 0.0f ? -1.0f : 1.0f;
    if (!normalise(tangent) || !project(tangent, normal))
        any_perpendicular(normal, tangent);
}

/* Corners of degenerate triangles take the group of another corner at the same vertex; any_group is one
 * per vertex. */
static void write_tangents(tangent_space *space, const uint32_t *any_group, float *out)
{
    for (uint32_t i = 0; i < space->triangle_count; i++) {
        const triangle *t = &space->triangles[i];
        for (uint32_t corner = 0; corner < 3; corner++) {
            float *tangent = out + 4 * (3 * (size_t)i + corner);
            uint32_t vertex = t->vertices[corner];
            uint32_t group = t->groups[corner] != SCENE_NONE ? t->groups[corner] : any_group[vertex];
            const float *normal = space->primitive->normals + 3 * (size_t)vertex;
            if (group == SCENE_NONE) {
                any_perpendicular(normal, tangent);
                tangent[3] = 1.0f;
            } else {
                finish(space->tangents + 4 * (size_t)group, normal);
                memcpy(tangent, space->tangents + 4 * (size_t)group, 4 * sizeof *tangent);
            }
        }
    }
}

facet_result scene_generate_tangents(const scene_primitive *primitive, uint32_t uv_set,
                                     const facet_allocator *allocator, float *out, facet_error *error)
{
    tangent_space space = {.primitive = primitive,
                           .uvs = primitive->texcoords[uv_set],
                           .triangle_count = primitive->index_count / 3,
                           .out = out};
    uint32_t *any_group = NULL;
    facet_result result = FACET_OK;
    space.welded = mem_alloc(allocator, primitive->vertex_count, sizeof *space.welded);
    space.triangles = mem_alloc(allocator, space.triangle_count, sizeof *space.triangles);
    any_group = mem_alloc(allocator, primitive->vertex_count, sizeof *any_group);
    if (!space.welded || !space.triangles || !any_group || !weld(&space, allocator))
        goto no_memory;
    parallel_for(0, space.triangle_count, GRAIN, set_up_triangles, &space);
    if (!connect(&space, allocator))
        goto no_memory;
    group_corners(&space);
    space.tangents = mem_zalloc(allocator, space.group_count, 4 * sizeof *space.tangents);
    if (!space.tangents)
        goto no_memory;
    parallel_for(0, space.triangle_count, GRAIN, weigh_corners, &space);
    sum_tangents(&space);
    memset(any_group, 0xff, primitive->vertex_count * sizeof *any_group);
    for (uint32_t i = 0; i < space.triangle_count; i++)
        for (int corner = 0; corner < 3; corner++) {
            uint32_t *group = &any_group[space.triangles[i].vertices[corner]];
            if (*group == SCENE_NONE)
                *group = space.triangles[i].groups[corner];
        }
    write_tangents(&space, any_group, out);
    goto done;
no_memory:
    result = fail_memory(error, "tangents", (size_t)space.triangle_count * sizeof *space.triangles);
done:
    mem_free(space.welded);
    mem_free(space.triangles);
    mem_free(space.tangents);
    mem_free(any_group);
    return result;
}
