/* model_list.h - the models of a command line: files, the models of folders, and those that a list names. */
#ifndef CLI_MODEL_LIST_H
#define CLI_MODEL_LIST_H

#include "cli/shared/command_line.h"
#include "cli/shared/output_name.h"

#define MODEL_NO_CLASH SIZE_MAX

/* {0}, then model_list_create(). */
typedef struct model_list {
    model_name *models; /* at least one */
    size_t count;
    size_t *
        clashes; /* per model: another one that has the same output, found by who knows the names; MODEL_NO_CLASH */
    char **texts; /* what the names point into */
    size_t text_count;
} model_list;

/* Lists the first argument_count arguments and what --files-from names. A folder stands for the models in it and below,
 * sorted by path, of the verb's file types (but .json, which may be anything); hidden ones are left out, and so are links
 * to folders. One that holds none stays in the list, and reading it fails. Without arguments and list it is the built-in
 * scene. The expanded paths become the arguments of c, in the place of the first argument_count. Fails with
 * FACET_ERROR_READ, _MEMORY, _LIMIT (a tree that is too deep), and _ARGUMENT where the list is empty. */
facet_result model_list_create(command_line *c, size_t argument_count, model_list *out, facet_error *error);
void model_list_destroy(model_list *list); /* {0} is allowed */

/* An output that a model will have. */
typedef struct output_claim {
    char *identity; /* output_identity() */
    size_t model;
} output_claim;

/* Finds models that claim the same output, and writes list->clashes. Sorts claims. */
void model_list_find_clashes(model_list *list, output_claim *claims, size_t claim_count);
/* FACET_ERROR_ARGUMENT with both models and the output, where model number i clashes. */
facet_result model_list_check_clash(const model_list *list, size_t i, const char *output, facet_error *error);

#endif
