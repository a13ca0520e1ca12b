/* animation.c - applies the channels of animations to copies of what they move, and clamps the results to
 * the ranges of the file format, since splines overshoot. */
#include "scene/animation.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/result.h"
#include "scene/material_table.h"
#include "scene/keyframes.h"

/* ---- ranges ---- */

static float clamp_to(float value, float minimum, float maximum)
{
    return value < minimum ? minimum : value > maximum ? maximum : value;
}

static bool overlaps(size_t offset, size_t size, size_t other, size_t other_size)
{
    return offset < other + other_size && other < offset + size;
}

/* Clamps parameters in bytes [offset, offset + size) of the material to the ranges of the specification,
 * and updates the transforms of texture refs there. */
static void settle_material(scene_material *material, size_t offset, size_t size)
{
    for (int i = 0; i < MATERIAL_PARAMETER_COUNT; i++) {
        const material_parameter *row = &material_parameters[i];
        if (!overlaps(offset, size, row->offset, row->count * sizeof(float)) ||
            (row->extension && !(row->extension & material->extensions)))
            continue;
        float *values = material_floats(material, row);
        for (uint32_t k = 0; k < row->count; k++)
            values[k] = clamp_to(values[k], row->minimum, row->maximum);
    }
    for (size_t i = 0; i < SCENE_TEXTURE_SLOT_COUNT; i++)
        if (overlaps(offset, size, offsetof(scene_material, textures) + i * sizeof *material->textures,
                     sizeof *material->textures))
            scene_texture_ref_update(&material->textures[i]);
}

/* Clamps to values >= 0, cones of at most a right angle, the inner one inside the outer one. */
static void settle_light(scene_light *light)
{
    const float right_angle = 1.57079633f;
    for (int i = 0; i < 3; i++)
        light->color[i] = clamp_to(light->color[i], 0.0f, FLT_MAX);
    light->intensity = clamp_to(light->intensity, 0.0f, FLT_MAX);
    light->range = clamp_to(light->range, 0.0f, FLT_MAX);
    light->outer_cone_rad = clamp_to(light->outer_cone_rad, 0.0f, right_angle);
    light->inner_cone_rad = clamp_to(light->inner_cone_rad, 0.0f, light->outer_cone_rad);
}

/* An invalid lens falls back to the camera's own. */
static void settle_camera(scene_camera *camera, const scene_camera *rest)
{
    if (!(camera->fov_y_rad > 0.0f && camera->fov_y_rad < 3.14f))
        camera->fov_y_rad = rest->fov_y_rad;
    if (!(camera->aspect >= 0.0f))
        camera->aspect = rest->aspect;
    if (!(camera->ortho_height > 0.0f))
        camera->ortho_height = rest->ortho_height;
    if (!(camera->ortho_width > 0.0f))
        camera->ortho_width = rest->ortho_width;
    if (!(camera->near_m >= 0.0f && camera->far_m >= 0.0f) ||
        (camera->far_m != 0.0f && !(camera->far_m > camera->near_m))) {
        camera->near_m = rest->near_m;
        camera->far_m = rest->far_m;
    }
}

/* ---- floats of a struct ---- */

/* Writes the channel's value into object, if all of it fits; components that are not finite are skipped. */
static void store_value(const scene_channel *channel, const scene_sampler *sampler, double time_s,
                        void *object, size_t object_size)
{
    size_t size = sampler->width * sizeof(float);
    if (channel->offset > object_size || size > object_size - channel->offset)
        return;
    unsigned char *to = (unsigned char *)object + channel->offset;
    if (channel->is_rotation && sampler->width == 4) {
        float rotation[4];
        if (sampler_rotation_at(sampler, time_s, rotation))
            memcpy(to, rotation, sizeof rotation);
        return;
    }
    sampler_blend blend = sampler_at(sampler, time_s, false);
    for (size_t i = 0; i < sampler->width; i++) {
        float value = (float)(sampler_blend_value(&blend, i) * (double)channel->scale);
        if (fabsf(value) <= FLT_MAX)
            memcpy(to + i * sizeof value, &value, sizeof value);
    }
}

/* ---- nodes ---- */

/* The specification forbids animating a node with a matrix; such a node moves from its matrix'
 * decomposition. */
static void leave_matrix(scene_node *node)
{
    if (node->has_matrix) {
        mat4 matrix = mat4_from_double(&node->matrix);
        float rounded[3];
        mat4_to_trs(&matrix, rounded, node->rotation, node->scale);
        memcpy(node->translation, node->matrix.m + 12, sizeof node->translation);
    }
    node->has_matrix = false;
}

static void store_transform(const scene_channel *channel, const scene_sampler *sampler, double time_s,
                            scene_node *node)
{
    leave_matrix(node);
    if (channel->offset != offsetof(scene_node, translation)) {
        store_value(channel, sampler, time_s, node, sizeof *node);
        return;
    }
    sampler_blend blend = sampler_at(sampler, time_s, false);
    for (size_t i = 0; i < 3 && i < sampler->width; i++) {
        double value = sampler_blend_value(&blend, i) * (double)channel->scale;
        if (fabs(value) <= (double)FLT_MAX)
            node->translation[i] = value;
    }
}

static bool has_weights(const facet_scene *scene, const scene_node *node)
{
    return node->mesh != SCENE_NONE && scene->meshes[node->mesh].weight_count > 0;
}

static void store_weights(const facet_scene *scene, const scene_channel *channel,
                          const scene_sampler *sampler, double time_s, scene_node *node)
{
    uint32_t count = has_weights(scene, node) ? scene->meshes[node->mesh].weight_count : 0;
    if (channel->offset >= count)
        return;
    /* node->weights is in the block of the state here. */
    float *weights = (float *)(uintptr_t)node->weights + channel->offset;
    sampler_blend blend = sampler_at(sampler, time_s, false);
    for (size_t i = 0; i < sampler->width && i < count - channel->offset; i++) {
        float value = (float)(sampler_blend_value(&blend, i) * (double)channel->scale);
        if (fabsf(value) <= FLT_MAX)
            weights[i] = value;
    }
}

static void store_visibility(const scene_sampler *sampler, double time_s, scene_node *node)
{
    sampler_blend blend = sampler_at(sampler, time_s, false);
    node->is_hidden = sampler->width > 0 && sampler_blend_value(&blend, 0) < 0.5;
}

/* ---- channels ---- */

/* The number of objects of a channel's kind. */
static uint32_t object_count(const facet_scene *scene, scene_target_kind kind)
{
    switch (kind) {
    case SCENE_TARGET_MATERIAL:
        return scene->material_count;
    case SCENE_TARGET_LIGHT:
        return scene->light_count;
    case SCENE_TARGET_CAMERA:
        return scene->camera_count;
    case SCENE_TARGET_NODE:
    case SCENE_TARGET_VISIBLE:
    case SCENE_TARGET_WEIGHTS:
        return scene->node_count;
    }
    return 0;
}

static void apply_channel(const facet_scene *scene, scene_state *state, const scene_channel *channel,
                          const scene_sampler *sampler, double time_s)
{
    uint32_t i = channel->index;
    switch (channel->kind) {
    case SCENE_TARGET_NODE:
        store_transform(channel, sampler, time_s, &state->node_copies[i]);
        break;
    case SCENE_TARGET_VISIBLE:
        store_visibility(sampler, time_s, &state->node_copies[i]);
        break;
    case SCENE_TARGET_WEIGHTS:
        store_weights(scene, channel, sampler, time_s, &state->node_copies[i]);
        break;
    case SCENE_TARGET_MATERIAL:
        store_value(channel, sampler, time_s, &state->material_copies[i], sizeof(scene_material));
        break;
    case SCENE_TARGET_LIGHT:
        store_value(channel, sampler, time_s, &state->light_copies[i], sizeof(scene_light));
        break;
    case SCENE_TARGET_CAMERA:
        store_value(channel, sampler, time_s, &state->camera_copies[i], sizeof(scene_camera));
        break;
    }
}

/* After all channels, so that the order of a light's two cones does not matter. */
static void settle_channel(const facet_scene *scene, scene_state *state, const scene_channel *channel,
                           const scene_sampler *sampler)
{
    uint32_t i = channel->index;
    if (channel->kind == SCENE_TARGET_MATERIAL)
        settle_material(&state->material_copies[i], channel->offset, sampler->width * sizeof(float));
    else if (channel->kind == SCENE_TARGET_LIGHT)
        settle_light(&state->light_copies[i]);
    else if (channel->kind == SCENE_TARGET_CAMERA)
        settle_camera(&state->camera_copies[i], &scene->cameras[i]);
}

/* ---- copies ---- */

/* Iterates over the channels of all of desc's animations in order; false: no more. */
typedef struct channel_walk {
    const facet_scene *scene;
    const facet_pose_desc *desc;
    uint32_t animation, next;
    const scene_channel *channel; /* current channel and its sampler */
    const scene_sampler *sampler;
} channel_walk;

static channel_walk walk_channels(const facet_scene *scene, const facet_pose_desc *desc)
{
    return (channel_walk){.scene = scene, .desc = desc};
}

static bool next_channel(channel_walk *walk)
{
    for (; walk->animation < walk->desc->animation_count; walk->animation++, walk->next = 0) {
        const scene_animation *animation = &walk->scene->animations[walk->desc->animations[walk->animation]];
        while (walk->next < animation->channel_count) {
            walk->channel = &animation->channels[walk->next++];
            walk->sampler = &animation->samplers[walk->channel->sampler];
            if (walk->channel->index < object_count(walk->scene, walk->channel->kind))
                return true;
        }
    }
    return false;
}

/* Copies count elements, once. False: no memory. */
static bool copy_array(const facet_allocator *allocator, const void *array, uint32_t count, size_t size,
                       void **copy)
{
    if (*copy)
        return true;
    *copy = mem_alloc(allocator, count, size);
    if (*copy && count > 0)
        memcpy(*copy, array, count * size);
    return *copy != NULL;
}

static bool copy_moved(const facet_scene *scene, const facet_pose_desc *desc,
                       const facet_allocator *allocator, scene_state *state)
{
    bool is_ok = true;
    for (channel_walk w = walk_channels(scene, desc); is_ok && next_channel(&w);) {
        if (w.channel->kind == SCENE_TARGET_MATERIAL)
            is_ok = copy_array(allocator, scene->materials, scene->material_count, sizeof(scene_material),
                               (void **)&state->material_copies);
        else if (w.channel->kind == SCENE_TARGET_LIGHT)
            is_ok = copy_array(allocator, scene->lights, scene->light_count, sizeof(scene_light),
                               (void **)&state->light_copies);
        else if (w.channel->kind == SCENE_TARGET_CAMERA)
            is_ok = copy_array(allocator, scene->cameras, scene->camera_count, sizeof(scene_camera),
                               (void **)&state->camera_copies);
        else
            is_ok = copy_array(allocator, scene->nodes, scene->node_count, sizeof(scene_node),
                               (void **)&state->node_copies);
    }
    return is_ok;
}

/* Gives each node with animated weights its own copy, all in one block. False: no memory. */
static bool copy_weights(const facet_scene *scene, const facet_pose_desc *desc,
                         const facet_allocator *allocator, scene_state *state)
{
    static const float mark = 0.0f; /* marks weights that are counted and not copied yet */
    size_t total = 0;
    for (channel_walk w = walk_channels(scene, desc); next_channel(&w);) {
        if (w.channel->kind != SCENE_TARGET_WEIGHTS)
            continue;
        scene_node *node = &state->node_copies[w.channel->index];
        if (!has_weights(scene, node) || node->weights == &mark)
            continue;
        total += scene->meshes[node->mesh].weight_count;
        node->weights = &mark;
    }
    if (total == 0)
        return true;
    float *next = state->weights = mem_alloc(allocator, total, sizeof *next);
    for (channel_walk w = walk_channels(scene, desc); next && next_channel(&w);) {
        scene_node *node = &state->node_copies[w.channel->index];
        if (w.channel->kind != SCENE_TARGET_WEIGHTS || node->weights != &mark)
            continue;
        const scene_mesh *mesh = &scene->meshes[node->mesh];
        const float *rest = scene->nodes[w.channel->index].weights;
        memcpy(next, rest ? rest : mesh->weights, mesh->weight_count * sizeof *next);
        node->weights = next;
        next += mesh->weight_count;
    }
    return next != NULL;
}

static facet_result check(const facet_scene *scene, const facet_pose_desc *desc, facet_error *error)
{
    for (uint32_t i = 0; i < desc->animation_count; i++) {
        uint32_t index = desc->animations[i];
        if (index < scene->animation_count)
            continue;
        if (scene->animation_count == 0)
            return fail(error, FACET_ERROR_ARGUMENT, "%s: has no animation %u; it has none", scene->source,
                        index);
        return fail(error, FACET_ERROR_ARGUMENT, "%s: has no animation %u; the last one is %u", scene->source,
                    index, scene->animation_count - 1);
    }
    if (!isfinite(desc->time_s))
        return fail(error, FACET_ERROR_ARGUMENT, "%s: the time of a pose must be finite", scene->source);
    return FACET_OK;
}

facet_result scene_state_create(const facet_scene *scene, const facet_pose_desc *desc,
                                const facet_allocator *allocator, scene_state *state, facet_error *error)
{
    *state = (scene_state){.nodes = scene->nodes,
                           .materials = scene->materials,
                           .lights = scene->lights,
                           .cameras = scene->cameras};
    if (desc)
        TRY(check(scene, desc, error));
    if (!desc || desc->animation_count == 0)
        return FACET_OK;
    if (!copy_moved(scene, desc, allocator, state) || !copy_weights(scene, desc, allocator, state)) {
        scene_state_destroy(state);
        return fail_memory(error, "animated values",
                           scene->node_count * sizeof(scene_node) +
                               scene->material_count * sizeof(scene_material));
    }
    for (channel_walk w = walk_channels(scene, desc); next_channel(&w);)
        apply_channel(scene, state, w.channel, w.sampler, desc->time_s);
    for (channel_walk w = walk_channels(scene, desc); next_channel(&w);)
        settle_channel(scene, state, w.channel, w.sampler);
    if (state->node_copies)
        state->nodes = state->node_copies;
    if (state->material_copies)
        state->materials = state->material_copies;
    if (state->light_copies)
        state->lights = state->light_copies;
    if (state->camera_copies)
        state->cameras = state->camera_copies;
    return FACET_OK;
}

void scene_state_destroy(scene_state *state)
{
    mem_free(state->node_copies);
    mem_free(state->material_copies);
    mem_free(state->light_copies);
    mem_free(state->camera_copies);
    mem_free(state->weights);
    *state = (scene_state){0};
}

const float *scene_state_weights(const facet_scene *scene, const scene_state *state, uint32_t node)
{
    const float *weights = state->nodes[node].weights;
    return weights ? weights : scene->meshes[state->nodes[node].mesh].weights;
}
