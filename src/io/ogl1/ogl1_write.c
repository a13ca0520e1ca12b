/* ogl1_write.c - scene->legacy as JSON text: one line per material, in the names of material3d(). */
#include <jansson.h>
#include <stdio.h>
#include <string.h>

#include "io/ogl1/ogl1_json.h"
#include "io/ogl1/ogl1_parameters.h"
#include "io/ogl1/ogl1_writer.h"

/* ---- a material ---- */

static void write_table(const legacy_material *m, text *out)
{
    ogl1_write_color(out, "color", m->diffuse);
    text_json_float(out, "alpha", m->opacity);
    for (int i = 0; i < OGL1_PARAMETER_COUNT; i++) {
        const void *member = (const char *)m + OGL1_PARAMETERS[i].offset;
        if (OGL1_PARAMETERS[i].kind == OGL1_COLOR)
            ogl1_write_color(out, OGL1_PARAMETERS[i].name, member);
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

/* The file that is written, else the path that was read. */
static const char *texture_path(const facet_scene *scene, const legacy_map *map,
                                const char *const *image_names)
{
    uint32_t image = map->ref.texture != SCENE_NONE ? scene->textures[map->ref.texture].image : SCENE_NONE;
    const char *written = image != SCENE_NONE && image_names ? image_names[image] : NULL;
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
    if (m->texture_mode != LEGACY_MODULATE) /* rgl knows it since 1.1 only */
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

/* A line "KEY VALUE" of legacy_material.unknown: of a document the value is JSON, of an MTL file any text. */
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

/* An entry without name and objects would go to all, so one without either gets a number. */
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
    if (!ogl1_objects_create(scene, &out->allocator, &objects, &count)) {
        out->has_failed = true;
        return;
    }
    ogl1_write_line(out);
    text_json_begin_array(out, "materials");
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const legacy_material *m = &scene->legacy->materials[i];
        size_t end = begin;
        while (end < count && objects[end].material == i)
            end++;
        ogl1_write_line(out);
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
    ogl1_write_lights(scene->legacy, out);
    text_json_end_object(out);
    text_add(out, "\n");
}
