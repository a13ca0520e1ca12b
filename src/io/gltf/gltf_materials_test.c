/* gltf_materials_test.c - materials, their extensions, textures and samplers. */
#include "io/gltf/gltf_test_support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* A PNG of one white texel. */
#define PNG                                                                                                  \
    "'data:image/png;base64,"                                                                                \
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMIQAAAABJRU5ErkJggg=='"
#define TEXTURES "'images':[{'uri':" PNG "}],'textures':[{'source':0},{'source':0}],"

static void an_empty_material_has_the_defaults(void **state)
{
    (void)state;
    facet_scene *scene = load("'materials':[{}]", NULL);
    const scene_material expected = scene_material_default();
    const scene_material *m = &scene->materials[0];
    assert_floats(m->base_color, expected.base_color, 4, 0);
    assert_near(m->metallic, 1, 0);
    assert_near(m->perceptual_roughness, 1, 0);
    assert_near(m->normal_scale, 1, 0);
    assert_near(m->occlusion_strength, 1, 0);
    assert_near(m->alpha_cutoff, 0.5, 0);
    assert_near(m->ior, 1.5, 0);
    assert_near(m->specular, 1, 0);
    assert_floats(m->specular_color, expected.specular_color, 3, 0);
    assert_floats(m->emissive, expected.emissive, 3, 0);
    assert_int_equal(m->alpha_mode, SCENE_ALPHA_OPAQUE);
    assert_false(m->is_double_sided || m->extensions);
    assert_int_equal(m->textures[SCENE_BASE_COLOR_TEXTURE].texture, SCENE_NONE);
    assert_int_equal(m->textures[SCENE_SPECULAR_COLOR_TEXTURE].texture, SCENE_NONE);
    const scene_material *none = scene_get_material(scene, SCENE_NONE);
    assert_near(none->metallic, 1, 0);
    assert_ptr_equal(scene_get_material(scene, 0), m);
    scene_destroy(scene);
}

static void all_members_are_read(void **state)
{
    (void)state;
    facet_scene *scene = load(
        TEXTURES "'materials':[{'name':'n','pbrMetallicRoughness':{'baseColorFactor':[0.1,0.2,0.3,0.4],'"
                 "metallicFactor':0.5,"
                 "'roughnessFactor':0.6,'baseColorTexture':{'index':1,'texCoord':2},'"
                 "metallicRoughnessTexture':{'index':0}},"
                 "'normalTexture':{'index':1,'scale':-2},'occlusionTexture':{'index':0,'strength':0.25},'"
                 "emissiveFactor':[0.5,0,1],"
                 "'emissiveTexture':{'index':1},'alphaMode':'MASK','alphaCutoff':0.75,'doubleSided':true}]",
        NULL);
    const scene_material *m = &scene->materials[0];
    const float base_color[4] = {0.1f, 0.2f, 0.3f, 0.4f};
    const float emissive[3] = {0.5f, 0, 1};
    assert_string_equal(m->name, "n");
    assert_floats(m->base_color, base_color, 4, 0);
    assert_near(m->metallic, 0.5, 0);
    assert_near(m->perceptual_roughness, 0.6f, 0);
    assert_int_equal(m->textures[SCENE_BASE_COLOR_TEXTURE].texture, 1);
    assert_int_equal(m->textures[SCENE_BASE_COLOR_TEXTURE].texcoord, 2);
    assert_false(m->textures[SCENE_BASE_COLOR_TEXTURE].has_transform);
    assert_int_equal(m->textures[SCENE_METALLIC_ROUGHNESS_TEXTURE].texture, 0);
    assert_int_equal(m->textures[SCENE_NORMAL_TEXTURE].texture, 1);
    assert_near(m->normal_scale, -2, 0);
    assert_int_equal(m->textures[SCENE_OCCLUSION_TEXTURE].texture, 0);
    assert_near(m->occlusion_strength, 0.25, 0);
    assert_floats(m->emissive, emissive, 3, 0);
    assert_int_equal(m->alpha_mode, SCENE_ALPHA_MASK);
    assert_near(m->alpha_cutoff, 0.75, 0);
    assert_true(m->is_double_sided);
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
}

/* Every parameter and texture of every extension, with a compatible one. */
static void extensions_are_read(void **state)
{
    (void)state;
    facet_scene *scene = load(
        TEXTURES
        "'extensionsUsed':['KHR_materials_emissive_strength','KHR_materials_ior','KHR_materials_specular',"
        "'KHR_materials_clearcoat','KHR_materials_sheen','KHR_materials_transmission','KHR_materials_volume',"
        "'KHR_materials_iridescence','KHR_materials_anisotropy','KHR_materials_dispersion',"
        "'KHR_materials_diffuse_transmission','KHR_materials_volume_scatter',"
        "'KHR_materials_diffuse_roughness'],"
        "'materials':[{'emissiveFactor':[1,0.5,0],'extensions':{"
        "'KHR_materials_emissive_strength':{'emissiveStrength':8},'KHR_materials_ior':{'ior':1.25},"
        "'KHR_materials_specular':{'specularFactor':0.25,'specularColorFactor':[1,2,3],"
        "'specularTexture':{'index':1},'specularColorTexture':{'index':0}},"
        "'KHR_materials_clearcoat':{'clearcoatFactor':0.5,'clearcoatTexture':{'index':1},"
        "'clearcoatRoughnessFactor':0.125,'clearcoatRoughnessTexture':{'index':0,'texCoord':3},"
        "'clearcoatNormalTexture':{'index':1,'scale':-0.5}},"
        "'KHR_materials_sheen':{'sheenColorFactor':[0.25,0.5,0.75],'sheenColorTexture':{'index':0},"
        "'sheenRoughnessFactor':0.75,'sheenRoughnessTexture':{'index':1}},"
        "'KHR_materials_transmission':{'transmissionFactor':0.5,'transmissionTexture':{'index':0}},"
        "'KHR_materials_volume':{'thicknessFactor':2,'thicknessTexture':{'index':1},"
        "'attenuationDistance':0.5,'attenuationColor':[0.5,0.25,1]},"
        "'KHR_materials_iridescence':{'iridescenceFactor':0.25,'iridescenceTexture':{'index':0},"
        "'iridescenceIor':1.75,'iridescenceThicknessMinimum':500,'iridescenceThicknessMaximum':200,"
        "'iridescenceThicknessTexture':{'index':1}},"
        "'KHR_materials_anisotropy':{'anisotropyStrength':0.5,'anisotropyRotation':-1.5,"
        "'anisotropyTexture':{'index':0}},"
        "'KHR_materials_dispersion':{'dispersion':4},"
        "'KHR_materials_diffuse_transmission':{'diffuseTransmissionFactor':0.5,"
        "'diffuseTransmissionTexture':{'index':1},'diffuseTransmissionColorFactor':[0.5,1,0],"
        "'diffuseTransmissionColorTexture':{'index':0}},"
        "'KHR_materials_volume_scatter':{'multiscatterColor':[1,0.5,0.25],'scatterAnisotropy':-0.5},"
        "'KHR_materials_diffuse_roughness':{'diffuseRoughnessFactor':0.625,"
        "'diffuseRoughnessTexture':{'index':1}}}}]",
        NULL);
    const scene_material *m = &scene->materials[0];
    const float emissive[3] = {1, 0.5f, 0};
    const float specular_color[3] = {1, 2, 3};
    const float sheen_color[3] = {0.25f, 0.5f, 0.75f};
    const float attenuation_color[3] = {0.5f, 0.25f, 1};
    const float diffuse_transmission_color[3] = {0.5f, 1, 0};
    const float multiscatter_color[3] = {1, 0.5f, 0.25f};
    const uint32_t apart = SCENE_UNLIT | SCENE_SPECULAR_GLOSSINESS;
    assert_int_equal(m->extensions, ((1 << 15) - 1) & ~(int)apart);
    assert_floats(m->emissive, emissive, 3, 0);
    assert_near(m->emissive_strength, 8, 0);
    assert_near(m->ior, 1.25, 0);
    assert_near(m->specular, 0.25, 0);
    assert_floats(m->specular_color, specular_color, 3, 0);
    assert_near(m->clearcoat, 0.5, 0);
    assert_near(m->clearcoat_roughness, 0.125, 0);
    assert_near(m->clearcoat_normal_scale, -0.5, 0);
    assert_floats(m->sheen_color, sheen_color, 3, 0);
    assert_near(m->sheen_roughness, 0.75, 0);
    assert_near(m->transmission, 0.5, 0);
    assert_near(m->thickness, 2, 0);
    assert_near(m->attenuation_distance, 0.5, 0);
    assert_floats(m->attenuation_color, attenuation_color, 3, 0);
    assert_near(m->iridescence, 0.25, 0);
    assert_near(m->iridescence_ior, 1.75, 0);
    assert_near(m->iridescence_thickness_minimum, 500, 0); /* may be the larger one */
    assert_near(m->iridescence_thickness_maximum, 200, 0);
    assert_near(m->anisotropy, 0.5, 0);
    assert_near(m->anisotropy_rotation, -1.5, 0);
    assert_near(m->dispersion, 4, 0);
    assert_near(m->diffuse_transmission, 0.5, 0);
    assert_floats(m->diffuse_transmission_color, diffuse_transmission_color, 3, 0);
    assert_floats(m->multiscatter_color, multiscatter_color, 3, 0);
    assert_near(m->diffuse_roughness, 0.625, 0);
    assert_near(m->scatter_anisotropy, -0.5, 0);
    static const struct {
        scene_texture_slot slot;
        uint32_t texture;
    } textures[] = {
        {SCENE_SPECULAR_TEXTURE, 1},
        {SCENE_SPECULAR_COLOR_TEXTURE, 0},
        {SCENE_CLEARCOAT_TEXTURE, 1},
        {SCENE_CLEARCOAT_ROUGHNESS_TEXTURE, 0},
        {SCENE_CLEARCOAT_NORMAL_TEXTURE, 1},
        {SCENE_SHEEN_COLOR_TEXTURE, 0},
        {SCENE_SHEEN_ROUGHNESS_TEXTURE, 1},
        {SCENE_TRANSMISSION_TEXTURE, 0},
        {SCENE_THICKNESS_TEXTURE, 1},
        {SCENE_IRIDESCENCE_TEXTURE, 0},
        {SCENE_IRIDESCENCE_THICKNESS_TEXTURE, 1},
        {SCENE_ANISOTROPY_TEXTURE, 0},
        {SCENE_DIFFUSE_TRANSMISSION_TEXTURE, 1},
        {SCENE_DIFFUSE_TRANSMISSION_COLOR_TEXTURE, 0},
    };
    for (size_t i = 0; i < sizeof textures / sizeof *textures; i++)
        assert_int_equal(m->textures[textures[i].slot].texture, textures[i].texture);
    assert_int_equal(m->textures[SCENE_CLEARCOAT_ROUGHNESS_TEXTURE].texcoord, 3);
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
}

/* An empty extension object sets the extension's bit and the defaults of the specification. */
static void empty_extensions_have_their_defaults(void **state)
{
    (void)state;
    facet_scene *scene =
        load("'extensionsUsed':['KHR_materials_volume','KHR_materials_iridescence','KHR_materials_ior'],"
             "'materials':[{'extensions':{'KHR_materials_volume':{},'KHR_materials_iridescence':{},"
             "'KHR_materials_ior':{}}}]",
             NULL);
    const scene_material *m = &scene->materials[0];
    const float white[3] = {1, 1, 1};
    assert_int_equal(m->extensions, SCENE_VOLUME | SCENE_IRIDESCENCE | SCENE_IOR);
    assert_true(m->attenuation_distance == INFINITY);
    assert_floats(m->attenuation_color, white, 3, 0);
    assert_near(m->iridescence_ior, 1.3f, 0);
    assert_near(m->iridescence_thickness_minimum, 100, 0);
    assert_near(m->iridescence_thickness_maximum, 400, 0);
    assert_near(m->ior, 1.5, 0);
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
}

/* The extension replaces metallic-roughness completely. */
static void specular_glossiness_takes_the_place_of_the_fallback(void **state)
{
    (void)state;
    facet_scene *scene = load(
        TEXTURES "'extensionsUsed':['KHR_materials_pbrSpecularGlossiness'],'materials':[{"
                 "'pbrMetallicRoughness':{'baseColorFactor':[0,0,0,0],'metallicFactor':0,'roughnessFactor':0,"
                 "'baseColorTexture':{'index':1},'metallicRoughnessTexture':{'index':1}},'extensions':{"
                 "'KHR_materials_pbrSpecularGlossiness':{'diffuseFactor':[0.5,0.25,1,0.75],"
                 "'specularFactor':[0.25,0.5,0.75],'glossinessFactor':0.5,'diffuseTexture':{'index':0},"
                 "'specularGlossinessTexture':{'index':1,'texCoord':1}}}},{'pbrMetallicRoughness':{"
                 "'baseColorFactor':[0,0,0,0],'baseColorTexture':{'index':1}},"
                 "'extensions':{'KHR_materials_pbrSpecularGlossiness':{}}}]",
        NULL);
    const scene_material *m = &scene->materials[0];
    const float diffuse[4] = {0.5f, 0.25f, 1, 0.75f};
    const float specular[3] = {0.25f, 0.5f, 0.75f};
    const float white[4] = {1, 1, 1, 1};
    assert_int_equal(m->extensions, SCENE_SPECULAR_GLOSSINESS);
    assert_floats(m->base_color, diffuse, 4, 0);
    assert_floats(m->specular_color, specular, 3, 0);
    assert_near(m->glossiness, 0.5, 0);
    assert_int_equal(m->textures[SCENE_BASE_COLOR_TEXTURE].texture, 0);
    assert_int_equal(m->textures[SCENE_METALLIC_ROUGHNESS_TEXTURE].texture, SCENE_NONE);
    assert_int_equal(m->textures[SCENE_SPECULAR_GLOSSINESS_TEXTURE].texture, 1);
    assert_floats(scene->materials[1].base_color, white, 4, 0);
    assert_near(scene->materials[1].glossiness, 1, 0);
    assert_int_equal(scene->materials[1].textures[SCENE_BASE_COLOR_TEXTURE].texture, SCENE_NONE);
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
}

static void extensions_that_exclude_others_win(void **state)
{
    (void)state;
    facet_scene *scene =
        load("'extensionsUsed':['KHR_materials_unlit','KHR_materials_pbrSpecularGlossiness',"
             "'KHR_materials_emissive_strength','KHR_materials_specular'],'materials':[{"
             "'pbrMetallicRoughness':{'baseColorFactor':[0.5,0.5,0.5,1]},'extensions':{"
             "'KHR_materials_unlit':{},'KHR_materials_pbrSpecularGlossiness':{'diffuseFactor':[1,0,0,1]}}},"
             "{'extensions':{'KHR_materials_pbrSpecularGlossiness':{'specularFactor':[0.5,0.5,0.5]},"
             "'KHR_materials_emissive_strength':{'emissiveStrength':2},"
             "'KHR_materials_specular':{'specularColorFactor':[1,0,0]}}}]",
             NULL);
    const scene_material *m = scene->materials;
    assert_int_equal(m[0].extensions, SCENE_UNLIT);
    assert_near(m[0].base_color[1], 0.5, 0);
    assert_int_equal(m[1].extensions, SCENE_SPECULAR_GLOSSINESS | SCENE_EMISSIVE_STRENGTH);
    assert_near(m[1].specular_color[1], 0.5, 0);
    assert_true(has_note(scene, "materials[0]: has KHR_materials_unlit, which excludes "
                                "KHR_materials_pbrSpecularGlossiness; the latter is ignored"));
    assert_true(has_note(scene, "(2 times in all)"));
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
}

static void extension_parameters_have_their_ranges(void **state)
{
    (void)state;
    facet_scene *scene =
        load("'extensionsUsed':['KHR_materials_ior','KHR_materials_volume','KHR_materials_volume_scatter',"
             "'KHR_materials_iridescence'],'materials':[{'extensions':{'KHR_materials_ior':{'ior':0},"
             "'KHR_materials_volume':{'attenuationDistance':0,'thicknessFactor':-1},"
             "'KHR_materials_volume_scatter':{'scatterAnisotropy':-1},"
             "'KHR_materials_iridescence':{'iridescenceIor':0.5}}}]",
             NULL);
    const scene_material *m = &scene->materials[0];
    assert_near(m->ior, 0, 0);
    assert_true(m->attenuation_distance == INFINITY);
    assert_near(m->thickness, 0, 0);
    assert_true(m->scatter_anisotropy > -1 && m->scatter_anisotropy < -0.99f);
    assert_near(m->iridescence_ior, 1, 0);
    assert_true(has_warning(scene, "attenuationDistance: must be above 0; it is taken as infinite"));
    assert_true(has_warning(scene, "scatterAnisotropy: must be between -1 and 1"));
    assert_true(has_warning(scene, "thicknessFactor: -1 is out of range; 0 is used (2 times in all)"));
    assert_int_equal(scene->warning_count, 3);
    scene_destroy(scene);
}

/* The worked example of the extension: offset (0, 1), a quarter turn, scale 0.5 select the lower left
 * quadrant. */
static void texture_transforms_match_the_specification_example(void **state)
{
    (void)state;
    facet_scene *scene = load(
        TEXTURES
        "'extensionsUsed':['KHR_texture_transform'],'materials':[{'normalTexture':{'index':0,'texCoord':3,"
        "'extensions':{'KHR_texture_transform':{'offset':[0,1],'rotation':1.57079632679,'scale':[0.5,0.5],"
        "'texCoord':1}}}}]",
        NULL);
    const scene_texture_ref *ref = &scene->materials[0].textures[SCENE_NORMAL_TEXTURE];
    static const float cases[4][4] = {{0, 0, 0, 1}, {1, 0, 0, 0.5f}, {0, 1, 0.5f, 1}, {1, 1, 0.5f, 0.5f}};
    assert_true(ref->has_transform);
    assert_int_equal(ref->texcoord, 1);
    for (int i = 0; i < 4; i++) {
        const float *t = ref->transform;
        float u = cases[i][0];
        float v = cases[i][1];
        assert_near(t[0] * u + t[1] * v + t[2], cases[i][2], 1e-6);
        assert_near(t[3] * u + t[4] * v + t[5], cases[i][3], 1e-6);
    }
    scene_destroy(scene);
}

static void identity_transforms_are_ignored(void **state)
{
    (void)state;
    facet_scene *scene =
        load(TEXTURES "'extensionsUsed':['KHR_texture_transform'],'materials':[{'normalTexture':{'index':0,"
                      "'extensions':{'KHR_texture_transform':{}}}}]",
             NULL);
    assert_false(scene->materials[0].textures[SCENE_NORMAL_TEXTURE].has_transform);
    scene_destroy(scene);
}

static void values_out_of_range_are_clamped_with_a_warning(void **state)
{
    (void)state;
    facet_scene *scene =
        load("'extensionsUsed':['KHR_materials_ior'],'materials':[{'pbrMetallicRoughness':{"
             "'baseColorFactor':[2,0,0,-1],'metallicFactor':-3},'alphaMode':'SHINY','emissiveFactor':[5,0,"
             "0],'extensions':{'KHR_materials_ior':{'ior':0.5}}}]",
             NULL);
    const scene_material *m = &scene->materials[0];
    assert_near(m->base_color[0], 1, 0);
    assert_near(m->base_color[3], 0, 0);
    assert_near(m->metallic, 0, 0);
    assert_near(m->ior, 1, 0);
    assert_near(m->emissive[0], 5, 0); /* viewers draw it */
    assert_int_equal(m->alpha_mode, SCENE_ALPHA_OPAQUE);
    assert_true(has_warning(scene, "baseColorFactor[0]: 2 is out of range; 1 is used (3 times in all)"));
    assert_true(has_warning(scene, "\"SHINY\" is not one of OPAQUE, MASK, BLEND"));
    assert_int_equal(scene->warning_count, 3);
    assert_true(has_note(scene, "emissiveFactor: is above 1"));
    scene_destroy(scene);
}

static void wrong_members_are_refused_where_they_are_used(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"'materials':[{'normalTexture':{'index':0}}]", "normalTexture.index: texture 0 does not exist"},
        {"'materials':[{'normalTexture':{}}]", "materials[0].normalTexture.index: is missing"},
        {"'materials':[{'pbrMetallicRoughness':{'baseColorFactor':[1,1,1]}}]",
         "must have 4 numbers, but has 3"},
        {"'materials':[{'pbrMetallicRoughness':{'metallicFactor':'1'}}]",
         "must be a number, but is a string"},
        {"'materials':[{'doubleSided':1}]", "doubleSided: must be a boolean, but is a number"},
        {"'materials':[3]", "materials[0]: must be an object, but is a number"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_left_out(cases[i][0], NULL, cases[i][1]);
        assert_refused(cases[i][0], NULL, FACET_ERROR_INVALID, cases[i][1]);
    }
    assert_refused("'materials':{}", NULL, FACET_ERROR_INVALID,
                   "materials: must be an array, but is an object");
    assert_left_out("'textures':[{'sampler':0}]", NULL,
                    "textures[0].sampler: sampler 0 does not exist (there are 0); the texture has the "
                    "default sampler");
    assert_left_out("'textures':[{'source':0}]", NULL,
                    "textures[0].source: image 0 does not exist (there are 0); white is used");
    assert_left_out("'images':[{'bufferView':0}]", NULL,
                    "images[0].bufferView: buffer view 0 does not exist (there are 0); white is used");
}

static void samplers_are_translated(void **state)
{
    (void)state;
    facet_scene *scene =
        load("'images':[{'uri':" PNG
             "}],'samplers':[{},{'wrapS':33071,'wrapT':33648,'magFilter':9728,'minFilter':9728},"
             "{'minFilter':9729},{'minFilter':9984},{'minFilter':9985},{'minFilter':9986},{'minFilter':9987,'"
             "magFilter':9729}],"
             "'textures':[{'source':0},{'source':0,'sampler':0},{'source':0,'sampler':1},{'source':0,'"
             "sampler':2},{'source':0,"
             "'sampler':3},{'source':0,'sampler':4},{'source':0,'sampler':5},{'source':0,'sampler':6}]",
             NULL);
    static const struct {
        scene_filter min;
        scene_mip_filter mip;
    } expected[8] = {{SCENE_FILTER_LINEAR, SCENE_MIP_LINEAR},   {SCENE_FILTER_LINEAR, SCENE_MIP_LINEAR},
                     {SCENE_FILTER_NEAREST, SCENE_MIP_NONE},    {SCENE_FILTER_LINEAR, SCENE_MIP_NONE},
                     {SCENE_FILTER_NEAREST, SCENE_MIP_NEAREST}, {SCENE_FILTER_LINEAR, SCENE_MIP_NEAREST},
                     {SCENE_FILTER_NEAREST, SCENE_MIP_LINEAR},  {SCENE_FILTER_LINEAR, SCENE_MIP_LINEAR}};
    for (int i = 0; i < 8; i++) {
        assert_int_equal(scene->textures[i].min_filter, expected[i].min);
        assert_int_equal(scene->textures[i].mip_filter, expected[i].mip);
        assert_int_equal(scene->textures[i].mag_filter, i == 2 ? SCENE_FILTER_NEAREST : SCENE_FILTER_LINEAR);
        assert_int_equal(scene->textures[i].wrap_u, i == 2 ? SCENE_WRAP_CLAMP : SCENE_WRAP_REPEAT);
        assert_int_equal(scene->textures[i].wrap_v, i == 2 ? SCENE_WRAP_MIRROR : SCENE_WRAP_REPEAT);
        assert_int_equal(scene->textures[i].image, 0);
    }
    scene_destroy(scene);
}

static void images_are_found_and_probed(void **state)
{
    (void)state;
    facet_scene *scene = load("'images':[{'name':'white','mimeType':'image/jpeg','uri':" PNG "}]", NULL);
    const scene_image *image = &scene->images[0];
    assert_string_equal(image->name, "white");
    assert_string_equal(image->mime_type, "image/png"); /* by content */
    assert_int_equal(image->width, 1);
    assert_int_equal(image->height, 1);
    assert_int_equal(image->size, 70);
    assert_true(has_note(scene, "says \"image/jpeg\", but the image is image/png"));
    scene_destroy(scene);
}

static void unreadable_images_are_white(void **state)
{
    (void)state;
    facet_scene *scene =
        load("'extensionsUsed':['KHR_texture_basisu'],'images':[{'uri':'missing.png'},{'uri':'data:;base64,"
             "AAAA'},{},{'uri':"
             "'data:image/ktx2;base64,q0tUWCAyMLsNChoK'},{'uri':" PNG
             "}],'textures':[{'source':0},{'source':1},{'source':2},{"
             "'source':3},{},{'extensions':{'KHR_texture_basisu':{'source':3}},'source':4},{'extensions':{"
             "'KHR_texture_basisu':{'source':3}}}]",
             NULL);
    for (int i = 0; i < 7; i++)
        assert_int_equal(scene->textures[i].image, i == 5 ? 4 : SCENE_NONE);
    assert_null(scene->images[0].bytes);
    assert_true(has_warning(scene, "images[0].uri: \"missing.png\" cannot be found"));
    assert_true(has_warning(scene, "images[1]: is no PNG, JPEG, WebP, "));
    assert_true(has_warning(scene, "images[2]: has neither a uri nor a bufferView; white is used"));
    assert_true(has_warning(scene, "images[3]: the image: KTX2: the file ends in its header"));
    assert_true(has_warning(scene, "textures[4]: has no source"));
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_empty_material_has_the_defaults),
        cmocka_unit_test(all_members_are_read),
        cmocka_unit_test(extensions_are_read),
        cmocka_unit_test(empty_extensions_have_their_defaults),
        cmocka_unit_test(specular_glossiness_takes_the_place_of_the_fallback),
        cmocka_unit_test(extensions_that_exclude_others_win),
        cmocka_unit_test(extension_parameters_have_their_ranges),
        cmocka_unit_test(texture_transforms_match_the_specification_example),
        cmocka_unit_test(identity_transforms_are_ignored),
        cmocka_unit_test(values_out_of_range_are_clamped_with_a_warning),
        cmocka_unit_test(wrong_members_are_refused_where_they_are_used),
        cmocka_unit_test(samplers_are_translated),
        cmocka_unit_test(images_are_found_and_probed),
        cmocka_unit_test(unreadable_images_are_white),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
