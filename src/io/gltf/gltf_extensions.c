/* gltf_extensions.c - the table of extensions, and what is reported about those that a file uses. */
#include <string.h>

#include "image/ktx2.h"
#include "io/gltf/gltf_reader.h"

/* Kinds of objects that an extension may extend; or-ed. */
enum {
    ROOT = 1 << 0,
    NODE = 1 << 1,
    MATERIAL = 1 << 2,
    TEXTURE_INFO = 1 << 3, /* anything inside of a material */
    TEXTURE = 1 << 4,
    PRIMITIVE = 1 << 5,
    SCENE = 1 << 6,
    BUFFER = 1 << 7,
    VIEW = 1 << 8,
    TARGET = 1 << 9, /* of a channel of an animation */
    ELSEWHERE = 1 << 10,
    ANYWHERE = (1 << 11) - 1
};

typedef struct known_extension {
    const char *name;
    scene_support support;
    int places;         /* objects where facet reads it; elsewhere it has no meaning */
    const char *effect; /* effect of ignoring it, for the warning; NULL: none, no warning */
    image_codec codec;  /* depends on the build */
} known_extension;

static const known_extension KNOWN[] = {
    {"CESIUM_RTC", SCENE_SUPPORTED, ROOT, NULL, 0},
    {"EXT_lights_image_based", SCENE_SUPPORTED, ROOT | SCENE, NULL, 0},
    {"EXT_mesh_gpu_instancing", SCENE_SUPPORTED, NODE, NULL, 0},
    /* Only groups primitives that may be drawn in one call; they are ordinary ones, and are drawn. */
    {"EXT_mesh_primitive_restart", SCENE_SUPPORTED, ELSEWHERE, NULL, 0},
    {"EXT_meshopt_compression", SCENE_SUPPORTED, BUFFER | VIEW, NULL, 0},
    {"EXT_texture_astc", SCENE_SUPPORTED, TEXTURE, "fallback images are used where the file has them", 0},
    {"EXT_texture_avif", SCENE_SUPPORTED, TEXTURE, "fallback images are used where the file has them",
     IMAGE_CODEC_AVIF},
    {"EXT_texture_webp", SCENE_SUPPORTED, TEXTURE, "fallback images are used where the file has them",
     IMAGE_CODEC_WEBP},
    {"KHR_accessor_float16", SCENE_SUPPORTED, ANYWHERE, NULL, 0},
    {"KHR_accessor_float64", SCENE_SUPPORTED, ANYWHERE, NULL, 0},
    {"KHR_animation_pointer", SCENE_SUPPORTED, TARGET, NULL, 0},
#ifdef HAVE_DRACO
    {"KHR_draco_mesh_compression", SCENE_SUPPORTED, PRIMITIVE, NULL, 0},
#else
    {"KHR_draco_mesh_compression", SCENE_IGNORED, PRIMITIVE,
     "uncompressed data is used where the file has it", 0},
#endif
    {"KHR_lights_punctual", SCENE_SUPPORTED, ROOT | NODE, NULL, 0},
    {"KHR_materials_anisotropy", SCENE_SUPPORTED, MATERIAL, NULL, 0},
    {"KHR_materials_clearcoat", SCENE_SUPPORTED, MATERIAL, NULL, 0},
    {"KHR_materials_diffuse_roughness", SCENE_SUPPORTED, MATERIAL, NULL, 0},
    {"KHR_materials_diffuse_transmission", SCENE_SUPPORTED, MATERIAL, NULL, 0},
    {"KHR_materials_dispersion", SCENE_SUPPORTED, MATERIAL, NULL, 0},
    {"KHR_materials_emissive_strength", SCENE_SUPPORTED, MATERIAL, NULL, 0},
    {"KHR_materials_ior", SCENE_SUPPORTED, MATERIAL, NULL, 0},
    {"KHR_materials_iridescence", SCENE_SUPPORTED, MATERIAL, NULL, 0},
    {"KHR_materials_pbrSpecularGlossiness", SCENE_SUPPORTED, MATERIAL, NULL, 0},
    {"KHR_materials_sheen", SCENE_SUPPORTED, MATERIAL, NULL, 0},
    {"KHR_materials_specular", SCENE_SUPPORTED, MATERIAL, NULL, 0},
    {"KHR_materials_transmission", SCENE_SUPPORTED, MATERIAL, NULL, 0},
    {"KHR_materials_unlit", SCENE_SUPPORTED, MATERIAL, NULL, 0},
    {"KHR_materials_variants", SCENE_SUPPORTED, ROOT | PRIMITIVE, NULL, 0},
    {"KHR_materials_volume", SCENE_SUPPORTED, MATERIAL, NULL, 0},
    {"KHR_materials_volume_scatter", SCENE_SUPPORTED, MATERIAL, NULL, 0},
    {"KHR_mesh_quantization", SCENE_SUPPORTED, ANYWHERE, NULL, 0},
    {"KHR_meshopt_compression", SCENE_SUPPORTED, BUFFER | VIEW, NULL, 0},
    {"KHR_node_visibility", SCENE_SUPPORTED, NODE, NULL, 0},
    {"KHR_texture_basisu", SCENE_SUPPORTED, TEXTURE, NULL, 0},
    {"KHR_texture_transform", SCENE_SUPPORTED, TEXTURE_INFO, NULL, 0},
    {"KHR_xmp", SCENE_SUPPORTED, ANYWHERE, NULL, 0},
    {"KHR_xmp_json_ld", SCENE_SUPPORTED, ANYWHERE, NULL, 0},
    /* Metadata, behavior, sound, and hints for editors that depend on the order of vertices: no effect on
     * images. */
    {"AGI_articulations", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"AGI_stk_metadata", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"EXT_feature_metadata", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"EXT_instance_features", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"EXT_mesh_features", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"EXT_mesh_manifold", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"EXT_property_animation", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"EXT_structural_metadata", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"FB_ngon_encoding", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"KHR_audio_emitter", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"KHR_implicit_shapes", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"KHR_interactivity", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"KHR_node_hoverability", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"KHR_node_selectability", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"KHR_physics_rigid_bodies", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"MSFT_audio_emitter", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"MSFT_lod", SCENE_IGNORED, ANYWHERE, NULL, 0}, /* the finest level is the node itself */
    {"MSFT_packing_normalRoughnessMetallic", SCENE_IGNORED, ANYWHERE, NULL,
     0}, /* for textures that exist twice */
    {"MSFT_packing_occlusionRoughnessMetallic", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"OMI_audio_emitter", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"OMI_collider", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"OMI_physics_body", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"OMI_physics_shape", SCENE_IGNORED, ANYWHERE, NULL, 0},
    {"OMI_spawn_point", SCENE_IGNORED, ANYWHERE, NULL, 0},
    /* Unsupported; docs/gltf-support.md gives the reasons. */
    {"EXT_lights_area", SCENE_IGNORED, ANYWHERE, "its lights are left out", 0},
    {"EXT_materials_bump", SCENE_IGNORED, ANYWHERE, "its heights do not tilt normals", 0},
    {"EXT_mesh_primitive_edge_visibility", SCENE_IGNORED, ANYWHERE, "its edges are left out", 0},
    {"EXT_lights_ies", SCENE_IGNORED, ANYWHERE, "its lights are left out", 0},
    {"MSFT_texture_dds", SCENE_SUPPORTED, TEXTURE, "fallback images are used where the file has them",
     IMAGE_CODEC_DDS},
};

static bool is_built(const known_extension *known)
{
    if (strcmp(known->name, "EXT_texture_astc") == 0)
        return ktx2_is_astc_built();
    return !known->codec || image_codec_is_built(known->codec);
}

static const known_extension *find_known(const char *name)
{
    for (size_t i = 0; i < sizeof KNOWN / sizeof *KNOWN; i++)
        if (strcmp(KNOWN[i].name, name) == 0)
            return &KNOWN[i];
    return NULL;
}

static scene_extension *find_listed(const io_reader *r, const char *name)
{
    for (uint32_t i = 0; i < r->scene->extension_count; i++)
        if (strcmp(r->scene->extensions[i].name, name) == 0)
            return &r->scene->extensions[i];
    return NULL;
}

bool gltf_is_extension_listed(const io_reader *r, const char *name)
{
    return find_listed(r, name) != NULL;
}

/* Adds a name of extensionsUsed or extensionsRequired to the list; NULL: it is not a string, or an error
 * is recorded. */
static scene_extension *list(io_reader *r, const json_place *at)
{
    if (!json_is_string(at->value)) {
        io_warn(r, at, NULL, "must be a string; it is ignored");
        return NULL;
    }
    const char *name = json_string_value(at->value);
    scene_extension *listed = find_listed(r, name);
    if (listed)
        return listed;
    const known_extension *known = find_known(name);
    char *copy = arena_strdup(r->scene->arena, name);
    if (!copy) {
        io_fail_memory(r, "extensions", strlen(name));
        return NULL;
    }
    listed = &r->scene->extensions[r->scene->extension_count++];
    *listed =
        (scene_extension){.name = copy, .support = known && is_built(known) ? known->support : SCENE_IGNORED};
    return listed;
}

/* The kind of object that a member of a parent is. */
static int place_below(int place, const char *key)
{
    static const struct {
        const char *key;
        int place;
    } below_root[] = {{"nodes", NODE},   {"materials", MATERIAL}, {"textures", TEXTURE},
                      {"scenes", SCENE}, {"buffers", BUFFER},     {"bufferViews", VIEW}};
    if (place == MATERIAL || place == TEXTURE_INFO)
        return TEXTURE_INFO;
    /* These names have no other meaning in glTF. */
    if (strcmp(key, "primitives") == 0)
        return PRIMITIVE;
    if (strcmp(key, "target") == 0)
        return TARGET;
    for (size_t i = 0; place == ROOT && i < sizeof below_root / sizeof *below_root; i++)
        if (strcmp(key, below_root[i].key) == 0)
            return below_root[i].place;
    return ELSEWHERE;
}

static void check_extensions_of(io_reader *r, json_t *extensions, int place)
{
    const char *name;
    json_t *extension;
    json_object_foreach(extensions, name, extension)
    {
        const known_extension *known = find_known(name);
        scene_extension *listed = find_listed(r, name);
        if (listed)
            listed->is_present = true;
        else
            (known ? io_note_each : io_warn_each)(r, NULL, NULL,
                                                  "uses %.100s without naming it in extensionsUsed", name);
        if (listed && known && !(known->places & place))
            io_note_each(r, NULL, NULL, "has %.100s in an object that it does not extend", name);
        if (!json_is_object(extension))
            io_note_each(r, NULL, NULL, "has an extension %.100s that is not an object", name);
    }
}

/* Reports, once per name, extension objects below value, an object or array at place, that are not listed
 * or are misplaced. The depth is bounded: glTF's own objects are not nested deeper. */
static void check_objects(io_reader *r, json_t *value, int place, int depth)
{
    size_t index;
    json_t *element;
    const char *key;
    if (depth == 0)
        return;
    if (json_is_array(value)) {
        json_array_foreach(value, index, element) check_objects(r, element, place, depth - 1);
        return;
    }
    json_object_foreach(value, key, element)
    {
        if (strcmp(key, "extensions") == 0)
            check_extensions_of(r, element, place);
        if (strcmp(key, "extras") != 0 && (json_is_object(element) || json_is_array(element)))
            check_objects(r, element, place_below(place, key), depth - 1);
    }
}

/* Reports extensions that the image lacks; an extension that no object uses affects nothing. */
static void warn_ignored(io_reader *r)
{
    for (uint32_t i = 0; i < r->scene->extension_count; i++) {
        const scene_extension *extension = &r->scene->extensions[i];
        const known_extension *known = find_known(extension->name);
        if (!known && !extension->is_present)
            io_note_each(r, NULL, NULL, "lists the extension %.100s, which no object has", extension->name);
        else if (!known)
            io_warn_each(r, NULL, NULL, "uses the extension %.100s, which facet does not support",
                         extension->name);
        else if (extension->is_present && extension->support == SCENE_IGNORED && known->effect)
            io_warn_each(r, NULL, NULL, "uses %s, which is not drawn: %s", extension->name, known->effect);
    }
}

void gltf_read_extensions(io_reader *r, const json_place *root)
{
    json_place used = io_get_array(r, root, "extensionsUsed");
    io_leave_out(r, "extensions of objects are read all the same");
    json_place required = io_get_array(r, root, "extensionsRequired");
    io_leave_out(r, "none is required");
    size_t most = io_get_count(&used) + io_get_count(&required);
    enum { MAX_EXTENSIONS = 1000 }; /* lookups are linear */
    if (most > MAX_EXTENSIONS) {
        io_fail(r, &used, NULL, FACET_ERROR_LIMIT, "lists more than %d extensions", (int)MAX_EXTENSIONS);
        return;
    }
    r->scene->extensions = io_alloc(r, "extensions", most, sizeof *r->scene->extensions);
    for (size_t i = 0; i < io_get_count(&used) && io_is_ok(r); i++) {
        json_place at = io_get_element(&used, i);
        uint32_t before = r->scene->extension_count;
        scene_extension *extension = list(r, &at);
        if (extension && r->scene->extension_count == before)
            io_note(r, &at, NULL, "\"%.100s\" is listed twice", extension->name);
    }
    for (size_t i = 0; i < io_get_count(&required) && io_is_ok(r); i++) {
        json_place at = io_get_element(&required, i);
        uint32_t before = r->scene->extension_count;
        scene_extension *extension = list(r, &at);
        if (!extension)
            continue;
        if (r->scene->extension_count != before)
            io_note(r, &at, NULL, "\"%.100s\" is not in extensionsUsed", extension->name);
        else if (extension->is_required)
            io_note(r, &at, NULL, "\"%.100s\" is listed twice", extension->name);
        extension->is_required = true;
        const known_extension *known = find_known(extension->name);
        if (!known || !is_built(known) || (known->support == SCENE_IGNORED && known->effect))
            io_fail(r, NULL, NULL, FACET_ERROR_UNSUPPORTED,
                    "requires the extension %.100s, which facet does not support", extension->name);
    }
    scene_extension *quantization = find_listed(r, "KHR_mesh_quantization");
    r->gltf->has_quantization = quantization != NULL;
    if (quantization && !quantization->is_required)
        io_note(r, NULL, NULL, "uses KHR_mesh_quantization, which must be among extensionsRequired");
    if (io_is_ok(r)) {
        check_objects(r, (json_t *)(uintptr_t)root->value, ROOT, 12);
        warn_ignored(r);
    }
}
