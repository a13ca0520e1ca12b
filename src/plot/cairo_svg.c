/* cairo_svg.c - see cairo_svg.h. */
#include "plot/cairo_svg.h"

#include <string.h>

#include "base/memory.h"

/* The names that cairo counts through its life. */
static const char *const COUNTED[] = {"surface", "image"};
enum { COUNTED_COUNT = 2 };

/* The numbers of one of them, in the order in which they come. */
typedef struct id_list {
    unsigned long *ids;
    size_t count, capacity;
} id_list;

/* The place of id in the list, from 1; 0: out of memory. */
static size_t renumber(id_list *list, const facet_allocator *allocator, unsigned long id)
{
    for (size_t i = 0; i < list->count; i++)
        if (list->ids[i] == id)
            return i + 1;
    if (!mem_reserve(allocator, (void **)&list->ids, &list->capacity, list->count + 1, sizeof *list->ids))
        return 0;
    list->ids[list->count++] = id;
    return list->count;
}

/* Which counted name stands at p, with a number behind; -1: none. */
static int counted_at(const char *p, const char *end)
{
    for (int i = 0; i < COUNTED_COUNT; i++) {
        size_t length = strlen(COUNTED[i]);
        if ((size_t)(end - p) > length && memcmp(p, COUNTED[i], length) == 0 && p[length] >= '0' &&
            p[length] <= '9')
            return i;
    }
    return -1;
}

static bool copy_renumbered(text *out, const char *from, const char *end, id_list lists[COUNTED_COUNT])
{
    const char *copied = from;
    for (const char *p = from; p < end; p++) {
        if (*p != '"' && *p != '#') /* id="image5", xlink:href="#image5", url(#image5) */
            continue;
        int name = counted_at(p + 1, end);
        if (name < 0)
            continue;
        const char *digits = p + 1 + strlen(COUNTED[name]), *after = digits;
        unsigned long id = 0;
        for (; after < end && *after >= '0' && *after <= '9'; after++)
            id = 10 * id + (unsigned long)(*after - '0');
        size_t number = renumber(&lists[name], &out->allocator, id);
        if (number == 0)
            return false;
        text_add_bytes(out, copied, (size_t)(digits - copied));
        text_addf(out, "%zu", number);
        copied = after;
        p = after - 1;
    }
    text_add_bytes(out, copied, (size_t)(end - copied));
    return true;
}

static void add_title(text *out, const char *title)
{
    text_add(out, "\n<title>");
    for (const char *p = title; *p; p++)
        if (*p == '<')
            text_add(out, "&lt;");
        else if (*p == '>')
            text_add(out, "&gt;");
        else if (*p == '&')
            text_add(out, "&amp;");
        else
            text_add_bytes(out, p, 1);
    text_add(out, "</title>");
}

bool cairo_svg_tidy(text *svg, const char *title)
{
    if (!svg->data)
        return true;
    text out = {.allocator = svg->allocator};
    id_list lists[COUNTED_COUNT] = {0};
    const char *end = svg->data + svg->length, *root = strstr(svg->data, "<svg");
    const char *head = root ? strchr(root, '>') : NULL;
    head = head ? head + 1 : svg->data;
    text_add_bytes(&out, svg->data, (size_t)(head - svg->data));
    if (title && *title && root)
        add_title(&out, title);
    bool is_done = copy_renumbered(&out, head, end, lists) && !out.has_failed;
    for (int i = 0; i < COUNTED_COUNT; i++)
        mem_free(lists[i].ids);
    if (!is_done) {
        text_destroy(&out);
        return false;
    }
    text_destroy(svg);
    *svg = out;
    return true;
}
