/* render_output.h - what pictures are called, and what is reported of them. */
#ifndef CLI_RENDER_OUTPUT_H
#define CLI_RENDER_OUTPUT_H

#include "cli/shared/failure.h"
#include "cli/shared/messages.h"
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

/* ---- reports: a line for people, an object for programs ---- */

/* One picture that was written, or kept. */
typedef struct picture_report {
    const char *model, *output;
    uint32_t width, height, samples;
    double exposure_ev;       /* stops */
    bool is_kept;             /* --no-clobber: it was there */
    facet_render_stats stats; /* of facet_render() */
    double load_s, save_s, total_s;
} picture_report;

/* Lines on standard error as verbosity asks; is_news: also without -v and off a terminal (the user did not name the
 * output). */
void report_picture(const messages *m, const picture_report *p, bool is_news);

/* The same as JSON; NULL: no memory. */
json_t *report_picture_json(const picture_report *p);

/* Warns of an image that has less samples than were asked for; resume_with: the checkpoint that has them, "" or NULL:
 * none. */
void report_partial(messages *m, const picture_report *p, const char *resume_with);

#endif
