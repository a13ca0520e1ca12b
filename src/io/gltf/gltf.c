/* gltf.c - reads a .glb or .gltf file: the container (glTF 2.0 section 4.4), the JSON, its version, then
 * one concern after the other. */
#include "io/gltf/gltf.h"

#include <stdio.h>
#include <string.h>

#include "base/result.h"
#include "io/file_source.h"
#include "io/gltf/gltf_external.h"

/* ---- the container: header, JSON chunk, binary chunk ---- */

enum { HEADER_SIZE = 12, CHUNK_HEADER_SIZE = 8 };

static const uint32_t CHUNK_JSON = 0x4e4f534a;
static const uint32_t CHUNK_BIN = 0x004e4942;

/* Little-endian on every machine. */
static uint32_t read_u32(const unsigned char *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static bool check_header(io_reader *r, const unsigned char *bytes, size_t *size)
{
    if (*size < HEADER_SIZE)
        return io_fail(r, NULL, NULL, FACET_ERROR_INVALID,
                       "is cut off: %zu bytes are less than the 12 of a GLB header", *size);
    uint32_t version = read_u32(bytes + 4);
    if (version == 1)
        return io_fail(r, NULL, NULL, FACET_ERROR_UNSUPPORTED, "is binary glTF 1.0; only glTF 2.0 is read");
    if (version != 2)
        return io_fail(r, NULL, NULL, FACET_ERROR_UNSUPPORTED, "is GLB version %u; only version 2 is read",
                       version);
    uint32_t length = read_u32(bytes + 8);
    if (length > *size)
        return io_fail(r, NULL, NULL, FACET_ERROR_INVALID,
                       "is cut off: its header declares %u bytes, but there are %zu", length, *size);
    if (length < *size) {
        io_note(r, NULL, NULL, "has %zu bytes after the %u that its header declares; they are ignored",
                *size - length, length);
        *size = length;
    }
    return true;
}

/* Splits a .glb; json and bin point into bytes. False: an error is recorded. */
static bool split_glb(io_reader *r, const unsigned char *bytes, size_t size, const char **json,
                      size_t *json_size)
{
    if (!check_header(r, bytes, &size))
        return false;
    *json = NULL;
    size_t at = HEADER_SIZE;
    for (unsigned number = 0; at < size; number++) {
        if (size - at < CHUNK_HEADER_SIZE)
            return io_fail(r, NULL, NULL, FACET_ERROR_INVALID, "is cut off in the header of chunk %u",
                           number);
        uint32_t length = read_u32(bytes + at);
        uint32_t type = read_u32(bytes + at + 4);
        at += CHUNK_HEADER_SIZE;
        if (length > size - at)
            return io_fail(r, NULL, NULL, FACET_ERROR_INVALID,
                           "is cut off: chunk %u declares %u bytes, but %zu follow", number, length,
                           size - at);
        if (length % 4)
            io_note(r, NULL, NULL, "chunk %u has %u bytes, which is not a multiple of 4", number, length);
        if (number == 0 && type != CHUNK_JSON)
            return io_fail(r, NULL, NULL, FACET_ERROR_INVALID,
                           "the first chunk must be JSON, but is of type 0x%08x", type);
        if (number == 0) {
            *json = (const char *)bytes + at;
            *json_size = length;
        } else if (type == CHUNK_BIN && !r->gltf->bin) {
            r->gltf->bin = bytes + at;
            r->gltf->bin_size = length;
        } else if (type == CHUNK_BIN || type == CHUNK_JSON) {
            io_warn(r, NULL, NULL, "chunk %u repeats a type and is ignored", number);
        } /* other chunks may belong to extensions and are skipped */
        at += length;
    }
    if (!*json)
        return io_fail(r, NULL, NULL, FACET_ERROR_INVALID, "has no JSON chunk");
    return true;
}

/* ---- JSON ---- */

static json_t *parse(io_reader *r, const char *text, size_t size)
{
    if (size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) {
        io_note(r, NULL, NULL, "begins with a byte order mark, which glTF does not allow");
        text += 3;
        size -= 3;
    }
    json_t *json = io_parse_json(r, text, size);
    if (json && !json_is_object(json))
        io_fail(r, NULL, NULL, FACET_ERROR_INVALID, "must be a JSON object");
    return json;
}

/* ---- asset ---- */

static bool parse_version(const char *text, unsigned *major, unsigned *minor)
{
    int used = 0;
    return text[0] >= '0' && text[0] <= '9' && sscanf(text, "%4u.%4u%n", major, minor, &used) == 2 &&
           used > 0 && text[used] == 0 && strspn(text, "0123456789.") == strlen(text);
}

static const char *copy_string(io_reader *r, const json_place *object, const char *key)
{
    const char *string = io_get_string(r, object, key, "");
    if (io_leave_out(r, "it is not kept"))
        string = "";
    char *copy = arena_strdup(r->scene->arena, string);
    if (!copy)
        io_fail_memory(r, key, 0);
    return copy ? copy : "";
}

static void read_asset(io_reader *r, const json_place *root)
{
    json_place asset = io_get_object(r, root, "asset");
    const char *version = io_get_string(r, &asset, "version", NULL);
    const char *minimum = io_is_ok(r) ? io_get_string(r, &asset, "minVersion", NULL) : NULL;
    if (version)
        io_leave_out(r, "it is ignored");
    unsigned major = 0;
    unsigned minor = 0;
    if (!io_is_ok(r))
        return;
    if (!version) {
        io_fail(r, &asset, "version", FACET_ERROR_INVALID, "is missing; this is not a glTF 2.0 file");
        return;
    }
    bool is_2 = version[0] == '2' && version[1] != '0' && strspn(version + 1, ".0") == strlen(version + 1);
    if (is_2 && !parse_version(version, &major, &minor)) { /* "2", "2.0.0" */
        io_note(r, &asset, "version", "\"%.40s\" is not a version such as \"2.0\"", version);
        major = 2;
        minor = 0;
    } else if (!parse_version(version, &major, &minor)) {
        io_fail(r, &asset, "version", FACET_ERROR_INVALID, "\"%.40s\" is not a version such as \"2.0\"",
                version);
        return;
    }
    if (major != 2) {
        io_fail(r, &asset, "version", FACET_ERROR_UNSUPPORTED, "is glTF %u.%u; only glTF 2.0 is read", major,
                minor);
        return;
    }
    r->gltf->has_externals = minor >= 1;
    if (minor > 1)
        io_warn(r, &asset, "version", "is glTF %u.%u; it is read as glTF 2.1", major, minor);
    if (minimum && !parse_version(minimum, &major, &minor))
        io_note(r, &asset, "minVersion", "\"%.40s\" is not a version", minimum);
    else if (minimum && (major > 2 || minor > 1))
        io_fail(r, &asset, "minVersion", FACET_ERROR_UNSUPPORTED,
                "requires a reader of glTF %u.%u; facet reads 2.1", major, minor);
    if (!io_is_ok(r))
        return;
    r->scene->version = copy_string(r, &asset, "version");
    r->scene->generator = copy_string(r, &asset, "generator");
    r->scene->copyright = copy_string(r, &asset, "copyright");
}

/* ---- the file ---- */

static void read_document(io_reader *r)
{
    const json_place root = {.value = r->json};
    read_asset(r, &root);
    if (io_is_ok(r))
        gltf_read_extensions(r, &root);
    void (*const concerns[])(io_reader *, const json_place *) = {
        gltf_read_buffers,  gltf_read_views,         gltf_read_accessors, gltf_read_images,
        gltf_read_textures, gltf_read_materials,     gltf_read_variants,  gltf_read_meshes,
        gltf_read_lights,   gltf_read_image_lights,  gltf_read_cameras,   gltf_read_nodes,
        gltf_read_scenes,   gltf_read_center,        gltf_read_skins,     gltf_read_animations,
        gltf_read_meta,     gltf_read_legacy_extras,
    };
    enum { IMAGES = 4 /* concerns up to images */, ALL = sizeof concerns / sizeof *concerns };
    for (size_t i = 0; i < (r->gltf->reads_images_only ? IMAGES : ALL) && io_is_ok(r); i++)
        concerns[i](r, &root);
    if (r->gltf->outer)
        r->gltf->outer->has_default_scene = io_has_member(&root, "scene");
    if (!io_is_ok(r) || r->gltf->reads_images_only)
        return;
    gltf_check_unused_parts(r);
    if (io_is_ok(r))
        gltf_read_externals(r, &root); /* the arrays of the scene grow */
}

static void read_bytes(io_reader *r, const unsigned char *bytes, size_t size)
{
    const char *json = (const char *)bytes;
    size_t json_size = size;
    bool is_glb = size >= 4 && memcmp(bytes, "glTF", 4) == 0;
    if (size == 0) {
        io_fail(r, NULL, NULL, FACET_ERROR_INVALID, "is empty");
        return;
    }
    if (is_glb && !split_glb(r, bytes, size, &json, &json_size))
        return;
    size_t at = json_size >= 3 && memcmp(json, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    while (at < json_size && strchr(" \t\r\n", json[at]) && json[at])
        at++;
    if (!is_glb && (at == json_size || json[at] != '{')) {
        io_fail(r, NULL, NULL, FACET_ERROR_INVALID, "is neither a .glb file nor the JSON of a .gltf file");
        return;
    }
    size_t estimate = io_json_memory_estimate(json, json_size);
    void *reserve = mem_alloc(r->allocator, estimate, 1);
    if (!reserve) {
        io_fail_memory(r, "JSON", estimate);
        return;
    }
    r->json = parse(r, json, json_size);
    if (io_is_ok(r))
        read_document(r);
    gltf_release_draco(r);
    json_decref(r->json);
    r->json = NULL;
    mem_free(reserve);
}

/* Reads the bytes of file, which the scene takes over. folder: as in io_reader. */
static facet_result load(file_bytes *file, const char *source, const char *folder, gltf_tables tables,
                         const facet_scene_desc *desc, facet_scene **out, facet_error *error)
{
    facet_scene *scene = NULL;
    TRY(scene_create(&desc->allocator, source, &scene, error));
    scene->max_texture_size = desc->max_texture_size;
    scene->thread_count = desc->thread_count;
    const unsigned char *bytes = file->data;
    size_t size = file->size;
    if (!scene_keep_file(scene, file, source)) {
        scene_destroy(scene);
        return fail_memory(error, "files", sizeof *file);
    }
    tables.path = scene->source;
    io_reader r = {.scene = scene,
                   .gltf = &tables,
                   .allocator = &desc->allocator,
                   .log = &desc->log,
                   .error = error,
                   .thread_count = desc->thread_count,
                   .max_file_bytes = file_limit(desc->max_file_bytes),
                   .files = &desc->files,
                   .folder = folder,
                   .root = desc->root,
                   .work = tables.outer ? tables.outer->state->work : 0};
    io_begin_remarks(&r);
    read_bytes(&r, bytes, size);
    io_end_remarks(&r);
    if (tables.outer)
        tables.outer->state->work = r.work;
    if (r.result != FACET_OK) {
        scene_destroy(scene);
        return r.result;
    }
    *out = scene;
    return FACET_OK;
}

static facet_result load_path(const char *path, bool reads_images_only, const facet_scene_desc *desc,
                              facet_scene **scene, facet_error *error)
{
    const facet_scene_desc defaults = {0};
    desc = desc ? desc : &defaults;
    *scene = NULL;
    file_bytes file = {0};
    TRY(model_file_open(path, desc, &file, error));
    char *folder = path_folder(&desc->allocator, path);
    const gltf_tables tables = {
        .reads_images_only = reads_images_only, .device = file.device, .number = file.number};
    facet_result result = folder ? load(&file, path, folder, tables, desc, scene, error)
                                 : fail_memory(error, "path", strlen(path));
    mem_free(folder);
    file_close(&file);
    return result;
}

facet_result gltf_load(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                       facet_error *error)
{
    return load_path(path, false, desc, scene, error);
}

facet_result gltf_load_images(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                              facet_error *error)
{
    return load_path(path, true, desc, scene, error);
}

facet_result gltf_load_memory(const void *bytes, size_t size, const char *name, const facet_scene_desc *desc,
                              facet_scene **scene, facet_error *error)
{
    const facet_scene_desc defaults = {0};
    desc = desc ? desc : &defaults;
    *scene = NULL;
    TRY(io_check_size(size, name, desc, error));
    unsigned char *copy = mem_alloc(&desc->allocator, size + 1, 1);
    if (!copy)
        return fail_memory(error, name, size);
    memcpy(copy, bytes, size);
    copy[size] = 0;
    file_bytes file = {.data = copy, .size = size, .mapping = copy};
    facet_result result = load(&file, name, NULL, (gltf_tables){0}, desc, scene, error);
    file_close(&file);
    return result;
}

facet_result gltf_load_asset(const uri_bytes *bytes, const char *path, const char *folder, uint64_t device,
                             uint64_t number, const facet_scene_desc *desc, gltf_outer *outer,
                             facet_scene **scene, facet_error *error)
{
    const gltf_tables tables = {.outer = outer, .device = device, .number = number};
    file_bytes file = {.data = bytes->data, .size = bytes->size}; /* of the file that refers to it */
    *scene = NULL;
    return load(&file, path, folder, tables, desc, scene, error);
}
