/* render_names.h - what the pictures of facet render are called. */
#ifndef CLI_RENDER_NAMES_H
#define CLI_RENDER_NAMES_H

#include "cli/shared/model_list.h"
#include "cli/render/render_options.h"

enum { RENDER_NAME_SIZE = 4096 };

/* The name of the picture with that number (of a sequence) of model, "-" for standard output. Fails with
 * FACET_ERROR_ARGUMENT where it is longer than size bytes. */
facet_result render_name(const render_options *o, const model_name *model, uint32_t number, char *name,
                         size_t size, facet_error *error);

/* The same for its checkpoint; "" where there is none. */
facet_result render_checkpoint_name(const render_options *o, const model_name *model, uint32_t number,
                                    char *name, size_t size, facet_error *error);

/* Whether the picture name would replace what is read for it: the model (NULL: none), the environment, the file of options; not where it is
 * kept (--no-clobber). */
bool render_name_is_input(const command_line *c, const render_options *o, const char *model,
                          const char *name);

/* Checks before any work that the first pictures of all models can be written and are no model, environment or file of
 * options, and finds models whose pictures would have one name. What a model is made of beside is known once it is
 * read. */
facet_result render_names_check(const command_line *c, const render_options *o, model_list *models,
                                facet_error *error);

#endif
