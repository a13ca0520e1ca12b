/* json_report.h - pieces of the objects that --json prints. */
#ifndef CLI_JSON_REPORT_H
#define CLI_JSON_REPORT_H

#include "cli/shared/messages.h"
#include "facet/facet.h"

#include <jansson.h>

/* A JSON string; null where text is NULL. Bytes that are not UTF-8, as names of files may have, become U+FFFD. */
json_t *report_string_json(const char *text);
json_t *report_error_json(const facet_error *error, const char *model /* NULL: none */, int exit_code);
json_t *report_warnings_json(const messages *m);

/* Prints root as one line on standard output. */
void report_print_json(const json_t *root);
/* Prints the object of a command that did nothing but fail: facet, failures, exit_code. */
void report_print_failure_json(const facet_error *error, int exit_code);

#endif
