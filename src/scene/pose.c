/* pose.c - evaluates the node hierarchy of one scene: instances, lights and cameras in world space, bounds. */
#include "scene/scene.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/result.h"

enum { MAX_INSTANCES = 1 << 22, BOUNDS_GRAIN = 1 << 15 /* indices that one thread takes at once */ };

static mat4 local_matrix(const scene_node *node)
{
    return node->has_matrix ? node->matrix : mat4_from_trs(node->translation, node->rotation, node->scale);
}

static bool is_finite_matrix(const mat4 *m)
{
    for (int i = 0; i < 16; i++)
        if (!(fabsf(m->m[i]) <= SCENE_FARTHEST))
            return false;
    return true;
}

/* Whether the world's basis vectors span space, judged relative to their lengths: a scale of 1e-10 is fine. */
static bool is_regular(const mat4 *world)
{
    double a[9];
    double lengths = 1.0;
    for (int column = 0; column < 3; column++) {
        double sum = 0.0;
        for (int row = 0; row < 3; row++) {
            a[3 * column + row] = (double)world->m[4 * column + row];
            sum += a[3 * column + row] * a[3 * column + row];
        }
        lengths *= sqrt(sum);
    }
    double determinant = a[0] * (a[4] * a[8] - a[7] * a[5]) - a[3] * (a[1] * a[8] - a[7] * a[2]) +
                         a[6] * (a[1] * a[5] - a[4] * a[2]);
    return lengths > 0.0 && fabs(determinant) > 1e-9 * lengths;
}

/* ---- world matrices ---- */

/* The nodes that a scene draws, parents before children, with their world matrices. */
typedef struct visit {
    uint32_t *nodes;
    mat4 *worlds;
    size_t count;
} visit;

static void visit_add(visit *v, const facet_scene *scene, uint32_t node, const mat4 *parent)
{
    /* The reader made sure that every node has one parent at most; a root that is named twice is drawn once. */
    if (v->count == scene->node_count || scene->nodes[node].is_hidden)
        return;
    v->nodes[v->count] = node;
    v->worlds[v->count] = mat4_multiply(*parent, local_matrix(&scene->nodes[node]));
    v->count++;
}

/* Breadth first: what was added is the queue. */
static void visit_scene(visit *v, const facet_scene *scene, uint32_t index)
{
    mat4 identity = mat4_identity();
    if (scene->scene_count == 0) {
        for (uint32_t i = 0; i < scene->node_count; i++)
            if (scene->nodes[i].parent == SCENE_NONE)
                visit_add(v, scene, i, &identity);
    } else {
        const scene_root *root = &scene->scenes[index];
        for (uint32_t i = 0; i < root->node_count; i++)
            visit_add(v, scene, root->nodes[i], &identity);
    }
    for (size_t i = 0; i < v->count; i++) {
        const scene_node *node = &scene->nodes[v->nodes[i]];
        for (uint32_t k = 0; k < node->child_count; k++)
            visit_add(v, scene, node->children[k], &v->worlds[i]);
    }
}

/* ---- bounds ---- */

typedef struct box {
    float minimum[3], maximum[3];
} box;

static const box EMPTY_BOX = {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};

static void box_add(box *b, const float p[3])
{
    for (int axis = 0; axis < 3; axis++) {
        b->minimum[axis] = p[axis] < b->minimum[axis] ? p[axis] : b->minimum[axis];
        b->maximum[axis] = p[axis] > b->maximum[axis] ? p[axis] : b->maximum[axis];
    }
}

/* Whether each world axis depends on one local axis only. Then the transform is monotone along each axis, and the
 * box of the transformed vertices is the transformed box, to the last bit. */
static bool keeps_boxes(const mat4 *m)
{
    for (int row = 0; row < 3; row++) {
        int used = 0;
        for (int column = 0; column < 3; column++)
            used += m->m[4 * column + row] != 0.0f;
        if (used > 1)
            return false;
    }
    return true;
}

typedef struct bounds_job {
    const scene_instance *instance;
    box *boxes; /* one per BOUNDS_GRAIN indices */
} bounds_job;

static void bounds_body(void *context, size_t begin, size_t end)
{
    const bounds_job *job = context;
    const scene_primitive *primitive = job->instance->primitive;
    box b = EMPTY_BOX;
    for (size_t i = begin; i < end; i++) {
        float p[3];
        mat4_transform_point(&job->instance->world,
                             job->instance->positions + 3 * (size_t)primitive->indices[i], p);
        box_add(&b, p);
    }
    job->boxes[begin / BOUNDS_GRAIN] = b;
}

/* World bounds of one instance; exact. boxes has room for the largest primitive. */
static box instance_bounds(const scene_instance *instance, box *boxes, uint32_t thread_count)
{
    const scene_primitive *primitive = instance->primitive;
    box b = EMPTY_BOX;
    if (primitive->index_count == 0)
        return b;
    if (keeps_boxes(&instance->world)) {
        float p[3];
        mat4_transform_point(&instance->world, primitive->bounds_min, p);
        box_add(&b, p);
        mat4_transform_point(&instance->world, primitive->bounds_max, p);
        box_add(&b, p);
        return b;
    }
    bounds_job job = {.instance = instance, .boxes = boxes};
    parallel_for(thread_count, primitive->index_count, BOUNDS_GRAIN, bounds_body, &job);
    size_t box_count = (primitive->index_count + (size_t)BOUNDS_GRAIN - 1) / BOUNDS_GRAIN;
    for (size_t i = 0; i < box_count; i++) {
        box_add(&b, boxes[i].minimum);
        box_add(&b, boxes[i].maximum);
    }
    return b;
}

static bool is_finite_box(const box *b)
{
    for (int axis = 0; axis < 3; axis++)
        if (!(fabsf(b->minimum[axis]) <= SCENE_FARTHEST && fabsf(b->maximum[axis]) <= SCENE_FARTHEST))
            return false;
    return true;
}

/* ---- the pose ---- */

static void add_instance(scene_pose *pose, const facet_scene *scene, uint32_t node, uint32_t index,
                         const mat4 *world)
{
    uint32_t mesh = scene->nodes[node].mesh;
    const scene_primitive *primitive = &scene->meshes[mesh].primitives[index];
    scene_instance *instance = &pose->instances[pose->instance_count++];
    *instance = (scene_instance){.primitive = primitive,
                                 .positions = primitive->positions,
                                 .normals = primitive->normals,
                                 .tangents = primitive->tangents,
                                 .material = primitive->material,
                                 .world = *world,
                                 .is_mirrored = mat4_determinant3(*world) < 0.0f,
                                 .node = node,
                                 .mesh = mesh,
                                 .primitive_index = index};
    /* Scaled to about 1 first: the cofactors of a scale of 1e-15 are below the smallest float. */
    float largest = 0.0f;
    for (int i = 0; i < 12; i++)
        if (i % 4 != 3)
            largest = fmaxf(largest, fabsf(world->m[i]));
    mat4 scaled = *world;
    for (int i = 0; i < 12; i++)
        scaled.m[i] /= largest;
    instance->is_mirrored = mat4_determinant3(scaled) < 0.0f;
    mat4_normal_matrix(&scaled, instance->normal_matrix);
    if (instance->is_mirrored)
        for (int i = 0; i < 9; i++)
            instance->normal_matrix[i] = -instance->normal_matrix[i];
}

static bool normalise(float v[3])
{
    double length =
        sqrt((double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] + (double)v[2] * (double)v[2]);
    if (!(length > 0.0))
        return false;
    for (int i = 0; i < 3; i++)
        v[i] = (float)((double)v[i] / length);
    return true;
}

static void add_light(scene_pose *pose, const facet_scene *scene, uint32_t node, const mat4 *world)
{
    scene_posed_light light = {.light = scene->lights[scene->nodes[node].light], .node = node};
    const float forward[3] = {0, 0, -1};
    memcpy(light.position, world->m + 12, sizeof light.position);
    mat4_transform_vector(world, forward, light.direction);
    if (normalise(light.direction))
        pose->lights[pose->light_count++] = light;
}

/* Counts first, then allocates, then fills. */
static facet_result allocate(scene_pose *pose, const facet_scene *scene, const visit *v,
                             const facet_allocator *allocator, facet_error *error)
{
    size_t instances = 0;
    size_t lights = 0;
    size_t cameras = 0;
    for (size_t i = 0; i < v->count; i++) {
        const scene_node *node = &scene->nodes[v->nodes[i]];
        if (node->mesh != SCENE_NONE)
            instances += scene->meshes[node->mesh].primitive_count;
        lights += node->light != SCENE_NONE;
        cameras += node->camera != SCENE_NONE;
        if (instances > MAX_INSTANCES)
            return fail(error, FACET_ERROR_LIMIT, "%s: draws more than %d primitives", scene->source,
                        (int)MAX_INSTANCES);
    }
    pose->instances = mem_alloc(allocator, instances, sizeof *pose->instances);
    pose->lights = mem_alloc(allocator, lights, sizeof *pose->lights);
    pose->cameras = mem_alloc(allocator, cameras, sizeof *pose->cameras);
    if (!pose->instances || !pose->lights || !pose->cameras)
        return fail_memory(error, "instances", instances * sizeof *pose->instances);
    return FACET_OK;
}

static void fill(scene_pose *pose, const facet_scene *scene, const visit *v)
{
    for (size_t i = 0; i < v->count; i++) {
        uint32_t index = v->nodes[i];
        const scene_node *node = &scene->nodes[index];
        const mat4 *world = &v->worlds[i];
        if (!is_finite_matrix(world))
            continue;
        if (node->light != SCENE_NONE)
            add_light(pose, scene, index, world);
        if (node->camera != SCENE_NONE)
            pose->cameras[pose->camera_count++] = (scene_posed_camera){.camera = scene->cameras[node->camera],
                                                                       .index = node->camera,
                                                                       .world = *world,
                                                                       .node = index};
        if (node->mesh != SCENE_NONE && is_regular(world))
            for (uint32_t k = 0; k < scene->meshes[node->mesh].primitive_count; k++)
                if (scene->meshes[node->mesh].primitives[k].index_count)
                    add_instance(pose, scene, index, k, world);
    }
}

/* Drops instances that leave the space where floats can be squared; the others make the bounds. */
static facet_result bound(scene_pose *pose, const facet_allocator *allocator, uint32_t thread_count,
                          facet_error *error)
{
    size_t most = 0;
    for (uint32_t i = 0; i < pose->instance_count; i++)
        if (pose->instances[i].primitive->index_count > most)
            most = pose->instances[i].primitive->index_count;
    size_t box_count = most / BOUNDS_GRAIN + 1;
    box *boxes = mem_alloc(allocator, box_count, sizeof *boxes);
    if (!boxes)
        return fail_memory(error, "bounds", box_count * sizeof *boxes);
    box all = EMPTY_BOX;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < pose->instance_count; i++) {
        box b = instance_bounds(&pose->instances[i], boxes, thread_count);
        if (!is_finite_box(&b))
            continue;
        box_add(&all, b.minimum);
        box_add(&all, b.maximum);
        pose->instances[kept++] = pose->instances[i];
    }
    mem_free(boxes);
    pose->instance_count = kept;
    pose->has_bounds = kept > 0;
    for (int axis = 0; axis < 3; axis++) {
        pose->bounds_min[axis] = kept ? all.minimum[axis] : 0.0f;
        pose->bounds_max[axis] = kept ? all.maximum[axis] : 0.0f;
    }
    return FACET_OK;
}

const scene_material *scene_pose_material(const facet_scene *scene, const scene_pose *pose,
                                          const scene_instance *instance)
{
    return instance->material == SCENE_NONE ? scene_get_material(scene, SCENE_NONE)
                                            : &pose->materials[instance->material];
}

facet_result scene_pose_create(const facet_scene *scene, const facet_pose_desc *desc,
                               const facet_allocator *allocator, uint32_t thread_count, scene_pose *pose,
                               facet_error *error)
{
    *pose = (scene_pose){.materials = scene->materials};
    uint32_t index = desc ? desc->scene_index : 0;
    if (!desc || !desc->has_scene_index)
        index = scene->default_scene == SCENE_NONE ? 0 : scene->default_scene;
    uint32_t scene_count = scene->scene_count ? scene->scene_count : 1;
    if (index >= scene_count)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: has no scene %u; the last one is %u", scene->source,
                    index, scene_count - 1);

    facet_result result = FACET_ERROR_MEMORY;
    visit v = {.nodes = mem_alloc(allocator, scene->node_count, sizeof *v.nodes),
               .worlds = mem_alloc(allocator, scene->node_count, sizeof *v.worlds)};
    if (!v.nodes || !v.worlds) {
        fail_memory(error, "world matrices", scene->node_count * sizeof *v.worlds);
        goto done;
    }
    visit_scene(&v, scene, index);
    result = allocate(pose, scene, &v, allocator, error);
    if (result != FACET_OK)
        goto done;
    fill(pose, scene, &v);
    result = bound(pose, allocator, thread_count, error);
done:
    mem_free(v.nodes);
    mem_free(v.worlds);
    if (result != FACET_OK)
        scene_pose_destroy(pose);
    return result;
}

void scene_pose_destroy(scene_pose *pose)
{
    mem_free(pose->instances);
    mem_free(pose->lights);
    mem_free(pose->cameras);
    *pose = (scene_pose){0};
}
