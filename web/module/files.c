/* files.c - see files.h. */
#include "files.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "io/file_source.h"

static struct {
    web_file **items;
    size_t count, capacity;
    unsigned last_number;
} table;

static void destroy(web_file *file)
{
    free(file->path);
    free(file->bytes);
    free(file);
}

/* Files in use stay where they are until close_file(). */
static void remove_at(size_t index)
{
    web_file *file = table.items[index];
    file->is_replaced = true;
    if (file->uses)
        return;
    table.items[index] = table.items[--table.count];
    destroy(file);
}

static size_t find(const char *path)
{
    for (size_t i = 0; i < table.count; i++)
        if (!table.items[i]->is_replaced && strcmp(table.items[i]->path, path) == 0)
            return i;
    return SIZE_MAX;
}

static bool add(web_file *file)
{
    if (table.count == table.capacity) {
        size_t capacity = 2 * table.capacity + 16;
        web_file **grown = realloc(table.items, capacity * sizeof *grown);
        if (!grown)
            return false;
        table.items = grown;
        table.capacity = capacity;
    }
    table.items[table.count++] = file;
    return true;
}

facet_result web_files_put(const char *path, void *bytes, size_t size, facet_error *error)
{
    bool leaves_top = false;
    char *plain = file_source_path(NULL, path, &leaves_top);
    web_file *file = plain ? calloc(1, sizeof *file) : NULL;
    if (file)
        *file = (web_file){strdup(plain), bytes, size, ++table.last_number, 0, false};
    size_t old = plain ? find(plain) : SIZE_MAX;
    mem_free(plain);
    if (old != SIZE_MAX)
        remove_at(old);
    if (file && file->path && add(file))
        return FACET_OK;
    if (file)
        free(file->path);
    free(file);
    free(bytes);
    return leaves_top ? fail(error, FACET_ERROR_ARGUMENT, "%s: the path leads above the topmost folder", path)
                      : fail_memory(error, path, size);
}

void web_files_remove(void)
{
    for (size_t i = table.count; i-- > 0;)
        remove_at(i);
}

/* ---- reading ---- */

static bool open_file(void *user, const char *path, const void **bytes, size_t *size)
{
    (void)user;
    size_t i = find(path);
    if (i == SIZE_MAX)
        return false;
    table.items[i]->uses++;
    *bytes = table.items[i]->bytes;
    *size = table.items[i]->size;
    return true;
}

static void close_file(void *user, const void *bytes, size_t size)
{
    (void)user;
    (void)size;
    for (size_t i = 0; i < table.count; i++) {
        web_file *file = table.items[i];
        if (file->bytes != bytes)
            continue;
        file->uses--;
        if (file->is_replaced)
            remove_at(i);
        return;
    }
}

/* Replaced files have no path that a name could match. */
static const char *list_files(void *user, size_t index)
{
    (void)user;
    return index >= table.count ? NULL : table.items[index]->is_replaced ? "" : table.items[index]->path;
}

facet_file_source web_files_source(void)
{
    return (facet_file_source){.open = open_file, .close = close_file, .list = list_files};
}

const web_file *web_files_find(const char *path, bool *is_alike)
{
    const facet_file_source source = web_files_source();
    bool leaves_top;
    char *plain = file_source_path(NULL, path, &leaves_top);
    size_t i = plain ? find(plain) : SIZE_MAX;
    const char *other = plain && i == SIZE_MAX ? file_source_find_alike(&source, plain) : NULL;
    *is_alike = other != NULL;
    mem_free(plain);
    i = other ? find(other) : i;
    return i == SIZE_MAX ? NULL : table.items[i];
}
