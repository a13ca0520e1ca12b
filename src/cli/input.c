/* input.c - models from files, standard input, or built in. */
#define _POSIX_C_SOURCE 200809L
#include "cli/input.h"

#include "cli/failure.h"
#include "cli/terminal.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

const char *input_name(const char *path)
{
    return !path ? "built-in scene" : strcmp(path, "-") == 0 ? "stdin" : path;
}

facet_result input_read_stdin(uint64_t max_bytes, unsigned char **bytes, size_t *size, facet_error *error)
{
    *bytes = NULL;
    *size = 0;
    if (terminal_is(stdin))
        return fail_with(error, FACET_ERROR_ARGUMENT,
                         "stdin: - is standard input, which is a terminal; send a file into it");
    if (!max_bytes)
        max_bytes = (uint64_t)4 << 30;
    unsigned char *data = NULL;
    size_t used = 0, capacity = 0;
    facet_result result = FACET_OK;
    while (result == FACET_OK) {
        if (used == capacity) {
            capacity = capacity ? 2 * capacity : (size_t)1 << 18;
            unsigned char *grown = realloc(data, capacity);
            if (!grown) {
                result = fail_with(error, FACET_ERROR_MEMORY, "stdin: out of memory: %zu bytes", capacity);
                break;
            }
            data = grown;
        }
        ssize_t n = read(STDIN_FILENO, data + used, capacity - used);
        if (n == 0)
            break;
        if (n > 0)
            used += (size_t)n;
        else if (errno != EINTR)
            result = fail_with(error, FACET_ERROR_READ, "stdin: %s", strerror(errno));
        if (used > max_bytes)
            result = fail_with(error, FACET_ERROR_LIMIT, "stdin: it is larger than %llu bytes",
                               (unsigned long long)max_bytes);
    }
    if (result == FACET_OK && used == 0)
        result = fail_with(error, FACET_ERROR_READ, "stdin: it is empty; a model was expected");
    if (result != FACET_OK) {
        free(data);
        return result;
    }
    *bytes = data;
    *size = used;
    return FACET_OK;
}

facet_result input_load(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                        facet_error *error)
{
    *scene = NULL;
    if (!path)
        return facet_scene_create_builtin(desc, scene, error);
    if (strcmp(path, "-") != 0)
        return facet_scene_load(path, desc, scene, error);
    unsigned char *bytes;
    size_t size;
    facet_result result = input_read_stdin(desc->max_file_bytes, &bytes, &size, error);
    if (result == FACET_OK)
        result = facet_scene_load_memory(bytes, size, input_name(path), desc, scene, error);
    free(bytes);
    return result;
}

bool input_is_same_file(const char *a, const char *b)
{
    struct stat x, y;
    return stat(a, &x) == 0 && stat(b, &y) == 0 && x.st_dev == y.st_dev && x.st_ino == y.st_ino &&
           S_ISREG(x.st_mode);
}
