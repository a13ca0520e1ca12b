/* describe.c - counts of a scene, and its description as JSON; docs/inspect.md lists the members. */
#include "scene/describe.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

/* ---- values ---- */

/* Nesting depth of extras and metadata in a description. System.Text.Json reads 64 levels, other programs
 * 100 to 1000; a description adds at most 8 around them. */
enum { MAX_DEPTH = 32 };

void describe_index(text *t, const char *key, uint32_t index)
{
    if (index == SCENE_NONE)
        text_json_string(t, key, NULL);
    else
        text_json_integer(t, key, index);
}

static void describe_indices(text *t, const char *key, const uint32_t *indices, uint32_t count)
{
    text_json_begin_array(t, key);
    for (uint32_t i = 0; i < count; i++)
        text_json_integer(t, NULL, indices[i]);
    text_json_end_array(t);
}

static void describe_strings(text *t, const char *key, const char *const *strings, uint32_t count)
{
    text_json_begin_array(t, key);
    for (uint32_t i = 0; i < count; i++)
        text_json_string(t, NULL, strings[i]);
    text_json_end_array(t);
}

/* The position behind the string that begins at json. */
static const char *skip_string(const char *json)
{
    for (json++; *json && *json != '"'; json++)
        if (*json == '\\' && json[1])
            json++;
    return *json ? json + 1 : json;
}

/* The position behind the array or object at json. */
static const char *skip_nested(const char *json)
{
    size_t depth = 0;
    do {
        if (*json == '"') {
            json = skip_string(json);
            continue;
        }
        depth += *json == '[' || *json == '{';
        depth -= *json == ']' || *json == '}';
        json++;
    } while (*json && depth);
    return json;
}

/* A valid value unchanged, except that strings replace parts nested deeper than MAX_DEPTH. */
static void describe_json(text *t, const char *key, const char *json)
{
    text_json_raw(t, key, "");
    size_t depth = 0;
    const char *from = json;
    for (const char *at = json; *at;) {
        if (*at == '"') {
            at = skip_string(at);
        } else if ((*at == '[' || *at == '{') && depth == MAX_DEPTH) {
            text_add_bytes(t, from, (size_t)(at - from));
            text_add(t, "\"(nested too deep to show)\"");
            from = at = skip_nested(at);
        } else {
            depth += *at == '[' || *at == '{';
            depth -= *at == ']' || *at == '}';
            at++;
        }
    }
    text_add(t, from);
}

void describe_meta(text *t, const scene_meta *meta)
{
    if (meta->extras)
        describe_json(t, "extras", meta->extras);
    if (meta->extensions)
        describe_json(t, "metadata", meta->extensions);
}

/* ---- skins and animations ---- */

static void write_skin(text *t, const scene_skin *skin)
{
    text_json_begin_object(t, NULL);
    text_json_string(t, "name", skin->name);
    describe_indices(t, "joints", skin->joints, skin->joint_count);
    describe_index(t, "skeleton", skin->skeleton);
    describe_meta(t, &skin->meta);
    text_json_end_object(t);
}

static const char *path_of(const scene_channel *c)
{
    switch (c->kind) {
    case SCENE_TARGET_WEIGHTS:
        return "weights";
    case SCENE_TARGET_VISIBLE:
        return "visible";
    case SCENE_TARGET_NODE:
        return c->offset == offsetof(scene_node, translation) ? "translation"
               : c->offset == offsetof(scene_node, rotation)  ? "rotation"
                                                              : "scale";
    default:
        return "pointer";
    }
}

static void write_channel(text *t, const scene_animation *animation, const scene_channel *c)
{
    static const char *const kinds[] = {[SCENE_TARGET_NODE] = "node",    [SCENE_TARGET_VISIBLE] = "node",
                                        [SCENE_TARGET_WEIGHTS] = "node", [SCENE_TARGET_MATERIAL] = "material",
                                        [SCENE_TARGET_LIGHT] = "light",  [SCENE_TARGET_CAMERA] = "camera"};
    static const char *const interpolations[] = {"STEP", "LINEAR", "CUBICSPLINE"};
    const scene_sampler *sampler = &animation->samplers[c->sampler];
    text_json_begin_object(t, NULL);
    text_json_integer(t, kinds[c->kind], c->index);
    text_json_string(t, "path", path_of(c));
    if (c->pointer)
        text_json_string(t, "pointer", c->pointer);
    text_json_string(t, "interpolation", interpolations[sampler->interpolation]);
    text_json_integer(t, "keys", sampler->key_count);
    text_json_end_object(t);
}

static void write_animation(text *t, const scene_animation *animation)
{
    text_json_begin_object(t, NULL);
    text_json_string(t, "name", animation->name);
    text_json_float(t, "begin", animation->begin_s);
    text_json_float(t, "end", animation->end_s);
    text_json_begin_array(t, "channels");
    for (uint32_t i = 0; i < animation->channel_count; i++)
        write_channel(t, animation, &animation->channels[i]);
    text_json_end_array(t);
    describe_meta(t, &animation->meta);
    text_json_end_object(t);
}

/* "skins", "animations" */
static void describe_motion(text *t, const facet_scene *scene)
{
    DESCRIBE_ARRAY("skins", scene->skins, scene->skin_count, write_skin);
    DESCRIBE_ARRAY("animations", scene->animations, scene->animation_count, write_animation);
}

/* ---- counts ---- */

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
                                 .animations = scene->animation_count,
                                 .variants = scene->variant_count,
                                 .image_lights = scene->image_light_count};
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
    if (scene_pose_create(scene, NULL, &scene->allocator, scene->thread_count, &pose, NULL) == FACET_OK) {
        counts.instances = pose.instance_count;
        for (uint32_t i = 0; i < pose.instance_count; i++)
            if (pose.instances[i].primitive->mode == SCENE_TRIANGLES)
                counts.drawn_triangles += element_count(pose.instances[i].primitive);
    }
    scene_pose_destroy(&pose);
    return counts;
}

static void write_asset(text *t, const facet_scene *scene)
{
    text_json_begin_object(t, "asset");
    text_json_string(t, "version", scene->version);
    text_json_string(t, "generator", scene->generator);
    text_json_string(t, "copyright", scene->copyright);
    describe_meta(t, &scene->asset_meta);
    text_json_end_object(t);
}

static void write_counts(text *t, const facet_scene *scene)
{
    facet_scene_counts c = scene_count(scene);
    text_json_begin_object(t, "counts");
    text_json_integer(t, "scenes", c.scenes);
    text_json_integer(t, "nodes", c.nodes);
    text_json_integer(t, "meshes", c.meshes);
    text_json_integer(t, "primitives", c.primitives);
    text_json_integer(t, "materials", c.materials);
    text_json_integer(t, "textures", c.textures);
    text_json_integer(t, "images", c.images);
    text_json_integer(t, "cameras", c.cameras);
    text_json_integer(t, "lights", c.lights);
    text_json_integer(t, "skins", c.skins);
    text_json_integer(t, "animations", c.animations);
    text_json_integer(t, "variants", c.variants);
    text_json_integer(t, "image_lights", c.image_lights);
    text_json_integer(t, "instances", c.instances);
    text_json_integer(t, "vertices", (int64_t)c.vertices);
    text_json_integer(t, "triangles", (int64_t)c.triangles);
    text_json_integer(t, "lines", (int64_t)c.lines);
    text_json_integer(t, "points", (int64_t)c.points);
    text_json_integer(t, "drawn_triangles", (int64_t)c.drawn_triangles);
    text_json_end_object(t);
}

/* In the file's coordinates: low and high are relative to origin. */
static void write_box(text *t, const float low[3], const float high[3], const double origin[3])
{
    text_json_begin_object(t, "bounds");
    text_json_place(t, "min", low, origin);
    text_json_place(t, "max", high, origin);
    text_json_end_object(t);
}

/* Bounds of the contents of one scene; null if it is empty. */
static void write_bounds(text *t, const facet_scene *scene, const facet_pose_desc *desc)
{
    scene_pose pose;
    facet_result result = scene_pose_create(scene, desc, &scene->allocator, scene->thread_count, &pose, NULL);
    if (result != FACET_OK || !pose.has_bounds) {
        text_json_string(t, "bounds", NULL);
    } else {
        write_box(t, pose.bounds_min, pose.bounds_max, scene->origin);
    }
    scene_pose_destroy(&pose);
}

/* ---- arrays of the scene ---- */

static void write_scenes(text *t, const facet_scene *scene)
{
    text_json_begin_array(t, "scenes");
    for (uint32_t i = 0; i < scene->scene_count; i++) {
        text_json_begin_object(t, NULL);
        text_json_string(t, "name", scene->scenes[i].name);
        describe_indices(t, "nodes", scene->scenes[i].nodes, scene->scenes[i].node_count);
        const facet_pose_desc desc = {.has_scene_index = true, .scene_index = i};
        write_bounds(t, scene, &desc);
        if (scene->image_light_count)
            describe_index(t, "image_light", scene->scenes[i].image_light);
        describe_meta(t, &scene->scenes[i].meta);
        text_json_end_object(t);
    }
    text_json_end_array(t);
}

static void write_node(text *t, const scene_node *node)
{
    text_json_begin_object(t, NULL);
    text_json_string(t, "name", node->name);
    describe_index(t, "parent", node->parent);
    describe_indices(t, "children", node->children, node->child_count);
    if (node->has_matrix) {
        text_json_doubles(t, "matrix", node->matrix.m, 16);
    } else {
        text_json_doubles(t, "translation", node->translation, 3);
        text_json_floats(t, "rotation", node->rotation, 4);
        text_json_floats(t, "scale", node->scale, 3);
    }
    describe_index(t, "mesh", node->mesh);
    describe_index(t, "camera", node->camera);
    describe_index(t, "light", node->light);
    describe_index(t, "skin", node->skin);
    text_json_bool(t, "visible", !node->is_hidden);
    if (node->instancing)
        text_json_integer(t, "instances", node->instancing->count);
    describe_meta(t, &node->meta);
    text_json_end_object(t);
}

/* The factors that the file states, by glTF's names. */
static void write_attributes(text *t, const scene_primitive *p)
{
    text_json_begin_array(t, "attributes");
    text_json_string(t, NULL, "POSITION");
    if (p->normals && !p->has_flat_normals)
        text_json_string(t, NULL, "NORMAL");
    if (p->tangents)
        text_json_string(t, NULL, "TANGENT");
    if (p->colors)
        text_json_string(t, NULL, "COLOR_0");
    for (uint32_t set = 0; set < p->texcoord_count; set++) {
        char name[24];
        snprintf(name, sizeof name, "TEXCOORD_%u", set);
        text_json_string(t, NULL, name);
    }
    for (uint32_t set = 0; 4 * set < p->influence_count; set++) {
        char name[24];
        snprintf(name, sizeof name, "JOINTS_%u", set);
        text_json_string(t, NULL, name);
        snprintf(name, sizeof name, "WEIGHTS_%u", set);
        text_json_string(t, NULL, name);
    }
    text_json_end_array(t);
}

static void write_primitive(text *t, const facet_scene *scene, const scene_mesh *mesh,
                            const scene_primitive *p)
{
    static const char *const modes[] = {"points", "lines", "triangles"};
    text_json_begin_object(t, NULL);
    text_json_string(t, "mode", modes[p->mode]);
    text_json_integer(t, "vertices", p->vertex_count);
    text_json_integer(t, "indices", p->index_count);
    describe_index(t, "material", p->material);
    if (p->variant_materials) {
        text_json_begin_array(t, "variant_materials");
        for (uint32_t i = 0; i < scene->variant_count; i++)
            describe_index(t, NULL, p->variant_materials[i]);
        text_json_end_array(t);
    }
    write_attributes(t, p);
    text_json_integer(t, "morph_targets", p->target_count);
    text_json_bool(t, "flat_normals", p->has_flat_normals);
    if (p->index_count) {
        write_box(t, p->bounds_min, p->bounds_max, mesh->origin);
    } else {
        text_json_string(t, "bounds", NULL);
    }
    describe_meta(t, &p->meta);
    text_json_end_object(t);
}

static void write_meshes(text *t, const facet_scene *scene)
{
    text_json_begin_array(t, "meshes");
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        const scene_mesh *mesh = &scene->meshes[i];
        text_json_begin_object(t, NULL);
        text_json_string(t, "name", mesh->name);
        text_json_begin_array(t, "primitives");
        for (uint32_t k = 0; k < mesh->primitive_count; k++)
            write_primitive(t, scene, mesh, &mesh->primitives[k]);
        text_json_end_array(t);
        if (mesh->weight_count)
            text_json_floats(t, "weights", mesh->weights, mesh->weight_count);
        describe_meta(t, &mesh->meta);
        text_json_end_object(t);
    }
    text_json_end_array(t);
}

static void write_camera(text *t, const scene_camera *camera)
{
    text_json_begin_object(t, NULL);
    text_json_string(t, "name", camera->name);
    text_json_string(t, "type", camera->is_orthographic ? "orthographic" : "perspective");
    if (camera->is_orthographic) {
        text_json_float(t, "ortho_height", camera->ortho_height);
        text_json_float(t, "aspect", camera->ortho_width / camera->ortho_height);
    } else {
        text_json_float(t, "fov_y_rad", camera->fov_y_rad);
        if (camera->aspect > 0.0f)
            text_json_float(t, "aspect", camera->aspect);
        else
            text_json_string(t, "aspect", NULL);
    }
    text_json_float(t, "near", camera->near_m);
    if (camera->far_m > 0.0f)
        text_json_float(t, "far", camera->far_m);
    else
        text_json_string(t, "far", NULL);
    describe_meta(t, &camera->meta);
    text_json_end_object(t);
}

static void write_light(text *t, const scene_light *light)
{
    static const char *const types[] = {"directional", "point", "spot"};
    text_json_begin_object(t, NULL);
    text_json_string(t, "name", light->name);
    text_json_string(t, "type", types[light->type]);
    text_json_floats(t, "color", light->color, 3);
    text_json_float(t, "intensity", light->intensity);
    if (light->range > 0.0f)
        text_json_float(t, "range", light->range);
    else
        text_json_string(t, "range", NULL);
    if (light->type == SCENE_LIGHT_SPOT) {
        text_json_float(t, "inner_cone_rad", light->inner_cone_rad);
        text_json_float(t, "outer_cone_rad", light->outer_cone_rad);
    }
    describe_meta(t, &light->meta);
    text_json_end_object(t);
}

static void write_image_light(text *t, const scene_image_light *light)
{
    text_json_begin_object(t, NULL);
    text_json_string(t, "name", light->name);
    text_json_float(t, "intensity", light->intensity);
    text_json_floats(t, "rotation", light->rotation, 4);
    text_json_integer(t, "size", light->specular_size);
    text_json_integer(t, "mips", light->mip_count);
    describe_meta(t, &light->meta);
    text_json_end_object(t);
}

/* ---- memory ---- */

/* Bytes of a primitive's arrays in the renderer's form. */
static uint64_t primitive_bytes(const scene_primitive *p)
{
    uint64_t floats = 3u + (p->normals ? 3u : 0u) + (p->tangents ? 4u : 0u) + (p->colors ? 4u : 0u) +
                      2u * (uint64_t)p->texcoord_count + p->influence_count;
    for (uint32_t i = 0; i < p->target_count; i++)
        floats += (p->targets[i].positions ? 3u : 0u) + (p->targets[i].normals ? 3u : 0u) +
                  (p->targets[i].tangents ? 3u : 0u);
    return p->vertex_count * (4u * floats + 2u * p->influence_count) + 4u * (uint64_t)p->index_count;
}

static void write_memory(text *t, const facet_scene *scene)
{
    uint64_t geometry = 0;
    uint64_t images = 0;
    uint64_t texels = 0;
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++)
            geometry += primitive_bytes(&scene->meshes[i].primitives[k]);
    for (uint32_t i = 0; i < scene->image_count; i++) {
        images += scene->images[i].size;
        texels += (uint64_t)scene->images[i].width * scene->images[i].height;
    }
    text_json_begin_object(t, "memory");
    text_json_integer(t, "geometry_bytes", (int64_t)geometry);
    text_json_integer(t, "image_file_bytes", (int64_t)images);
    text_json_integer(t, "image_texel_bytes", (int64_t)(4 * texels));
    text_json_end_object(t);
}

static void write_extensions(text *t, const facet_scene *scene)
{
    static const char *const states[] = {"supported", "approximated", "ignored"};
    text_json_begin_array(t, "extensions");
    for (uint32_t i = 0; i < scene->extension_count; i++) {
        text_json_begin_object(t, NULL);
        text_json_string(t, "name", scene->extensions[i].name);
        text_json_string(t, "state", states[scene->extensions[i].support]);
        text_json_bool(t, "required", scene->extensions[i].is_required);
        text_json_end_object(t);
    }
    text_json_end_array(t);
}

void scene_describe_json(const facet_scene *scene, struct text *t)
{
    text_json_begin_object(t, NULL);
    text_json_string(t, "source", scene->source);
    write_asset(t, scene);
    write_counts(t, scene);
    write_bounds(t, scene, NULL);
    describe_index(t, "default_scene", scene->default_scene);
    write_scenes(t, scene);
    describe_externals(t, scene);
    DESCRIBE_ARRAY("nodes", scene->nodes, scene->node_count, write_node);
    write_meshes(t, scene);
    describe_materials(t, scene);
    describe_legacy(t, scene);
    describe_images(t, scene);
    DESCRIBE_ARRAY("cameras", scene->cameras, scene->camera_count, write_camera);
    DESCRIBE_ARRAY("lights", scene->lights, scene->light_count, write_light);
    DESCRIBE_ARRAY("image_lights", scene->image_lights, scene->image_light_count, write_image_light);
    describe_motion(t, scene);
    describe_strings(t, "variants", scene->variants, scene->variant_count);
    write_memory(t, scene);
    describe_meta(t, &scene->meta);
    write_extensions(t, scene);
    describe_strings(t, "warnings", scene->warnings, scene->warning_count);
    describe_strings(t, "notes", scene->notes, scene->note_count);
    text_json_end_object(t);
}
