/* gltf_write_scene.c - writes meshes with morph targets, skin attributes and variants; cameras, lights,
 * nodes and scenes; skins and animations. */
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "io/gltf/gltf_writer.h"

/* ---- meshes ---- */

static const int modes[] = {[SCENE_POINTS] = 0, [SCENE_LINES] = 1, [SCENE_TRIANGLES] = 4};

static void put_attribute(gltf_writer *w, json_t *attributes, const char *name, uint32_t set,
                          uint32_t accessor)
{
    char key[32];
    snprintf(key, sizeof key, name, set);
    gltf_put(w, attributes, key, json_integer(accessor));
}

static void put_floats_attribute(gltf_writer *w, json_t *attributes, const char *name, uint32_t set,
                                 const float *values, size_t count, write_type type)
{
    if (values)
        put_attribute(
            w, attributes, name, set,
            gltf_write_floats(w, values, count, type, WRITE_VERTICES, strcmp(name, "POSITION") == 0));
}

/* A morph target without effect: glTF requires an attribute in it. */
static void add_still_target(gltf_writer *w, json_t *targets, size_t vertex_count)
{
    json_t *target = json_object();
    put_attribute(w, target, "POSITION", 0, gltf_write_zeros(w, vertex_count, WRITE_VEC3));
    gltf_append(w, targets, target);
}

/* An empty primitive keeps its index in the mesh: a triangle without area, with as many morph targets as
 * the other primitives. */
static void write_empty(gltf_writer *w, json_t *out, uint32_t target_count)
{
    static const float positions[9] = {0};
    static const uint32_t indices[3] = {0, 1, 2};
    json_t *attributes = gltf_put_object(w, out, "attributes");
    put_floats_attribute(w, attributes, "POSITION", 0, positions, 3, WRITE_VEC3);
    gltf_put(w, out, "indices", json_integer(gltf_write_indices(w, indices, 3)));
    for (uint32_t i = 0; i < target_count; i++)
        add_still_target(w, gltf_put_array(w, out, "targets"), 3);
}

/* Normals that facet computed are left to the reader of the file. */
static void write_attributes(gltf_writer *w, json_t *out, const scene_mesh *mesh, const scene_primitive *p)
{
    json_t *attributes = gltf_put_object(w, out, "attributes");
    size_t n = p->vertex_count;
    put_attribute(w, attributes, "POSITION", 0, gltf_write_positions(w, p->positions, n, mesh->origin));
    if (!p->has_flat_normals) {
        put_floats_attribute(w, attributes, "NORMAL", 0, p->normals, n, WRITE_VEC3);
        put_floats_attribute(w, attributes, "TANGENT", 0, p->tangents, n, WRITE_VEC4);
    }
    for (uint32_t i = 0; i < p->texcoord_count; i++)
        put_floats_attribute(w, attributes, "TEXCOORD_%u", i, p->texcoords[i], n, WRITE_VEC2);
    put_floats_attribute(w, attributes, "COLOR_0", 0, p->colors, n, WRITE_VEC4);
    for (uint32_t i = 0; 4 * i < p->influence_count; i++) {
        put_attribute(w, attributes, "JOINTS_%u", i,
                      gltf_write_joints(w, p->joints + 4 * i, n, p->influence_count));
        put_attribute(w, attributes, "WEIGHTS_%u", i,
                      gltf_write_weights(w, p->weights + 4 * i, n, p->influence_count));
    }
}

static void write_targets(gltf_writer *w, json_t *out, const scene_primitive *p)
{
    size_t n = p->vertex_count;
    for (uint32_t i = 0; i < p->target_count; i++) {
        const scene_morph_target *t = &p->targets[i];
        json_t *target = json_object();
        put_floats_attribute(w, target, "POSITION", 0, t->positions, n, WRITE_VEC3);
        if (!p->has_flat_normals) {
            put_floats_attribute(w, target, "NORMAL", 0, t->normals, n, WRITE_VEC3);
            if (p->tangents)
                put_floats_attribute(w, target, "TANGENT", 0, t->tangents, n, WRITE_VEC3);
        }
        if (json_object_size(target)) {
            gltf_append(w, gltf_put_array(w, out, "targets"), target);
        } else {
            json_decref(target);
            add_still_target(w, gltf_put_array(w, out, "targets"), n);
        }
    }
}

/* The variants with a material of their own, by material. */
static void write_variants(gltf_writer *w, json_t *out, const scene_primitive *p)
{
    for (uint32_t i = 0; p->variant_materials && i < w->scene->variant_count; i++) {
        uint32_t material = p->variant_materials[i];
        if (material == SCENE_NONE)
            continue;
        json_t *mappings =
            gltf_put_array(w, gltf_put_extension(w, out, "KHR_materials_variants"), "mappings");
        json_t *mapping = NULL;
        for (size_t k = 0; k < json_array_size(mappings) && !mapping; k++)
            if (json_integer_value(json_object_get(json_array_get(mappings, k), "material")) == material)
                mapping = json_array_get(mappings, k);
        if (!mapping) {
            gltf_append(w, mappings, json_object());
            mapping = json_array_get(mappings, json_array_size(mappings) - 1);
            gltf_put_index(w, mapping, "material", material);
        }
        gltf_append(w, gltf_put_array(w, mapping, "variants"), json_integer(i));
    }
}

static void write_primitive(gltf_writer *w, json_t *primitives, const scene_mesh *mesh,
                            const scene_primitive *p, uint32_t target_count)
{
    json_t *out = json_object();
    if (p->index_count == 0) {
        write_empty(w, out, target_count);
    } else {
        write_attributes(w, out, mesh, p);
        gltf_put(w, out, "indices", json_integer(gltf_write_indices(w, p->indices, p->index_count)));
        if (p->mode != SCENE_TRIANGLES)
            gltf_put(w, out, "mode", json_integer(modes[p->mode]));
        write_targets(w, out, p);
    }
    gltf_put_index(w, out, "material", p->material);
    write_variants(w, out, p);
    gltf_put_meta(w, out, &p->meta);
    gltf_append(w, primitives, out);
}

void gltf_write_meshes(gltf_writer *w)
{
    for (uint32_t i = 0; i < w->scene->mesh_count && gltf_writer_is_ok(w); i++) {
        const scene_mesh *mesh = &w->scene->meshes[i];
        json_t *out = json_object();
        gltf_put_name(w, out, mesh->name);
        json_t *primitives = gltf_put_array(w, out, "primitives");
        for (uint32_t k = 0; k < mesh->primitive_count; k++)
            write_primitive(w, primitives, mesh, &mesh->primitives[k], mesh->weight_count);
        if (mesh->weight_count && mesh->weights)
            gltf_put(w, out, "weights", gltf_json_floats(mesh->weights, mesh->weight_count));
        gltf_put_meta(w, out, &mesh->meta);
        gltf_append(w, gltf_put_array(w, w->root, "meshes"), out);
    }
}

static const float ONE[3] = {1, 1, 1};
static const float IDENTITY[4] = {0, 0, 0, 1};

/* ---- cameras and lights ---- */

static void write_camera(gltf_writer *w, const scene_camera *camera)
{
    json_t *out = json_object();
    const char *type = camera->is_orthographic ? "orthographic" : "perspective";
    gltf_put_name(w, out, camera->name);
    gltf_put(w, out, "type", json_string(type));
    json_t *lens = gltf_put_object(w, out, type);
    if (camera->is_orthographic) {
        gltf_put(w, lens, "xmag", gltf_json_float(0.5f * camera->ortho_width));
        gltf_put(w, lens, "ymag", gltf_json_float(0.5f * camera->ortho_height));
    } else {
        gltf_put(w, lens, "yfov", gltf_json_float(camera->fov_y_rad));
        gltf_put_float(w, lens, "aspectRatio", camera->aspect, 0.0f);
    }
    /* glTF requires zfar of an orthographic and znear above 0 of a perspective camera; facet may have
     * neither plane. */
    bool lacks_far = camera->is_orthographic && camera->far_m == 0.0f;
    bool lacks_near = !camera->is_orthographic && camera->near_m == 0.0f;
    gltf_put(w, lens, "znear", gltf_json_float(lacks_near ? FLT_MIN : camera->near_m));
    gltf_put_float(w, lens, "zfar", lacks_far ? FLT_MAX : camera->far_m, 0.0f);
    gltf_put_meta(w, out, &camera->meta);
    gltf_append(w, gltf_put_array(w, w->root, "cameras"), out);
}

void gltf_write_cameras(gltf_writer *w)
{
    for (uint32_t i = 0; i < w->scene->camera_count; i++)
        write_camera(w, &w->scene->cameras[i]);
}

static void write_light(gltf_writer *w, json_t *lights, const scene_light *light)
{
    static const char *const types[] = {"directional", "point", "spot"};
    json_t *out = json_object();
    gltf_put_name(w, out, light->name);
    gltf_put(w, out, "type", json_string(types[light->type]));
    gltf_put_floats(w, out, "color", light->color, ONE, 3);
    gltf_put_float(w, out, "intensity", light->intensity, 1.0f);
    gltf_put_float(w, out, "range", light->range, 0.0f);
    if (light->type == SCENE_LIGHT_SPOT) {
        json_t *spot = gltf_put_object(w, out, "spot");
        /* glTF requires angles above 0 and an inner angle below the outer one. */
        float outer = fmaxf(light->outer_cone_rad, FLT_MIN);
        float inner = light->inner_cone_rad < outer ? light->inner_cone_rad : nextafterf(outer, 0.0f);
        gltf_put_float(w, spot, "innerConeAngle", inner, 0.0f);
        gltf_put(w, spot, "outerConeAngle", gltf_json_float(outer));
    }
    gltf_put_meta(w, out, &light->meta);
    gltf_append(w, lights, out);
}

static void write_image_light(gltf_writer *w, json_t *lights, const scene_image_light *light)
{
    json_t *out = json_object();
    gltf_put_name(w, out, light->name);
    gltf_put_floats(w, out, "rotation", light->rotation, IDENTITY, 4);
    gltf_put_float(w, out, "intensity", light->intensity, 1.0f);
    json_t *irradiance = gltf_put_array(w, out, "irradianceCoefficients");
    for (int i = 0; i < 9; i++)
        gltf_append(w, irradiance, gltf_json_floats(light->irradiance[i], 3));
    json_t *mips = gltf_put_array(w, out, "specularImages");
    for (uint32_t mip = 0; mip < light->mip_count; mip++)
        gltf_append(w, mips, gltf_json_indices(light->images + 6 * (size_t)mip, 6));
    gltf_put(w, out, "specularImageSize", json_integer(light->specular_size));
    gltf_put_meta(w, out, &light->meta);
    gltf_append(w, lights, out);
}

void gltf_write_lights(gltf_writer *w)
{
    const facet_scene *scene = w->scene;
    for (uint32_t i = 0; i < scene->light_count; i++)
        write_light(w, gltf_put_array(w, gltf_put_extension(w, w->root, "KHR_lights_punctual"), "lights"),
                    &scene->lights[i]);
    for (uint32_t i = 0; i < scene->image_light_count; i++)
        write_image_light(
            w, gltf_put_array(w, gltf_put_extension(w, w->root, "EXT_lights_image_based"), "lights"),
            &scene->image_lights[i]);
}

/* ---- nodes ---- */

static void put_instancing(gltf_writer *w, json_t *node, const scene_instancing *instancing)
{
    json_t *attributes =
        gltf_put_object(w, gltf_put_extension(w, node, "EXT_mesh_gpu_instancing"), "attributes");
    const struct {
        const char *name;
        const float *values;
        write_type type;
    } arrays[] = {{"TRANSLATION", instancing->translations, WRITE_VEC3},
                  {"ROTATION", instancing->rotations, WRITE_VEC4},
                  {"SCALE", instancing->scales, WRITE_VEC3}};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        if (arrays[i].values)
            gltf_put_index(w, attributes, arrays[i].name,
                           gltf_write_floats(w, arrays[i].values, instancing->count, arrays[i].type,
                                             WRITE_NO_TARGET, false));
}

static void write_node(gltf_writer *w, const scene_node *node)
{
    json_t *out = json_object();
    gltf_put_name(w, out, node->name);
    if (node->child_count)
        gltf_put(w, out, "children", gltf_json_indices(node->children, node->child_count));
    if (node->has_matrix) {
        gltf_put(w, out, "matrix", gltf_json_doubles(node->matrix.m, 16));
    } else {
        if (node->translation[0] != 0.0 || node->translation[1] != 0.0 || node->translation[2] != 0.0)
            gltf_put(w, out, "translation", gltf_json_doubles(node->translation, 3));
        gltf_put_floats(w, out, "rotation", node->rotation, IDENTITY, 4);
        gltf_put_floats(w, out, "scale", node->scale, ONE, 3);
    }
    gltf_put_index(w, out, "mesh", node->mesh);
    gltf_put_index(w, out, "skin", node->skin);
    gltf_put_index(w, out, "camera", node->camera);
    if (node->weights && node->mesh != SCENE_NONE)
        gltf_put(w, out, "weights",
                 gltf_json_floats(node->weights, w->scene->meshes[node->mesh].weight_count));
    if (node->light != SCENE_NONE)
        gltf_put_index(w, gltf_put_extension(w, out, "KHR_lights_punctual"), "light", node->light);
    if (node->is_hidden)
        gltf_put(w, gltf_put_extension(w, out, "KHR_node_visibility"), "visible", json_false());
    if (node->instancing)
        put_instancing(w, out, node->instancing);
    gltf_put_meta(w, out, &node->meta);
    gltf_append(w, gltf_put_array(w, w->root, "nodes"), out);
}

void gltf_write_nodes(gltf_writer *w)
{
    for (uint32_t i = 0; i < w->scene->node_count && gltf_writer_is_ok(w); i++)
        write_node(w, &w->scene->nodes[i]);
}

void gltf_write_scenes(gltf_writer *w)
{
    const facet_scene *scene = w->scene;
    for (uint32_t i = 0; i < scene->scene_count; i++) {
        const scene_root *root = &scene->scenes[i];
        json_t *out = json_object();
        gltf_put_name(w, out, root->name);
        if (root->node_count)
            gltf_put(w, out, "nodes", gltf_json_indices(root->nodes, root->node_count));
        if (root->image_light < scene->image_light_count)
            gltf_put_index(w, gltf_put_extension(w, out, "EXT_lights_image_based"), "light",
                           root->image_light);
        gltf_put_meta(w, out, &root->meta);
        gltf_append(w, gltf_put_array(w, w->root, "scenes"), out);
    }
    if (scene->scene_count)
        gltf_put_index(w, w->root, "scene", scene->default_scene);
}

/* ---- skins ---- */

void gltf_write_skins(gltf_writer *w)
{
    for (uint32_t i = 0; i < w->scene->skin_count && gltf_writer_is_ok(w); i++) {
        const scene_skin *skin = &w->scene->skins[i];
        json_t *out = json_object();
        gltf_put_name(w, out, skin->name);
        if (skin->inverse_bind)
            gltf_put_index(w, out, "inverseBindMatrices",
                           gltf_write_floats(w, skin->inverse_bind->m, skin->joint_count, WRITE_MAT4,
                                             WRITE_NO_TARGET, false));
        gltf_put_index(w, out, "skeleton", skin->skeleton);
        gltf_put(w, out, "joints", gltf_json_indices(skin->joints, skin->joint_count));
        gltf_put_meta(w, out, &skin->meta);
        gltf_append(w, gltf_put_array(w, w->root, "skins"), out);
    }
}

/* ---- animations ---- */

/* Whether the values of a channel are booleans: bytes, 0 or 1. */
static bool is_boolean(const scene_animation *animation, uint32_t sampler)
{
    for (uint32_t i = 0; i < animation->channel_count; i++)
        if (animation->channels[i].sampler == sampler)
            return animation->channels[i].kind == SCENE_TARGET_VISIBLE;
    return false;
}

/* Whether values are written as scalars: weights of any number, and values with more components than
 * vectors. */
static bool is_scalars(const scene_animation *animation, uint32_t sampler)
{
    for (uint32_t i = 0; i < animation->channel_count; i++)
        if (animation->channels[i].sampler == sampler)
            return animation->channels[i].kind == SCENE_TARGET_WEIGHTS;
    return animation->samplers[sampler].width > 4;
}

static uint32_t write_booleans(gltf_writer *w, const scene_sampler *s)
{
    unsigned char *bytes = mem_alloc(w->allocator, s->key_count, 1);
    uint32_t accessor = 0;
    if (!bytes) {
        gltf_writer_fail_memory(w, s->key_count);
        return 0;
    }
    for (uint32_t i = 0; i < s->key_count; i++)
        bytes[i] = s->values[i] >= 0.5f;
    accessor = gltf_write_bytes(w, bytes, s->key_count);
    mem_free(bytes);
    return accessor;
}

static uint32_t write_values(gltf_writer *w, const scene_animation *animation, uint32_t sampler)
{
    static const write_type types[] = {WRITE_SCALAR, WRITE_SCALAR, WRITE_VEC2, WRITE_VEC3, WRITE_VEC4};
    const scene_sampler *s = &animation->samplers[sampler];
    size_t count = (size_t)s->key_count * (s->interpolation == SCENE_CUBIC_SPLINE ? 3 : 1);
    if (is_boolean(animation, sampler))
        return write_booleans(w, s);
    if (is_scalars(animation, sampler))
        return gltf_write_floats(w, s->values, count * s->width, WRITE_SCALAR, WRITE_NO_TARGET, false);
    return gltf_write_floats(w, s->values, count, types[s->width], WRITE_NO_TARGET, false);
}

static void write_sampler(gltf_writer *w, json_t *samplers, const scene_animation *animation, uint32_t index)
{
    static const char *const names[] = {"STEP", "LINEAR", "CUBICSPLINE"};
    const scene_sampler *s = &animation->samplers[index];
    json_t *out = json_object();
    gltf_put_index(w, out, "input",
                   gltf_write_floats(w, s->times, s->key_count, WRITE_SCALAR, WRITE_NO_TARGET, true));
    if (s->interpolation != SCENE_LINEAR)
        gltf_put(w, out, "interpolation", json_string(names[s->interpolation]));
    gltf_put_index(w, out, "output", write_values(w, animation, index));
    gltf_append(w, samplers, out);
}

/* The path of a core target. */
static const char *path_of(const scene_channel *c)
{
    if (c->kind == SCENE_TARGET_WEIGHTS)
        return "weights";
    return c->offset == offsetof(scene_node, translation) ? "translation"
           : c->offset == offsetof(scene_node, rotation)  ? "rotation"
                                                          : "scale";
}

static void write_channel(gltf_writer *w, json_t *channels, const scene_channel *c)
{
    json_t *out = json_object();
    gltf_put_index(w, out, "sampler", c->sampler);
    json_t *target = gltf_put_object(w, out, "target");
    if (c->pointer) {
        gltf_put(w, target, "path", json_string("pointer"));
        gltf_put(w, gltf_put_extension(w, target, "KHR_animation_pointer"), "pointer",
                 gltf_json_text(w, c->pointer));
    } else {
        gltf_put_index(w, target, "node", c->index);
        gltf_put(w, target, "path", json_string(path_of(c)));
    }
    gltf_append(w, channels, out);
}

void gltf_write_animations(gltf_writer *w)
{
    for (uint32_t i = 0; i < w->scene->animation_count && gltf_writer_is_ok(w); i++) {
        const scene_animation *animation = &w->scene->animations[i];
        if (animation->channel_count == 0) /* glTF allows no empty arrays */
            continue;
        json_t *out = json_object();
        gltf_put_name(w, out, animation->name);
        json_t *channels = gltf_put_array(w, out, "channels");
        json_t *samplers = gltf_put_array(w, out, "samplers");
        for (uint32_t k = 0; k < animation->channel_count; k++)
            write_channel(w, channels, &animation->channels[k]);
        for (uint32_t k = 0; k < animation->sampler_count; k++)
            write_sampler(w, samplers, animation, k);
        gltf_put_meta(w, out, &animation->meta);
        gltf_append(w, gltf_put_array(w, w->root, "animations"), out);
    }
}
