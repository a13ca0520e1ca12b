/* render_report.h - what facet render did: a line for people, an object for programs. */
#ifndef CLI_RENDER_REPORT_H
#define CLI_RENDER_REPORT_H

#include "cli/shared/json_report.h"
#include "facet/facet.h"

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
