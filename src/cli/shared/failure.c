/* failure.c - sentences, exit codes and JSON of failures. */
#include "cli/shared/failure.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const exit_meaning exit_meanings[] = {
    {"0", "done; the output is complete"},
    {"1", "done, with a negative result: warnings with --strict, an error above --max-error, images beyond "
          "--max or --min, or a failure of some of several models"},
    {"2", "the command line or the file of --config is wrong"},
    {"3", "an input cannot be read: missing, no permission, I/O"},
    {"4", "an input is not valid"},
    {"5", "an input needs a feature that facet lacks"},
    {"6", "the output cannot be written"},
    {"7", "a limit is reached: memory, time, size of a texture or file"},
    {"8", "the machine lacks something"},
    {"70", "a bug in facet"},
    {"75", "there is more to do: interrupted by SIGTERM, or the machine is suspect; run it again"},
    {"128+N", "killed by signal N"},
    {NULL, NULL},
};

int exit_code_of(facet_result result)
{
    switch (result) {
    case FACET_OK:
        return EXIT_DONE;
    case FACET_ERROR_ARGUMENT:
        return EXIT_USAGE;
    case FACET_ERROR_READ:
        return EXIT_READ;
    case FACET_ERROR_INVALID:
        return EXIT_INVALID;
    case FACET_ERROR_UNSUPPORTED:
        return EXIT_UNSUPPORTED;
    case FACET_ERROR_WRITE:
        return EXIT_WRITE;
    case FACET_ERROR_LIMIT:
    case FACET_ERROR_MEMORY:
        return EXIT_LIMIT;
    case FACET_ERROR_SYSTEM:
        return EXIT_ENVIRONMENT;
    case FACET_ERROR_CANCELLED:
        return EXIT_AGAIN;
    case FACET_ERROR_BUG:
        break;
    }
    return EXIT_BUG;
}

void failure_complete(facet_error *error, const char *name, uint64_t limit)
{
    char sentence[sizeof error->message + 256];
    size_t length = strlen(name);
    bool is_named = strncmp(error->message, name, length) == 0 && error->message[length] == ':';
    bool is_general = error->result == FACET_ERROR_MEMORY || error->result == FACET_ERROR_LIMIT;
    int n = snprintf(sentence, sizeof sentence, "%s%s%s", is_general && !is_named ? name : "",
                     is_general && !is_named ? ": " : "", error->message);
    if (strstr(sentence, "(--max-memory)"))
        return; /* complete already */
    if (error->result == FACET_ERROR_MEMORY && limit && n > 0 && (size_t)n < sizeof sentence)
        snprintf(sentence + n, sizeof sentence - (size_t)n, "; the limit is %.6g MiB (--max-memory)",
                 (double)limit / 1048576.0);
    snprintf(error->message, sizeof error->message, "%.1000s", sentence);
}

/* ---- JSON ---- */

/* text with U+FFFD for each byte that is not UTF-8 by jansson's check. */
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
