/* mtl_reader.c - reads material libraries, and makes the scene's materials. */
#include <string.h>
#include <strings.h>

#include "base/result.h"
#include "base/utf8.h"
#include "io/name_table.h"
#include "io/obj/mtl_parts.h"

struct mtl_reader {
    facet_scene *scene;
    facet_scene_desc desc;
    mtl_files files;
    mtl_clues clues;
    mtl_draft *drafts;
    size_t count, capacity;
    index_table names;     /* of drafts; the first of equal names */
    index_table libraries; /* libraries that were read, by file */
    size_t library_count;
    const char **missing; /* reasons why libraries could not be read; block of mem_alloc() */
    size_t missing_count, missing_capacity;
    mtl_spectra spectra;
    bool has_failed;
};

facet_result mtl_reader_create(facet_scene *scene, const facet_scene_desc *desc, const char *folder,
                               mtl_reader **out, facet_error *error)
{
    *out = mem_zalloc(&desc->allocator, 1, sizeof **out);
    if (!*out)
        return fail_memory(error, "materials", sizeof **out);
    mtl_reader *r = *out;
    r->scene = scene;
    r->desc = *desc;
    r->files.scope = (file_scope){
        .scene = scene,
        .allocator = &r->desc.allocator,
        .files = &r->desc.files,
        .folder = folder,
        .root = desc->root,
        .log = &r->desc.log,
        .max_file_bytes = file_limit(desc->max_file_bytes),
        .allows_absolute = true,
    };
    return FACET_OK;
}

void mtl_reader_destroy(mtl_reader *r)
{
    if (!r)
        return;
    for (size_t i = 0; i < r->count; i++) {
        text_destroy(&r->drafts[i].unknown);
        mtl_gltf_destroy(r->drafts[i].gltf);
    }
    mtl_files_destroy(&r->files);
    mem_free(r->drafts);
    index_table_release(&r->names);
    mem_free(r->missing);
    index_table_release(&r->libraries);
    mtl_spectra_destroy(&r->spectra);
    mem_free(r);
}

/* ---- names ---- */

uint32_t mtl_reader_find(mtl_reader *r, const char *name, size_t length)
{
    uint32_t hash = index_table_hash(INDEX_TABLE_HASH, name, length);
    size_t cursor = 0;
    for (uint32_t i; (i = index_table_next(&r->names, hash, &cursor)) != INDEX_TABLE_NONE;)
        if (strlen(r->drafts[i].m.name) == length && memcmp(r->drafts[i].m.name, name, length) == 0)
            return i;
    return SCENE_NONE;
}

uint32_t mtl_reader_add(mtl_reader *r, const char *name, size_t length)
{
    mtl_parser p = {.arena = r->scene->arena};
    if (r->count >= SCENE_NONE || !index_table_reserve(&r->names, &r->desc.allocator, 1) ||
        !mem_reserve(&r->desc.allocator, (void **)&r->drafts, &r->capacity, r->count + 1, sizeof *r->drafts))
        return SCENE_NONE;
    mtl_draft draft = mtl_draft_begin(&r->desc.allocator);
    draft.m.name = mtl_keep(&p, (mtl_span){name, name + length});
    if (p.has_failed)
        return SCENE_NONE;
    size_t size = strlen(draft.m.name);
    if (mtl_reader_find(r, draft.m.name, size) == SCENE_NONE)
        index_table_add(&r->names, &r->desc.allocator, index_table_hash(INDEX_TABLE_HASH, draft.m.name, size),
                        (uint32_t)r->count); /* room is reserved */
    r->drafts[r->count] = draft;
    return (uint32_t)r->count++;
}

/* ---- one library ---- */

/* A library during reading. */
typedef struct library {
    mtl_reader *reader;
    mtl_parser parser;
    const char *folder; /* below the OBJ file's: "" or "materials/" */
    uint32_t current;   /* material; SCENE_NONE: none */
    bool is_ignored;    /* inside a material whose name was defined before */
    bool has_begun;     /* a newmtl was read */
} library;

/* Opens the file of a spectrum for the parser. */
static bool open_beside(void *user, const char *name, uri_bytes *out)
{
    library *l = user;
    const char *found;
    bool is_open = mtl_files_open(&l->reader->files, l->folder, name, out, &found);
    l->parser.has_failed = l->parser.has_failed || l->reader->files.has_failed;
    return is_open;
}

/* Finds the textures of new maps. */
static void resolve_maps(library *l, mtl_draft *draft)
{
    mtl_files *files = &l->reader->files;
    for (int i = 0; i < LEGACY_MAP_COUNT; i++) {
        legacy_map *map = &draft->m.maps[i];
        if (map->path == draft->resolved[i])
            continue;
        draft->resolved[i] = map->path;
        uint32_t found = mtl_files_image(files, &l->parser, l->folder, map->path);
        scene_wrap wrap = draft->is_clamped[i] ? SCENE_WRAP_CLAMP : SCENE_WRAP_REPEAT;
        if (found != SCENE_NONE)
            map->ref.texture = mtl_files_texture(
                files, &(scene_texture){.name = "", .image = found, .wrap_u = wrap, .wrap_v = wrap});
    }
    l->parser.has_failed = l->parser.has_failed || files->has_failed;
}

static void end_material(library *l)
{
    if (l->current == SCENE_NONE)
        return;
    mtl_draft *draft = &l->reader->drafts[l->current];
    mtl_draft_end(&l->parser, draft);
    if (legacy_has(&draft->m, LEGACY_SHININESS))
        mtl_clues_shininess(&l->reader->clues, draft->m.shininess);
    if (draft->m.gltf_json && !l->parser.has_failed) {
        l->parser.line = draft->gltf_line;
        draft->gltf = mtl_gltf_begin(&l->parser, &l->reader->files, l->folder, &draft->m);
        l->parser.has_failed = l->parser.has_failed || l->reader->files.has_failed;
    }
    l->current = SCENE_NONE;
}

static void begin_material(library *l, mtl_span name)
{
    end_material(l);
    l->has_begun = true;
    l->is_ignored = mtl_reader_find(l->reader, name.begin, mtl_length(name)) != SCENE_NONE;
    if (l->is_ignored) {
        mtl_warn(&l->parser, "material \"%.*s\" is defined more than once; the first definition is used",
                 (int)(mtl_length(name) < 60 ? mtl_length(name) : 60), name.begin);
        return;
    }
    l->current = mtl_reader_add(l->reader, name.begin, mtl_length(name));
    l->parser.has_failed = l->parser.has_failed || l->current == SCENE_NONE;
}

static void read_comment(library *l, mtl_span line)
{
    static const char word[] = "#facet-gltf";
    enum { MAX_JSON = 1 << 20 }; /* a material needs far less, and jansson's memory is not accounted */
    mtl_span rest = line;
    if (!mtl_is_word(mtl_next_word(&rest), word)) {
        line.begin++;
        if (!l->has_begun)
            mtl_clues_comment(&l->reader->clues, line, false);
        return;
    }
    rest = mtl_trim(rest);
    if (l->current == SCENE_NONE)
        return;
    if (mtl_length(rest) > MAX_JSON) {
        mtl_warn(&l->parser, "#facet-gltf: is longer than %d bytes; it is ignored", (int)MAX_JSON);
        return;
    }
    l->reader->drafts[l->current].m.gltf_json = mtl_keep(&l->parser, rest);
    l->reader->drafts[l->current].gltf_line = l->parser.line;
}

static void read_line(library *l, mtl_span line, bool *has_warned)
{
    mtl_span rest = line;
    mtl_span keyword = mtl_next_word(&rest);
    if (*line.begin == '#') {
        read_comment(l, line);
    } else if (mtl_is_word(keyword, "newmtl")) {
        begin_material(l, mtl_trim(rest));
    } else if (l->current != SCENE_NONE) {
        mtl_draft *draft = &l->reader->drafts[l->current];
        mtl_parse_statement(&l->parser, line, draft);
        if (!l->parser.has_failed)
            resolve_maps(l, draft);
    } else if (!l->is_ignored && !*has_warned) {
        mtl_warn(&l->parser, "\"%.*s\" stands before the first newmtl; such statements are ignored",
                 (int)(mtl_length(keyword) < 60 ? mtl_length(keyword) : 60), keyword.begin);
        *has_warned = true;
    }
}

/* The folder of a path, with the slash behind it. */
static const char *folder_of(mtl_parser *p, const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? mtl_keep(p, (mtl_span){path, slash + 1}) : "";
}

static void read_library(mtl_reader *r, const char *path, const uri_bytes *bytes)
{
    library l = {.reader = r, .current = SCENE_NONE};
    l.parser = (mtl_parser){
        .arena = r->scene->arena,
        .allocator = &r->desc.allocator,
        .scene = r->scene,
        .log = &r->desc.log,
        .file = path,
        .has_flipped_texcoords = r->desc.has_flipped_texcoords,
        .has_srgb_colors = r->desc.legacy.colors != FACET_LEGACY_COLORS_LINEAR,
        .spectra = &r->spectra,
        .open = open_beside,
        .user = &l,
    };
    l.folder = folder_of(&l.parser, path);
    mtl_lines lines = mtl_lines_begin(&r->desc.allocator, bytes->data, bytes->size);
    mtl_span line;
    bool has_warned = false;
    if (bytes->size >= 2 &&
        (memcmp(bytes->data, "\xff\xfe", 2) == 0 || memcmp(bytes->data, "\xfe\xff", 2) == 0))
        scene_warn(r->scene, &r->desc.log, "%s: is UTF-16 text; UTF-8 was expected", path);
    while (!l.parser.has_failed && mtl_next_line(&lines, &line)) {
        l.parser.line = lines.line;
        read_line(&l, line, &has_warned);
    }
    end_material(&l);
    r->has_failed = r->has_failed || l.parser.has_failed || lines.joined.has_failed;
    text_destroy(&lines.joined);
}

facet_result mtl_reader_load_bytes(mtl_reader *r, const char *name, const void *bytes, size_t size,
                                   facet_error *error)
{
    read_library(r, name, &(uri_bytes){.data = bytes, .size = size});
    return r->has_failed ? fail_memory(error, "materials", r->count * sizeof *r->drafts) : FACET_OK;
}

/* ---- mtllib ---- */

/* Interpretations of a library name. */
typedef enum name_leeway {
    NAME_LITERAL,
    NAME_ALIKE, /* as in file_scope_open() */
    NAME_BASE   /* the same, then the base name beside the OBJ file */
} name_leeway;

/* Reads the library of a name unless it was read already. False: not found; *why is filled. */
static bool load_library(mtl_reader *r, const char *name, name_leeway leeway, uri_bytes *why)
{
    const char *found;
    r->files.scope.is_literal = leeway == NAME_LITERAL;
    bool is_open = leeway == NAME_BASE ? mtl_files_open(&r->files, "", name, why, &found)
                                       : mtl_files_open_named(&r->files, "", name, why, &found);
    r->files.scope.is_literal = false; /* for its maps */
    if (!is_open) {
        r->has_failed = r->has_failed || r->files.has_failed;
        return false;
    }
    if (index_table_find(&r->libraries, why->file) != INDEX_TABLE_NONE)
        return true;
    if (!index_table_add(&r->libraries, &r->desc.allocator, why->file, 0)) {
        r->has_failed = true;
        return true;
    }
    r->library_count++;
    read_library(r, found, why);
    return true;
}

/* Loads the shortest name of up to MAX_WORDS words at the front of *rest that is a file, and advances
 * *rest. The format separates names by spaces, but names with spaces are common. */
static bool load_front(mtl_reader *r, mtl_span *rest, name_leeway leeway, mtl_parser *p)
{
    enum { MAX_WORDS = 16 };
    mtl_span all = mtl_trim(*rest);
    mtl_span ahead = all;
    for (int words = 0; words < MAX_WORDS && mtl_length(mtl_trim(ahead)) > 0; words++) {
        mtl_next_word(&ahead);
        mtl_span name = mtl_trim((mtl_span){all.begin, ahead.begin});
        if (mtl_length(name) >= 2 && *name.begin == '"') {
            if (name.end[-1] != '"')
                continue;
            name = (mtl_span){name.begin + 1, name.end - 1};
        }
        uri_bytes why;
        const char *kept = mtl_keep(p, name);
        if (!p->has_failed && load_library(r, kept, leeway, &why)) {
            *rest = ahead;
            return true;
        }
    }
    return false;
}

/* The name of a missing library: up to the next word that ends in ".mtl", or the first word. */
static mtl_span missing_name(mtl_span *rest)
{
    mtl_span all = mtl_trim(*rest);
    mtl_span ahead = all;
    mtl_span first = mtl_next_word(&ahead);
    for (mtl_span word = first; mtl_length(word) > 0; word = mtl_next_word(&ahead))
        if (mtl_length(word) > 4 && strncasecmp(word.end - 4, ".mtl", 4) == 0) {
            *rest = ahead;
            return (mtl_span){all.begin, word.end};
        }
    rest->begin = first.end;
    return first;
}

/* Records why a library cannot be read. */
static void add_missing(mtl_reader *r, mtl_parser *p, const char *message)
{
    const char *kept = mtl_keep(p, (mtl_span){message, message + strlen(message)});
    if (p->has_failed || !mem_reserve(&r->desc.allocator, (void **)&r->missing, &r->missing_capacity,
                                      r->missing_count + 1, sizeof *r->missing))
        r->has_failed = true;
    else
        r->missing[r->missing_count++] = kept;
}

facet_result mtl_reader_load(mtl_reader *r, const char *names, size_t length, facet_error *error)
{
    enum { MAX_LIBRARIES = 256 }; /* per statement: each missing library costs several system calls */
    mtl_span rest = {names, names + length};
    mtl_parser p = {.arena = r->scene->arena};
    for (int i = 0; i < MAX_LIBRARIES && mtl_length(mtl_trim(rest)) > 0 && !r->has_failed; i++) {
        if (load_front(r, &rest, NAME_LITERAL, &p) || load_front(r, &rest, NAME_ALIKE, &p) || r->has_failed ||
            p.has_failed)
            continue;
        mtl_span name = missing_name(&rest);
        uri_bytes why;
        const char *kept = mtl_keep(&p, name);
        if (!load_library(r, kept, NAME_BASE, &why) && !r->has_failed)
            add_missing(r, &p, why.message);
    }
    r->has_failed = r->has_failed || p.has_failed || r->files.has_failed;
    return r->has_failed ? fail_memory(error, "materials", r->count * sizeof *r->drafts) : FACET_OK;
}

/* Exporters write the library's name into the OBJ file; users rename both. False: there is no such file. */
static bool load_namesake(mtl_reader *r)
{
    const char *base = path_base_name(r->scene->source);
    size_t length = strlen(base);
    const char *extension = path_extension(base);
    length -= *extension ? strlen(extension) + 1 : 0;
    char *name = arena_alloc(r->scene->arena, length + sizeof ".mtl", 1);
    if (!name) {
        r->has_failed = true;
        return false;
    }
    memcpy(name, base, length);
    memcpy(name + length, ".mtl", sizeof ".mtl");
    uri_bytes why;
    if (!load_library(r, name, NAME_ALIKE, &why))
        return false;
    if (r->missing_count)
        scene_warn(r->scene, &r->desc.log,
                   "%s: mtllib: %s; \"%.200s\", which is named like the model, is read instead",
                   r->scene->source, r->missing[0], why.name);
    else
        scene_warn(r->scene, &r->desc.log,
                   "%s: names no library of materials; \"%.200s\", which is named like the model, is read",
                   r->scene->source, why.name);
    return true;
}

facet_result mtl_reader_settle(mtl_reader *r, bool needs_materials, facet_error *error)
{
    bool is_found = needs_materials && r->library_count == 0 && r->files.scope.folder && load_namesake(r);
    for (size_t i = 0; i < r->missing_count && !is_found; i++)
        scene_warn(r->scene, &r->desc.log, "%s: mtllib: %s; its materials have default values",
                   r->scene->source, r->missing[i]);
    r->has_failed = r->has_failed || r->files.has_failed;
    return r->has_failed ? fail_memory(error, "materials", r->count * sizeof *r->drafts) : FACET_OK;
}

void mtl_reader_hint(mtl_reader *r, const char *comment, size_t length)
{
    mtl_clues_comment(&r->clues, (mtl_span){comment, comment + length}, true);
}

/* ---- the scene ---- */

static scene_legacy *new_legacy(mtl_reader *r)
{
    scene_legacy *legacy = arena_zalloc(r->scene->arena, 1, sizeof *legacy);
    if (!legacy)
        return NULL;
    legacy->materials = arena_alloc(r->scene->arena, r->count, sizeof *legacy->materials);
    legacy->is_source = true;
    legacy->fog.scale = 1.0f;
    legacy->colors = r->desc.legacy.colors == FACET_LEGACY_COLORS_LINEAR ? FACET_LEGACY_COLORS_LINEAR
                                                                         : FACET_LEGACY_COLORS_SRGB;
    legacy->dialect = r->desc.legacy.dialect;
    if (legacy->dialect == FACET_MTL_DIALECT_AUTO)
        legacy->dialect = mtl_clues_decide(&r->clues, &legacy->is_dialect_guessed);
    return legacy->materials ? legacy : NULL;
}

static void fill_material(mtl_reader *r, scene_legacy *legacy, size_t i)
{
    mtl_draft *draft = &r->drafts[i];
    mtl_parser p = {.arena = r->scene->arena,
                    .allocator = &r->desc.allocator,
                    .scene = r->scene,
                    .log = &r->desc.log,
                    .file = r->scene->source,
                    .line = draft->gltf_line};
    scene_material *m = &r->scene->materials[i];
    *m = scene_material_default();
    m->name = draft->m.name;
    if (draft->gltf) {
        draft->m.is_gltf_restored = mtl_gltf_end(draft->gltf, &p, m);
        draft->gltf = NULL;
    }
    r->has_failed = r->has_failed || p.has_failed;
    legacy->materials[i] = draft->m;
}

/* The name as UTF-8, made unique in the table; NULL: no memory. */
static const char *settle_name(const mtl_reader *r, name_table *names, const char *name)
{
    size_t size = strlen(name);
    char *copy = arena_alloc(r->scene->arena, 2 * size + NAME_NUMBER_ROOM, 1);
    if (!copy)
        return NULL;
    copy[utf8_from_latin1(name, size, copy)] = 0;
    name_table_add_numbered(names, copy, 2);
    return copy;
}

/* Statements refer to materials by the bytes of their names; afterwards names are UTF-8. Bytes of another
 * encoding are taken as Latin-1, with one warning. */
static bool settle_names(mtl_reader *r, scene_legacy *legacy)
{
    size_t others = 0;
    const char *first = NULL;
    name_table names = {0};
    bool is_done = name_table_create(&names, r->count, false, &r->desc.allocator);
    for (size_t i = 0; i < r->count && is_done; i++) {
        const char *name = legacy->materials[i].name;
        if (utf8_is_valid(name, strlen(name)))
            name_table_add(&names, name);
        else
            first = others++ ? first : name;
    }
    if (others)
        scene_warn(r->scene, &r->desc.log,
                   "%s: the name of material \"%.200s\" is not UTF-8; its bytes are taken as Latin-1%s",
                   r->scene->source, first, others > 1 ? ", as those of others" : "");
    for (size_t i = 0; i < r->count && is_done && others; i++) {
        const char *name = legacy->materials[i].name;
        if (utf8_is_valid(name, strlen(name)))
            continue;
        name = settle_name(r, &names, name);
        is_done = name != NULL;
        legacy->materials[i].name = r->scene->materials[i].name = name;
    }
    name_table_destroy(&names);
    return is_done;
}

facet_result mtl_reader_finish(mtl_reader *r, facet_error *error)
{
    facet_scene *scene = r->scene;
    scene_legacy *legacy = new_legacy(r);
    scene->materials = arena_alloc(scene->arena, r->count, sizeof *scene->materials);
    if (!legacy || !scene->materials || r->has_failed || !mtl_files_finish(&r->files))
        return fail_memory(error, "materials", r->count * sizeof *scene->materials);
    for (size_t i = 0; i < r->count; i++)
        fill_material(r, legacy, i);
    if (r->has_failed || !settle_names(r, legacy))
        return fail_memory(error, "materials", r->count * sizeof *scene->materials);
    scene->material_count = (uint32_t)r->count;
    scene->legacy = legacy;
    return FACET_OK;
}
