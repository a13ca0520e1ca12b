/* uri.c - resolves URIs and names in a model: base64 data inside it, or a file below the model's folder.
 * No other file is opened. */
#define _POSIX_C_SOURCE 200809L
#include <dirent.h>
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/base64.h"
#include "base/result.h"
#include "io/file_alike.h"
#include "io/file_source.h"
#include "io/uri.h"

static bool uri_fail(uri_bytes *out, facet_result result, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
static bool uri_fail(uri_bytes *out, facet_result result, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(out->message, sizeof out->message, format, arguments);
    va_end(arguments);
    out->result = result;
    out->data = NULL;
    out->size = 0;
    return false;
}

/* ---- data: ---- */

static bool load_data_uri(const file_scope *scope, const char *uri, uri_bytes *out)
{
    const char *comma = strchr(uri, ',');
    if (!comma || comma - uri < 7 || strncmp(comma - 7, ";base64", 7) != 0)
        return uri_fail(out, FACET_ERROR_INVALID, "is a data URI that is not base64");
    const char *text = comma + 1;
    size_t length = strlen(text);
    unsigned char *bytes = arena_alloc(scope->scene->arena, base64_bound(length), 1);
    if (!bytes)
        return uri_fail(out, FACET_ERROR_MEMORY, "out of memory for a data URI of %zu characters", length);
    if (!base64_decode(text, length, bytes, &out->size))
        return uri_fail(out, FACET_ERROR_INVALID, "is a data URI with characters that are not base64");
    out->data = bytes;
    return true;
}

/* ---- files ---- */

static int hex_value(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

/* Decodes %XX; a % without two hexadecimal digits stays. out has strlen(uri) + 1 bytes. False: the result
 * contains a
 * 0. */
static bool decode_percent(const char *uri, char *out)
{
    for (; *uri; uri++) {
        int high = *uri == '%' ? hex_value(uri[1]) : -1;
        int low = high >= 0 ? hex_value(uri[2]) : -1;
        if (low < 0) {
            *out++ = *uri;
            continue;
        }
        if (high == 0 && low == 0)
            return false;
        *out++ = (char)(high * 16 + low);
        uri += 2;
    }
    *out = 0;
    return true;
}

/* Whether uri starts with a scheme or drive letter, as http: or C:. */
static bool has_scheme(const char *uri)
{
    size_t length = strspn(uri, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789+.-");
    return length > 0 && uri[length] == ':';
}

/* Whether the path leaves its starting folder at any point. */
static bool climbs_out(const char *path)
{
    long depth = 0;
    while (*path) {
        size_t length = strcspn(path, "/");
        if (length == 2 && path[0] == '.' && path[1] == '.')
            depth--;
        else if (length > 0 && !(length == 1 && path[0] == '.'))
            depth++;
        if (depth < 0)
            return true;
        path += length;
        path += *path == '/';
    }
    return false;
}

/* Keeps a file of the scene, or gives it back. */
static bool keep_file(const file_scope *scope, file_bytes *file, const char *path, uri_bytes *out)
{
    facet_scene *scene = scope->scene;
    out->file = scene->file_count;
    if (scene_keep_file(scene, file, path))
        return true;
    file_close(file);
    return uri_fail(out, FACET_ERROR_MEMORY, "out of memory for a file");
}

/* Reads the open file unless the scene has it already. */
static bool read_once(const file_scope *scope, int fd, const char *path, const struct stat *status,
                      uri_bytes *out)
{
    facet_scene *scene = scope->scene;
    facet_error error;
    out->file = scene_find_file(scene, (uint64_t)status->st_dev, (uint64_t)status->st_ino);
    if (out->file == SCENE_NONE) {
        file_bytes file = {0};
        if (file_open_descriptor(fd, path, scope->max_file_bytes, scope->allocator, &file, &error) !=
            FACET_OK)
            return uri_fail(out, error.result, "%.400s", error.message);
        if (!keep_file(scope, &file, path, out))
            return false;
    }
    out->data = scene->files[out->file].data;
    out->size = scene->files[out->file].size;
    return true;
}

/* Whether the scope permits a search for the name. */
static bool may_search(const file_scope *scope, const char *name, const char *shown, uri_bytes *out)
{
    bool is_absolute = name[0] == '/';
    if (!scope->folder && !scope->root)
        return uri_fail(out, FACET_ERROR_READ,
                        "\"%.200s\" cannot be found: the model was not read from a folder", shown);
    if (name[0] == 0)
        return uri_fail(out, FACET_ERROR_INVALID, "names no file");
    if (is_absolute ? !scope->allows_absolute : !scope->root && climbs_out(name))
        return uri_fail(out, FACET_ERROR_READ, "\"%.200s\" leads out of the model's folder", shown);
    return true;
}

/* Opens the file at a path of file_source_path(), unless the scene has it already. */
static bool read_supplied(const file_scope *scope, const char *path, const char *shown, uri_bytes *out)
{
    const char *allowed = scope->root ? scope->root : scope->folder;
    facet_error error;
    file_bytes file;
    if (!file_source_below(path, allowed, scope->allocator))
        return uri_fail(out, FACET_ERROR_READ, "\"%.200s\" leads out of the folder that the model may read",
                        shown);
    out->file = scene_find_file(scope->scene, FILE_SOURCE_DEVICE, file_source_number(path));
    if (out->file == SCENE_NONE) {
        if (file_source_open(scope->files, path, scope->max_file_bytes, &file, &error) != FACET_OK)
            return error.result == FACET_ERROR_READ
                       ? uri_fail(out, FACET_ERROR_READ, "there is no file \"%.200s\"", shown)
                       : uri_fail(out, error.result, "%.400s", error.message);
        if (!keep_file(scope, &file, path, out))
            return false;
    }
    out->data = scope->scene->files[out->file].data;
    out->size = scope->scene->files[out->file].size;
    return true;
}

/* open_exact() of a name below the folder, among the files that the caller supplies. */
static bool open_supplied(const file_scope *scope, const char *path, const char *name, const char *shown,
                          uri_bytes *out)
{
    bool leaves_top;
    char *plain = file_source_path(scope->allocator, path, &leaves_top);
    if (!plain)
        return leaves_top ? uri_fail(out, FACET_ERROR_READ,
                                     "\"%.200s\" leads out of the folder that the model may read", shown)
                          : uri_fail(out, FACET_ERROR_MEMORY, "out of memory for a path");
    bool done = read_supplied(scope, plain, name, out);
    mem_free(plain);
    return done;
}

/* open_exact() in the file system. */
static bool open_on_disk(const file_scope *scope, const char *path, const char *name, const char *shown,
                         uri_bytes *out)
{
    const char *allowed = scope->root ? scope->root : scope->folder;
    bool done = false;
    struct stat status;
    int fd = path_open_inside(path, allowed);
    if (fd < 0 && errno == EXDEV)
        uri_fail(out, FACET_ERROR_READ, "\"%.200s\" leads out of the folder that the model may read", shown);
    else if (fd < 0 && errno == ENOENT)
        uri_fail(out, FACET_ERROR_READ, "there is no file \"%.200s\"", name);
    else if (fd < 0 || fstat(fd, &status) != 0)
        uri_fail(out, FACET_ERROR_READ, "\"%.200s\" cannot be opened: %s", name, strerror(errno));
    else if (!S_ISREG(status.st_mode)) /* opening a pipe could block forever */
        uri_fail(out, FACET_ERROR_READ, "\"%.200s\" is not a regular file", name);
    else
        done = read_once(scope, fd, path, &status, out);
    if (fd >= 0)
        close(fd);
    return done;
}

/* Opens the file of exactly that name. */
static bool open_exact(const file_scope *scope, const char *name, const char *shown, uri_bytes *out)
{
    const char *folder = scope->folder ? scope->folder : scope->root;
    *out = (uri_bytes){0};
    if (!may_search(scope, name, shown, out))
        return false;
    char *path = path_join(scope->allocator, name[0] == '/' ? "" : folder, name);
    if (!path)
        return uri_fail(out, FACET_ERROR_MEMORY, "out of memory for a path");
    bool done = file_source_is_given(scope->files) ? open_supplied(scope, path, name, shown, out)
                                                   : open_on_disk(scope, path, name, shown, out);
    mem_free(path);
    out->name = done ? arena_strdup(scope->scene->arena, name) : NULL;
    return done && !out->name ? uri_fail(out, FACET_ERROR_MEMORY, "out of memory for a path") : done;
}

/* open_alike() among the files that the caller supplies. The name of the result is relative to the folder. */
static bool open_alike_supplied(const file_scope *scope, const char *name, const char *shown, uri_bytes *out)
{
    bool leaves_top;
    const char *folder = scope->folder ? scope->folder : scope->root;
    char *path = path_join(scope->allocator, name[0] == '/' ? "" : folder, name);
    char *plain = path ? file_source_path(scope->allocator, path, &leaves_top) : NULL;
    const char *found = plain ? file_source_find_alike(scope->files, plain) : NULL;
    bool done = found ? read_supplied(scope, found, shown, out)
                      : uri_fail(out, FACET_ERROR_READ, "there is no file \"%.200s\"", name);
    const char *below = done ? file_source_below(found, folder, scope->allocator) : NULL;
    out->name = done ? arena_strdup(scope->scene->arena, below ? below : found) : NULL;
    mem_free(plain);
    mem_free(path);
    return done && !out->name ? uri_fail(out, FACET_ERROR_MEMORY, "out of memory for a path") : done;
}

/* Opens the only file whose name differs in case or in Unicode normalization. */
static bool open_alike(const file_scope *scope, const char *name, const char *shown, uri_bytes *out)
{
    *out = (uri_bytes){0};
    if (!may_search(scope, name, shown, out))
        return false;
    bool has_failed;
    if (file_source_is_given(scope->files))
        return open_alike_supplied(scope, name, shown, out);
    char *found = file_find_alike(scope->allocator, scope->folder ? scope->folder : scope->root, name,
                                  &scope->scene->search_budget, &has_failed);
    if (has_failed)
        return uri_fail(out, FACET_ERROR_MEMORY, "out of memory for a path");
    bool done = found ? open_exact(scope, found, shown, out)
                      : uri_fail(out, FACET_ERROR_READ, "there is no file \"%.200s\"", name);
    mem_free(found);
    return done;
}

/* Interpretations of a name, the literal one first. */
typedef enum name_reading {
    NAME_AS_WRITTEN,
    NAME_OF_WINDOWS,      /* backslashes separate folders */
    NAME_WITHOUT_ESCAPES, /* a backslash escapes a space, as in a shell */
    NAME_WITHOUT_QUERY,   /* "a.png?v=1", "a.png#b": copied from a web site */
    NAME_DECODED,         /* %20 is a space */
    NAME_READING_COUNT
} name_reading;

/* Writes the interpretation of name to out, of strlen(name) + 1 bytes. False: it equals an earlier one. */
static bool read_name(const char *name, name_reading reading, char *out)
{
    size_t length = strcspn(name, reading == NAME_WITHOUT_QUERY ? "?#" : "");
    size_t count = 0;
    bool differs =
        reading == NAME_AS_WRITTEN || (reading == NAME_WITHOUT_QUERY && length > 0 && name[length]);
    if (reading == NAME_DECODED)
        return strchr(name, '%') && decode_percent(name, out);
    for (size_t i = 0; i < length; i++) {
        bool is_escape = reading == NAME_WITHOUT_ESCAPES && name[i] == '\\' && name[i + 1] == ' ';
        bool is_separator = reading != NAME_AS_WRITTEN && name[i] == '\\' && !is_escape;
        if (!is_escape)
            out[count++] = is_separator ? '/' : name[i];
        differs |= is_escape || (is_separator && reading == NAME_OF_WINDOWS);
    }
    out[count] = 0;
    return differs;
}

/* Tries the other interpretations of a name, exactly and then, unless the scope is literal, by alike
 * names. *out: the failure of the first. */
static bool open_otherwise(const file_scope *scope, const char *name, const char *shown, uri_bytes *out)
{
    char *text = mem_alloc(scope->allocator, strlen(name) + 1, 1);
    int count = (scope->is_literal ? 1 : 2) * NAME_READING_COUNT;
    bool done = false;
    if (!text)
        return uri_fail(out, FACET_ERROR_MEMORY, "out of memory for a path");
    for (int i = NAME_AS_WRITTEN + 1; i < count && !done; i++) {
        name_reading reading = (name_reading)(i % NAME_READING_COUNT);
        bool is_alike = i >= NAME_READING_COUNT;
        uri_bytes bytes;
        if (!read_name(name, reading, text))
            continue;
        done = is_alike ? open_alike(scope, text, shown, &bytes) : open_exact(scope, text, shown, &bytes);
        if (done && (is_alike || reading == NAME_WITHOUT_ESCAPES || reading == NAME_WITHOUT_QUERY))
            scene_warn(scope->scene, scope->log,
                       "%s: there is no file \"%.200s\"; \"%.200s\" is read instead", scope->scene->source,
                       shown, bytes.name);
        if (done || bytes.result != FACET_ERROR_READ)
            *out = bytes;
        if (!done && bytes.result != FACET_ERROR_READ)
            break;
    }
    mem_free(text);
    return done;
}

bool file_scope_open(const file_scope *scope, const char *name, const char *shown, uri_bytes *out)
{
    return open_exact(scope, name, shown, out) ||
           (out->result == FACET_ERROR_READ && open_otherwise(scope, name, shown, out));
}

/* Whether a folder shows a single file, as sandboxes do that let a program see the model alone. */
static bool has_one_file(const char *folder)
{
    DIR *entries = opendir(folder);
    uint32_t count = 0;
    for (struct dirent *e; entries && count < 2 && (e = readdir(entries));)
        count += strcmp(e->d_name, ".") != 0 && strcmp(e->d_name, "..") != 0;
    if (entries)
        closedir(entries);
    return count == 1;
}

/* Adds the likely reason to the message about a missing file. */
static void explain_missing(const file_scope *scope, uri_bytes *out)
{
    size_t used = strlen(out->message);
    if (out->result == FACET_ERROR_READ && strncmp(out->message, "there is no file", 16) == 0 &&
        scope->folder && !file_source_is_given(scope->files) && has_one_file(scope->folder))
        snprintf(out->message + used, sizeof out->message - used,
                 "; the model is all that can be seen of its folder, as in a sandbox for thumbnails");
}

bool uri_load(const file_scope *scope, const char *uri, uri_bytes *out)
{
    *out = (uri_bytes){0};
    if (strncmp(uri, "data:", 5) == 0)
        return load_data_uri(scope, uri, out);
    if (has_scheme(uri))
        return uri_fail(out, FACET_ERROR_READ,
                        "\"%.200s\" is not a file beside the model; no others are read", uri);
    size_t length = strlen(uri);
    char *name = mem_alloc(scope->allocator, length + 1, 1);
    if (!name)
        return uri_fail(out, FACET_ERROR_MEMORY, "out of memory for a path");
    bool done = decode_percent(uri, name) ? file_scope_open(scope, name, uri, out)
                                          : uri_fail(out, FACET_ERROR_INVALID, "contains a NUL character");
    if (!done && out->result == FACET_ERROR_READ && strchr(uri, '%')) {
        uri_bytes raw = {0}; /* a name whose % was not escaped */
        if (file_scope_open(scope, uri, uri, &raw)) {
            *out = raw;
            done = true;
        }
    }
    if (!done)
        explain_missing(scope, out);
    mem_free(name);
    return done;
}

/* ---- the file of a model ---- */

facet_result io_load_file(io_loader *load, const char *path, const facet_scene_desc *desc,
                          facet_scene **scene, facet_error *error)
{
    file_bytes file = {0};
    *scene = NULL;
    TRY(model_file_open(path, desc, &file, error));
    char *folder = path_folder(&desc->allocator, path);
    facet_result result = folder ? load((const char *)file.data, file.size, path, folder, desc, scene, error)
                                 : fail_memory(error, "path", strlen(path));
    if (result == FACET_OK && !scene_note_file(*scene, &file, path)) {
        scene_destroy(*scene);
        *scene = NULL;
        result = fail_memory(error, "files", sizeof file);
    }
    mem_free(folder);
    file_close(&file);
    return result;
}

facet_result io_check_size(size_t size, const char *name, const facet_scene_desc *desc, facet_error *error)
{
    uint64_t limit = file_limit(desc->max_file_bytes);
    if (size <= limit)
        return FACET_OK;
    return fail(error, FACET_ERROR_LIMIT, "%s: %zu bytes is larger than the limit of %llu", name, size,
                (unsigned long long)limit);
}
