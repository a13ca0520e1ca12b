/* command_line.c - parses options; a mistyped option gets one suggestion. */
#include "cli/shared/command_line.h"

#include "cli/shared/failure.h"
#include "cli/shared/output.h"
#include "cli/shared/suggest.h"
#include "cli/shared/value.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- values ---- */

/* Index of the first length characters of text in the choices; -1: none. */
static int find_choice(const option *o, const char *text, size_t length)
{
    for (int i = 0; o->choices[i]; i++)
        if (strlen(o->choices[i]) == length && memcmp(o->choices[i], text, length) == 0)
            return i;
    return -1;
}

static facet_result fail_choice(const char *label, const option *o, const char *text, facet_error *error)
{
    char list[256] = "";
    for (int i = 0; o->choices[i]; i++) {
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "", o->choices[i]);
    }
    const char *near = suggest_word(text, o->choices);
    if (near)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: \"%s\" is none of %s; did you mean %s?", label, text,
                    list, near);
    return fail(error, FACET_ERROR_ARGUMENT, "%s: \"%s\" is none of %s", label, text, list);
}

static facet_result check_choices(const char *label, const option *o, const char *text, facet_error *error)
{
    for (const char *at = text;; at++) {
        size_t length = strcspn(at, ",");
        if (find_choice(o, at, length) < 0)
            return fail_choice(label, o, text, error);
        at += length;
        if (!*at)
            return FACET_OK;
    }
}

static facet_result check_number(const char *label, const option *o, const char *text, facet_error *error)
{
    double number;
    const char *kind = o->kind == OPTION_INTEGER ? "whole number" : "number";
    bool is_good = value_number(text, &number) && number >= o->minimum && number <= o->maximum;
    if (is_good && o->kind == OPTION_INTEGER)
        is_good = number == (double)(long long)number;
    if (is_good)
        return FACET_OK;
    return fail(error, FACET_ERROR_ARGUMENT, "%s: \"%s\" is not a %s from %.10g to %.10g", label, text, kind,
                o->minimum, o->maximum);
}

/* The subject of a message: "--size", or "thumb.json: size" for a value of a configuration file. */
static void label_of(const command_line *c, const option *o, option_source source, char *label, size_t size)
{
    if (source == SOURCE_CONFIG)
        snprintf(label, size, "%s: %s", c->config_name, o->name);
    else
        snprintf(label, size, "--%s", o->name);
}

/* Sets an option and replaces an earlier value of the same source. */
static facet_result set(command_line *c, const option *o, const char *text, option_source source,
                        facet_error *error)
{
    char label[512];
    label_of(c, o, source, label, sizeof label);
    facet_result result = FACET_OK;
    if (option_takes_value(o) && !*text && o->id != OPT_TITLE)
        result = fail(error, FACET_ERROR_ARGUMENT, "%s: the %s is empty", label, o->argument);
    else if ((o->kind == OPTION_CHOICE || (o->kind == OPTION_SWITCH && text)) &&
             find_choice(o, text, strlen(text)) < 0)
        result = fail_choice(label, o, text, error);
    else if (o->kind == OPTION_CHOICES)
        result = check_choices(label, o, text, error);
    else if (o->kind == OPTION_NUMBER || o->kind == OPTION_INTEGER)
        result = check_number(label, o, text, error);
    if (result != FACET_OK)
        return result;
    option_value *value = &c->values[o->id];
    if (o->kind == OPTION_TEXTS) {
        const char **grown = realloc(value->texts, (value->count + 1) * sizeof *grown);
        if (!grown)
            return fail(error, FACET_ERROR_MEMORY, "out of memory: options");
        value->texts = grown;
        value->texts[value->count] = text;
    }
    value->text = text;
    value->count++;
    value->source = source;
    return FACET_OK;
}

facet_result command_line_set(command_line *c, const option *o, const char *text, option_source source,
                              facet_error *error)
{
    if (c->values[o->id].count && c->values[o->id].source != source)
        return FACET_OK;
    return set(c, o, text, source, error);
}

/* ---- options ---- */

/* Whether the word after an option that takes a value is the next option instead: "-o --size". */
static bool looks_like_option(const char *word)
{
    if (word[0] != '-' || word[1] == 0)
        return false;
    return !((word[1] >= '0' && word[1] <= '9') || word[1] == '.');
}

/* Reads the value of o, which may be the next word. given is the option as typed, for messages. */
static facet_result parse_value(command_line *c, const option *o, const char *given, const char *value,
                                int argc, char **argv, int *at, facet_error *error)
{
    if (!value) {
        if (*at + 1 >= argc)
            return fail(error, FACET_ERROR_ARGUMENT, "%s: the %s is missing", given, o->argument);
        if (looks_like_option(argv[*at + 1]))
            return fail(error, FACET_ERROR_ARGUMENT,
                        "%s: the %s is missing; if it is to begin with a dash, write --%s=%s", given,
                        o->argument, o->name, argv[*at + 1]);
        value = argv[++*at];
    }
    return set(c, o, value, SOURCE_COMMAND_LINE, error);
}

static facet_result parse_long(command_line *c, int argc, char **argv, int *at, facet_error *error)
{
    const char *name = argv[*at] + 2;
    size_t length = strcspn(name, "=");
    const char *value = name[length] == '=' ? name + length + 1 : NULL;
    const option *o = option_find(c->verb, name, length);
    if (!o) {
        o = option_find_attribute(c->verb, name, length);
        c->has_attributes = c->has_attributes || o;
    }
    if (!o)
        return suggest_option(c->verb, name, length, error);
    if (option_takes_value(o)) {
        char given[64];
        snprintf(given, sizeof given, "--%s", o->name);
        return parse_value(c, o, given, value, argc, argv, at, error);
    }
    if (value && o->kind != OPTION_SWITCH)
        return fail(error, FACET_ERROR_ARGUMENT, "--%s: it takes no value, but got \"%s\"", o->name, value);
    return set(c, o, value, SOURCE_COMMAND_LINE, error);
}

/* One word of letters: -vv, -n16, -qs 640. */
static facet_result parse_letters(command_line *c, int argc, char **argv, int *at, facet_error *error)
{
    const char *word = argv[*at];
    size_t length = strcspn(word + 1, "=");
    if (length >= 3 && option_find(c->verb, word + 1, length)) /* -size is not -s with the value "ize" */
        return fail(error, FACET_ERROR_ARGUMENT, "unknown option %s; did you mean -%s?", word, word);
    const char *foreign = length >= 4 ? suggest_foreign(c->verb, word + 1, length) : NULL;
    if (foreign) /* -outCubeMap is not -o with the value "utCubeMap" */
        return fail(error, FACET_ERROR_ARGUMENT, "unknown option %s; did you mean %s?", word, foreign);
    for (const char *letter = word + 1; *letter; letter++) {
        const option *o = option_find_letter(c->verb, *letter);
        if (!o)
            return suggest_letter(c->verb, *letter, error);
        if (option_takes_value(o)) {
            char given[] = {'-', *letter, 0};
            const char *value = letter[1] ? letter + 1 + (letter[1] == '=') : NULL;
            return parse_value(c, o, given, value, argc, argv, at, error);
        }
        facet_result result = set(c, o, NULL, SOURCE_COMMAND_LINE, error);
        if (result != FACET_OK)
            return result;
    }
    return FACET_OK;
}

/* ---- arguments ---- */

/* Whether an argument names an output: "render in.glb out.png". Where inputs and outputs share extensions,
 * only a surplus argument is taken for an output. */
static bool is_output(const command_line *c, size_t index)
{
    const verb *v = c->verb;
    const char *word = c->arguments[index];
    if (is_given(c, OPT_OUTPUT) || !v->output_types || !output_name_has_type(word, v->output_types))
        return false;
    if (index >= v->max_arguments)
        return true;
    bool is_input_type = v->file_types && output_name_has_type(word, v->file_types);
    return !is_input_type && (index > 0 || !output_exists(word));
}

static facet_result check_arguments(const command_line *c, facet_error *error)
{
    const verb *v = c->verb;
    for (size_t i = 0; i < c->argument_count; i++)
        if (is_output(c, i))
            return fail(error, FACET_ERROR_ARGUMENT, "%s: \"%s\" is not an input; did you mean %s %s?",
                        v->name, c->arguments[i], v->output_hint ? v->output_hint : "-o", c->arguments[i]);
    if (c->argument_count > v->max_arguments)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: it takes at most %zu %s%s, but got \"%s\"", v->name,
                    v->max_arguments, v->file_types ? "file" : "argument", v->max_arguments == 1 ? "" : "s",
                    c->arguments[v->max_arguments]);
    return FACET_OK;
}

facet_result command_line_parse(const verb *v, int argc, char **argv, command_line *out, facet_error *error)
{
    *out = (command_line){.verb = v};
    out->arguments = malloc(((size_t)argc + 1) * sizeof *out->arguments);
    if (!out->arguments)
        return fail(error, FACET_ERROR_MEMORY, "out of memory: %d arguments", argc);
    bool has_options = true;
    for (int at = 0; at < argc; at++) {
        const char *word = argv[at];
        facet_result result = FACET_OK;
        if (!has_options || word[0] != '-' || word[1] == 0)
            out->arguments[out->argument_count++] = word;
        else if (strcmp(word, "--") == 0)
            has_options = false, out->dashed_index = out->argument_count;
        else if (word[1] == '-')
            result = parse_long(out, argc, argv, &at, error);
        else
            result = parse_letters(out, argc, argv, &at, error);
        if (result != FACET_OK)
            return result;
        if (is_given(out, OPT_HELP) || (is_given(out, OPT_HELP_ALL) && strcmp(v->name, "help") != 0))
            return FACET_OK; /* help wins over the rest of the line */
    }
    if (has_options)
        out->dashed_index = out->argument_count;
    return check_arguments(out, error);
}

void command_line_destroy(command_line *c)
{
    for (int i = 0; i < OPTION_ID_COUNT; i++)
        free(c->values[i].texts);
    free(c->arguments);
    *c = (command_line){0};
}

/* ---- reading ---- */

const char *option_text(const command_line *c, option_id id, const char *otherwise)
{
    return c->values[id].text ? c->values[id].text : otherwise;
}

double option_number(const command_line *c, option_id id, double otherwise)
{
    double number = otherwise;
    if (c->values[id].text)
        value_number(c->values[id].text, &number);
    return number;
}

int option_choice(const command_line *c, option_id id, int otherwise)
{
    const char *text = c->values[id].text;
    return text ? find_choice(option_find_id(c->verb, id), text, strlen(text)) : otherwise;
}

facet_result option_fail(const command_line *c, option_id id, const char *expected, facet_error *error)
{
    char label[512];
    label_of(c, option_find_id(c->verb, id), c->values[id].source, label, sizeof label);
    return fail(error, FACET_ERROR_ARGUMENT, "%s: \"%s\" is not %s", label, option_text(c, id, ""), expected);
}
