/* cmd_version.c - facet version. */
#include "cli/commands.h"

#include "cli/failure.h"
#include "cli/render_report.h"

#include <stdio.h>
#include <stdlib.h>

int cmd_version(command_line *c)
{
    size_t length = facet_build_report(NULL, 0);
    char *report = malloc(length + 1);
    if (!report) {
        message_error("facet: out of memory");
        return EXIT_LIMIT;
    }
    facet_build_report(report, length + 1);
    if (is_given(c, OPT_JSON)) {
        json_t *root = json_pack("{s:s, s:I, s:s}", "version", facet_version(), "threads",
                                 (json_int_t)facet_thread_count(), "report", report);
        report_print_json(root);
        json_decref(root);
    } else if (is_given(c, OPT_VERBOSE)) {
        fputs(report, stdout);
    } else {
        printf("facet %s\n", facet_version());
    }
    free(report);
    return EXIT_DONE;
}
