/* render_report.h - what facet render did: a line for people, an object for programs. */
#ifndef CLI_RENDER_REPORT_H
#define CLI_RENDER_REPORT_H

#include "cli/messages.h"
#include "facet/facet.h"

#include <jansson.h>

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
json_t *report_warnings_json(const messages *m);
json_t *report_error_json(const facet_error *error, const char *model /* NULL: none */, int exit_code);

/* Warns of an image that has less samples than were asked for; resume_with: the checkpoint that has them, "" or NULL:
 * none. */
void report_partial(messages *m, const picture_report *p, const char *resume_with);

/* Prints the warnings of a model that were not yet, appends them to all (NULL: nobody asked for JSON) and forgets them.
 * Returns how many there were. */
size_t report_end_model(messages *m, json_t *all);

/* A JSON string; null where text is NULL. Bytes that are no UTF-8, as names of files may have, become U+FFFD. */
json_t *report_string_json(const char *text);

/* Prints the object of a command that did nothing but fail: facet, failures, exit_code. */
void report_print_failure_json(const facet_error *error, int exit_code);

/* Prints root as one line on standard output. */
void report_print_json(const json_t *root);

#endif
