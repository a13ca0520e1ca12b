/* farm_program.c - see farm_program.h. */
#define _POSIX_C_SOURCE 200809L
#include "cli/farm/farm_program.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { EXIT_NOT_FOUND = 127, OUTPUT_MAX = 64 << 20 };

/* Becomes the program, which writes to the descriptor output. */
static void become(const char *const *words, const char *folder, bool is_quiet, int output)
{
    int nothing = open("/dev/null", O_RDWR);
    dup2(nothing, 0);
    dup2(output, 1);
    if (is_quiet)
        dup2(nothing, 2);
    if (chdir(folder) == 0)
        execvp(words[0], (char *const *)(uintptr_t)words);
    _exit(EXIT_NOT_FOUND);
}

/* All that comes from a descriptor, as text; NULL: no memory. */
static char *read_all(int descriptor)
{
    size_t length = 0, capacity = 4096;
    char *text = malloc(capacity);
    while (text) {
        ssize_t count = read(descriptor, text + length, capacity - length - 1);
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0)
            break;
        length += (size_t)count;
        if (capacity - length > 1)
            continue;
        capacity *= 2;
        char *grown = capacity > OUTPUT_MAX ? NULL : realloc(text, capacity);
        if (!grown)
            free(text);
        text = grown;
    }
    if (text)
        text[length] = 0;
    return text;
}

static facet_result fail_program(const char *name, int status, facet_error *error)
{
    if (WIFSIGNALED(status))
        return fail(error, FACET_ERROR_SYSTEM, "%s: killed by signal %d", name, WTERMSIG(status));
    if (WEXITSTATUS(status) == EXIT_NOT_FOUND)
        return fail(error, FACET_ERROR_SYSTEM, "%s: the program is not installed here, or not in PATH", name);
    return fail(error, FACET_ERROR_SYSTEM, "%s: failed with exit code %d", name, WEXITSTATUS(status));
}

facet_result farm_program_run(const char *const *words, const char *folder, bool is_quiet, int max_exit_code,
                              char **output, facet_error *error)
{
    int pipes[2], status = 0;
    *output = NULL;
    if (pipe(pipes) != 0)
        return fail(error, FACET_ERROR_SYSTEM, "%s: no pipe: %s", words[0], strerror(errno));
    pid_t child = fork();
    if (child == 0) {
        close(pipes[0]);
        become(words, folder, is_quiet, pipes[1]);
    }
    int reason = errno;
    close(pipes[1]);
    char *text = child > 0 ? read_all(pipes[0]) : NULL;
    close(pipes[0]);
    if (child < 0)
        return fail(error, FACET_ERROR_SYSTEM, "%s: no process: %s", words[0], strerror(reason));
    while (waitpid(child, &status, 0) < 0 && errno == EINTR)
        ;
    if (!WIFEXITED(status) || WEXITSTATUS(status) > max_exit_code) {
        free(text);
        return fail_program(words[0], status, error);
    }
    if (!text)
        return fail(error, FACET_ERROR_MEMORY, "out of memory: the output of %s", words[0]);
    *output = text;
    return FACET_OK;
}
