/* cmd_merge.c - facet merge: the image of which several processes rendered parts, or what is missing of it. */
#include "cli/shared/options.h"

#include "cli/render/render_options.h"
#include "cli/render/render_output.h"
#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/output.h"
#include "cli/shared/shell_line.h"
#include "cli/shared/verb_run.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const verb merge_verb = {
    .name = "merge",
    .summary = "merge parts of an image",
    .arguments = "PART...",
    .max_arguments = SIZE_MAX,
    .file_types = "exr",
    .output_types = "png png16 jpg jpeg webp exr hdr pfm",
#ifndef FACET_WITHOUT_HELP
    .description = "Merges the parts that facet render --shard and facet ocean --shard wrote, in any order, "
                   "into the image that the "
                   "same command writes without --shard, to the last bit. What needs the whole image is done "
                   "here: denoising, tone "
                   "mapping, the background.\n\n"
                   "If parts are missing, the commands that make them are printed on standard output, one a "
                   "line, and the exit code "
                   "is 1. Parts of other settings, of another version of facet or with another instruction "
                   "set (--isa) are refused.",
    .examples = (const example[]){{"facet render huge.glb -o part_0.exr --size 16384x8192 --shard 0/2\n"
                                   "      facet render huge.glb -o part_1.exr --size 16384x8192 --shard 1/2\n"
                                   "      facet merge part_*.exr -o huge.png",
                                   "an image in two parts, which two machines may render"},
                                  {"facet merge part_*.exr -o huge.png | sh", "make the missing parts"},
                                  {"facet merge part_*.exr -o huge.exr", "linear radiance, with all layers"},
                                  {NULL, NULL}},
#endif
    .groups =
        (const option_group *const[]){OPTION_GROUP("Image", OPT_OUTPUT, OPT_NO_CLOBBER, OPT_FORMAT,
                                                   OPT_TONE_MAPPING, OPT_JPEG_QUALITY, OPT_PNG_COMPRESSION),
                                      &limits_group, &messages_group,
                                      OPTION_GROUP("Running", OPT_PROGRESS, OPT_CONFIG), NULL},
};

typedef struct merge_run {
    verb_run base;
    render_options options; /* output, format, quality, limits */
    facet_part_info first;  /* any part */
    bool *is_there;         /* by index; NULL: nothing read yet */
    uint32_t missing_count;
    json_t *image, *missing; /* with --json, else NULL */
} merge_run;

/* ---- parts that are missing ---- */

/* A command of the parts with the number of one. malloc() memory; NULL: none. */
static char *fill_command(const char *command, uint32_t index)
{
    static const char mark[] = "{part:";
    enum { MARK = sizeof mark - 1 };
    shell_line l = {.text = NULL};
    while (*command) {
        const char *found = strstr(command, mark);
        bool is_whole = found && found[MARK] >= '1' && found[MARK] <= '9' && found[MARK + 1] == '}';
        char number[200];
        if (!is_whole) {
            shell_line_add_bytes(&l, command, found ? (size_t)(found - command) + MARK : strlen(command));
            command = found ? found + MARK : "";
            continue;
        }
        shell_line_add_bytes(&l, command, (size_t)(found - command));
        snprintf(number, sizeof number, "%0*u", found[MARK] - '0', index);
        shell_line_add_bytes(&l, number, strlen(number));
        command = found + MARK + 2;
    }
    return l.text;
}

/* Control characters could be commands of a terminal or further lines. */
static bool is_printable(const char *text)
{
    for (; *text; text++)
        if ((unsigned char)*text < 32 || *text == 127)
            return false;
    return true;
}

static void print_missing(merge_run *run)
{
    const facet_part_info *p = &run->first;
    for (uint32_t i = 0; i < p->count; i++) {
        if (run->is_there[i])
            continue;
        char *command = is_printable(p->command) ? fill_command(p->command, i) : NULL;
        if (run->missing)
            json_array_append_new(run->missing,
                                  json_pack("{s:I, s:o}", "part", (json_int_t)i, "command",
                                            command ? report_string_json(command) : json_null()));
        else
            printf("%s\n", command ? command : "");
        free(command);
    }
}

/* Reports what is missing; the parts that are there are of one image. */
static void report_missing(merge_run *run)
{
    const facet_part_info *p = &run->first;
    char list[96] = "";
    uint32_t shown = 0;
    for (uint32_t i = 0; i < p->count && shown < 8; i++)
        if (!run->is_there[i]) {
            size_t used = strlen(list);
            snprintf(list + used, sizeof list - used, "%s%u", shown++ ? ", " : "", i);
        }
    message_error("facet: %s: %u of %u parts %s missing (%s%s)%s",
                  run->options.is_stdout ? "stdout" : run->options.output, run->missing_count, p->count,
                  run->missing_count == 1 ? "is" : "are", list, shown < run->missing_count ? ", .." : "",
                  run->missing ? "" : "; the commands that make them are on standard output");
    print_missing(run);
    run->base.is_negative = true;
}

/* Reads what the files say, and finds the parts. Those of different images are left to the merging, which says how they
 * differ. *is_of_one: all are of one image. */
static facet_result find_parts(merge_run *run, bool *is_of_one, facet_error *error)
{
    const command_line *c = run->base.line;
    facet_part_info info;
    *is_of_one = true;
    for (size_t i = 0; i < c->argument_count; i++) {
        TRY(interrupt_check(c->arguments[i], error));
        TRY(facet_part_read_info(c->arguments[i], &info, error));
        if (!run->is_there) {
            run->first = info;
            run->missing_count = info.count;
            run->is_there = calloc(info.count, sizeof *run->is_there);
            if (!run->is_there)
                return fail(error, FACET_ERROR_MEMORY, "out of memory: parts");
        }
        bool is_same = info.count == run->first.count && strcmp(info.settings, run->first.settings) == 0;
        *is_of_one = *is_of_one && is_same;
        if (!is_same)
            continue;
        run->missing_count -= !run->is_there[info.index];
        run->is_there[info.index] = true;
    }
    return FACET_OK;
}

/* ---- the image ---- */

static bool is_linear(facet_image_format format)
{
    return format == FACET_IMAGE_FORMAT_HDR || format == FACET_IMAGE_FORMAT_PFM ||
           format == FACET_IMAGE_FORMAT_EXR || format == FACET_IMAGE_FORMAT_EXR_FLOAT;
}

static facet_merge_desc desc_of(merge_run *run, progress *shown)
{
    const render_options *o = &run->options;
    const command_line *c = run->base.line;
    facet_merge_desc desc = {.allocator = run->base.allocator,
                             .log = messages_log(&run->base.messages),
                             .progress = progress_callback(shown),
                             .thread_count = o->limits.thread_count,
                             .has_tonemap = is_given(c, OPT_TONE_MAPPING),
                             .tonemap =
                                 (facet_tonemap)option_choice(c, OPT_TONE_MAPPING, FACET_TONEMAP_NONE)};
    if (!desc.has_tonemap && run->first.has_display_tonemap && is_linear(o->save.format))
        desc.has_tonemap = true;
    return desc;
}

static void report(merge_run *run, const char *name, const facet_image *image, double start)
{
    facet_image_view view = facet_image_get_layer(image, 0);
    double seconds = interrupt_clock() - start;
    message_at(&run->base.messages, VERBOSITY_NORMAL, "%s: %ux%u of %u parts, %.2f s", name, view.width,
               view.height, run->first.count, seconds);
    if (is_given(run->base.line, OPT_JSON))
        run->image = json_pack("{s:o, s:I, s:I, s:I, s:f}", "output", report_string_json(name), "width",
                               (json_int_t)view.width, "height", (json_int_t)view.height, "parts",
                               (json_int_t)run->first.count, "seconds", seconds);
}

static facet_result merge(merge_run *run, const char *name, facet_error *error)
{
    const command_line *c = run->base.line;
    double start = interrupt_clock();
    progress shown = {
        .mode = run->base.progress, .subject = name, .start = start, .share = 1.0, .last_percent = -10};
    const facet_merge_desc desc = desc_of(run, &shown);
    facet_image *image = NULL;
    interrupt_begin_polling(name, "merging", shown.mode == PROGRESS_BAR);
    facet_result result = facet_part_merge(c->arguments, c->argument_count, &desc, &image, error);
    interrupt_end();
    progress_clear();
    if (result == FACET_OK && run->first.has_layers && run->options.save.format != FACET_IMAGE_FORMAT_EXR &&
        run->options.save.format != FACET_IMAGE_FORMAT_EXR_FLOAT)
        message_at(&run->base.messages, VERBOSITY_NORMAL,
                   "%s: the layers of the parts are left out; they need an .exr file", name);
    if (result == FACET_OK)
        result = render_write(&run->options, image, name, &run->base.allocator, NULL, error);
    if (result == FACET_OK)
        report(run, name, image, start);
    facet_image_destroy(image);
    return result;
}

/* ---- the run ---- */

static facet_result check_inputs(const command_line *c, const char *name, facet_error *error)
{
    for (size_t i = 0; i < c->argument_count && output_exists(name); i++)
        if (input_is_same_file(c->arguments[i], name))
            return fail(error, FACET_ERROR_ARGUMENT,
                        "%s: this part would be overwritten; name another output with -o", name);
    return FACET_OK;
}

static facet_result read_line(verb_run *base, facet_error *error)
{
    merge_run *run = (merge_run *)base;
    render_options *o = &run->options;
    const command_line *c = base->line;
    TRY(limits_read(c, &o->limits, error));
    base->limits = o->limits;
    o->save.thread_count = o->limits.thread_count;
    if (c->argument_count == 0)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "merge: no parts are named: facet merge part_*.exr -o whole.png");
    if (!is_given(c, OPT_OUTPUT))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "merge: no output is named: facet merge part_*.exr -o whole.png");
    command_line one = *c; /* several parts make one image */
    one.argument_count = 1;
    TRY(image_options_output(&one, o, error));
    TRY(image_options_format(&one, o, error));
    image_options_quality(c, FACET_TONEMAP_NONE, o);
    if (o->video)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--format: parts are merged into an image, not into a video");
    if (o->is_stdout)
        return FACET_OK;
    TRY(output_check(o->output, error));
    return check_inputs(c, o->output, error);
}

static facet_result work(verb_run *base, facet_error *error)
{
    merge_run *run = (merge_run *)base;
    const render_options *o = &run->options;
    bool is_of_one = true;
    run->missing = is_given(base->line, OPT_JSON) ? json_array() : NULL;
    if (o->keeps_existing && !o->is_stdout && output_exists(o->output)) {
        message_at(&base->messages, VERBOSITY_NORMAL, "%s: it exists and is kept", o->output);
        return FACET_OK;
    }
    facet_result result = find_parts(run, &is_of_one, error);
    if (result == FACET_OK && is_of_one && run->missing_count > 0) {
        report_missing(run);
        return FACET_OK;
    }
    if (result == FACET_OK)
        result = merge(run, o->output, error);
    if (result != FACET_OK)
        failure_complete(error, o->is_stdout ? "stdout" : o->output, base->limits.max_memory_bytes);
    return result;
}

static void add_json(const verb_run *base, json_t *root)
{
    const merge_run *run = (const merge_run *)base;
    json_object_set_new(root, "image", run->image ? json_incref(run->image) : json_null());
    json_object_set(root, "missing", run->missing);
}

static void destroy(verb_run *base)
{
    merge_run *run = (merge_run *)base;
    free(run->is_there);
    json_decref(run->image);
    json_decref(run->missing);
}

int cmd_merge(command_line *c)
{
    static const verb_work parts = {read_line, work, add_json, destroy};
    merge_run run = {.is_there = NULL};
    return verb_run_all(&run.base, c, &parts);
}
