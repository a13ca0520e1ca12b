/* html.h - pieces of an HTML page. */
#ifndef REPORT_HTML_H
#define REPORT_HTML_H

#include "base/text.h"

/* An img element with the file embedded. */
void html_image(text *out, const char *mime_type, const unsigned char *bytes, size_t size, uint32_t width,
                uint32_t height, const char *alternative);
/* Three significant digits; "-" for NaN. */
void html_number(text *out, double value);
/* Head of the page with its style sheet; html_end() closes it. */
void html_begin(text *out, const char *title);
void html_end(text *out);

#endif
