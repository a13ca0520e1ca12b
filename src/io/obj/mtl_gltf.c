/* mtl_gltf.c - comments "#facet-gltf {..}" in MTL files: the glTF material from which the statements above
 * were converted.
 *
 * The JSON is a glTF material with file names of images and samplers in place of texture indices, and a
 * member "facet": the statements at the time of writing. While the statements are unchanged, the glTF
 * material is restored exactly, except for textures that read a second set of coordinates; once they have
 * been edited, the statements are used. */
#include <stdlib.h>
#include <string.h>

#include "io/gltf/gltf_reader.h"
#include "io/gltf/gltf_writer.h"
#include "io/obj/mtl_parts.h"
#include "scene/legacy_extras.h"
#include "scene/material_table.h"

struct mtl_gltf {
    json_t *json;
    void *reserve; /* accounts for jansson's memory */
};

/* ---- what statements say ---- */

/* As JSON, without what depends on existing files; NULL: no memory. */
static json_t *statements_json(const facet_allocator *allocator, const legacy_material *m)
{
    legacy_material plain = *m;
    for (int i = 0; i < LEGACY_MAP_COUNT; i++)
        plain.maps[i].ref.texture = SCENE_NONE;
    text t = {.allocator = *allocator};
    legacy_extras_write_material(&plain, NULL, &t);
    json_t *json = t.has_failed ? NULL : json_loads(t.data, 0, NULL);
    text_destroy(&t);
    return json;
}

/* ---- reading ---- */

static io_reader begin_reader(mtl_parser *p, mtl_files *f, json_t *json, facet_error *error)
{
    return (io_reader){.scene = p->scene,
                       .allocator = p->allocator,
                       .log = p->log,
                       .error = error,
                       .json = json,
                       .max_file_bytes = f ? f->scope.max_file_bytes : 0};
}

/* The texture of a textureInfo; SCENE_NONE: its image is not available. */
static uint32_t find_texture(mtl_parser *p, mtl_files *f, const char *folder, json_t *info)
{
    facet_error error;
    const json_t *image = json_object_get(info, "image");
    const json_t *name = json_object_get(info, "name");
    const json_place at = {.value = info};
    io_reader r = begin_reader(p, f, info, &error);
    scene_texture texture = {.name = "", .image = SCENE_NONE};
    json_place sampler = io_get_object(&r, &at, "sampler");
    gltf_read_texture_sampler(&r, &sampler, &texture);
    if (json_is_string(name))
        texture.name = mtl_keep(
            p, (mtl_span){json_string_value(name), json_string_value(name) + json_string_length(name)});
    if (r.result == FACET_ERROR_MEMORY)
        p->has_failed = true;
    else if (!io_is_ok(&r))
        mtl_warn(p, "#facet-gltf: %.400s; the texture is left out", error.message);
    if (!io_is_ok(&r) || !json_is_string(image))
        return json_is_null(image) && io_is_ok(&r) ? mtl_files_texture(f, &texture) : SCENE_NONE;
    const char *file = json_string_value(image);
    texture.image = mtl_files_image(f, p, folder, mtl_keep(p, (mtl_span){file, file + strlen(file)}));
    return texture.image == SCENE_NONE ? SCENE_NONE : mtl_files_texture(f, &texture);
}

/* The set of texture coordinates of a textureInfo. */
static double texcoord_of(const json_t *info)
{
    const json_t *transform = json_object_get(json_object_get(info, "extensions"), "KHR_texture_transform");
    const json_t *set = json_object_get(transform, "texCoord");
    return json_number_value(set ? set : json_object_get(info, "texCoord"));
}

/* Replaces the name of an image by a texture index, or removes the textureInfo if the image is missing.
 * OBJ has one set of coordinates, which mtl_gltf_write() calls 0: other sets cannot be drawn. */
static void resolve_texture(mtl_parser *p, mtl_files *f, const char *folder, json_t *object, const char *key,
                            const char *material)
{
    json_t *info = json_object_get(object, key);
    if (!json_object_get(info, "image") && !json_object_get(info, "index"))
        return;
    uint32_t texture = SCENE_NONE; /* an index would be that of another scene's texture */
    if (texcoord_of(info) != 0.0)
        mtl_warn(p,
                 "#facet-gltf: material \"%.200s\": %s reads another set of texture coordinates than the one "
                 "that OBJ has; it is left out",
                 material, key);
    else if (json_object_get(info, "image"))
        texture = find_texture(p, f, folder, info);
    if (texture == SCENE_NONE)
        json_object_del(object, key);
    else if (json_object_set_new(info, "index", json_integer(texture)) != 0)
        p->has_failed = true;
}

/* All textures that gltf_read_material() reads. */
static void resolve_textures(mtl_parser *p, mtl_files *f, const char *folder, json_t *json,
                             const char *material)
{
    json_t *extensions = json_object_get(json, "extensions");
    for (int i = 0; i < SCENE_TEXTURE_SLOT_COUNT && !p->has_failed && !f->has_failed; i++) {
        const material_texture *row = &material_textures[i];
        json_t *object = row->extension ? json_object_get(extensions, row->object)
                         : *row->object ? json_object_get(json, row->object)
                                        : json;
        resolve_texture(p, f, folder, object, row->key, material);
    }
    /* pbrSpecularGlossiness has the base color texture in its own object. */
    resolve_texture(p, f, folder, json_object_get(extensions, "KHR_materials_pbrSpecularGlossiness"),
                    "diffuseTexture", material);
}

/* Whether the statements are those of the time of writing. */
static bool is_unchanged(mtl_parser *p, const json_t *json, const legacy_material *m)
{
    json_t *said = json_copy(json_object_get(json, "facet"));
    json_t *says = statements_json(p->allocator, m);
    json_object_del(said, "newmtl");
    bool is_same = said && says && json_equal(said, says);
    p->has_failed = p->has_failed || !says;
    json_decref(said);
    json_decref(says);
    return is_same;
}

/* Keeps the new name of a renamed material. */
static void settle_name(mtl_parser *p, json_t *json, const legacy_material *m)
{
    const json_t *name = json_object_get(json_object_get(json, "facet"), "newmtl");
    if (json_is_string(name) && strcmp(json_string_value(name), m->name) == 0)
        return;
    json_t *new =
        json_string(m->name); /* NULL also if it is not UTF-8; then mtl_reader_finish() sets the name */
    if (new &&json_object_set_new(json, "name", new) != 0)
        p->has_failed = true;
}

mtl_gltf *mtl_gltf_begin(mtl_parser *p, mtl_files *f, const char *folder, const legacy_material *m)
{
    size_t length = strlen(m->gltf_json);
    size_t estimate = io_json_memory_estimate(m->gltf_json, length);
    mtl_gltf *g = mem_zalloc(p->allocator, 1, sizeof *g);
    void *reserve = mem_alloc(p->allocator, estimate, 1);
    json_error_t error;
    if (!g || !reserve) {
        p->has_failed = true;
        mem_free(g);
        mem_free(reserve);
        return NULL;
    }
    g->reserve = reserve;
    g->json = json_loadb(m->gltf_json, length, JSON_ALLOW_NUL, &error);
    if (!g->json || !json_is_object(g->json))
        mtl_warn(p, "#facet-gltf: is not a valid JSON object; the statements are used");
    else if (is_unchanged(p, g->json, m)) {
        settle_name(p, g->json, m);
        resolve_textures(p, f, folder, g->json, m->name);
        if (!p->has_failed)
            return g;
    }
    mtl_gltf_destroy(g);
    return NULL;
}

bool mtl_gltf_end(mtl_gltf *g, mtl_parser *p, scene_material *out)
{
    facet_error error;
    const json_place at = {.value = g->json};
    io_reader r = begin_reader(p, NULL, g->json, &error);
    scene_material m;
    gltf_read_material(&r, &at, &m);
    if (io_is_ok(&r))
        *out = m;
    else if (r.result == FACET_ERROR_MEMORY)
        p->has_failed = true;
    else
        mtl_warn(p, "#facet-gltf: %.400s; the statements are used", error.message);
    mtl_gltf_destroy(g);
    return io_is_ok(&r);
}

void mtl_gltf_destroy(mtl_gltf *g)
{
    if (!g)
        return;
    json_decref(g->json);
    mem_free(g->reserve);
    mem_free(g);
}

/* ---- writing ---- */

/* The material that a reader will make of the statements; NULL: no memory. */
static json_t *parse_back(const char *statements, const char *name, const facet_scene_save_desc *desc)
{
    mtl_parser p = {.arena = arena_create(&desc->allocator),
                    .allocator = &desc->allocator,
                    .has_flipped_texcoords = desc->has_flipped_texcoords};
    if (!p.arena)
        return NULL;
    mtl_draft draft = mtl_draft_begin(&desc->allocator);
    mtl_lines lines = mtl_lines_begin(&desc->allocator, statements, strlen(statements));
    mtl_span line;
    while (mtl_next_line(&lines, &line))
        mtl_parse_statement(&p, line, &draft);
    mtl_draft_end(&p, &draft);
    json_t *json =
        p.has_failed || lines.joined.has_failed ? NULL : statements_json(&desc->allocator, &draft.m);
    json_t *newmtl = json_string(name);
    if (json && newmtl && json_object_set(json, "newmtl", newmtl) != 0) {
        json_decref(json);
        json = NULL;
    }
    json_decref(newmtl);
    text_destroy(&lines.joined);
    arena_destroy(p.arena);
    return json;
}

/* The material for an OBJ file with its single set of coordinates, that of the first map, as obj_write.c
 * chooses it. That set becomes 0 in the comment, and set 0 takes its index. */
static scene_material with_one_set(const facet_scene *scene, uint32_t material)
{
    scene_material m = scene->materials[material];
    uint32_t written = SCENE_NONE;
    for (int i = 0; scene->legacy && i < LEGACY_MAP_COUNT && written == SCENE_NONE; i++) {
        int slot = i == 0 ? LEGACY_DIFFUSE_MAP : i == LEGACY_DIFFUSE_MAP ? 0 : i;
        const scene_texture_ref *ref = &scene->legacy->materials[material].maps[slot].ref;
        if (ref->texture != SCENE_NONE)
            written = ref->texcoord;
    }
    for (int i = 0; i < SCENE_TEXTURE_SLOT_COUNT && written != SCENE_NONE; i++) {
        uint32_t *set = &m.textures[i].texcoord;
        *set = *set == written ? 0 : *set == 0 ? written : *set;
    }
    return m;
}

void mtl_gltf_write(const facet_scene *scene, uint32_t material, const char *name, const char *statements,
                    const char *const *image_names, const facet_scene_save_desc *desc, text *out)
{
    gltf_writer w = {.scene = scene,
                     .allocator = &desc->allocator,
                     .log = &desc->log,
                     .root = json_object(),
                     .extensions_used = json_object(),
                     .names_images = true,
                     .image_names = image_names};
    json_t *facet = parse_back(statements, name, desc);
    const scene_material m = with_one_set(scene, material);
    json_t *json = w.root && w.extensions_used ? gltf_new_material(&w, &m) : NULL;
    char *dumped = NULL;
    if (facet && json)
        gltf_put(&w, json, "facet", json_incref(facet));
    if (facet && json && gltf_writer_is_ok(&w))
        dumped = json_dumps(json, w.needs_all_digits ? JSON_COMPACT | JSON_REAL_PRECISION(17)
                                                     : JSON_COMPACT | JSON_REAL_PRECISION(15));
    if (dumped)
        text_add(out, dumped);
    else
        out->has_failed = true;
    free(dumped);
    json_decref(json);
    json_decref(facet);
    json_decref(w.root);
    json_decref(w.extensions_used);
}
