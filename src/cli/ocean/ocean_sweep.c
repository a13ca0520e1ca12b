/* ocean_sweep.c - a sheet of pictures over one option, or two. Any option that takes a number can be swept: each picture is that of the
 * command line with the number put in. */
#include "cli/ocean/ocean_run.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/shared/failure.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/suggest.h"
#include "cli/shared/value.h"

enum { MAX_STEPS = 64, AXES = 2, LABEL_SIZE = 96, LONGEST_EDGE = 65536 };

static const double LARGEST = 1e15; /* of numbers: whole ones are exact */

typedef struct axis {
    const option *option;
    double from, to;
    uint32_t count;
} axis;

static const char expected[] =
    "NAME=FROM:TO:COUNT, or two of them separated by a comma: roughness=0.01:0.1:5,"
    "ior=1.3:1.4:5";

static bool takes_number(const option *o)
{
    static const option_id texts[] = {OPT_WIND, OPT_FETCH,   OPT_DEPTH, OPT_BED_SLOPE,
                                      OPT_SUN,  OPT_HEADING, OPT_FOV,   OPT_EXPOSURE};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        if (o->id == texts[i])
            return true;
    static const option_id others[] = {OPT_THREADS,      OPT_MAX_TEXTURE,  OPT_MESH_SIZE,
                                       OPT_MESH_SAMPLES, OPT_JPEG_QUALITY, OPT_FPS};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (o->id == others[i])
            return false;
    return o->kind == OPTION_NUMBER || o->kind == OPTION_INTEGER;
}

static facet_result read_axis(const command_line *c, const char **at, axis *out, facet_error *error)
{
    size_t length = strcspn(*at, "=");
    out->option = option_find(c->verb, *at, length);
    if (length == 0 || !(*at)[length])
        return option_fail(c, OPT_SWEEP, expected, error);
    if (!out->option)
        return suggest_option(c->verb, *at, length, error);
    if (!takes_number(out->option))
        return fail(error, FACET_ERROR_ARGUMENT, "--sweep: --%s is not one number that changes the picture",
                    out->option->name);
    *at += length + 1;
    double count = 0.0;
    bool is_range = scan_number(at, &out->from) && *(*at)++ == ':' && scan_number(at, &out->to) &&
                    *(*at)++ == ':' && scan_number(at, &count);
    if (!is_range || !(fabs(out->from) <= LARGEST && fabs(out->to) <= LARGEST) || count < 1.0 ||
        count > MAX_STEPS || count != floor(count))
        return option_fail(c, OPT_SWEEP, expected, error);
    out->count = (uint32_t)count;
    return FACET_OK;
}

static facet_result read_axes(const ocean_run *run, axis axes[AXES], facet_error *error)
{
    const command_line *c = run->base.line;
    const char *at = option_text(c, OPT_SWEEP, "");
    facet_result result = read_axis(c, &at, &axes[0], error);
    if (result == FACET_OK && *at == ',') {
        at++;
        result = read_axis(c, &at, &axes[1], error);
    }
    if (result == FACET_OK && *at)
        result = option_fail(c, OPT_SWEEP, expected, error);
    const render_options *p = &run->options.picture;
    uint64_t columns = axes[0].count, rows = axes[1].count; /* 0: the columns are as many as look well */
    if (result == FACET_OK &&
        (columns * p->desc.width > LONGEST_EDGE || rows * p->desc.height > LONGEST_EDGE))
        result =
            fail(error, FACET_ERROR_ARGUMENT,
                 "--sweep: %u x %u pictures of %u x %u pixels are more than a sheet of %d x %d holds",
                 axes[0].count, (unsigned)rows, p->desc.width, p->desc.height, LONGEST_EDGE, LONGEST_EDGE);
    if (result == FACET_OK && axes[0].option == axes[1].option)
        result =
            fail(error, FACET_ERROR_ARGUMENT, "--sweep: both of its axes are --%s", axes[0].option->name);
    return result;
}

static void put_number(const axis *a, uint32_t i, char *text, size_t size)
{
    double share = a->count > 1 ? (double)i / (a->count - 1) : 0.0;
    double number = a->from + share * (a->to - a->from);
    if (a->option->kind == OPTION_INTEGER)
        snprintf(text, size, "%.0f", round(number));
    else
        snprintf(text, size, "%.6g", number); /* the picture is of the number that its label shows */
}

/* One picture: the command line with both numbers. */
static facet_result draw_cell(ocean_run *run, const axis *axes, uint32_t cell, ocean_step step, char *label,
                              facet_image **image, facet_error *error)
{
    command_line line = *run->base.line;
    char numbers[AXES][32];
    *label = 0;
    for (int i = 0; i < AXES && axes[i].option; i++) {
        const option *o = axes[i].option;
        put_number(&axes[i], i ? cell / axes[0].count : cell % axes[0].count, numbers[i], sizeof numbers[i]);
        line.values[o->id] = (option_value){.text = NULL};
        facet_result result = command_line_set(&line, o, numbers[i], SOURCE_COMMAND_LINE, error);
        if (result != FACET_OK)
            return result;
        size_t used = strlen(label);
        snprintf(label + used, LABEL_SIZE - used, "%s%s %s", i ? ", " : "", o->name, numbers[i]);
    }
    ocean_options options;
    facet_result result = ocean_options_read(&line, &options, error);
    if (result == FACET_OK)
        result = ocean_run_set_sea(run, &options, error);
    if (result == FACET_OK)
        result = ocean_run_meter(run, &options, error);
    if (result == FACET_OK)
        result = facet_sea_set_time(run->sea, options.picture.time_s, error);
    if (result == FACET_OK && run->model)
        result = ocean_float_place(run, error);
    return result == FACET_OK ? ocean_run_draw(run, &options, step, image, error) : result;
}

facet_result ocean_sweep(ocean_run *run, const char *output, facet_image **image, facet_error *error)
{
    axis axes[AXES] = {{.option = NULL}, {.option = NULL}};
    facet_result result = read_axes(run, axes, error);
    if (result != FACET_OK)
        return result;
    uint32_t count = axes[0].count * (axes[1].option ? axes[1].count : 1);
    facet_image **pictures = calloc(count, sizeof *pictures);
    char(*labels)[LABEL_SIZE] = calloc(count, sizeof *labels);
    const char **words = calloc(count, sizeof *words);
    if (!pictures || !labels || !words)
        result = fail(error, FACET_ERROR_MEMORY, "out of memory: sheet");
    for (uint32_t i = 0; i < count && result == FACET_OK; i++) {
        result = draw_cell(run, axes, i, (ocean_step){output, i, count}, labels[i], &pictures[i], error);
        words[i] = labels[i];
    }
    const facet_contact_sheet_desc desc = {.allocator = run->base.allocator,
                                           .log = messages_log(&run->base.messages),
                                           .column_count = axes[1].option ? axes[0].count : 0,
                                           .labels = words};
    if (result == FACET_OK)
        result = facet_image_create_sheet((const facet_image *const *)pictures, count, &desc, image, error);
    for (uint32_t i = 0; pictures && i < count; i++)
        facet_image_destroy(pictures[i]);
    free(pictures);
    free(labels);
    free(words);
    return result;
}
