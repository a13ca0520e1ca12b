/* command_line.h - the parsed command line. */
#ifndef CLI_COMMAND_LINE_H
#define CLI_COMMAND_LINE_H

#include "cli/shared/options.h"
#include "facet/facet.h"

#include <jansson.h>

/* Source of a value. A source later in this list does not replace an earlier one. */
typedef enum option_source { SOURCE_NONE, SOURCE_COMMAND_LINE, SOURCE_CONFIG, SOURCE_PRESET } option_source;

typedef struct option_value {
    const char *text;   /* of the last occurrence; NULL: not given, or a flag */
    const char **texts; /* OPTION_TEXTS: of all, count of them */
    unsigned count;     /* occurrences */
    option_source source;
} option_value;

/* {0}, then command_line_parse(). Strings belong to argv or to the caller of command_line_set(). */
typedef struct command_line {
    const verb *verb;
    option_value values[OPTION_ID_COUNT];
    const char **arguments;              /* words that are not options, in order */
    size_t argument_count, dashed_index; /* arguments[dashed_index] and the following stand after "--" */
    const char *config_name;             /* the file of --config, for messages */
    bool has_attributes;                 /* some options were given as attributes of <model-viewer> */
} command_line;

/* Parses argv (without program and verb). Options stand anywhere before "--"; --name=value, --name value,
 * -xvalue, -x value and -x=value are equivalent; a negative number is a value. Fails with
 * FACET_ERROR_ARGUMENT and one sentence that names the option, suggests another one or states the
 * expectation. */
facet_result command_line_parse(const verb *v, int argc, char **argv, command_line *out, facet_error *error);
void command_line_destroy(command_line *c); /* {0} is allowed */

/* Sets an option from another source, with the same checks, unless an earlier source has set it. text is
 * NULL for a flag. */
facet_result command_line_set(command_line *c, const option *o, const char *text, option_source source,
                              facet_error *error);

static inline bool is_given(const command_line *c, option_id id)
{
    return c->values[id].count > 0;
}
const char *option_text(const command_line *c, option_id id, const char *otherwise);
double option_number(const command_line *c, option_id id, double otherwise);
/* Index of the choice in the option's list; otherwise if the option was not given. */
int option_choice(const command_line *c, option_id id, int otherwise);

/* FACET_ERROR_ARGUMENT with "--size: \"12y\" is not EXPECTED". */
facet_result option_fail(const command_line *c, option_id id, const char *expected, facet_error *error);

/* ---- options from presets and JSON files: config.c ---- */

/* Sets the options of --preset that are not set already. */
facet_result preset_apply(command_line *c, facet_error *error);

/* Storage of the values of a configuration file. {0} initially. */
typedef struct config {
    char **texts;
    size_t text_count;
} config;

/* Sets the options in the file of --config that are not set already: an object whose members are long
 * option names, with true for flags (a number for those that count), text, numbers, or arrays for values
 * with commas. Fails with FACET_ERROR_READ, _LIMIT, or _ARGUMENT (not a JSON object, unknown option, wrong
 * value). */
facet_result config_apply(command_line *c, config *storage, facet_error *error);
void config_destroy(config *storage);

/* A member of such an object in the notation of the command line: the text of a string, a number, or an array of these.
 * False: another type, or too long. */
enum { CONFIG_TEXT_SIZE = 4096 };
bool config_value_text(const json_t *value, char *text, size_t size);
/* The count of a flag: 1 for true, the number for options that count. Negative: neither. */
long config_flag_count(const option *o, const json_t *value);

#endif
