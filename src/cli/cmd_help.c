/* cmd_help.c - facet help. */
#include "cli/commands.h"

#include "cli/failure.h"
#include "cli/help.h"
#include "cli/messages.h"
#include "cli/suggest.h"

#include <string.h>

int cmd_help(command_line *c)
{
    if (c->argument_count == 0) {
        help_print_overview(stdout);
        return EXIT_DONE;
    }
    const char *topic = c->arguments[0];
    const verb *v = verb_find(topic);
    if (v) {
        help_print_verb(stdout, v);
    } else if (strcmp(topic, "exit-codes") == 0) {
        help_print_exit_codes(stdout);
    } else if (verb_is_planned(topic)) {
        message_error("facet: this version does not have the command %s yet", topic);
        return EXIT_USAGE;
    } else {
        const char *near = suggest_verb(topic);
        message_error("facet: there is no command \"%s\"%s%s%s", topic,
                      near ? "; did you mean facet help " : "",
                      near ? near : "; facet help lists those there are", near ? "?" : "");
        return EXIT_USAGE;
    }
    return EXIT_DONE;
}
