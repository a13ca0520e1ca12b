/* gltf_write_nodes.c - cameras, lights, nodes and scenes. */
#include <float.h>
#include <math.h>

#include "io/gltf/gltf_writer.h"

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
    /* The specification wants a zfar of the one and a znear above 0 of the other, where facet has no such plane. */
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
        /* A cone without a soft border, or without width: angles must be above 0, the inner one below the outer one. */
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
