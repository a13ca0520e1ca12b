/* part_options.c - --shard and --shard-by of facet render and facet ocean: which frames are rendered, or which part of an
 * image; the names of parts, and the command that makes any of them. */
#include "cli/render/render_options.h"

#include "cli/shared/failure.h"
#include "cli/shared/output.h"
#include "cli/shared/shell_line.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BY_FRAMES, BY_TILES, BY_SAMPLES }; /* choices of --shard-by */

/* Whether the options ask for several images. */
static bool has_several(const command_line *c)
{
    const char *animation = option_text(c, OPT_ANIMATION, NULL);
    bool is_still = is_given(c, OPT_TIME) || (animation && strcmp(animation, "none") == 0);
    frame_list frames;
    if (is_given(c, OPT_FRAMES))
        return !frame_list_parse(option_text(c, OPT_FRAMES, ""), &frames) || frames.frame_count > 1;
    return is_given(c, OPT_TURNTABLE) ||
           (!is_still && (animation || is_given(c, OPT_FPS) || is_given(c, OPT_LOOP)));
}

facet_result part_options_read(const command_line *c, render_options *out, facet_error *error)
{
    TRY(shard_read(c, &out->shard, error));
    if (!is_given(c, OPT_SHARD))
        return is_given(c, OPT_SHARD_BY)
                   ? fail(error, FACET_ERROR_ARGUMENT, "--shard-by: it needs --shard I/N")
                   : FACET_OK;
    int by = option_choice(c, OPT_SHARD_BY, has_several(c) ? BY_FRAMES : BY_TILES);
    if (by == BY_FRAMES && !has_several(c))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--shard-by: there is one frame only; divide it by tiles or samples");
    out->has_shard = true;
    if (by != BY_FRAMES)
        out->desc.part =
            (facet_part_desc){.index = out->shard.index,
                              .count = out->shard.count,
                              .split = by == BY_TILES ? FACET_PART_SPLIT_TILES : FACET_PART_SPLIT_SAMPLES,
                              .has_display_tonemap = !is_given(c, OPT_TONE_MAPPING)};
    return FACET_OK;
}

bool part_options_has_frame(const render_options *o, uint32_t index)
{
    return !o->has_shard || o->desc.part.count || shard_has(o->shard, index);
}

uint32_t part_options_frame_count(const render_options *o, uint32_t frame_count)
{
    return o->has_shard && !o->desc.part.count ? (uint32_t)shard_size(o->shard, frame_count) : frame_count;
}

/* ---- names ---- */

static const char MARK[] = "{shard}";

static int digits_of_last(uint32_t count)
{
    return snprintf(NULL, 0, "%u", count - 1);
}

/* Finds the number of the part in a name, the last one of its base name: *length digits. NULL: it is not there. */
static const char *find_number(const char *name, uint32_t index, size_t *length)
{
    const char *slash = strrchr(name, '/'), *found = NULL;
    for (const char *at = slash ? slash + 1 : name; *at;) {
        size_t digits = strspn(at, "0123456789");
        if (digits > 0 && digits <= 9 && strtoul(at, NULL, 10) == index) {
            found = at;
            *length = digits;
        }
        at += digits ? digits : 1;
    }
    return found;
}

/* Splits the output into what is before and after the part's number, of *width digits at least. */
static facet_result split_name(const render_options *o, const char **rest, int *width, facet_error *error)
{
    const char *mark = strstr(o->output, MARK);
    size_t length = strlen(MARK);
    *width = digits_of_last(o->shard.count);
    if (!mark) {
        mark = find_number(o->output, o->shard.index, &length);
        *width = (int)length;
    }
    if (!mark)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--output: \"%s\" is one name for all parts; put {shard} in it, as in part_{shard}.exr",
                    o->output);
    *rest = mark + length;
    return FACET_OK;
}

/* The name with the part's number, or with the placeholder that facet merge fills in. */
static size_t put_name(const render_options *o, const char *rest, int width, bool is_open, char *name,
                       size_t size)
{
    const char *mark = strstr(o->output, MARK);
    size_t number = mark ? strlen(MARK) : (size_t)width;
    int before = (int)(rest - o->output) - (int)number;
    if (is_open)
        return (size_t)snprintf(name, size, "%.*s{part:%d}%s", before, o->output, width, rest);
    return (size_t)snprintf(name, size, "%.*s%0*u%s", before, o->output, width, o->shard.index, rest);
}

/* Whether an option belongs to one process rather than to its image. */
static bool is_of_process(option_id id)
{
    return option_is_among(id,
                           OPTION_IDS(OPT_OUTPUT, OPT_SHARD, OPT_THREADS, OPT_QUIET, OPT_VERBOSE, OPT_JSON,
                                      OPT_PROGRESS, OPT_NO_CLOBBER, OPT_CHECKPOINT, OPT_RESUME));
}

/* The command that makes a part, with placeholders for its number. */
static facet_result make_command(const command_line *c, const char *name, render_options *out,
                                 facet_error *error)
{
    shell_line l = {.text = NULL};
    const option *o;
    char part[64];
    shell_line_add_word(&l, "facet");
    shell_line_add_word(&l, c->verb->name);
    for (size_t i = 0; i < c->argument_count; i++)
        shell_line_add_word(&l, c->arguments[i]);
    for (size_t i = 0; (o = option_at(c->verb, i)); i++) {
        const option_value *v = &c->values[o->id];
        if (v->source != SOURCE_COMMAND_LINE || is_of_process(o->id))
            continue;
        if (o->kind != OPTION_TEXTS)
            shell_line_add_option(&l, o, v->text ? v->text : "");
        for (unsigned k = 0; o->kind == OPTION_TEXTS && k < v->count; k++)
            shell_line_add_option(&l, o, v->texts[k]);
    }
    shell_line_add_word(&l, "-o");
    shell_line_add_word(&l, name);
    snprintf(part, sizeof part, " --shard {part:1}/%u", out->shard.count);
    shell_line_add_bytes(&l, part, strlen(part));
    bool fits = !l.has_failed && l.length < sizeof out->part_command;
    if (fits)
        memcpy(out->part_command, l.text, l.length + 1);
    free(l.text);
    out->desc.part.command = out->part_command;
    return fits ? FACET_OK
                : fail(error, FACET_ERROR_ARGUMENT,
                       "--shard: the command line is too long to be kept in a part");
}

facet_result part_options_name(const command_line *c, render_options *out, facet_error *error)
{
    char name[sizeof out->part_output];
    const char *rest = NULL;
    int width = 0;
    if (!out->desc.part.count)
        return FACET_OK;
    if (!out->output)
        out->output = "{stem}_{shard}.exr";
    if (out->is_stdout)
        return make_command(c, "part_{part:1}.exr", out, error);
    TRY(split_name(out, &rest, &width, error));
    if (put_name(out, rest, width, true, name, sizeof name) >= sizeof name)
        return fail(error, FACET_ERROR_ARGUMENT, "--output: the name is too long");
    TRY(make_command(c, name, out, error));
    put_name(out, rest, width, false, out->part_output, sizeof out->part_output);
    out->output = out->part_output;
    return FACET_OK;
}

/* ---- what cannot be divided ---- */

facet_result part_options_check(const render_options *o, facet_error *error)
{
    const facet_part_desc *p = &o->desc.part;
    bool by_samples = p->split == FACET_PART_SPLIT_SAMPLES;
    if (!o->has_shard)
        return FACET_OK;
    if (o->video)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--shard: a video has all frames in one file; render images, as in frame_####.png");
    if (!p->count)
        return FACET_OK;
    if (o->renderer.features & FACET_RENDERER_FEATURE_GL)
        return fail(
            error, FACET_ERROR_ARGUMENT,
            "--shard-by: --renderer gl is divided by frames only; tiles need --renderer preview or path");
    if (by_samples && !(o->renderer.features & FACET_RENDERER_FEATURE_PATH))
        return fail(error, FACET_ERROR_ARGUMENT, "--shard-by: samples need --renderer path");
    if (o->desc.path.noise > 0.0f)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--noise: which pixels get more samples depends on pixels of other parts; give --samples "
                    "alone, or "
                    "divide by frames");
    if (by_samples && o->desc.aovs & FACET_AOV_CRYPTOMATTE)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--aov: the ranks of Cryptomatte depend on all samples of a pixel; divide by tiles");
    return FACET_OK;
}
