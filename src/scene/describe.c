/* describe.c - a scene in numbers and as JSON; docs/inspect.md lists the members. */
#include "scene/scene.h"

#include <stdio.h>

#include "base/text.h"

static uint64_t element_count(const scene_primitive *p)
{
    return p->index_count / (p->mode == SCENE_POINTS ? 1u : p->mode == SCENE_LINES ? 2u : 3u);
}

facet_scene_counts scene_count(const facet_scene *scene)
{
    facet_scene_counts counts = {.scenes = scene->scene_count,
                                 .nodes = scene->node_count,
                                 .meshes = scene->mesh_count,
                                 .materials = scene->material_count,
                                 .textures = scene->texture_count,
                                 .images = scene->image_count,
                                 .cameras = scene->camera_count,
                                 .lights = scene->light_count,
                                 .skins = scene->skin_count,
                                 .animations = scene->animation_count};
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++) {
            const scene_primitive *p = &scene->meshes[i].primitives[k];
            counts.primitives++;
            counts.vertices += p->vertex_count;
            counts.triangles += p->mode == SCENE_TRIANGLES ? element_count(p) : 0;
            counts.lines += p->mode == SCENE_LINES ? element_count(p) : 0;
            counts.points += p->mode == SCENE_POINTS ? element_count(p) : 0;
        }
    scene_pose pose;
    if (scene_pose_create(scene, FACET_DEFAULT, &scene->allocator, 0, &pose, NULL) == FACET_OK) {
        counts.instances = pose.instance_count;
        for (uint32_t i = 0; i < pose.instance_count; i++)
            if (pose.instances[i].primitive->mode == SCENE_TRIANGLES)
                counts.drawn_triangles += element_count(pose.instances[i].primitive);
    }
    scene_pose_destroy(&pose);
    return counts;
}

/* ---- small things ---- */

/* An index, null where there is none. */
static void write_index(text *t, const char *key, uint32_t index)
{
    if (index == SCENE_NONE)
        json_string(t, key, NULL);
    else
        json_integer(t, key, index);
}

static void write_indices(text *t, const char *key, const uint32_t *indices, uint32_t count)
{
    json_begin_array(t, key);
    for (uint32_t i = 0; i < count; i++)
        json_integer(t, NULL, indices[i]);
    json_end_array(t);
}

static void write_asset(text *t, const facet_scene *scene)
{
    json_begin_object(t, "asset");
    json_string(t, "version", scene->version);
    json_string(t, "generator", scene->generator);
    json_string(t, "copyright", scene->copyright);
    json_end_object(t);
}

static void write_counts(text *t, const facet_scene *scene)
{
    facet_scene_counts c = scene_count(scene);
    json_begin_object(t, "counts");
    json_integer(t, "scenes", c.scenes);
    json_integer(t, "nodes", c.nodes);
    json_integer(t, "meshes", c.meshes);
    json_integer(t, "primitives", c.primitives);
    json_integer(t, "materials", c.materials);
    json_integer(t, "textures", c.textures);
    json_integer(t, "images", c.images);
    json_integer(t, "cameras", c.cameras);
    json_integer(t, "lights", c.lights);
    json_integer(t, "skins", c.skins);
    json_integer(t, "animations", c.animations);
    json_integer(t, "instances", c.instances);
    json_integer(t, "vertices", (int64_t)c.vertices);
    json_integer(t, "triangles", (int64_t)c.triangles);
    json_integer(t, "lines", (int64_t)c.lines);
    json_integer(t, "points", (int64_t)c.points);
    json_integer(t, "drawn_triangles", (int64_t)c.drawn_triangles);
    json_end_object(t);
}

/* Of what one scene draws; null for nothing. */
static void write_bounds(text *t, const facet_scene *scene, uint32_t index)
{
    scene_pose pose;
    facet_result result = scene_pose_create(scene, index, &scene->allocator, 0, &pose, NULL);
    if (result != FACET_OK || !pose.has_bounds) {
        json_string(t, "bounds", NULL);
    } else {
        json_begin_object(t, "bounds");
        json_floats(t, "min", pose.bounds_min, 3);
        json_floats(t, "max", pose.bounds_max, 3);
        json_end_object(t);
    }
    scene_pose_destroy(&pose);
}

/* ---- arrays of the scene ---- */

static void write_scenes(text *t, const facet_scene *scene)
{
    json_begin_array(t, "scenes");
    for (uint32_t i = 0; i < scene->scene_count; i++) {
        json_begin_object(t, NULL);
        json_string(t, "name", scene->scenes[i].name);
        write_indices(t, "nodes", scene->scenes[i].nodes, scene->scenes[i].node_count);
        write_bounds(t, scene, i);
        json_end_object(t);
    }
    json_end_array(t);
}

static void write_node(text *t, const scene_node *node)
{
    json_begin_object(t, NULL);
    json_string(t, "name", node->name);
    write_index(t, "parent", node->parent);
    write_indices(t, "children", node->children, node->child_count);
    if (node->has_matrix) {
        json_floats(t, "matrix", node->matrix.m, 16);
    } else {
        json_floats(t, "translation", node->translation, 3);
        json_floats(t, "rotation", node->rotation, 4);
        json_floats(t, "scale", node->scale, 3);
    }
    write_index(t, "mesh", node->mesh);
    write_index(t, "camera", node->camera);
    write_index(t, "light", node->light);
    write_index(t, "skin", node->skin);
    json_bool(t, "visible", !node->is_hidden);
    json_end_object(t);
}

/* Those that the file gave, by glTF's names. */
static void write_attributes(text *t, const scene_primitive *p)
{
    json_begin_array(t, "attributes");
    json_string(t, NULL, "POSITION");
    if (p->normals && !p->has_flat_normals)
        json_string(t, NULL, "NORMAL");
    if (p->tangents)
        json_string(t, NULL, "TANGENT");
    if (p->colors)
        json_string(t, NULL, "COLOR_0");
    for (uint32_t set = 0; set < p->texcoord_count; set++) {
        char name[24];
        snprintf(name, sizeof name, "TEXCOORD_%u", set);
        json_string(t, NULL, name);
    }
    json_end_array(t);
}

static void write_primitive(text *t, const scene_primitive *p)
{
    static const char *const modes[] = {"points", "lines", "triangles"};
    json_begin_object(t, NULL);
    json_string(t, "mode", modes[p->mode]);
    json_integer(t, "vertices", p->vertex_count);
    json_integer(t, "indices", p->index_count);
    write_index(t, "material", p->material);
    write_attributes(t, p);
    json_bool(t, "flat_normals", p->has_flat_normals);
    if (p->index_count) {
        json_begin_object(t, "bounds");
        json_floats(t, "min", p->bounds_min, 3);
        json_floats(t, "max", p->bounds_max, 3);
        json_end_object(t);
    } else {
        json_string(t, "bounds", NULL);
    }
    json_end_object(t);
}

static void write_meshes(text *t, const facet_scene *scene)
{
    json_begin_array(t, "meshes");
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        const scene_mesh *mesh = &scene->meshes[i];
        json_begin_object(t, NULL);
        json_string(t, "name", mesh->name);
        json_begin_array(t, "primitives");
        for (uint32_t k = 0; k < mesh->primitive_count; k++)
            write_primitive(t, &mesh->primitives[k]);
        json_end_array(t);
        json_end_object(t);
    }
    json_end_array(t);
}

static void write_texture_ref(text *t, const char *key, const scene_texture_ref *ref)
{
    if (ref->texture == SCENE_NONE)
        return;
    json_begin_object(t, key);
    json_integer(t, "texture", ref->texture);
    json_integer(t, "texcoord", ref->texcoord);
    if (ref->has_transform)
        json_floats(t, "transform", ref->transform, 6);
    json_end_object(t);
}

static void write_material(text *t, const scene_material *m)
{
    static const char *const alpha_modes[] = {"OPAQUE", "MASK", "BLEND"};
    json_begin_object(t, NULL);
    json_string(t, "name", m->name);
    json_floats(t, "base_color", m->base_color, 4);
    json_float(t, "metallic", m->metallic);
    json_float(t, "roughness", m->perceptual_roughness);
    json_float(t, "normal_scale", m->normal_scale);
    json_float(t, "occlusion_strength", m->occlusion_strength);
    json_floats(t, "emissive", m->emissive, 3);
    json_string(t, "alpha_mode", alpha_modes[m->alpha_mode]);
    json_float(t, "alpha_cutoff", m->alpha_cutoff);
    json_bool(t, "double_sided", m->is_double_sided);
    json_bool(t, "unlit", m->is_unlit);
    json_float(t, "ior", m->ior);
    json_float(t, "specular", m->specular);
    json_floats(t, "specular_color", m->specular_color, 3);
    write_texture_ref(t, "base_color_texture", &m->base_color_texture);
    write_texture_ref(t, "metallic_roughness_texture", &m->metallic_roughness_texture);
    write_texture_ref(t, "normal_texture", &m->normal_texture);
    write_texture_ref(t, "occlusion_texture", &m->occlusion_texture);
    write_texture_ref(t, "emissive_texture", &m->emissive_texture);
    write_texture_ref(t, "specular_texture", &m->specular_texture);
    write_texture_ref(t, "specular_color_texture", &m->specular_color_texture);
    json_end_object(t);
}

static void write_texture(text *t, const scene_texture *texture)
{
    static const char *const wraps[] = {"repeat", "clamp", "mirror"};
    static const char *const filters[] = {"linear", "nearest"};
    static const char *const mips[] = {"linear", "nearest", "none"};
    json_begin_object(t, NULL);
    json_string(t, "name", texture->name);
    write_index(t, "image", texture->image);
    json_string(t, "wrap_u", wraps[texture->wrap_u]);
    json_string(t, "wrap_v", wraps[texture->wrap_v]);
    json_string(t, "mag_filter", filters[texture->mag_filter]);
    json_string(t, "min_filter", filters[texture->min_filter]);
    json_string(t, "mip_filter", mips[texture->mip_filter]);
    json_end_object(t);
}

static void write_image(text *t, const scene_image *image)
{
    json_begin_object(t, NULL);
    json_string(t, "name", image->name);
    json_string(t, "mime_type", image->mime_type[0] ? image->mime_type : NULL);
    json_integer(t, "bytes", (int64_t)image->size);
    json_integer(t, "width", image->width);
    json_integer(t, "height", image->height);
    json_bool(t, "readable", image->bytes != NULL);
    json_end_object(t);
}

static void write_camera(text *t, const scene_camera *camera)
{
    json_begin_object(t, NULL);
    json_string(t, "name", camera->name);
    json_string(t, "type", camera->is_orthographic ? "orthographic" : "perspective");
    if (camera->is_orthographic) {
        json_float(t, "ortho_height", camera->ortho_height);
        json_float(t, "aspect", camera->ortho_width / camera->ortho_height);
    } else {
        json_float(t, "fov_y_rad", camera->fov_y_rad);
        if (camera->aspect > 0.0f)
            json_float(t, "aspect", camera->aspect);
        else
            json_string(t, "aspect", NULL);
    }
    json_float(t, "near", camera->near_m);
    if (camera->far_m > 0.0f)
        json_float(t, "far", camera->far_m);
    else
        json_string(t, "far", NULL);
    json_end_object(t);
}

static void write_light(text *t, const scene_light *light)
{
    static const char *const types[] = {"directional", "point", "spot"};
    json_begin_object(t, NULL);
    json_string(t, "name", light->name);
    json_string(t, "type", types[light->type]);
    json_floats(t, "color", light->color, 3);
    json_float(t, "intensity", light->intensity);
    if (light->range > 0.0f)
        json_float(t, "range", light->range);
    else
        json_string(t, "range", NULL);
    if (light->type == SCENE_LIGHT_SPOT) {
        json_float(t, "inner_cone_rad", light->inner_cone_rad);
        json_float(t, "outer_cone_rad", light->outer_cone_rad);
    }
    json_end_object(t);
}

static void write_extensions(text *t, const facet_scene *scene)
{
    static const char *const states[] = {"supported", "approximated", "ignored"};
    json_begin_array(t, "extensions");
    for (uint32_t i = 0; i < scene->extension_count; i++) {
        json_begin_object(t, NULL);
        json_string(t, "name", scene->extensions[i].name);
        json_string(t, "state", states[scene->extensions[i].support]);
        json_bool(t, "required", scene->extensions[i].is_required);
        json_end_object(t);
    }
    json_end_array(t);
}

#define WRITE_ARRAY(key, items, count, write)                                                                \
    do {                                                                                                     \
        json_begin_array(t, key);                                                                            \
        for (uint32_t index_ = 0; index_ < (count); index_++)                                                \
            write(t, &(items)[index_]);                                                                      \
        json_end_array(t);                                                                                   \
    } while (0)

void scene_describe_json(const facet_scene *scene, struct text *t)
{
    json_begin_object(t, NULL);
    json_string(t, "source", scene->source);
    write_asset(t, scene);
    write_counts(t, scene);
    write_bounds(t, scene, FACET_DEFAULT);
    write_index(t, "default_scene", scene->default_scene);
    write_scenes(t, scene);
    WRITE_ARRAY("nodes", scene->nodes, scene->node_count, write_node);
    write_meshes(t, scene);
    WRITE_ARRAY("materials", scene->materials, scene->material_count, write_material);
    WRITE_ARRAY("textures", scene->textures, scene->texture_count, write_texture);
    WRITE_ARRAY("images", scene->images, scene->image_count, write_image);
    WRITE_ARRAY("cameras", scene->cameras, scene->camera_count, write_camera);
    WRITE_ARRAY("lights", scene->lights, scene->light_count, write_light);
    write_extensions(t, scene);
    json_begin_array(t, "warnings");
    for (uint32_t i = 0; i < scene->warning_count; i++)
        json_string(t, NULL, scene->warnings[i]);
    json_end_array(t);
    json_end_object(t);
}
