/* convert_names.h - what facet convert reads and what it writes. */
#ifndef CLI_CONVERT_NAMES_H
#define CLI_CONVERT_NAMES_H

#include "cli/shared/command_line.h"
#include "cli/shared/model_list.h"

enum { CONVERT_NAME_SIZE = 4096 };

typedef enum model_format { MODEL_GLB, MODEL_GLTF, MODEL_OBJ, MODEL_OGL1 } model_format;

typedef struct convert_names {
    model_list models;
    const char *output; /* pattern with {stem} or the like, or a name */
    const char *report; /* the same; NULL: none */
    model_format format;
    bool is_html; /* of the report */
    bool keeps_existing;
} convert_names;

/* MODEL NEW, or MODEL... with --output. Checks before any work that the outputs can be written and replace nothing that
 * is read, and finds models whose outputs would have one name. Fails as model_list_create(), and with
 * FACET_ERROR_ARGUMENT, _WRITE. */
facet_result convert_names_read(command_line *c, convert_names *out, facet_error *error);
void convert_names_destroy(convert_names *n); /* {0} is allowed */

/* The output for a model; report: the report for it. Fails with FACET_ERROR_ARGUMENT where it is too long. */
facet_result convert_name(const convert_names *n, const model_name *model, bool report,
                          char name[CONVERT_NAME_SIZE], facet_error *error);

/* Whether that format has materials of OpenGL 1. */
static inline bool format_is_legacy(model_format format)
{
    return format == MODEL_OBJ || format == MODEL_OGL1;
}

#endif
