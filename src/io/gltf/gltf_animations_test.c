/* gltf_animations_test.c - animations: keys, core channels, and targets of KHR_animation_pointer. */
#include "io/gltf/gltf_test_support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const float TIMES[3] = {0, 1, 2.5f};
static const float VECTORS[9] = {1, 2, 3, 4, 5, 6, 7, 8, 9};

/* ---- samplers ---- */

static void core_channels_are_read(void **state)
{
    (void)state;
    const float rotations[12] = {0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 0};
    const float weights[6] = {0, 1, 0.5f, 0.25f, 1, 0};
    const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    test_model m = {0};
    model_add_floats(&m, TIMES, 3, "SCALAR");
    model_add_floats(&m, VECTORS, 3, "VEC3");
    model_add_floats(&m, rotations, 3, "VEC4");
    model_add_floats(&m, weights, 6, "SCALAR");
    model_add_floats(&m, corners, 3, "VEC3");
    facet_scene *scene = model_load(
        &m, "'meshes':[{'primitives':[{'attributes':{'POSITION':4},'targets':[{'POSITION':4},{}]}]}],"
            "'nodes':[{'mesh':0},{}],'animations':[{'name':'a','extras':{'k':1},'samplers':["
            "{'input':0,'output':1,'interpolation':'STEP'},{'input':0,'output':2},{'input':0,'output':3},"
            "{'input':0,'output':1}],'channels':["
            "{'sampler':0,'target':{'node':1,'path':'translation'}},"
            "{'sampler':1,'target':{'node':0,'path':'rotation'}},"
            "{'sampler':2,'target':{'node':0,'path':'weights'}},"
            "{'sampler':0,'target':{'node':0,'path':'scale'}},"
            "{'sampler':0,'target':{'path':'scale'}}]}]");
    const scene_animation *a = &scene->animations[0];
    assert_int_equal(scene->animation_count, 1);
    assert_string_equal(a->name, "a");
    assert_string_equal(a->meta.extras, "{\"k\":1}");
    assert_int_equal(a->channel_count, 4); /* the last one has no node */
    assert_int_equal(a->sampler_count, 3); /* the last one has no effect */
    assert_near(a->begin_s, 0, 0);
    assert_near(a->end_s, 2.5, 0);
    const scene_channel *c = a->channels;
    assert_int_equal(c[0].kind, SCENE_TARGET_NODE);
    assert_int_equal(c[0].index, 1);
    assert_int_equal(c[0].offset, offsetof(scene_node, translation));
    assert_near(c[0].scale, 1, 0);
    assert_false(c[0].is_rotation);
    assert_null(c[0].pointer);
    assert_true(c[1].is_rotation);
    assert_int_equal(c[1].offset, offsetof(scene_node, rotation));
    assert_int_equal(c[2].kind, SCENE_TARGET_WEIGHTS);
    assert_int_equal(c[2].offset, 0);
    assert_int_equal(c[3].offset, offsetof(scene_node, scale));
    assert_int_equal(c[3].sampler, c[0].sampler);
    const scene_sampler *s = &a->samplers[c[0].sampler];
    assert_int_equal(s->interpolation, SCENE_STEP);
    assert_int_equal(s->key_count, 3);
    assert_int_equal(s->width, 3);
    assert_floats(s->times, TIMES, 3, 0);
    assert_floats(s->values, VECTORS, 9, 0);
    assert_int_equal(a->samplers[c[1].sampler].interpolation, SCENE_LINEAR);
    assert_int_equal(a->samplers[c[2].sampler].width, 2);
    assert_floats(a->samplers[c[2].sampler].values, weights, 6, 0);
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
}

/* In-tangent, value, out-tangent: all three shrink by the length of the value. */
static void cubic_rotations_become_unit(void **state)
{
    (void)state;
    const float rotations[24] = {2, 0, 0, 0, 0, 0, 2, 0, 0, 4, 0, 0, 0, 0, 0, 8, 0, 0, 0, 1, 0, 0, 0, 1};
    test_model m = {0};
    model_add_floats(&m, TIMES, 2, "SCALAR");
    model_add_floats(&m, rotations, 6, "VEC4");
    facet_scene *scene =
        model_load(&m, "'nodes':[{}],'animations':[{'samplers':[{'input':0,'output':1,'interpolation':"
                       "'CUBICSPLINE'}],'channels':[{'sampler':0,'target':{'node':0,'path':'rotation'}}]}]");
    const scene_sampler *s = &scene->animations[0].samplers[0];
    const float expected[24] = {1, 0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 0, 0, 8, 0, 0, 0, 1, 0, 0, 0, 1};
    assert_int_equal(s->interpolation, SCENE_CUBIC_SPLINE);
    assert_int_equal(s->key_count, 2);
    assert_int_equal(s->width, 4);
    assert_floats(s->values, expected, 24, 0);
    assert_true(has_warning(scene, "output: has 1 rotations that are not of length 1"));
    scene_destroy(scene);
}

static void normalised_rotations_become_unit(void **state)
{
    (void)state;
    const short rotations[12] = {23170, 0, 0, 23170, 0, 0, 0, 32767, 0, -32768, 0, 0};
    const signed char bytes[12] = {90, 0, 0, 90, 0, 0, 0, 0, 0, 0, 0, 127};
    test_model m = {0};
    model_add_floats(&m, TIMES, 3, "SCALAR");
    model_add(&m, rotations, 3, "VEC4", 5122, ",'normalized':true");
    model_add(&m, bytes, 3, "VEC4", 5120, ",'normalized':true");
    facet_scene *scene =
        model_load(&m, "'nodes':[{}],'animations':[{'samplers':[{'input':0,'output':1},{'input':0,"
                       "'output':2}],'channels':[{'sampler':0,'target':{'node':0,'path':'rotation'}},"
                       "{'sampler':1,'target':{'node':0,'path':'rotation'}}]}]");
    const float *values = scene->animations[0].samplers[0].values;
    assert_near(values[0], sqrt(0.5), 1e-5);
    assert_near(values[9], -1, 0);
    values = scene->animations[0].samplers[1].values;
    const float identity[4] = {0, 0, 0, 1};
    assert_near(values[0], sqrt(0.5), 1e-6);
    assert_floats(values + 4, identity, 4, 0); /* a quaternion without direction */
    assert_true(has_warning(scene, "samplers[1].output: has 1 rotations that are not of length 1"));
    scene_destroy(scene);
}

static void keys_are_put_in_order(void **state)
{
    (void)state;
    const float times[5] = {2, 1, 1, NAN, 0.5f};
    const float values[15] = {0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4};
    test_model m = {0};
    model_add_floats(&m, times, 5, "SCALAR");
    model_add_floats(&m, values, 5, "VEC3");
    model_add_floats(&m, times + 3, 1, "SCALAR");
    facet_scene *scene =
        model_load(&m, "'nodes':[{}],'animations':[{'samplers':[{'input':0,'output':1},{'input':2,'output':"
                       "1}],'channels':[{'sampler':0,'target':{'node':0,'path':'scale'}},"
                       "{'sampler':1,'target':{'node':0,'path':'translation'}}]}]");
    const scene_animation *a = &scene->animations[0];
    const float sorted[3] = {0.5f, 1, 2};
    assert_int_equal(a->channel_count, 1);
    assert_int_equal(a->samplers[0].key_count, 3);
    assert_floats(a->samplers[0].times, sorted, 3, 0);
    assert_near(a->samplers[0].values[0], 4, 0);
    assert_near(a->samplers[0].values[3], 2, 0); /* the later one of two at 1 s */
    assert_near(a->samplers[0].values[6], 0, 0);
    assert_true(has_warning(scene, "samplers[0].input: does not increase strictly; 3 of 5 keys are used"));
    scene_destroy(scene);
}

/* Invalid targets are reported and not animated. */
static void unsupported_targets_are_reported(void **state)
{
    (void)state;
    test_model m = {0};
    model_add_floats(&m, TIMES, 3, "SCALAR");
    model_add_floats(&m, VECTORS, 2, "VEC3");
    model_add_floats(&m, VECTORS, 3, "VEC3");
    model_add_floats(&m, VECTORS, 3, "VEC2");
    static const struct {
        const char *sampler, *target, *warning;
    } cases[] = {
        {"'input':0,'output':1", "'node':0,'path':'scale'",
         "accessor 1 has 2 elements, which is no multiple"},
        {"'input':0,'output':2,'interpolation':'CUBICSPLINE'", "'node':0,'path':'scale'",
         "which is no multiple of 9"},
        {"'input':2,'output':2", "'node':0,'path':'scale'", "accessor 2 must have SCALAR elements"},
        {"'input':0,'output':3", "'node':0,'path':'scale'", "has 2 numbers per key, but its target has 3"},
        {"'input':0,'output':2", "'node':0,'path':'rotation'", "has 3 numbers per key, but its target has 4"},
        {"'input':0,'output':2", "'node':0,'path':'weights'", "targets weights of node 0, which has no mesh"},
        {"'input':0,'output':2", "'node':0,'path':'color'", "\"color\" is not a target path"},
        {"'input':0,'output':2", "'path':'pointer'", "is \"pointer\", but the pointer is missing"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        facet_scene *scene =
            model_load(&m,
                       "'nodes':[{}],'animations':[{'samplers':[{%s}],'channels':[{'sampler':0,"
                       "'target':{%s}}]}]",
                       cases[i].sampler, cases[i].target);
        assert_int_equal(scene->animations[0].channel_count, 0);
        if (!has_warning(scene, cases[i].warning))
            fail_msg("no \"%s\", but \"%s\"", cases[i].warning, scene->warnings[scene->warning_count - 1]);
        scene_destroy(scene);
    }
    facet_scene *scene = model_load(
        &m, "'nodes':[{'matrix':[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}],'animations':[{'samplers':[{'input':0,"
            "'output':2,'interpolation':'SMOOTH'}],'channels':[{'sampler':0,'target':{'node':0,"
            "'path':'scale'}}]}]");
    assert_int_equal(scene->animations[0].samplers[0].interpolation, SCENE_LINEAR);
    assert_true(has_warning(scene, "\"SMOOTH\" is not one of LINEAR, STEP, CUBICSPLINE"));
    assert_true(has_warning(scene, "animates node 0, which has a matrix"));
    scene_destroy(scene);
}

/* ---- pointers ---- */

/* A 1 x 1 PNG. */
#define PNG                                                                                                  \
    "'data:image/png;base64,"                                                                                \
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMIQAAAABJRU5ErkJggg=='"

/* Something of each kind that moves. */
#define OBJECTS                                                                                              \
    "'extensionsUsed':['KHR_animation_pointer','KHR_node_visibility','KHR_lights_punctual',"                 \
    "'KHR_materials_clearcoat','KHR_materials_ior','KHR_materials_volume','KHR_texture_transform',"          \
    "'KHR_materials_pbrSpecularGlossiness'],"                                                                \
    "'images':[{'uri':" PNG "}],'textures':[{'source':0}],"                                                  \
    "'materials':[{'normalTexture':{'index':0},'extensions':{'KHR_materials_clearcoat':{"                    \
    "'clearcoatNormalTexture':{'index':0}},'KHR_materials_ior':{'ior':0},'KHR_materials_volume':{}}},"       \
    "{'extensions':{'KHR_materials_pbrSpecularGlossiness':{'diffuseTexture':{'index':0}}}}],"                \
    "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'point'},{'type':'spot','spot':{}}]}},"          \
    "'cameras':[{'type':'perspective','perspective':{'yfov':1,'znear':1}},"                                  \
    "{'type':'orthographic','orthographic':{'xmag':1,'ymag':1,'znear':0,'zfar':9}}],"                        \
    "'meshes':[{'primitives':[{'attributes':{'POSITION':1,'NORMAL':1},'targets':[{'POSITION':1},{}]}]},{"    \
    "'primitives':[{'attributes':{'POSITION':1,'NORMAL':1}}]}],"                                             \
    "'nodes':[{'mesh':0},{'mesh':1},{'mesh':0,'weights':[0,0]},{'mesh':0}],"

/* A model with those objects whose only channel has this pointer; width floats at each of two keys. */
static facet_scene *load_pointer(const char *pointer, size_t width, const char *interpolation)
{
    static const char *const types[] = {"SCALAR", "SCALAR", "VEC2", "VEC3", "VEC4"};
    const float normals[9] = {0, 0, 1, 0, 0, 1, 0, 0, 1};
    const float values[8] = {0, 0, 0, 1, 0, 0, 0, 1};
    test_model m = {0};
    model_add_floats(&m, TIMES, 2, "SCALAR");
    model_add_floats(&m, normals, 3, "VEC3");
    model_add_floats(&m, values, 2, types[width]);
    return model_load(&m,
                      OBJECTS
                      "'animations':[{'samplers':[{'input':0,'output':2,'interpolation':'%s'}],'channels':[{"
                      "'sampler':0,'target':{'path':'pointer','extensions':{'KHR_animation_pointer':{"
                      "'pointer':'%s'}}}}]}],'scenes':[{'nodes':[0]}]",
                      interpolation, pointer);
}

#define MATERIAL(member) SCENE_TARGET_MATERIAL, 0, offsetof(scene_material, member)
#define REF(slot, member)                                                                                    \
    offsetof(scene_material, textures) + (slot) * sizeof(scene_texture_ref) +                                \
        offsetof(scene_texture_ref, member)

static void pointers_resolve_to_their_targets(void **state)
{
    (void)state;
    static const struct {
        const char *pointer;
        size_t width;
        scene_target_kind kind;
        uint32_t index;
        size_t offset;
        float scale;
    } cases[] = {
        {"/nodes/1/translation", 3, SCENE_TARGET_NODE, 1, offsetof(scene_node, translation), 1},
        {"/nodes/1/rotation", 4, SCENE_TARGET_NODE, 1, offsetof(scene_node, rotation), 1},
        {"/nodes/1/scale", 3, SCENE_TARGET_NODE, 1, offsetof(scene_node, scale), 1},
        {"/nodes/0/weights", 2, SCENE_TARGET_WEIGHTS, 0, 0, 1},
        {"/nodes/0/weights/1", 1, SCENE_TARGET_WEIGHTS, 0, 1, 1},
        {"/materials/0/pbrMetallicRoughness/baseColorFactor", 4, MATERIAL(base_color), 1},
        {"/materials/0/pbrMetallicRoughness/roughnessFactor", 1, MATERIAL(perceptual_roughness), 1},
        {"/materials/0/alphaCutoff", 1, MATERIAL(alpha_cutoff), 1},
        {"/materials/0/emissiveFactor", 3, MATERIAL(emissive), 1},
        {"/materials/0/normalTexture/scale", 1, MATERIAL(normal_scale), 1},
        {"/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor", 1, MATERIAL(clearcoat), 1},
        {"/materials/0/extensions/KHR_materials_clearcoat/clearcoatNormalTexture/scale", 1,
         MATERIAL(clearcoat_normal_scale), 1},
        {"/materials/0/extensions/KHR_materials_volume/attenuationColor", 3, MATERIAL(attenuation_color), 1},
        {"/materials/0/normalTexture/extensions/KHR_texture_transform/offset", 2, SCENE_TARGET_MATERIAL, 0,
         REF(SCENE_NORMAL_TEXTURE, offset), 1},
        {"/materials/0/normalTexture/extensions/KHR_texture_transform/rotation", 1, SCENE_TARGET_MATERIAL, 0,
         REF(SCENE_NORMAL_TEXTURE, rotation_rad), 1},
        {"/materials/0/extensions/KHR_materials_clearcoat/clearcoatNormalTexture/extensions/"
         "KHR_texture_transform/scale",
         2, SCENE_TARGET_MATERIAL, 0, REF(SCENE_CLEARCOAT_NORMAL_TEXTURE, scale), 1},
        {"/materials/1/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor", 4,
         SCENE_TARGET_MATERIAL, 1, offsetof(scene_material, base_color), 1},
        {"/materials/1/extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture/extensions/"
         "KHR_texture_transform/offset",
         2, SCENE_TARGET_MATERIAL, 1, REF(SCENE_BASE_COLOR_TEXTURE, offset), 1},
        {"/extensions/KHR_lights_punctual/lights/0/color", 3, SCENE_TARGET_LIGHT, 0,
         offsetof(scene_light, color), 1},
        {"/extensions/KHR_lights_punctual/lights/1/spot/outerConeAngle", 1, SCENE_TARGET_LIGHT, 1,
         offsetof(scene_light, outer_cone_rad), 1},
        {"/cameras/0/perspective/yfov", 1, SCENE_TARGET_CAMERA, 0, offsetof(scene_camera, fov_y_rad), 1},
        {"/cameras/1/orthographic/ymag", 1, SCENE_TARGET_CAMERA, 1, offsetof(scene_camera, ortho_height), 2},
        {"/cameras/1/orthographic/zfar", 1, SCENE_TARGET_CAMERA, 1, offsetof(scene_camera, far_m), 1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        facet_scene *scene = load_pointer(cases[i].pointer, cases[i].width, "LINEAR");
        if (scene->warning_count || scene->animations[0].channel_count != 1)
            fail_msg("%s: %s", cases[i].pointer, scene->warning_count ? scene->warnings[0] : "no channel");
        const scene_channel *c = &scene->animations[0].channels[0];
        assert_int_equal(c->kind, cases[i].kind);
        assert_int_equal(c->index, cases[i].index);
        assert_int_equal(c->offset, cases[i].offset);
        assert_near(c->scale, cases[i].scale, 0);
        assert_int_equal(c->is_rotation, strstr(cases[i].pointer, "nodes/1/rotation") != NULL);
        assert_string_equal(c->pointer, cases[i].pointer);
        scene_destroy(scene);
    }
}

static void pointers_without_a_target_are_reported(void **state)
{
    (void)state;
    static const struct {
        const char *pointer;
        size_t width;
        const char *warning;
    } cases[] = {
        {"/nodes/4/scale", 3, "\"/nodes/4/scale\" names a node that does not exist; it is ignored"},
        {"/nodes/01/scale", 3, "names a node that does not exist"},
        {"/nodes/0", 3, "does not name an animatable property"},
        {"/nodes/0/scale/0", 1, "does not name an animatable property"},
        {"/nodes/0/mesh", 1, "does not name an animatable property"},
        {"/nodes/1/weights", 1, "names weights of a mesh without morph targets"},
        {"/nodes/0/weights/2", 1, "names a weight that does not exist"},
        {"/nodes/1/translation", 4, "has 4 numbers per key, but its target has 3"},
        {"nodes/0/scale", 3, "is not a JSON pointer"},
        {"", 3, "is not a JSON pointer"},
        {"/no~2des/0/scale", 3, "is not a JSON pointer"},
        {"/nodes//0/scale", 3, "names a node that does not exist"},
        {"/", 1, "does not name an animatable property"},
        {"/a/b/c/d/e/f/g/h/i/j/k/l/m/n", 1, "is not a JSON pointer"},
        {"/materials/0/occlusionTexture/strength", 1, "names a texture that the material lacks"},
        {"/materials/0/emissiveTexture/extensions/KHR_texture_transform/offset", 2,
         "names a texture that the material lacks"},
        {"/materials/0/normalTexture/extensions/KHR_texture_transform/texCoord", 1,
         "does not name an animatable property"},
        {"/materials/0/extensions/KHR_materials_sheen/sheenColorFactor", 3,
         "names a property that the material lacks"},
        {"/materials/0/extensions/KHR_materials_ior/ior", 1, "names an index of refraction of 0"},
        {"/materials/1/pbrMetallicRoughness/baseColorFactor", 4, "names a property that the material lacks"},
        {"/materials/0/alphaMode", 1, "does not name an animatable property"},
        {"/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle", 1,
         "names the cone of a light without one"},
        {"/extensions/KHR_lights_punctual/lights/2/color", 3, "names a light that does not exist"},
        {"/cameras/0/orthographic/ymag", 1, "names a lens that the camera lacks"},
        {"/nodes/0/extensions/KHR_node_visibility/visible", 1, "must have interpolation STEP"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        facet_scene *scene = load_pointer(cases[i].pointer, cases[i].width, "LINEAR");
        assert_int_equal(scene->animations[0].channel_count, 0);
        assert_int_equal(scene->warning_count, 1);
        if (!has_warning(scene, cases[i].warning))
            fail_msg("no \"%s\", but \"%s\"", cases[i].warning, scene->warnings[0]);
        scene_destroy(scene);
    }
}

static void booleans_are_step_functions(void **state)
{
    (void)state;
    facet_scene *scene = load_pointer("/nodes/2/extensions/KHR_node_visibility/visible", 1, "STEP");
    const scene_channel *c = &scene->animations[0].channels[0];
    assert_int_equal(scene->warning_count, 0);
    assert_int_equal(c->kind, SCENE_TARGET_VISIBLE);
    assert_int_equal(c->index, 2);
    scene_destroy(scene);
    scene = load_pointer("/nodes/2/extensions/KHR_node~1visibility/visible", 1, "STEP"); /* "KHR_node/vi.." */
    assert_int_equal(scene->animations[0].channel_count, 0);
    scene_destroy(scene);
}

/* A mesh has no pose of its own: its weights apply to each node without weights. */
static void animated_mesh_weights_apply_to_its_nodes(void **state)
{
    (void)state;
    facet_scene *scene = load_pointer("/meshes/0/weights", 2, "LINEAR");
    const scene_animation *a = &scene->animations[0];
    assert_int_equal(a->channel_count, 2);
    assert_int_equal(a->channels[0].index, 0);
    assert_int_equal(a->channels[1].index, 3);
    assert_int_equal(a->channels[1].kind, SCENE_TARGET_WEIGHTS);
    assert_null(a->channels[1].pointer);
    scene_destroy(scene);
    scene = load_pointer("/meshes/0/weights/1", 1, "LINEAR");
    a = &scene->animations[0];
    assert_int_equal(a->channel_count, 2);
    assert_int_equal(a->channels[1].offset, 1);
    assert_string_equal(a->channels[1].pointer, "/nodes/3/weights/1");
    scene_destroy(scene);
}

/* ---- real models ---- */

static void real_models_are_read(void **state)
{
    (void)state;
    facet_scene *scene = load_shared("animation/AnimatedColorsCube.glb");
    assert_int_equal(scene->animation_count, 1);
    assert_int_equal(scene->animations[0].channel_count, 3);
    const scene_channel *c = &scene->animations[0].channels[2];
    assert_int_equal(c->kind, SCENE_TARGET_MATERIAL);
    assert_int_equal(c->offset, offsetof(scene_material, base_color));
    assert_int_equal(scene->animations[0].samplers[c->sampler].width, 4);
    scene_destroy(scene);

    scene = load_shared("animation/Fox.glb");
    static const char *const names[3] = {"Survey", "Walk", "Run"};
    assert_int_equal(scene->animation_count, 3);
    for (int i = 0; i < 3; i++)
        assert_string_equal(scene->animations[i].name, names[i]);
    assert_near(scene->animations[0].end_s, 3.41667, 1e-4);
    scene_destroy(scene);

    scene = load_shared("lights/LightVisibility.glb");
    uint32_t visible = 0;
    for (uint32_t i = 0; i < scene->animations[0].channel_count; i++)
        visible += scene->animations[0].channels[i].kind == SCENE_TARGET_VISIBLE;
    assert_int_equal(visible, 1);
    scene_destroy(scene);

    scene = load_shared("animation/SimpleMorph.glb");
    assert_int_equal(scene->animations[0].channels[0].kind, SCENE_TARGET_WEIGHTS);
    assert_int_equal(scene->animations[0].samplers[0].width, 2);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(core_channels_are_read),
        cmocka_unit_test(cubic_rotations_become_unit),
        cmocka_unit_test(normalised_rotations_become_unit),
        cmocka_unit_test(keys_are_put_in_order),
        cmocka_unit_test(unsupported_targets_are_reported),
        cmocka_unit_test(pointers_resolve_to_their_targets),
        cmocka_unit_test(pointers_without_a_target_are_reported),
        cmocka_unit_test(booleans_are_step_functions),
        cmocka_unit_test(animated_mesh_weights_apply_to_its_nodes),
        cmocka_unit_test(real_models_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
