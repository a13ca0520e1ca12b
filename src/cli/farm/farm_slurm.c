/* farm_slurm.c - see farm_slurm.h. */
#define _POSIX_C_SOURCE 200809L
#include "cli/farm/farm_slurm.h"

#include "base/text.h"
#include "cli/farm/farm_program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define WORDS(...) ((const char *const[]){__VA_ARGS__, NULL})
enum { DEFAULT_MAX_ARRAY_SIZE = 1001 };

uint32_t farm_slurm_max_shards(void)
{
    facet_error error;
    char *output = NULL;
    unsigned size = 0;
    if (farm_program_run(WORDS("scontrol", "show", "config"), "/", true, 0, &output, &error) == FACET_OK) {
        const char *line = strstr(output, "MaxArraySize");
        if (line)
            sscanf(line, "MaxArraySize = %u", &size);
    }
    free(output);
    return size ? size : DEFAULT_MAX_ARRAY_SIZE;
}

char *farm_shard_list(const bool *shards, uint32_t count)
{
    text list = {0};
    for (uint32_t i = 0; i < count; i++) {
        if (!shards[i])
            continue;
        uint32_t first = i;
        while (i + 1 < count && shards[i + 1])
            i++;
        text_addf(&list, "%s%u", list.length ? "," : "", first);
        if (i > first)
            text_addf(&list, "-%u", i);
    }
    char *copy = list.has_failed ? NULL : strdup(list.data ? list.data : "");
    text_destroy(&list);
    return copy;
}

/* ---- submission ---- */

/* Runs sbatch with an option of its own, those of --sbatch, and a script; *id is the number of the job. */
static facet_result submit(const farm_run *run, const char *own, const char *script, char id[32],
                           facet_error *error)
{
    enum { MAX_WORDS = 64 };
    const char *words[MAX_WORDS] = {"sbatch", "--parsable", own};
    size_t count = 3, index;
    json_t *option;
    json_array_foreach(json_object_get(run->root, "sbatch"), index, option)
    {
        if (count < MAX_WORDS - 2 && json_is_string(option))
            words[count++] = json_string_value(option);
    }
    words[count] = script;
    char *output = NULL;
    TRY(farm_program_run(words, run->folder, false, 0, &output, error));
    bool is_good = sscanf(output, "%31[0-9]", id) == 1;
    free(output);
    return is_good ? FACET_OK : fail(error, FACET_ERROR_SYSTEM, "sbatch: it printed no number of a job");
}

facet_result farm_slurm_submit(farm_run *run, const bool *shards, facet_error *error)
{
    char *list = farm_shard_list(shards, run->shard_count);
    text words = {0};
    char array[32] = "", finish[32] = "";
    text_addf(&words, "--array=%s", list ? list : "");
    if (farm_run_number(run, "at_once"))
        text_addf(&words, "%%%u", (unsigned)farm_run_number(run, "at_once"));
    facet_result result = FACET_OK;
    if (!list || words.has_failed)
        result = fail_memory(error, "list of shards", 0);
    if (result == FACET_OK)
        result = submit(run, words.data, "slurm.sh", array, error);
    if (result ==
        FACET_OK) { /* afterany: after afterok, one failed element would keep the job waiting for ever */
        char dependency[64];
        snprintf(dependency, sizeof dependency, "--dependency=afterany:%s", array);
        result = submit(run, dependency, "finish.sh", finish, error);
    }
    if (*array) { /* also without the second job: facet farm status must know it */
        json_t *job = json_pack("{s:s, s:s, s:s, s:I}", "array", array, "finish", finish, "shards", list,
                                "time", (json_int_t)time(NULL));
        json_array_append_new(json_object_get(run->root, "jobs"), job);
        facet_error other;
        if (farm_run_save(run, &other) != FACET_OK && result == FACET_OK)
            result = fail(error, other.result, "%s", other.message);
    }
    text_destroy(&words);
    free(list);
    return result;
}

/* ---- what it does ---- */

static bool is_array_of(const farm_run *run, const char *id)
{
    size_t index;
    json_t *job;
    json_array_foreach(json_object_get(run->root, "jobs"), index, job)
    {
        const char *array = json_string_value(json_object_get(job, "array"));
        if (array && strcmp(array, id) == 0)
            return true;
    }
    return false;
}

void farm_slurm_places(const farm_run *run, farm_place *places)
{
    facet_error error;
    char *output = NULL, *rest = NULL;
    memset(places, 0, run->shard_count * sizeof *places);
    if (json_array_size(json_object_get(run->root, "jobs")) == 0)
        return;
    if (farm_program_run(WORDS("squeue", "-h", "-r", "-o", "%F %K %t"), "/", true, 0, &output, &error) !=
        FACET_OK)
        return;
    for (char *line = strtok_r(output, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        char id[32], state[8];
        unsigned shard;
        if (sscanf(line, "%31s %u %7s", id, &shard, state) == 3 && shard < run->shard_count &&
            is_array_of(run, id))
            places[shard] = strcmp(state, "PD") == 0 ? FARM_WAITING : FARM_RUNNING;
    }
    free(output);
}

void farm_slurm_history(const farm_run *run, void (*add)(void *user, uint32_t shard, const char *state),
                        void *user)
{
    facet_error error;
    text ids = {0};
    char *output = NULL, *rest = NULL;
    size_t index;
    json_t *job;
    json_array_foreach(json_object_get(run->root, "jobs"), index, job)
    {
        const char *array = json_string_value(json_object_get(job, "array"));
        if (array)
            text_addf(&ids, "%s%s", ids.length ? "," : "", array);
    }
    if (ids.length && !ids.has_failed &&
        farm_program_run(WORDS("sacct", "-n", "-X", "-P", "-o", "JobID,State", "-j", ids.data), "/", true, 0,
                         &output, &error) == FACET_OK)
        for (char *line = strtok_r(output, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
            char state[32];
            unsigned shard;
            if (sscanf(line, "%*[0-9]_%u|%31[A-Z_]", &shard, state) == 2 && shard < run->shard_count)
                add(user, shard, state);
        }
    free(output);
    text_destroy(&ids);
}
