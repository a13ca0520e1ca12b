/* ogl1_json.c - a JSON document of rgl's parameters: its detection, its members one after the other, and
 * the scene that shows it, with one ball per material in a grid with the aspect of an image. */
#include "io/ogl1/ogl1_json.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/result.h"
#include "io/ogl1/ogl1_parameters.h"
#include "io/ogl1/ogl1_reader.h"
#include "scene/sphere.h"

enum { MAX_MATERIALS = 16384, VERSION = 1 };

/* ---- telling it apart, without parsing ---- */

static const unsigned char *skip_space(const unsigned char *at, const unsigned char *end)
{
    while (at < end && (*at == ' ' || *at == '\t' || *at == '\r' || *at == '\n'))
        at++;
    return at;
}

/* The position behind the string that begins at at with its quote; end if it is not closed. */
static const unsigned char *skip_string(const unsigned char *at, const unsigned char *end)
{
    for (at++; at < end && *at != '"'; at++)
        at += *at == '\\';
    return at < end ? at + 1 : end;
}

/* The comma or bracket that ends the value at at. */
static const unsigned char *skip_value(const unsigned char *at, const unsigned char *end)
{
    size_t depth = 0;
    while (at < end) {
        if (*at == '"') {
            at = skip_string(at, end);
            continue;
        }
        if (depth == 0 && (*at == ',' || *at == '}' || *at == ']'))
            return at;
        depth += *at == '{' || *at == '[';
        depth -= *at == '}' || *at == ']';
        at++;
    }
    return end;
}

static bool is_key(const unsigned char *at, const unsigned char *end, const char *key)
{
    size_t length = strlen(key);
    return (size_t)(end - at) >= length + 2 && memcmp(at + 1, key, length) == 0 && at[length + 1] == '"';
}

bool ogl1_json_detect(const void *bytes, size_t size)
{
    static const char *const gltf[] = {"asset",   "meshes",      "nodes", "accessors",
                                       "buffers", "bufferViews", "scenes"};
    const unsigned char *at = bytes;
    const unsigned char *end = at + size;
    bool is_ours = false;
    if (size >= 3 && memcmp(at, "\xef\xbb\xbf", 3) == 0)
        at += 3;
    at = skip_space(at, end);
    if (at == end || *at != '{')
        return false;
    at = skip_space(at + 1, end);
    while (at < end && *at == '"') {
        for (size_t i = 0; i < sizeof gltf / sizeof *gltf; i++)
            if (is_key(at, end, gltf[i]))
                return false;
        is_ours |= is_key(at, end, "materials") || is_key(at, end, "material3d") ||
                   is_key(at, end, "shininess") || is_key(at, end, "facet");
        at = skip_space(skip_string(at, end), end);
        if (at < end && *at == ':')
            at = skip_value(at + 1, end);
        if (at < end && *at == ',')
            at = skip_space(at + 1, end);
    }
    return is_ours;
}

/* ---- reading ---- */

static json_t *parse(io_reader *r, const char *bytes, size_t size)
{
    size_t mark = size >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    json_t *json = io_parse_json(r, bytes + mark, size - mark);
    if (json && !json_is_object(json))
        io_fail(r, NULL, NULL, FACET_ERROR_INVALID,
                "must be a JSON object with \"materials\" or \"material3d\"");
    return json;
}

static bool is_material(const json_t *object)
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)object, key, value)
    {
        if (ogl1_is_parameter(key) && (!json_is_object(value) || json_object_size(value) == 0))
            return true;
    }
    return false;
}

static void read_header(ogl1_document *d, const json_place *root)
{
    static const char *const spaces[] = {"srgb", "linear", NULL};
    io_reader *r = &d->r;
    const char *kind = "ogl1";
    const char *generator = "";
    double version = VERSION;
    int space = -1;
    ogl1_string(r, root, "facet", &kind);
    ogl1_number(r, root, "version", &version);
    ogl1_string(r, root, "generator", &generator);
    ogl1_choice(r, root, "colors", spaces, &space);
    d->colors = space < 0    ? FACET_LEGACY_COLORS_DEFAULT
                : space == 0 ? FACET_LEGACY_COLORS_SRGB
                             : FACET_LEGACY_COLORS_LINEAR;
    if (strcmp(kind, "ogl1") != 0)
        io_fail(r, root, "facet", FACET_ERROR_UNSUPPORTED, "\"%.40s\" is not \"ogl1\"", kind);
    if (version != VERSION)
        io_fail(r, root, "version", FACET_ERROR_UNSUPPORTED, "%g is not supported; only version %d is",
                version, VERSION);
    d->generator = arena_strdup(r->scene->arena, generator);
    if (!d->generator)
        io_fail_memory(r, "generator", strlen(generator));
}

/* toJSON() of a bare material3d(): the root itself is the material. */
static bool is_bare(const json_place *root)
{
    return !io_has_member(root, "materials") && !io_has_member(root, "material3d") &&
           is_material(root->value);
}

/* "materials", then "material3d". */
static void read_entries(ogl1_document *d, const json_place *root)
{
    io_reader *r = &d->r;
    json_place at;
    ogl1_list list = ogl1_list_begin(r, root, "materials", is_material);
    json_place bare = is_bare(root) ? *root : ogl1_object(r, root, "material3d");
    if (list.count > MAX_MATERIALS)
        io_fail(r, &list.at, NULL, FACET_ERROR_LIMIT, "has %zu materials, more than %d", list.count,
                MAX_MATERIALS);
    d->entries = io_alloc(r, "materials", list.count + 1, sizeof *d->entries);
    while (ogl1_list_next(r, &list, &at)) {
        ogl1_entry *entry = &d->entries[d->entry_count++];
        ogl1_read_material(r, &at, entry);
        if (!entry->name && at.key && at.key[0] && !list.is_single) { /* of a named list */
            entry->name = arena_strdup(r->scene->arena, at.key);
            if (!entry->name)
                io_fail_memory(r, "name", strlen(at.key));
        }
    }
    if (bare.value && io_is_ok(r))
        ogl1_read_material(r, &bare, &d->entries[d->entry_count++]);
}

static void report_unknown(io_reader *r, const json_place *root)
{
    static const char *const known[] = {"facet",      "version", "generator",  "colors", "materials",
                                        "material3d", "lights",  "background", "fog"};
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)root->value, key, value)
    {
        bool is_known = false;
        for (size_t i = 0; i < sizeof known / sizeof *known; i++)
            is_known |= strcmp(key, known[i]) == 0;
        if (!is_known)
            io_warn(r, NULL, NULL, "\"%.60s\" has no meaning here; it is dropped", key);
    }
}

static void read_root(ogl1_document *d, const json_place *root)
{
    io_reader *r = &d->r;
    read_header(d, root);
    read_entries(d, root);
    if (is_bare(root)) /* its "fog" is a switch */
        return;
    if (io_is_ok(r))
        ogl1_read_lights(d, root);
    if (io_is_ok(r))
        ogl1_read_fog(d, root);
    if (io_is_ok(r))
        report_unknown(r, root);
}

void ogl1_document_read(ogl1_document *d, facet_scene *scene, const char *bytes, size_t size,
                        const char *folder, const facet_scene_desc *desc, facet_error *error)
{
    *d = (ogl1_document){.r = {.scene = scene,
                               .allocator = &desc->allocator,
                               .log = &desc->log,
                               .error = error,
                               .max_file_bytes = file_limit(desc->max_file_bytes),
                               .files = &desc->files,
                               .folder = folder,
                               .root = desc->root},
                         .generator = ""};
    size_t estimate = io_json_memory_estimate(bytes, size);
    void *reserve = mem_alloc(&desc->allocator, estimate, 1);
    if (!reserve) {
        io_fail_memory(&d->r, "JSON", estimate);
        return;
    }
    json_t *json = parse(&d->r, bytes, size);
    const json_place root = {.value = json};
    if (io_is_ok(&d->r))
        read_root(d, &root);
    json_decref(json);
    mem_free(reserve);
}

/* ---- balls ---- */

enum { SEGMENTS = 64, RINGS = 32 };
static const float SPACING = 2.5f; /* m, of balls of radius 1 */

/* The entry's name, or that of its first object, or a number. */
static const char *name_of(io_reader *r, const ogl1_entry *entry, uint32_t number)
{
    char name[32];
    if (entry->name)
        return entry->name;
    if (entry->object_count)
        return entry->objects[0];
    snprintf(name, sizeof name, "material %u", number + 1);
    const char *copy = arena_strdup(r->scene->arena, name);
    if (!copy)
        io_fail_memory(r, "name", sizeof name);
    return copy ? copy : "";
}

/* Sets mesh and node i, in row-major order from the top left. */
static void place(io_reader *r, const scene_primitive *sphere, uint32_t i, uint32_t columns, uint32_t rows)
{
    facet_scene *scene = r->scene;
    scene_primitive *own = io_alloc(r, "primitive", 1, sizeof *own);
    if (!own)
        return;
    *own = *sphere;
    own->material = i;
    const char *name = scene->materials[i].name;
    scene->meshes[i] = (scene_mesh){.name = name, .primitive_count = 1, .primitives = own};
    scene_node *node = &scene->nodes[i];
    *node = scene_node_default(name);
    node->translation[0] = (double)(SPACING * ((float)(i % columns) - 0.5f * (float)(columns - 1)));
    node->translation[1] = (double)(SPACING * (0.5f * (float)(rows - 1) - (float)(i / columns)));
    node->mesh = i;
}

static void make_materials(ogl1_document *d)
{
    facet_scene *scene = d->r.scene;
    for (uint32_t i = 0; i < d->entry_count && io_is_ok(&d->r); i++) {
        scene->materials[i] = scene_material_default();
        scene->legacy->materials[i] = d->entries[i].material;
        scene->materials[i].name = scene->legacy->materials[i].name = name_of(&d->r, &d->entries[i], i);
    }
}

/* Fills the scene with one ball per entry. */
static void make_balls(ogl1_document *d)
{
    io_reader *r = &d->r;
    facet_scene *scene = r->scene;
    uint32_t count = d->entry_count;
    uint32_t columns = (uint32_t)ceil(sqrt((double)count * 4.0 / 3.0)); /* the aspect of common images */
    uint32_t rows = (count + columns - 1) / columns;
    scene_primitive sphere;
    scene->materials = io_alloc(r, "materials", count, sizeof *scene->materials);
    scene->meshes = io_alloc(r, "meshes", count, sizeof *scene->meshes);
    scene->nodes = io_alloc(r, "nodes", count, sizeof *scene->nodes);
    scene->scenes = io_alloc(r, "scenes", 1, sizeof *scene->scenes);
    scene->legacy = io_alloc(r, "materials", 1, sizeof *scene->legacy);
    legacy_material *materials = io_alloc(r, "materials", count, sizeof *materials);
    uint32_t *roots = io_alloc(r, "nodes", count, sizeof *roots);
    if (!io_is_ok(r))
        return;
    if (!scene_make_sphere(scene->arena, SEGMENTS, RINGS, &sphere)) {
        io_fail_memory(r, "sphere", 0);
        return;
    }
    scene->legacy->materials = materials;
    scene->legacy->is_rgl = true;
    make_materials(d);
    for (uint32_t i = 0; i < count && io_is_ok(r); i++) {
        place(r, &sphere, i, columns, rows);
        roots[i] = i;
    }
    scene->scenes[0] =
        (scene_root){.name = "materials", .node_count = count, .nodes = roots, .image_light = SCENE_NONE};
    scene->scene_count = 1;
    scene->default_scene = 0;
    scene->material_count = scene->mesh_count = scene->node_count = count;
}

/* ---- files ---- */

void ogl1_set_lights_and_fog(const ogl1_document *d, const facet_legacy_desc *desc)
{
    scene_legacy *legacy = d->r.scene->legacy;
    facet_legacy_colors stated = desc->colors ? desc->colors : d->colors;
    if (d->has_lights) {
        legacy->light_count = d->light_count;
        legacy->lights = d->lights;
    }
    if (d->has_fog)
        legacy->fog = d->fog;
    if (stated || !legacy->colors)
        legacy->colors = stated ? stated : FACET_LEGACY_COLORS_SRGB;
    if (!legacy->dialect)
        legacy->dialect = FACET_MTL_DIALECT_SPEC;
    legacy->is_source = true;
}

static void read_scene(ogl1_document *d, const facet_scene_desc *desc)
{
    io_reader *r = &d->r;
    if (io_is_ok(r) && d->entry_count == 0)
        io_fail(r, NULL, NULL, FACET_ERROR_INVALID,
                "has neither \"materials\" nor \"material3d\", so there is nothing to show");
    if (io_is_ok(r))
        ogl1_find_textures(d);
    if (io_is_ok(r))
        make_balls(d);
    if (!io_is_ok(r))
        return;
    r->scene->generator = d->generator;
    r->scene->legacy->fog.scale = 1.0f;
    ogl1_set_lights_and_fog(d, &desc->legacy);
}

static facet_result load(const char *bytes, size_t size, const char *source, const char *folder,
                         const facet_scene_desc *desc, facet_scene **out, facet_error *error)
{
    facet_scene *scene = NULL;
    ogl1_document d;
    TRY(scene_create(&desc->allocator, source, &scene, error));
    scene->max_texture_size = desc->max_texture_size;
    scene->thread_count = desc->thread_count;
    ogl1_document_read(&d, scene, bytes, size, folder, desc, error);
    read_scene(&d, desc);
    if (d.r.result != FACET_OK) {
        scene_destroy(scene);
        return d.r.result;
    }
    *out = scene;
    return FACET_OK;
}

facet_result ogl1_json_load(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                            facet_error *error)
{
    const facet_scene_desc defaults = {0};
    return io_load_file(load, path, desc ? desc : &defaults, scene, error);
}

facet_result ogl1_json_load_memory(const void *bytes, size_t size, const char *name,
                                   const facet_scene_desc *desc, facet_scene **scene, facet_error *error)
{
    const facet_scene_desc defaults = {0};
    desc = desc ? desc : &defaults;
    *scene = NULL;
    TRY(io_check_size(size, name, desc, error));
    return load(bytes, size, name, NULL, desc, scene, error);
}
