/* farm_run.c - see farm_run.h. */
#define _POSIX_C_SOURCE 200809L
#define _DEFAULT_SOURCE /* realpath() */
#include "cli/farm/farm_run.h"

#include "base/file.h"
#include "cli/shared/output.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

void farm_run_destroy(farm_run *run)
{
    free(run->folder);
    json_decref(run->root);
    *run = (farm_run){0};
}

/* Makes a folder, which may exist. */
static facet_result make_folder(const char *path, facet_error *error)
{
    TRY(output_make_folders(path, error));
    if (mkdir(path, 0777) != 0 && errno != EEXIST)
        return fail(error, FACET_ERROR_WRITE, "%s: cannot make the folder: %s", path, strerror(errno));
    return FACET_OK;
}

/* Sets the absolute path of the folder. */
static facet_result find_folder(const char *folder, farm_run *out, facet_error *error)
{
    out->folder = realpath(folder, NULL);
    if (!out->folder)
        return fail(error, FACET_ERROR_READ, "%s: cannot open the folder of the run: %s", folder,
                    strerror(errno));
    if (strlen(out->folder) > 3000 || strchr(out->folder, '\n'))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--run: the path of the folder is too long, or contains a line feed");
    return FACET_OK;
}

facet_result farm_run_create(const char *folder, farm_run *out, facet_error *error)
{
    static const char *const names[] = {"", "/results", "/parts", "/log"};
    char path[FARM_PATH_SIZE];
    snprintf(path, sizeof path, "%.3000s/run.json", folder);
    if (output_exists(path))
        return fail(
            error, FACET_ERROR_ARGUMENT,
            "--run: %s holds a run already; facet farm retry continues it, another folder starts another run",
            folder);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        snprintf(path, sizeof path, "%.3000s%s", folder, names[i]);
        TRY(make_folder(path, error));
    }
    return find_folder(folder, out, error);
}

/* Reads the members of root that every command needs. */
static facet_result read_members(farm_run *run, const char *path, facet_error *error)
{
    json_int_t shards = 0, items = 0;
    if (json_unpack(run->root, "{s:s, s:I, s:I}", "verb", &run->verb, "shards", &shards, "items", &items) !=
            0 ||
        shards < 1 || shards > 1000000 || items < 0)
        return fail(error, FACET_ERROR_INVALID,
                    "%s: not the record of a run (\"verb\", \"shards\" and \"items\" are expected)", path);
    run->shard_count = (uint32_t)shards;
    run->item_count = (uint64_t)items;
    return FACET_OK;
}

facet_result farm_run_load(const char *folder, farm_run *out, facet_error *error)
{
    char path[FARM_PATH_SIZE];
    snprintf(path, sizeof path, "%.3000s/run.json", folder);
    if (!output_exists(path))
        return fail(error, FACET_ERROR_READ,
                    "%s: no run is here; facet farm submit starts one, --run names its folder", path);
    TRY(find_folder(folder, out, error));
    json_error_t at;
    out->root = json_load_file(path, JSON_REJECT_DUPLICATES, &at);
    if (!out->root)
        return fail(error, FACET_ERROR_INVALID, "%s: line %d: %s", path, at.line, at.text);
    return read_members(out, path, error);
}

facet_result farm_run_write(const farm_run *run, const char *name, const char *text, facet_error *error)
{
    char path[FARM_PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", run->folder, name);
    return file_replace(path, text, strlen(text), error);
}

facet_result farm_run_save(farm_run *run, facet_error *error)
{
    char *text = json_dumps(run->root, JSON_INDENT(1) | JSON_PRESERVE_ORDER);
    if (!text)
        return fail_memory(error, "run.json", 0);
    facet_result result = farm_run_write(run, "run.json", text, error);
    free(text);
    return result == FACET_OK ? read_members(run, "run.json", error) : result;
}

json_int_t farm_run_number(const farm_run *run, const char *name)
{
    return json_integer_value(json_object_get(run->root, name));
}

bool farm_run_is_catalog(const farm_run *run)
{
    return strcmp(run->verb, "batch") == 0;
}
