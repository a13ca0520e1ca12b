/* cmd_help.c - facet help: a command, a topic, an option, or a word. */
#include "cli/shared/commands.h"

#include "cli/shared/failure.h"
#include "cli/help/help.h"
#include "cli/help/help_search.h"
#include "cli/shared/messages.h"
#include "cli/shared/suggest.h"

#include <string.h>

static int search(const char *word)
{
    if (help_search(stdout, word))
        return EXIT_DONE;
    message_error("facet: no command, option or document mentions \"%s\"", word);
    return EXIT_USAGE;
}

/* Of a word that is neither a command nor a topic. */
static int explain_word(const char *word)
{
    if (help_print_option(stdout, word))
        return EXIT_DONE;
    const char *near = suggest_verb(word);
    if (verb_is_planned(word))
        message_error("facet: this version does not have the command %s yet", word);
    else if (near)
        message_error("facet: there is no command \"%s\"; did you mean facet help %s?", word, near);
    else
        return search(word);
    return EXIT_USAGE;
}

int cmd_help(command_line *c)
{
    const char *topic = c->argument_count ? c->arguments[0] : NULL;
    const verb *v = topic ? verb_find(topic) : NULL;
    if (is_given(c, OPT_SEARCH))
        return search(option_text(c, OPT_SEARCH, ""));
    if (!topic)
        help_print_overview(stdout);
    else if (v)
        help_print_verb(stdout, v, is_given(c, OPT_HELP_ALL));
    else if (strcmp(topic, "exit-codes") == 0)
        help_print_exit_codes(stdout);
    else if (strcmp(topic, "documents") == 0)
        help_print_documents(stdout);
    else
        return explain_word(topic);
    return EXIT_DONE;
}
