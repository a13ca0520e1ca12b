/* cmd_version.c - facet version. */
#include "cli/shared/options.h"

#include "cli/shared/command_line.h"
#include "cli/shared/failure.h"
#include "cli/shared/messages.h"

#include <stdio.h>
#include <stdlib.h>

const verb version_verb = {
    .name = "version",
    .summary = "print the version",
    .arguments = "",
    .description = "Prints the version; with -v also how it was built and what it found on this machine.",
    .examples = (const example[]){{"facet version -v", "for a bug report"}, {NULL, NULL}},
    .groups =
        (const option_group *const[]){OPTION_GROUP("Options", OPT_VERBOSE, OPT_JSON, OPT_HELP, OPT_HELP_ALL),
                                      NULL},
};

/* Builds the report. It queries the OpenGL driver, which is slow: once, and only if it is printed. */
static char *read_report(void)
{
    size_t size = 4096;
    char *report = malloc(size);
    size_t length = report ? facet_build_report(report, size) : 0;
    if (length < size)
        return report;
    free(report);
    report = malloc(length + 1);
    if (report)
        facet_build_report(report, length + 1);
    return report;
}

/* The libraries as objects; "found" is null where one is missing. */
static json_t *list_libraries(void)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < facet_get_library_count(); i++) {
        const facet_library_info info = facet_get_library(i);
        if (!*info.built_version)
            continue;
        json_array_append_new(list,
                              json_pack("{s:s, s:s, s:s, s:s*, s:s?}", "name", info.name, "license",
                                        info.license, "built_with", info.built_version, "file", info.file,
                                        "found", *info.found_version ? info.found_version : NULL));
    }
    return list;
}

int cmd_version(command_line *c)
{
    bool is_json = is_given(c, OPT_JSON);
    if (!is_json && !is_given(c, OPT_VERBOSE)) {
        printf("facet %s\n", facet_version());
        return EXIT_DONE;
    }
    char *report = read_report();
    if (!report) {
        message_error("facet: out of memory");
        return EXIT_LIMIT;
    }
    if (is_json) {
        json_t *root =
            json_pack("{s:s, s:I, s:o, s:s}", "version", facet_version(), "threads",
                      (json_int_t)facet_thread_count(), "libraries", list_libraries(), "report", report);
        report_print_json(root);
        json_decref(root);
    } else {
        fputs(report, stdout);
    }
    free(report);
    return EXIT_DONE;
}
