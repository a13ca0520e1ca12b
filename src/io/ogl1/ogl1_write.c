/* ogl1_write.c - scene->legacy as JSON text, one line per material, in the names of material3d(),
 * light3d() and bg3d(); and the document with the images that it names as files, all or nothing. */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/result.h"
#include "io/file_set.h"
#include "io/image_kind.h"
#include "io/ogl1/ogl1_json.h"
#include "io/ogl1/ogl1_parameters.h"
#include "scene/legacy.h"

/* ---- objects that name their material ---- */

/* An object with a single material. */
typedef struct ogl1_object {
    const char *name;
    uint32_t material, node;
} ogl1_object;

/* The single material of a node's mesh; SCENE_NONE: several or none, or the node has descendants, which
 * would get it, too. */
static uint32_t material_of(const facet_scene *scene, const scene_node *node)
{
    const scene_mesh *mesh = &scene->meshes[node->mesh];
    uint32_t material = mesh->primitive_count ? mesh->primitives[0].material : SCENE_NONE;
    for (uint32_t i = 1; i < mesh->primitive_count; i++)
        if (mesh->primitives[i].material != material)
            return SCENE_NONE;
    return node->child_count ? SCENE_NONE : material;
}

static int by_name(const void *a, const void *b)
{
    const ogl1_object *x = a;
    const ogl1_object *y = b;
    int order = strcmp(x->name, y->name);
    return order ? order : (x->node > y->node) - (x->node < y->node);
}

static int by_material(const void *a, const void *b)
{
    const ogl1_object *x = a;
    const ogl1_object *y = b;
    if (x->material != y->material)
        return x->material < y->material ? -1 : 1;
    return (x->node > y->node) - (x->node < y->node);
}

/* Removes from objects sorted by name all but one of each name, and all of a name that differ in material. */
static size_t keep_clear(ogl1_object *objects, size_t count)
{
    size_t kept = 0;
    for (size_t i = 0; i < count;) {
        size_t end = i + 1;
        bool is_clear = objects[i].material != SCENE_NONE;
        for (; end < count && strcmp(objects[i].name, objects[end].name) == 0; end++)
            is_clear &= objects[end].material == objects[i].material;
        if (is_clear)
            objects[kept++] = objects[i];
        i = end;
    }
    return kept;
}

/* The objects whose name identifies their material: leaf nodes with a name that no object of another
 * material has; for unnamed nodes, their meshes. Sorted by material, then node. *out is one block of
 * mem_alloc(). False: no memory. */
static bool create_objects(const facet_scene *scene, const facet_allocator *allocator, ogl1_object **out,
                           size_t *count)
{
    ogl1_object *objects = mem_alloc(allocator, scene->node_count, sizeof *objects);
    size_t n = 0;
    if (!objects)
        return false;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const scene_node *node = &scene->nodes[i];
        if (node->mesh == SCENE_NONE)
            continue;
        const char *name = node->name[0] ? node->name : scene->meshes[node->mesh].name;
        if (name[0])
            objects[n++] = (ogl1_object){.name = name, .material = material_of(scene, node), .node = i};
    }
    qsort(objects, n, sizeof *objects, by_name);
    n = keep_clear(objects, n);
    qsort(objects, n, sizeof *objects, by_material);
    *out = objects;
    *count = n;
    return true;
}

/* ---- lights and fog ---- */

/* Begins a new line before the next value. */
static void write_line(text *out)
{
    text_add(out, out->needs_comma ? ",\n" : "\n");
    out->needs_comma = false;
}

/* "#rrggbb" if the color has 8 bits, otherwise three numbers; key as for text_json_string(). */
static void write_color(text *out, const char *key, const float rgb[3])
{
    int bytes[3];
    bool has_8_bits = true;
    for (int k = 0; k < 3; k++) {
        float scaled = rgb[k] >= 0.0f && rgb[k] <= 1.0f ? rgb[k] * 255.0f : -1.0f;
        bytes[k] = (int)lrintf(scaled);
        has_8_bits &= bytes[k] >= 0 && (float)bytes[k] / 255.0f == rgb[k];
    }
    if (has_8_bits) {
        char hex[8];
        snprintf(hex, sizeof hex, "#%02X%02X%02X", (unsigned)bytes[0] & 255, (unsigned)bytes[1] & 255,
                 (unsigned)bytes[2] & 255);
        text_json_string(out, key, hex);
    } else {
        text_json_floats(out, key, rgb, 3);
    }
}

/* Degrees in the fewest digits that reproduce the direction to the bit; false: 9 digits are not enough. */
static bool find_angles(const float direction[3], char theta[32], char phi[32])
{
    const double to_rad = 3.14159265358979323846 / 180.0;
    double y = fmin(fmax((double)direction[1], -1.0), 1.0);
    double exact_theta = atan2((double)direction[0], (double)direction[2]) / to_rad;
    double exact_phi = atan2(y, hypot((double)direction[0], (double)direction[2])) / to_rad;
    for (int digits = 1; digits <= 9; digits++) {
        float back[3];
        snprintf(theta, 32, "%.*g", digits, exact_theta);
        snprintf(phi, 32, "%.*g", digits, exact_phi);
        legacy_light_direction((float)(strtod(theta, NULL) * to_rad), (float)(strtod(phi, NULL) * to_rad),
                               back);
        if (memcmp(back, direction, sizeof back) == 0)
            return true;
    }
    return false;
}

static void write_light(const legacy_light *light, text *out)
{
    static const char *const axes[3] = {"x", "y", "z"};
    char theta[32];
    char phi[32];
    write_line(out);
    text_json_begin_object(out, NULL);
    if (light->is_point) {
        for (int k = 0; k < 3; k++)
            text_json_float(out, axes[k], light->position[k]);
    } else {
        bool is_exact = find_angles(light->position, theta, phi);
        text_json_raw(out, "theta", theta);
        text_json_raw(out, "phi", phi);
        if (!is_exact) /* unknown to rgl; facet prefers it to the angles */
            text_json_floats(out, "direction", light->position, 3);
    }
    text_json_bool(out, "viewpoint.rel", light->is_viewpoint_relative);
    write_color(out, "ambient", light->ambient);
    write_color(out, "diffuse", light->diffuse);
    write_color(out, "specular", light->specular);
    text_json_end_object(out);
}

/* The members "lights" and "background". */
static void write_lights(const scene_legacy *legacy, text *out)
{
    static const char *const types[] = {"none", "linear", "exp", "exp2"};
    const legacy_fog *fog = &legacy->fog;
    if (legacy->light_count) {
        write_line(out);
        text_json_begin_array(out, "lights");
        for (uint32_t i = 0; i < legacy->light_count; i++)
            write_light(&legacy->lights[i], out);
        text_json_end_array(out);
    }
    if (fog->mode != LEGACY_FOG_NONE || fog->color[0] != 0.0f || fog->color[1] != 0.0f ||
        fog->color[2] != 0.0f) {
        write_line(out);
        text_json_begin_object(out, "background");
        text_json_string(out, "fogtype", types[fog->mode]);
        text_json_float(out, "fogScale", fog->scale);
        write_color(out, "color", fog->color);
        text_json_end_object(out);
    }
}

/* ---- a material ---- */

static void write_table(const legacy_material *m, text *out)
{
    write_color(out, "color", m->diffuse);
    text_json_float(out, "alpha", m->opacity);
    for (int i = 0; i < OGL1_PARAMETER_COUNT; i++) {
        const void *member = (const char *)m + OGL1_PARAMETERS[i].offset;
        if (OGL1_PARAMETERS[i].kind == OGL1_COLOR)
            write_color(out, OGL1_PARAMETERS[i].name, member);
        else if (OGL1_PARAMETERS[i].kind == OGL1_NUMBER)
            text_json_float(out, OGL1_PARAMETERS[i].name, *(const float *)member);
        else
            text_json_bool(out, OGL1_PARAMETERS[i].name, *(const bool *)member);
    }
}

static const char *min_filter_name(const scene_texture *t)
{
    for (int i = 0; i < OGL1_MIN_FILTER_COUNT; i++)
        if (OGL1_MIN_FILTERS[i].filter == t->min_filter && OGL1_MIN_FILTERS[i].mip_filter == t->mip_filter)
            return OGL1_MIN_FILTERS[i].name;
    return OGL1_MIN_FILTERS[0].name;
}

/* The image file that is written, or the path that was read. */
static const char *texture_path(const facet_scene *scene, const legacy_map *map,
                                const char *const *image_names)
{
    uint32_t index = map->ref.texture != SCENE_NONE ? scene->textures[map->ref.texture].image : SCENE_NONE;
    const char *written = index != SCENE_NONE && image_names ? image_names[index] : NULL;
    return written ? written : map->path;
}

static void write_texture(const facet_scene *scene, const legacy_material *m, const char *const *image_names,
                          text *out)
{
    const legacy_map *map = &m->maps[LEGACY_DIFFUSE_MAP];
    const char *path = texture_path(scene, map, image_names);
    if (path)
        text_json_string(out, "texture", path);
    if (path || m->texture_type != LEGACY_RGB)
        text_json_string(out, "textype", OGL1_TEXTYPES[m->texture_type]);
    if (m->texture_mode != LEGACY_MODULATE) /* since rgl 1.1 only */
        text_json_string(out, "texmode", OGL1_TEXMODES[m->texture_mode]);
    if (path && map->ref.texture != SCENE_NONE) {
        const scene_texture *t = &scene->textures[map->ref.texture];
        text_json_bool(out, "texmipmap", t->mip_filter != SCENE_MIP_NONE);
        text_json_string(out, "texminfilter", min_filter_name(t));
        text_json_string(out, "texmagfilter", OGL1_MAG_FILTERS[t->mag_filter == SCENE_FILTER_NEAREST]);
    }
    if (path || m->has_environment_map)
        text_json_bool(out, "texenvmap", m->has_environment_map);
}

/* Whether text is one JSON value. */
static bool is_json(const char *value, size_t length)
{
    json_t *json = json_loadb(value, length, JSON_DECODE_ANY | JSON_ALLOW_NUL, NULL);
    json_decref(json);
    return json != NULL;
}

/* A line "KEY VALUE" of legacy_material.unknown; the value is JSON if it comes from a document, any text
 * if from an MTL file. */
static void write_unknown_line(const char *line, size_t length, json_t *seen, text *out)
{
    char key[64];
    size_t key_length = strcspn(line, " \t\n");
    key_length = key_length < length ? key_length : length;
    size_t begin = key_length + (key_length < length);
    if (key_length == 0 || key_length >= sizeof key)
        return;
    snprintf(key, sizeof key, "%.*s", (int)key_length, line);
    bool is_side = strcmp(key, "front") == 0 || strcmp(key, "back") == 0;
    if ((ogl1_is_parameter(key) && !is_side) || json_object_get(seen, key))
        return;
    out->has_failed |= json_object_set_new_nocheck(seen, key, json_true()) != 0;
    text value = {.allocator = out->allocator};
    text_add_bytes(&value, line + begin, length - begin);
    out->has_failed |= value.has_failed;
    if (value.length && is_json(value.data, value.length))
        text_json_raw(out, key, value.data);
    else
        text_json_string(out, key, value.data ? value.data : "");
    text_destroy(&value);
}

static void write_unknown(const legacy_material *m, text *out)
{
    json_t *seen = json_object();
    out->has_failed |= seen == NULL;
    for (const char *line = m->unknown; line && *line && !out->has_failed;) {
        size_t length = strcspn(line, "\n");
        write_unknown_line(line, length, seen, out);
        line += length + (line[length] == '\n');
    }
    if (!json_object_get(seen, "front"))
        text_json_string(out, "front", OGL1_SIDES[OGL1_FILLED]);
    if (!json_object_get(seen, "back"))
        text_json_string(out, "back", OGL1_SIDES[m->is_culled ? OGL1_CULLED : OGL1_FILLED]);
    json_decref(seen);
}

static void write_statements(const legacy_material *m, text *out)
{
    uint32_t any = LEGACY_ILLUM | LEGACY_TRANSMISSION_FILTER;
    for (int i = 0; i < OGL1_STATEMENT_COUNT; i++)
        any |= OGL1_STATEMENTS[i].field;
    if (!(m->fields & any))
        return;
    text_json_begin_object(out, "mtl");
    if (legacy_has(m, LEGACY_ILLUM))
        text_json_integer(out, "illum", m->illum);
    if (legacy_has(m, LEGACY_TRANSMISSION_FILTER))
        text_json_floats(out, "Tf", m->transmission_filter, 3);
    for (int i = 0; i < OGL1_STATEMENT_COUNT; i++)
        if (legacy_has(m, OGL1_STATEMENTS[i].field))
            text_json_float(out, OGL1_STATEMENTS[i].name,
                            *(const float *)(const void *)((const char *)m + OGL1_STATEMENTS[i].offset));
    text_json_end_object(out);
}

/* An entry without name and objects would apply to everything, so that one without either gets a number. */
static void write_names(const legacy_material *m, uint32_t number, const ogl1_object *objects, size_t count,
                        text *out)
{
    char name[32];
    snprintf(name, sizeof name, "material %u", number + 1);
    if (m->name[0] || count == 0)
        text_json_string(out, "name", m->name[0] ? m->name : name);
    if (count == 0)
        return;
    text_json_begin_array(out, "objects");
    for (size_t i = 0; i < count; i++)
        text_json_string(out, NULL, objects[i].name);
    text_json_end_array(out);
}

/* ---- the document ---- */

static void write_materials(const facet_scene *scene, const char *const *image_names, text *out)
{
    ogl1_object *objects;
    size_t count;
    size_t begin = 0;
    if (!create_objects(scene, &out->allocator, &objects, &count)) {
        out->has_failed = true;
        return;
    }
    write_line(out);
    text_json_begin_array(out, "materials");
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const legacy_material *m = &scene->legacy->materials[i];
        size_t end = begin;
        while (end < count && objects[end].material == i)
            end++;
        write_line(out);
        text_json_begin_object(out, NULL);
        write_names(m, i, objects + begin, end - begin, out);
        write_table(m, out);
        write_texture(scene, m, image_names, out);
        write_unknown(m, out);
        write_statements(m, out);
        text_json_end_object(out);
        begin = end;
    }
    text_json_end_array(out);
    mem_free(objects);
}

void ogl1_json_write(const facet_scene *scene, const char *generator, const char *const *image_names,
                     text *out)
{
    text_json_begin_object(out, NULL);
    text_json_string(out, "facet", "ogl1");
    text_json_integer(out, "version", 1);
    text_json_string(out, "generator", generator);
    text_json_string(out, "colors", scene->legacy->colors == FACET_LEGACY_COLORS_LINEAR ? "linear" : "srgb");
    write_materials(scene, image_names, out);
    write_lights(scene->legacy, out);
    text_json_end_object(out);
    text_add(out, "\n");
}

/* The state of saving. */
typedef struct saving {
    const facet_scene *scene;
    const char *path;
    const facet_scene_save_desc *desc;
    const facet_allocator *allocator;
    facet_error *error;
    char **image_names; /* per image; NULL: not written. Blocks of mem_alloc() */
} saving;

/* ---- what has no place in the document ---- */

static void warn_lost(const facet_scene *scene, const facet_log *log)
{
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const legacy_material *m = &scene->legacy->materials[i];
        const legacy_map *map = &m->maps[LEGACY_DIFFUSE_MAP];
        int others = 0;
        for (int slot = 0; slot < LEGACY_MAP_COUNT; slot++)
            others += slot != LEGACY_DIFFUSE_MAP &&
                      (legacy_has_map(m, (legacy_map_slot)slot) || m->maps[slot].path);
        if (others)
            log_warning(log, "material \"%s\": rgl has one texture, that of the color; %d other%s left out",
                        m->name, others, others == 1 ? " is" : "s are");
        if (map->ref.has_transform || map->base != 0.0f || map->gain != 1.0f)
            log_warning(log,
                        "material \"%s\": rgl cannot move, scale or recolor a texture; it is used as it is",
                        m->name);
    }
}

/* ---- images ---- */

static facet_result name_image(saving *s, uint32_t number, const char *extension)
{
    const char *base = path_base_name(s->path);
    size_t stem = strlen(base) - (path_extension(base)[0] ? strlen(path_extension(base)) + 1 : 0);
    size_t size = stem + strlen(extension) + 32;
    char *name = mem_alloc(s->allocator, size, 1);
    if (!name)
        return fail_memory(s->error, "name of an image", size);
    snprintf(name, size, "%.*s_image%u.%s", (int)stem, base, number, extension);
    s->image_names[number] = name;
    return FACET_OK;
}

static facet_result name_images(saving *s, const facet_log *log)
{
    for (uint32_t i = 0; i < s->scene->material_count; i++) {
        const legacy_material *m = &s->scene->legacy->materials[i];
        uint32_t texture = m->maps[LEGACY_DIFFUSE_MAP].ref.texture;
        uint32_t number = texture != SCENE_NONE ? s->scene->textures[texture].image : SCENE_NONE;
        const scene_image *source = number != SCENE_NONE ? &s->scene->images[number] : NULL;
        const image_kind *kind =
            source && source->bytes ? image_kind_of_bytes(source->bytes, source->size) : NULL;
        if (!kind || s->image_names[number])
            continue;
        if (kind->codec != IMAGE_CODEC_PNG)
            log_warning(log, "material \"%s\": its texture is a %s file; rgl reads PNG only", m->name,
                        kind->name);
        TRY(name_image(s, number, kind->file_extension));
    }
    return FACET_OK;
}

/* ---- files ---- */

/* The document comes last, so that its presence implies that of all files that it names. */
static facet_result add_files(const saving *s, const text *document, file_set *files)
{
    for (uint32_t i = 0; i < s->scene->image_count; i++)
        if (s->image_names[i])
            TRY(file_set_add(files, s->image_names[i], s->scene->images[i].bytes, s->scene->images[i].size,
                             s->error));
    TRY(file_set_add(files, NULL, document->data, document->length, s->error));
    return file_set_commit(files, s->error);
}

static facet_result write_files(const saving *s, const text *document)
{
    file_set files = file_set_begin(s->scene, s->path, s->desc);
    files.inputs = s->scene;
    facet_result result = add_files(s, document, &files);
    file_set_destroy(&files);
    return result;
}

facet_result ogl1_json_save(const facet_scene *scene, const char *path, const char *generator,
                            const facet_scene_save_desc *desc, facet_error *error)
{
    const facet_scene_save_desc defaults = {0};
    desc = desc ? desc : &defaults;
    saving s = {.scene = scene, .path = path, .desc = desc, .allocator = &desc->allocator, .error = error};
    text document = {.allocator = desc->allocator};
    facet_result result = FACET_OK;
    s.image_names = mem_zalloc(s.allocator, scene->image_count, sizeof *s.image_names);
    if (!s.image_names)
        return fail_memory(error, "images", scene->image_count * sizeof *s.image_names);
    result = name_images(&s, &desc->log);
    if (result == FACET_OK)
        ogl1_json_write(scene, generator, (const char *const *)s.image_names, &document);
    if (document.has_failed)
        result = fail_memory(error, "parameters", document.capacity);
    if (result == FACET_OK)
        result = write_files(&s, &document);
    if (result == FACET_OK)
        warn_lost(scene, &desc->log);
    for (uint32_t i = 0; i < scene->image_count; i++)
        mem_free(s.image_names[i]);
    mem_free(s.image_names);
    text_destroy(&document);
    return result;
}
