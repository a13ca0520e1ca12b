/* path_film_file.c - checkpoints: see path_film.h. */
#include "path/path_film_state.h"

#include "base/result.h"

facet_result path_film_save(const path_film *f, const char *key, const char *path, uint32_t thread_count,
                            facet_error *error)
{
    (void)f;
    (void)key;
    (void)thread_count;
    return fail(error, FACET_ERROR_UNSUPPORTED, "%s: checkpoints are not there yet", path);
}

facet_result path_film_load(path_film *f, const char *key, const char *path, bool *exists, facet_error *error)
{
    (void)f;
    (void)key;
    *exists = false;
    return fail(error, FACET_ERROR_UNSUPPORTED, "%s: checkpoints are not there yet", path);
}
