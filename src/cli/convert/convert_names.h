/* convert_names.h - inputs and outputs of facet convert. */
#ifndef CLI_CONVERT_NAMES_H
#define CLI_CONVERT_NAMES_H

#include "cli/shared/command_line.h"
#include "cli/shared/model_list.h"

enum { CONVERT_NAME_SIZE = 4096 };

typedef enum model_format { MODEL_GLB, MODEL_GLTF, MODEL_OBJ, MODEL_OGL1, MODEL_USDZ } model_format;

typedef struct convert_names {
    model_list models;
    const char *output; /* a name, or a pattern with placeholders */
    const char *report; /* the same; NULL: none */
    model_format format;
    bool is_html; /* of the report */
    bool keeps_existing;
} convert_names;

/* Reads MODEL NEW, or MODEL... with --output. Checks before any work that the outputs can be written and
 * overwrite no input, and finds models with the same output. Fails as model_list_create(), and with
 * FACET_ERROR_ARGUMENT, _WRITE. */
facet_result convert_names_read(command_line *c, convert_names *out, facet_error *error);
void convert_names_destroy(convert_names *n); /* {0} is allowed */

/* The output of a model, or its report. Fails with FACET_ERROR_ARGUMENT if it is too long. */
facet_result convert_name(const convert_names *n, const model_name *model, bool report,
                          char name[CONVERT_NAME_SIZE], facet_error *error);

/* Whether the format has OpenGL 1 materials. */
static inline bool format_is_legacy(model_format format)
{
    return format == MODEL_OBJ || format == MODEL_OGL1;
}

#endif
