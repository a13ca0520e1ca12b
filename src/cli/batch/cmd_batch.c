/* cmd_batch.c - facet batch: renders or converts many models, each in a process of its own. */
#define _POSIX_C_SOURCE 200809L
#include "cli/shared/options.h"

#include "cli/batch/batch_run.h"
#include "cli/batch/batch_survey.h"
#include "cli/jobs/job_warm.h"
#include "cli/shared/failure.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/verb_run.h"

#include <glob.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const verb batch_verb = {
    .name = "batch",
    .summary = "render or convert many models, each in a process of its own",
    .arguments = "[MODEL|FOLDER...] [-- OPTION...]",
    .max_arguments = SIZE_MAX,
    .file_types = "glb gltf obj stl ply json",
    .description = "Renders each MODEL, and the models in and below each FOLDER, with the options of facet "
                   "render after --. With "
                   "--manifest each line of a file is an item: a JSON object with input, output and options "
                   "by their long names; "
                   "command names another verb (bake, convert, inspect, ..).\n\n"
                   "Every item runs in a process of its own, with limits of time and memory, so that a model "
                   "that crashes, hangs or "
                   "exhausts the memory is reported and the others go on. The environment is prepared once "
                   "for all. Outputs "
                   "appear whole or not at all, and are the bytes that the verb alone writes, except for the "
                   "hash of the settings in "
                   ".png and .exr files by which --resume finds what is done.\n\n"
                   "Invalid models fail at once. Reading and writing is tried again after 1, 4 and 16 s; a "
                   "crash, a hang or lack of "
                   "memory once, alone and with half of the threads. SIGTERM lets running items end for 20 "
                   "s; exit 75 then says that "
                   "there is more to do, as it does when three models in a row fail as if by the machine. "
                   "batch.md of facet help "
                   "documents has the rules and the format of manifests and results.",
    .examples =
        (const example[]){
            {"facet batch models/ -o 'thumbs/{dir}/{stem}.png' -- --size 256", "thumbnails of a folder"},
            {"facet batch *.glb -o 'thumbs/{stem}.png' --resume --results results.jsonl -- --size 256",
             "again, only what is new or was rendered with other settings"},
            {"facet batch --manifest jobs.jsonl --results results.jsonl", "items with options of their own"},
            {"facet batch --manifest jobs.jsonl --shard auto --results 'results.{shard}.jsonl' --resume",
             "one of many processes on a cluster"},
            {"producer | facet batch --manifest - --results results.jsonl", "items as they come"},
            {"facet batch old/ --command convert -o 'new/{dir}/{stem}.glb'", "another verb than render"},
            {NULL, NULL}},
    .basics = OPTION_IDS(OPT_OUTPUT, OPT_MANIFEST, OPT_COMMAND, OPT_JOBS, OPT_RESUME, OPT_RESULTS, OPT_FAILED,
                         OPT_GALLERY, OPT_VERIFY, OPT_SHARD, OPT_TIME_LIMIT, OPT_MAX_MEMORY, OPT_PROGRESS),
    .groups =
        (const option_group *const[]){
            OPTION_GROUP("Items", OPT_OUTPUT, OPT_MANIFEST, OPT_FILES_FROM, OPT_COMMAND, OPT_SHARD),
            OPTION_GROUP("Running", OPT_JOBS, OPT_TIME_LIMIT, OPT_MAX_MEMORY, OPT_RESUME, OPT_PROGRESS,
                         OPT_CONFIG),
            OPTION_GROUP("Results", OPT_RESULTS, OPT_FAILED, OPT_GALLERY, OPT_VERIFY, OPT_DRY_RUN),
            OPTION_GROUP("Messages", OPT_QUIET, OPT_VERBOSE, OPT_JSON, OPT_HELP, OPT_HELP_ALL), NULL},
};

typedef struct batch_verb_run {
    verb_run base;
    batch_plan plan;
    command_line models_line; /* the models, as the verb of the items takes them */
    model_list models;
    batch_run run;
    batch_survey survey;
} batch_verb_run;

/* ---- reading ---- */

/* Lists the models of the command line. */
static facet_result read_models(batch_verb_run *b, facet_error *error)
{
    const command_line *c = b->base.line;
    command_line *m = &b->models_line;
    if (c->dashed_index == 0 && !is_given(c, OPT_FILES_FROM))
        return FACET_OK;
    *m = (command_line){.verb = b->plan.verb, .argument_count = c->dashed_index};
    m->values[OPT_FILES_FROM] = c->values[OPT_FILES_FROM];
    m->values[OPT_FILES_FROM].texts = NULL;
    m->arguments = malloc((c->dashed_index + 1) * sizeof *m->arguments);
    if (!m->arguments)
        return fail_memory(error, "names of models", 0);
    memcpy(m->arguments, c->arguments, c->dashed_index * sizeof *m->arguments);
    for (size_t i = 0; i < m->argument_count; i++)
        if (strcmp(m->arguments[i], "-") == 0)
            return fail(error, FACET_ERROR_ARGUMENT, "batch: standard input cannot be a model of several");
    return model_list_create(m, m->argument_count, &b->models, error);
}

/* Checks the options of all items, and prepares what they share. */
static facet_result read_words(const batch_verb_run *b, facet_error *error)
{
    const batch_plan *plan = &b->plan;
    job_words w = {.words = NULL};
    job_words_add(&w, plan->verb->name);
    for (size_t i = 0; i < plan->word_count; i++)
        job_words_add(&w, plan->words[i]);
    command_line line = {.verb = NULL};
    facet_result result = job_words_check(&w, error);
    if (result == FACET_OK)
        result = command_line_parse(plan->verb, (int)w.count - 1, w.words + 1, &line, error);
    if (result == FACET_OK && line.argument_count)
        result = fail(
            error, FACET_ERROR_ARGUMENT,
            "batch: \"%.300s\" stands after --, where the options of facet %s are expected; models stand "
            "before it",
            line.arguments[0], plan->verb->name);
    else if (result == FACET_OK && is_given(&line, OPT_OUTPUT))
        result =
            fail(error, FACET_ERROR_ARGUMENT, "--output: it stands before --, as an option of facet batch");
    else if (result == FACET_OK && (is_given(&line, OPT_HELP) || is_given(&line, OPT_HELP_ALL)))
        result = fail(error, FACET_ERROR_ARGUMENT, "batch: facet help %s lists the options after --",
                      plan->verb->name);
    command_line_destroy(&line);
    if (result == FACET_OK)
        result = job_warm(&w, error);
    job_words_destroy(&w);
    return result;
}

static facet_result read_line(verb_run *base, facet_error *error)
{
    batch_verb_run *b = (batch_verb_run *)base;
    TRY(batch_plan_read(base->line, &b->plan, error));
    return read_models(b, error);
}

/* ---- the run ---- */

/* Reads the results of earlier runs; for --verify of all shards those of all of them. */
static facet_result read_history(batch_verb_run *b, facet_error *error)
{
    const batch_plan *plan = &b->plan;
    batch_run *run = &b->run;
    if (!plan->results || (plan->resume == RESUME_NOTHING && !plan->verifies))
        return FACET_OK;
    const char *at = strstr(plan->result_pattern, "{shard}");
    if (!plan->verifies || plan->has_shard || !at)
        return batch_history_read(&run->history, run->reasons, plan->results, error);
    char pattern[BATCH_NAME_SIZE];
    glob_t found = {.gl_pathc = 0};
    snprintf(pattern, sizeof pattern, "%.*s[0-9]*%s", (int)(at - plan->result_pattern), plan->result_pattern,
             at + strlen("{shard}"));
    facet_result result = FACET_OK;
    if (glob(pattern, 0, NULL, &found) == 0)
        for (size_t i = 0; i < found.gl_pathc && result == FACET_OK; i++)
            result = batch_history_read(&run->history, run->reasons, found.gl_pathv[i], error);
    globfree(&found);
    return result;
}

/* Writes the gallery, or verifies, without running anything. */
static facet_result survey(batch_verb_run *b, facet_error *error)
{
    batch_survey *s = &b->survey;
    *s = (batch_survey){.plan = &b->plan,
                        .models = b->models.count ? &b->models : NULL,
                        .history = &b->run.history,
                        .messages = b->run.reasons};
    facet_result result = FACET_OK;
    if (b->plan.verifies)
        result = batch_verify(s, is_given(b->base.line, OPT_JSON), error);
    if (result == FACET_OK && b->plan.gallery)
        result = batch_gallery_write(s, b->plan.gallery, error);
    if (b->plan.verifies && result == FACET_OK) {
        b->base.is_negative = s->failed || s->missing;
        message_at(&b->base.messages, VERBOSITY_NORMAL,
                   "batch: %" PRIu64 " done, %" PRIu64 " failed, %" PRIu64 " missing", s->done, s->failed,
                   s->missing);
    }
    return result;
}

static facet_result run_all(batch_verb_run *b, facet_error *error)
{
    verb_run *base = &b->base;
    batch_run *run = &b->run;
    const batch_plan *plan = &b->plan;
    facet_result result = batch_run_all(run, error);
    const batch_progress *p = &run->progress;
    char time[BATCH_TIME_SIZE];
    batch_time_text(interrupt_clock() - p->start, time);
    if (!plan->is_dry)
        message_at(&base->messages, VERBOSITY_NORMAL,
                   "batch: %" PRIu64 " done, %" PRIu64 " kept, %" PRIu64 " failed in %s", p->done, p->kept,
                   p->failed, time);
    base->is_negative = p->failed > 0;
    if (result == FACET_OK && plan->has_shard && run->for_others)
        return fail(error, FACET_ERROR_CANCELLED,
                    "batch: %" PRIu64
                    " items failed as if by this machine; the shard can be run again elsewhere",
                    run->for_others);
    return result;
}

static facet_result work(verb_run *base, facet_error *error)
{
    batch_verb_run *b = (batch_verb_run *)base;
    batch_run *run = &b->run;
    const batch_plan *plan = &b->plan;
    run->plan = plan;
    run->messages = &base->messages;
    run->failures = base->failures;
    run->progress.mode = base->progress;
    run->reasons = plan->gallery || plan->verifies ? json_object() : NULL;
    TRY(read_words(b, error));
    TRY(read_history(b, error));
    if (plan->verifies)
        return survey(b, error);
    TRY(batch_source_open(plan, b->models.count ? &b->models : NULL, &run->source, error));
    run->progress.total = batch_source_count(run->source);
    if (!plan->is_dry) {
        TRY(batch_lines_open(plan->results, &run->results, error));
        TRY(batch_lines_open(plan->failed, &run->failed, error));
    }
    facet_result result = run_all(b, error), surveyed = FACET_OK;
    facet_error gallery_error;
    if (plan->gallery && !plan->is_dry)
        surveyed = survey(b, &gallery_error);
    if (result == FACET_OK && surveyed != FACET_OK)
        *error = gallery_error;
    return result == FACET_OK ? surveyed : result;
}

static void add_json(const verb_run *base, json_t *root)
{
    const batch_verb_run *b = (const batch_verb_run *)base;
    const batch_progress *p = &b->run.progress;
    if (b->plan.verifies) {
        json_t *states = json_pack("{s:I, s:I, s:I}", "done", (json_int_t)b->survey.done, "failed",
                                   (json_int_t)b->survey.failed, "missing", (json_int_t)b->survey.missing);
        json_object_update(root, states);
        json_decref(states);
        return;
    }
    json_t *counts = json_pack("{s:I, s:I, s:I}", "done", (json_int_t)p->done, "kept", (json_int_t)p->kept,
                               "failed", (json_int_t)p->failed);
    json_object_update(root, counts);
    json_decref(counts);
}

static void destroy(verb_run *base)
{
    batch_verb_run *b = (batch_verb_run *)base;
    json_decref(b->run.reasons);
    batch_run_destroy(&b->run);
    batch_plan_destroy(&b->plan);
    model_list_destroy(&b->models);
    command_line_destroy(&b->models_line);
}

int cmd_batch(command_line *c)
{
    static const verb_work parts = {read_line, work, add_json, destroy};
    batch_verb_run b = {.plan = {.verb = NULL}, .run = {.results = {.fd = -1}, .failed = {.fd = -1}}};
    return verb_run_all(&b.base, c, &parts);
}
