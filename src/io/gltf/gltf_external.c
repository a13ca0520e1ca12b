/* gltf_external.c - assets of other files below nodes (draft of glTF 2.1: files, externalAssets): which bytes a URI
 * stands for, what may be opened, and the scenes that are attached. */
#include "io/gltf/gltf_external.h"

#include <stdio.h>
#include <string.h>

#include "scene/attach.h"

/* Limits of a whole model. */
enum {
    MAX_DEPTH = 16,     /* assets within assets */
    MAX_FILES = 4096,   /* assets read; one that several files name counts for each */
    MAX_NODES = 1 << 20 /* in the scene with all copies */
};

/* ---- files ---- */

/* The contents of a URI or of an element of files[]. */
typedef struct located {
    uri_bytes bytes;
    const char *path, *folder; /* NULL folder: none is known; both in an arena */
    uint64_t device, number;   /* number 0: embedded */
} located;

static bool locate_file(io_reader *r, uint32_t index, located *out);

/* The element of the outer file's files[] that stands for a URI in this one; SCENE_NONE: none. */
static uint32_t find_alias(io_reader *r, const char *uri)
{
    const gltf_outer *outer = r->gltf->outer;
    const json_t *files = outer ? json_object_get(outer->reader->json, "files") : NULL;
    const json_t *aliases = files ? json_object_get(json_array_get(files, outer->file), "aliases") : NULL;
    for (size_t i = 0; i < json_array_size(aliases); i++) {
        const json_t *alias = json_array_get(aliases, i);
        const json_t *name = json_object_get(alias, "alias"), *file = json_object_get(alias, "file");
        if (json_is_string(name) && strcmp(json_string_value(name), uri) == 0 && json_is_integer(file) &&
            json_integer_value(file) >= 0 && (size_t)json_integer_value(file) < json_array_size(files))
            return (uint32_t)json_integer_value(file);
    }
    return SCENE_NONE;
}

/* Copies the folder of a path to the arena. */
static const char *folder_of(io_reader *r, const char *path)
{
    char *folder = path_folder(r->allocator, path);
    const char *out = folder ? arena_strdup(r->scene->arena, folder) : NULL;
    mem_free(folder);
    if (!out)
        io_fail_memory(r, "path", strlen(path));
    return out;
}

/* False: out->bytes has the reason. */
static bool locate_uri(io_reader *r, const char *uri, located *out)
{
    const uint32_t alias = find_alias(r, uri);
    if (alias != SCENE_NONE)
        return locate_file(r->gltf->outer->reader, alias, out);
    *out = (located){.path = r->gltf->path, .folder = r->folder};
    if (!io_load_uri(r, uri, &out->bytes))
        return false;
    if (strncmp(uri, "data:", 5) == 0)
        return true;
    const file_bytes *file = &r->scene->files[out->bytes.file];
    out->path = file->path;
    out->folder = folder_of(r, file->path);
    out->device = file->device;
    out->number = file->number;
    return out->folder != NULL;
}

bool gltf_load_uri(io_reader *r, const char *uri, uri_bytes *out)
{
    located there;
    const bool is_found = locate_uri(r, uri, &there);
    *out = there.bytes;
    return is_found;
}

/* The place of an element of files[]. */
#define FILE_PLACE(name, r, number)                                                                          \
    const json_place name##_root = {.value = (r)->json};                                                     \
    const json_place name##_array = {                                                                        \
        .parent = &name##_root, .key = "files", .value = json_object_get((r)->json, "files")};               \
    const json_place name = io_get_element_object(r, &name##_array, number)

static bool fail_to_locate(located *out, facet_result result, const char *message)
{
    snprintf(out->bytes.message, sizeof out->bytes.message, "%s", message);
    out->bytes.result = result;
    return false;
}

/* An element of files[]: a URI or a buffer view. False: out->bytes has the reason. */
static bool locate_file(io_reader *r, uint32_t index, located *out)
{
    FILE_PLACE(at, r, index);
    char path[1024];
    snprintf(path, sizeof path, "%s: files[%u]", r->gltf->path, index);
    const char *uri = io_get_string(r, &at, "uri", NULL);
    const uint32_t view = io_get_index(r, &at, "bufferView", r->gltf->view_count, "buffer view");
    *out = (located){.path = arena_strdup(r->scene->arena, path), .folder = r->folder};
    if (!out->path)
        io_fail_memory(r, "path", sizeof path);
    const located embedded = *out;
    if (io_is_ok(r) && (uri != NULL) == (view != SCENE_NONE))
        io_fail(r, &at, NULL, FACET_ERROR_INVALID, "must have either a uri or a bufferView");
    if (io_is_ok(r) && uri) {
        const bool is_found = locate_uri(r, uri, out);
        out->path = out->number ? out->path : embedded.path;
        return is_found;
    }
    if (io_is_ok(r)) {
        out->bytes.data = gltf_get_view_bytes(r, &at, view);
        out->bytes.size = r->gltf->views[view].length;
    }
    return io_is_ok(r) || fail_to_locate(out, r->result, "is not there");
}

/* ---- one asset ---- */

/* An element of externalAssets. */
typedef struct asset {
    bool is_tried;
    facet_scene *scene; /* NULL: it is not there, which was reported */
    const char *path, *name;
    scene_attachment attachment;
} asset;

/* The reader that has the file open: r or one that it is read for. NULL: none. */
static const io_reader *find_open(const io_reader *r, const located *file)
{
    for (; r && file->number; r = r->gltf->outer ? r->gltf->outer->reader : NULL)
        if (r->gltf->device == file->device && r->gltf->number == file->number)
            return r;
    return NULL;
}

/* Names the files from first to r, and the asset, which is first again: "a.gltf -> b.gltf -> a.gltf". */
static void write_chain(const io_reader *first, const io_reader *r, const located *file, char *text,
                        size_t size)
{
    const io_reader *chain[MAX_DEPTH + 1] = {r};
    size_t count = 1, used = 0;
    for (; r != first; chain[count++] = r)
        r = r->gltf->outer->reader;
    while (count-- > 0 && used < size)
        used +=
            (size_t)snprintf(text + used, size - used, "%s -> ", path_base_name(chain[count]->gltf->path));
    if (used < size)
        snprintf(text + used, size - used, "%s", path_base_name(file->path));
}

/* False: an error, of the whole model, is recorded. */
static bool check_limits(io_reader *r, const json_place *at, const located *file, gltf_asset_state *state)
{
    const uint32_t depth = r->gltf->outer ? r->gltf->outer->depth : 0;
    char chain[600];
    const io_reader *open = find_open(r, file);
    state->is_fatal = true;
    if (open) {
        write_chain(open, r, file, chain, sizeof chain);
        return io_fail(r, at, NULL, FACET_ERROR_INVALID, "is a cycle of files, %s", chain);
    }
    if (depth >= MAX_DEPTH)
        return io_fail(r, at, NULL, FACET_ERROR_LIMIT, "is nested in more than %d other assets",
                       (int)MAX_DEPTH);
    if (state->file_count >= MAX_FILES)
        return io_fail(r, at, NULL, FACET_ERROR_LIMIT, "is one of more than %d assets", (int)MAX_FILES);
    state->file_count++;
    state->is_fatal = false;
    return true;
}

static void check_type(io_reader *r, uint32_t index, const located *file)
{
    FILE_PLACE(at, r, index);
    const char *said = io_get_string(r, &at, "mimeType", NULL);
    const bool is_binary = file->bytes.size >= 4 && memcmp(file->bytes.data, "glTF", 4) == 0;
    const char *type = is_binary ? "model/gltf-binary" : "model/gltf+json";
    if (io_leave_out(r, "the format is detected from the bytes"))
        return;
    if (!said)
        io_note(r, &at, "mimeType", "is missing");
    else if (strcmp(said, type) != 0)
        io_warn(r, &at, "mimeType", "says \"%.40s\", but the file is %s", said, type);
}

/* Reads the asset. It stays NULL with a warning where it cannot be had; false: an error is recorded. */
static bool load_asset(io_reader *r, const json_place *at, gltf_asset_state *state, asset *out)
{
    const json_t *files = json_object_get(r->json, "files");
    located file = {0};
    out->is_tried = true;
    out->name = io_get_name(r, at);
    const uint32_t index = io_get_required_index(r, at, "file", (uint32_t)json_array_size(files), "file");
    if (io_leave_out(r, "the asset is left out"))
        return true;
    if (!locate_file(r, index, &file)) {
        if (file.bytes.result == FACET_ERROR_MEMORY)
            return io_fail(r, at, "file", FACET_ERROR_MEMORY, "%s", file.bytes.message);
        if (!io_leave_out(r, "the asset is left out"))
            io_warn_each(r, at, "file", "%s; the asset is left out", file.bytes.message);
        return io_is_ok(r);
    }
    if (!check_limits(r, at, &file, state))
        return false;
    check_type(r, index, &file);
    const facet_scene_desc desc = {.allocator = *r->allocator,
                                   .log = *r->log,
                                   .files = r->files ? *r->files : (facet_file_source){0},
                                   .root = r->root ? r->root : r->folder,
                                   .max_file_bytes = r->max_file_bytes,
                                   .max_texture_size = r->scene->max_texture_size,
                                   .thread_count = r->thread_count};
    gltf_outer outer = {.reader = r,
                        .file = index,
                        .depth = (r->gltf->outer ? r->gltf->outer->depth : 0) + 1,
                        .state = state};
    facet_error error;
    state->work = r->work;
    facet_result result = gltf_load_asset(&file.bytes, file.path, file.folder, file.device, file.number,
                                          &desc, &outer, &out->scene, &error);
    r->work = state->work;
    out->path = file.path;
    if (result == FACET_OK && !outer.has_default_scene)
        out->scene->default_scene = SCENE_NONE;
    if (result == FACET_OK)
        return true;
    if (result == FACET_ERROR_MEMORY || result == FACET_ERROR_LIMIT || state->is_fatal) {
        state->is_fatal = true;
        return io_fail(r, NULL, NULL, result, "%s", error.message);
    }
    io_warn_each(r, at, NULL, "cannot be read, so that its nodes are empty: %s", error.message);
    return true;
}

/* ---- nodes ---- */

/* Whether a scene of the file shows the node, or it has no scenes. */
static bool is_shown(const facet_scene *scene, uint32_t node)
{
    while (scene->nodes[node].parent != SCENE_NONE)
        node = scene->nodes[node].parent;
    for (uint32_t i = 0; i < scene->scene_count; i++)
        for (uint32_t k = 0; k < scene->scenes[i].node_count; k++)
            if (scene->scenes[i].nodes[k] == node)
                return true;
    return scene->scene_count == 0;
}

/* Calls act for each node that has an asset, with its copies. False: an error is recorded. */
typedef bool act_on_node(io_reader *r, const json_place *at, uint32_t node, asset *a, void *context);
static bool for_each_node(io_reader *r, const json_place *root, asset *assets, uint32_t asset_count,
                          act_on_node *act, void *context)
{
    json_place nodes = io_get_array(r, root, "nodes");
    for (uint32_t i = 0; i < r->gltf->file_node_count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &nodes, i);
        const uint32_t index = io_get_index(r, &at, "externalAsset", asset_count, "external asset");
        if (io_leave_out(r, "the node has no external asset") || index == SCENE_NONE)
            continue;
        for (uint32_t node = i; node != SCENE_NONE && io_is_ok(r); node = gltf_next_node_copy(r, node))
            if (is_shown(r->scene, node))
                act(r, &at, node, &assets[index], context);
    }
    return io_is_ok(r);
}

typedef struct counting {
    const json_place *assets;
    asset *first;
    gltf_asset_state *state;
    uint64_t node_count; /* of the scene and all copies */
} counting;

/* Reads the asset of a node, and counts its nodes. */
static bool load_for_node(io_reader *r, const json_place *at, uint32_t node, asset *a, void *context)
{
    counting *c = context;
    const json_place place = io_get_element_object(r, c->assets, (size_t)(a - c->first));
    if (r->scene->nodes[node].mesh != SCENE_NONE)
        io_warn(r, at, "externalAsset", "is beside a mesh, which glTF does not allow; both are drawn");
    if (!io_is_ok(r) || (!a->is_tried && !load_asset(r, &place, c->state, a)))
        return false;
    c->node_count += a->scene ? a->scene->node_count : 0;
    if (c->node_count <= MAX_NODES)
        return true;
    c->state->is_fatal = true;
    return io_fail(r, at, "externalAsset", FACET_ERROR_LIMIT,
                   "makes more than %d nodes with those of all other assets", (int)MAX_NODES);
}

static bool attach_to_node(io_reader *r, const json_place *at, uint32_t node, asset *a, void *context)
{
    (void)at;
    (void)context;
    if (!a->scene)
        return true;
    const char *name = r->scene->nodes[node].name;
    const scene_external external = {
        .name = name[0] ? name : a->name, .file = a->path, .node = node, .node_count = a->scene->node_count};
    return scene_attach(r->scene, a->scene, &external, &a->attachment, NULL) == FACET_OK ||
           io_fail_memory(r, "external assets", a->scene->node_count * sizeof(scene_node));
}

void gltf_read_externals(io_reader *r, const json_place *root)
{
    json_place array = io_get_array(r, root, "externalAssets");
    const uint32_t count = (uint32_t)io_get_count(&array);
    gltf_asset_state own = {0};
    if (io_leave_out(r, "there are no external assets") || count == 0)
        return;
    if (!r->gltf->has_externals) {
        io_warn(r, root, "externalAssets",
                "need glTF 2.1, which the asset's version does not name; they are left out");
        return;
    }
    counting c = {.assets = &array,
                  .first = mem_zalloc(r->allocator, count, sizeof(asset)),
                  .state = r->gltf->outer ? r->gltf->outer->state : &own,
                  .node_count = r->scene->node_count};
    if (!c.first) {
        io_fail_memory(r, "external assets", count * sizeof(asset));
        return;
    }
    if (for_each_node(r, root, c.first, count, load_for_node, &c))
        for_each_node(r, root, c.first, count, attach_to_node, NULL);
    for (uint32_t i = 0; i < count; i++)
        if (c.first[i].scene)
            scene_keep_scene(r->scene, c.first[i].scene);
    mem_free(c.first);
}
