/* ogl1_materials.c - reads the parameters of material3d() into a legacy_material, by tables that the
 * writer shares, and finds the images that materials name, beside the document or below the root. Members
 * without a meaning here are kept as text. R writes absolute paths of the machine that it runs on: where
 * such a path is not allowed or names no file, the base name is searched beside the document. */
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "io/image_kind.h"
#include "io/obj/mtl_parts.h"
#include "io/ogl1/ogl1_parameters.h"
#include "io/ogl1/ogl1_reader.h"

/* ---- tables of parameters ---- */

const ogl1_parameter OGL1_PARAMETERS[OGL1_PARAMETER_COUNT] = {
    {"lit", OGL1_BOOLEAN, offsetof(legacy_material, is_lit), 0, 0},
    {"ambient", OGL1_COLOR, offsetof(legacy_material, ambient), 0, 0},
    {"specular", OGL1_COLOR, offsetof(legacy_material, specular), 0, 0},
    {"emission", OGL1_COLOR, offsetof(legacy_material, emission), 0, 0},
    {"shininess", OGL1_NUMBER, offsetof(legacy_material, shininess), 0, 1e6},
    {"smooth", OGL1_BOOLEAN, offsetof(legacy_material, is_smooth), 0, 0},
    {"fog", OGL1_BOOLEAN, offsetof(legacy_material, has_fog), 0, 0},
};

const ogl1_statement OGL1_STATEMENTS[OGL1_STATEMENT_COUNT] = {
    {"Ni", LEGACY_IOR, offsetof(legacy_material, ior), 0.001, 100},
    {"sharpness", LEGACY_SHARPNESS, offsetof(legacy_material, sharpness), 0, 1000},
    {"Pr", LEGACY_ROUGHNESS, offsetof(legacy_material, roughness), 0, 1},
    {"Pm", LEGACY_METALLIC, offsetof(legacy_material, metallic), 0, 1},
    {"Ps", LEGACY_SHEEN, offsetof(legacy_material, sheen), 0, 1},
    {"Pc", LEGACY_CLEARCOAT, offsetof(legacy_material, clearcoat), 0, 1},
    {"Pcr", LEGACY_CLEARCOAT_ROUGHNESS, offsetof(legacy_material, clearcoat_roughness), 0, 1},
    {"aniso", LEGACY_ANISOTROPY, offsetof(legacy_material, anisotropy), -1, 1},
    {"anisor", LEGACY_ANISOTROPY_ROTATION, offsetof(legacy_material, anisotropy_rotation), -1, 1},
};

const char *const OGL1_TEXTYPES[] = {"rgb", "rgba", "alpha", "luminance", "luminance.alpha", NULL};
const char *const OGL1_TEXMODES[] = {"modulate", "replace", "decal", "blend", "add", NULL};
const char *const OGL1_MAG_FILTERS[] = {"linear", "nearest", NULL};
const char *const OGL1_SIDES[] = {"filled", "lines", "points", "culled", NULL};

const ogl1_min_filter OGL1_MIN_FILTERS[OGL1_MIN_FILTER_COUNT] = {
    {"linear", SCENE_FILTER_LINEAR, SCENE_MIP_NONE},
    {"nearest", SCENE_FILTER_NEAREST, SCENE_MIP_NONE},
    {"linear.mipmap.linear", SCENE_FILTER_LINEAR, SCENE_MIP_LINEAR},
    {"linear.mipmap.nearest", SCENE_FILTER_LINEAR, SCENE_MIP_NEAREST},
    {"nearest.mipmap.linear", SCENE_FILTER_NEAREST, SCENE_MIP_LINEAR},
    {"nearest.mipmap.nearest", SCENE_FILTER_NEAREST, SCENE_MIP_NEAREST},
};

static bool is_among(const char *key, const char *const *names, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(key, names[i]) == 0)
            return true;
    return false;
}

bool ogl1_is_parameter(const char *key)
{
    static const char *const others[] = {"color",     "col",          "alpha",        "front",
                                         "back",      "texture",      "textype",      "texmode",
                                         "texmipmap", "texminfilter", "texmagfilter", "texenvmap"};
    for (int i = 0; i < OGL1_PARAMETER_COUNT; i++)
        if (strcmp(key, OGL1_PARAMETERS[i].name) == 0)
            return true;
    return is_among(key, others, sizeof others / sizeof *others);
}

static bool is_kept(const char *key)
{
    static const char *const kept[] = {
        "size",       "lwd",           "point_antialias", "line_antialias", "depth_mask",
        "depth_test", "isTransparent", "polygon_offset",  "margin",         "floating",
        "tag",        "blend"};
    return is_among(key, kept, sizeof kept / sizeof *kept);
}

/* rgl's defaults where they differ from legacy_material_default(). */
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
    /* rgl itself drops the alpha of a color; a hand-written one is respected. */
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
        io_warn(r, at, "front",
                "\"culled\" leaves only the inside, or nothing, visible; both sides are shown");
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

/* Whether this file reads the member, so that it is not kept as text. Modes of front and back that a
 * legacy_material cannot express are kept. */
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

/* A word as the lines of legacy_material.unknown begin with. */
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

/* The lines of both; those unknown to rgl come first. */
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

/* Keeps members without a counterpart. */
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
        bool is_rgls = ogl1_is_parameter(key) || is_kept(key);
        if (!is_rgls)
            io_warn(r, NULL, NULL,
                    is_word(key) ? "\"%.60s\" is not a parameter of material3d(); it is kept"
                                 : "\"%.60s\" is not a parameter of material3d(); it is dropped",
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

/* ---- textures ---- */

/* Images and textures to append to the scene. */
typedef struct findings {
    mtl_files files; /* for its scope */
    scene_image *images;
    size_t image_count, image_capacity;
    scene_texture *textures;
    size_t texture_count, texture_capacity;
    index_table images_by_file, textures_by_hash;
} findings;

static void warn(io_reader *r, const char *path, const char *what)
{
    io_warn(r, NULL, NULL, "texture \"%.200s\": %.400s; it is left out", path, what);
}

/* The index of the image among those found; SCENE_NONE: not available, which is reported. */
static uint32_t find_image(io_reader *r, findings *f, const char *path)
{
    uri_bytes bytes;
    const char *found;
    image header;
    facet_error error;
    if (!mtl_files_open(&f->files, "", path, &bytes, &found)) {
        if (f->files.has_failed)
            io_fail_memory(r, "texture", 0);
        else
            warn(r, path, bytes.message);
        return SCENE_NONE;
    }
    uint32_t there = index_table_find(&f->images_by_file, bytes.file);
    if (there != INDEX_TABLE_NONE)
        return there;
    const image_kind *kind = image_kind_of_bytes(bytes.data, bytes.size);
    if (!kind) {
        const char *foreign = image_foreign_kind(bytes.data, bytes.size, path);
        char what[160];
        snprintf(what, sizeof what, "is a %s file; " IMAGE_KINDS_TEXT " was expected",
                 foreign ? foreign : "");
        warn(r, path, foreign ? what : "is no " IMAGE_KINDS_TEXT " file");
        return SCENE_NONE;
    }
    if (image_probe(bytes.data, bytes.size, path, &header, NULL, &error) != FACET_OK) {
        warn(r, path, error.message);
        return SCENE_NONE;
    }
    if (!mem_reserve(r->allocator, (void **)&f->images, &f->image_capacity, f->image_count + 1,
                     sizeof *f->images) ||
        !index_table_add(&f->images_by_file, r->allocator, bytes.file, (uint32_t)f->image_count)) {
        io_fail_memory(r, "images", 0);
        return SCENE_NONE;
    }
    f->images[f->image_count] = (scene_image){.name = found,
                                              .mime_type = kind->mime_type,
                                              .bytes = bytes.data,
                                              .size = bytes.size,
                                              .width = header.width,
                                              .height = header.height,
                                              .uri = found};
    return (uint32_t)f->image_count++;
}

/* The index of the texture among those found. */
static uint32_t find_texture(io_reader *r, findings *f, const scene_texture *like)
{
    uint32_t hash = mtl_hash_texture(like);
    size_t cursor = 0;
    for (uint32_t i; (i = index_table_next(&f->textures_by_hash, hash, &cursor)) != INDEX_TABLE_NONE;)
        if (f->textures[i].image == like->image && f->textures[i].mag_filter == like->mag_filter &&
            f->textures[i].min_filter == like->min_filter && f->textures[i].mip_filter == like->mip_filter)
            return i;
    if (!mem_reserve(r->allocator, (void **)&f->textures, &f->texture_capacity, f->texture_count + 1,
                     sizeof *f->textures) ||
        !index_table_add(&f->textures_by_hash, r->allocator, hash, (uint32_t)f->texture_count)) {
        io_fail_memory(r, "textures", 0);
        return SCENE_NONE;
    }
    f->textures[f->texture_count] = *like;
    return (uint32_t)f->texture_count++;
}

/* Concatenates old and more in the arena. */
static void *joined(io_reader *r, const void *old, size_t old_count, const void *more, size_t count,
                    size_t size)
{
    char *all = io_alloc_raw(r, "textures", old_count + count, size);
    if (all && old_count)
        memcpy(all, old, old_count * size);
    if (all && count)
        memcpy(all + old_count * size, more, count * size);
    return all;
}

static void append(io_reader *r, findings *f)
{
    facet_scene *scene = r->scene;
    for (size_t i = 0; i < f->texture_count; i++)
        f->textures[i].image += scene->image_count;
    scene_image *images =
        joined(r, scene->images, scene->image_count, f->images, f->image_count, sizeof *images);
    scene_texture *textures =
        joined(r, scene->textures, scene->texture_count, f->textures, f->texture_count, sizeof *textures);
    if (!io_is_ok(r))
        return;
    scene->images = images;
    scene->image_count += (uint32_t)f->image_count;
    scene->textures = textures;
    scene->texture_count += (uint32_t)f->texture_count;
}

void ogl1_find_textures(ogl1_document *d)
{
    io_reader *r = &d->r;
    uint32_t first = r->scene->texture_count;
    findings f = {.files = {.scope = {.scene = r->scene,
                                      .allocator = r->allocator,
                                      .files = r->files,
                                      .folder = r->folder,
                                      .root = r->root,
                                      .log = r->log,
                                      .max_file_bytes = r->max_file_bytes,
                                      .allows_absolute = true}}};
    for (uint32_t i = 0; i < d->entry_count && io_is_ok(r); i++) {
        legacy_map *map = &d->entries[i].material.maps[LEGACY_DIFFUSE_MAP];
        scene_texture like = d->entries[i].sampler;
        like.image = map->path ? find_image(r, &f, map->path) : SCENE_NONE;
        uint32_t texture = like.image == SCENE_NONE ? SCENE_NONE : find_texture(r, &f, &like);
        map->ref.texture = texture == SCENE_NONE ? SCENE_NONE : first + texture;
    }
    if (io_is_ok(r) && f.image_count)
        append(r, &f);
    mtl_files_destroy(&f.files);
    mem_free(f.images);
    mem_free(f.textures);
    index_table_release(&f.images_by_file);
    index_table_release(&f.textures_by_hash);
}
