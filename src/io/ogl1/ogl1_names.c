/* ogl1_names.c - see ogl1_names.h. */
#include "io/ogl1/ogl1_names.h"

#include <stdlib.h>
#include <string.h>

static int compare(const void *a, const void *b)
{
    const ogl1_name *x = a;
    const ogl1_name *y = b;
    int order = strcmp(x->name, y->name);
    return order ? order : (x->entry > y->entry) - (x->entry < y->entry);
}

/* Of a sorted list the last one of each name. */
static void keep_last(ogl1_document *d, bool of_objects, ogl1_names *n)
{
    size_t kept = 0;
    for (size_t i = 0; i < n->count; i++) {
        bool is_last = i + 1 == n->count || strcmp(n->names[i].name, n->names[i + 1].name) != 0;
        if (is_last)
            n->names[kept++] = n->names[i];
        else if (n->names[i].entry != n->names[i + 1].entry)
            io_warn(&d->r, NULL, NULL, "%s \"%.200s\" is there more than once; the last one counts",
                    of_objects ? "object" : "material", n->names[i].name);
    }
    n->count = kept;
}

bool ogl1_names_create(ogl1_document *d, bool of_objects, ogl1_names *out)
{
    size_t count = 0;
    for (uint32_t i = 0; i < d->entry_count; i++)
        count += of_objects ? d->entries[i].object_count : d->entries[i].name != NULL;
    *out = (ogl1_names){.names = mem_alloc(d->r.allocator, count, sizeof *out->names)};
    if (!out->names)
        return false;
    for (uint32_t i = 0; i < d->entry_count; i++) {
        const ogl1_entry *entry = &d->entries[i];
        for (uint32_t k = 0; of_objects && k < entry->object_count; k++)
            out->names[out->count++] = (ogl1_name){.name = entry->objects[k], .entry = i};
        if (!of_objects && entry->name)
            out->names[out->count++] = (ogl1_name){.name = entry->name, .entry = i};
    }
    qsort(out->names, out->count, sizeof *out->names, compare);
    keep_last(d, of_objects, out);
    return true;
}

void ogl1_names_destroy(ogl1_names *n)
{
    mem_free(n->names);
    *n = (ogl1_names){0};
}

uint32_t ogl1_names_find(ogl1_names *n, const char *name)
{
    size_t begin = 0;
    size_t end = n->count;
    while (begin < end) {
        size_t middle = begin + (end - begin) / 2;
        int order = strcmp(n->names[middle].name, name);
        if (order == 0) {
            n->names[middle].is_met = true;
            return n->names[middle].entry;
        }
        if (order < 0)
            begin = middle + 1;
        else
            end = middle;
    }
    return SCENE_NONE;
}
