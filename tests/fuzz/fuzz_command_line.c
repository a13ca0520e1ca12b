/* fuzz_command_line.c - a command line, one argument per line of the input, the first a verb: parsed, and its
 * option values read. No verb is run. */
#include "fuzz_support.h"

#include <string.h>

#include "cli/bake/bake_options.h"
#include "cli/compare/compare_metrics.h"
#include "cli/convert/convert_names.h"
#include "cli/ocean/ocean_run.h"
#include "cli/plot/plot_material.h"
#include "cli/render/render_options.h"

enum { MAX_WORDS = 64 };

static facet_result read_values(command_line *c, facet_error *error)
{
    const char *name = c->verb->name;
    if (strcmp(name, "render") == 0) {
        render_options options;
        return render_options_read(c, &options, error);
    }
    if (strcmp(name, "bake") == 0) {
        bake_options options;
        return bake_options_read(c, &options, error);
    }
    if (strcmp(name, "ocean") == 0) {
        ocean_options options;
        return ocean_options_read(c, &options, error);
    }
    if (strcmp(name, "compare") == 0) {
        compare_wish wish;
        return compare_wish_read(c, &wish, error);
    }
    if (strcmp(name, "convert") == 0) {
        convert_names names = {0};
        facet_result result = convert_names_read(c, &names, error);
        convert_names_destroy(&names);
        return result;
    }
    if (strcmp(name, "plot") == 0) {
        plot_materials materials = {0};
        facet_result result = plot_materials_add_options(&materials, c, error);
        plot_materials_destroy(&materials);
        return result;
    }
    return FACET_OK;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    if (!text)
        abort();
    memcpy(text, data, size);
    text[size] = 0;
    char *words[MAX_WORDS];
    int count = 0;
    for (char *word = strtok(text, "\n"); word && count < MAX_WORDS; word = strtok(NULL, "\n"))
        words[count++] = word;
    const verb *v = count ? verb_find(words[0]) : NULL;
    if (v) {
        command_line c;
        facet_error error = {0};
        facet_result result = command_line_parse(v, count - 1, words + 1, &c, &error);
        if (result == FACET_OK && !is_given(&c, OPT_HELP))
            result = read_values(&c, &error);
        fuzz_check_error(result, &error);
        command_line_destroy(&c);
    }
    free(text);
    return 0;
}
