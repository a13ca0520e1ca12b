/* gl_program_text.c - the GLSL of each program: which parts of the shader library and which files make up
 * each main. */
#include "gl/core/gl_program.h"

#include <string.h>

#include "base/memory.h"
#include "base/result.h"

typedef struct glsl_part {
    const char *name, *text;
} glsl_part;

#include "gl/core/gl_api.h"
#include "gl_text.h"

/* ---- features and mains ---- */

/* clang-format off */
/* Texture slots in the order of scene_texture_slot. */
#define TEXTURE_SLOTS(X) \
    X(BASE_COLOR) X(METALLIC_ROUGHNESS) X(NORMAL) X(OCCLUSION) X(EMISSIVE) X(SPECULAR) X(SPECULAR_COLOR) \
    X(CLEARCOAT) X(CLEARCOAT_ROUGHNESS) X(CLEARCOAT_NORMAL) X(SHEEN_COLOR) X(SHEEN_ROUGHNESS) \
    X(TRANSMISSION) X(THICKNESS) X(IRIDESCENCE) X(IRIDESCENCE_THICKNESS) X(ANISOTROPY) \
    X(DIFFUSE_TRANSMISSION) X(DIFFUSE_TRANSMISSION_COLOR) X(SPECULAR_GLOSSINESS) X(DIFFUSE_ROUGHNESS)

/* Pairs of slots that often share one texture: the second can then read the first one's texel. */
#define TEXTURE_PAIRS(X) \
    X(METALLIC_ROUGHNESS, OCCLUSION) X(SPECULAR_COLOR, SPECULAR) X(CLEARCOAT, CLEARCOAT_ROUGHNESS) \
    X(NORMAL, CLEARCOAT_NORMAL) X(SHEEN_COLOR, SHEEN_ROUGHNESS) X(IRIDESCENCE, IRIDESCENCE_THICKNESS) \
    X(DIFFUSE_TRANSMISSION_COLOR, DIFFUSE_TRANSMISSION)

#define SLOT_NAME(slot) [SCENE_##slot##_TEXTURE] = #slot,
#define TEXTURE_FEATURE(slot) "HAS_" #slot "_TEXTURE",
#define PAIR(first, second) {SCENE_##first##_TEXTURE, SCENE_##second##_TEXTURE},
#define PAIR_FEATURE(first, second) "IS_" #second "_PAIRED",
static const char *const slot_names[] = {TEXTURE_SLOTS(SLOT_NAME)};
const gl_slot_pair gl_slot_pairs[GL_SLOT_PAIR_COUNT] = {TEXTURE_PAIRS(PAIR)};

/* Feature names become #defines; bit 0 first. gl_program.h has those that C sets by number. */
static const char *const surface_features[] = {
    "HAS_TANGENTS", "HAS_ENVIRONMENT", "HAS_LIGHTS", "HAS_SHADOWS",
    TEXTURE_SLOTS(TEXTURE_FEATURE) TEXTURE_PAIRS(PAIR_FEATURE)
    "HAS_CLEARCOAT", "HAS_SHEEN", "HAS_ANISOTROPY", "HAS_IRIDESCENCE", "HAS_TRANSMISSION",
    "HAS_DIFFUSE_TRANSMISSION", "HAS_VOLUME", "HAS_DISPERSION", "HAS_SCATTER", "HAS_DIFFUSE_ROUGHNESS",
    "IS_LIT", "IS_UNLIT", "IS_GLOSSY", "HAS_ALPHA_MASK", "HAS_ALPHA_BLEND", "HAS_COLORS", "IS_VOLUME",
    "HAS_SPECULAR_ANTIALIASING", "HAS_ONE_FOOTPRINT", "IS_SPRITE", "AOVS", "IS_WEIGHTED", "IS_PEELED", "HAS_CHANNEL",
    "HAS_SCHLICK_GGX", "IS_DISPLAYED", "ADDS_1", "ADDS_2", "ADDS_4", "IS_TRACED", "IS_TRACING", NULL};
/* clang-format on */
_Static_assert(sizeof slot_names / sizeof *slot_names == SCENE_TEXTURE_SLOT_COUNT, "every slot has a name");

/* In place of the surface features from GL_SURFACE_TEXTURES on. */
static const char *const phong_features[] = {"HAS_AMBIENT_MAP",  "HAS_DIFFUSE_MAP",   "HAS_SPECULAR_MAP",
                                             "HAS_EMISSION_MAP", "HAS_SHININESS_MAP", "HAS_OPACITY_MAP",
                                             "HAS_NORMAL_MAP",   "IS_SPHERE_MAP",     "IS_AT_VERTICES",
                                             "IS_FLAT",          "IS_SEE_THROUGH"};
static const char *const pyramid_features[] = {"IS_COPY", "IS_DOUBLED", NULL};
static const char *const no_features[] = {NULL};
static const char *const ground_features[] = {"HAS_ENVIRONMENT", "HAS_LIGHTS", "HAS_SHADOWS", NULL};
static const char *const background_features[] = {"HAS_ENVIRONMENT", "IS_BLURRED", NULL};
static const char *const compose_features[] = {"IS_WEIGHTED", "IS_SUM", NULL};
static const char *const sea_features[] = {"HAS_IMAGE",
                                           "IS_LEGACY",
                                           "IS_PAINTED",
                                           "IS_BELOW",
                                           "HAS_BED",
                                           "HAS_FOAM",
                                           "HAS_GLINTS",
                                           "HAS_CUBIC",
                                           "IS_BESIDE",
                                           "HAS_MODEL",
                                           "HAS_OTHER_MICROFACETS",
                                           "AOVS",
                                           NULL};
/* ADDS_N are the bits of the facet_tonemap. */
static const char *const present_features[] = {"IS_TOP_DOWN", "IS_PREMULTIPLIED", "ADDS_1",
                                               "ADDS_2",      "ADDS_4",           NULL};

enum { MAX_SOURCES = 15 };

/* The source of a stage: parts of the shader library with their dependencies, then files of src/gl/shaders and shade/compose, the last
 * of which has main(). */
typedef struct stage_source {
    const char *parts[MAX_SOURCES], *files[MAX_SOURCES];
} stage_source;

/* clang-format off */
#define SCREEN {{"constants"}, {"screen.vert"}}
#define SURFACE {{"constants"}, {"surface.vert"}}

static const struct {
    const char *name;
    const char *const *features;
    stage_source vertex, fragment;
} mains[GL_MAIN_COUNT] = {
    [GL_MAIN_SURFACE] = {"surface", surface_features, SURFACE,
        {{"surface", "light", "layers_direct", "layers_ibl", "layers_lobes", "material", "footprint", "tonemap", "color", "sobol"},
         {"display.glsl", "light_block.glsl", "environment.glsl", "shadow.glsl", "lights.glsl", "surface_io.glsl",
          "material.glsl", "transmission.glsl", "rays.glsl", "radiance.glsl", "surface_tables.h", "surface_radiance.h",
          "glass.glsl", "surface.frag"}}},
    [GL_MAIN_SHADOW] = {"shadow", surface_features, SURFACE,
        {{"material", "footprint"}, {"surface_io.glsl", "material.glsl", "shadow.frag"}}},
    [GL_MAIN_PHONG] = {"phong", surface_features,
        {{"phong", "light", "color", "material"},
         {"light_block.glsl", "lights.glsl", "phong.glsl", "ogl1_light.h", "surface.vert"}},
        {{"phong", "light", "color", "material", "footprint"},
         {"light_block.glsl", "shadow.glsl", "lights.glsl", "surface_io.glsl", "phong.glsl", "ogl1_light.h",
          "phong_fragment.glsl", "ogl1_fragment.h", "phong.frag"}}},
    [GL_MAIN_GROUND_MAP] = {"ground_map", no_features, SCREEN,
        {{"constants"}, {"light_block.glsl", "ground_map.frag"}}},
    [GL_MAIN_GROUND] = {"ground", ground_features, SCREEN,
        {{"ground", "surface", "light", "color"},
         {"light_block.glsl", "environment.glsl", "shadow.glsl", "lights.glsl", "ground.frag"}}},
    [GL_MAIN_BACKGROUND] = {"background", background_features, SCREEN,
        {{"surface"}, {"light_block.glsl", "environment.glsl", "background.frag"}}},
    [GL_MAIN_COMPOSE] = {"compose", compose_features, SCREEN, {{"constants"}, {"compose.frag"}}},
    [GL_MAIN_PRESENT] = {"present", present_features, SCREEN, {{"tonemap", "color"}, {"display.glsl", "present.frag"}}},
    [GL_MAIN_PYRAMID] = {"pyramid", pyramid_features, SCREEN, {{"constants"}, {"pyramid.frag"}}},
    [GL_MAIN_LINEARIZE] = {"linearize", no_features, SCREEN, {{"color"}, {"linearize.frag"}}},
    [GL_MAIN_SEA_GRID] = {"sea_grid", no_features, SCREEN,
        {{"water_place"}, {"sea_block.glsl", "sea_waves.glsl", "sea_grid.frag"}}},
    [GL_MAIN_SEA_SURFACE] = {"sea_surface", no_features,
        {{"water_place"}, {"sea_block.glsl", "sea.vert"}},
        {{"water_place"}, {"sea_block.glsl", "sea_surface.frag"}}},
    [GL_MAIN_SEA_CLASS] = {"sea_class", no_features, SCREEN,
        {{"water_place"}, {"sea_block.glsl", "sea_class.frag"}}},
    [GL_MAIN_SEA] = {"sea", sea_features, SCREEN,
        {{"water_place", "water_crest", "water_facets", "water_caustic", "water_legacy", "glint", "ibl", "surface",
          "sobol"},
         {"sea_block.glsl", "light_block.glsl", "environment.glsl", "sea_waves.glsl", "sea_host.glsl",
          "sea_sky.glsl", "sea_place.glsl", "sea_model.glsl", "sea_radiance.h", "sea.frag"}}},
};
/* clang-format on */

const char *gl_program_main_name(gl_main main)
{
    return mains[main].name;
}

uint32_t gl_program_feature_count(gl_main main)
{
    uint32_t count = 0;
    while (mains[main].features[count])
        count++;
    return count;
}

const char *gl_program_feature_name(gl_main main, uint32_t feature)
{
    const uint32_t own = sizeof phong_features / sizeof *phong_features;
    /* OpenGL 1 has no shadows */
    if (main == GL_MAIN_PHONG && UINT64_C(1) << feature == GL_SURFACE_HAS_SHADOWS)
        return "";
    if (main == GL_MAIN_PHONG && feature >= GL_SURFACE_TEXTURES && feature < GL_SURFACE_IS_LIT)
        return feature - GL_SURFACE_TEXTURES < own ? phong_features[feature - GL_SURFACE_TEXTURES] : "";
    return mains[main].features[feature];
}

uint64_t gl_program_feature(gl_main main, const char *name)
{
    for (uint32_t i = 0; mains[main].features[i]; i++)
        if (strcmp(gl_program_feature_name(main, i), name) == 0)
            return UINT64_C(1) << i;
    return 0;
}

uint64_t gl_program_present_features(const gl_context *context, facet_tonemap tonemap)
{
    return (uint64_t)tonemap << 2 | (uint64_t)context->is_canvas << 1 | gl_context_is_top_down(context);
}

uint64_t gl_program_display_features(facet_tonemap tonemap)
{
    uint64_t is_displayed = gl_program_feature(GL_MAIN_SURFACE, "IS_DISPLAYED");
    return is_displayed | (is_displayed << 1) * (uint64_t)tonemap;
}

/* ---- texture slots ---- */

const uint8_t gl_slots_by_loss[SCENE_TEXTURE_SLOT_COUNT] = {SCENE_THICKNESS_TEXTURE,
                                                            SCENE_IRIDESCENCE_THICKNESS_TEXTURE,
                                                            SCENE_SPECULAR_TEXTURE,
                                                            SCENE_SPECULAR_COLOR_TEXTURE,
                                                            SCENE_DIFFUSE_ROUGHNESS_TEXTURE,
                                                            SCENE_SHEEN_ROUGHNESS_TEXTURE,
                                                            SCENE_CLEARCOAT_ROUGHNESS_TEXTURE,
                                                            SCENE_CLEARCOAT_NORMAL_TEXTURE,
                                                            SCENE_DIFFUSE_TRANSMISSION_COLOR_TEXTURE,
                                                            SCENE_IRIDESCENCE_TEXTURE,
                                                            SCENE_OCCLUSION_TEXTURE,
                                                            SCENE_SHEEN_COLOR_TEXTURE,
                                                            SCENE_CLEARCOAT_TEXTURE,
                                                            SCENE_ANISOTROPY_TEXTURE,
                                                            SCENE_DIFFUSE_TRANSMISSION_TEXTURE,
                                                            SCENE_TRANSMISSION_TEXTURE,
                                                            SCENE_EMISSIVE_TEXTURE,
                                                            SCENE_NORMAL_TEXTURE,
                                                            SCENE_METALLIC_ROUGHNESS_TEXTURE,
                                                            SCENE_SPECULAR_GLOSSINESS_TEXTURE,
                                                            SCENE_BASE_COLOR_TEXTURE};

static bool has(uint64_t features, int bit)
{
    return features >> bit & 1;
}

/* The slot that is sampled for a slot: itself, or the first of its pair. */
static int source_of(uint64_t features, int slot)
{
    for (int i = 0; i < GL_SLOT_PAIR_COUNT; i++)
        if ((int)gl_slot_pairs[i].second == slot && has(features, GL_SURFACE_PAIRS + i))
            return (int)gl_slot_pairs[i].first;
    return slot;
}

int gl_material_slot_units(uint64_t features, int8_t units[SCENE_TEXTURE_SLOT_COUNT])
{
    int count = 0;
    for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++) {
        units[slot] = -1;
        if (has(features, GL_SURFACE_TEXTURES + slot) && source_of(features, slot) == slot)
            units[slot] = (int8_t)count++;
    }
    return count;
}

/* Adds MATERIAL_LAYERS, the samplers u_material0.., EACH_TEXTURE(X), which is X(variable of the texel, sampler, slot) of
 * each of them, and BASE_COLOR_TEXEL and so on: a vec4 per slot, white for absent textures. FIRST_TEXTURE_SLOT, that of
 * u_material0, is defined where all textures have its footprint. */
static void slot_text(uint64_t features, text *out)
{
    int8_t units[SCENE_TEXTURE_SLOT_COUNT];
    int count = gl_material_slot_units(features, units);
    unsigned layers = (unsigned)(features >> GL_SURFACE_LAYERS) & ((1u << GL_SURFACE_LAYER_COUNT) - 1u);
    uint64_t by_layers = gl_program_feature(GL_MAIN_SURFACE, "HAS_CHANNEL") |
                         gl_program_feature(GL_MAIN_SURFACE, "HAS_SCHLICK_GGX");
    if (layers || features & by_layers)
        text_addf(out, "#define HAS_LAYERS\n#define MATERIAL_LAYERS %uu\n", layers);
    for (int i = 0; i < count; i++)
        text_addf(out, "uniform sampler2D u_material%d;\n", i);
    text_add(out, "#define EACH_TEXTURE(X)");
    for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++)
        if (units[slot] >= 0)
            text_addf(out, " X(texel%d, u_material%d, %d)", units[slot], units[slot], slot);
    text_add(out, "\n");
    for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++)
        if (has(features, GL_SURFACE_HAS_ONE_FOOTPRINT) && units[slot] == 0)
            text_addf(out, "#define FIRST_TEXTURE_SLOT %d\n", slot);
    for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++) {
        int source = source_of(features, slot);
        if (!has(features, GL_SURFACE_TEXTURES + slot))
            text_addf(out, "#define %s_TEXEL vec4(1.0)\n", slot_names[slot]);
        else if (source != slot)
            text_addf(out, "#define %s_TEXEL %s_TEXEL\n", slot_names[slot], slot_names[source]);
        else
            text_addf(out, "#define %s_TEXEL texel%d\n", slot_names[slot], units[slot]);
    }
}

/* ---- the text ---- */

static const char *file_text(const char *name)
{
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        if (strcmp(parts[i].name, name) == 0)
            return parts[i].text;
    return "#error there is no such file\n";
}

facet_result gl_program_text(const char *glsl_version, gl_program_key key, uint32_t stage, text *out,
                             facet_error *error)
{
    const stage_source *source =
        stage == GL_VERTEX_SHADER ? &mains[key.main].vertex : &mains[key.main].fragment;
    facet_shader_desc desc = {.allocator = out->allocator, .version = glsl_version, .parts = source->parts};
    while (desc.part_count < MAX_SOURCES && desc.parts[desc.part_count])
        desc.part_count++;
    unsigned char *shared;
    size_t size;
    TRY(facet_shader_text(&desc, &shared, &size, error));
    text_add(out, (const char *)shared);
    mem_free(shared);
    for (uint32_t i = 0; i < gl_program_feature_count(key.main); i++)
        if (key.features >> i & 1 && gl_program_feature_name(key.main, i)[0])
            text_addf(out, "#define %s\n", gl_program_feature_name(key.main, i));
    if (key.main == GL_MAIN_PHONG)
        text_add(out, "#define IS_PHONG\n");
    if ((key.main == GL_MAIN_SURFACE || key.main == GL_MAIN_SHADOW) && stage == GL_FRAGMENT_SHADER)
        slot_text(key.features, out);
    text_add(out, file_text("blocks.glsl"));
    for (int i = 0; i < MAX_SOURCES && source->files[i]; i++)
        text_add(out, file_text(source->files[i]));
    return out->has_failed ? fail_memory(error, "shader", out->length) : FACET_OK;
}
