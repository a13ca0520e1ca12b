/* ogl1_materials.c - reads the parameters of material3d() into a legacy_material. What has no meaning here is kept as it
 * stands. */
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "io/ogl1/ogl1_parameters.h"
#include "io/ogl1/ogl1_reader.h"

/* rgl's, where they are not those of legacy_material_default(). */
static legacy_material default_material(void)
{
    legacy_material m = legacy_material_default();
    m.fields = LEGACY_AMBIENT | LEGACY_DIFFUSE | LEGACY_SPECULAR | LEGACY_EMISSION | LEGACY_SHININESS |
               LEGACY_OPACITY;
    for (int k = 0; k < 3; k++)
        m.diffuse[k] = m.specular[k] = 1.0f;
    m.shininess = 50.0f;
    return m;
}

/* ---- reading ---- */

static void read_color(io_reader *r, const json_place *at, legacy_material *m)
{
    float rgba[4] = {1, 1, 1, 1};
    if (ogl1_color(r, at, io_has_member(at, "color") ? "color" : "col", rgba))
        memcpy(m->diffuse, rgba, sizeof m->diffuse);
    /* rgl itself drops the alpha of a color. Who writes one by hand means it. */
    if (!ogl1_number_in(r, at, "alpha", 0.0, 1.0, &m->opacity))
        m->opacity = rgba[3];
}

static void read_table(io_reader *r, const json_place *at, legacy_material *m)
{
    for (int i = 0; i < OGL1_PARAMETER_COUNT; i++) {
        void *member = (char *)m + OGL1_PARAMETERS[i].offset;
        float rgba[4];
        if (OGL1_PARAMETERS[i].kind == OGL1_BOOLEAN)
            ogl1_bool(r, at, OGL1_PARAMETERS[i].name, member);
        else if (OGL1_PARAMETERS[i].kind == OGL1_NUMBER)
            ogl1_number_in(r, at, OGL1_PARAMETERS[i].name, OGL1_PARAMETERS[i].minimum,
                           OGL1_PARAMETERS[i].maximum, member);
        else if (ogl1_color(r, at, OGL1_PARAMETERS[i].name, rgba))
            memcpy(member, rgba, 3 * sizeof *rgba);
    }
}

static void read_texture(io_reader *r, const json_place *at, ogl1_entry *out)
{
    legacy_material *m = &out->material;
    const char *path = NULL;
    int type = LEGACY_RGB;
    int mode = LEGACY_MODULATE;
    int mag = 0;
    int min = 0;
    bool has_mips = false;
    const char *min_filters[OGL1_MIN_FILTER_COUNT + 1] = {NULL};
    for (int i = 0; i < OGL1_MIN_FILTER_COUNT; i++)
        min_filters[i] = OGL1_MIN_FILTERS[i].name;
    ogl1_choice(r, at, "textype", OGL1_TEXTYPES, &type);
    ogl1_choice(r, at, "texmode", OGL1_TEXMODES, &mode);
    ogl1_choice(r, at, "texmagfilter", OGL1_MAG_FILTERS, &mag);
    ogl1_choice(r, at, "texminfilter", min_filters, &min);
    ogl1_bool(r, at, "texmipmap", &has_mips);
    ogl1_bool(r, at, "texenvmap", &m->has_environment_map);
    m->texture_type = (legacy_texture_type)type;
    m->texture_mode = (legacy_texture_mode)mode;
    out->sampler = (scene_texture){
        .name = "",
        .image = SCENE_NONE,
        .mag_filter = mag ? SCENE_FILTER_NEAREST : SCENE_FILTER_LINEAR,
        .min_filter = OGL1_MIN_FILTERS[min].filter,
        .mip_filter = has_mips ? OGL1_MIN_FILTERS[min].mip_filter : SCENE_MIP_NONE,
    };
    if (!ogl1_string(r, at, "texture", &path) || !path[0])
        return;
    m->maps[LEGACY_DIFFUSE_MAP].path = arena_strdup(r->scene->arena, path);
    if (!m->maps[LEGACY_DIFFUSE_MAP].path)
        io_fail_memory(r, "texture", strlen(path));
}

static void read_sides(io_reader *r, const json_place *at, legacy_material *m)
{
    int front = OGL1_FILLED;
    int back = OGL1_FILLED;
    ogl1_choice(r, at, "front", OGL1_SIDES, &front);
    ogl1_choice(r, at, "back", OGL1_SIDES, &back);
    m->is_culled = back == OGL1_CULLED && front != OGL1_CULLED;
    if (front == OGL1_CULLED)
        io_warn(r, at, "front", "\"culled\" leaves the inside, or nothing; both sides are shown");
}

static void read_statements(io_reader *r, const json_place *at, legacy_material *m)
{
    json_place mtl = ogl1_object(r, at, "mtl");
    float illum = -1.0f;
    for (int i = 0; i < OGL1_STATEMENT_COUNT; i++)
        if (ogl1_number_in(r, &mtl, OGL1_STATEMENTS[i].name, OGL1_STATEMENTS[i].minimum,
                           OGL1_STATEMENTS[i].maximum,
                           (float *)(void *)((char *)m + OGL1_STATEMENTS[i].offset)))
            m->fields |= OGL1_STATEMENTS[i].field;
    if (ogl1_number_in(r, &mtl, "illum", 0.0, 10.0, &illum))
        m->fields |= LEGACY_ILLUM;
    m->illum = (int)illum;
    if (ogl1_vector(r, &mtl, "Tf", m->transmission_filter))
        m->fields |= LEGACY_TRANSMISSION_FILTER;
}

/* Whether this file reads the member, so that it is not to be kept as text. Of front and back the modes that a
 * legacy_material cannot hold are kept. */
static bool is_read(const char *key, const json_t *value)
{
    if (strcmp(key, "front") == 0 || strcmp(key, "back") == 0) {
        const json_t *mode = json_is_array(value) ? json_array_get(value, 0) : value;
        const char *name = json_is_string(mode) ? json_string_value(mode) : "filled";
        return strcmp(name, "filled") == 0 || (key[0] == 'b' && strcmp(name, "culled") == 0);
    }
    return strcmp(key, "name") == 0 || strcmp(key, "objects") == 0 || strcmp(key, "mtl") == 0 ||
           ogl1_is_parameter(key);
}

/* A word of its own, as the lines of legacy_material.unknown begin with. */
static bool is_word(const char *key)
{
    for (const char *c = key; *c; c++)
        if ((unsigned char)*c <= ' ' || *c == 0x7f)
            return false;
    return key[0] != 0;
}

/* A line "KEY VALUE", the value as JSON. */
static void add_line(const char *key, const json_t *value, text *lines)
{
    char *json = json_dumps(value, JSON_COMPACT | JSON_ENCODE_ANY | JSON_REAL_PRECISION(15));
    if (json)
        text_addf(lines, "%s%s %s", lines->length ? "\n" : "", key, json);
    else
        lines->has_failed = true;
    free(json);
}

/* The lines of both, what is foreign to rgl first. */
static void join_unknown(io_reader *r, const text *foreign, const text *kept, legacy_material *m)
{
    size_t at = foreign->length + (foreign->length && kept->length);
    size_t size = at + kept->length + 1;
    if (size == 1 && !foreign->has_failed && !kept->has_failed)
        return;
    char *all = arena_zalloc(r->scene->arena, size, 1);
    if (!all || foreign->has_failed || kept->has_failed) {
        io_fail_memory(r, "parameters", size);
        return;
    }
    if (foreign->length)
        memcpy(all, foreign->data, foreign->length);
    if (at > foreign->length)
        all[foreign->length] = '\n';
    if (kept->length)
        memcpy(all + at, kept->data, kept->length);
    m->unknown = all;
    m->kept = kept->length ? all + at : NULL;
}

/* Keeps what nothing here reads. */
static void keep_unknown(io_reader *r, const json_place *at, legacy_material *m)
{
    const char *key;
    json_t *value;
    text foreign = {.allocator = *r->allocator};
    text kept = {.allocator = *r->allocator};
    json_object_foreach((json_t *)at->value, key, value)
    {
        if (is_read(key, value) || ogl1_member(at, key).value == NULL)
            continue;
        bool is_rgls = ogl1_is_parameter(key) || ogl1_is_kept(key);
        if (!is_rgls)
            io_warn(r, NULL, NULL,
                    is_word(key) ? "\"%.60s\" is no parameter of material3d(); it is kept"
                                 : "\"%.60s\" is no parameter of material3d(); it is dropped",
                    key);
        if (is_word(key))
            add_line(key, value, is_rgls ? &kept : &foreign);
    }
    join_unknown(r, &foreign, &kept, m);
    text_destroy(&foreign);
    text_destroy(&kept);
}

static void read_objects(io_reader *r, const json_place *at, ogl1_entry *out)
{
    json_place objects = ogl1_member(at, "objects");
    size_t count = !objects.value ? 0 : json_is_array(objects.value) ? json_array_size(objects.value) : 1;
    out->objects = io_alloc(r, "objects", count, sizeof *out->objects);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place element = json_is_array(objects.value) ? io_get_element(&objects, i) : objects;
        const char *name;
        if (!ogl1_string_value(r, &element, &name))
            return;
        out->objects[i] = arena_strdup(r->scene->arena, name);
        if (!out->objects[i])
            io_fail_memory(r, "objects", strlen(name));
        out->object_count = (uint32_t)(i + 1);
    }
}

void ogl1_read_material(io_reader *r, const json_place *at, ogl1_entry *out)
{
    const char *name = NULL;
    *out = (ogl1_entry){.material = default_material()};
    if (ogl1_string(r, at, "name", &name) && name[0]) {
        out->name = arena_strdup(r->scene->arena, name);
        if (!out->name)
            io_fail_memory(r, "name", strlen(name));
    }
    read_objects(r, at, out);
    read_color(r, at, &out->material);
    read_table(r, at, &out->material);
    read_texture(r, at, out);
    read_sides(r, at, &out->material);
    read_statements(r, at, &out->material);
    if (io_is_ok(r))
        keep_unknown(r, at, &out->material);
}
