/* root.c - see root.h. Links are resolved before a path is compared with the root; names that climb out of it
 * are refused unseen, so that answers do not tell what exists outside. */
#define _DEFAULT_SOURCE
#define _XOPEN_SOURCE 700
#include "cli/serve/root.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

facet_result root_enter(const char *folder, root *out, facet_error *error)
{
    char resolved[PATH_MAX];
    if (!realpath(folder, resolved) || chdir(resolved) != 0)
        return fail(error, FACET_ERROR_READ, "--root: %s: %s", folder, strerror(errno));
    snprintf(out->path, sizeof out->path, "%.*s", ROOT_PATH_SIZE - 1, resolved);
    return FACET_OK;
}

/* The part of an absolute path below the root; NULL: it is outside. "" for the root itself. */
static const char *part_below(const root *r, const char *path)
{
    size_t length = strlen(r->path);
    if (length == 1)
        return path + strspn(path, "/");
    if (strncmp(path, r->path, length) != 0 || (path[length] && path[length] != '/'))
        return NULL;
    return path + length + strspn(path + length, "/");
}

/* Whether a relative path climbs above its start at any point. */
static bool climbs_out(const char *path)
{
    long depth = 0;
    while (*path) {
        size_t length = strcspn(path, "/");
        if (length == 2 && memcmp(path, "..", 2) == 0)
            depth--;
        else if (length && !(length == 1 && path[0] == '.'))
            depth++;
        if (depth < 0)
            return true;
        path += length + strspn(path + length, "/");
    }
    return false;
}

static bool refuse_outside(const char *path, answer *refusal)
{
    return answer_fail(refusal, ANSWER_FORBIDDEN, "%.800s: it is outside of the folder of --root", path);
}

/* The path relative to the root, by its text alone; NULL: it is outside, or no path. */
static const char *written_below(const root *r, const char *path, answer *refusal)
{
    const char *below = path[0] == '/' ? part_below(r, path) : path;
    if (!*path || strlen(path) >= ROOT_PATH_SIZE / 2) {
        answer_fail(refusal, ANSWER_USAGE, "the path \"%.60s\" is %s", path, *path ? "too long" : "empty");
        return NULL;
    }
    if (!below || climbs_out(below)) {
        refuse_outside(path, refusal);
        return NULL;
    }
    return *below ? below : ".";
}

/* "./-x" for a name that begins like an option; the same path otherwise. */
static void put_below(const char *below, char out[ROOT_PATH_SIZE])
{
    snprintf(out, ROOT_PATH_SIZE, "%s%.*s", below[0] == '-' ? "./" : "", ROOT_PATH_SIZE - 4,
             *below ? below : ".");
}

/* Cuts the last name off a relative path; false: it was the only one, and the path is now ".". */
static bool cut_last(char *path)
{
    char *slash = strrchr(path, '/');
    while (slash && slash > path && slash[-1] == '/')
        slash--;
    if (!slash) {
        memcpy(path, ".", 2);
        return false;
    }
    *slash = 0;
    return true;
}

/* Resolves the deepest folder above a relative path that exists: folder is its part of the path. False: none can be. */
static bool resolve_above(const char *path, char folder[ROOT_PATH_SIZE], char resolved[PATH_MAX])
{
    snprintf(folder, ROOT_PATH_SIZE, "%.*s", ROOT_PATH_SIZE - 1, path);
    size_t length = strlen(folder);
    while (length > 1 && folder[length - 1] == '/')
        folder[--length] = 0;
    bool has_more = cut_last(folder);
    while (!realpath(folder, resolved)) {
        if ((errno != ENOENT && errno != ENOTDIR) || !has_more)
            return false;
        has_more = cut_last(folder);
    }
    return true;
}

bool root_find(const root *r, const char *path, char below[ROOT_PATH_SIZE], answer *refusal)
{
    char resolved[PATH_MAX];
    const char *written = written_below(r, path, refusal);
    if (!written)
        return false;
    if (!realpath(written, resolved)) {
        char folder[ROOT_PATH_SIZE];
        int code = errno;
        if (resolve_above(written, folder, resolved) && !part_below(r, resolved))
            return refuse_outside(path, refusal);
        return answer_fail(refusal, ANSWER_MISSING, "%.800s: %s", path, strerror(code));
    }
    const char *part = part_below(r, resolved);
    if (!part)
        return refuse_outside(path, refusal);
    put_below(part, below);
    return true;
}

bool root_place(const root *r, const char *path, char below[ROOT_PATH_SIZE], answer *refusal)
{
    char folder[ROOT_PATH_SIZE], resolved[PATH_MAX];
    const char *written = written_below(r, path, refusal);
    if (!written)
        return false;
    if (strstr(written, "..") && (strncmp(written, "../", 3) == 0 || strstr(written, "/../")))
        return answer_fail(refusal, ANSWER_FORBIDDEN, "%.800s: the path of an output cannot contain \"..\"",
                           path);
    if (!resolve_above(written, folder, resolved))
        return answer_fail(refusal, ANSWER_UNWRITABLE, "%.800s: %s", path, strerror(errno));
    const char *part = part_below(r, resolved);
    if (!part)
        return refuse_outside(path, refusal);
    const char *rest = strcmp(folder, ".") == 0 ? written : written + strlen(folder);
    char joined[2 * ROOT_PATH_SIZE];
    snprintf(joined, sizeof joined, "%s%s%s", part, *part ? "/" : "", rest + strspn(rest, "/"));
    if (strlen(joined) >= ROOT_PATH_SIZE - 4)
        return answer_fail(refusal, ANSWER_USAGE, "the path \"%.60s..\" is too long", path);
    put_below(joined, below);
    return true;
}
