/* cmd_farm.c - facet farm: a command in shards on a cluster. */
#include "cli/shared/options.h"

#include "base/text.h"
#include "cli/farm/farm_slurm.h"
#include "cli/farm/farm_status.h"
#include "cli/farm/farm_submit.h"
#include "cli/shared/failure.h"
#include "cli/shared/terminal.h"
#include "cli/shared/verb_run.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const verb farm_verb = {
    .name = "farm",
    .summary = "run a catalog, a large image or an animation on a cluster",
    .arguments = "submit|status|retry [-- COMMAND...]",
    .max_arguments = SIZE_MAX,
    .words = OPTION_WORDS("submit", "status", "retry"),
    .description = "Divides a command with --shard (facet batch, facet render) into shards of some minutes "
                   "and submits them to "
                   "Slurm as a job array, followed by a job that puts parts together and says what is "
                   "missing. The command "
                   "follows after --, without --shard.\n\n"
                   "facet farm submit writes the scripts of the run into the folder of --run and submits "
                   "them; --dry-run "
                   "prints them, --print-commands prints a command per shard for other engines.\n\n"
                   "facet farm status says what is done, failed, running and missing; the exit code is 0 if "
                   "all is done, else "
                   "1. facet farm retry submits the shards that are unfinished and no longer in Slurm; what "
                   "failed for good, "
                   "such as an invalid model, only with --with-failed.",
    .examples =
        (const example[]){
            {"facet farm submit -- batch --manifest jobs.jsonl -- --size 256",
             "a catalog, in shards of about 3 min"},
            {"facet farm submit --shards 40 --shard-cpus 16 -- render huge.glb -o huge.exr --size "
             "32768x16384",
             "one large image"},
            {"facet farm submit --print-commands -- batch --manifest jobs.jsonl | parallel --joblog log",
             "with GNU parallel, without a cluster"},
            {"facet farm status", "what is done"},
            {"facet farm retry", "submit what is missing"},
            {NULL, NULL}},
    .groups =
        (const option_group *const[]){
            OPTION_GROUP("Run", OPT_RUN, OPT_SHARDS, OPT_TARGET_TIME, OPT_WITH_FAILED, OPT_DRY_RUN,
                         OPT_PRINT_COMMANDS),
            OPTION_GROUP("Slurm", OPT_SHARD_CPUS, OPT_SHARD_MEMORY, OPT_SHARD_TIME, OPT_AT_ONCE, OPT_SBATCH),
            OPTION_GROUP("Messages", OPT_QUIET, OPT_VERBOSE, OPT_JSON, OPT_HELP, OPT_HELP_ALL), NULL},
};

enum { FARM_SUBMIT, FARM_STATUS, FARM_RETRY };

typedef struct farm_verb_run {
    verb_run base;
    int action;                 /* FARM_SUBMIT, .. */
    farm_submission submission; /* of submit */
    farm_run run;
    farm_status status; /* of status and retry */
    bool *chosen;       /* shards that are submitted or printed */
} farm_verb_run;

static facet_result read(verb_run *base, facet_error *error)
{
    farm_verb_run *f = (farm_verb_run *)base;
    const command_line *c = base->line;
    static const char *const actions[] = {"submit", "status", "retry"};
    int action = 0;
    while (c->argument_count && action < 3 && strcmp(c->arguments[0], actions[action]) != 0)
        action++;
    if (c->argument_count == 0 || action == 3)
        return fail(error, FACET_ERROR_ARGUMENT, "farm: %s%.60s%s submit, status or retry comes first",
                    c->argument_count ? "\"" : "what to do?", c->argument_count ? c->arguments[0] : "",
                    c->argument_count ? "\" is unknown;" : "");
    f->action = action;
    if (action == FARM_SUBMIT)
        return farm_submission_read(c, &f->submission, error);
    if (c->argument_count > 1)
        return fail(error, FACET_ERROR_ARGUMENT, "farm: %s takes no command; it has that of the run",
                    actions[action]);
    return farm_run_load(option_text(c, OPT_RUN, FARM_DEFAULT_FOLDER), &f->run, error);
}

/* ---- submission ---- */

/* Submits the chosen shards; a failure says how to go on. */
static facet_result submit_chosen(farm_verb_run *f, facet_error *error)
{
    facet_error reason;
    facet_result result = farm_slurm_submit(&f->run, f->chosen, &reason);
    if (result == FACET_OK)
        return FACET_OK;
    return fail(error, result,
                "%s; the run is in %.1000s: facet farm retry submits it, and with --print-commands "
                "another engine can do it",
                reason.message, f->run.folder);
}

/* Submits the chosen shards, or prints their commands. */
static facet_result start(farm_verb_run *f, facet_error *error)
{
    const command_line *c = f->base.line;
    text lines = {0};
    uint32_t count = 0;
    for (uint32_t i = 0; i < f->run.shard_count; i++)
        if (f->chosen[i]) {
            farm_script_line(f->run.folder, i, &lines);
            count++;
        }
    facet_result result = lines.has_failed ? fail_memory(error, "commands", 0) : FACET_OK;
    if (result == FACET_OK && count && is_given(c, OPT_PRINT_COMMANDS))
        fputs(lines.data, stdout);
    else if (result == FACET_OK && count)
        result = submit_chosen(f, error);
    text_destroy(&lines);
    if (result == FACET_OK && !is_given(c, OPT_PRINT_COMMANDS))
        message_at(&f->base.messages, VERBOSITY_NORMAL, "%s: %u of %u shards submitted", f->run.folder, count,
                   f->run.shard_count);
    return result;
}

static facet_result submit(farm_verb_run *f, facet_error *error)
{
    if (is_given(f->base.line, OPT_DRY_RUN))
        return farm_submission_print(&f->submission, error);
    TRY(farm_submission_prepare(&f->submission, &f->run, error));
    f->chosen = malloc(f->run.shard_count * sizeof *f->chosen);
    if (!f->chosen)
        return fail_memory(error, "shards", f->run.shard_count);
    memset(f->chosen, true, f->run.shard_count);
    return start(f, error);
}

/* ---- status and retry ---- */

/* Prints "  shards WHAT: 2 (3,17)" for the chosen shards, unless there are none. */
static void print_shards(const farm_verb_run *f, uint32_t count, const char *what)
{
    char *list = count ? farm_shard_list(f->chosen, f->run.shard_count) : NULL;
    if (list)
        printf("  shards %s: %u (%.200s%s)\n", what, count, list, strlen(list) > 200 ? ".." : "");
    free(list);
}

static bool is_missing(const farm_shard *s)
{
    return s->place == FARM_NOWHERE && !farm_shard_is_finished(s);
}

/* Prints the failures, each "NAME: MESSAGE". */
static void print_failures(const farm_status *s)
{
    size_t index;
    json_t *failure;
    json_array_foreach(s->failures, index, failure)
    {
        const char *name = json_string_value(json_object_get(failure, "name"));
        const char *message = json_string_value(json_object_get(failure, "message"));
        char line[700];
        snprintf(line, sizeof line, "    %.200s%s%.400s", name ? name : "", name ? ": " : "",
                 message ? message : "failed");
        terminal_disarm(line);
        puts(line);
    }
    if (s->failed + s->to_retry > FARM_FAILURES)
        printf("    and %llu more\n", (unsigned long long)(s->failed + s->to_retry - FARM_FAILURES));
}

static void print_status(farm_verb_run *f)
{
    const farm_status *s = &f->status;
    const char *what = farm_run_is_catalog(&f->run) ? "items" : "shards";
    printf("%s: %llu of %llu %s done\n", f->run.folder, (unsigned long long)s->done,
           (unsigned long long)s->items, what);
    for (uint32_t i = 0; i < f->run.shard_count; i++)
        f->chosen[i] = s->shards[i].place == FARM_RUNNING;
    print_shards(f, s->running, "running");
    for (uint32_t i = 0; i < f->run.shard_count; i++)
        f->chosen[i] = s->shards[i].place == FARM_WAITING;
    print_shards(f, s->waiting, "waiting");
    for (uint32_t i = 0; i < f->run.shard_count; i++)
        f->chosen[i] = is_missing(&s->shards[i]);
    print_shards(f, s->missing, "unfinished");
    for (uint32_t i = 0; i < f->run.shard_count; i++)
        if (f->chosen[i] && s->shards[i].history[0])
            printf("    shard %u: %s\n", i, s->shards[i].history);
    if (s->failed)
        printf("  %s failed: %llu\n", what, (unsigned long long)s->failed);
    if (s->to_retry)
        printf("  %s failed, and are tried again by facet farm retry: %llu\n", what,
               (unsigned long long)s->to_retry);
    print_failures(s);
}

static facet_result retry(farm_verb_run *f, facet_error *error)
{
    bool has_failed = is_given(f->base.line, OPT_WITH_FAILED);
    for (uint32_t i = 0; i < f->run.shard_count; i++) {
        const farm_shard *s = &f->status.shards[i];
        f->chosen[i] = is_missing(s) || (has_failed && s->failed && s->place == FARM_NOWHERE);
    }
    return start(f, error);
}

static facet_result work(verb_run *base, facet_error *error)
{
    farm_verb_run *f = (farm_verb_run *)base;
    if (f->action == FARM_SUBMIT)
        return submit(f, error);
    TRY(farm_status_read(&f->run, &f->status, error));
    f->chosen = calloc(f->run.shard_count, sizeof *f->chosen);
    if (!f->chosen)
        return fail_memory(error, "shards", f->run.shard_count);
    if (f->action == FARM_RETRY)
        return retry(f, error);
    base->is_negative = !farm_status_is_complete(&f->status);
    if (!is_given(base->line, OPT_JSON))
        print_status(f);
    return FACET_OK;
}

/* ---- the object of --json ---- */

static void add_json(const verb_run *base, json_t *root)
{
    const farm_verb_run *f = (const farm_verb_run *)base;
    json_object_set_new(root, "run", report_string_json(f->run.folder));
    json_object_set_new(root, "shards", json_integer(f->run.shard_count));
    json_object_set(root, "jobs", json_object_get(f->run.root, "jobs"));
    if (f->action == FARM_SUBMIT || !f->status.shards)
        return;
    const farm_status *s = &f->status;
    json_t *counts = json_pack("{s:I, s:I, s:I, s:I, s:I, s:I, s:O}", "items", (json_int_t)s->items, "done",
                               (json_int_t)s->done, "failed", (json_int_t)s->failed, "shards_running",
                               (json_int_t)s->running, "shards_waiting", (json_int_t)s->waiting,
                               "shards_unfinished", (json_int_t)s->missing, "failed_items", s->failures);
    json_object_update(root, counts);
    json_decref(counts);
}

static void destroy(verb_run *base)
{
    farm_verb_run *f = (farm_verb_run *)base;
    farm_submission_destroy(&f->submission);
    farm_status_destroy(&f->status);
    farm_run_destroy(&f->run);
    free(f->chosen);
}

int cmd_farm(command_line *c)
{
    static const verb_work parts = {read, work, add_json, destroy};
    farm_verb_run f = {0};
    return verb_run_all(&f.base, c, &parts);
}
