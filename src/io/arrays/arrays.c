/* arrays.c - the scene: its cameras, lights and nodes, and the checks that all files of this folder share. Materials and
 * textures: arrays_materials.c; meshes: arrays_meshes.c. */
#include "io/arrays/arrays.h"

#include <math.h>
#include <string.h>

#include "base/result.h"
#include "io/arrays/arrays_reader.h"
#include "io/gltf/gltf_reader.h"

/* ---- copies and checks ---- */

const char *arrays_copy_text(io_reader *r, const char *text)
{
    const char *copy = text ? arena_strdup(r->scene->arena, text) : "";
    if (!copy)
        io_fail_memory(r, "name", strlen(text));
    return copy ? copy : "";
}

void *arrays_copy(io_reader *r, const char *what, const void *in, size_t count, size_t size)
{
    void *out = io_alloc_raw(r, what, count, size);
    if (out && count)
        memcpy(out, in, count * size);
    return out;
}

bool arrays_check_floats(io_reader *r, const json_place *at, const char *key, const float *in, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!(fabsf(in[i]) <= SCENE_FARTHEST))
            return io_fail(r, at, key, FACET_ERROR_ARGUMENT,
                           "number %zu is %g, but must be finite and at most %g", i, (double)in[i],
                           (double)SCENE_FARTHEST);
    return io_is_ok(r);
}

bool arrays_check_doubles(io_reader *r, const json_place *at, const char *key, const double *in, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!(fabs(in[i]) <= (double)SCENE_FARTHEST))
            return io_fail(r, at, key, FACET_ERROR_ARGUMENT,
                           "number %zu is %g, but must be finite and at most %g", i, in[i],
                           (double)SCENE_FARTHEST);
    return io_is_ok(r);
}

const float *arrays_copy_floats(io_reader *r, const json_place *at, const char *key, const float *in,
                                size_t count)
{
    if (!in || !arrays_check_floats(r, at, key, in, count))
        return NULL;
    return arrays_copy(r, key, in, count, sizeof *in);
}

bool arrays_check_index(io_reader *r, const json_place *at, const char *key, uint32_t index, uint32_t count,
                        const char *what)
{
    return index < count ||
           io_fail(r, at, key, FACET_ERROR_ARGUMENT, "is %u, but there are %u %s", index, count, what);
}

bool arrays_check_array(io_reader *r, const json_place *at, const char *key, const void *array,
                        uint32_t count)
{
    return array || count == 0 ||
           io_fail(r, at, key, FACET_ERROR_ARGUMENT, "is NULL, but its count is %u", count);
}

/* ---- cameras ---- */

static void read_camera(io_reader *r, const json_place *at, const facet_camera_desc *in, scene_camera *out)
{
    const float numbers[5] = {in->fov_y_rad, in->ortho_height, in->aspect, in->near_m, in->far_m};
    *out = (scene_camera){.name = arrays_copy_text(r, in->name),
                          .is_orthographic = in->fov_y_rad == 0.0f,
                          .fov_y_rad = in->fov_y_rad,
                          .aspect = in->aspect,
                          .ortho_height = in->ortho_height,
                          .ortho_width = in->ortho_height * (in->aspect > 0.0f ? in->aspect : 1.0f),
                          .near_m = in->near_m,
                          .far_m = in->far_m};
    for (int i = 0; i < 5; i++)
        if (!(numbers[i] >= 0.0f && numbers[i] <= SCENE_FARTHEST))
            io_fail(r, at, NULL, FACET_ERROR_ARGUMENT, "has the number %g; all must be finite and at least 0",
                    (double)numbers[i]);
    if (in->fov_y_rad >= 3.14f)
        io_fail(r, at, "fov_y_rad", FACET_ERROR_ARGUMENT, "is %g, but must be below 3.14",
                (double)in->fov_y_rad);
    if (out->is_orthographic && !(in->ortho_height > 0.0f))
        io_fail(r, at, NULL, FACET_ERROR_ARGUMENT, "needs fov_y_rad, or ortho_height above 0");
    if (in->far_m != 0.0f && !(in->far_m > in->near_m))
        io_fail(r, at, "far_m", FACET_ERROR_ARGUMENT, "is %g, but must be above near_m, %g",
                (double)in->far_m, (double)in->near_m);
}

static void read_cameras(io_reader *r, const facet_arrays_desc *in)
{
    if (!arrays_check_array(r, NULL, "cameras", in->cameras, in->camera_count))
        return;
    r->scene->cameras = io_alloc(r, "cameras", in->camera_count, sizeof *r->scene->cameras);
    for (uint32_t i = 0; i < in->camera_count && io_is_ok(r); i++) {
        ARRAYS_PLACE(array, at, NULL, "cameras", i);
        read_camera(r, &at, &in->cameras[i], &r->scene->cameras[i]);
        r->scene->camera_count = i + 1;
    }
}

/* ---- lights ---- */

static void read_light(io_reader *r, const json_place *at, const facet_light_desc *in, scene_light *out)
{
    static const float white[3] = {1, 1, 1};
    const float quarter_pi = 0.785398163f, right_angle = 1.57079637f;
    bool has_color = in->color[0] != 0.0f || in->color[1] != 0.0f || in->color[2] != 0.0f;
    const float outer = in->outer_cone_rad == 0.0f ? quarter_pi : in->outer_cone_rad;
    static const scene_light_type types[] = {SCENE_LIGHT_DIRECTIONAL, SCENE_LIGHT_POINT, SCENE_LIGHT_SPOT};
    if ((unsigned)in->type >= sizeof types / sizeof *types) {
        io_fail(r, at, "type", FACET_ERROR_ARGUMENT, "is %d, which is no facet_light_type", (int)in->type);
        return;
    }
    *out = (scene_light){.name = arrays_copy_text(r, in->name),
                         .type = types[in->type],
                         .intensity = in->intensity,
                         .range = in->range_m};
    memcpy(out->color, has_color ? in->color : white, sizeof out->color);
    const float numbers[5] = {in->color[0], in->color[1], in->color[2], in->intensity, in->range_m};
    for (int i = 0; i < 5; i++)
        if (!(numbers[i] >= 0.0f && numbers[i] <= SCENE_FARTHEST))
            io_fail(r, at, NULL, FACET_ERROR_ARGUMENT,
                    "has the number %g; color, intensity and range_m must be finite and at least 0",
                    (double)numbers[i]);
    if (in->type != FACET_LIGHT_TYPE_SPOT)
        return;
    out->outer_cone_rad = outer;
    out->inner_cone_rad = in->inner_cone_rad;
    if (!(in->inner_cone_rad >= 0.0f && in->inner_cone_rad < outer && outer <= right_angle))
        io_fail(r, at, "inner_cone_rad", FACET_ERROR_ARGUMENT,
                "is %g and outer_cone_rad %g; they must be in order and lie in [0, pi/2]",
                (double)in->inner_cone_rad, (double)outer);
}

static void read_lights(io_reader *r, const facet_arrays_desc *in)
{
    if (!arrays_check_array(r, NULL, "lights", in->lights, in->light_count))
        return;
    r->scene->lights = io_alloc(r, "lights", in->light_count, sizeof *r->scene->lights);
    for (uint32_t i = 0; i < in->light_count && io_is_ok(r); i++) {
        ARRAYS_PLACE(array, at, NULL, "lights", i);
        read_light(r, &at, &in->lights[i], &r->scene->lights[i]);
        r->scene->light_count = i + 1;
    }
}

/* ---- nodes ---- */

static void read_transform(io_reader *r, const json_place *at, const facet_node_desc *in, scene_node *out)
{
    bool has_scale = in->scale[0] != 0.0f || in->scale[1] != 0.0f || in->scale[2] != 0.0f;
    out->matrix = dmat4_identity();
    memcpy(out->translation, in->translation, sizeof out->translation);
    memcpy(out->rotation, in->rotation, sizeof out->rotation);
    if (has_scale)
        memcpy(out->scale, in->scale, sizeof out->scale);
    if (!arrays_check_doubles(r, at, "translation", in->translation, 3) ||
        !arrays_check_floats(r, at, "rotation", in->rotation, 4) ||
        !arrays_check_floats(r, at, "scale", in->scale, 3))
        return;
    gltf_normalize_rotation(out->rotation);
    if (!in->matrix || !arrays_check_doubles(r, at, "matrix", in->matrix, 16))
        return;
    const double *m = in->matrix;
    if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0)
        io_fail(r, at, "matrix", FACET_ERROR_ARGUMENT,
                "has the last row %g %g %g %g, but must have 0 0 0 1 (numbers 3, 7, 11 and 15)", m[3], m[7],
                m[11], m[15]);
    out->has_matrix = true;
    memcpy(out->matrix.m, m, sizeof out->matrix.m);
}

static void read_instances(io_reader *r, const json_place *at, const facet_node_desc *in, scene_node *out)
{
    size_t count = in->instance_count;
    scene_instancing *instancing = io_alloc(r, "instances", 1, sizeof *instancing);
    if (!instancing)
        return;
    instancing->count = in->instance_count;
    instancing->translations =
        arrays_copy_floats(r, at, "instance_translations", in->instance_translations, 3 * count);
    instancing->scales = arrays_copy_floats(r, at, "instance_scales", in->instance_scales, 3 * count);
    if (in->instance_rotations &&
        arrays_check_floats(r, at, "instance_rotations", in->instance_rotations, 4 * count)) {
        float *rotations = arrays_copy(r, "instances", in->instance_rotations, count, 4 * sizeof *rotations);
        for (size_t i = 0; i < count && rotations; i++)
            gltf_normalize_rotation(rotations + 4 * i);
        instancing->rotations = rotations;
    }
    out->instancing = instancing;
}

static void read_node(io_reader *r, const json_place *at, const facet_arrays_desc *arrays, uint32_t index,
                      scene_node *out)
{
    const facet_node_desc *in = &arrays->nodes[index];
    *out = scene_node_default(arrays_copy_text(r, in->name));
    out->is_hidden = in->is_hidden;
    read_transform(r, at, in, out);
    if (in->has_parent && in->parent >= index)
        io_fail(r, at, "parent", FACET_ERROR_ARGUMENT,
                "is %u, but parents come before their children: it must be below %u", in->parent, index);
    else if (in->has_parent)
        out->parent = in->parent;
    if (in->has_mesh && arrays_check_index(r, at, "mesh", in->mesh, arrays->mesh_count, "meshes"))
        out->mesh = in->mesh;
    if (in->has_camera && arrays_check_index(r, at, "camera", in->camera, arrays->camera_count, "cameras"))
        out->camera = in->camera;
    if (in->has_light && arrays_check_index(r, at, "light", in->light, arrays->light_count, "lights"))
        out->light = in->light;
    if (in->instance_count && io_is_ok(r))
        read_instances(r, at, in, out);
}

/* Lists of children, and the roots. The parent of each node is before it. */
static void link_nodes(io_reader *r)
{
    facet_scene *scene = r->scene;
    uint32_t root_count = 0;
    for (uint32_t i = 0; i < scene->node_count; i++)
        if (scene->nodes[i].parent == SCENE_NONE)
            root_count++;
        else
            scene->nodes[scene->nodes[i].parent].child_count++;
    uint32_t *lists = io_alloc_raw(r, "nodes", scene->node_count, sizeof *lists), *roots = lists;
    scene->scenes = io_alloc(r, "scenes", 1, sizeof *scene->scenes);
    if (!io_is_ok(r))
        return;
    lists += root_count;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        scene->nodes[i].children = lists;
        lists += scene->nodes[i].child_count;
        scene->nodes[i].child_count = 0;
    }
    root_count = 0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        scene_node *parent =
            scene->nodes[i].parent == SCENE_NONE ? NULL : &scene->nodes[scene->nodes[i].parent];
        if (parent) /* lists are in `roots`, which may be written */
            roots[parent->children - roots + parent->child_count++] = i;
        else
            roots[root_count++] = i;
    }
    scene->scenes[0] =
        (scene_root){.name = "", .node_count = root_count, .nodes = roots, .image_light = SCENE_NONE};
    scene->scene_count = 1;
    scene->default_scene = 0;
}

static void read_nodes(io_reader *r, const facet_arrays_desc *in)
{
    if (!arrays_check_array(r, NULL, "nodes", in->nodes, in->node_count))
        return;
    uint32_t count = in->node_count ? in->node_count : in->mesh_count;
    scene_node *nodes = io_alloc(r, "nodes", count, sizeof *nodes);
    r->scene->nodes = nodes;
    for (uint32_t i = 0; i < count && io_is_ok(r); i++) {
        ARRAYS_PLACE(array, at, NULL, "nodes", i);
        if (in->node_count) {
            read_node(r, &at, in, i, &nodes[i]);
        } else {
            nodes[i] = scene_node_default(r->scene->meshes[i].name);
            nodes[i].mesh = i;
        }
        r->scene->node_count = i + 1;
    }
    if (io_is_ok(r))
        link_nodes(r);
}

/* ---- the scene ---- */

static void read_variants(io_reader *r, const facet_arrays_desc *in)
{
    if (!arrays_check_array(r, NULL, "variants", in->variants, in->variant_count))
        return;
    r->scene->variants = io_alloc(r, "variants", in->variant_count, sizeof *r->scene->variants);
    for (uint32_t i = 0; i < in->variant_count && io_is_ok(r); i++) {
        r->scene->variants[i] = arrays_copy_text(r, in->variants[i]);
        r->scene->variant_count = i + 1;
    }
}

facet_result arrays_load(const facet_arrays_desc *arrays, const facet_scene_desc *desc, facet_scene **out,
                         facet_error *error)
{
    facet_scene *scene = NULL;
    gltf_tables tables = {0};
    *out = NULL;
    TRY(scene_create(&desc->allocator, arrays->name ? arrays->name : "arrays", &scene, error));
    scene->max_texture_size = desc->max_texture_size;
    scene->thread_count = desc->thread_count;
    scene->version = "2.0";
    io_reader r = {.scene = scene,
                   .gltf = &tables,
                   .allocator = &desc->allocator,
                   .log = &desc->log,
                   .error = error,
                   .thread_count = desc->thread_count};
    void (*const concerns[])(io_reader *, const facet_arrays_desc *) = {
        arrays_read_textures, arrays_read_materials, read_variants, arrays_read_meshes,
        read_cameras,         read_lights,           read_nodes};
    for (size_t i = 0; i < sizeof concerns / sizeof *concerns && io_is_ok(&r); i++)
        concerns[i](&r, arrays);
    if (r.result != FACET_OK) {
        scene_destroy(scene);
        return r.result;
    }
    *out = scene;
    return FACET_OK;
}
