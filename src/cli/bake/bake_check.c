/* bake_check.c - whether what is planned can be written, found out before anything is read. See bake_plan.h. */
#define _DEFAULT_SOURCE
#include "cli/bake/bake_plan.h"

#include "cli/bake/bake_names.h"
#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/output.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* A folder that is there and open, or one above it in which it can be made. */
static facet_result check_folder(const char *folder, facet_error *error)
{
    struct stat info;
    char above[BAKE_NAME_SIZE + 4];
    if (stat(folder, &info) == 0) {
        if (!S_ISDIR(info.st_mode))
            return fail(error, FACET_ERROR_WRITE, "%s: it is not a folder, which --layout fills", folder);
        return access(folder, W_OK | X_OK) == 0
                   ? FACET_OK
                   : fail(error, FACET_ERROR_WRITE, "%s: the folder cannot be written to: %s", folder,
                          strerror(errno));
    }
    snprintf(above, sizeof above, "%s", folder);
    size_t length = strlen(above);
    while (length > 1 && above[length - 1] == '/')
        above[--length] = 0;
    return output_check(above, error); /* as if it were a file */
}

static bool is_read(const command_line *c, const bake_options *o, const char *path)
{
    const char *config_path = option_text(c, OPT_CONFIG, NULL);
    if (config_path && input_is_same_file(path, config_path))
        return true;
    for (int i = 0; o->has_faces && i < 6; i++)
        if (input_is_same_file(path, o->faces[i]))
            return true;
    return !o->has_faces && !o->is_table && environment_input_is_file(&o->environment, path);
}

static int compare_identities(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* No file under two names. */
static facet_result check_twice(const bake_plan *plan, facet_error *error)
{
    char **identities = calloc(plan->file_count + 1, sizeof *identities);
    facet_result result = identities ? FACET_OK : fail(error, FACET_ERROR_MEMORY, "out of memory: names");
    for (size_t i = 0; i < plan->file_count && result == FACET_OK; i++) {
        identities[i] = output_identity(plan->files[i].path);
        if (!identities[i])
            result = fail(error, FACET_ERROR_MEMORY, "out of memory: names");
    }
    if (result == FACET_OK)
        qsort(identities, plan->file_count, sizeof *identities, compare_identities);
    for (size_t i = 1; i < plan->file_count && result == FACET_OK; i++)
        if (strcmp(identities[i - 1], identities[i]) == 0)
            result = fail(error, FACET_ERROR_ARGUMENT, "bake: two outputs would both be written to %s",
                          strchr(identities[i], '/') + 1);
    for (size_t i = 0; identities && i < plan->file_count; i++)
        free(identities[i]);
    free(identities);
    return result;
}

/* Cube maps of which all files are kept need not be baked. */
static void drop_idle_cubes(bake_plan *plan)
{
    for (uint32_t i = 0; i < plan->cube_count; i++) {
        bool is_needed = false;
        for (size_t f = 0; f < plan->file_count; f++) {
            const bake_file *file = &plan->files[f];
            bool is_of_cube = file->content <= BAKE_FACE || file->content == BAKE_SHEET;
            is_needed = is_needed || (is_of_cube && file->cube == i && !file->is_kept);
        }
        if (!is_needed)
            plan->cubes[i].desc.size = 0;
    }
}

/* Options of a kind of file of which there is none. */
static facet_result check_idle_options(const command_line *c, const bake_plan *plan, facet_error *error)
{
    bool has_picture = false, has_png = false, has_ktx2 = false, has_sh = false;
    for (size_t i = 0; i < plan->file_count; i++) {
        const bake_file *file = &plan->files[i];
        const bool is_picture = file->content == BAKE_LEVEL || file->content == BAKE_FACE;
        has_picture = has_picture || is_picture;
        has_png = has_png || (is_picture && file->container == CONTAINER_PNG);
        has_ktx2 = has_ktx2 || file->container == CONTAINER_KTX2;
        has_sh = has_sh || file->content == BAKE_SH;
    }
    const struct {
        option_id id;
        bool is_of_use;
        const char *what;
    } rules[] = {{OPT_PROJECTION, has_picture, "a picture (.exr .hdr .pfm .png)"},
                 {OPT_LEVEL, has_picture, "a picture (.exr .hdr .pfm .png)"},
                 {OPT_RGBM, has_png, "a .png file"},
                 {OPT_ZSTD, has_ktx2, "a .ktx2 file"},
                 {OPT_SH_WINDOW, has_sh, "--sh"}};
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++)
        if (is_given(c, rules[i].id) && !rules[i].is_of_use)
            return fail(error, FACET_ERROR_ARGUMENT, "--%s: it says nothing without %s",
                        option_find_id(c->verb, rules[i].id)->name, rules[i].what);
    return FACET_OK;
}

facet_result bake_plan_check(const command_line *c, const bake_options *o, bake_plan *plan,
                             facet_error *error)
{
    facet_result result = check_idle_options(c, plan, error);
    for (size_t i = 0; i < plan->folder_count && result == FACET_OK; i++)
        if (i == 0 || access(plan->folders[0], F_OK) == 0)
            result = check_folder(plan->folders[i], error);
    for (size_t i = 0; i < plan->file_count && result == FACET_OK; i++) {
        bake_file *file = &plan->files[i];
        const bool exists = strcmp(file->path, "-") != 0 && output_exists(file->path);
        result = output_check(file->path, error);
        file->is_kept = result == FACET_OK && o->keeps_existing && exists;
        if (result == FACET_OK && exists && !file->is_kept && is_read(c, o, file->path))
            result =
                fail(error, FACET_ERROR_ARGUMENT,
                     "%s: it is an input, too, and would be overwritten; name another output", file->path);
    }
    if (result == FACET_OK)
        result = check_twice(plan, error);
    drop_idle_cubes(plan);
    return result;
}
