/* model_list.h - the models of a command line: files, models in folders, and names in a list. */
#ifndef CLI_MODEL_LIST_H
#define CLI_MODEL_LIST_H

#include "cli/shared/command_line.h"
#include "cli/shared/output.h"

#define MODEL_NO_CLASH SIZE_MAX

/* {0}, then model_list_create(). */
typedef struct model_list {
    model_name *models; /* at least one */
    size_t count;
    size_t *clashes; /* per model: another one with the same output, or MODEL_NO_CLASH */
    char **texts;    /* storage of the names */
    size_t text_count;
} model_list;

/* Lists the first argument_count arguments and the models of --files-from. A folder stands for the models
 * in and below it, sorted by path, of the verb's file types (except .json, which may be anything), without
 * hidden files and links to folders. A folder without models stays in the list, and reading it fails.
 * Without arguments and list the built-in scene is listed. The expanded paths replace the first
 * argument_count arguments of c. Fails with FACET_ERROR_READ, _MEMORY, _LIMIT (nested too deep), and
 * _ARGUMENT for an empty list. */
facet_result model_list_create(command_line *c, size_t argument_count, model_list *out, facet_error *error);
void model_list_destroy(model_list *list); /* {0} is allowed */

/* Writes {dir} of a file to folder, which has room for path: its folder without ".." and the root, so that outputs stay below
 * their place. */
void model_folder(const char *path, char *folder);

/* The output of a model. */
typedef struct output_claim {
    char *identity; /* output_identity() */
    size_t model;
} output_claim;

/* Finds models with the same output and writes list->clashes. Sorts claims. */
void model_list_find_clashes(model_list *list, output_claim *claims, size_t claim_count);
/* FACET_ERROR_ARGUMENT, naming both models and the output, if model i clashes. */
facet_result model_list_check_clash(const model_list *list, size_t i, const char *output, facet_error *error);

#endif
