/* mtl_write.c - legacy materials as the text of an MTL file. */
#include <stdio.h>
#include <string.h>

#include "base/result.h"
#include "io/obj/mtl_parts.h"
#include "io/name_table.h"
#include "scene/legacy_extras.h"

/* ---- names ---- */

/* Appends text that fits on a line: control characters, and a backslash at the end, which would continue
 * the line, become "_". Blanks at the ends are removed. */
static void add_line_text(text *out, const char *s)
{
    mtl_span trimmed = mtl_trim((mtl_span){s, s + strlen(s)});
    for (const char *c = trimmed.begin; c < trimmed.end; c++) {
        bool is_plain = (unsigned char)*c >= 0x20 && *c != 0x7f && !(*c == '\\' && c + 1 == trimmed.end);
        text_add_bytes(out, is_plain ? c : "_", 1);
    }
}

const char **mtl_names_create(const facet_scene *scene, const facet_allocator *allocator)
{
    size_t count = scene->material_count;
    size_t characters = 0;
    for (size_t i = 0; i < count; i++)
        characters += strlen(scene->legacy->materials[i].name) + sizeof "material" + NAME_NUMBER_ROOM;
    name_table table;
    bool has_table = name_table_create(&table, count, false, allocator);
    const char **names = mem_alloc(allocator, count * sizeof *names + characters, 1);
    char *at = names ? (char *)(names + count) : NULL;
    text name = {0};
    if (allocator)
        name.allocator = *allocator;
    for (size_t i = 0; i < count && has_table && names && !name.has_failed; i++) {
        name.length = 0;
        text_add(&name, "");
        add_line_text(&name, scene->legacy->materials[i].name);
        if (name.length == 0)
            text_add(&name, "material");
        if (name.has_failed)
            break;
        names[i] = at;
        memcpy(at, name.data, name.length + 1);
        name_table_add_numbered(&table, at, i + 1);
        at += strlen(at) + 1;
    }
    if (!has_table || name.has_failed) {
        mem_free(names);
        names = NULL;
    }
    text_destroy(&name);
    name_table_destroy(&table);
    return names;
}

/* ---- statements ---- */

/* The output and the settings of a writer. */
typedef struct mtl_writer {
    const facet_scene *scene;
    const char *const *image_names;
    const facet_scene_save_desc *desc;
    const char *name; /* of the material */
    arena *strings;
    text *out;
} mtl_writer;

/* A parser for text that is about to be written, without warnings. */
static mtl_parser make_parser(const mtl_writer *w)
{
    return (mtl_parser){.arena = w->strings,
                        .allocator = &w->desc->allocator,
                        .has_flipped_texcoords = w->desc->has_flipped_texcoords};
}

static void add_numbers(text *out, const float *values, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        char digits[TEXT_FLOAT_SIZE];
        text_shortest_float(values[i], digits);
        text_addf(out, " %s", digits);
    }
}

static bool is_of_pbr(uint32_t field)
{
    return field >= LEGACY_ROUGHNESS;
}

static void write_parameters(mtl_writer *w, const legacy_material *m)
{
    float scale = w->desc->mtl_shininess_scale > 0.0f ? w->desc->mtl_shininess_scale : 1.0f;
    for (int i = 0; i < LEGACY_PARAMETER_COUNT; i++) {
        const legacy_parameter *row = &legacy_parameters[i];
        float values[3];
        if (!legacy_has(m, row->field) || (w->desc->omits_mtl_pbr && is_of_pbr(row->field)))
            continue;
        memcpy(values, legacy_floats_const(m, row), row->count * sizeof *values);
        if (row->field == LEGACY_SHININESS)
            values[0] *= scale;
        text_add(w->out, row->key);
        if (row->field == LEGACY_OPACITY && m->is_halo)
            text_add(w->out, " -halo");
        add_numbers(w->out, values, row->count);
        text_add(w->out, "\n");
    }
}

/* The source's own number; otherwise one that matches the terms of the material. */
static int illum_of(const legacy_material *m)
{
    if (legacy_has(m, LEGACY_ILLUM))
        return m->illum;
    bool is_matte = m->specular[0] == 0.0f && m->specular[1] == 0.0f && m->specular[2] == 0.0f;
    return !m->is_lit ? 0 : is_matte && !m->maps[LEGACY_SPECULAR_MAP].path ? 1 : 2;
}

/* ---- maps ---- */

static bool is_clamped(const mtl_writer *w, const legacy_map *map)
{
    if (map->ref.texture == SCENE_NONE)
        return false;
    const scene_texture *t = &w->scene->textures[map->ref.texture];
    return t->wrap_u == SCENE_WRAP_CLAMP && t->wrap_v == SCENE_WRAP_CLAMP;
}

/* Parses s as options on one line: extras of a glTF file may contain anything there. said->options and
 * said->dropped are the text of it. */
static void read_options(const mtl_writer *w, const char *s, legacy_map *said, bool *is_option_clamped)
{
    mtl_parser p = make_parser(w);
    text line = {.allocator = w->desc->allocator};
    *said = legacy_map_default();
    *is_option_clamped = false;
    text_add(&line, "");
    add_line_text(&line, s);
    if (!line.has_failed)
        mtl_parse_options(&p, line.data, said, is_option_clamped);
    w->out->has_failed = w->out->has_failed || line.has_failed || p.has_failed;
    text_destroy(&line);
}

/* The original options, if they still describe the map; otherwise NULL. */
static const char *find_true_options(const mtl_writer *w, const legacy_map *map)
{
    legacy_map said;
    bool clamped;
    if (!map->options)
        return NULL;
    read_options(w, map->options, &said, &clamped);
    bool is_true = memcmp(said.ref.offset, map->ref.offset, sizeof said.ref.offset) == 0 &&
                   memcmp(said.ref.scale, map->ref.scale, sizeof said.ref.scale) == 0 &&
                   said.base == map->base && said.gain == map->gain && said.channel == map->channel &&
                   said.bump_multiplier == map->bump_multiplier &&
                   (clamped == is_clamped(w, map) || map->ref.texture == SCENE_NONE);
    return is_true ? said.options : NULL;
}

/* The shortest decimal that reads back as the offset: see mtl_values.c. */
static void add_offset(const mtl_writer *w, const scene_texture_ref *ref)
{
    double scale = (double)ref->scale[1];
    double offset = (double)ref->offset[1];
    char digits[TEXT_FLOAT_SIZE];
    add_numbers(w->out, ref->offset, 1);
    if (w->desc->has_flipped_texcoords) {
        add_numbers(w->out, &ref->offset[1], 1);
        return;
    }
    double wanted = 1.0 - scale - offset;
    for (int precision = 1; precision <= 17; precision++) {
        double number;
        snprintf(digits, sizeof digits, "%.*g", precision, wanted);
        mtl_to_number((mtl_span){digits, digits + strlen(digits)}, &number);
        if ((float)(1.0 - scale - number) == ref->offset[1])
            break;
    }
    text_addf(w->out, " %s", strcmp(digits, "-0") == 0 ? "0" : digits);
}

static void add_options(const mtl_writer *w, const legacy_map *map)
{
    const scene_texture_ref *ref = &map->ref;
    if (map->dropped) {
        legacy_map said;
        bool clamped;
        read_options(w, map->dropped, &said, &clamped);
        if (said.dropped)
            text_addf(w->out, " %s", said.dropped);
    }
    if (is_clamped(w, map))
        text_add(w->out, " -clamp on");
    if (ref->offset[0] != 0.0f || ref->offset[1] != 0.0f || ref->scale[1] != 1.0f) {
        text_add(w->out, " -o");
        add_offset(w, ref);
    }
    if (ref->scale[0] != 1.0f || ref->scale[1] != 1.0f) {
        text_add(w->out, " -s");
        add_numbers(w->out, ref->scale, 2);
    }
    if (map->base != 0.0f || map->gain != 1.0f) {
        text_add(w->out, " -mm");
        add_numbers(w->out, &map->base, 1);
        add_numbers(w->out, &map->gain, 1);
    }
    if (map->channel)
        text_addf(w->out, " -imfchan %c", map->channel);
    if (map->bump_multiplier != 1.0f) {
        text_add(w->out, " -bm");
        add_numbers(w->out, &map->bump_multiplier, 1);
    }
}

/* Warns about properties of a map that MTL cannot express. */
static void warn_of_map(const mtl_writer *w, const legacy_map *map, const char *key)
{
    const scene_texture *t = map->ref.texture == SCENE_NONE ? NULL : &w->scene->textures[map->ref.texture];
    if (map->ref.rotation_rad != 0.0f)
        log_warning(&w->desc->log,
                    "material \"%s\": %s: MTL cannot rotate textures; it is written without rotation",
                    w->name, key);
    if (t && (t->wrap_u != t->wrap_v || t->wrap_u == SCENE_WRAP_MIRROR))
        log_warning(&w->desc->log,
                    "material \"%s\": %s: MTL textures repeat or are clamped in both directions; %s", w->name,
                    key, "this one is written as repeating");
}

/* Quotes names that readers would take as options, numbers or comments; such names contain no quotes, and
 * none begins with one. */
static void add_path(text *out, const char *path)
{
    text name = {.allocator = out->allocator};
    add_line_text(&name, path);
    out->has_failed = out->has_failed || name.has_failed;
    if (!out->has_failed) {
        mtl_span rest = {name.data, name.data + name.length};
        mtl_span word = mtl_next_word(&rest);
        double number;
        bool is_quoted = name.data[0] == '-' || mtl_to_number(word, &number) || strstr(name.data, " -") ||
                         strstr(name.data, " #");
        for (size_t i = 0; i < name.length; i++)
            if (name.data[i] == '"' && (is_quoted || i == 0))
                name.data[i] = '_';
        text_add(out, is_quoted ? " \"" : " ");
        text_add(out, name.data);
        text_add(out, is_quoted ? "\"" : "");
    }
    text_destroy(&name);
}

/* The file name of a map; NULL: the map is not written. */
static const char *find_path(const mtl_writer *w, const legacy_map *map)
{
    uint32_t image = map->ref.texture == SCENE_NONE ? SCENE_NONE : w->scene->textures[map->ref.texture].image;
    const char *file = image == SCENE_NONE || !w->image_names ? NULL : w->image_names[image];
    const char *path = file ? file : map->path;
    return path && mtl_length(mtl_trim((mtl_span){path, path + strlen(path)})) > 0 ? path : NULL;
}

static void write_map(mtl_writer *w, const legacy_map *map, const char *key)
{
    const char *path = find_path(w, map);
    if (!path)
        return;
    const char *options = find_true_options(w, map);
    text_add(w->out, key);
    if (options)
        text_addf(w->out, " %s", options);
    else
        add_options(w, map);
    add_path(w->out, path);
    text_add(w->out, "\n");
    warn_of_map(w, map, key);
}

static void write_maps(mtl_writer *w, const legacy_material *m)
{
    for (int i = 0; i < LEGACY_MAP_COUNT; i++)
        if (!w->desc->omits_mtl_pbr || i < LEGACY_NORMAL_MAP)
            write_map(w, &m->maps[i], i == LEGACY_ORM_MAP && m->is_rma ? "map_RMA" : legacy_map_keys[i]);
}

/* Whether a reader would keep the line again. Extras of a glTF file may contain statements and comments
 * with a meaning, which would begin another material or change this one. */
static bool is_unknown(const mtl_writer *w, const legacy_material *m, mtl_span line)
{
    mtl_span rest = line;
    if (*line.begin == '#' || mtl_is_word(mtl_next_word(&rest), "newmtl"))
        return false;
    mtl_parser p = make_parser(w);
    mtl_draft draft = mtl_draft_begin(&w->desc->allocator);
    draft.m.maps[LEGACY_REFLECTION_MAP].path = find_path(w, &m->maps[LEGACY_REFLECTION_MAP]);
    mtl_parse_statement(&p, line, &draft);
    bool is_kept = draft.unknown.length > 0;
    w->out->has_failed = w->out->has_failed || p.has_failed || draft.unknown.has_failed;
    text_destroy(&draft.unknown);
    return is_kept;
}

/* Writes kept lines. A trailing blank keeps a backslash at the end from joining the next line. */
static void write_unknown(const mtl_writer *w, const legacy_material *m)
{
    for (const char *lines = m->unknown; *lines && !w->out->has_failed;) {
        mtl_span line = {lines, lines + strcspn(lines, "\r\n")};
        lines = *line.end ? line.end + 1 : line.end;
        line = mtl_trim(line);
        if (mtl_length(line) == 0 || !is_unknown(w, m, line))
            continue;
        text_add_bytes(w->out, line.begin, mtl_length(line));
        text_add(w->out, line.end[-1] == '\\' ? " \n" : "\n");
    }
}

/* ---- the file ---- */

/* Whether to write the glTF material of a scene: it came from glTF, or was restored from such a comment. */
static bool has_gltf(const mtl_writer *w, const legacy_material *m)
{
    return !w->desc->omits_mtl_pbr && (!w->scene->legacy->is_source || m->is_gltf_restored);
}

static void write_material(mtl_writer *w, uint32_t index)
{
    const legacy_material *m = &w->scene->legacy->materials[index];
    text *out = w->out;
    text_addf(out, "\nnewmtl %s\n", w->name);
    size_t start = out->length;
    write_parameters(w, m);
    text_addf(out, "illum %d\n", illum_of(m));
    write_maps(w, m);
    if (m->unknown)
        write_unknown(w, m);
    if (!has_gltf(w, m) || out->has_failed)
        return;
    text comment = {.allocator = w->desc->allocator};
    mtl_gltf_write(w->scene, index, w->name, out->data + start, w->image_names, w->desc, &comment);
    if (comment.data)
        text_addf(out, "#facet-gltf %s\n", comment.data);
    out->has_failed = out->has_failed || comment.has_failed;
    text_destroy(&comment);
}

void mtl_write(const facet_scene *scene, const char *generator, const char *const *image_names,
               const facet_scene_save_desc *desc, text *out)
{
    const facet_scene_save_desc defaults = {0};
    desc = desc ? desc : &defaults;
    const char **names = mtl_names_create(scene, &desc->allocator);
    mtl_writer w = {.scene = scene,
                    .image_names = image_names,
                    .desc = desc,
                    .strings = arena_create(&desc->allocator),
                    .out = out};
    out->has_failed = out->has_failed || !names || !w.strings;
    text_addf(out, "# MTL file written by %s\n# %u material%s\n", generator, scene->material_count,
              scene->material_count == 1 ? "" : "s");
    for (uint32_t i = 0; i < scene->material_count && !out->has_failed; i++) {
        w.name = names[i];
        write_material(&w, i);
    }
    arena_destroy(w.strings);
    mem_free(names);
}
