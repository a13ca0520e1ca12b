/* farm_submit.c - see farm_submit.h. */
#define _DEFAULT_SOURCE /* readlink(), getcwd() */
#include "cli/farm/farm_submit.h"

#include "cli/farm/farm_program.h"
#include "cli/farm/farm_slurm.h"
#include "cli/shared/failure.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/output.h"
#include "cli/shared/shard.h"
#include "cli/shared/value.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- options ---- */

static facet_result read_seconds(const command_line *c, option_id id, double *seconds, facet_error *error)
{
    const char *given = option_text(c, id, NULL);
    if (given && !value_seconds(given, seconds))
        return option_fail(c, id, "a time, as 90s, 5m or 1h", error);
    return FACET_OK;
}

static facet_result find_places(farm_submission *s, facet_error *error)
{
    ssize_t length = readlink("/proc/self/exe", s->program, sizeof s->program - 1);
    if (length < 0)
        length = snprintf(s->program, sizeof s->program, "facet"); /* the one in PATH */
    s->program[length] = 0;
    if (!getcwd(s->place, sizeof s->place))
        return fail(error, FACET_ERROR_READ, "farm: the current folder has no path: %s", strerror(errno));
    s->script.program = s->program;
    s->script.place = s->place;
    return FACET_OK;
}

static facet_result read_script(farm_submission *s, facet_error *error)
{
    const command_line *c = s->line;
    const char *memory = option_text(c, OPT_SHARD_MEMORY, NULL);
    s->target_s = 180.0;
    TRY(read_seconds(c, OPT_TARGET_TIME, &s->target_s, error));
    s->script.time_limit_s = fmax(10.0 * s->target_s, 1800.0);
    TRY(read_seconds(c, OPT_SHARD_TIME, &s->script.time_limit_s, error));
    if (memory && !value_bytes(memory, &s->script.memory_bytes))
        return option_fail(c, OPT_SHARD_MEMORY, "a size, as 512M or 8G", error);
    s->script.command = &s->command;
    s->script.cpu_count = (uint32_t)option_number(c, OPT_SHARD_CPUS, 4.0);
    s->script.at_once = (uint32_t)option_number(c, OPT_AT_ONCE, 0.0);
    s->script.shard_count = (uint32_t)option_number(c, OPT_SHARDS, 0.0);
    return find_places(s, error);
}

facet_result farm_submission_read(const command_line *c, farm_submission *out, facet_error *error)
{
    out->line = c;
    TRY(farm_command_read(c->arguments + 1, c->argument_count - 1, &out->command, error));
    TRY(read_script(out, error));
    if (farm_command_is_catalog(&out->command))
        return farm_items_count(farm_command_option(&out->command, "manifest"), &out->items, error);
    if (!out->script.shard_count)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "farm: facet %s needs --shards N here; choose N so that a shard takes some minutes",
                    out->command.verb->name);
    return FACET_OK;
}

void farm_submission_destroy(farm_submission *s)
{
    farm_command_destroy(&s->command);
}

/* ---- the number of shards ---- */

/* Renders a sample of the items on this machine; *core_seconds is the estimate for all of them. The sample is a part of the
 * work, which --resume of the shards finds done. */
static facet_result render_sample(const farm_submission *s, double *core_seconds, facet_error *error)
{
    farm_script script = s->script;
    if (script.cpu_count > facet_thread_count())
        script.cpu_count = facet_thread_count();
    script.shard_count = farm_sample_count(s->items.count, script.cpu_count);
    text results = {0}, path = {0}, command = {0};
    text_addf(&path, "%s/results/sample", script.folder);
    if (!path.has_failed)
        farm_script_add_word(&results, path.data);
    if (!results.has_failed)
        farm_script_command(&script, "0", results.data, &command);
    bool has_failed = path.has_failed || results.has_failed || command.has_failed;
    char *output = NULL;
    double start_s = interrupt_clock();
    facet_result result = has_failed ? fail_memory(error, "command", 0)
                                     : farm_program_run((const char *const[]){"sh", "-c", command.data, NULL},
                                                        s->place, false, EXIT_NEGATIVE, &output, error);
    *core_seconds = (interrupt_clock() - start_s) * script.cpu_count * (double)s->items.count /
                    (double)shard_size((shard){0, script.shard_count}, s->items.count);
    free(output);
    text_destroy(&command);
    text_destroy(&results);
    text_destroy(&path);
    return result == FACET_ERROR_SYSTEM
               ? fail(error, result, "farm: the sample of the items, by which --shards is chosen, failed")
               : result;
}

static facet_result choose_shard_count(farm_submission *s, bool is_dry, facet_error *error)
{
    uint64_t most = is_given(s->line, OPT_PRINT_COMMANDS) ? SHARD_COUNT_MAX : farm_slurm_max_shards();
    if (s->script.shard_count > most)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--shards: %u are more than an array of Slurm may have here (MaxArraySize is %u)",
                    s->script.shard_count, (unsigned)most);
    if (farm_command_is_catalog(&s->command) && s->script.shard_count > s->items.count)
        s->script.shard_count = (uint32_t)s->items.count;
    if (s->script.shard_count)
        return FACET_OK;
    double core_seconds = farm_items_cost(&s->items);
    if (core_seconds == 0.0 && is_dry)
        core_seconds = (double)s->items.count;
    else if (core_seconds == 0.0)
        TRY(render_sample(s, &core_seconds, error));
    if (most > s->items.count)
        most = s->items.count;
    s->script.shard_count = farm_shard_count(core_seconds, s->target_s, s->script.cpu_count, most);
    double expected_s = core_seconds / s->script.shard_count / s->script.cpu_count;
    if (!is_given(s->line, OPT_SHARD_TIME)) /* shards are longer where Slurm allows few */
        s->script.time_limit_s = fmax(s->script.time_limit_s, 5.0 * expected_s);
    return FACET_OK;
}

/* ---- the folder of the run ---- */

static json_t *sbatch_options(const farm_submission *s)
{
    const option_value *given = &s->line->values[OPT_SBATCH];
    json_t *list = json_array();
    for (unsigned i = 0; i < given->count; i++)
        json_array_append_new(list, report_string_json(given->texts[i]));
    return list;
}

static json_t *command_words(const farm_submission *s)
{
    json_t *list = json_array();
    for (size_t i = 0; i < s->command.word_count; i++)
        json_array_append_new(list, report_string_json(s->command.words[i]));
    return list;
}

static facet_result write_scripts(const farm_submission *s, const farm_run *run, facet_error *error)
{
    static void (*const make[])(const farm_script *, text *) = {farm_script_chunk, farm_script_slurm,
                                                                farm_script_finish};
    static const char *const names[] = {"chunk.sh", "slurm.sh", "finish.sh"};
    for (size_t i = 0; i < 3; i++) {
        text script = {0};
        make[i](&s->script, &script);
        facet_result result = script.has_failed ? fail_memory(error, names[i], 0)
                                                : farm_run_write(run, names[i], script.data, error);
        text_destroy(&script);
        TRY(result);
    }
    return FACET_OK;
}

facet_result farm_submission_prepare(farm_submission *s, farm_run *run, facet_error *error)
{
    const char *folder = option_text(s->line, OPT_RUN, FARM_DEFAULT_FOLDER);
    TRY(farm_run_create(folder, run, error));
    s->script.folder = run->folder;
    TRY(choose_shard_count(s, false, error));
    TRY(write_scripts(s, run, error));
    run->root =
        json_pack("{s:s, s:s, s:o, s:o, s:I, s:I, s:I, s:o, s:[]}", "facet", facet_version(), "verb",
                  s->command.verb->name, "words", command_words(s), "folder", report_string_json(s->place),
                  "shards", (json_int_t)s->script.shard_count, "items", (json_int_t)s->items.count, "at_once",
                  (json_int_t)s->script.at_once, "sbatch", sbatch_options(s), "jobs");
    return run->root ? farm_run_save(run, error) : fail_memory(error, "run.json", 0);
}

facet_result farm_submission_print(farm_submission *s, facet_error *error)
{
    char folder[FARM_PATH_SIZE + 256];
    const char *given = option_text(s->line, OPT_RUN, FARM_DEFAULT_FOLDER);
    snprintf(folder, sizeof folder, "%s%s%s", *given == '/' ? "" : s->place, *given == '/' ? "" : "/", given);
    s->script.folder = folder;
    TRY(choose_shard_count(s, true, error));
    text out = {0};
    text_add(&out, "# chunk.sh\n");
    farm_script_chunk(&s->script, &out);
    text_add(&out, "\n# slurm.sh\n");
    farm_script_slurm(&s->script, &out);
    text_add(&out, "\n# finish.sh\n");
    farm_script_finish(&s->script, &out);
    if (!out.has_failed)
        fputs(out.data, stdout);
    facet_result result = out.has_failed ? fail_memory(error, "scripts", 0) : FACET_OK;
    text_destroy(&out);
    s->script.folder = NULL;
    return result;
}
