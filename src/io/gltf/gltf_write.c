/* gltf_write.c - writes a scene as a glTF 2.0 file: .glb, or .gltf with a .bin and the images beside it. */
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/result.h"
#include "io/file_set.h"
#include "io/gltf/gltf.h"
#include "io/gltf/gltf_writer.h"

enum { GLB_MAGIC = 0x46546C67, GLB_JSON = 0x4E4F534A, GLB_BIN = 0x004E4942 };

/* ---- the document ---- */

static void write_asset(gltf_writer *w)
{
    const facet_scene *scene = w->scene;
    json_t *asset = gltf_put_object(w, w->root, "asset");
    gltf_put(w, asset, "version", json_string("2.0"));
    gltf_put(w, asset, "generator", gltf_json_text(w, w->generator));
    if (scene->copyright[0])
        gltf_put(w, asset, "copyright", gltf_json_text(w, scene->copyright));
    gltf_put_meta(w, asset, &scene->asset_meta);
}

static void write_variant_names(gltf_writer *w)
{
    for (uint32_t i = 0; i < w->scene->variant_count; i++) {
        json_t *variant = json_object();
        gltf_put(w, variant, "name", gltf_json_text(w, w->scene->variants[i]));
        gltf_append(w,
                    gltf_put_array(w, gltf_put_extension(w, w->root, "KHR_materials_variants"), "variants"),
                    variant);
    }
}

/* Extensions that the original file required are required again if they are used. */
static void write_extension_names(gltf_writer *w)
{
    const char *name;
    json_t *is_required;
    for (uint32_t i = 0; i < w->scene->extension_count; i++) {
        const scene_extension *e = &w->scene->extensions[i];
        if (e->is_required && json_object_get(w->extensions_used, e->name))
            gltf_require_extension(w, e->name);
    }
    json_object_foreach(w->extensions_used, name, is_required)
    {
        gltf_append(w, gltf_put_array(w, w->root, "extensionsUsed"), gltf_json_text(w, name));
        if (json_is_true(is_required))
            gltf_append(w, gltf_put_array(w, w->root, "extensionsRequired"), gltf_json_text(w, name));
    }
}

/* uri: of the binary data; NULL: the binary chunk. */
static void write_buffer(gltf_writer *w, const char *uri)
{
    if (w->bin_size == 0)
        return;
    json_t *buffer = json_object();
    if (uri)
        gltf_put_uri(w, buffer, uri);
    gltf_put(w, buffer, "byteLength", json_integer((json_int_t)w->bin_size));
    gltf_append(w, gltf_put_array(w, w->root, "buffers"), buffer);
}

static void put_filled(gltf_writer *w, const char *key, json_t *array)
{
    if (json_array_size(array))
        gltf_put(w, w->root, key, json_incref(array));
}

static void write_document(gltf_writer *w, const char *bin_name)
{
    void (*const concerns[])(gltf_writer *) = {
        write_asset,       gltf_write_scenes,     gltf_write_nodes,     gltf_write_meshes,
        gltf_write_skins,  gltf_write_animations, gltf_write_materials, gltf_write_textures,
        gltf_write_images, gltf_write_cameras,    gltf_write_lights,    write_variant_names};
    for (size_t i = 0; i < sizeof concerns / sizeof *concerns && gltf_writer_is_ok(w); i++)
        concerns[i](w);
    put_filled(w, "accessors", w->accessors);
    put_filled(w, "bufferViews", w->views);
    write_buffer(w, bin_name);
    gltf_put_meta(w, w->root, &w->scene->meta);
    write_extension_names(w);
}

/* The JSON text; for free(). */
static char *dump(gltf_writer *w)
{
    size_t flags = w->needs_all_digits ? JSON_REAL_PRECISION(17) : JSON_REAL_PRECISION(15);
    char *text = json_dumps(w->root, flags | (w->stem ? JSON_INDENT(2) : JSON_COMPACT));
    if (!text)
        gltf_writer_fail_memory(w, 0);
    return text;
}

/* ---- files ---- */

static void put_u32(unsigned char *at, size_t value)
{
    for (int i = 0; i < 4; i++)
        at[i] = (unsigned char)(value >> 8 * i);
}

/* Writes a chunk with its header at *at, padded to a multiple of 4, and advances *at. */
static void add_chunk(unsigned char **at, size_t type, const void *bytes, size_t size, char padding)
{
    size_t padded = (size + 3) & ~(size_t)3;
    put_u32(*at, padded);
    put_u32(*at + 4, type);
    memcpy(*at + 8, bytes, size);
    memset(*at + 8 + size, padding, padded - size);
    *at += 8 + padded;
}

static facet_result save_glb(gltf_writer *w, const char *path)
{
    write_document(w, NULL);
    char *text = gltf_writer_is_ok(w) ? dump(w) : NULL;
    if (!text)
        return w->result;
    size_t length = strlen(text);
    size_t size =
        12 + 8 + ((length + 3) & ~(size_t)3) + (w->bin_size ? 8 + ((w->bin_size + 3) & ~(size_t)3) : 0);
    unsigned char *file = size <= UINT32_MAX ? mem_alloc(w->allocator, size, 1) : NULL;
    if (size > UINT32_MAX) {
        w->result = fail(w->error, FACET_ERROR_LIMIT,
                         "%s: a .glb file holds at most 4 GiB; write a .gltf file", path);
    } else if (!file) {
        gltf_writer_fail_memory(w, size);
    } else {
        unsigned char *at = file + 12;
        put_u32(file, GLB_MAGIC);
        put_u32(file + 4, 2);
        put_u32(file + 8, size);
        add_chunk(&at, GLB_JSON, text, length, ' ');
        if (w->bin_size)
            add_chunk(&at, GLB_BIN, w->bin, w->bin_size, 0);
        file_set set = file_set_begin(w->scene, path, w->desc);
        w->result = file_set_add(&set, NULL, file, size, w->error);
        if (gltf_writer_is_ok(w))
            w->result = file_set_commit(&set, w->error);
        file_set_destroy(&set);
    }
    mem_free(file);
    free(text);
    return w->result;
}

/* Writes all files or none. */
static void save_files(gltf_writer *w, const char *path, const char *text, const char *bin_name)
{
    file_set set = file_set_begin(w->scene, path, w->desc);
    for (size_t i = 0; i < w->file_count && gltf_writer_is_ok(w); i++)
        w->result = file_set_add(&set, w->files[i].name, w->files[i].bytes, w->files[i].size, w->error);
    if (gltf_writer_is_ok(w) && w->bin_size)
        w->result = file_set_add(&set, bin_name, w->bin, w->bin_size, w->error);
    if (gltf_writer_is_ok(w))
        w->result = file_set_add(&set, NULL, text, strlen(text), w->error);
    if (gltf_writer_is_ok(w))
        w->result = file_set_commit(&set, w->error);
    file_set_destroy(&set);
}

static facet_result save_gltf(gltf_writer *w, const char *path)
{
    const char *base = path_base_name(path);
    const char *extension = path_extension(path);
    size_t length = strlen(base) - (extension[0] ? strlen(extension) + 1 : 0);
    char *stem = mem_alloc(w->allocator, length + 1, 1);
    char *bin_name = mem_alloc(w->allocator, length + 5, 1);
    char *text = NULL;
    if (!stem || !bin_name) {
        gltf_writer_fail_memory(w, length + 5);
        goto done;
    }
    snprintf(stem, length + 1, "%s", base);
    snprintf(bin_name, length + 5, "%s.bin", stem);
    w->stem = stem;
    write_document(w, bin_name);
    text = gltf_writer_is_ok(w) ? dump(w) : NULL;
    if (gltf_writer_is_ok(w))
        save_files(w, path, text, bin_name);
done:
    free(text);
    mem_free(stem);
    mem_free(bin_name);
    return w->result;
}

facet_result gltf_save(const facet_scene *scene, const char *path, const char *generator,
                       const facet_scene_save_desc *desc, facet_error *error)
{
    const facet_scene_save_desc defaults = {0};
    desc = desc ? desc : &defaults;
    bool is_glb = desc->is_glb || strcasecmp(path_extension(path), "glb") == 0;
    if (!is_glb && strcasecmp(path_extension(path), "gltf") != 0)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: the name does not end in .glb or .gltf", path);
    gltf_writer w = {.scene = scene,
                     .generator = generator,
                     .allocator = &desc->allocator,
                     .log = &desc->log,
                     .desc = desc,
                     .error = error,
                     .result = FACET_OK,
                     .thread_count = desc->thread_count,
                     .root = json_object(),
                     .accessors = json_array(),
                     .views = json_array(),
                     .extensions_used = json_object()};
    if (!w.root || !w.accessors || !w.views || !w.extensions_used)
        gltf_writer_fail_memory(&w, 0);
    else if (is_glb)
        save_glb(&w, path);
    else
        save_gltf(&w, path);
    for (size_t i = 0; i < w.file_count; i++) {
        mem_free(w.files[i].name);
        mem_free(w.files[i].made);
    }
    mem_free(w.files);
    mem_free(w.written);
    index_table_release(&w.written_table);
    mem_free(w.bin);
    json_decref(w.root);
    json_decref(w.accessors);
    json_decref(w.views);
    json_decref(w.extensions_used);
    return w.result;
}
