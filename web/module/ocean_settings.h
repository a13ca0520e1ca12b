/* ocean_settings.h - the options of facet ocean as a page sets them: one by one, by name and text, parsed and refused
 * by the command itself, so that a page, its link and the command line say the same. */
#ifndef WEB_OCEAN_SETTINGS_H
#define WEB_OCEAN_SETTINGS_H

#include "base/text.h"
#include "cli/ocean/ocean_run.h"

typedef struct ocean_settings {
    char *texts[OPTION_ID_COUNT]; /* NULL: not given; "": a flag */
    command_line line;
    ocean_run run; /* .options; .sea is the caller's, for the functions of the command */
} ocean_settings;

/* {0}, then this. */
facet_result ocean_settings_reset(ocean_settings *s, facet_error *error);

/* text NULL: the default again. On failure nothing changes: FACET_ERROR_ARGUMENT, with the command's sentence. */
facet_result ocean_settings_set(ocean_settings *s, const char *name, const char *text, facet_error *error);

/* JSON: name to text of all that is given, so that setting it gives the same image. */
void ocean_settings_write(const ocean_settings *s, text *out);
/* "facet ocean --wind 7,45 .. -o sea.png": the command of the image, time_s from the start. */
void ocean_settings_write_command(const ocean_settings *s, double time_s, int width, int height, text *out);

/* JSON: what the command's help says about each option that a page can set: help, argument, default, choices, and the
 * range of numbers. */
void ocean_settings_write_help(text *out);
/* JSON: values in use, by option name, whether they are given, come from a preset or are defaults. */
void ocean_settings_write_values(const ocean_settings *s, text *out);

#endif
