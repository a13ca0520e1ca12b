/* gltf_extras.c - metadata, kept as JSON text so that readers of the scene need no JSON parser: extras of
 * any object, and XMP packets (KHR_xmp_json_ld and its predecessor KHR_xmp). The member
 * extras.facet_legacy becomes the scene's OpenGL 1 materials (scene/legacy_extras.h writes it).
 *
 * The old values of a material count while its factors equal those of the member "pbr" to 1e-6 and its
 * images exist: otherwise an editor has changed the material, and the glTF material is the truth. Other
 * programs may own a member of that name, so that unexpected content is ignored without a message. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/gltf/gltf_reader.h"
#include "scene/legacy_extras.h"

static const char *const METADATA[] = {"KHR_xmp_json_ld", "KHR_xmp"};

/* ---- text ---- */

/* 15 digits where they read back as the same value, so that 0.1 stays 0.1; otherwise 17. */
static size_t choose_format(const json_t *value)
{
    const size_t plain = JSON_COMPACT | JSON_ENCODE_ANY;
    const size_t exact = plain | JSON_REAL_PRECISION(17);
    char *string = json_dumps(value, plain | JSON_REAL_PRECISION(15));
    json_t *back = string ? json_loads(string, JSON_DECODE_ANY | JSON_ALLOW_NUL, NULL) : NULL;
    bool is_same = back && json_equal(value, back);
    json_decref(back);
    free(string);
    return is_same ? plain | JSON_REAL_PRECISION(15) : exact;
}

/* A value as JSON text in the scene's arena, members in the order of the file; NULL: an error is recorded. */
static const char *keep_text(io_reader *r, const json_t *value)
{
    size_t format = choose_format(value);
    size_t size = json_dumpb(value, NULL, 0, format);
    char *string = io_alloc_raw(r, "metadata", size + 1, 1);
    if (!string)
        return NULL;
    if (size == 0 || json_dumpb(value, string, size, format) != size) { /* jansson ran out of memory */
        io_fail_memory(r, "metadata", size);
        return NULL;
    }
    string[size] = 0;
    return string;
}

/* ---- objects ---- */

/* Other objects refer to a packet of the root by index; a wrong index does not affect images. */
static void check_packet(io_reader *r, const json_place *extension)
{
    const json_place root = {.value = r->json};
    json_place packets = io_get_extension(r, &root, extension->key);
    json_place list = io_get_array(r, &packets, "packets");
    const json_t *packet = json_object_get(extension->value, "packet");
    json_int_t index = json_is_integer(packet) ? json_integer_value(packet) : -1;
    if (packet && (index < 0 || (uint64_t)index >= io_get_count(&list)))
        io_note(r, extension, "packet", "is not the index of a packet");
}

scene_meta gltf_get_meta(io_reader *r, const json_place *object)
{
    scene_meta out = {0};
    if (!io_is_ok(r) || !object->value)
        return out;
    const json_t *extras = json_object_get(object->value, "extras");
    if (extras)
        out.extras = keep_text(r, extras);
    json_t *kept = NULL;
    for (size_t i = 0; i < sizeof METADATA / sizeof *METADATA && io_is_ok(r); i++) {
        json_place at = io_get_extension(r, object, METADATA[i]);
        if (!at.value)
            continue;
        check_packet(r, &at);
        kept = kept ? kept : json_object();
        if (!kept || json_object_set(kept, METADATA[i], (json_t *)(uintptr_t)at.value) != 0)
            io_fail_memory(r, "metadata", 0);
    }
    if (kept && io_is_ok(r))
        out.extensions = keep_text(r, kept);
    json_decref(kept);
    return out;
}

void gltf_read_meta(io_reader *r, const json_place *root)
{
    facet_scene *scene = r->scene;
    json_place asset = io_get_object(r, root, "asset");
    json_place images = io_get_array(r, root, "images");
    json_place textures = io_get_array(r, root, "textures");
    scene->meta = gltf_get_meta(r, root);
    scene->asset_meta = gltf_get_meta(r, &asset);
    for (uint32_t i = 0; i < scene->image_count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &images, i);
        scene->images[i].meta = gltf_get_meta(r, &at);
    }
    for (uint32_t i = 0; i < scene->texture_count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &textures, i);
        scene->textures[i].meta = gltf_get_meta(r, &at);
    }
}

/* ---- facet_legacy ---- */

static const char MEMBER[] = "facet_legacy";

/* ---- values ---- */

/* Reads count numbers in range; one number may stand without an array. False: out is unchanged. */
static bool get_numbers(const json_t *value, float *out, size_t count, float minimum, float maximum)
{
    double numbers[3];
    size_t given = json_is_array(value) ? json_array_size(value) : 1;
    if (given != count || count > 3)
        return false;
    for (size_t i = 0; i < count; i++) {
        const json_t *number = json_is_array(value) ? json_array_get(value, i) : value;
        numbers[i] = json_is_number(number) ? json_number_value(number) : (double)NAN;
        if (!(numbers[i] >= (double)minimum && numbers[i] <= (double)maximum))
            return false;
    }
    for (size_t i = 0; i < count; i++)
        out[i] = (float)numbers[i];
    return true;
}

static void get_flag(const json_t *value, bool *out)
{
    if (json_is_boolean(value))
        *out = json_is_true(value);
}

/* The index of a name; fallback where it is unknown. */
static int get_choice(const json_t *value, const char *const *names, int fallback)
{
    for (int i = 0; json_is_string(value) && names[i]; i++)
        if (strcmp(json_string_value(value), names[i]) == 0)
            return i;
    return fallback;
}

static const char *get_text(io_reader *r, const json_t *value)
{
    if (!json_is_string(value) || !io_is_ok(r))
        return NULL;
    const char *copy = arena_strdup(r->scene->arena, json_string_value(value));
    if (!copy)
        io_fail_memory(r, "extras", json_string_length(value));
    return copy;
}

/* ---- materials ---- */

static void get_ref(const io_reader *r, const json_t *object, legacy_map *map)
{
    scene_texture_ref *ref = &map->ref;
    const json_t *texture = json_object_get(object, "texture");
    const json_t *set = json_object_get(object, "texCoord");
    json_int_t index = json_is_integer(texture) ? json_integer_value(texture) : -1;
    if (index >= 0 && (uint64_t)index < r->scene->texture_count)
        ref->texture = (uint32_t)index;
    get_flag(json_object_get(object, "left_out"), &map->is_left_out);
    map->is_left_out |= index >= 0 && ref->texture == SCENE_NONE;
    if (json_is_integer(set) && json_integer_value(set) >= 0 && json_integer_value(set) < SCENE_NONE)
        ref->texcoord = (uint32_t)json_integer_value(set);
    const float most = LEGACY_LARGEST;
    get_numbers(json_object_get(object, "offset"), ref->offset, 2, -most, most);
    get_numbers(json_object_get(object, "scale"), ref->scale, 2, -most, most);
    get_numbers(json_object_get(object, "rotation"), &ref->rotation_rad, 1, -most, most);
    scene_texture_ref_update(ref);
}

static void get_map(io_reader *r, const json_t *object, legacy_map *map)
{
    const json_t *channel = json_object_get(object, "imfchan");
    const float most = LEGACY_LARGEST;
    if (!json_is_object(object))
        return;
    get_ref(r, object, map);
    map->path = get_text(r, json_object_get(object, "path"));
    map->options = get_text(r, json_object_get(object, "options"));
    map->dropped = get_text(r, json_object_get(object, "dropped"));
    get_numbers(json_object_get(object, "base"), &map->base, 1, -most, most);
    get_numbers(json_object_get(object, "gain"), &map->gain, 1, -most, most);
    get_numbers(json_object_get(object, "bm"), &map->bump_multiplier, 1, -most, most);
    if (json_is_string(channel) && json_string_length(channel) == 1 &&
        strchr("rgbmlz", *json_string_value(channel)))
        map->channel = *json_string_value(channel);
}

static void get_material(io_reader *r, const json_t *object, legacy_material *m)
{
    const json_t *illum = json_object_get(object, "illum");
    for (int i = 0; i < LEGACY_PARAMETER_COUNT; i++) {
        const legacy_parameter *row = &legacy_parameters[i];
        if (get_numbers(json_object_get(object, row->key), legacy_floats(m, row), row->count, row->minimum,
                        row->maximum))
            m->fields |= row->field;
    }
    if (json_is_integer(illum) && json_integer_value(illum) >= 0 && json_integer_value(illum) <= 10) {
        m->illum = (int)json_integer_value(illum);
        m->fields |= LEGACY_ILLUM;
    }
    for (int i = 0; i < LEGACY_FLAG_COUNT; i++)
        get_flag(json_object_get(object, legacy_flags[i].key), (bool *)((char *)m + legacy_flags[i].offset));
    m->texture_type = (legacy_texture_type)get_choice(json_object_get(object, "texture_type"),
                                                      legacy_texture_type_names, LEGACY_RGB);
    m->texture_mode = (legacy_texture_mode)get_choice(json_object_get(object, "texture_mode"),
                                                      legacy_texture_mode_names, LEGACY_MODULATE);
    for (int i = 0; i < LEGACY_MAP_COUNT; i++)
        get_map(r, json_object_get(object, legacy_map_keys[i]), &m->maps[i]);
    m->unknown = get_text(r, json_object_get(object, "unknown"));
}

/* Whether a material equals the result of the conversion. */
static bool is_unchanged(const json_t *pbr, const scene_material *m)
{
    if (!json_is_object(pbr))
        return false;
    for (int i = 0; i < LEGACY_PBR_FACTOR_COUNT; i++) {
        const legacy_pbr_factor *factor = &legacy_pbr_factors[i];
        float now[3];
        float then[3];
        legacy_pbr_factor_get(m, i, now);
        if (!get_numbers(json_object_get(pbr, factor->key), then, factor->count, -HUGE_VALF, HUGE_VALF))
            return false;
        for (uint32_t k = 0; k < factor->count; k++)
            if (!(fabsf(now[k] - then[k]) <= 1e-6f * fmaxf(fabsf(now[k]), fabsf(then[k]))))
                return false;
    }
    return true;
}

/* ---- the scene ---- */

static void get_light(const json_t *object, legacy_light *light)
{
    const float most = SCENE_FARTHEST;
    *light = legacy_light_default();
    get_flag(json_object_get(object, "point"), &light->is_point);
    get_flag(json_object_get(object, "viewpoint_relative"), &light->is_viewpoint_relative);
    get_numbers(json_object_get(object, "position"), light->position, 3, -most, most);
    get_numbers(json_object_get(object, "ambient"), light->ambient, 3, 0, LEGACY_LARGEST);
    get_numbers(json_object_get(object, "diffuse"), light->diffuse, 3, 0, LEGACY_LARGEST);
    get_numbers(json_object_get(object, "specular"), light->specular, 3, 0, LEGACY_LARGEST);
}

static void get_lights(io_reader *r, const json_t *array, scene_legacy *legacy)
{
    size_t count = json_array_size(array);
    if (count == 0 || count >= SCENE_NONE)
        return;
    legacy->lights = io_alloc(r, "lights", count, sizeof *legacy->lights);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        get_light(json_array_get(array, i), &legacy->lights[i]);
        legacy->light_count = (uint32_t)(i + 1);
    }
}

static void get_scene(io_reader *r, const json_t *object, scene_legacy *legacy)
{
    const json_t *fog = json_object_get(object, "fog");
    get_lights(r, json_object_get(object, "lights"), legacy);
    legacy->fog.mode =
        (legacy_fog_mode)get_choice(json_object_get(fog, "mode"), legacy_fog_names, LEGACY_FOG_NONE);
    get_numbers(json_object_get(fog, "color"), legacy->fog.color, 3, 0, LEGACY_LARGEST);
    get_numbers(json_object_get(fog, "scale"), &legacy->fog.scale, 1, 0, LEGACY_LARGEST);
    legacy->colors = (facet_legacy_colors)get_choice(json_object_get(object, "colors"), legacy_color_names,
                                                     FACET_LEGACY_COLORS_SRGB);
    if (legacy->colors == FACET_LEGACY_COLORS_DEFAULT)
        legacy->colors = FACET_LEGACY_COLORS_SRGB;
    legacy->dialect = (facet_mtl_dialect)get_choice(json_object_get(object, "dialect"), legacy_dialect_names,
                                                    FACET_MTL_DIALECT_SPEC);
    if (legacy->dialect == FACET_MTL_DIALECT_AUTO)
        legacy->dialect = FACET_MTL_DIALECT_SPEC;
    get_flag(json_object_get(object, "rgl"), &legacy->is_rgl);
}

/* The member of an object's extras; NULL: none. */
static const json_t *find_member(const json_t *object)
{
    const json_t *member = json_object_get(json_object_get(object, "extras"), MEMBER);
    return json_is_object(member) ? member : NULL;
}

void gltf_read_legacy_extras(io_reader *r, const json_place *root)
{
    facet_scene *scene = r->scene;
    const json_t *materials = json_object_get(root->value, "materials");
    const json_t *whole = find_member(root->value);
    bool has_any = json_object_get(whole, "lights") || json_object_get(whole, "fog");
    for (uint32_t i = 0; i < scene->material_count && !has_any; i++) {
        const json_t *member = find_member(json_array_get(materials, i));
        has_any = member && is_unchanged(json_object_get(member, "pbr"), &scene->materials[i]);
    }
    if (!has_any)
        return;
    scene_legacy *legacy = io_alloc(r, "legacy materials", 1, sizeof *legacy);
    if (!legacy)
        return;
    legacy->fog.scale = 1.0f;
    legacy->materials = io_alloc(r, "legacy materials", scene->material_count, sizeof *legacy->materials);
    get_scene(r, whole, legacy);
    for (uint32_t i = 0; i < scene->material_count && io_is_ok(r); i++) {
        const json_t *member = find_member(json_array_get(materials, i));
        legacy->materials[i] = legacy_material_default();
        legacy->materials[i].name = scene->materials[i].name;
        if (!member || !is_unchanged(json_object_get(member, "pbr"), &scene->materials[i]))
            continue;
        legacy_material known = legacy->materials[i];
        get_material(r, member, &known);
        if (!legacy_lacks_images(&known))
            legacy->materials[i] = known;
    }
    if (io_is_ok(r))
        scene->legacy = legacy;
}
