/* picture_options.h - options that all verbs which draw pictures have: output, format, size, color, light, frames.
 *
 * Each fills its members of render_options and fails with FACET_ERROR_ARGUMENT. In this order. */
#ifndef CLI_PICTURE_OPTIONS_H
#define CLI_PICTURE_OPTIONS_H

#include "cli/render/render_options.h"

facet_result picture_options_output(const command_line *c, render_options *out, facet_error *error);
facet_result picture_options_format(const command_line *c, render_options *out, facet_error *error);
/* --size (otherwise: where it is not given), --crop. */
facet_result picture_options_size(const command_line *c, const char *otherwise, render_options *out,
                                  facet_error *error);
/* --exposure, as stops. */
facet_result picture_options_exposure(const command_line *c, render_options *out, facet_error *error);
/* --tone-mapping (otherwise: where nothing is given and the file is for a display), --quality, --jpeg-quality, --png-compression. */
void picture_options_look(const command_line *c, facet_tonemap otherwise, render_options *out);
/* --time, --frames, --fps. */
facet_result picture_options_frames(const command_line *c, render_options *out, facet_error *error);
/* --env and what belongs to it. */
facet_result picture_options_environment(const command_line *c, render_options *out, facet_error *error);

/* Whether all pictures have a place to go, is_sequence being known. */
facet_result picture_options_check_sequence(const command_line *c, const render_options *o,
                                            facet_error *error);

#endif
