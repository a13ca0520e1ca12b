/* pose.c - one scene of the file at one time: instances, lights and cameras in world space. Animation,
 * hierarchy, deformation and bounds have their own files. */
#include <math.h>
#include <string.h>

#include "base/result.h"
#include "scene/bounds.h"
#include "scene/deform.h"
#include "scene/unit.h"

enum { MAX_INSTANCES = 1 << 22 };

static bool is_finite_matrix(const mat4 *m)
{
    for (int i = 0; i < 16; i++)
        if (!(fabsf(m->m[i]) <= SCENE_FARTHEST))
            return false;
    return true;
}

/* Whether the world's basis vectors are independent relative to their lengths: a scale of 1e-10 is fine. */
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

/* The inputs of a pose. */
typedef struct pose_parts {
    const facet_scene *scene;
    uint32_t variant; /* SCENE_NONE: the file's materials */
    scene_state state;
    hierarchy nodes;
    deform_set deformed;
} pose_parts;

/* ---- instances ---- */

/* The cofactor matrix, of world scaled to about 1: the cofactors of a scale of 1e-15 are below the
 * smallest float. */
static void set_normal_matrix(scene_instance *instance)
{
    float largest = 0.0f;
    for (int i = 0; i < 12; i++)
        if (i % 4 != 3)
            largest = fmaxf(largest, fabsf(instance->world.m[i]));
    mat4 scaled = instance->world;
    for (int i = 0; i < 12; i++)
        scaled.m[i] /= largest;
    instance->is_mirrored = mat4_determinant3(scaled) < 0.0f;
    mat4_normal_matrix(&scaled, instance->normal_matrix);
    for (int i = 0; i < 9 && instance->is_mirrored; i++)
        instance->normal_matrix[i] = -instance->normal_matrix[i];
}

/* Adds a primitive at world unless world is singular. moved: its deformed vertices, NULL: the file's. */
static void add_instance(scene_pose *pose, const pose_parts *parts, uint32_t shown, uint32_t index,
                         const deformed *moved, const mat4 *world)
{
    if (!is_finite_matrix(world) || !is_regular(world))
        return;
    uint32_t node = parts->nodes.shown[shown];
    uint32_t mesh = parts->state.nodes[node].mesh;
    const scene_primitive *p = &parts->scene->meshes[mesh].primitives[index];
    scene_instance *instance = &pose->instances[pose->instance_count++];
    *instance = (scene_instance){.primitive = p,
                                 .positions = p->positions,
                                 .normals = p->normals,
                                 .tangents = p->tangents,
                                 .material = p->material,
                                 .world = *world,
                                 .node = node,
                                 .mesh = mesh,
                                 .primitive_index = index};
    set_normal_matrix(instance);
    if (parts->variant != SCENE_NONE && p->variant_materials &&
        p->variant_materials[parts->variant] != SCENE_NONE)
        instance->material = p->variant_materials[parts->variant];
    memcpy(instance->bounds_min, moved ? moved->bounds.minimum : p->bounds_min, sizeof p->bounds_min);
    memcpy(instance->bounds_max, moved ? moved->bounds.maximum : p->bounds_max, sizeof p->bounds_max);
    if (!moved)
        return;
    instance->is_deformed = true;
    instance->positions = moved->arrays.positions ? moved->arrays.positions : p->positions;
    instance->normals = moved->arrays.normals ? moved->arrays.normals : p->normals;
    instance->tangents = moved->arrays.tangents ? moved->arrays.tangents : p->tangents;
}

/* From the mesh's positions to the world. copy: NULL: the node is drawn once. */
static mat4 instance_world(const dmat4 *node, const copy_place *copy, bool is_far, const double origin[3])
{
    if (!is_far) {
        mat4 world = mat4_from_double(node);
        return copy ? mat4_multiply(world, mat4_from_trs(copy->translation, copy->rotation, copy->scale))
                    : world;
    }
    dmat4 inner = dmat4_translation(origin);
    if (copy) {
        dmat4 outer = copy_place_matrix(copy);
        inner = dmat4_multiply(&outer, &inner);
    }
    dmat4 world = dmat4_multiply(node, &inner);
    return mat4_from_double(&world);
}

/* How often a primitive of the mesh of a shown node is drawn; used by allocate() and fill(). The vertices
 * of a skin do not follow the node that has it (glTF 2.0 section 3.7.3.3), so that all of its instances
 * coincide. */
static uint32_t count_copies(const pose_parts *parts, uint32_t shown, uint32_t index)
{
    const deformed *moved = deform_get(&parts->deformed, shown, index);
    const scene_node *node = &parts->state.nodes[parts->nodes.shown[shown]];
    if (parts->scene->meshes[node->mesh].primitives[index].index_count == 0 || (moved && moved->is_unbounded))
        return 0;
    if (!node->instancing)
        return 1;
    return moved && moved->skin && node->instancing->count > 1 ? 1 : node->instancing->count;
}

static void add_primitive(scene_pose *pose, const pose_parts *parts, uint32_t shown, uint32_t index)
{
    const deformed *moved = deform_get(&parts->deformed, shown, index);
    uint32_t node = parts->nodes.shown[shown];
    const scene_node *at = &parts->state.nodes[node];
    uint32_t copies = count_copies(parts, shown, index);
    const double *origin = parts->scene->meshes[at->mesh].origin;
    dmat4 node_world = hierarchy_shown_world(&parts->nodes, node);
    for (uint32_t i = 0; i < copies; i++) {
        copy_place copy = {0};
        if (at->instancing)
            copy = hierarchy_copy(at->instancing, i);
        mat4 world = mat4_identity();
        if (moved && moved->skin)
            world.m[0] = moved->skin->is_mirrored ? -1.0f : 1.0f;
        else
            world = instance_world(&node_world, at->instancing ? &copy : NULL, parts->scene->is_far, origin);
        uint32_t before = pose->instance_count;
        add_instance(pose, parts, shown, index, moved, &world);
        if (pose->instance_count > before)
            pose->instances[before].copy = i;
    }
}

/* After instances were removed. */
static void mark_copies(scene_pose *pose)
{
    for (uint32_t i = 1; i < pose->instance_count; i++)
        pose->instances[i].is_copy =
            pose->instances[i].node == pose->instances[i - 1].node &&
            pose->instances[i].primitive_index == pose->instances[i - 1].primitive_index;
}

/* ---- lights and cameras ---- */

static bool normalise(float v[3])
{
    const double wide[3] = {(double)v[0], (double)v[1], (double)v[2]};
    return unit_from_double(wide, v);
}

static void add_light(scene_pose *pose, const scene_light *light, uint32_t node, const mat4 *world)
{
    scene_posed_light posed = {.light = *light, .node = node};
    const float forward[3] = {0, 0, -1};
    memcpy(posed.position, world->m + 12, sizeof posed.position);
    mat4_transform_vector(world, forward, posed.direction);
    if (is_finite_matrix(world) && normalise(posed.direction))
        pose->lights[pose->light_count++] = posed;
}

static void add_camera(scene_pose *pose, const scene_camera *camera, uint32_t index, uint32_t node,
                       const mat4 *world)
{
    if (is_finite_matrix(world))
        pose->cameras[pose->camera_count++] =
            (scene_posed_camera){.camera = *camera, .index = index, .world = *world, .node = node};
}

/* ---- the pose ---- */

/* Counts first, then allocates, then fills. */
static facet_result allocate(scene_pose *pose, const pose_parts *parts, const facet_allocator *allocator,
                             facet_error *error)
{
    size_t instances = 0;
    size_t lights = 0;
    size_t cameras = 0;
    for (uint32_t i = 0; i < parts->nodes.count; i++) {
        const scene_node *node = &parts->state.nodes[parts->nodes.shown[i]];
        uint32_t primitives = node->mesh == SCENE_NONE ? 0 : parts->scene->meshes[node->mesh].primitive_count;
        for (uint32_t k = 0; k < primitives && instances <= MAX_INSTANCES; k++)
            instances += count_copies(parts, i, k);
        lights += node->light != SCENE_NONE;
        cameras += node->camera != SCENE_NONE;
        if (instances > MAX_INSTANCES)
            return fail(error, FACET_ERROR_LIMIT, "%s: draws more than %d primitives", parts->scene->source,
                        (int)MAX_INSTANCES);
    }
    pose->instances = mem_alloc(allocator, instances, sizeof *pose->instances);
    pose->lights = mem_alloc(allocator, lights, sizeof *pose->lights);
    pose->cameras = mem_alloc(allocator, cameras, sizeof *pose->cameras);
    if (!pose->instances || !pose->lights || !pose->cameras)
        return fail_memory(error, "instances", instances * sizeof *pose->instances);
    return FACET_OK;
}

static void fill(scene_pose *pose, const pose_parts *parts)
{
    for (uint32_t i = 0; i < parts->nodes.count; i++) {
        uint32_t index = parts->nodes.shown[i];
        const scene_node *node = &parts->state.nodes[index];
        const dmat4 exact = hierarchy_shown_world(&parts->nodes, index);
        const mat4 world = mat4_from_double(&exact);
        if (node->light != SCENE_NONE)
            add_light(pose, &parts->state.lights[node->light], index, &world);
        if (node->camera != SCENE_NONE)
            add_camera(pose, &parts->state.cameras[node->camera], node->camera, index, &world);
        if (node->mesh != SCENE_NONE)
            for (uint32_t k = 0; k < parts->scene->meshes[node->mesh].primitive_count; k++)
                add_primitive(pose, parts, i, k);
    }
}

facet_result scene_pose_check(const facet_scene *scene, const facet_pose_desc *desc, uint32_t *index,
                              facet_error *error)
{
    *index = scene->default_scene == SCENE_NONE ? 0 : scene->default_scene;
    if (desc && desc->has_scene_index)
        *index = desc->scene_index;
    uint32_t scene_count = scene->scene_count ? scene->scene_count : 1;
    if (*index >= scene_count)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: has no scene %u; the last one is %u", scene->source,
                    *index, scene_count - 1);
    if (!desc || !desc->has_variant || desc->variant < scene->variant_count)
        return FACET_OK;
    if (scene->variant_count == 0)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: has no variant %u; it has none", scene->source,
                    desc->variant);
    return fail(error, FACET_ERROR_ARGUMENT, "%s: has no variant %u; the last one is %u", scene->source,
                desc->variant, scene->variant_count - 1);
}

/* Fills pose and parts, which the caller releases. */
static facet_result create(const facet_scene *scene, const facet_pose_desc *desc,
                           const facet_allocator *allocator, uint32_t thread_count, pose_parts *parts,
                           scene_pose *pose, facet_error *error)
{
    uint32_t index;
    TRY(scene_pose_check(scene, desc, &index, error));
    TRY(scene_state_create(scene, desc, allocator, &parts->state, error));
    if (!hierarchy_create(scene, &parts->state, index, allocator, &parts->nodes))
        return fail_memory(error, "world matrices", scene->node_count * sizeof(dmat4));
    TRY(deform_create(scene, &parts->state, &parts->nodes, allocator, thread_count, &parts->deformed, error));
    TRY(allocate(pose, parts, allocator, error));
    fill(pose, parts);
    pose->materials = parts->state.materials;
    TRY(bound_instances(scene, pose, allocator, thread_count, error));
    mark_copies(pose);
    return FACET_OK;
}

facet_result scene_pose_create(const facet_scene *scene, const facet_pose_desc *desc,
                               const facet_allocator *allocator, uint32_t thread_count, scene_pose *pose,
                               facet_error *error)
{
    *pose = (scene_pose){.materials = scene->materials};
    pose_parts parts = {.scene = scene, .variant = desc && desc->has_variant ? desc->variant : SCENE_NONE};
    facet_result result = create(scene, desc, allocator, thread_count, &parts, pose, error);
    if (result == FACET_OK) {
        pose->material_copies = parts.state.material_copies;
        pose->deformed = parts.deformed.block;
        parts.state.material_copies = NULL;
        parts.deformed.block = NULL;
    } else {
        scene_pose_destroy(pose);
    }
    deform_destroy(&parts.deformed);
    hierarchy_destroy(&parts.nodes);
    scene_state_destroy(&parts.state);
    return result;
}

void scene_pose_destroy(scene_pose *pose)
{
    mem_free(pose->instances);
    mem_free(pose->lights);
    mem_free(pose->cameras);
    mem_free(pose->deformed);
    mem_free(pose->material_copies);
    *pose = (scene_pose){0};
}

const scene_material *scene_pose_material(const facet_scene *scene, const scene_pose *pose,
                                          const scene_instance *instance)
{
    return instance->material == SCENE_NONE ? scene_get_material(scene, SCENE_NONE)
                                            : &pose->materials[instance->material];
}
