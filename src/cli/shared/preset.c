/* preset.c - several options in one word. */
#define _DEFAULT_SOURCE
#include "cli/shared/preset.h"

#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

typedef struct setting {
    option_id id;
    const char *text; /* NULL for flags */
} setting;

/* For file managers: small, bounded, silent. */
static const setting thumbnail[] = {
    {OPT_SIZE, "256"}, {OPT_BACKGROUND, "transparent"}, {OPT_MAX_MEMORY, "1G"}};

facet_result preset_apply(command_line *c, facet_error *error)
{
    if (!is_given(c, OPT_PRESET))
        return FACET_OK;
    static char limit[32]; /* 5 s for each model; a command line lives as long as the process */
    snprintf(limit, sizeof limit, "%zus", 5 * (c->argument_count ? c->argument_count : 1));
    facet_result result =
        command_line_set(c, option_find_id(c->verb, OPT_TIME_LIMIT), limit, SOURCE_PRESET, error);
    if (result == FACET_OK && !is_given(c, OPT_VERBOSE))
        result = command_line_set(c, option_find_id(c->verb, OPT_QUIET), NULL, SOURCE_PRESET, error);
    for (size_t i = 0; i < sizeof thumbnail / sizeof *thumbnail && result == FACET_OK; i++)
        result = command_line_set(c, option_find_id(c->verb, thumbnail[i].id), thumbnail[i].text,
                                  SOURCE_PRESET, error);
    /* several thumbnailers at once must not take every core (f3d issue 300) */
    if (result == FACET_OK && getpriority(PRIO_PROCESS, 0) > 0)
        result = command_line_set(c, option_find_id(c->verb, OPT_THREADS), "1", SOURCE_PRESET, error);
    return result;
}
