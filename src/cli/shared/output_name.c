/* output_name.c - see output_name.h. */
#include "cli/shared/output_name.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MARK_STEM, MARK_NAME, MARK_DIR, MARK_INDEX, MARK_COUNT };
static const char *const marks[] = {"{stem}", "{name}", "{dir}", "{index}"};

/* Length of the frame number placeholder at text, 0: none; *width is its number of digits. A single #
 * belongs to the name, as in "part#2.png". */
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

bool output_name_has_model(const char *pattern)
{
    for (int i = 0; i < MARK_COUNT; i++)
        if (strstr(pattern, marks[i]))
            return true;
    return false;
}

/* Whether a blank-separated list contains the first length characters of word. */
static bool has_word(const char *words, const char *word, size_t length)
{
    for (; *words; words += strspn(words, " ")) {
        size_t n = strcspn(words, " ");
        if (n == length && memcmp(words, word, n) == 0)
            return true;
        words += n;
    }
    return false;
}

facet_result output_name_check(const char *place, const char *pattern, const char *words, facet_error *error)
{
    for (const char *at = pattern; (at = strchr(at, '{')); at++) {
        size_t length = 0;
        while (isalpha((unsigned char)at[1 + length]))
            length++;
        if (length == 0 || at[1 + length] != '}' || has_word(words, at + 1, length))
            continue;
        char known[128] = "";
        for (const char *w = words; *w; w += strspn(w, " ")) {
            size_t used = strlen(known);
            int n = (int)strcspn(w, " ");
            snprintf(known + used, sizeof known - used, "%s{%.*s}", used ? ", " : "", n, w);
            w += n;
        }
        return fail(error, FACET_ERROR_ARGUMENT, "%s: {%.*s} is not a placeholder; the placeholders are %s",
                    place, (int)(length < 60 ? length : 60), at + 1, known);
    }
    return FACET_OK;
}

/* ---- filling in ---- */

/* A name being composed in a buffer of fixed size. */
typedef struct filling {
    char *name;
    size_t used, size;
    bool is_full;
} filling;

static void put(filling *f, const char *text, size_t length)
{
    f->is_full = f->is_full || length >= f->size - f->used;
    if (f->is_full)
        return;
    memcpy(f->name + f->used, text, length);
    f->used += length;
}

/* Appends the number of the model, as wide as the last one. */
static void put_index(filling *f, const model_name *model)
{
    char number[32], last[32];
    int width = snprintf(last, sizeof last, "%zu", model->count ? model->count : 1);
    int length = snprintf(number, sizeof number, "%0*zu", width, model->number ? model->number : 1);
    put(f, number, (size_t)length);
}

/* Appends the text of a placeholder. */
static void put_model(filling *f, int mark, const model_name *model)
{
    const char *path = !model->path ? "facet" : strcmp(model->path, "-") == 0 ? "stdin" : model->path;
    const char *slash = strrchr(path, '/');
    const char *folder = model->folder ? model->folder : "";
    char stem[1024];
    switch (mark) {
    case MARK_STEM:
        f->is_full = f->is_full || !output_name_stem(path, stem, sizeof stem);
        if (!f->is_full)
            put(f, stem, strlen(stem));
        return;
    case MARK_NAME:
        put(f, slash ? slash + 1 : path, strlen(slash ? slash + 1 : path));
        return;
    case MARK_DIR:
        put(f, folder, strlen(folder));
        return;
    default:
        put_index(f, model);
    }
}

/* The placeholder that text begins with; MARK_COUNT: none. */
static int find_mark(const char *text)
{
    for (int i = 0; i < MARK_COUNT; i++)
        if (strncmp(text, marks[i], strlen(marks[i])) == 0)
            return i;
    return MARK_COUNT;
}

bool output_name_expand(const char *pattern, const model_name *model, const uint32_t *frame, char *name,
                        size_t size)
{
    filling f = {.name = name, .size = size};
    while (*pattern && !f.is_full) {
        char number[128];
        int width, mark = find_mark(pattern);
        size_t place = frame ? frame_mark(pattern, &width) : 0;
        if (place) {
            put(&f, number, (size_t)snprintf(number, sizeof number, "%0*u", width, *frame));
            pattern += place;
        } else if (mark < MARK_COUNT) {
            size_t before = f.used;
            put_model(&f, mark, model);
            pattern += strlen(marks[mark]);
            /* without a folder no slash: '{dir}/{stem}.png' stays below the current folder */
            pattern += mark == MARK_DIR && f.used == before && *pattern == '/';
        } else {
            put(&f, pattern++, 1);
        }
    }
    if (f.is_full || f.used >= size)
        return false;
    name[f.used] = 0;
    return true;
}

/* ---- parts of names ---- */

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
