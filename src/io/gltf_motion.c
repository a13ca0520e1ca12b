/* gltf_motion.c - skins and animations: what they refer to is checked, so that a broken file is refused today and not
 * only once facet moves things. They are counted, not evaluated yet. */
#include <string.h>

#include "io/gltf_reader.h"

/* ---- skins ---- */

static void check_bind_matrices(reader *r, const json_place *skin, size_t joint_count)
{
    uint32_t index = get_index(r, skin, "inverseBindMatrices", r->accessor_count, "accessor");
    if (index == SCENE_NONE)
        return;
    const gltf_accessor *a = &r->accessors[index];
    if (a->type != GLTF_MAT4 || a->component != GLTF_F32)
        reader_fail(r, skin, "inverseBindMatrices", FACET_ERROR_INVALID,
                    "accessor %u must have MAT4 elements of floats", index);
    else if (a->count < joint_count)
        reader_fail(r, skin, "inverseBindMatrices", FACET_ERROR_INVALID,
                    "accessor %u has %u elements, but there are %zu joints", index, a->count, joint_count);
    if (a->view != SCENE_NONE && r->views[a->view].stride)
        reader_warn(r, skin, "inverseBindMatrices", "is in a buffer view with byteStride");
}

/* For each node the outermost one above it; a block of mem_alloc(), NULL: an error is recorded. */
static uint32_t *find_roots(reader *r)
{
    const facet_scene *scene = r->scene;
    uint32_t *roots = mem_alloc(r->allocator, scene->node_count, sizeof *roots);
    if (!roots) {
        reader_fail_memory(r, "nodes", scene->node_count * sizeof *roots);
        return NULL;
    }
    memset(roots, 0xff, scene->node_count * sizeof *roots);
    for (uint32_t i = 0; i < scene->node_count; i++) {
        uint32_t top = i;
        while (roots[top] == SCENE_NONE && scene->nodes[top].parent != SCENE_NONE)
            top = scene->nodes[top].parent;
        uint32_t root = roots[top] == SCENE_NONE ? top : roots[top];
        for (uint32_t node = i; node != SCENE_NONE && roots[node] == SCENE_NONE;
             node = scene->nodes[node].parent)
            roots[node] = root;
    }
    return roots;
}

static void read_skin(reader *r, const json_place *at, const uint32_t *roots)
{
    const facet_scene *scene = r->scene;
    json_place joints = get_array(r, at, "joints");
    if (reader_is_ok(r) && !joints.value)
        reader_fail(r, at, "joints", FACET_ERROR_INVALID, "is missing");
    get_index(r, at, "skeleton", scene->node_count, "node");
    uint32_t root = SCENE_NONE;
    for (size_t i = 0; i < get_count(&joints) && reader_is_ok(r); i++) {
        json_place element = get_element(&joints, i);
        uint32_t joint = get_index_value(r, &element, scene->node_count, "node");
        if (joint != SCENE_NONE && root != SCENE_NONE && roots[joint] != root)
            reader_warn(r, &joints, NULL, "have no common root");
        if (joint != SCENE_NONE)
            root = roots[joint];
    }
    check_bind_matrices(r, at, get_count(&joints));
}

void read_skins(reader *r, const json_place *root)
{
    json_place array = get_array(r, root, "skins");
    size_t count = get_count(&array);
    uint32_t *roots = count ? find_roots(r) : NULL;
    for (size_t i = 0; i < count && reader_is_ok(r); i++) {
        json_place at = get_element_object(r, &array, i);
        read_skin(r, &at, roots);
    }
    mem_free(roots);
    r->scene->skin_count = (uint32_t)count;
    if (count)
        reader_warn(r, NULL, NULL,
                    "has skins, which are not applied yet: meshes are drawn as they are stored");
}

/* ---- animations ---- */

static void check_sampler(reader *r, const json_place *at)
{
    static const char *const keys[2] = {"input", "output"};
    for (int i = 0; i < 2; i++) {
        uint32_t index = get_required_index(r, at, keys[i], r->accessor_count, "accessor");
        if (index == SCENE_NONE)
            return;
        const gltf_accessor *a = &r->accessors[index];
        if (a->view != SCENE_NONE && r->views[a->view].stride)
            reader_warn(r, at, keys[i], "accessor %u is in a buffer view with byteStride", index);
        if (i == 0 && (a->type != GLTF_SCALAR || a->component != GLTF_F32))
            reader_warn(r, at, keys[i], "accessor %u must have SCALAR elements of floats", index);
    }
    const char *interpolation = get_string(r, at, "interpolation", "LINEAR");
    if (strcmp(interpolation, "LINEAR") != 0 && strcmp(interpolation, "STEP") != 0 &&
        strcmp(interpolation, "CUBICSPLINE") != 0)
        reader_warn(r, at, "interpolation", "\"%.40s\" is none of LINEAR, STEP, CUBICSPLINE", interpolation);
}

static void check_channel(reader *r, const json_place *at, const json_place *samplers)
{
    uint32_t sampler = get_required_index(r, at, "sampler", (uint32_t)get_count(samplers), "sampler");
    json_place target = get_object(r, at, "target");
    if (reader_is_ok(r) && !target.value)
        reader_fail(r, at, "target", FACET_ERROR_INVALID, "is missing");
    uint32_t node = get_index(r, &target, "node", r->scene->node_count, "node");
    const char *path = get_string(r, &target, "path", "");
    if (!reader_is_ok(r))
        return;
    static const struct {
        const char *path;
        gltf_type type;
    } paths[] = {
        {"translation", GLTF_VEC3}, {"rotation", GLTF_VEC4}, {"scale", GLTF_VEC3}, {"weights", GLTF_SCALAR}};
    size_t i = 0;
    while (i < 4 && strcmp(path, paths[i].path) != 0)
        i++;
    if (i == 4) {
        if (strcmp(path, "pointer") != 0)
            reader_warn(r, &target, "path", "\"%.40s\" is nothing that moves", path);
        return;
    }
    json_place element = get_element_object(r, samplers, sampler);
    uint32_t output = get_index(r, &element, "output", r->accessor_count, "accessor");
    if (output != SCENE_NONE && r->accessors[output].type != paths[i].type)
        reader_warn(r, at, "sampler", "accessor %u has a type that %s cannot have", output, path);
    if (i == 3 && node != SCENE_NONE && r->scene->nodes[node].mesh == SCENE_NONE)
        reader_warn(r, &target, NULL, "asks for weights of node %u, which has no mesh", node);
}

void read_animations(reader *r, const json_place *root)
{
    json_place array = get_array(r, root, "animations");
    size_t count = get_count(&array);
    for (size_t i = 0; i < count && reader_is_ok(r); i++) {
        json_place at = get_element_object(r, &array, i);
        json_place samplers = get_array(r, &at, "samplers");
        json_place channels = get_array(r, &at, "channels");
        if (reader_is_ok(r) && (!samplers.value || !channels.value))
            reader_fail(r, &at, samplers.value ? "channels" : "samplers", FACET_ERROR_INVALID, "is missing");
        for (size_t k = 0; k < get_count(&samplers) && reader_is_ok(r); k++) {
            json_place sampler = get_element_object(r, &samplers, k);
            check_sampler(r, &sampler);
        }
        for (size_t k = 0; k < get_count(&channels) && reader_is_ok(r); k++) {
            json_place channel = get_element_object(r, &channels, k);
            check_channel(r, &channel, &samplers);
        }
    }
    r->scene->animation_count = (uint32_t)count;
}
