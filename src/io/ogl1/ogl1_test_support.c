/* ogl1_test_support.c - see ogl1_test_support.h. */
#define _POSIX_C_SOURCE 200809L
#include "io/ogl1/ogl1_test_support.h"

#include <stdlib.h>
#include <string.h>

static char *with_quotes(const char *json)
{
    char *copy = strdup(json);
    assert_non_null(copy);
    for (char *c = copy; *c; c++)
        *c = *c == '\'' ? '"' : *c;
    return copy;
}

facet_result ogl1_try(const char *json, facet_scene **scene, facet_error *error)
{
    char *quoted = with_quotes(json);
    facet_result result = ogl1_json_load_memory(quoted, strlen(quoted), "test.json", NULL, scene, error);
    free(quoted);
    return result;
}

facet_scene *ogl1_load(const char *json)
{
    facet_error error = {0};
    facet_scene *scene = NULL;
    if (ogl1_try(json, &scene, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return scene;
}

void ogl1_assert_refused(const char *json, facet_result result, const char *place, const char *what)
{
    facet_error error = {0};
    facet_scene *scene = NULL;
    assert_int_equal(ogl1_try(json, &scene, &error), result);
    assert_null(scene);
    if (!strstr(error.message, "test.json: ") || !strstr(error.message, place) ||
        !strstr(error.message, what))
        fail_msg("\"%s\" lacks \"%s\" or \"%s\"", error.message, place, what);
}

void ogl1_assert_color(const float color[3], unsigned rgb)
{
    for (int k = 0; k < 3; k++)
        if (color[k] != (float)(rgb >> (16 - 8 * k) & 255) / 255.0f)
            fail_msg("channel %d is %g, not that of #%06X", k, (double)color[k], rgb);
}

int ogl1_folder_create(void **state)
{
    temporary_folder *f = malloc(sizeof *f);
    assert_non_null(f);
    temporary_folder_create(f);
    *state = f;
    return 0;
}

int ogl1_folder_remove(void **state)
{
    temporary_folder_remove(*state);
    free(*state);
    return 0;
}

const char *ogl1_write_json(const temporary_folder *f, const char *name, const char *json)
{
    char *quoted = with_quotes(json);
    const char *path = temporary_folder_put(f, name, quoted, strlen(quoted));
    free(quoted);
    return path;
}
