/* farm_status.c - see farm_status.h. */
#define _POSIX_C_SOURCE 200809L
#include "cli/farm/farm_status.h"

#include "cli/shared/failure.h"
#include "cli/shared/shard.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool farm_shard_is_finished(const farm_shard *s)
{
    return s->done + s->failed >= s->items;
}

bool farm_status_is_complete(const farm_status *s)
{
    return s->done >= s->items;
}

void farm_status_destroy(farm_status *s)
{
    free(s->shards);
    json_decref(s->failures);
    *s = (farm_status){0};
}

static void add_failure(farm_status *s, json_t *name, json_t *message)
{
    if (json_array_size(s->failures) < FARM_FAILURES)
        json_array_append_new(s->failures, json_pack("{s:O?, s:O?}", "name", name, "message", message));
}

/* Whether a failure with this exit code is final: the others may be the machine's. */
static bool is_final(json_int_t exit_code)
{
    return exit_code != EXIT_DONE && exit_code != EXIT_READ && exit_code != EXIT_WRITE &&
           exit_code != EXIT_ENVIRONMENT && exit_code != EXIT_AGAIN;
}

/* ---- a shard of one picture or of frames: the object of --json ---- */

static void read_single(farm_status *s, farm_shard *part, const char *path)
{
    json_t *root = json_load_file(path, 0, NULL);
    json_t *code = json_object_get(root, "exit_code"),
           *first = json_array_get(json_object_get(root, "failures"), 0);
    json_int_t exit_code = json_integer_value(code);
    part->items = 1;
    if (json_is_integer(code) && (exit_code == EXIT_DONE || (exit_code == EXIT_NEGATIVE && !first))) {
        part->done = 1;
    } else if (json_is_integer(code) && is_final(exit_code)) {
        part->failed = 1;
        add_failure(s, json_object_get(first, "model"), json_object_get(first, "message"));
    }
    json_decref(root);
}

/* ---- a shard of a catalog: a line of JSON per item ---- */

/* Counts the last result of each item: a shard that ran again has appended to its results. */
static void count_results(farm_status *s, farm_shard *part, json_t *results)
{
    const char *number;
    json_t *result;
    json_object_foreach(results, number, result)
    {
        const char *status = json_string_value(json_object_get(result, "status"));
        bool is_done = status && strcmp(status, "done") == 0;
        part->done += is_done;
        bool is_over = !is_done && is_final(json_integer_value(json_object_get(result, "exit_code")));
        part->failed += is_over;
        s->to_retry += !is_done && !is_over;
        if (!is_done)
            add_failure(s, json_object_get(result, "id"), json_object_get(result, "message"));
    }
}

/* Reads the lines of the results; an incomplete one, of a process that was killed, is ignored. */
static void read_catalog(farm_status *s, farm_shard *part, shard self, const char *path)
{
    FILE *file = fopen(path, "r");
    json_t *results = json_object();
    char *line = NULL;
    size_t capacity = 0;
    ssize_t length;
    while (file && (length = getline(&line, &capacity, file)) > 0) {
        char key[32];
        json_t *result = json_loadb(line, (size_t)length, 0, NULL), *item = json_object_get(result, "item");
        json_int_t number = json_integer_value(item);
        if (json_is_integer(item) && number >= 0 && shard_has(self, (uint64_t)number)) {
            snprintf(key, sizeof key, "%lld", (long long)number);
            json_object_set(results, key, result);
        }
        json_decref(result);
    }
    free(line);
    if (file)
        fclose(file);
    count_results(s, part, results);
    json_decref(results);
}

/* ---- a run ---- */

static void add_history(void *user, uint32_t index, const char *state)
{
    farm_status *s = user;
    snprintf(s->shards[index].history, sizeof s->shards[index].history, "%s", state);
}

static void read_shard(const farm_run *run, uint32_t index, farm_status *s)
{
    char path[FARM_PATH_SIZE];
    farm_shard *part = &s->shards[index];
    bool is_catalog = farm_run_is_catalog(run);
    snprintf(path, sizeof path, "%s/results/%u.json%s", run->folder, index, is_catalog ? "l" : "");
    if (is_catalog) {
        shard self = {index, run->shard_count};
        part->items = shard_size(self, run->item_count);
        read_catalog(s, part, self, path);
    } else {
        read_single(s, part, path);
    }
    s->items += part->items;
    s->done += part->done;
    s->failed += part->failed;
    s->running += part->place == FARM_RUNNING;
    s->waiting += part->place == FARM_WAITING;
    s->missing += part->place == FARM_NOWHERE && !farm_shard_is_finished(part);
}

facet_result farm_status_read(const farm_run *run, farm_status *out, facet_error *error)
{
    farm_place *places = calloc(run->shard_count, sizeof *places);
    out->shards = calloc(run->shard_count, sizeof *out->shards);
    out->failures = json_array();
    if (!places || !out->shards || !out->failures) {
        free(places);
        return fail_memory(error, "shards", run->shard_count * sizeof *out->shards);
    }
    farm_slurm_places(run, places); /* before the results: a shard that ends meanwhile has one */
    for (uint32_t i = 0; i < run->shard_count; i++) {
        out->shards[i].place = places[i];
        read_shard(run, i, out);
    }
    farm_slurm_history(run, add_history, out);
    free(places);
    return FACET_OK;
}
