/* model_files.c - the files that a model names.
 *
 * helmet.gltf with a texture helmet.png beside it is common, and helmet.png is what facet render calls its picture;
 * shoe.gltf with the data shoe.bin is, and shoe.bin is what facet convert writes beside a new shoe.gltf. */
#define _POSIX_C_SOURCE 200809L
#include "cli/model_files.h"

#include "cli/input.h"
#include "cli/output.h"

#include <jansson.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* ---- the JSON ---- */

enum { GLB_HEADER = 20 }; /* bytes before the JSON of a .glb file */

static uint32_t load_u32(const unsigned char *b)
{
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

/* The JSON of a model, told apart by content; NULL: it has none. Of a pipe none is read: to read it twice would be
 * once too often. */
static json_t *load_json(const char *model)
{
    struct stat info;
    if (stat(model, &info) != 0 || !S_ISREG(info.st_mode))
        return NULL;
    FILE *file = fopen(model, "rb");
    if (!file)
        return NULL;
    unsigned char head[GLB_HEADER] = {0};
    size_t begin = fread(head, 1, sizeof head, file), size = (size_t)info.st_size;
    bool is_glb = begin == sizeof head && memcmp(head, "glTF", 4) == 0;
    begin = is_glb ? sizeof head : memcmp(head, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    size = size > begin ? size - begin : 0;
    if (is_glb && load_u32(head + 12) < size)
        size = load_u32(head + 12);
    char *text = fseek(file, (long)begin, SEEK_SET) == 0 ? malloc(size + 1) : NULL;
    json_t *root =
        text && fread(text, 1, size, file) == size ? json_loadb(text, size, JSON_ALLOW_NUL, NULL) : NULL;
    free(text);
    fclose(file);
    return root;
}

/* ---- names ---- */

/* The value of a hexadecimal digit; -1: it is none. */
static int digit_of(char c)
{
    static const char digits[] = "0123456789abcdef0123456789ABCDEF";
    const char *found = c ? strchr(digits, c) : NULL;
    return found ? (int)(found - digits) % 16 : -1;
}

/* Writes the path of uri beside model, %20 and the like decoded. False: it does not fit. */
static bool resolve(const char *model, const char *uri, char *path, size_t size)
{
    const char *slash = strrchr(model, '/');
    size_t used = slash ? (size_t)(slash - model) + 1 : 0;
    if (used >= size)
        return false;
    memcpy(path, model, used);
    for (; *uri; uri++) {
        if (used + 1 >= size)
            return false;
        char c = *uri;
        if (c == '%' && digit_of(uri[1]) >= 0 && digit_of(uri[2]) >= 0) {
            c = (char)(digit_of(uri[1]) * 16 + digit_of(uri[2]));
            uri += 2;
        }
        path[used++] = c;
    }
    path[used] = 0;
    return true;
}

/* Calls see() with the path of each buffer and image that root names beside model, until it returns true. */
static bool find_file(const json_t *root, const char *model, bool (*see)(void *context, const char *path),
                      void *context)
{
    static const char *const lists[] = {"images", "buffers"};
    for (size_t k = 0; k < 2; k++) {
        size_t i;
        json_t *element;
        json_array_foreach(json_object_get(root, lists[k]), i, element)
        {
            char name[4096];
            const char *uri = json_string_value(json_object_get(element, "uri"));
            if (uri && strncmp(uri, "data:", 5) != 0 && resolve(model, uri, name, sizeof name) &&
                see(context, name))
                return true;
        }
    }
    return false;
}

static bool is_file(void *context, const char *path)
{
    return input_is_same_file(path, context);
}

bool model_has_file(const char *model, const char *path)
{
    char same[4096];
    if (input_is_same_file(model, path))
        return true;
    if ((size_t)snprintf(same, sizeof same, "%s", path) >= sizeof same)
        return false;
    json_t *root = load_json(model);
    bool is_found = find_file(root, model, is_file, same);
    json_decref(root);
    return is_found;
}

/* ---- files beside an output ---- */

typedef struct known_files {
    struct known_file {
        dev_t device;
        ino_t number;
    } * files;
    size_t count, capacity;
    bool is_full; /* no memory for more */
} known_files;

static bool know_file(void *context, const char *path)
{
    known_files *known = context;
    struct stat info;
    if (stat(path, &info) != 0)
        return false;
    if (known->count == known->capacity) {
        size_t capacity = 2 * known->capacity + 16;
        struct known_file *grown = realloc(known->files, capacity * sizeof *grown);
        known->is_full = !grown;
        if (!grown)
            return true;
        known->files = grown;
        known->capacity = capacity;
    }
    known->files[known->count++] = (struct known_file){info.st_dev, info.st_ino};
    return false;
}

static bool is_known(const known_files *known, const char *path)
{
    struct stat info;
    if (known->is_full)
        return output_exists(path); /* to be safe */
    if (stat(path, &info) != 0)
        return false;
    for (size_t i = 0; i < known->count; i++)
        if (known->files[i].device == info.st_dev && known->files[i].number == info.st_ino)
            return true;
    return false;
}

bool model_loses_file(const char *model, const char *out, char *name, size_t size)
{
    static const char *const extensions[] = {"png", "jpg", "webp", "avif", "ktx2"};
    const char *dot = strrchr(out, '.');
    int length = dot ? (int)(dot - out) : (int)strlen(out);
    known_files known = {0};
    json_t *root = load_json(model);
    size_t image_count = json_array_size(json_object_get(root, "images"));
    find_file(root, model, know_file, &known);
    json_decref(root);
    bool is_lost = (size_t)snprintf(name, size, "%.*s.bin", length, out) < size && is_known(&known, name);
    for (size_t i = 0; i < image_count && !is_lost; i++)
        for (size_t k = 0; k < sizeof extensions / sizeof *extensions && !is_lost; k++)
            is_lost =
                (size_t)snprintf(name, size, "%.*s_image%zu.%s", length, out, i, extensions[k]) < size &&
                is_known(&known, name);
    free(known.files);
    return is_lost;
}
