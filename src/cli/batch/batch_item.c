/* batch_item.c - see batch_item.h. */
#define _GNU_SOURCE
#include "cli/batch/batch_item.h"

#include "base/hash.h"
#include "cli/batch/batch_tag.h"
#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/model_list.h"
#include "cli/shared/value.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Members of a line that are no options: those of a manifest, and those that --failed adds. */
static const char *const own_members[] = {"input", "model", "output",    "id",      "command",
                                          "cost",  "line",  "exit_code", "message", NULL};

/* Keeps the first problem of an item. */
static void set_problem(batch_item *item, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void set_problem(batch_item *item, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (!item->problem && vasprintf(&item->problem, format, arguments) < 0)
        item->problem = NULL;
    va_end(arguments);
}

/* ---- hashes ---- */

/* 64 bits of two hashes with different seeds. */
typedef struct digest {
    uint32_t a, b;
} digest;

static void digest_add(digest *d, const void *bytes, size_t size)
{
    d->a = murmur3(bytes, size, d->a + 1);
    d->b = murmur3(bytes, size, d->b + 0x5bd1e995u);
}

static void digest_text(digest *d, const char *text)
{
    digest_add(d, text, strlen(text) + 1);
}

/* The bytes of a file; false: it cannot be read, which its job will report. */
static bool digest_file(digest *d, const char *path)
{
    FILE *file = batch_open_regular(path);
    if (!file)
        return false;
    unsigned char block[65536];
    for (size_t n; (n = fread(block, 1, sizeof block, file)) > 0;)
        digest_add(d, block, n);
    bool is_good = !ferror(file);
    fclose(file);
    return is_good;
}

/* Options that do not change what is written. */
static bool is_indifferent(option_id id)
{
    return option_is_among(id, OPTION_IDS(OPT_OUTPUT, OPT_THREADS, OPT_MAX_MEMORY, OPT_QUIET, OPT_VERBOSE,
                                          OPT_PROGRESS, OPT_JSON, OPT_ENV_CACHE, OPT_ISA, OPT_STRICT));
}

/* The settings of a parsed command line in the order of the table of options, so that --size 256 and --size=256 are
 * the same. */
static digest digest_settings(const batch_item *item, const command_line *c)
{
    digest d = {0, 0};
    digest_text(&d, facet_version());
    digest_text(&d, item->verb->name);
    for (int i = 0; i < OPTION_ID_COUNT; i++) {
        const option_value *v = &c->values[i];
        if (!v->count || is_indifferent((option_id)i))
            continue;
        digest_text(&d, option_find_id(item->verb, (option_id)i)->name);
        for (unsigned k = 0; v->texts && k < v->count; k++)
            digest_text(&d, v->texts[k]);
        if (!v->texts)
            digest_text(&d, v->text ? v->text : "");
    }
    for (size_t i = 0; i < c->argument_count; i++)
        digest_text(&d, c->arguments[i]);
    if (is_given(c, OPT_CONFIG)) /* its options are settings as well */
        digest_file(&d, option_text(c, OPT_CONFIG, ""));
    return d;
}

/* ---- words ---- */

static bool is_image_with_metadata(const command_line *c, const char *output)
{
    const char *format = option_text(c, OPT_FORMAT, NULL);
    return format ? strncmp(format, "png", 3) == 0 || strncmp(format, "exr", 3) == 0
                  : output_name_has_type(output, "png png16 exr");
}

/* What the parsed words say. */
static void read_words(const batch_plan *plan, batch_item *item, const command_line *c)
{
    item->has_threads = is_given(c, OPT_THREADS);
    item->has_memory = is_given(c, OPT_MAX_MEMORY);
    item->time_limit_s = plan->time_limit_s;
    if (is_given(c, OPT_TIME_LIMIT)) {
        double seconds = 0.0;
        if (value_seconds(option_text(c, OPT_TIME_LIMIT, ""), &seconds)) /* with time to say so itself */
            item->time_limit_s = seconds > 0.0 ? seconds + (seconds > 20.0 ? 0.1 * seconds : 2.0) : 0.0;
    }
    bool is_render = strcmp(item->verb->name, "render") == 0;
    item->writes_sequence = item->output && output_name_has_frame(item->output);
    item->has_metadata =
        is_render && item->output && !item->writes_sequence && is_image_with_metadata(c, item->output);
}

/* Checks the words by the table of options, and computes the hash. */
static void finish_words(const batch_plan *plan, batch_item *item)
{
    facet_error error;
    command_line line = {.verb = NULL};
    const verb *v = item->verb;
    job_words *w = &item->words;
    if (item->output)
        job_words_addf(w, "--output=%s", item->output);
    if (w->has_failed) {
        set_problem(item, "%s: out of memory", item->name);
        return;
    }
    facet_result result = command_line_parse(v, (int)w->count - 1, w->words + 1, &line, &error);
    if (result == FACET_OK && plan->time_text && !is_given(&line, OPT_TIME_LIMIT) &&
        option_find_id(v, OPT_TIME_LIMIT)) {
        job_words_addf(w, "--time-limit=%s", plan->time_text);
        command_line_destroy(&line);
        result = command_line_parse(v, (int)w->count - 1, w->words + 1, &line, &error);
    }
    if (result != FACET_OK) {
        set_problem(item, "%s: %s", item->place ? item->place : item->name, error.message);
    } else {
        read_words(plan, item, &line);
        digest d = digest_settings(item, &line);
        int length = snprintf(item->hash, sizeof item->hash, "%08x%08x", d.a, d.b);
        digest content = {0, 0};
        if (plan->resume == RESUME_CONTENT && digest_file(&content, item->name))
            snprintf(item->hash + length, sizeof item->hash - (size_t)length, "-%08x%08x", content.a,
                     content.b);
    }
    command_line_destroy(&line);
}

/* Sets the name of the output. pattern NULL: there is none. */
static void set_output(batch_item *item, const char *pattern, const model_name *model)
{
    char name[BATCH_NAME_SIZE];
    const char *label = item->place ? item->place : item->name;
    facet_error error;
    if (!option_find_id(item->verb, OPT_OUTPUT))
        return;
    if (!pattern) {
        if (strcmp(item->verb->name, "compare") != 0)
            set_problem(item, "%s: facet %s needs the name of an output", label, item->verb->name);
        return;
    }
    if (output_name_check(label, pattern, OUTPUT_NAME_WORDS, &error) != FACET_OK)
        set_problem(item, "%s", error.message);
    else if (strcmp(pattern, "-") == 0)
        set_problem(item, "%s: items cannot share standard output; the name of a file was expected", label);
    else if (!output_name_expand(pattern, model, NULL, name, sizeof name))
        set_problem(item, "%s: the name of its output is too long", label);
    else
        item->output = strdup(name);
}

static void set_id(batch_item *item)
{
    const json_t *id = json_object_get(item->source, "id");
    if (json_is_string(id))
        item->id = strdup(json_string_value(id));
    else if (json_is_integer(id)) {
        if (asprintf(&item->id, "%" JSON_INTEGER_FORMAT, json_integer_value(id)) < 0)
            item->id = NULL;
    } else if (id)
        set_problem(item, "%s: id: it must be text or a whole number", item->place);
    if (item->id)
        return;
    json_t *name = report_string_json(item->output ? item->output : item->name); /* as results have it */
    item->id = name ? strdup(json_string_value(name)) : NULL;
    json_decref(name);
}

/* ---- arguments ---- */

static bool is_complete(const batch_item *item)
{
    return item->id && item->name && item->source;
}

batch_item *batch_item_from_model(const batch_plan *plan, const model_name *model, uint64_t number)
{
    batch_item *item = calloc(1, sizeof *item);
    if (!item)
        return NULL;
    *item = (batch_item){.number = number, .verb = plan->verb, .name = strdup(model->path)};
    item->source = json_pack("{s:o}", "input", report_string_json(model->path));
    job_words_add(&item->words, plan->verb->name);
    for (size_t i = 0; i < plan->word_count; i++)
        job_words_add(&item->words, plan->words[i]);
    set_output(item, plan->output, model);
    set_id(item);
    job_words_add(&item->words, model->path);
    if (is_complete(item))
        finish_words(plan, item);
    if (is_complete(item))
        return item;
    batch_item_destroy(item);
    return NULL;
}

/* ---- lines of a manifest ---- */

/* The inputs of a line: text, or a list of texts. The first is the item's name. */
static void add_inputs(batch_item *item, job_words *w)
{
    const json_t *input = json_object_get(item->source, "input");
    if (!input)
        input = json_object_get(item->source, "model");
    size_t count = json_is_array(input) ? json_array_size(input) : input ? 1 : 0;
    for (size_t i = 0; i < count; i++) {
        const char *path = json_string_value(json_is_array(input) ? json_array_get(input, i) : input);
        if (!path || !*path || strcmp(path, "-") == 0) {
            set_problem(item, "%s: input: the name of a file was expected", item->place);
            return;
        }
        if (path[0] == '-')
            job_words_addf(w, "./%s", path);
        else
            job_words_add(w, path);
        if (i == 0)
            item->name = strdup(path);
    }
    if (count == 0 && option_find_id(item->verb, OPT_FILES_FROM)) /* a verb of models */
        set_problem(item, "%s: it has no input", item->place);
}

static void set_command(const batch_plan *plan, batch_item *item)
{
    const json_t *command = json_object_get(item->source, "command");
    item->verb = plan->verb;
    if (!command)
        return;
    const verb *v = json_is_string(command) ? batch_find_command(json_string_value(command)) : NULL;
    if (v)
        item->verb = v;
    else
        set_problem(item, "%s: command: it is none of render, ocean, bake, convert, inspect, plot, compare",
                    item->place);
}

/* Composes the words of a line: those of all items, if they are for its verb; its own; its inputs. */
static void compose(const batch_plan *plan, batch_item *item, const model_name *model)
{
    facet_error error;
    set_command(plan, item);
    job_words_add(&item->words, item->verb->name);
    for (size_t i = 0; i < plan->word_count && item->verb == plan->verb; i++)
        job_words_add(&item->words, plan->words[i]);
    if (job_options_add(&item->words, item->verb, item->source, own_members, item->place, &error) != FACET_OK)
        set_problem(item, "%s", error.message);
    add_inputs(item, &item->words);
    char folder[BATCH_NAME_SIZE];
    model_name named = *model;
    named.path = item->name ? item->name : "";
    if (strlen(named.path) < sizeof folder) {
        model_folder(named.path, folder);
        named.folder = folder;
    }
    const json_t *output = json_object_get(item->source, "output");
    if (output && !json_is_string(output))
        set_problem(item, "%s: output: the name of a file was expected", item->place);
    if (!item->problem)
        set_output(item,
                   output                     ? json_string_value(output)
                   : item->verb == plan->verb ? plan->output
                                              : NULL,
                   &named);
}

batch_item *batch_item_from_line(const batch_plan *plan, const char *line, size_t length, const char *place,
                                 uint64_t number)
{
    json_error_t problem;
    batch_item *item = calloc(1, sizeof *item);
    if (!item)
        return NULL;
    *item = (batch_item){.number = number, .verb = plan->verb, .place = strdup(place)};
    item->source = line ? json_loadb(line, length, JSON_REJECT_DUPLICATES, &problem) : NULL;
    if (!line)
        set_problem(item, "%s: it is longer than 1 MiB", place);
    else if (!item->source)
        set_problem(item, "%s: column %d: %s", place, problem.column, problem.text);
    else if (!json_is_object(item->source))
        set_problem(item, "%s: a JSON object was expected", place);
    else
        compose(plan, item, &(model_name){.number = (size_t)number + 1});
    if (!json_is_object(item->source)) {
        char text[1001] = "";
        if (line)
            snprintf(text, sizeof text, "%.*s", (int)(length < 1000 ? length : 1000), line);
        json_decref(item->source);
        item->source = json_pack("{s:o}", "line", report_string_json(text));
    }
    item->name = item->name ? item->name : strdup(place);
    set_id(item);
    if (is_complete(item) && !item->problem)
        finish_words(plan, item);
    if (is_complete(item))
        return item;
    batch_item_destroy(item);
    return NULL;
}

void batch_item_destroy(batch_item *item)
{
    if (!item)
        return;
    json_decref(item->source);
    free(item->place);
    free(item->id);
    free(item->name);
    free(item->output);
    free(item->problem);
    job_words_destroy(&item->words);
    free(item);
}
