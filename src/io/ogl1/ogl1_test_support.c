/* ogl1_test_support.c - see ogl1_test_support.h. */
#define _POSIX_C_SOURCE 200809L
#include "io/ogl1/ogl1_test_support.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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
    ogl1_folder *f = calloc(1, sizeof *f);
    assert_non_null(f);
    strcpy(f->path, "/tmp/facet_ogl1_XXXXXX");
    assert_non_null(mkdtemp(f->path));
    *state = f;
    return 0;
}

int ogl1_folder_remove(void **state)
{
    ogl1_folder *f = *state;
    DIR *entries = opendir(f->path);
    for (struct dirent *entry; entries && (entry = readdir(entries));)
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0)
            unlink(ogl1_path(f, entry->d_name));
    if (entries)
        closedir(entries);
    rmdir(f->path);
    free(f);
    return 0;
}

const char *ogl1_path(const ogl1_folder *f, const char *name)
{
    static char paths[4][512];
    static int next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", f->path, name);
    return path;
}

const char *ogl1_write(const ogl1_folder *f, const char *name, const void *bytes, size_t size)
{
    const char *path = ogl1_path(f, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    return path;
}

const char *ogl1_write_json(const ogl1_folder *f, const char *name, const char *json)
{
    char *quoted = with_quotes(json);
    const char *path = ogl1_write(f, name, quoted, strlen(quoted));
    free(quoted);
    return path;
}

const char *ogl1_write_png(const ogl1_folder *f, const char *name)
{
    static const unsigned char white[] = {
        0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00,
        0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00, 0x00, 0x3a, 0x7e, 0x9b, 0x55, 0x00,
        0x00, 0x00, 0x0a, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0xf8, 0x0f, 0x00, 0x01, 0x01, 0x01, 0x00,
        0x1c, 0xb0, 0x8c, 0x99, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
    return ogl1_write(f, name, white, sizeof white);
}
