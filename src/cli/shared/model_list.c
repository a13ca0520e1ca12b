/* model_list.c - see model_list.h. */
#define _DEFAULT_SOURCE
#include "cli/shared/model_list.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/limits.h"

enum { MAX_DEPTH = 64, MAX_LIST_BYTES = 64 << 20 };

/* ---- the list ---- */

/* Keeps text until the list is destroyed; NULL: no memory. */
static char *keep(model_list *list, const char *text)
{
    char **grown = realloc(list->texts, (list->text_count + 1) * sizeof *grown);
    if (!grown)
        return NULL;
    list->texts = grown;
    char *copy = strdup(text);
    if (copy)
        list->texts[list->text_count++] = copy;
    return copy;
}

/* path stays with the caller, or with the list. */
static facet_result add(model_list *list, const char *path, const char *folder, facet_error *error)
{
    if (list->count % 64 == 0) {
        model_name *grown = realloc(list->models, (list->count + 64) * sizeof *grown);
        if (!grown)
            return fail_memory(error, "names of models", 0);
        list->models = grown;
    }
    list->models[list->count++] = (model_name){.path = path, .folder = folder};
    return FACET_OK;
}

/* ---- folders ---- */

static int compare_texts(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* Sorted names in a folder, NULL-terminated. */
static facet_result read_names(const char *path, char ***names, facet_error *error)
{
    size_t count = 0;
    facet_result result = FACET_OK;
    *names = NULL;
    DIR *folder = opendir(path);
    if (!folder)
        return fail(error, FACET_ERROR_READ, "%.400s: the folder cannot be read: %s", path, strerror(errno));
    for (const struct dirent *entry; result == FACET_OK && (entry = readdir(folder));) {
        if (entry->d_name[0] == '.')
            continue;
        char **grown = realloc(*names, (count + 2) * sizeof *grown);
        *names = grown ? grown : *names;
        char *copy = grown ? strdup(entry->d_name) : NULL;
        if (copy)
            (*names)[count++] = copy;
        else
            result = fail_memory(error, "names of models", 0);
    }
    closedir(folder);
    if (*names) {
        qsort(*names, count, sizeof **names, compare_texts);
        (*names)[count] = NULL;
    }
    return result;
}

static void destroy_names(char **names)
{
    for (size_t i = 0; names && names[i]; i++)
        free(names[i]);
    free(names);
}

/* Whether a name in a folder is a model's. */
static bool is_model(const command_line *c, const char *name)
{
    return output_name_has_type(name, c->verb->file_types) && !output_name_has_type(name, "json");
}

typedef struct folder_walk {
    const command_line *c;
    model_list *list;
    unsigned depth;
} folder_walk;

/* Adds the models below path. below is path relative to the named folder. */
static facet_result add_folder(folder_walk *w, const char *path, const char *below, facet_error *error)
{
    char **names;
    facet_result result = read_names(path, &names, error);
    const char *folder = result == FACET_OK ? keep(w->list, below) : NULL;
    if (result == FACET_OK && !folder)
        result = fail_memory(error, "names of models", 0);
    if (result == FACET_OK && ++w->depth > MAX_DEPTH)
        result = fail(error, FACET_ERROR_LIMIT, "%.400s: folders nest deeper than %d", path, MAX_DEPTH);
    size_t length = strlen(path);
    const char *slash = length && path[length - 1] == '/' ? "" : "/";
    for (size_t i = 0; result == FACET_OK && names && names[i]; i++) {
        size_t size = length + strlen(below) + strlen(names[i]) + 3;
        char *inner = malloc(size), *inner_below = malloc(size);
        struct stat link, info;
        if (!inner || !inner_below) {
            result = fail_memory(error, "names of models", 0);
        } else {
            snprintf(inner, size, "%s%s%s", path, slash, names[i]);
            snprintf(inner_below, size, "%s%s%s", below, *below ? "/" : "", names[i]);
            bool is_there = lstat(inner, &link) == 0 && stat(inner, &info) == 0;
            if (is_there && S_ISDIR(link.st_mode)) {
                result = add_folder(w, inner, inner_below, error);
            } else if (is_there && S_ISREG(info.st_mode) && is_model(w->c, names[i])) {
                const char *kept = keep(w->list, inner);
                result = kept ? add(w->list, kept, folder, error) : fail_memory(error, "names of models", 0);
            }
        }
        free(inner);
        free(inner_below);
    }
    w->depth--;
    destroy_names(names);
    return result;
}

void model_folder(const char *path, char *folder)
{
    size_t used = 0;
    for (const char *part = path, *slash; (slash = strchr(part, '/')); part = slash + 1) {
        size_t length = (size_t)(slash - part);
        if (length <= 2 && strncmp(part, "..", length) == 0) /* "", ".", ".." */
            continue;
        if (used)
            folder[used++] = '/';
        memcpy(folder + used, part, length);
        used += length;
    }
    folder[used] = 0;
}

static facet_result add_file(model_list *list, const char *path, facet_error *error)
{
    char *folder = malloc(strlen(path) + 1);
    if (!folder)
        return fail_memory(error, "names of models", 0);
    model_folder(path, folder);
    const char *kept = keep(list, folder);
    free(folder);
    return kept ? add(list, path, kept, error) : fail_memory(error, "names of models", 0);
}

static facet_result add_argument(const command_line *c, const char *path, model_list *list,
                                 facet_error *error)
{
    struct stat info;
    size_t before = list->count;
    if (strcmp(path, "-") == 0 || stat(path, &info) != 0 || !S_ISDIR(info.st_mode))
        return add_file(list, path, error);
    folder_walk walk = {.c = c, .list = list};
    facet_result result = add_folder(&walk, path, "", error);
    if (result == FACET_OK && list->count == before) /* reading it then fails */
        result = add(list, path, "", error);
    return result;
}

/* ---- lists ---- */

/* Adds the lines of the list, or the names between zero bytes (find -print0). */
static facet_result add_lines(const command_line *c, char *text, size_t size, model_list *list,
                              facet_error *error)
{
    char separator = memchr(text, 0, size) ? 0 : '\n';
    facet_result result = FACET_OK;
    for (char *line = text, *end = text + size; line < end && result == FACET_OK;) {
        char *stop = memchr(line, separator, (size_t)(end - line));
        stop = stop ? stop : end;
        *stop = 0;
        if (separator == '\n' && stop > line && stop[-1] == '\r')
            stop[-1] = 0;
        if (*line) {
            const char *kept = keep(list, line);
            result = kept ? add_argument(c, kept, list, error) : fail_memory(error, "names of models", 0);
        }
        line = stop + 1;
    }
    return result;
}

static facet_result add_files_from(const command_line *c, model_list *list, facet_error *error)
{
    const char *path = option_text(c, OPT_FILES_FROM, NULL);
    const char *name = input_name(path);
    bool is_stdin = strcmp(path, "-") == 0;
    for (size_t i = 0; is_stdin && i < c->argument_count; i++)
        if (strcmp(c->arguments[i], "-") == 0)
            return fail(error, FACET_ERROR_ARGUMENT,
                        "--files-from: standard input is a model already; name a file");
    interrupt_begin_reading(name);
    FILE *file = is_stdin ? stdin : fopen(path, "re");
    if (!file)
        return fail(error, FACET_ERROR_READ, "%.400s: %s", name, strerror(errno));
    char *text = malloc(MAX_LIST_BYTES + 1);
    size_t size = text ? fread(text, 1, MAX_LIST_BYTES + 1, file) : 0, before = list->count;
    facet_result result = FACET_OK;
    if (!text)
        result = fail_memory(error, "names of models", 0);
    else if (ferror(file))
        result = fail(error, FACET_ERROR_READ, "%.400s: %s", name, strerror(errno));
    else if (size > MAX_LIST_BYTES)
        result = fail(error, FACET_ERROR_LIMIT,
                      "%.400s: it is larger than 64 MiB; a list of files was expected", name);
    if (!is_stdin)
        fclose(file);
    if (result == FACET_OK)
        result = add_lines(c, text, size, list, error);
    free(text);
    if (result == FACET_OK && list->count == before)
        result = fail(error, FACET_ERROR_ARGUMENT, "--files-from: %.400s names no file", name);
    return result;
}

/* ---- all ---- */

/* Replaces the arguments by the expanded paths. */
static facet_result replace_arguments(command_line *c, size_t argument_count, const model_list *list,
                                      facet_error *error)
{
    size_t rest = c->argument_count - argument_count;
    const char **arguments = malloc((list->count + rest + 1) * sizeof *arguments);
    if (!arguments)
        return fail_memory(error, "names of models", 0);
    for (size_t i = 0; i < list->count; i++)
        arguments[i] = list->models[i].path;
    for (size_t i = 0; i < rest; i++)
        arguments[list->count + i] = c->arguments[argument_count + i];
    free(c->arguments);
    c->arguments = arguments;
    c->argument_count = list->count + rest;
    return FACET_OK;
}

facet_result model_list_create(command_line *c, size_t argument_count, model_list *out, facet_error *error)
{
    *out = (model_list){0};
    facet_result result = limits_start_clock(c, error);
    interrupt_begin("facet", "finding models", false);
    for (size_t i = 0; i < argument_count && result == FACET_OK; i++)
        result = add_argument(c, c->arguments[i], out, error);
    if (result == FACET_OK && is_given(c, OPT_FILES_FROM))
        result = add_files_from(c, out, error);
    interrupt_end();
    if (result == FACET_OK && out->count)
        result = replace_arguments(c, argument_count, out, error);
    if (result == FACET_OK && !out->count)
        result = add(out, NULL, "", error);
    if (result == FACET_OK && !(out->clashes = malloc(out->count * sizeof *out->clashes)))
        result = fail_memory(error, "names of models", 0);
    for (size_t i = 0; i < out->count && result == FACET_OK; i++) {
        out->models[i].number = i + 1;
        out->models[i].count = out->count;
        out->clashes[i] = MODEL_NO_CLASH;
    }
    return result;
}

void model_list_destroy(model_list *list)
{
    for (size_t i = 0; i < list->text_count; i++)
        free(list->texts[i]);
    free(list->texts);
    free(list->models);
    free(list->clashes);
    *list = (model_list){0};
}

/* ---- clashes ---- */

static int compare_claims(const void *a, const void *b)
{
    const output_claim *x = a, *y = b;
    int order = strcmp(x->identity, y->identity);
    return order ? order : x->model < y->model ? -1 : x->model > y->model;
}

void model_list_find_clashes(model_list *list, output_claim *claims, size_t claim_count)
{
    qsort(claims, claim_count, sizeof *claims, compare_claims);
    for (size_t i = 1; i < claim_count; i++) {
        size_t a = claims[i - 1].model, b = claims[i].model;
        if (strcmp(claims[i - 1].identity, claims[i].identity) != 0)
            continue;
        list->clashes[b] = a;
        if (list->clashes[a] == MODEL_NO_CLASH)
            list->clashes[a] = b;
    }
}

facet_result model_list_check_clash(const model_list *list, size_t i, const char *output, facet_error *error)
{
    size_t other = list->clashes[i];
    if (other == MODEL_NO_CLASH)
        return FACET_OK;
    return fail(error, FACET_ERROR_ARGUMENT,
                "%.300s: it and %.300s have the same output %.300s; put {dir}, {name} or {index} in the name",
                input_name(list->models[i].path),
                other == i ? "its report" : input_name(list->models[other].path), output);
}
