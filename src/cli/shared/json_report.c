/* json_report.c - see json_report.h. */
#include "cli/shared/json_report.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* text with U+FFFD for each byte that is no UTF-8; jansson tells what is. */
static json_t *replace_others(const char *text)
{
    const char replacement[] = "\xef\xbf\xbd";
    char *copy = malloc(3 * strlen(text) + 1);
    size_t used = 0;
    while (copy && *text) {
        size_t length = 1;
        json_t *character = NULL;
        while (length <= 4 && !memchr(text, 0, length) && !(character = json_stringn(text, length)))
            length++;
        memcpy(copy + used, character ? text : replacement, character ? length : 3);
        used += character ? length : 3;
        text += character ? length : 1;
        json_decref(character);
    }
    json_t *string = copy ? json_stringn(copy, used) : NULL;
    free(copy);
    return string;
}

json_t *report_string_json(const char *text)
{
    json_t *string = text ? json_string(text) : NULL;
    if (text && !string)
        string = replace_others(text);
    return string ? string : json_null();
}

json_t *report_warnings_json(const messages *m)
{
    json_t *list = json_array();
    for (size_t i = 0; i < m->warning_count; i++) {
        json_array_append_new(list, json_pack("{s:o, s:I}", "text", report_string_json(m->warnings[i].text),
                                              "count", (json_int_t)m->warnings[i].count));
    }
    return list;
}

json_t *report_error_json(const facet_error *error, const char *model, int exit_code)
{
    if (model)
        return json_pack("{s:o, s:o, s:i}", "model", report_string_json(model), "message",
                         report_string_json(error->message), "exit_code", exit_code);
    return json_pack("{s:o, s:i}", "message", report_string_json(error->message), "exit_code", exit_code);
}

void report_print_json(const json_t *root)
{
    json_dumpf(root, stdout, JSON_REAL_PRECISION(9));
    putchar('\n');
}

void report_print_failure_json(const facet_error *error, int exit_code)
{
    json_t *root = json_pack("{s:s, s:[o], s:i}", "facet", facet_version(), "failures",
                             report_error_json(error, NULL, exit_code), "exit_code", exit_code);
    report_print_json(root);
    json_decref(root);
}
