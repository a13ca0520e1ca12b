/* batch_plan.c - see batch_plan.h. */
#define _GNU_SOURCE
#include "cli/batch/batch_plan.h"

#include "cli/shared/failure.h"
#include "cli/shared/limits.h"
#include "cli/shared/output.h"
#include "cli/shared/value.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Time after which an item without --time-limit is ended, s: a hang must not hold a batch for ever. */
static const double default_time_limit_s = 600.0;

const char *const batch_commands[] = {"render",  "ocean", "bake",    "convert",
                                      "inspect", "plot",  "compare", NULL};

const verb *batch_find_command(const char *name)
{
    for (const char *const *command = batch_commands; *command; command++)
        if (strcmp(*command, name) == 0)
            return verb_find(name);
    return NULL;
}

static facet_result read_limits(const command_line *c, batch_plan *out, facet_error *error)
{
    limits all;
    TRY(limits_read(c, &all, error));
    out->core_count = facet_thread_count();
    out->job_count = (unsigned)option_number(c, OPT_JOBS, (double)out->core_count);
    out->alone_bytes = out->max_memory_bytes = all.max_memory_bytes;
    if (!is_given(c, OPT_MAX_MEMORY)) /* items at a time share what the machine has */
        out->max_memory_bytes /= out->job_count;
    out->time_text = option_text(c, OPT_TIME_LIMIT, NULL);
    out->time_limit_s = out->time_text ? all.time_limit_s : default_time_limit_s;
    return FACET_OK;
}

/* The name of outputs, which has a default for images only. */
static facet_result read_output(const command_line *c, batch_plan *out, facet_error *error)
{
    out->output = option_text(c, OPT_OUTPUT, NULL);
    if (!out->output && strcmp(out->verb->name, "render") == 0)
        out->output = "{stem}.png";
    if (!out->output)
        return FACET_OK;
    if (strcmp(out->output, "-") == 0)
        return fail(
            error, FACET_ERROR_ARGUMENT,
            "--output: items cannot share standard output; a name such as 'thumbs/{stem}.png' was expected");
    return output_name_check("--output", out->output, OUTPUT_NAME_WORDS, error);
}

/* The name of a file that each shard has of its own, where it contains {shard}. */
static facet_result read_file(const command_line *c, option_id id, const batch_plan *plan, char **name,
                              facet_error *error)
{
    static const char mark[] = "{shard}";
    const char *text = option_text(c, id, NULL);
    if (!text)
        return FACET_OK;
    const char *at = strstr(text, mark);
    int length = at ? asprintf(name, "%.*s%u%s", (int)(at - text), text, plan->shard.index, at + strlen(mark))
                    : asprintf(name, "%s", text);
    if (length >= 0)
        return FACET_OK;
    *name = NULL;
    return fail_memory(error, "names of files", 0);
}

facet_result batch_plan_read(const command_line *c, batch_plan *out, facet_error *error)
{
    *out = (batch_plan){.verb = batch_find_command(option_text(c, OPT_COMMAND, "render")),
                        .words = c->arguments + c->dashed_index,
                        .word_count = c->argument_count - c->dashed_index,
                        .gallery = option_text(c, OPT_GALLERY, NULL),
                        .verifies = is_given(c, OPT_VERIFY),
                        .is_dry = is_given(c, OPT_DRY_RUN),
                        .result_pattern = option_text(c, OPT_RESULTS, NULL),
                        .manifest = option_text(c, OPT_MANIFEST, NULL),
                        .has_shard = is_given(c, OPT_SHARD)};
    if (is_given(c, OPT_RESUME))
        out->resume = option_text(c, OPT_RESUME, NULL) ? RESUME_CONTENT : RESUME_SETTINGS;
    if (c->dashed_index == 0 && !out->manifest && !is_given(c, OPT_FILES_FROM))
        return fail(
            error, FACET_ERROR_ARGUMENT,
            "batch: which models? facet batch models/ -o 'thumbs/{stem}.png', or --manifest FILE.jsonl");
    TRY(read_limits(c, out, error));
    TRY(read_output(c, out, error));
    TRY(shard_read(c, &out->shard, error));
    TRY(read_file(c, OPT_RESULTS, out, &out->results, error));
    return read_file(c, OPT_FAILED, out, &out->failed, error);
}

void batch_plan_destroy(batch_plan *plan)
{
    free(plan->results);
    free(plan->failed);
}
