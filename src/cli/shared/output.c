/* output.c - see output.h. */
#define _POSIX_C_SOURCE 200809L
#include "cli/shared/output.h"

#include "cli/shared/failure.h"
#include "cli/shared/interrupt.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool output_exists(const char *path)
{
    return access(path, F_OK) == 0;
}

/* Writes the nearest existing folder above path to folder, without a trailing slash, and returns the rest
 * of path. NULL: too long. */
static const char *find_folder(const char *path, char *folder, size_t size)
{
    struct stat info;
    size_t length = strlen(path);
    if (length >= size)
        return NULL;
    for (size_t i = length; i > 0; i--) {
        if (path[i - 1] != '/')
            continue;
        snprintf(folder, size, "%.*s", i > 1 ? (int)i - 1 : 1, path);
        if (stat(folder, &info) == 0)
            return path + i;
    }
    snprintf(folder, size, ".");
    return path;
}

char *output_identity(const char *path)
{
    char folder[4096];
    struct stat info = {0};
    const char *rest = find_folder(path, folder, sizeof folder);
    size_t size = strlen(path) + 64;
    char *identity = malloc(size);
    if (!identity)
        return NULL;
    if (!rest || stat(folder, &info) != 0) /* which is reported elsewhere */
        info.st_ino = 0;
    snprintf(identity, size, "%llx.%llx/%s", (unsigned long long)info.st_dev, (unsigned long long)info.st_ino,
             rest ? rest : path);
    return identity;
}

facet_result output_make_folders(const char *path, facet_error *error)
{
    char folder[4096];
    if (strcmp(path, "-") == 0)
        return FACET_OK;
    const char *rest = find_folder(path, folder, sizeof folder);
    for (const char *slash = rest; slash && (slash = strchr(slash, '/')); slash++) {
        snprintf(folder, sizeof folder, "%.*s", (int)(slash - path), path);
        if (mkdir(folder, 0777) != 0 && errno != EEXIST)
            return fail(error, FACET_ERROR_WRITE, "%s: the folder %s cannot be created: %s", path, folder,
                        strerror(errno));
    }
    return FACET_OK;
}

/* From the first progress report on there are files, which the library removes on failure. */
static bool may_go_on(void *user, const char *stage, double fraction)
{
    (void)user, (void)stage, (void)fraction;
    interrupt_end();
    return !interrupt_signal() && interrupt_seconds_left() > 0.0;
}

facet_result output_write_scene(const facet_scene *scene, const char *path, facet_scene_save_desc desc,
                                facet_error *error)
{
    if (output_make_folders(path, error) != FACET_OK)
        return FACET_ERROR_WRITE;
    desc.progress.report = may_go_on;
    interrupt_begin(path, "writing it", false);
    facet_result result = facet_scene_save(scene, path, &desc, error);
    interrupt_end();
    return result == FACET_ERROR_CANCELLED ? interrupt_check(path, error) : result;
}

facet_result output_check(const char *path, facet_error *error)
{
    if (strcmp(path, "-") == 0)
        return FACET_OK;
    struct stat info;
    if (stat(path, &info) == 0) {
        if (S_ISDIR(info.st_mode))
            return fail(error, FACET_ERROR_WRITE, "%s: it is a folder; the name of a file was expected",
                        path);
        if (!S_ISREG(info.st_mode)) /* a device, a pipe: written directly */
            return access(path, W_OK) == 0 ? FACET_OK
                                           : fail(error, FACET_ERROR_WRITE, "%s: %s", path, strerror(errno));
    }
    char folder[4096];
    const char *rest = find_folder(path, folder, sizeof folder);
    if (!rest)
        return fail(error, FACET_ERROR_WRITE, "%s: the name is too long", path);
    if (stat(folder, &info) != 0)
        return fail(error, FACET_ERROR_WRITE, "%s: there is no folder %s", path, folder);
    if (!S_ISDIR(info.st_mode))
        return fail(error, FACET_ERROR_WRITE, "%s: %s is not a folder", path, folder);
    if (access(folder, W_OK | X_OK) != 0)
        return fail(error, FACET_ERROR_WRITE, "%s: the folder %s cannot be written to: %s", path, folder,
                    strerror(errno));
    return FACET_OK;
}

/* Begins the writing of a regular file (interrupt.h), or of a stream, which needs no cleanup and whose
 * reader may never come. Returns whether path is a file. */
static bool begin_writing(const char *path)
{
    struct stat info;
    bool is_stream = strcmp(path, "-") == 0 ||
                     (lstat(path, &info) == 0 && !S_ISREG(info.st_mode) && !S_ISLNK(info.st_mode));
    if (is_stream)
        interrupt_begin("facet", "writing", false);
    else
        interrupt_file_begin();
    return !is_stream;
}

static void end_writing(bool is_file)
{
    if (is_file)
        interrupt_file_end();
    else
        interrupt_end();
}

facet_result output_write_bytes(const void *bytes, size_t size, const char *path, facet_error *error)
{
    facet_result result = output_make_folders(path, error);
    if (result != FACET_OK)
        return result;
    bool is_file = begin_writing(path);
    if (strcmp(path, "-") != 0)
        result = facet_bytes_save(bytes, size, path, error);
    else if (fwrite(bytes, 1, size, stdout) != size || fflush(stdout) != 0)
        result = fail(error, FACET_ERROR_WRITE, "stdout: %s", strerror(errno));
    end_writing(is_file);
    return result;
}

facet_result output_write(const facet_image *image, const char *path, const facet_image_save_desc *desc,
                          facet_error *error)
{
    if (strcmp(path, "-") != 0) {
        if (output_make_folders(path, error) != FACET_OK)
            return FACET_ERROR_WRITE;
        bool is_file = begin_writing(path);
        facet_result saved = facet_image_save(image, path, desc, error);
        end_writing(is_file);
        return saved;
    }
    unsigned char *bytes;
    size_t size;
    facet_result result = facet_image_encode(image, desc, &bytes, &size, error);
    if (result == FACET_OK)
        result = output_write_bytes(bytes, size, path, error);
    facet_bytes_destroy(bytes);
    return result;
}

facet_result output_close_stdout(facet_error *error)
{
    bool has_failed = ferror(stdout) != 0;
    errno = 0;
    if (fflush(stdout) != 0 || has_failed)
        return fail(error, FACET_ERROR_WRITE, "stdout: %s",
                    errno ? strerror(errno) : "it could not be written");
    return FACET_OK;
}
