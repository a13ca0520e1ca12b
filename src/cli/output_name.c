/* output_name.c - the names of pictures: {stem}, #### and %04d. */
#include "cli/output_name.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const char stem_mark[] = "{stem}";

/* Length of the place for a frame number that begins at text, 0: none; *width is how many digits it asks for. A
 * single # is part of a name: people call files "part#2.png". */
static size_t frame_mark(const char *text, int *width)
{
    size_t run = strspn(text, "#");
    if (run >= 2) {
        *width = run > 20 ? 20 : (int)run;
        return run;
    }
    if (text[0] != '%')
        return 0;
    size_t digits = strspn(text + 1, "0123456789");
    if (digits > 2 || text[1 + digits] != 'd')
        return 0;
    *width = digits ? atoi(text + 1) : 1;
    return digits + 2;
}

bool output_name_has_frame(const char *pattern)
{
    int width;
    for (; *pattern; pattern++)
        if (frame_mark(pattern, &width))
            return true;
    return false;
}

bool output_name_has_stem(const char *pattern)
{
    return strstr(pattern, stem_mark) != NULL;
}

/* frame NULL: marks of a frame number are part of the name. */
static bool expand(const char *pattern, const char *stem, const uint32_t *frame, char *name, size_t size)
{
    size_t used = 0;
    while (*pattern) {
        char number[128];
        const char *piece = pattern;
        size_t length = 1, consumed = 1;
        int width;
        size_t mark = frame ? frame_mark(pattern, &width) : 0;
        if (mark) {
            length = (size_t)snprintf(number, sizeof number, "%0*u", width, *frame);
            piece = number;
            consumed = mark;
        } else if (strncmp(pattern, stem_mark, sizeof stem_mark - 1) == 0) {
            piece = stem;
            length = strlen(stem);
            consumed = sizeof stem_mark - 1;
        }
        if (length >= size - used)
            return false;
        memcpy(name + used, piece, length);
        used += length;
        pattern += consumed;
    }
    if (used >= size)
        return false;
    name[used] = 0;
    return true;
}

bool output_name_expand(const char *pattern, const char *stem, uint32_t frame, char *name, size_t size)
{
    return expand(pattern, stem, &frame, name, size);
}

bool output_name_expand_stem(const char *pattern, const char *stem, char *name, size_t size)
{
    return expand(pattern, stem, NULL, name, size);
}

bool output_name_has_type(const char *path, const char *types)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    for (; dot && *types; types += strspn(types, " ")) {
        size_t length = strcspn(types, " ");
        if (strlen(dot + 1) == length && strncasecmp(dot + 1, types, length) == 0)
            return true;
        types += length;
    }
    return false;
}

bool output_name_stem(const char *path, char *stem, size_t size)
{
    const char *slash = strrchr(path, '/');
    const char *base = slash ? slash + 1 : path;
    const char *dot = strrchr(base, '.');
    size_t length = dot && dot != base ? (size_t)(dot - base) : strlen(base);
    if (!length) {
        base = "model";
        length = strlen(base);
    }
    if (length >= size)
        return false;
    memcpy(stem, base, length);
    stem[length] = 0;
    return true;
}
