/* viewer_package.c - see viewer_package.h. */
#define _POSIX_C_SOURCE 200809L
#include "cli/view/viewer_package.h"

#include "base/memory.h"
#include "base/result.h"
#include "facet_install.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* In every folder of the viewer. */
static const char mark[] = "pages/files.txt";

/* Whether folder is one of the viewer; writes it to out. */
static bool is_package(const char *folder, viewer_package *out)
{
    char name[sizeof out->folder + sizeof mark];
    int length = snprintf(out->folder, sizeof out->folder, "%s", folder);
    if (length < 0 || (size_t)length >= sizeof out->folder)
        return false;
    snprintf(name, sizeof name, "%s/%s", out->folder, mark);
    return access(name, R_OK) == 0;
}

/* The folder of the running command. */
static bool find_command(char *folder, size_t size)
{
    ssize_t length = readlink("/proc/self/exe", folder, size - 1);
    folder[length > 0 ? length : 0] = 0;
    char *slash = strrchr(folder, '/');
    if (slash)
        *slash = 0;
    return slash != NULL;
}

facet_result viewer_package_find(viewer_package *out, facet_error *error)
{
    /* from the folder of the command: installed; in the build tree build/NAME/src/cli */
    static const char *const places[] = {FACET_WEB_FROM_COMMAND, "../../../web/dist"};
    char command[3072], folder[4096];
    const char *named = getenv("FACET_WEB");
    if (named && *named)
        return is_package(named, out)
                   ? FACET_OK
                   : fail(error, FACET_ERROR_SYSTEM,
                          "--html: FACET_WEB names %s, in which there is no %s; it is the folder that "
                          "./run web --build makes, build/web/dist",
                          named, mark);
    bool has_command = find_command(command, sizeof command);
    for (size_t i = 0; has_command && i < sizeof places / sizeof *places; i++) {
        snprintf(folder, sizeof folder, "%s/%s", command, places[i]);
        if (is_package(folder, out))
            return FACET_OK;
    }
    return fail(error, FACET_ERROR_SYSTEM,
                "--html: the viewer for browsers is not installed here; ./run web --build in facet's sources "
                "builds it, and FACET_WEB=DIR names a folder elsewhere");
}

facet_result viewer_package_open(const viewer_package *p, const char *name, const facet_allocator *allocator,
                                 file_bytes *file, facet_error *error)
{
    char *path = path_join(allocator, p->folder, name);
    if (!path)
        return fail(error, FACET_ERROR_MEMORY, "out of memory: names");
    facet_result result = file_open(path, 0, allocator, file, error);
    mem_free(path);
    return result;
}
