/* model_files.c - the files that a model names.
 *
 * helmet.gltf with a texture helmet.png beside it is common, and helmet.png is what facet render calls its picture. */
#include "cli/model_files.h"

#include "cli/input.h"

#include <jansson.h>
#include <stdio.h>
#include <string.h>

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

bool model_has_file(const char *model, const char *path)
{
    if (input_is_same_file(model, path))
        return true;
    const char *dot = strrchr(model, '.');
    if (!input_is_same_file(model, model)) /* no regular file: to read a pipe twice would be once too often */
        return false;
    if (!dot || strcmp(dot, ".gltf") != 0)
        return false;
    json_t *root = json_load_file(model, 0, NULL);
    bool is_found = false;
    static const char *const lists[] = {"images", "buffers"};
    for (size_t k = 0; k < 2; k++) {
        size_t i;
        json_t *element;
        json_array_foreach(json_object_get(root, lists[k]), i, element)
        {
            char name[4096];
            const char *uri = json_string_value(json_object_get(element, "uri"));
            if (uri && strncmp(uri, "data:", 5) != 0 && resolve(model, uri, name, sizeof name))
                is_found = is_found || input_is_same_file(name, path);
        }
    }
    json_decref(root);
    return is_found;
}
