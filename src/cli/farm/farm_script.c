/* farm_script.c - see farm_script.h. */
#include "cli/farm/farm_script.h"

#include "base/file.h"
#include "cli/shared/shell_line.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>

enum { REQUEUES = 5 }; /* of an element that exits with 75 */

void farm_script_add_word(text *out, const char *word)
{
    shell_line line = {.text = NULL};
    shell_line_add_word(&line, word);
    if (line.text && !line.has_failed)
        text_add(out, line.text);
    else
        out->has_failed = true;
    free(line.text);
}

static void add_word(text *out, const char *word)
{
    text_add(out, " ");
    farm_script_add_word(out, word);
}

/* "name=VALUE" and a line feed. */
static void add_assignment(text *out, const char *name, const char *value)
{
    text_addf(out, "%s=", name);
    farm_script_add_word(out, value);
    text_add(out, "\n");
}

static void add_place(const farm_script *s, text *out)
{
    text_add(out, "cd");
    add_word(out, s->place);
    text_add(out, " || exit 75\n");
}

/* A path in the folder of the run, as a word. */
static void add_file(const farm_script *s, const char *name, text *out)
{
    text path = {.allocator = out->allocator};
    text_addf(&path, "%s/%s", s->folder, name);
    if (!path.has_failed)
        add_word(out, path.data);
    text_destroy(&path);
}

/* Options of facet farm come directly behind the verb: the command may contain a "--". */
void farm_script_command(const farm_script *s, const char *shard, const char *results, text *out)
{
    farm_script_add_word(out, s->program);
    text_addf(out, " %s --shard %s/%u", s->command->verb->name, shard, s->shard_count);
    bool is_catalog = farm_command_is_catalog(s->command);
    if (farm_command_lacks(s->command, is_catalog ? "jobs" : "threads"))
        text_addf(out, " -j %u", s->cpu_count);
    if (s->memory_bytes && farm_command_lacks(s->command, "max-memory")) /* exit code 7 instead of a kill */
        text_addf(out, " --max-memory %.0fM",
                  floor(0.9 * (double)s->memory_bytes / (1 << 20) / (is_catalog ? s->cpu_count : 1)));
    if (s->command->merge_option_count) {
        text_add(out, " -o");
        add_file(s, "parts/{shard}.exr", out);
    }
    if (is_catalog)
        text_addf(out, " --resume --results %s.jsonl", results);
    else
        text_add(out, " --json");
    for (size_t i = 0; i < s->command->word_count; i++)
        add_word(out, s->command->words[i]);
    if (!is_catalog)
        text_addf(out, " >%s.json", results);
}

void farm_script_chunk(const farm_script *s, text *out)
{
    text_addf(out,
              "#!/bin/sh\n"
              "# One of %u shards of a run of facet farm: sh chunk.sh 0 .. sh chunk.sh %u, in any order, on "
              "any machine that\n"
              "# sees these files. Exit code 75 asks for another run of the shard.\n"
              "shard=${1:?\"the number of the shard is missing: sh chunk.sh SHARD\"}\n",
              s->shard_count, s->shard_count - 1);
    add_assignment(out, "run", s->folder);
    add_place(s, out);
    text_add(out, "exec ");
    farm_script_command(s, "\"$shard\"", "\"$run/results/$shard\"", out);
    text_add(out, "\n");
}

/* The name of a job: that of the folder, in characters that need no quoting. */
static void add_job_name(const farm_script *s, text *out)
{
    for (const char *at = path_base_name(s->folder); *at; at++)
        text_addf(out, "%c", isalnum((unsigned char)*at) || *at == '-' || *at == '_' ? *at : '_');
}

void farm_script_slurm(const farm_script *s, text *out)
{
    text_add(out, "#!/bin/sh\n"
                  "# The array job of a run of facet farm: an element does a shard. To submit it again, or a "
                  "part of it, in\n"
                  "# this folder: sbatch --array=3,17 slurm.sh; facet farm retry submits what is missing.\n"
                  "#SBATCH --job-name=");
    add_job_name(s, out);
    text_addf(out, "\n#SBATCH --array=0-%u", s->shard_count - 1);
    if (s->at_once)
        text_addf(out, "%%%u", s->at_once);
    text_addf(out, "\n#SBATCH --ntasks=1 --cpus-per-task=%u", s->cpu_count);
    if (s->memory_bytes)
        text_addf(out, " --mem=%.0fM", ceil((double)s->memory_bytes / (1 << 20)));
    text_addf(out,
              "\n#SBATCH --time=%.0f\n"
              "#SBATCH --requeue --open-mode=append --signal=TERM@60\n"
              "#SBATCH --output=log/%%A_%%a.log\n",
              ceil(s->time_limit_s / 60.0));
    add_assignment(out, "run", s->folder);
    text_addf(out,
              "# srun, since Slurm signals steps, not this script: 60 s before the time limit, facet ends "
              "with 75.\n"
              "srun --ntasks=1 --cpus-per-task=%u sh \"$run/chunk.sh\" \"$SLURM_ARRAY_TASK_ID\"\n"
              "code=$?\n"
              "# 75 asks for another run. Slurm holds the element for about two minutes before.\n"
              "if [ $code = 75 ] && [ \"${SLURM_RESTART_COUNT:-0}\" -lt %d ]; then\n"
              "    scontrol requeue \"${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID\"\n"
              "fi\n"
              "exit $code\n",
              s->cpu_count, REQUEUES);
}

void farm_script_finish(const farm_script *s, text *out)
{
    text_add(out, "#!/bin/sh\n"
                  "# What follows the shards of a run of facet farm, whether all of them succeeded or not.\n"
                  "#SBATCH --job-name=");
    add_job_name(s, out);
    text_add(out, "-finish\n"
                  "#SBATCH --ntasks=1 --time=60\n"
                  "#SBATCH --requeue --open-mode=append --output=log/finish.log\n");
    add_place(s, out);
    text_add(out, "code=0\n");
    if (s->command->merge_option_count) {
        add_assignment(out, "run", s->folder);
        farm_script_add_word(out, s->program);
        text_add(out, " merge \"$run\"/parts/*.exr");
        for (size_t i = 0; i < s->command->merge_option_count; i++) {
            const option *o = s->command->merge_options[i];
            text_addf(out, " --%s=", o->name);
            farm_script_add_word(out, s->command->line.values[o->id].text);
        }
        text_add(out, " || code=$?\n");
    }
    farm_script_add_word(out, s->program);
    text_add(out, " farm status --run");
    add_word(out, s->folder);
    text_add(out, " || code=$?\nexit $code\n");
}

void farm_script_line(const char *folder, uint32_t shard, text *out)
{
    text t = {.allocator = out->allocator};
    text_addf(&t, "%s/chunk.sh", folder);
    text_add(out, "sh");
    if (!t.has_failed)
        add_word(out, t.data);
    text_addf(out, " %u\n", shard);
    text_destroy(&t);
}
