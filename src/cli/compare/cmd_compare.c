/* cmd_compare.c - facet compare: metrics of two images. */
#include "cli/shared/options.h"

#include "cli/compare/compare_metrics.h"
#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/output.h"
#include "cli/shared/value.h"
#include "cli/shared/verb_run.h"

#include <string.h>
#include <strings.h>

const verb compare_verb = {
    .name = "compare",
    .summary = "measure the difference of two images",
    .arguments = "A B",
    .max_arguments = 2,
    .file_types = "png jpg jpeg webp avif tga bmp gif dds exr hdr pfm ktx2",
    .output_types = "png jpg jpeg webp exr hdr pfm",
    .description =
        "A is the reference, B is compared with it; both are .png .jpg .webp .avif .tga .bmp .gif "
        ".dds .exr .hdr .pfm .ktx2, recognized by content; - is standard input, once. They must have "
        "the same size.\n\n"
        "Without limits the exit code is 0, however different they are. With --max or --min it is 1 "
        "if a limit is exceeded, with one line that states by how much; then numbers are printed "
        "only with --metric or -v.\n\n"
        "Scene-linear files (exr, hdr, pfm, ktx2 with linear texels) are compared as radiance, all "
        "others as display values; if only one of two is linear, it is tone-mapped (--tone-mapping) "
        "and clamped. FLIP of linear files is the largest over a range of exposures (HDR-FLIP).\n\n"
        "Pixels that are NaN or infinite in one image and not the same in the other enter no mean, "
        "but they count as infinitely different; with such pixels no limit holds.",
    .examples =
        (const example[]){
            {"facet compare reference.png render.png", "a table"},
            {"facet compare golden.exr new.exr --max flip=0.02,nrmse=0.01", "a test: exit 1 if it fails"},
            {"facet compare a.png b.png -o diff.png --heat-map --sheet", "a false-color image beside both"},
            {"facet compare a.png b.png --metric psnr --min 40 -q", "only the exit code"},
            {"facet compare light.exr shot.png --tone-mapping neutral --json | jq .metrics.flip",
             "a linear image and a display image"},
            {"facet render shoe.glb -o - --format png | facet compare golden.png - --max differing=0",
             "equal in every bit of the file"},
            {NULL, NULL}},
    .basics = OPTION_IDS(OPT_METRIC, OPT_MAX, OPT_MIN, OPT_OUTPUT, OPT_HEAT_MAP, OPT_GAIN, OPT_MASK,
                         OPT_LAYER, OPT_SPACE, OPT_EXPOSURE, OPT_TONE_MAPPING, OPT_JSON),
    .groups =
        (const option_group *const[]){OPTION_GROUP("Metrics", OPT_METRIC, OPT_MAX, OPT_MIN, OPT_PERCENTILE,
                                                   OPT_THRESHOLD, OPT_PIXELS_PER_DEGREE, OPT_PEAK,
                                                   OPT_EPSILON),
                                      OPTION_GROUP("Images", OPT_SPACE, OPT_TONE_MAPPING, OPT_EXPOSURE,
                                                   OPT_ALPHA, OPT_BACKGROUND, OPT_LAYER, OPT_MASK, OPT_CROP),
                                      OPTION_GROUP("Difference image", OPT_OUTPUT, OPT_NO_CLOBBER, OPT_FORMAT,
                                                   OPT_HEAT_MAP, OPT_GAIN, OPT_SHEET),
                                      &limits_group, &messages_group, NULL},
};

typedef struct compare_run {
    verb_run base;
    compare_wish wish;
    facet_compare_desc desc;
    facet_image_save_desc save;
    const char *output; /* NULL: none */
    facet_image *a, *b, *mask, *difference;
    facet_comparison comparison;
    bool is_measured, is_kept, is_written;
} compare_run;

/* ---- options ---- */

static facet_result read_images(compare_run *run, facet_error *error)
{
    const command_line *c = run->base.line;
    const char *mask = option_text(c, OPT_MASK, NULL);
    if (c->argument_count < 2)
        return fail(error, FACET_ERROR_ARGUMENT,
                    c->argument_count ? "compare: %s with what? facet compare reference.png render.png"
                                      : "compare: which images?%s facet compare reference.png render.png",
                    c->argument_count ? c->arguments[0] : "");
    int streams = 0;
    for (int i = 0; i < 2; i++)
        streams += strcmp(c->arguments[i], "-") == 0;
    streams += mask && strcmp(mask, "-") == 0;
    if (streams > 1)
        return fail(error, FACET_ERROR_ARGUMENT, "compare: standard input is one image, not %d", streams);
    return FACET_OK;
}

static facet_result read_output(compare_run *run, facet_error *error)
{
    static const char *const extensions[] = {"png", "jpg", "jpeg", "webp", "exr", "hdr", "pfm"};
    const command_line *c = run->base.line;
    const int format = option_choice(c, OPT_FORMAT, -1);
    run->output = option_text(c, OPT_OUTPUT, NULL);
    if (!run->output) {
        static const option_id idle[] = {OPT_HEAT_MAP, OPT_SHEET, OPT_GAIN, OPT_FORMAT, OPT_NO_CLOBBER};
        for (size_t i = 0; i < sizeof idle / sizeof *idle; i++)
            if (is_given(c, idle[i]))
                return fail(error, FACET_ERROR_ARGUMENT, "--%s: it needs a difference image, -o FILE",
                            option_find_id(c->verb, idle[i])->name);
        return FACET_OK;
    }
    const char *dot = strrchr(run->output, '.');
    bool is_known = format >= 0;
    for (size_t i = 0; i < sizeof extensions / sizeof *extensions && dot; i++)
        is_known = is_known || strcasecmp(dot + 1, extensions[i]) == 0;
    const bool is_stdout = strcmp(run->output, "-") == 0;
    if (!is_known)
        return fail(error, FACET_ERROR_ARGUMENT,
                    is_stdout ? "--output: standard output (%s) needs --format png, jpg, webp, exr, .."
                              : "--output: \"%s\" does not end in .png, .jpg, .webp, .exr, .hdr or .pfm",
                    run->output);
    if (is_stdout && is_given(c, OPT_JSON))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--json: the image goes to standard output (-o -); write one of them elsewhere");
    run->save.format =
        format >= 0 ? (facet_image_format)(FACET_IMAGE_FORMAT_PNG + format) : FACET_IMAGE_FORMAT_FROM_NAME;
    const char *inputs[] = {c->arguments[0], c->arguments[1], option_text(c, OPT_MASK, NULL)};
    for (int i = 0; i < 3; i++)
        if (inputs[i] && !is_stdout && input_is_same_file(inputs[i], run->output))
            return fail(error, FACET_ERROR_ARGUMENT,
                        "%s: this input would be overwritten; name another output with -o", run->output);
    return output_check(run->output, error);
}

static facet_result read_color(compare_run *run, facet_error *error)
{
    const command_line *c = run->base.line;
    facet_compare_desc *d = &run->desc;
    double stops = 0.0;
    d->space = (facet_compare_space)option_choice(c, OPT_SPACE, FACET_COMPARE_SPACE_AUTO);
    d->tonemap = (facet_tonemap)option_choice(c, OPT_TONE_MAPPING, FACET_TONEMAP_NONE);
    if (d->space == FACET_COMPARE_SPACE_LINEAR && d->tonemap != FACET_TONEMAP_NONE)
        return fail(error, FACET_ERROR_ARGUMENT, "--tone-mapping: it has no effect in --space linear");
    if (is_given(c, OPT_EXPOSURE) && !value_exposure(option_text(c, OPT_EXPOSURE, ""), &stops))
        return option_fail(c, OPT_EXPOSURE, "stops such as +0.5, or a factor such as 2x", error);
    d->exposure_ev = (float)stops;
    const char *background = option_text(c, OPT_BACKGROUND, NULL);
    const int otherwise = background ? FACET_COMPARE_ALPHA_BACKGROUND : FACET_COMPARE_ALPHA_CHANNEL;
    d->alpha = (facet_compare_alpha)option_choice(c, OPT_ALPHA, otherwise);
    if (background && !color_parse(background, d->background))
        return option_fail(c, OPT_BACKGROUND, "#rgb, #rrggbb or a CSS color name", error);
    if ((d->alpha == FACET_COMPARE_ALPHA_BACKGROUND) != (background != NULL))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--alpha: background and --background COLOR need each other");
    if (is_given(c, OPT_CROP) && !value_rectangle(option_text(c, OPT_CROP, ""), d->crop))
        return option_fail(c, OPT_CROP, "X,Y,WIDTH,HEIGHT in pixels", error);
    return FACET_OK;
}

static facet_result read_desc(compare_run *run, facet_error *error)
{
    const command_line *c = run->base.line;
    facet_compare_desc *d = &run->desc;
    d->thread_count = run->base.limits.thread_count;
    d->skipped_metrics = compare_wish_skipped(&run->wish);
    d->percentile = option_number(c, OPT_PERCENTILE, 0.0);
    d->threshold = (float)option_number(c, OPT_THRESHOLD, 0.0);
    d->pixels_per_degree = (float)option_number(c, OPT_PIXELS_PER_DEGREE, 0.0);
    d->peak = (float)option_number(c, OPT_PEAK, 0.0);
    d->relative_epsilon = (float)option_number(c, OPT_EPSILON, 0.0);
    d->difference = is_given(c, OPT_HEAT_MAP) ? FACET_DIFFERENCE_HEAT_MAP : FACET_DIFFERENCE_ABSOLUTE;
    d->gain = (float)option_number(c, OPT_GAIN, 0.0);
    d->is_sheet = is_given(c, OPT_SHEET);
    return read_color(run, error);
}

/* ---- the run ---- */

static facet_image_view pixels_of(const facet_image *image)
{
    return facet_image_get_layer(image, 0);
}

/* Loads an image, which must have the size of the first one. */
static facet_result load(compare_run *run, const char *path, const char *layer, facet_image **image,
                         facet_error *error)
{
    const facet_image_load_desc desc = {.allocator = run->desc.allocator,
                                        .thread_count = run->base.limits.thread_count,
                                        .max_size = run->base.limits.max_texture_size,
                                        .layer = layer,
                                        .is_compact = true,
                                        .log = messages_log(&run->base.messages)};
    interrupt_begin_reading(input_name(path));
    facet_result result = input_load_image(path, &desc, image, error);
    if (result != FACET_OK) {
        failure_complete(error, input_name(path), run->base.limits.max_memory_bytes);
        return result;
    }
    const facet_image_view loaded = pixels_of(*image), first = pixels_of(run->a);
    if (loaded.width != first.width || loaded.height != first.height)
        return fail(error, FACET_ERROR_INVALID,
                    "%s: %u x %u pixels, but %s has %u x %u; images of the same size were expected",
                    input_name(path), loaded.width, loaded.height, input_name(run->base.line->arguments[0]),
                    first.width, first.height);
    return FACET_OK;
}

static facet_result load_all(compare_run *run, facet_error *error)
{
    const command_line *c = run->base.line;
    const char *mask = option_text(c, OPT_MASK, NULL), *layer = option_text(c, OPT_LAYER, NULL);
    TRY(load(run, c->arguments[0], layer, &run->a, error));
    TRY(load(run, c->arguments[1], layer, &run->b, error));
    if (mask)
        TRY(load(run, mask, NULL, &run->mask, error));
    run->desc.mask = run->mask;
    return FACET_OK;
}

/* Warns of mixed color spaces and non-finite pixels. */
static void warn(compare_run *run)
{
    const facet_comparison *c = &run->comparison;
    const char *const *names = run->base.line->arguments;
    const bool is_display[] = {facet_image_is_for_display(run->a), facet_image_is_for_display(run->b)};
    const uint64_t nonfinite[] = {c->nonfinite_a, c->nonfinite_b};
    if (is_display[0] != is_display[1] && !is_given(run->base.line, OPT_SPACE))
        message_at(&run->base.messages, VERBOSITY_NORMAL,
                   "%s: it is scene-linear, and %s is for displays; compared as display values%s",
                   input_name(names[is_display[0]]), input_name(names[!is_display[0]]),
                   run->desc.tonemap == FACET_TONEMAP_NONE ? ", clamped (--tone-mapping)" : "");
    facet_log log = messages_log(&run->base.messages);
    for (int i = 0; i < 2; i++) {
        if (!nonfinite[i])
            continue;
        log_warning(&log,
                    nonfinite[i] == 1 ? "%.400s: %llu pixel is not finite"
                                      : "%.400s: %llu pixels are not finite",
                    input_name(names[i]), (unsigned long long)nonfinite[i]);
    }
}

static facet_result compare(compare_run *run, facet_error *error)
{
    interrupt_begin("facet", "comparing", false);
    run->is_kept = run->output && is_given(run->base.line, OPT_NO_CLOBBER) && output_exists(run->output);
    const bool is_drawn = run->output && !run->is_kept;
    facet_result result = facet_compare(run->a, run->b, &run->desc, &run->comparison,
                                        is_drawn ? &run->difference : NULL, error);
    run->is_measured = result == FACET_OK;
    interrupt_end();
    if (result != FACET_OK)
        failure_complete(error, "compare", run->base.limits.max_memory_bytes);
    if (result == FACET_OK && interrupt_signal())
        result = fail(error, FACET_ERROR_CANCELLED, "compare: interrupted");
    if (result == FACET_OK)
        warn(run);
    if (result == FACET_OK && is_drawn)
        result = output_write(run->difference, run->output, &run->save, error);
    if (result == FACET_OK && run->is_kept)
        message_at(&run->base.messages, VERBOSITY_NORMAL, "%s: kept, since it exists", run->output);
    return result;
}

/* ---- the answer ---- */

static json_t *image_json(const char *path, const facet_image *image)
{
    if (!image)
        return json_pack("{s:o}", "path", report_string_json(path));
    return json_pack("{s:o, s:b}", "path", report_string_json(path), "for_display",
                     (int)facet_image_is_for_display(image));
}

static void add_json(const verb_run *base, json_t *root)
{
    const compare_run *run = (const compare_run *)base;
    const command_line *c = base->line;
    json_object_set_new(root, "a", image_json(c->argument_count > 0 ? c->arguments[0] : NULL, run->a));
    json_object_set_new(root, "b", image_json(c->argument_count > 1 ? c->arguments[1] : NULL, run->b));
    if (run->is_measured) {
        json_t *found = compare_report_json(&run->wish, &run->comparison);
        json_object_update(root, found);
        json_decref(found);
        json_object_set_new(root, "passed",
                            run->wish.has_limits ? json_boolean(!run->base.is_negative) : json_null());
    }
    json_object_set_new(root, "output", report_string_json(run->is_written ? run->output : NULL));
}

/* Prints the numbers if they are requested, or if there are no limits. */
static void print_table(const compare_run *run)
{
    const command_line *c = run->base.line;
    const bool is_wanted = run->wish.has_choice || !run->wish.has_limits || is_given(c, OPT_VERBOSE);
    if (!is_wanted || is_given(c, OPT_JSON) || is_given(c, OPT_QUIET))
        return;
    const bool is_taken = run->output && strcmp(run->output, "-") == 0;
    compare_report_table(is_taken ? stderr : stdout, &run->wish, &run->comparison,
                         is_given(c, OPT_PERCENTILE));
    fflush(stdout);
}

/* Reports limits that do not hold in one sentence. */
static void check_limits(compare_run *run)
{
    const char *const *names = run->base.line->arguments;
    char failed[800] = "";
    compare_report_failures(&run->wish, &run->comparison, failed, sizeof failed);
    run->base.is_negative = failed[0] != 0;
    messages_flush(&run->base.messages);
    if (failed[0])
        message_error("%.400s: %s (reference %.400s)", input_name(names[1]), failed, input_name(names[0]));
}

static facet_result read_line(verb_run *base, facet_error *error)
{
    compare_run *run = (compare_run *)base;
    TRY(read_images(run, error));
    TRY(compare_wish_read(base->line, &run->wish, error));
    TRY(read_output(run, error));
    TRY(limits_read(base->line, &base->limits, error));
    return read_desc(run, error);
}

static facet_result work(verb_run *base, facet_error *error)
{
    compare_run *run = (compare_run *)base;
    run->desc.allocator = run->save.allocator = base->allocator;
    run->save.thread_count = base->limits.thread_count;
    TRY(load_all(run, error));
    facet_result result = compare(run, error);
    run->is_written = result == FACET_OK;
    if (run->is_measured) {
        print_table(run);
        check_limits(run);
    }
    return result;
}

static void destroy(verb_run *base)
{
    compare_run *run = (compare_run *)base;
    facet_image_destroy(run->a);
    facet_image_destroy(run->b);
    facet_image_destroy(run->mask);
    facet_image_destroy(run->difference);
}

int cmd_compare(command_line *c)
{
    static const verb_work parts = {read_line, work, add_json, destroy};
    compare_run run = {.output = NULL};
    return verb_run_all(&run.base, c, &parts);
}
