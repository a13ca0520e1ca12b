/* input.c - see input.h. */
#define _POSIX_C_SOURCE 200809L
#include "cli/shared/input.h"

#include "cli/shared/failure.h"
#include "cli/shared/terminal.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

const char *input_name(const char *path)
{
    return !path ? "built-in scene" : strcmp(path, "-") == 0 ? "stdin" : path;
}

/* A growing buffer in memory of allocator. */
typedef struct growing {
    const facet_allocator *allocator;
    unsigned char *data;
    size_t used, capacity;
} growing;

static void release(growing *g)
{
    if (g->data)
        g->allocator->release(g->allocator->user, g->data, g->capacity);
    *g = (growing){.allocator = g->allocator};
}

static bool grow(growing *g)
{
    size_t capacity = g->capacity ? g->capacity + g->capacity / 2 : (size_t)1 << 20;
    unsigned char *grown = g->allocator->allocate(g->allocator->user, capacity);
    if (!grown)
        return false;
    growing larger = {.allocator = g->allocator, .data = grown, .used = g->used, .capacity = capacity};
    if (g->used)
        memcpy(grown, g->data, g->used);
    release(g);
    *g = larger;
    return true;
}

/* The library's default of max_file_bytes. */
static const uint64_t MAX_STDIN_BYTES = (uint64_t)4 << 30;

/* All of standard input. Fails with FACET_ERROR_READ, _LIMIT, _MEMORY, and _ARGUMENT where it is a terminal. */
static facet_result read_stdin(const char *expected, growing *out, facet_error *error)
{
    if (terminal_is(stdin))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "stdin: standard input is a terminal; redirect a file into it");
    for (;;) {
        if (out->used == out->capacity && !grow(out))
            return fail(error, FACET_ERROR_MEMORY, "stdin: out of memory after %zu bytes", out->used);
        ssize_t n = read(STDIN_FILENO, out->data + out->used, out->capacity - out->used);
        if (n == 0)
            break;
        if (n > 0)
            out->used += (size_t)n;
        else if (errno != EINTR)
            return fail(error, FACET_ERROR_READ, "stdin: %s", strerror(errno));
        if (out->used > MAX_STDIN_BYTES)
            return fail(error, FACET_ERROR_LIMIT, "stdin: it is larger than %llu bytes",
                        (unsigned long long)MAX_STDIN_BYTES);
    }
    return out->used ? FACET_OK
                     : fail(error, FACET_ERROR_READ, "stdin: it is empty; %s was expected", expected);
}

/* An address as input is a usage error. */
static facet_result check_address(const char *path, facet_error *error)
{
    struct stat info;
    bool is_address = strncasecmp(path, "http://", 7) == 0 || strncasecmp(path, "https://", 8) == 0;
    if (!is_address || stat(path, &info) == 0)
        return FACET_OK;
    return fail(
        error, FACET_ERROR_ARGUMENT,
        "%.400s: facet reads files, not addresses; fetch it first, as with curl -LO, or send it to standard "
        "input: curl -sL %.400s | facet render - -o out.png",
        path, path);
}

/* Checks that need no reading. */
static facet_result check(const char *path, const char *root, facet_error *error)
{
    struct stat info;
    if (path && !path[0])
        return fail(error, FACET_ERROR_ARGUMENT, "facet: the name of a model is empty");
    if (path)
        TRY(check_address(path, error));
    if (path && stat(path, &info) == 0 &&
        S_ISDIR(info.st_mode)) /* folders with models were replaced by these */
        return fail(error, FACET_ERROR_READ, "%s: there is no model in or below this folder", path);
    if (root && (stat(root, &info) != 0 || !S_ISDIR(info.st_mode)))
        return fail(error, FACET_ERROR_READ, "%s: there is no such folder (--root)", root);
    return FACET_OK;
}

facet_result input_load(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                        facet_error *error)
{
    *scene = NULL;
    if (check(path, desc->root, error) != FACET_OK)
        return error->result;
    if (!path)
        return facet_scene_create_builtin(desc, scene, error);
    if (strcmp(path, "-") != 0)
        return facet_scene_load(path, desc, scene, error);
    growing bytes = {.allocator = &desc->allocator};
    facet_result result = read_stdin("a model", &bytes, error);
    if (result == FACET_OK)
        result = facet_scene_load_memory(bytes.data, bytes.used, input_name(path), desc, scene, error);
    release(&bytes);
    return result;
}

facet_result input_load_shaded(const char *path, const facet_scene_desc *desc, facet_shading shading,
                               facet_scene **scene, facet_error *error)
{
    facet_scene_desc d = *desc;
    d.legacy.keeps_materials = shading == FACET_SHADING_OGL1;
    TRY(input_load(path, &d, scene, error));
    return shading == FACET_SHADING_OGL1
               ? facet_scene_convert_materials(*scene, FACET_MATERIAL_MODEL_OGL1, &d.legacy, &d.log, error)
               : FACET_OK;
}

facet_result input_load_image(const char *path, const facet_image_load_desc *desc, facet_image **image,
                              facet_error *error)
{
    *image = NULL;
    if (!path[0])
        return fail(error, FACET_ERROR_ARGUMENT, "facet: the name of an image is empty");
    TRY(check_address(path, error));
    if (strcmp(path, "-") != 0)
        return facet_image_load(path, desc, image, error);
    growing bytes = {.allocator = &desc->allocator};
    facet_result result = read_stdin("an image", &bytes, error);
    if (result == FACET_OK)
        result = facet_image_load_memory(bytes.data, bytes.used, input_name(path), desc, image, error);
    release(&bytes);
    return result;
}

facet_result input_load_environment(const char *path, const facet_environment_desc *desc,
                                    facet_environment **environment, facet_error *error)
{
    *environment = NULL;
    if (!path[0])
        return fail(error, FACET_ERROR_ARGUMENT, "facet: the name of an environment is empty");
    TRY(check_address(path, error));
    if (strcmp(path, "-") != 0)
        return facet_environment_load(path, desc, environment, error);
    growing bytes = {.allocator = &desc->allocator};
    facet_result result = read_stdin("an image", &bytes, error);
    if (result == FACET_OK)
        result =
            facet_environment_load_memory(bytes.data, bytes.used, input_name(path), desc, environment, error);
    release(&bytes);
    return result;
}

bool input_is_same_file(const char *a, const char *b)
{
    struct stat x, y;
    return stat(a, &x) == 0 && stat(b, &y) == 0 && x.st_dev == y.st_dev && x.st_ino == y.st_ino &&
           S_ISREG(x.st_mode);
}
