/* command_line.h - what the user typed, against the option table. */
#ifndef CLI_COMMAND_LINE_H
#define CLI_COMMAND_LINE_H

#include "cli/shared/options.h"
#include "facet/facet.h"

/* Who set an option; a later one does not replace an earlier one. */
typedef enum option_source { SOURCE_NONE, SOURCE_COMMAND_LINE, SOURCE_CONFIG, SOURCE_PRESET } option_source;

typedef struct option_value {
    const char *text; /* the last one given; NULL: not given, or a flag */
    unsigned count;   /* how often it was given */
    option_source source;
} option_value;

/* {0}, then command_line_parse(). Strings belong to argv or to whoever called command_line_set(). */
typedef struct command_line {
    const verb *verb;
    option_value values[OPTION_ID_COUNT];
    const char **arguments; /* what is no option, in order */
    size_t argument_count;
    const char *config_name; /* for messages on values from there */
    bool has_attributes;     /* some options were given by the names that <model-viewer> has for them */
} command_line;

/* Reads argv (without program and verb). Options stand anywhere until "--"; --name=value, --name value, -xvalue,
 * -x value and -x=value are the same; what looks like a negative number is a value. Fails with
 * FACET_ERROR_ARGUMENT and one sentence that names the option, suggests another or says what was expected. */
facet_result command_line_parse(const verb *v, int argc, char **argv, command_line *out, facet_error *error);
void command_line_destroy(command_line *c); /* {0} is allowed */

/* Sets one option from elsewhere unless it is set already; text NULL for a flag. Same checks as on the command
 * line. */
facet_result command_line_set(command_line *c, const option *o, const char *text, option_source source,
                              facet_error *error);

static inline bool is_given(const command_line *c, option_id id)
{
    return c->values[id].count > 0;
}
const char *option_text(const command_line *c, option_id id, const char *otherwise);
double option_number(const command_line *c, option_id id, double otherwise);
/* Position of a choice in the table's list, or otherwise where the option was not given. */
int option_choice(const command_line *c, option_id id, int otherwise);

/* FACET_ERROR_ARGUMENT with "--size: \"12y\" is not EXPECTED". */
facet_result option_fail(const command_line *c, option_id id, const char *expected, facet_error *error);

#endif
