/* view_folder.c - see view_folder.h. */
#define _POSIX_C_SOURCE 200809L
#include "view/view_folder.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "base/file.h"
#include "base/memory.h"

enum { MAX_NAMES = 10000, DEEPEST = 2 };

static bool has_extension(const char *path, const char *const *extensions)
{
    const char *extension = path_extension(path);
    for (; *extensions; extensions++)
        if (strcasecmp(extension, *extensions) == 0)
            return true;
    return false;
}

bool view_path_is_model(const char *path)
{
    return has_extension(path, (const char *const[]){"glb", "gltf", "obj", NULL});
}

bool view_path_is_environment(const char *path)
{
    return has_extension(
        path, (const char *const[]){"hdr", "exr", "pfm", "ktx2", "png", "jpg", "jpeg", "webp", "avif", NULL});
}

/* Environment light has high dynamic range: images of eight bits in a folder are more likely textures. */
static bool is_light(const char *path)
{
    return has_extension(path, (const char *const[]){"hdr", "exr", "ktx2", NULL});
}

/* ---- lists ---- */

void view_list_clear(view_list *l)
{
    for (size_t i = 0; i < l->count; i++)
        mem_free(l->names[i]);
    mem_free(l->names);
    *l = (view_list){.allocator = l->allocator};
}

/* Takes ownership of name. */
static bool add(view_list *l, char *name)
{
    bool fits =
        name && mem_reserve(&l->allocator, (void **)&l->names, &l->capacity, l->count + 1, sizeof *l->names);
    if (!fits) {
        mem_free(name);
        return false;
    }
    l->names[l->count++] = name;
    return true;
}

static char *copy_of(const view_list *l, const char *name)
{
    size_t size = strlen(name) + 1;
    char *copy = mem_alloc(&l->allocator, size, 1);
    if (copy)
        memcpy(copy, name, size);
    return copy;
}

static bool add_copy(view_list *l, const char *name)
{
    return add(l, copy_of(l, name));
}

/* Numbers in names sort by value: ball2 before ball10. */
static int compare_names(const void *a, const void *b)
{
    const char *x = *(char *const *)a;
    const char *y = *(char *const *)b;
    while (*x && *y) {
        bool are_figures = *x >= '0' && *x <= '9' && *y >= '0' && *y <= '9';
        if (are_figures) {
            size_t zeros_x = strspn(x, "0");
            size_t zeros_y = strspn(y, "0");
            size_t length_x = strspn(x + zeros_x, "0123456789");
            size_t length_y = strspn(y + zeros_y, "0123456789");
            if (length_x != length_y)
                return length_x < length_y ? -1 : 1;
            int order = strncmp(x + zeros_x, y + zeros_y, length_x);
            if (order)
                return order;
            x += zeros_x + length_x;
            y += zeros_y + length_y;
            continue;
        }
        if (*x != *y)
            return (unsigned char)*x < (unsigned char)*y ? -1 : 1;
        x++;
        y++;
    }
    return (*x != 0) - (*y != 0);
}

bool view_path_is_folder(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

/* Appends the matching files of a folder, by name. depth: how many folders further down it looks where it
 * has none itself. */
static bool add_folder(view_list *l, const char *folder, bool (*is_wanted)(const char *), int depth)
{
    DIR *directory = opendir(folder);
    view_list folders = {.allocator = l->allocator};
    size_t first = l->count;
    bool fits = true;
    struct dirent *entry;
    while (fits && directory && l->count < MAX_NAMES && (entry = readdir(directory)) != NULL) {
        if (entry->d_name[0] == '.')
            continue;
        char *path = path_join(&l->allocator, folder, entry->d_name);
        if (path && view_path_is_folder(path))
            fits = add(&folders, path);
        else if (is_wanted(entry->d_name))
            fits = add(l, path);
        else
            mem_free(path);
    }
    if (directory)
        closedir(directory);
    if (l->count > first)
        qsort(l->names + first, l->count - first, sizeof *l->names, compare_names);
    else if (folders.count && depth > 0) {
        qsort(folders.names, folders.count, sizeof *folders.names, compare_names);
        for (size_t i = 0; fits && i < folders.count; i++)
            fits = add_folder(l, folders.names[i], is_wanted, depth - 1);
    }
    view_list_clear(&folders);
    return fits;
}

static bool is_same_file(const char *a, const char *b)
{
    struct stat x;
    struct stat y;
    return strcmp(a, b) == 0 ||
           (stat(a, &x) == 0 && stat(b, &y) == 0 && x.st_dev == y.st_dev && x.st_ino == y.st_ino);
}

static size_t find(const view_list *l, const char *path)
{
    for (size_t i = 0; i < l->count; i++)
        if (is_same_file(l->names[i], path))
            return i;
    return l->count;
}

/* The matching files in path's folder; path is among them whatever its extension is. */
static bool add_neighbours(view_list *l, const char *path, bool (*is_wanted)(const char *))
{
    char *folder = path_folder(&l->allocator, path);
    bool fits = folder && add_folder(l, folder, is_wanted, 0);
    mem_free(folder);
    l->at = find(l, path);
    if (!fits || l->at == l->count)
        return fits && add_copy(l, path);
    char *as_given = copy_of(l, path); /* not ./path */
    if (as_given) {
        mem_free(l->names[l->at]);
        l->names[l->at] = as_given;
    }
    return as_given != NULL;
}

bool view_list_models(view_list *l, const char *const *paths, uint32_t path_count)
{
    view_list_clear(l);
    if (path_count == 1 && !view_path_is_folder(paths[0]))
        return strcmp(paths[0], "-") == 0 ? add_copy(l, paths[0])
                                          : add_neighbours(l, paths[0], view_path_is_model);
    bool fits = true;
    for (uint32_t i = 0; fits && i < path_count; i++)
        fits = view_path_is_folder(paths[i]) ? add_folder(l, paths[i], view_path_is_model, DEEPEST)
                                             : add_copy(l, paths[i]);
    return fits;
}

bool view_list_environments(view_list *l, const char *const *names, uint32_t name_count, const char *path)
{
    view_list_clear(l);
    bool fits = true;
    for (uint32_t i = 0; fits && i < name_count; i++)
        fits = add_copy(l, names[i]);
    l->at = path ? find(l, path) : 0;
    if (fits && path && l->at == l->count)
        fits = add_neighbours(l, path, is_light);
    return fits;
}

const char *view_list_step(view_list *l, int steps)
{
    if (l->count == 0)
        return NULL;
    size_t at = l->at;
    if (at >= l->count)
        at = steps > 0 ? l->count - 1 : 0;
    size_t count = l->count;
    size_t forward = steps >= 0 ? (size_t)steps % count : count - (size_t)-steps % count;
    l->at = (at + forward) % count;
    return l->names[l->at];
}
