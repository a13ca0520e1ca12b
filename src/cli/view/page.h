/* page.h - pages that show a model in a browser: templates of the viewer's package, filled in. */
#ifndef CLI_PAGE_H
#define CLI_PAGE_H

#include "base/text.h"
#include "cli/shared/command_line.h"
#include "cli/view/page_files.h"
#include "cli/view/viewer_package.h"

/* What a page shows. */
typedef struct page {
    const command_line *line; /* options of the view go into the page */
    const char *title;
    const facet_scene *scene;      /* NULL: none, in an index */
    const viewer_package *package; /* whose decoders a page of one file carries where the model needs them */
    page_files files;
    const unsigned char *preview; /* PNG: shown until the viewer has drawn, in print, and without WebGL */
    size_t preview_size;
    /* of a page beside its files: URLs of the preview and of the folders of the model's and of the light's files, each with
     * its slash; NULL: all is inside the page */
    const char *preview_url, *model_url, *light_url;
    const char *links; /* of an index: HTML; NULL: none */
} page;

/* Replaces the marks {{name}} of a template and appends the result to out. Fails with FACET_ERROR_READ where a file cannot
 * be read, and with FACET_ERROR_MEMORY. */
facet_result page_fill(const page *p, const char *template, size_t size, text *out, facet_error *error);

/* Whether options change how the model is read, which the page's own reader does not do. */
bool page_reads_otherwise(const command_line *c);

#endif
