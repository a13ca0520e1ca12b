/* prepared_scene.c - see prepared_scene.h. */
#include "cpu/prepared_scene.h"

#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "cpu/instancing.h"
#include "draw/texture_store.h"

void prepared_scene_init(prepared_scene *p, const facet_scene *scene, const facet_allocator *allocator)
{
    memset(p, 0, sizeof *p);
    p->scene = scene;
    p->content_revision = scene ? scene->content_revision : 0;
    p->allocator = allocator ? *allocator : (facet_allocator){0};
    p->default_legacy = legacy_material_default();
}

void prepared_scene_clear(prepared_scene *p)
{
    const facet_scene *scene = p->scene;
    facet_allocator allocator = p->allocator;
    ray_scene_destroy(&p->rays);
    render_geometry_destroy(&p->geometries);
    scene_pose_destroy(&p->geometry_pose);
    scene_pose_destroy(&p->pose);
    tangent_store_destroy(&p->tangents);
    texture_store_destroy(p->textures);
    pose_key_clear(&p->key);
    prepared_scene_init(p, scene, &allocator);
}

/* ---- the pose ---- */

/* Drops what was made of the scene before it changed. */
static void follow_content(prepared_scene *p)
{
    bool has_warned = p->has_warned_occlusion;
    if (p->content_revision == p->scene->content_revision)
        return;
    prepared_scene_clear(p);
    p->has_warned_occlusion = has_warned;
}

facet_result prepared_scene_pose(prepared_scene *p, const facet_render_desc *desc, facet_error *error)
{
    follow_content(p);
    if (pose_key_matches(&p->key, p->scene, &desc->pose))
        return FACET_OK;
    scene_pose pose;
    facet_result result =
        scene_pose_create(p->scene, &desc->pose, &p->allocator, desc->thread_count, &pose, error);
    if (result != FACET_OK)
        return result;
    if (!pose_key_set(&p->key, p->scene, &desc->pose, &p->allocator)) {
        scene_pose_destroy(&pose);
        return fail_memory(error, "animations", desc->pose.animation_count * sizeof *p->key.animations);
    }
    /* The geometries point into their pose until they are replaced. */
    if (p->has_geometry && !p->geometry_pose.instances)
        p->geometry_pose = p->pose;
    else
        scene_pose_destroy(&p->pose);
    p->pose = pose;
    return FACET_OK;
}

/* ---- geometry ---- */

/* Replaces the geometries by those of the pose, keeping vertices that are the same. */
static facet_result make_geometry(prepared_scene *p, const facet_render_desc *desc, const camera_rays *camera,
                                  facet_error *error)
{
    const scene_pose *old_pose = p->geometry_pose.instances ? &p->geometry_pose : &p->pose;
    instancing_desc instancing = {
        .pose = &p->key.desc, .ray_count = p->ray_count, .is_within_reach = p->is_within_reach};
    render_geometry_set set;
    facet_result result = render_geometry_create(p->scene, &p->pose, &p->allocator, &set, error);
    if (result == FACET_OK)
        result = instancing_choose(p->scene, &p->pose, &instancing, &p->allocator, &set, error);
    if (result == FACET_OK) {
        p->likeness = RENDER_OTHER;
        if (p->has_geometry)
            p->likeness = render_geometry_compare(&set, &p->pose, &p->geometries, old_pose);
        render_geometry_adopt(&set, &p->geometries, p->likeness);
        /* The old geometries are freed before the new ones are made: both may not fit into memory. */
        render_geometry_destroy(&p->geometries);
        scene_pose_destroy(&p->geometry_pose);
        tangent_store_forget_deformed(&p->tangents);
        result = render_geometry_transform(&set, &p->pose, camera, &p->allocator, desc->thread_count, error);
    }
    if (result != FACET_OK) {
        render_geometry_destroy(&set);
        return result;
    }
    p->geometries = set;
    p->shading = FACET_SHADING_GLTF;
    p->has_geometry = true;
    p->has_tangents = false;
    return FACET_OK;
}

/* Whether points and lines have the same width for both cameras. */
static bool is_same_place(const camera_rays *a, const camera_rays *b)
{
    return memcmp(a->origin, b->origin, sizeof a->origin) == 0 &&
           memcmp(a->direction, b->direction, sizeof a->direction) == 0 &&
           memcmp(&a->pixel_size, &b->pixel_size, sizeof a->pixel_size) == 0 &&
           a->is_orthographic == b->is_orthographic;
}

facet_result prepared_scene_geometry(prepared_scene *p, const facet_render_desc *desc,
                                     const camera_rays *camera, facet_error *error)
{
    /* Of the whole image: a crop has the same geometry. */
    uint64_t ray_count = (uint64_t)desc->width * desc->height * desc->samples;
    bool is_within_reach = instancing_is_within_reach(&p->pose, camera);
    bool is_same = p->has_geometry && !p->geometry_pose.instances && p->ray_count == ray_count &&
                   p->is_within_reach == is_within_reach;
    p->ray_count = ray_count;
    p->is_within_reach = is_within_reach;
    p->likeness = RENDER_SAME;
    if (!is_same) {
        facet_result result = make_geometry(p, desc, camera, error);
        if (result != FACET_OK)
            return result;
    }
    if (p->shading != desc->shading) {
        bool is_legacy = desc->shading == FACET_SHADING_OGL1;
        render_geometry_choose_materials(&p->geometries, p->scene, &p->pose,
                                         is_legacy ? &p->default_legacy : NULL);
        p->shading = desc->shading;
        p->has_tangents = false;
    }
    p->has_moved_sprites =
        p->likeness == RENDER_SAME && p->geometries.has_sprites && !is_same_place(&p->camera, camera);
    if (p->has_moved_sprites)
        render_geometry_place_sprites(&p->geometries, &p->pose, camera, desc->thread_count);
    p->camera = *camera;
    if (p->scene->texture_count == 0)
        return FACET_OK;
    return nearest_copies_choose(&p->geometries, camera, desc->width, desc->height, &p->allocator, error);
}

/* ---- BVH, tangents, textures ---- */

facet_result prepared_scene_hierarchy(prepared_scene *p, const facet_render_desc *desc, facet_error *error)
{
    const ray_scene_desc wanted = {
        .ray_count = p->ray_count, .thread_count = desc->thread_count, .isa = desc->isa};
    if (p->rays.bvh && p->thread_count == desc->thread_count && p->isa == desc->isa)
        return p->rays.tracer->update(p->rays.bvh, &wanted, p->likeness, p->has_moved_sprites, error);
    ray_scene_destroy(&p->rays);
    p->thread_count = desc->thread_count;
    p->isa = desc->isa;
    TRY(ray_tracer_choose(FACET_BVH_AUTO, &p->rays.tracer, error));
    return p->rays.tracer->create(&p->geometries, &wanted, &p->allocator, &p->rays.bvh, error);
}

void prepared_scene_skip_hierarchy(prepared_scene *p)
{
    if (p->likeness != RENDER_SAME || p->has_moved_sprites)
        ray_scene_destroy(&p->rays);
}

facet_result prepared_scene_tangents(prepared_scene *p, const facet_render_desc *desc, facet_error *error)
{
    if (p->has_tangents)
        return FACET_OK;
    facet_result result =
        tangent_store_fill(&p->tangents, &p->geometries, &p->allocator, desc->thread_count, error);
    p->has_tangents = result == FACET_OK;
    return result;
}

facet_result prepared_scene_textures(prepared_scene *p, facet_error *error)
{
    return p->textures ? FACET_OK : texture_store_create(p->scene, &p->allocator, &p->textures, error);
}
