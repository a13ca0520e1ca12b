/* help_search.h - help by word: an option of any command, or all that mentions a word; and the documents. */
#ifndef CLI_HELP_SEARCH_H
#define CLI_HELP_SEARCH_H

#include <stdbool.h>
#include <stdio.h>

/* Prints the options of that name, without or with its dashes, each with the commands that have it; of a name that another
 * tool has for one, what it is here. False: there is none. */
bool help_print_option(FILE *stream, const char *name);

/* Prints commands, options and documents that mention word, in upper or lower case. False: there are none. */
bool help_search(FILE *stream, const char *word);

/* Prints the documents: with their paths where they are installed beside the command. */
void help_print_documents(FILE *stream);

#endif
