/* uri.c - what a URI in a model stands for: base64 data inside it, or a file below the model's folder. Nothing else
 * is ever opened. */
#define _POSIX_C_SOURCE 200809L
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/gltf/gltf_reader.h"

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

/* 0 to 63; 64: none. Also the URL-safe alphabet, which some writers use. */
static unsigned base64_value(unsigned char c)
{
    if (c >= 'A' && c <= 'Z')
        return c - 'A';
    if (c >= 'a' && c <= 'z')
        return c - 'a' + 26u;
    if (c >= '0' && c <= '9')
        return c - '0' + 52u;
    return c == '+' || c == '-' ? 62u : c == '/' || c == '_' ? 63u : 64u;
}

/* Decodes length characters into out (3 bytes per 4 characters begun); false: something is no base64. */
static bool decode_base64(const char *text, size_t length, unsigned char *out, size_t *size)
{
    unsigned char values[256];
    for (unsigned i = 0; i < 256; i++)
        values[i] = (unsigned char)base64_value((unsigned char)i);
    while (length && text[length - 1] == '=')
        length--;
    size_t count = 0;
    size_t i = 0;
    for (; i + 4 <= length; i += 4) {
        unsigned a = values[(unsigned char)text[i]];
        unsigned b = values[(unsigned char)text[i + 1]];
        unsigned c = values[(unsigned char)text[i + 2]];
        unsigned d = values[(unsigned char)text[i + 3]];
        if ((a | b | c | d) > 63)
            return false;
        unsigned bits = a << 18 | b << 12 | c << 6 | d;
        out[count++] = (unsigned char)(bits >> 16);
        out[count++] = (unsigned char)(bits >> 8);
        out[count++] = (unsigned char)bits;
    }
    unsigned bits = 0;
    size_t rest = length - i;
    if (rest == 1)
        return false;
    for (size_t k = 0; k < rest; k++) {
        unsigned value = values[(unsigned char)text[i + k]];
        if (value > 63)
            return false;
        bits |= value << (18 - 6 * k);
    }
    if (rest >= 2)
        out[count++] = (unsigned char)(bits >> 16);
    if (rest == 3)
        out[count++] = (unsigned char)(bits >> 8);
    *size = count;
    return true;
}

static bool load_data_uri(reader *r, const char *uri, uri_bytes *out)
{
    const char *comma = strchr(uri, ',');
    if (!comma || comma - uri < 7 || strncmp(comma - 7, ";base64", 7) != 0)
        return uri_fail(out, FACET_ERROR_INVALID, "is a data URI that is not base64");
    const char *text = comma + 1;
    size_t length = strlen(text);
    unsigned char *bytes = arena_alloc(r->scene->arena, length / 4 + 1, 3);
    if (!bytes)
        return uri_fail(out, FACET_ERROR_MEMORY, "out of memory for a data URI of %zu characters", length);
    if (!decode_base64(text, length, bytes, &out->size))
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

/* %20 to a space; a % that starts no pair of digits stays. out has strlen(uri) + 1 bytes. False: a 0 inside. */
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

/* Whether uri starts with "letters:", as http: or C: do. */
static bool has_scheme(const char *uri)
{
    size_t length = strspn(uri, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789+.-");
    return length > 0 && uri[length] == ':';
}

/* Whether the path climbs out of where it starts, on its way or in the end. */
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
        out->file = scene->file_count;
        if (!scene_keep_file(scene, &file)) {
            file_close(&file);
            return uri_fail(out, FACET_ERROR_MEMORY, "out of memory for a file");
        }
    }
    out->data = scene->files[out->file].data;
    out->size = scene->files[out->file].size;
    return true;
}

bool file_scope_open(const file_scope *scope, const char *name, const char *shown, uri_bytes *out)
{
    const char *folder = scope->folder ? scope->folder : scope->root;
    const char *allowed = scope->root ? scope->root : scope->folder;
    bool is_absolute = name[0] == '/';
    *out = (uri_bytes){0};
    if (!folder)
        return uri_fail(out, FACET_ERROR_READ,
                        "\"%.200s\" cannot be found: the model was not read from a folder", shown);
    if (name[0] == 0)
        return uri_fail(out, FACET_ERROR_INVALID, "names no file");
    if (is_absolute ? !scope->allows_absolute : !scope->root && climbs_out(name))
        return uri_fail(out, FACET_ERROR_READ, "\"%.200s\" leads out of the model's folder", shown);
    char *path = path_join(scope->allocator, is_absolute ? "" : folder, name);
    if (!path)
        return uri_fail(out, FACET_ERROR_MEMORY, "out of memory for a path");
    bool done = false;
    struct stat status;
    int fd = path_open_inside(path, allowed);
    if (fd < 0 && errno == EXDEV)
        uri_fail(out, FACET_ERROR_READ, "\"%.200s\" leads out of the folder that the model may read", shown);
    else if (fd < 0 && errno == ENOENT)
        uri_fail(out, FACET_ERROR_READ, "there is no file \"%.200s\"", name);
    else if (fd < 0 || fstat(fd, &status) != 0)
        uri_fail(out, FACET_ERROR_READ, "\"%.200s\" cannot be opened: %s", name, strerror(errno));
    else if (!S_ISREG(status.st_mode)) /* a pipe could keep us waiting for ever */
        uri_fail(out, FACET_ERROR_READ, "\"%.200s\" is no regular file", name);
    else
        done = read_once(scope, fd, path, &status, out);
    if (fd >= 0)
        close(fd);
    mem_free(path);
    return done;
}

static bool open_below(reader *r, const char *name, const char *uri, uri_bytes *out)
{
    const file_scope scope = {.scene = r->scene,
                              .allocator = r->allocator,
                              .folder = r->folder,
                              .root = r->root,
                              .max_file_bytes = r->max_file_bytes};
    return file_scope_open(&scope, name, uri, out);
}

bool load_uri(reader *r, const char *uri, uri_bytes *out)
{
    *out = (uri_bytes){0};
    if (strncmp(uri, "data:", 5) == 0)
        return load_data_uri(r, uri, out);
    if (has_scheme(uri))
        return uri_fail(out, FACET_ERROR_READ, "\"%.200s\" is no file beside the model; only those are read",
                        uri);
    size_t length = strlen(uri);
    char *name = mem_alloc(r->allocator, length + 1, 1);
    if (!name)
        return uri_fail(out, FACET_ERROR_MEMORY, "out of memory for a path");
    bool done = decode_percent(uri, name) ? open_below(r, name, uri, out)
                                          : uri_fail(out, FACET_ERROR_INVALID, "has a character 0 inside");
    if (!done && out->result == FACET_ERROR_READ && strchr(uri, '%')) {
        uri_bytes raw = {0}; /* a name that was written without escaping its % */
        if (open_below(r, uri, uri, &raw)) {
            *out = raw;
            done = true;
        }
    }
    if (!done && out->result == FACET_ERROR_READ && strchr(name, '\\')) {
        uri_bytes slashed = {0}; /* Windows' separators */
        for (char *c = name; *c; c++)
            *c = *c == '\\' ? '/' : *c;
        if (open_below(r, name, uri, &slashed)) {
            *out = slashed;
            done = true;
        }
    }
    mem_free(name);
    return done;
}
