/* convert_names.c - see convert_names.h. */
#include "cli/convert/convert_names.h"

#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/output.h"
#include "cli/shared/terminal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const struct {
    const char *extension;
    model_format format;
} extensions[] = {{".glb", MODEL_GLB},
                  {".gltf", MODEL_GLTF},
                  {".obj", MODEL_OBJ},
                  {".json", MODEL_OGL1},
                  {".usdz", MODEL_USDZ}};

/* ---- formats ---- */

static bool find_format(const char *name, model_format *format)
{
    const char *dot = strrchr(name, '.');
    for (size_t i = 0; dot && i < sizeof extensions / sizeof *extensions; i++)
        if (strcasecmp(dot, extensions[i].extension) == 0) {
            *format = extensions[i].format;
            return true;
        }
    return false;
}

static facet_result read_format(const command_line *c, convert_names *out, facet_error *error)
{
    /* in the order of --to's choices */
    static const model_format choices[] = {MODEL_GLB, MODEL_GLTF, MODEL_OBJ, MODEL_OBJ, MODEL_OGL1};
    static const char *const files[] = {
        "a .glb file", "a .gltf file", "an .obj file", "an .obj file, the .mtl beside it",
        "a .json file of rgl's parameters (as MTL the same materials need an .obj file and --to mtl)"};
    int to = option_choice(c, OPT_TO, -1);
    if (strcmp(out->output, "-") == 0) {
        out->format = MODEL_GLB;
        if (terminal_is(stdout))
            return fail(error, FACET_ERROR_ARGUMENT,
                        "--output: standard output is a terminal; redirect it to a file or a program");
        if (is_given(c, OPT_JSON))
            return fail(error, FACET_ERROR_ARGUMENT,
                        "--json: the model goes to standard output already; name a file with -o");
        return to < 0 || choices[to] == MODEL_GLB
                   ? FACET_OK
                   : fail(error, FACET_ERROR_ARGUMENT,
                          "--to: standard output takes a .glb file; other formats consist of several files");
    }
    if (!find_format(out->output, &out->format))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "convert: \"%s\" does not end in .glb, .gltf, .obj, .json or .usdz", out->output);
    if (to >= 0 && choices[to] != out->format)
        return fail(error, FACET_ERROR_ARGUMENT, "--to: %s is written to %s, but the output is \"%s\"",
                    option_text(c, OPT_TO, ""), files[to], out->output);
    return FACET_OK;
}

static facet_result read_report(const command_line *c, convert_names *out, facet_error *error)
{
    out->report = option_text(c, OPT_REPORT, NULL);
    if (!out->report)
        return FACET_OK;
    TRY(output_name_check("--report", out->report, OUTPUT_NAME_WORDS, error));
    const char *dot = strrchr(out->report, '.');
    out->is_html = dot && (strcasecmp(dot, ".html") == 0 || strcasecmp(dot, ".htm") == 0);
    if (!out->is_html && !(dot && strcasecmp(dot, ".json") == 0))
        return option_fail(c, OPT_REPORT, "a name that ends in .html or .json", error);
    if (out->models.count > 1 && !output_name_has_model(out->report))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--report: several models need a name with {stem}, as in 'reports/{stem}.html'");
    return FACET_OK;
}

/* ---- names ---- */

facet_result convert_name(const convert_names *n, const model_name *model, bool report,
                          char name[CONVERT_NAME_SIZE], facet_error *error)
{
    if (output_name_expand(report ? n->report : n->output, model, NULL, name, CONVERT_NAME_SIZE))
        return FACET_OK;
    return fail(error, FACET_ERROR_ARGUMENT, "%s: the name for %s is too long",
                report ? "--report" : "--output", input_name(model->path));
}

static facet_result check_name(const convert_names *n, const model_name *model, bool report,
                               output_claim *claim, facet_error *error)
{
    char name[CONVERT_NAME_SIZE];
    TRY(convert_name(n, model, report, name, error));
    if (input_is_same_file(model->path, name) && !(n->keeps_existing && !report))
        return fail(error, FACET_ERROR_ARGUMENT, "%s: this input would be overwritten; name another output",
                    name);
    TRY(output_check(name, error));
    claim->identity = output_identity(name);
    return claim->identity ? FACET_OK : fail(error, FACET_ERROR_MEMORY, "out of memory: names");
}

static facet_result check_names(convert_names *n, facet_error *error)
{
    size_t models = n->models.count, count = models * (n->report ? 2 : 1);
    output_claim *claims = calloc(count, sizeof *claims);
    facet_result result = claims ? FACET_OK : fail(error, FACET_ERROR_MEMORY, "out of memory: names");
    for (size_t i = 0; i < count && result == FACET_OK; i++) {
        claims[i].model = i % models;
        result = check_name(n, &n->models.models[i % models], i >= models, &claims[i], error);
    }
    if (result == FACET_OK)
        model_list_find_clashes(&n->models, claims, count);
    for (size_t i = 0; claims && i < count; i++)
        free(claims[i].identity);
    free(claims);
    return result;
}

void convert_names_destroy(convert_names *n)
{
    model_list_destroy(&n->models);
    *n = (convert_names){0};
}

facet_result convert_names_read(command_line *c, convert_names *out, facet_error *error)
{
    *out = (convert_names){.output = option_text(c, OPT_OUTPUT, NULL),
                           .keeps_existing = is_given(c, OPT_NO_CLOBBER)};
    size_t argument_count = c->argument_count;
    bool is_pair = !out->output && argument_count == 2;
    if (is_pair)
        out->output = c->arguments[--argument_count];
    if (!out->output || (argument_count == 0 && !is_given(c, OPT_FILES_FROM)))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "convert: a model and the name of the new one were expected, as in facet convert "
                    "old.gltf new.glb; for several models give -o 'new/{stem}.glb'");
    TRY(output_name_check(is_pair ? "convert" : "--output", out->output, OUTPUT_NAME_WORDS, error));
    TRY(model_list_create(c, argument_count, &out->models, error));
    if (out->models.count > 1 && !output_name_has_model(out->output))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--output: several models need a name with {stem}, as in -o 'new/{stem}.glb'");
    TRY(read_format(c, out, error));
    TRY(read_report(c, out, error));
    return check_names(out, error);
}
