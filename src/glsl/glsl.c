/* glsl.c - the shader library as GLSL: all of it, or some parts with their dependencies. */
#include <stdlib.h>
#include <string.h>

#include "facet/facet.h"

#include "base/memory.h"
#include "base/result.h"
#include "base/text.h"

/* A header of shade/. */
typedef struct glsl_part {
    const char *name, *text;
} glsl_part;

#include "glsl_text.h"

enum { PART_COUNT = sizeof parts / sizeof *parts };
static const char *const versions[] = {"300 es", "310 es", "320 es", "330", "400", "410",
                                       "420",    "430",    "440",    "450", "460", NULL};

/* ---- dependencies of parts ---- */

static bool is_name_start(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static bool is_name(char c)
{
    return is_name_start(c) || (c >= '0' && c <= '9');
}

/* A word of a text. */
typedef struct word {
    const char *start;
    size_t length;
} word;

static bool is_word(word w, const char *name)
{
    return strlen(name) == w.length && memcmp(w.start, name, w.length) == 0;
}

/* The next word after *at outside comments; length 0: there is none. */
static word next_word(const char **at)
{
    const char *c = *at;
    while (*c && !is_name_start(*c)) {
        if (strncmp(c, "/*", 2) == 0) {
            const char *end = strstr(c + 2, "*/");
            c = end ? end + 2 : c + strlen(c);
        } else if (is_name(*c)) { /* a number, with its suffix */
            while (is_name(*c) || *c == '.')
                c++;
        } else {
            c++;
        }
    }
    word w = {c, 0};
    while (is_name(c[w.length]))
        w.length++;
    *at = c + w.length;
    return w;
}

/* What a part defines: a function, a structure or a macro. */
typedef struct definition {
    word name;
    size_t part;
} definition;

typedef struct definitions {
    definition *items; /* sorted by name */
    size_t count, capacity;
} definitions;

static int compare_definitions(const void *a, const void *b)
{
    const word x = ((const definition *)a)->name, y = ((const definition *)b)->name;
    int order = memcmp(x.start, y.start, x.length < y.length ? x.length : y.length);
    return order ? order : (x.length > y.length) - (x.length < y.length);
}

static bool find_definitions(const facet_allocator *allocator, definitions *d)
{
    for (size_t i = 0; i < PART_COUNT; i++) {
        const char *at = parts[i].text;
        for (word w = next_word(&at); w.length; w = next_word(&at)) {
            bool is_function = is_word(w, "FN");
            if (!is_function && !is_word(w, "STRUCT") && !is_word(w, "define"))
                continue;
            if (is_function)
                next_word(&at); /* the type it returns */
            if (!mem_reserve(allocator, (void **)&d->items, &d->capacity, d->count + 1, sizeof *d->items))
                return false;
            d->items[d->count++] = (definition){next_word(&at), i};
        }
    }
    qsort(d->items, d->count, sizeof *d->items, compare_definitions);
    return true;
}

/* Marks everything that the marked parts use. A part uses only earlier ones. */
static bool close_parts(const facet_allocator *allocator, bool is_wanted[PART_COUNT])
{
    definitions d = {0};
    bool is_found = find_definitions(allocator, &d);
    for (size_t i = PART_COUNT; is_found && i-- > 0;) {
        const char *at = parts[i].text;
        for (word w = next_word(&at); is_wanted[i] && w.length; w = next_word(&at)) {
            const definition key = {w, 0};
            const definition *used = bsearch(&key, d.items, d.count, sizeof key, compare_definitions);
            if (used)
                is_wanted[used->part] = true;
        }
    }
    mem_free(d.items);
    return is_found;
}

/* ---- the functions of facet.h ---- */

uint32_t facet_shader_get_part_count(void)
{
    return PART_COUNT;
}

const char *facet_shader_get_part_name(uint32_t index)
{
    return index < PART_COUNT ? parts[index].name : NULL;
}

/* Whether version begins with a GLSL version that the text compiles as; "core" may follow it. */
static bool is_version(const char *version)
{
    for (const char *const *v = versions; *v; v++) {
        size_t length = strlen(*v);
        if (strncmp(version, *v, length) == 0 &&
            (version[length] == 0 || (!strstr(*v, "es") && strcmp(version + length, " core") == 0)))
            return true;
    }
    return false;
}

/* PART_COUNT: there is none. */
static size_t part_index(const char *name)
{
    size_t i = 0;
    while (i < PART_COUNT && strcmp(parts[i].name, name) != 0)
        i++;
    return i;
}

static facet_result find_parts(const facet_shader_desc *desc, bool is_wanted[PART_COUNT], facet_error *error)
{
    static const char *const khronos[] = {"brdf", "fresnel", "anisotropy", "sheen"};
    bool is_khronos = desc->names == FACET_SHADER_NAMES_KHRONOS;
    bool is_whole = desc->part_count == 0 && !is_khronos;
    for (size_t i = 0; i < PART_COUNT; i++)
        is_wanted[i] = is_whole;
    for (size_t k = 0; is_khronos && k < sizeof khronos / sizeof *khronos; k++)
        is_wanted[part_index(khronos[k])] = true;
    for (uint32_t k = 0; k < desc->part_count; k++) {
        size_t i = part_index(desc->parts[k]);
        if (i == PART_COUNT)
            return fail(error, FACET_ERROR_ARGUMENT, "the shader library has no part \"%.60s\"",
                        desc->parts[k]);
        is_wanted[i] = true;
    }
    return is_whole || close_parts(&desc->allocator, is_wanted)
               ? FACET_OK
               : fail_memory(error, "shader library", PART_COUNT * sizeof *parts);
}

facet_result facet_shader_text(const facet_shader_desc *desc, unsigned char **bytes, size_t *size,
                               facet_error *error)
{
    static const facet_shader_desc all;
    desc = desc ? desc : &all;
    *bytes = NULL;
    *size = 0;
    if (desc->version && !is_version(desc->version))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "GLSL \"%.40s\": 300 es to 320 es and 330 to 460 were expected", desc->version);
    bool is_wanted[PART_COUNT];
    facet_result result = find_parts(desc, is_wanted, error);
    if (result != FACET_OK)
        return result;
    text t = {.allocator = desc->allocator};
    if (desc->version)
        text_addf(&t, "#version %s\n", desc->version);
    text_add(&t, "/* The shader library of facet " FACET_VERSION ", under the Apache License 2.0. */\n");
    bool is_khronos = desc->names == FACET_SHADER_NAMES_KHRONOS;
    text_add(&t, (const char *)text_0);
    if (is_khronos)
        text_add(&t, (const char *)khronos_begin);
    for (size_t i = 0; i < PART_COUNT; i++)
        if (is_wanted[i])
            text_add(&t, parts[i].text);
    if (is_khronos)
        text_add(&t, (const char *)khronos_end);
    if (t.has_failed) {
        text_destroy(&t);
        return fail_memory(error, "shader library", t.length);
    }
    *bytes = (unsigned char *)t.data;
    *size = t.length;
    return FACET_OK;
}
