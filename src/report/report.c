/* report.c - see report.h. */
#include "report/report.h"

facet_result report_html(const facet_scene *scene, text *out, facet_error *error)
{
    (void)scene;
    (void)error;
    text_add(out, "<!doctype html>");
    return FACET_OK;
}
