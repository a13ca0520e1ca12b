/* file_set.c - see file_set.h. */
#include "io/file_set.h"

#include <string.h>

#include "base/result.h"

/* The path of a file beside main; a block of mem_alloc(). */
static char *path_beside(const file_set *set, const char *name)
{
    char *folder = path_folder(set->allocator, set->main);
    char *path = folder ? path_join(set->allocator, folder, name) : NULL;
    mem_free(folder);
    return path;
}

file_set file_set_begin(const facet_scene *scene, const char *path, const facet_scene_save_desc *desc)
{
    return (file_set){.allocator = &desc->allocator,
                      .main = path,
                      .inputs = desc->keeps_inputs ? scene : NULL,
                      .progress = desc->progress};
}

static facet_result ask(const file_set *set, double fraction, facet_error *error)
{
    return set->progress.report && !set->progress.report(set->progress.user, "write", fraction)
               ? fail(error, FACET_ERROR_CANCELLED, "%s: cancelled", set->main)
               : FACET_OK;
}

facet_result file_set_add(file_set *set, const char *name, const void *bytes, size_t size, facet_error *error)
{
    char *beside = name && strchr(set->main, '/') ? path_beside(set, name) : NULL;
    const char *path = !name ? set->main : strchr(set->main, '/') ? beside : name;
    facet_result result = ask(set, 0.0, error);
    if (result != FACET_OK)
        ;
    else if (!path || !mem_reserve(set->allocator, (void **)&set->stages, &set->capacity, set->count + 1,
                                   sizeof *set->stages))
        result = fail_memory(error, set->main, 0);
    else if (set->inputs && scene_has_file(set->inputs, path))
        result = name ? fail(error, FACET_ERROR_ARGUMENT,
                             "%s: %s, which belongs to %s, would be overwritten; name another output",
                             set->main, path, set->inputs->source)
                      : fail(error, FACET_ERROR_ARGUMENT,
                             "%s: it is an input, too, and would be overwritten; name another output", path);
    else
        result = file_stage_write(path, bytes, size, &set->stages[set->count], error);
    set->count += result == FACET_OK;
    mem_free(beside);
    return result;
}

facet_result file_set_commit(file_set *set, facet_error *error)
{
    TRY(ask(set, 1.0, error));
    for (size_t i = 0; i < set->count; i++)
        TRY(file_stage_commit(&set->stages[i], error));
    return FACET_OK;
}

void file_set_destroy(file_set *set)
{
    for (size_t i = 0; i < set->count; i++)
        file_stage_discard(&set->stages[i]);
    mem_free(set->stages);
    *set = (file_set){0};
}
