/* gl_scene.c - see gl_scene.h. */
#include "gl/scene/gl_scene.h"

#include <string.h>

#include "base/memory.h"
#include "base/result.h"

void gl_scene_init(gl_scene *s, const facet_scene *scene, const facet_allocator *allocator)
{
    memset(s, 0, sizeof *s);
    s->scene = scene;
    s->content_revision = scene ? scene->content_revision : 0;
    s->allocator = allocator ? *allocator : (facet_allocator){0};
    s->default_legacy = legacy_material_default();
}

/* Drops the pose; keeps the tangents of static geometry. */
static void drop_pose(gl_scene *s)
{
    material_plans_destroy(&s->plans);
    tangent_store_forget_deformed(&s->tangents);
    render_geometry_destroy(&s->geometries);
    scene_pose_destroy(&s->pose);
    s->pose = (scene_pose){0};
    pose_key_clear(&s->key);
}

void gl_scene_clear(gl_scene *s)
{
    const facet_scene *scene = s->scene;
    facet_allocator allocator = s->allocator;
    uint64_t revision = s->revision, generation = s->generation;
    drop_pose(s);
    tangent_store_destroy(&s->tangents);
    if (!scene)
        return;
    gl_scene_init(s, scene, &allocator);
    s->revision = revision;
    s->generation = generation + 1;
}

static facet_result make_geometry(gl_scene *s, const facet_render_desc *desc, facet_error *error)
{
    s->shading = FACET_SHADING_GLTF;
    TRY(scene_pose_create(s->scene, &desc->pose, &s->allocator, desc->thread_count, &s->pose, error));
    TRY(render_geometry_create(s->scene, &s->pose, &s->allocator, &s->geometries, error));
    for (uint32_t i = 0; i < s->geometries.count; i++)
        s->geometries.items[i].world = &s->pose.instances[i].world;
    return pose_key_set(&s->key, s->scene, &desc->pose, &s->allocator)
               ? FACET_OK
               : fail_memory(error, "animations", desc->pose.animation_count * sizeof *s->key.animations);
}

static void choose_materials(gl_scene *s, facet_shading shading)
{
    if (s->shading == shading)
        return;
    bool is_legacy = shading == FACET_SHADING_OGL1;
    render_geometry_choose_materials(&s->geometries, s->scene, &s->pose,
                                     is_legacy ? &s->default_legacy : NULL);
    s->shading = shading;
}

facet_result gl_scene_update(gl_scene *s, const facet_render_desc *desc, facet_error *error)
{
    facet_result result = FACET_OK;
    bool is_same_pose = pose_key_matches(&s->key, s->scene, &desc->pose);
    if (is_same_pose && s->shading == desc->shading)
        return FACET_OK;
    s->revision++;
    if (!is_same_pose) {
        drop_pose(s);
        result = make_geometry(s, desc, error);
    }
    if (result == FACET_OK) {
        choose_materials(s, desc->shading);
        result = tangent_store_fill(&s->tangents, &s->geometries, &s->allocator, desc->thread_count, error);
    }
    material_plans_destroy(&s->plans);
    if (result == FACET_OK)
        result = material_plans_create(&s->geometries, &s->allocator, &s->plans, error);
    if (result != FACET_OK)
        gl_scene_clear(s);
    return result;
}
