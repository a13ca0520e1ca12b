/* origin.c - see origin.h. */
#include "scene/origin.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/result.h"
#include "scene/box.h"
#include "scene/hierarchy.h"

enum {
    SAMPLES = 1024,    /* vertices sampled in a scene */
    MAX_ANCESTORS = 64 /* vertices sampled in a node */
};

/* A model is far beyond this multiple of its size from the origin. Positions of a mesh are moved earlier,
 * since that is cheaper and errors show earlier, in normals and tangents between neighbors. */
static const double FAR_RATIO = 16.0, MESH_RATIO = 4.0;
/* Steps of floats above this fraction of a mesh are visible in its shading. */
static const double COARSE = 0x1p-15;

/* ---- where points lie ---- */

typedef struct samples {
    double axes[3][SAMPLES];
    double reach[SAMPLES]; /* the largest coordinate along the chain of transforms to the point */
    size_t count;
} samples;

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The center of a point cloud per axis, and its size, without a twentieth of the points at either end of
 * each axis. A single point counts as 1 m, as in framing. Sorts. */
static double measure(samples *s, double middle[3])
{
    double square = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        double *values = s->axes[axis];
        size_t few = (s->count - 1) / 20;
        qsort(values, s->count, sizeof *values, compare);
        double low = values[few], high = values[s->count - 1 - few];
        middle[axis] = 0.5 * (low + high);
        square += (high - low) * (high - low);
    }
    double size = sqrt(square);
    return size > 0.0 ? size : 1.0;
}

/* 0 for near models. Otherwise a multiple of a power of two of about the size, so that the subtraction is
 * exact and the number readable. */
static double choose(double middle, double size, double ratio)
{
    if (!(fabs(middle) > ratio * size && fabs(middle) < (double)SCENE_FARTHEST))
        return 0.0;
    double unit = exp2(ceil(log2(size)));
    return round(middle / unit) * unit;
}

bool scene_find_origin(const float *positions, size_t count, const facet_allocator *allocator,
                       double origin[3])
{
    samples *s = mem_alloc(allocator, 1, sizeof *s);
    memset(origin, 0, 3 * sizeof *origin);
    if (!s)
        return false;
    s->count = 0;
    size_t step = count / SAMPLES + 1;
    for (size_t i = 0; i < count; i += step) {
        const float *p = positions + 3 * i;
        if (!(fabsf(p[0]) <= SCENE_FARTHEST && fabsf(p[1]) <= SCENE_FARTHEST &&
              fabsf(p[2]) <= SCENE_FARTHEST))
            continue;
        for (int axis = 0; axis < 3; axis++)
            s->axes[axis][s->count] = (double)p[axis];
        s->count++;
    }
    if (s->count > 0) {
        double middle[3];
        double size = measure(s, middle);
        for (int axis = 0; axis < 3; axis++)
            origin[axis] = choose(middle[axis], size, FAR_RATIO);
    }
    mem_free(s);
    return origin[0] != 0.0 || origin[1] != 0.0 || origin[2] != 0.0;
}

/* ---- a scene ---- */

/* Indices of a primitive in all its copies. */
static uint64_t drawn_indices(const scene_node *node, const scene_primitive *p)
{
    bool is_skinned = node->skin != SCENE_NONE && p->influence_count > 0;
    uint64_t copies = node->instancing && !is_skinned ? node->instancing->count : 1;
    return copies * p->index_count;
}

/* From the mesh to the file's world, for a vertex of a copy. */
static dmat4 vertex_matrix(const facet_scene *scene, hierarchy *h, uint32_t node, const scene_primitive *p,
                           uint32_t vertex, uint32_t copy)
{
    const scene_node *n = &h->nodes[node];
    if (n->skin != SCENE_NONE && p->influence_count > 0) {
        const scene_skin *skin = &scene->skins[n->skin];
        uint32_t joint = p->joints[(size_t)p->influence_count * vertex];
        if (joint >= skin->joint_count)
            return dmat4_identity();
        dmat4 world = hierarchy_world(h, skin->joints[joint]);
        dmat4 bind = skin->inverse_bind ? dmat4_from_float(&skin->inverse_bind[joint]) : dmat4_identity();
        return dmat4_multiply(&world, &bind);
    }
    dmat4 world = hierarchy_shown_world(h, node);
    if (!n->instancing)
        return world;
    copy_place place = hierarchy_copy(n->instancing, copy);
    dmat4 inner = copy_place_matrix(&place);
    return dmat4_multiply(&world, &inner);
}

static double farthest(const double p[3])
{
    return fmax(fabs(p[0]), fmax(fabs(p[1]), fabs(p[2])));
}

static void add_sample(samples *s, const dmat4 *world, const double local[3], double ancestors)
{
    double p[3];
    dmat4_transform_point(world, local, p);
    for (int axis = 0; axis < 3; axis++)
        if (!(fabs(p[axis]) <= (double)SCENE_FARTHEST)) /* nor NaN */
            return;
    if (s->count == SAMPLES)
        return;
    const double inner[3] = {p[0] - world->m[12], p[1] - world->m[13], p[2] - world->m[14]};
    for (int axis = 0; axis < 3; axis++)
        s->axes[axis][s->count] = p[axis];
    s->reach[s->count++] = fmax(fmax(farthest(world->m + 12), farthest(inner)), ancestors);
}

/* Worlds of the parents of all nodes. */
static double reach_of_ancestors(hierarchy *h, uint32_t node)
{
    double reach = 0.0;
    uint32_t up = h->nodes[node].parent;
    for (int i = 0; i < MAX_ANCESTORS && up != SCENE_NONE; i++, up = h->nodes[up].parent) {
        dmat4 world = hierarchy_world(h, up);
        reach = fmax(reach, farthest(world.m + 12));
    }
    return reach;
}

typedef struct sampling {
    const facet_scene *scene;
    hierarchy *h;
    samples *out;
    uint64_t step, next; /* of the indices of everything drawn, in order */
    uint64_t begin;      /* position of the primitive in that order */
} sampling;

static void sample_primitive(sampling *g, uint32_t node, const scene_mesh *mesh, const scene_primitive *p)
{
    uint64_t end = g->begin + drawn_indices(&g->h->nodes[node], p);
    double ancestors = g->next < end ? reach_of_ancestors(g->h, node) : 0.0;
    for (; g->next < end; g->next += g->step) {
        uint32_t vertex = p->indices[(g->next - g->begin) % p->index_count];
        uint32_t copy = (uint32_t)((g->next - g->begin) / p->index_count);
        dmat4 world = vertex_matrix(g->scene, g->h, node, p, vertex, copy);
        double local[3];
        for (int axis = 0; axis < 3; axis++)
            local[axis] = mesh->origin[axis] + (double)p->positions[3 * (size_t)vertex + (size_t)axis];
        add_sample(g->out, &world, local, ancestors);
    }
    g->begin = end;
}

static void sample_scene(const facet_scene *scene, hierarchy *h, samples *out)
{
    uint64_t total = 0;
    for (int pass = 0; pass < 2; pass++) {
        sampling g = {.scene = scene, .h = h, .out = out, .step = total / SAMPLES + 1};
        for (uint32_t i = 0; i < h->count; i++) {
            const scene_node *node = &h->nodes[h->shown[i]];
            const scene_mesh *mesh = node->mesh == SCENE_NONE ? NULL : &scene->meshes[node->mesh];
            for (uint32_t k = 0; mesh && k < mesh->primitive_count; k++)
                if (pass == 0)
                    total += drawn_indices(node, &mesh->primitives[k]);
                else
                    sample_primitive(&g, h->shown[i], mesh, &mesh->primitives[k]);
        }
    }
}

/* Computes the origin from the samples, in double even if the scene uses float. */
static facet_result find_scene_origin(facet_scene *scene, uint32_t index, const facet_pose_desc *desc,
                                      samples *s, facet_error *error)
{
    scene_state state;
    hierarchy h = {0};
    s->count = 0;
    memset(scene->origin, 0, sizeof scene->origin);
    scene->is_far = true;
    facet_result result = scene_state_create(scene, desc, &scene->allocator, &state, error);
    if (result == FACET_OK && !hierarchy_create(scene, &state, index, &scene->allocator, &h))
        result = fail_memory(error, "world matrices", scene->node_count * sizeof(dmat4));
    if (result == FACET_OK)
        sample_scene(scene, &h, s);
    hierarchy_destroy(&h);
    scene_state_destroy(&state);
    scene->is_far = false;
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        scene->is_far |= farthest(scene->meshes[i].origin) > 0.0;
    if (s->count == 0)
        return result;
    double middle[3];
    double size = measure(s, middle);
    for (int axis = 0; axis < 3; axis++) {
        scene->origin[axis] = choose(middle[axis], size, FAR_RATIO);
        scene->is_far |= scene->origin[axis] != 0.0;
    }
    qsort(s->reach, s->count, sizeof *s->reach, compare);
    scene->is_far |= s->reach[s->count / 2] > FAR_RATIO * size;
    return result;
}

/* ---- meshes ---- */

/* The object with the largest loss of detail: vertices of a mesh, or copies of a node. */
typedef struct coarseness {
    const char *owner, *name, *parts; /* "mesh", its name, "vertices"; NULL: no loss */
    double distance, step, share;
    uint64_t indices; /* of all affected; a few distant parts are ignored */
} coarseness;

/* Bounds of the drawn part of a mesh. */
static box bound_mesh(const scene_mesh *mesh)
{
    box b = box_empty();
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        const scene_primitive *p = &mesh->primitives[i];
        if (p->index_count > 0) {
            box_add(&b, p->bounds_min);
            box_add(&b, p->bounds_max);
        }
    }
    return b;
}

static uint64_t count_indices(const scene_mesh *mesh)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < mesh->primitive_count; i++)
        count += mesh->primitives[i].index_count;
    return count;
}

static double size_of(const box *b)
{
    double size = 0.0;
    for (int axis = 0; axis < 3; axis++)
        size = hypot(size, (double)b->maximum[axis] - (double)b->minimum[axis]);
    return size;
}

/* size: of the contents of b, which may be larger than b. */
static void note_steps(coarseness *worst, const box *b, double size, const scene_mesh *mesh,
                       const char *owner, const char *name, const char *parts)
{
    float distance = 0.0f;
    for (int axis = 0; axis < 3; axis++)
        distance = fmaxf(distance, fmaxf(fabsf(b->minimum[axis]), fabsf(b->maximum[axis])));
    double step = (double)nextafterf(distance, INFINITY) - (double)distance;
    if (!(step > COARSE * size))
        return;
    uint64_t indices = worst->indices + count_indices(mesh);
    if (step > worst->share * size)
        *worst = (coarseness){owner, name, parts, (double)distance, step, step / size, 0};
    worst->indices = indices;
}

static void note_copies(const facet_scene *scene, const scene_node *node, coarseness *worst)
{
    if (!node->instancing || !node->instancing->translations || node->mesh == SCENE_NONE)
        return;
    box b = box_empty();
    for (size_t i = 0; i < node->instancing->count; i++)
        box_add(&b, node->instancing->translations + 3 * i);
    const box mesh = bound_mesh(&scene->meshes[node->mesh]);
    if (box_is_near(&b) && box_is_near(&mesh))
        note_steps(worst, &b, size_of(&b) + size_of(&mesh), &scene->meshes[node->mesh], "node", node->name,
                   "instances");
}

/* Primitives that share positions still do afterwards. */
static bool subtract(facet_scene *scene, scene_mesh *mesh, const double origin[3])
{
    const float *before = NULL, *after = NULL;
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        scene_primitive *p = &mesh->primitives[i];
        if (p->positions != before) {
            float *moved = arena_alloc(scene->arena, p->vertex_count, 3 * sizeof *moved);
            if (!moved)
                return false;
            for (size_t k = 0; k < 3 * (size_t)p->vertex_count; k++)
                moved[k] = (float)((double)p->positions[k] - origin[k % 3]);
            before = p->positions;
            after = moved;
        }
        p->positions = after;
        for (int axis = 0; axis < 3 && p->index_count > 0; axis++) {
            p->bounds_min[axis] = (float)((double)p->bounds_min[axis] - origin[axis]);
            p->bounds_max[axis] = (float)((double)p->bounds_max[axis] - origin[axis]);
        }
    }
    for (int axis = 0; axis < 3; axis++)
        mesh->origin[axis] += origin[axis];
    return true;
}

static bool move_mesh(facet_scene *scene, scene_mesh *mesh, coarseness *worst)
{
    const box b = bound_mesh(mesh);
    double origin[3], size = size_of(&b);
    if (!box_is_near(&b) || !(size > 0.0))
        return true;
    bool is_far = false;
    for (int axis = 0; axis < 3; axis++) {
        double middle = 0.5 * ((double)b.minimum[axis] + (double)b.maximum[axis]);
        origin[axis] = choose(middle, size, MESH_RATIO);
        is_far |= origin[axis] != 0.0;
    }
    if (!is_far)
        return true;
    note_steps(worst, &b, size, mesh, "mesh", mesh->name, "vertices");
    return subtract(scene, mesh, origin);
}

/* Vertices of skins stay, since several meshes share the matrices of joints. */
static facet_result move_meshes(facet_scene *scene, const facet_log *log, facet_error *error)
{
    coarseness worst = {.share = 0.0};
    bool *is_skinned = mem_zalloc(&scene->allocator, scene->mesh_count, sizeof *is_skinned);
    bool is_ok = is_skinned != NULL;
    for (uint32_t i = 0; is_ok && i < scene->node_count; i++) {
        if (scene->nodes[i].mesh != SCENE_NONE && scene->nodes[i].skin != SCENE_NONE)
            is_skinned[scene->nodes[i].mesh] = true;
        note_copies(scene, &scene->nodes[i], &worst);
    }
    uint64_t indices = 0;
    for (uint32_t i = 0; is_ok && i < scene->mesh_count; i++) {
        indices += count_indices(&scene->meshes[i]);
        if (!is_skinned[i])
            is_ok = move_mesh(scene, &scene->meshes[i], &worst);
    }
    mem_free(is_skinned);
    if (!is_ok)
        return fail_memory(error, "positions", scene->mesh_count * sizeof *is_skinned);
    if (worst.owner && worst.indices > indices / 20)
        scene_warn(
            scene, log,
            "%s: %s \"%s\" has %s %.3g m from its origin, where 32-bit numbers have steps of %.2g m: finer "
            "detail is lost in the file",
            scene->source, worst.owner, worst.name, worst.parts, worst.distance, worst.step);
    return FACET_OK;
}

facet_result scene_settle_origin(facet_scene *scene, const facet_pose_desc *desc, const facet_log *log,
                                 facet_error *error)
{
    uint32_t index;
    TRY(scene_pose_check(scene, desc, &index, error));
    if (scene->part_count)
        return FACET_OK;
    samples *s = mem_alloc(&scene->allocator, 1, sizeof *s);
    if (!s)
        return fail_memory(error, "samples", sizeof *s);
    scene->content_revision++;
    facet_result result = find_scene_origin(scene, index, desc, s, error);
    mem_free(s);
    TRY(result);
    return scene->is_far ? move_meshes(scene, log, error) : FACET_OK;
}
