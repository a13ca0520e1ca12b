/* render_output.h - names of images and checkpoints, and reports of images. */
#ifndef CLI_RENDER_OUTPUT_H
#define CLI_RENDER_OUTPUT_H

#include "cli/shared/failure.h"
#include "cli/shared/messages.h"
#include "cli/shared/model_list.h"
#include "cli/render/render_options.h"

enum { RENDER_NAME_SIZE = 4096 };

/* Name of an image of model, with its number in a sequence; "-" for standard output. Fails with
 * FACET_ERROR_ARGUMENT if it exceeds size bytes. */
facet_result render_name(const render_options *o, const model_name *model, uint32_t number, char *name,
                         size_t size, facet_error *error);

/* The same for its checkpoint; "" without one. */
facet_result render_checkpoint_name(const render_options *o, const model_name *model, uint32_t number,
                                    char *name, size_t size, facet_error *error);

/* Whether the image name would overwrite an input: the model (NULL: none), the environment, the file of
 * --config. False with --no-clobber. */
bool render_name_is_input(const command_line *c, const render_options *o, const char *model,
                          const char *name);

/* Checks before any work that the first images of all models can be written and overwrite no model,
 * environment or file of --config, and finds models with the same output. Further files of a model are
 * known after loading. */
facet_result render_names_check(const command_line *c, const render_options *o, model_list *models,
                                facet_error *error);

/* Writes an image to name: as a frame of a video (NULL: a file), or of its layer of IDs the colors. */
facet_result render_write(const render_options *o, const facet_image *image, const char *name,
                          const facet_allocator *allocator, video *frames, facet_error *error);

/* ---- reports: a line for people, an object for programs ---- */

/* An image that was written or kept. */
typedef struct image_report {
    const char *model, *output;
    uint32_t width, height, samples;
    double exposure_ev;       /* stops */
    bool is_kept;             /* by --no-clobber */
    facet_render_stats stats; /* of facet_render() */
    double load_s, save_s, total_s;
} image_report;

/* Prints lines on standard error by verbosity. is_news: also without -v and off a terminal, since the user
 * did not name the output. */
void report_image(const messages *m, const image_report *p, bool is_news);

/* The same as JSON; NULL: no memory. */
json_t *report_image_json(const image_report *p);

/* Warns of an image with fewer samples than requested; resume_with is its checkpoint, "" or NULL: none. */
void report_partial(messages *m, const image_report *p, const char *resume_with);

#endif
