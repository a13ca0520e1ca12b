/* gltf_nodes.c - cameras, lights, nodes and scenes (glTF 2.0 sections 3.5, 3.10; KHR_lights_punctual;
 * EXT_lights_image_based). */
#include <float.h>
#include <math.h>
#include <string.h>

#include "io/gltf/gltf_reader.h"

/* ---- cameras ---- */

static float get_required_float(io_reader *r, const json_place *object, const char *key)
{
    if (object->value && !io_has_member(object, key))
        io_fail(r, object, key, FACET_ERROR_INVALID, "is missing");
    return io_get_float(r, object, key, 1.0f);
}

static void read_perspective(io_reader *r, const json_place *at, scene_camera *out)
{
    out->fov_y_rad = get_required_float(r, at, "yfov");
    out->aspect = io_get_float_in(r, at, "aspectRatio", 0.0f, FLT_MAX, 0.0f);
    if (out->fov_y_rad > 0.0f && out->fov_y_rad < 3.14f)
        return;
    io_warn(r, at, "yfov", "%g is not between 0 and pi; 0.8 is used", (double)out->fov_y_rad);
    out->fov_y_rad = 0.8f;
}

static float get_magnitude(io_reader *r, const json_place *at, const char *key)
{
    float magnitude = get_required_float(r, at, key);
    if (magnitude > 0.0f)
        return 2.0f * magnitude;
    io_warn(r, at, key, "%g must be above 0", (double)magnitude);
    return magnitude < 0.0f ? -2.0f * magnitude : 2.0f;
}

static void read_camera(io_reader *r, const json_place *at, scene_camera *out)
{
    *out = (scene_camera){.name = io_get_name(r, at)};
    const char *type = io_get_string(r, at, "type", "");
    out->is_orthographic = strcmp(type, "orthographic") == 0;
    if (!out->is_orthographic && strcmp(type, "perspective") != 0) {
        io_fail(r, at, "type", FACET_ERROR_INVALID, "must be perspective or orthographic");
        return;
    }
    json_place lens = io_get_object(r, at, type);
    if (!lens.value) {
        io_fail(r, at, type, FACET_ERROR_INVALID, "is missing");
        return;
    }
    if (out->is_orthographic) {
        out->ortho_width = get_magnitude(r, &lens, "xmag");
        out->ortho_height = get_magnitude(r, &lens, "ymag");
        out->far_m = get_required_float(r, &lens, "zfar");
    } else {
        read_perspective(r, &lens, out);
        out->far_m = io_get_float(r, &lens, "zfar", 0.0f);
    }
    out->near_m = get_required_float(r, &lens, "znear");
    if (out->near_m < 0.0f || (out->near_m == 0.0f && !out->is_orthographic)) {
        io_note(r, &lens, "znear", "%g must be above 0", (double)out->near_m);
        out->near_m = 0.0f;
    }
    if ((out->far_m != 0.0f || io_has_member(&lens, "zfar")) && !(out->far_m > out->near_m)) {
        io_note(r, &lens, "zfar", "%g must be above znear; it is taken as infinite", (double)out->far_m);
        out->far_m = 0.0f;
    }
}

void gltf_read_cameras(io_reader *r, const json_place *root)
{
    json_place array = io_get_array(r, root, "cameras");
    size_t count = io_get_count(&array);
    io_leave_out(r, "there are no cameras");
    r->scene->cameras = io_alloc(r, "cameras", count, sizeof *r->scene->cameras);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &array, i);
        read_camera(r, &at, &r->scene->cameras[i]);
        if (io_leave_out(r, "a field of view of 0.8 rad is used"))
            r->scene->cameras[i] = (scene_camera){.name = io_get_name(r, &at), .fov_y_rad = 0.8f};
        r->scene->cameras[i].meta = gltf_get_meta(r, &at);
        r->scene->camera_count = (uint32_t)(i + 1);
    }
}

/* ---- lights ---- */

static void read_spot(io_reader *r, const json_place *light, scene_light *out)
{
    const float right_angle = 1.57079633f;
    json_place at = io_get_object(r, light, "spot");
    if (!at.value)
        io_warn(r, light, "spot", "is missing; an angle of 45 degrees is used");
    out->outer_cone_rad = io_get_float_in(r, &at, "outerConeAngle", 0.0f, right_angle, 0.785398163f);
    out->inner_cone_rad = io_get_float_in(r, &at, "innerConeAngle", 0.0f, right_angle, 0.0f);
    if (out->inner_cone_rad < out->outer_cone_rad)
        return;
    io_note(r, &at, "innerConeAngle", "must be below outerConeAngle");
    out->inner_cone_rad = out->outer_cone_rad;
}

static void read_light(io_reader *r, const json_place *at, scene_light *out)
{
    *out = (scene_light){.name = io_get_name(r, at), .color = {1, 1, 1}};
    io_get_floats_in(r, at, "color", 0.0f, FLT_MAX, out->color, 3);
    out->intensity = io_get_float_in(r, at, "intensity", 0.0f, FLT_MAX, 1.0f);
    out->range = io_get_float_in(r, at, "range", 0.0f, FLT_MAX, 0.0f);
    const char *type = io_get_string(r, at, "type", NULL);
    if (!type) {
        io_fail(r, at, "type", FACET_ERROR_INVALID, "is missing");
    } else if (strcmp(type, "directional") == 0) {
        out->type = SCENE_LIGHT_DIRECTIONAL;
    } else if (strcmp(type, "point") == 0) {
        out->type = SCENE_LIGHT_POINT;
    } else if (strcmp(type, "spot") == 0) {
        out->type = SCENE_LIGHT_SPOT;
        read_spot(r, at, out);
    } else {
        io_warn(r, at, "type", "\"%.40s\" is not one of directional, point, spot; the light is dark", type);
        out->type = SCENE_LIGHT_POINT;
        out->intensity = 0.0f;
    }
}

void gltf_read_lights(io_reader *r, const json_place *root)
{
    json_place extension = io_get_extension(r, root, "KHR_lights_punctual");
    json_place array = io_get_array(r, &extension, "lights");
    size_t count = io_get_count(&array);
    if (io_is_ok(r) && extension.value && !array.value)
        io_note(r, &extension, "lights", "is missing");
    io_leave_out(r, "there are no lights");
    r->scene->lights = io_alloc(r, "lights", count, sizeof *r->scene->lights);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &array, i);
        read_light(r, &at, &r->scene->lights[i]);
        if (io_leave_out(r, "the light is dark"))
            r->scene->lights[i] = (scene_light){.name = io_get_name(r, &at), .type = SCENE_LIGHT_POINT};
        r->scene->lights[i].meta = gltf_get_meta(r, &at);
        r->scene->light_count = (uint32_t)(i + 1);
    }
}

/* ---- nodes ---- */

double gltf_normalize_rotation(float rotation[4])
{
    double length = 0.0;
    for (int i = 0; i < 4; i++)
        length += (double)rotation[i] * (double)rotation[i];
    length = sqrt(length);
    for (int i = 0; i < 4; i++)
        rotation[i] = length > 0.0 ? (float)((double)rotation[i] / length) : i == 3 ? 1.0f : 0.0f;
    return length;
}

static void read_rotation(io_reader *r, const json_place *at, float rotation[4])
{
    if (io_get_floats(r, at, "rotation", rotation, 4) &&
        !(fabs(gltf_normalize_rotation(rotation) - 1.0) < 0.001))
        io_warn(r, at, "rotation", "is not a quaternion of length 1");
}

static void read_transform(io_reader *r, const json_place *at, scene_node *out)
{
    out->matrix = dmat4_identity();
    out->rotation[3] = out->scale[0] = out->scale[1] = out->scale[2] = 1.0f;
    out->has_matrix = io_get_doubles(r, at, "matrix", out->matrix.m, 16);
    io_get_doubles(r, at, "translation", out->translation, 3);
    read_rotation(r, at, out->rotation);
    io_get_floats(r, at, "scale", out->scale, 3);
    if (!out->has_matrix)
        return;
    if (io_has_member(at, "translation") || io_has_member(at, "rotation") || io_has_member(at, "scale"))
        io_warn(r, at, NULL, "has a matrix beside translation, rotation or scale; the matrix is used");
    const double *m = out->matrix.m;
    if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0) {
        io_warn(r, at, "matrix", "has a last row other than 0 0 0 1, which is ignored");
        out->matrix.m[3] = out->matrix.m[7] = out->matrix.m[11] = 0.0;
        out->matrix.m[15] = 1.0;
    }
}

/* The camera, light, skin, weights and visibility of a node; invalid ones are left out. */
static void read_attachments(io_reader *r, const json_place *at, scene_node *out)
{
    out->camera = io_get_index(r, at, "camera", r->scene->camera_count, "camera");
    io_leave_out(r, "the node has no camera");
    json_place light = io_get_extension(r, at, "KHR_lights_punctual");
    out->light = io_get_required_index(r, &light, "light", r->scene->light_count, "light");
    io_leave_out(r, "the node has no light");
    json_place visibility = io_get_extension(r, at, "KHR_node_visibility");
    out->is_hidden = !io_get_bool(r, &visibility, "visible", true);
    io_leave_out(r, "the node is visible");
    if (out->mesh != SCENE_NONE)
        out->weights = gltf_read_weights(r, at, r->scene->meshes[out->mesh].weight_count);
    else if (io_has_member(at, "weights"))
        io_note(r, at, "weights", "are present without a mesh");
    if (io_leave_out(r, "the node has the weights of its mesh"))
        out->weights = NULL;
}

static void read_node(io_reader *r, const json_place *at, scene_node *out, uint32_t skin_count)
{
    out->name = io_get_name(r, at);
    out->mesh = out->camera = out->skin = out->light = SCENE_NONE;
    read_transform(r, at, out);
    out->mesh = io_get_index(r, at, "mesh", r->scene->mesh_count, "mesh");
    if (out->mesh != SCENE_NONE && r->gltf->meshes[out->mesh].problem.message)
        io_fail_deferred(r, &r->gltf->meshes[out->mesh].problem);
    if (!io_is_ok(r))
        return;
    read_attachments(r, at, out);
    out->skin = io_get_index(r, at, "skin", skin_count, "skin");
    out->instancing = gltf_read_instancing(r, at);
    if (out->mesh == SCENE_NONE) {
        io_leave_out(r, "the node has no mesh");
        if (out->skin != SCENE_NONE)
            io_note(r, at, "skin", "is present without a mesh");
        if (out->instancing)
            io_note(r, at, NULL, "has instances, but no mesh");
    } else if (out->skin != SCENE_NONE && out->instancing) {
        io_warn(r, at, NULL, "has instances of a skinned mesh, which its joints place; it is drawn %s",
                out->instancing->count ? "once" : "nowhere, as there are 0 of them");
    }
    out->meta = gltf_get_meta(r, at);
}

void gltf_read_nodes(io_reader *r, const json_place *root)
{
    json_place array = io_get_array(r, root, "nodes");
    json_place skins = io_get_array(r, root, "skins");
    uint32_t skin_count = (uint32_t)io_get_count(&skins);
    uint32_t count = (uint32_t)io_get_count(&array);
    scene_node *nodes = io_alloc(r, "nodes", count, sizeof *nodes);
    r->scene->nodes = nodes;
    for (uint32_t i = 0; i < count && io_is_ok(r); i++)
        nodes[i].parent = SCENE_NONE;
    for (uint32_t i = 0; i < count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &array, i);
        read_node(r, &at, &nodes[i], skin_count);
        gltf_read_children(r, &at, i, count);
        r->scene->node_count = i + 1;
    }
    if (io_is_ok(r))
        gltf_settle_hierarchy(r, &array);
}

/* ---- scenes ---- */

static void read_scene(io_reader *r, const json_place *at, scene_root *out, bool *is_listed)
{
    out->name = io_get_name(r, at);
    json_place array = io_get_array(r, at, "nodes");
    size_t count = io_get_count(&array);
    uint32_t *nodes = io_alloc(r, "scenes", count, sizeof *nodes);
    out->nodes = nodes;
    memset(is_listed, 0, r->scene->node_count * sizeof *is_listed);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place element = io_get_element(&array, i);
        uint32_t node = io_get_index_value(r, &element, r->gltf->file_node_count, "node");
        if (node == SCENE_NONE)
            return;
        if (r->scene->nodes[node].parent != SCENE_NONE) {
            io_warn(r, &element, NULL, "node %u is not a root but a child of node %u", node,
                    r->scene->nodes[node].parent);
        }
        if (is_listed[node]) {
            io_note(r, &element, NULL, "node %u is listed twice", node);
            continue;
        }
        is_listed[node] = true;
        nodes[out->node_count++] = node;
    }
    if (!io_is_ok(r))
        return;
    json_place light = io_get_extension(r, at, "EXT_lights_image_based");
    out->image_light = io_get_required_index(r, &light, "light", r->scene->image_light_count, "light");
    if (out->image_light != SCENE_NONE && r->scene->image_lights[out->image_light].mip_count == 0)
        out->image_light = SCENE_NONE; /* a warning gave the reason */
    if (io_leave_out(r, "the scene has no image-based light"))
        out->image_light = SCENE_NONE;
    out->meta = gltf_get_meta(r, at);
}

void gltf_read_scenes(io_reader *r, const json_place *root)
{
    json_place array = io_get_array(r, root, "scenes");
    size_t count = io_get_count(&array);
    r->scene->scenes = io_alloc(r, "scenes", count, sizeof *r->scene->scenes);
    uint32_t drawn = io_get_index(r, root, "scene", (uint32_t)count, "scene");
    bool is_wrong = io_leave_out(r, count ? "the first scene is drawn" : "all nodes are drawn");
    if (count && (is_wrong || drawn == SCENE_NONE))
        drawn = 0;
    bool *is_listed = mem_alloc(r->allocator, r->scene->node_count, sizeof *is_listed);
    if (!is_listed)
        io_fail_memory(r, "scenes", r->scene->node_count);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &array, i);
        scene_root *scene = &r->scene->scenes[i];
        scene->image_light = SCENE_NONE;
        read_scene(r, &at, scene, is_listed);
        if (i != drawn && io_leave_out(r, "that scene is empty"))
            scene->node_count = 0;
        r->scene->scene_count = (uint32_t)(i + 1);
    }
    mem_free(is_listed);
    r->scene->default_scene = drawn;
    if (io_is_ok(r) && r->scene->scene_count == 0 && r->scene->node_count)
        io_note(r, NULL, NULL, "has no scene; all its nodes are drawn");
}

/* ---- cube maps that light a scene; their images are decoded later ---- */

static const char NAME[] = "EXT_lights_image_based";

/* Nine coefficients for each of red, green and blue. */
static void read_irradiance(io_reader *r, const json_place *light, scene_image_light *out)
{
    json_place array = io_get_array(r, light, "irradianceCoefficients");
    if (io_is_ok(r) && io_get_count(&array) != 9)
        io_fail(r, light, "irradianceCoefficients", FACET_ERROR_INVALID,
                "must have 9 coefficients, but has %zu", io_get_count(&array));
    for (size_t i = 0; i < 9 && io_is_ok(r); i++) {
        json_place element = io_get_element(&array, i);
        io_get_floats_value(r, &element, out->irradiance[i], 3);
    }
}

static void read_cube(io_reader *r, const json_place *light, scene_image_light *out)
{
    json_place array = io_get_array(r, light, "specularImages");
    size_t mip_count = io_get_count(&array);
    out->specular_size = (uint32_t)io_get_uint(r, light, "specularImageSize", UINT32_MAX, IO_REQUIRED_UINT);
    if (io_is_ok(r) && (mip_count == 0 || mip_count > 32))
        io_fail(r, light, "specularImages", FACET_ERROR_INVALID, "must have 1 to 32 mips, but has %zu",
                mip_count);
    uint32_t *images = io_alloc(r, "lights", mip_count, 6 * sizeof *images);
    for (size_t mip = 0; mip < mip_count && io_is_ok(r); mip++) {
        json_place faces = io_get_element(&array, mip);
        if (!json_is_array(faces.value) || io_get_count(&faces) != 6)
            io_fail(r, &faces, NULL, FACET_ERROR_INVALID, "must be an array of 6 images");
        for (size_t face = 0; face < 6 && io_is_ok(r); face++) {
            json_place element = io_get_element(&faces, face);
            images[6 * mip + face] = io_get_index_value(r, &element, r->scene->image_count, "image");
        }
    }
    out->images = images;
    out->mip_count = (uint32_t)mip_count;
}

void gltf_read_image_lights(io_reader *r, const json_place *root)
{
    json_place extension = io_get_extension(r, root, NAME);
    json_place array = io_get_array(r, &extension, "lights");
    size_t count = io_get_count(&array);
    if (io_is_ok(r) && extension.value && !array.value)
        io_note(r, &extension, "lights", "is missing");
    io_leave_out(r, "there is no image-based light");
    r->scene->image_lights = io_alloc(r, "lights", count, sizeof *r->scene->image_lights);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &array, i);
        scene_image_light *out = &r->scene->image_lights[i];
        *out = (scene_image_light){.name = io_get_name(r, &at), .rotation = {0, 0, 0, 1}};
        if (io_get_floats(r, &at, "rotation", out->rotation, 4))
            gltf_normalize_rotation(out->rotation);
        out->intensity = io_get_float_in(r, &at, "intensity", 0.0f, FLT_MAX, 1.0f);
        read_irradiance(r, &at, out);
        read_cube(r, &at, out);
        if (io_leave_out(r, "the image-based light is left out"))
            *out = (scene_image_light){.name = io_get_name(r, &at), .rotation = {0, 0, 0, 1}};
        out->meta = gltf_get_meta(r, &at);
        r->scene->image_light_count = (uint32_t)(i + 1);
    }
}
