/* render_geometry.c - see render_geometry.h. */
#include "draw/render_geometry.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

enum { VERTEX_GRAIN = 1 << 15 };

/* Half the width of lines and the radius of points in pixels: with these, one sample in the middle of each
 * pixel misses no line in the columns (or rows) that it crosses, and no point. */
static const float LINE_RADIUS = 0.5f;
static const float POINT_RADIUS = 0.70710678f;

static bool has_vertex_alpha(const scene_primitive *primitive)
{
    for (uint32_t i = 0; primitive->colors && i < primitive->vertex_count; i++)
        if (primitive->colors[4 * (size_t)i + 3] < 1.0f)
            return true;
    return false;
}

/* Whether some hit may be transparent. A BLEND material without texture whose factor is 1 is opaque. */
static bool may_see_through(const scene_primitive *primitive, const scene_material *material)
{
    if (material->alpha_mode == SCENE_ALPHA_OPAQUE)
        return false;
    return material->textures[SCENE_BASE_COLOR_TEXTURE].texture != SCENE_NONE ||
           material->base_color[3] < 1.0f || has_vertex_alpha(primitive);
}

/* The same of a material of OpenGL 1: its opacity includes these factors. */
static bool may_see_through_legacy(const scene_primitive *primitive, const legacy_material *m)
{
    bool has_texture_opacity = legacy_has_map(m, LEGACY_DIFFUSE_MAP) && m->texture_type != LEGACY_RGB &&
                               m->texture_type != LEGACY_LUMINANCE;
    return m->opacity < 1.0f || has_texture_opacity || legacy_has_map(m, LEGACY_OPACITY_MAP) ||
           has_vertex_alpha(primitive);
}

static void choose_gltf(render_geometry *g)
{
    g->legacy = NULL;
    g->is_double_sided = g->material->is_double_sided || g->primitive->mode != SCENE_TRIANGLES;
    g->is_lit = !(g->material->extensions & SCENE_UNLIT) && g->normals;
    g->is_see_through = may_see_through(g->primitive, g->material);
}

static void choose_legacy(render_geometry *g, const legacy_material *legacy)
{
    g->legacy = legacy;
    g->is_double_sided = !legacy->is_culled || g->primitive->mode != SCENE_TRIANGLES;
    g->is_lit = legacy->is_lit && g->normals;
    g->is_see_through = may_see_through_legacy(g->primitive, legacy);
}

static float determinant9(const float m[9])
{
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
           m[2] * (m[3] * m[7] - m[4] * m[6]);
}

/* The scale of a 3x3 matrix that makes its determinant 1 or -1. */
static float unit_volume(float determinant)
{
    float scale = cbrtf(fabsf(determinant));
    return scale > 0.0f ? 1.0f / scale : 1.0f;
}

/* Normals and tangents are scaled alike, so that a normal map has the same depth on small and large nodes;
 * the normal matrix has a scale of its own. */
static void set_transform(render_geometry *g, const scene_instance *instance)
{
    float vector_scale = unit_volume(mat4_determinant3(instance->world));
    float normal_scale = unit_volume(determinant9(instance->normal_matrix));
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            g->normal_matrix[3 * row + column] = instance->normal_matrix[3 * row + column] * normal_scale;
            g->tangent_matrix[3 * row + column] = instance->world.m[4 * column + row] * vector_scale;
        }
    g->scale = 1.0f / vector_scale;
    g->is_mirrored = instance->is_mirrored;
    g->bitangent_sign = instance->is_mirrored ? -1.0f : 1.0f;
}

facet_result render_geometry_create(const facet_scene *scene, const scene_pose *pose,
                                    const facet_allocator *allocator, render_geometry_set *set,
                                    facet_error *error)
{
    *set = (render_geometry_set){.count = pose->instance_count};
    set->items = mem_zalloc(allocator, set->count, sizeof *set->items);
    if (!set->items) {
        *set = (render_geometry_set){0};
        return fail_memory(error, "instances", pose->instance_count * sizeof *set->items);
    }
    for (uint32_t i = 0; i < set->count; i++) {
        const scene_instance *instance = &pose->instances[i];
        const scene_primitive *primitive = instance->primitive;
        render_geometry *g = &set->items[i];
        g->primitive = primitive;
        g->material = scene_pose_material(scene, pose, instance);
        g->material_id = instance->material == SCENE_NONE ? 0 : instance->material + 1;
        g->normals = instance->normals;
        choose_gltf(g);
        g->positions = instance->positions;
        g->tangents = instance->tangents;
        set->has_sprites = set->has_sprites || primitive->mode != SCENE_TRIANGLES;
        set_transform(g, instance);
    }
    return FACET_OK;
}

void render_geometry_choose_materials(render_geometry_set *set, const facet_scene *scene,
                                      const scene_pose *pose, const legacy_material *fallback)
{
    for (uint32_t i = 0; i < set->count; i++) {
        render_geometry *g = &set->items[i];
        g->tangents = pose->instances[i].tangents;
        g->has_corner_tangents = false;
        if (fallback)
            choose_legacy(g, g->material_id ? &scene->legacy->materials[g->material_id - 1] : fallback);
        else
            choose_gltf(g);
    }
}

static void free_blocks(render_blocks *blocks)
{
    for (uint32_t i = 0; i < blocks->count; i++)
        mem_free(blocks->items[i]);
    mem_free(blocks->items);
    *blocks = (render_blocks){0};
}

void render_geometry_destroy(render_geometry_set *set)
{
    free_blocks(&set->blocks);
    free_blocks(&set->still_blocks);
    for (uint32_t i = 0; i < set->shape_count; i++)
        mem_free(set->shapes[i].vertices);
    mem_free(set->shapes);
    mem_free(set->items);
    *set = (render_geometry_set){0};
}

/* ---- vertices ---- */

typedef struct transform_job {
    const scene_instance *instance;
    const camera_rays *camera;
    float *out;
} transform_job;

static void transform_vertices(void *context, size_t begin, size_t end)
{
    const transform_job *job = context;
    const float *positions = job->instance->positions;
    for (size_t i = begin; i < end; i++)
        mat4_transform_point(&job->instance->world, positions + 3 * i, job->out + 3 * i);
}

float render_geometry_sprite_radius(scene_mode mode)
{
    return mode == SCENE_POINTS ? POINT_RADIUS : LINE_RADIUS;
}

/* One vertex per index, so that neighbours in the array are neighbours on the line. */
static void place_sprites(void *context, size_t begin, size_t end)
{
    const transform_job *job = context;
    const camera_rays *camera = job->camera;
    const scene_primitive *primitive = job->instance->primitive;
    float radius = render_geometry_sprite_radius(primitive->mode);
    for (size_t i = begin; i < end; i++) {
        float *p = job->out + 4 * i;
        mat4_transform_point(&job->instance->world,
                             job->instance->positions + 3 * (size_t)primitive->indices[i], p);
        float depth = 0.0f;
        for (int axis = 0; axis < 3; axis++)
            depth += (p[axis] - camera->origin[axis]) * camera->direction[axis];
        p[3] = radius * camera_rays_pixel_size(camera, depth);
    }
}

static bool shares_vertices(const scene_instance *a, const scene_instance *b)
{
    return a->node == b->node && memcmp(&a->world, &b->world, sizeof a->world) == 0 &&
           a->positions == b->positions && a->primitive->vertex_count == b->primitive->vertex_count &&
           a->primitive->mode == SCENE_TRIANGLES && b->primitive->mode == SCENE_TRIANGLES;
}

static float *make_vertices(const scene_instance *instance, const camera_rays *camera,
                            const facet_allocator *allocator, uint32_t thread_count)
{
    const scene_primitive *primitive = instance->primitive;
    bool is_mesh = primitive->mode == SCENE_TRIANGLES;
    size_t count = is_mesh ? primitive->vertex_count : primitive->index_count;
    /* One additional vertex: Embree reads 16 bytes for the last three floats. */
    transform_job job = {.instance = instance,
                         .camera = camera,
                         .out = mem_alloc(allocator, count + 1, (is_mesh ? 3 : 4) * sizeof(float))};
    if (job.out)
        parallel_for(thread_count, count, VERTEX_GRAIN, is_mesh ? transform_vertices : place_sprites, &job);
    return job.out;
}

static facet_result copy_shapes(render_geometry_set *set, const facet_allocator *allocator,
                                facet_error *error)
{
    for (uint32_t i = 0; i < set->shape_count; i++) {
        render_shape *shape = &set->shapes[i];
        size_t size = shape->primitive->vertex_count * (3 * sizeof(float));
        if (shape->vertices)
            continue;
        shape->vertices = mem_alloc(allocator, shape->primitive->vertex_count + (size_t)1, 3 * sizeof(float));
        if (!shape->vertices)
            return fail_memory(error, "vertices of instances", size);
        memcpy(shape->vertices, shape->positions, size);
    }
    return FACET_OK;
}

/* Reserves as many blocks as will be made. */
static facet_result reserve_blocks(render_geometry_set *set, const facet_allocator *allocator,
                                   facet_error *error)
{
    size_t counts[2] = {0, 0};
    render_blocks *const blocks[2] = {&set->blocks, &set->still_blocks};
    for (uint32_t i = 0; i < set->count; i++)
        if (!set->items[i].vertices && set->items[i].role != RENDER_INSTANCED)
            counts[set->items[i].role == RENDER_STILL]++;
    for (int i = 0; i < 2; i++) {
        if (blocks[i]->items || counts[i] == 0)
            continue;
        blocks[i]->items = mem_alloc(allocator, counts[i], sizeof *blocks[i]->items);
        if (!blocks[i]->items)
            return fail_memory(error, "vertices in world space", counts[i] * sizeof *blocks[i]->items);
    }
    return FACET_OK;
}

facet_result render_geometry_transform(render_geometry_set *set, const scene_pose *pose,
                                       const camera_rays *camera, const facet_allocator *allocator,
                                       uint32_t thread_count, facet_error *error)
{
    facet_result result = copy_shapes(set, allocator, error);
    if (result == FACET_OK)
        result = reserve_blocks(set, allocator, error);
    for (uint32_t i = 0; i < set->count && result == FACET_OK; i++) {
        const scene_instance *instance = &pose->instances[i];
        render_geometry *g = &set->items[i];
        if (g->role == RENDER_INSTANCED) {
            g->vertices = set->shapes[g->shape].vertices;
            g->world = &instance->world;
            continue;
        }
        if (g->vertices)
            continue;
        if (i > 0 && g->role == g[-1].role && shares_vertices(instance, instance - 1)) {
            g->vertices = g[-1].vertices;
            continue;
        }
        g->vertices = make_vertices(instance, camera, allocator, thread_count);
        if (!g->vertices)
            return fail_memory(error, "vertices in world space",
                               g->primitive->vertex_count * (3 * sizeof(float)));
        render_blocks *blocks = g->role == RENDER_STILL ? &set->still_blocks : &set->blocks;
        blocks->items[blocks->count++] = g->vertices;
    }
    return result;
}

void render_geometry_place_sprites(render_geometry_set *set, const scene_pose *pose,
                                   const camera_rays *camera, uint32_t thread_count)
{
    for (uint32_t i = 0; i < set->count; i++) {
        transform_job job = {
            .instance = &pose->instances[i], .camera = camera, .out = set->items[i].vertices};
        if (set->items[i].primitive->mode != SCENE_TRIANGLES)
            parallel_for(thread_count, set->items[i].primitive->index_count, VERTEX_GRAIN, place_sprites,
                         &job);
    }
}

/* ---- from pose to pose ---- */

static bool is_deformed(const scene_primitive *primitive, const float *positions)
{
    return positions != primitive->positions;
}

render_likeness render_geometry_compare(const render_geometry_set *set, const scene_pose *pose,
                                        const render_geometry_set *old, const scene_pose *old_pose)
{
    if (set->count != old->count || set->shape_count != old->shape_count ||
        set->is_animated != old->is_animated)
        return RENDER_OTHER;
    render_likeness likeness = RENDER_SAME;
    for (uint32_t i = 0; i < set->count; i++) {
        const render_geometry *g = &set->items[i];
        const render_geometry *h = &old->items[i];
        if (g->primitive != h->primitive || g->role != h->role || g->shape != h->shape)
            return RENDER_OTHER;
        bool is_same = !is_deformed(g->primitive, g->positions) && !is_deformed(h->primitive, h->positions) &&
                       memcmp(&pose->instances[i].world, &old_pose->instances[i].world, sizeof(mat4)) == 0;
        if (!is_same && g->role == RENDER_STILL)
            return RENDER_OTHER;
        if (!is_same)
            likeness = RENDER_SAME_STILL;
    }
    for (uint32_t i = 0; i < set->shape_count; i++)
        if (set->shapes[i].primitive != old->shapes[i].primitive ||
            is_deformed(set->shapes[i].primitive, set->shapes[i].positions) !=
                is_deformed(old->shapes[i].primitive, old->shapes[i].positions))
            return RENDER_OTHER;
    return likeness;
}

void render_geometry_adopt(render_geometry_set *set, render_geometry_set *old, render_likeness likeness)
{
    if (likeness == RENDER_OTHER)
        return;
    for (uint32_t i = 0; i < set->count; i++)
        if (set->items[i].role == RENDER_STILL || likeness == RENDER_SAME)
            set->items[i].vertices = old->items[i].vertices;
    set->still_blocks = old->still_blocks;
    old->still_blocks = (render_blocks){0};
    if (likeness == RENDER_SAME) {
        set->blocks = old->blocks;
        old->blocks = (render_blocks){0};
    }
    for (uint32_t i = 0; i < set->shape_count; i++)
        if (!is_deformed(set->shapes[i].primitive, set->shapes[i].positions)) {
            set->shapes[i].vertices = old->shapes[i].vertices;
            old->shapes[i].vertices = NULL;
        }
}

/* ---- pose keys ---- */

bool pose_key_matches(const pose_key *key, const facet_scene *scene, const facet_pose_desc *desc)
{
    const facet_pose_desc *a = &key->desc;
    if (!key->is_set || key->place_revision != scene->place_revision ||
        a->has_scene_index != desc->has_scene_index || a->has_variant != desc->has_variant ||
        a->animation_count != desc->animation_count)
        return false;
    if ((a->has_scene_index && a->scene_index != desc->scene_index) ||
        (a->has_variant && a->variant != desc->variant))
        return false;
    if (a->animation_count == 0)
        return true;
    return memcmp(&a->time_s, &desc->time_s, sizeof a->time_s) == 0 &&
           memcmp(a->animations, desc->animations, a->animation_count * sizeof *a->animations) == 0;
}

bool pose_key_set(pose_key *key, const facet_scene *scene, const facet_pose_desc *desc,
                  const facet_allocator *allocator)
{
    uint32_t *animations = NULL;
    if (desc->animation_count) {
        animations = mem_alloc(allocator, desc->animation_count, sizeof *animations);
        if (!animations)
            return false;
        memcpy(animations, desc->animations, desc->animation_count * sizeof *animations);
    }
    mem_free(key->animations);
    *key = (pose_key){
        .is_set = true, .place_revision = scene->place_revision, .desc = *desc, .animations = animations};
    key->desc.animations = animations;
    return true;
}

void pose_key_clear(pose_key *key)
{
    mem_free(key->animations);
    *key = (pose_key){0};
}
