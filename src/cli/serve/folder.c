/* folder.c - see folder.h. */
#define _GNU_SOURCE
#include "cli/serve/folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PATH_SIZE = 4096 };

facet_result folder_create(folder *f, facet_error *error)
{
    const char *parent = getenv("TMPDIR");
    folder made;
    int n = snprintf(made.path, sizeof made.path, "%s/facet-serve-XXXXXX",
                     parent && parent[0] == '/' ? parent : "/tmp");
    if (n < 0 || (size_t)n >= sizeof made.path || !mkdtemp(made.path))
        return fail(error, FACET_ERROR_WRITE, "%s: a temporary folder cannot be made: %s",
                    parent && parent[0] == '/' ? parent : "/tmp", strerror(errno));
    *f = made;
    return FACET_OK;
}

facet_result folder_create_below(folder *f, const folder *parent, uint64_t number, facet_error *error)
{
    char path[PATH_SIZE];
    if (f->path[0])
        return FACET_OK;
    snprintf(path, sizeof path, "%s/%llu", parent->path, (unsigned long long)number);
    bool is_made = strlen(path) < sizeof f->path && mkdir(path, 0700) == 0;
    if (is_made)
        memcpy(f->path, path, strlen(path) + 1);
    for (int i = 0; i < 2 && is_made; i++) {
        snprintf(path, sizeof path, "%s/%s", f->path, i ? "out" : "in");
        is_made = mkdir(path, 0700) == 0;
    }
    return is_made ? FACET_OK
                   : fail(error, FACET_ERROR_WRITE, "a temporary folder cannot be made: %s", strerror(errno));
}

static int remove_one(const char *path, const struct stat *info, int type, struct FTW *place)
{
    (void)info;
    (void)type;
    (void)place;
    remove(path);
    return 0;
}

void folder_remove(folder *f)
{
    if (f->path[0])
        nftw(f->path, remove_one, 8, FTW_DEPTH | FTW_PHYS);
    f->path[0] = 0;
}

/* ---- files of a request ---- */

bool folder_name_is_plain(const char *name)
{
    if (!*name || strlen(name) > 1000)
        return false;
    for (const char *at = name; *at;) {
        size_t length = strcspn(at, "/");
        if (!length || at[0] == '.' || at[0] == '-' || length > 200)
            return false;
        for (size_t i = 0; i < length; i++)
            if ((unsigned char)at[i] < 0x20 || at[i] == 0x7f)
                return false;
        at += length + (at[length] == '/' && at[length + 1]);
        if (*at == '/')
            return false;
    }
    return true;
}

/* Makes the folders of a file. */
static void make_folders(char *path, size_t from)
{
    for (char *slash = strchr(path + from, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = 0;
        mkdir(path, 0700);
        *slash = '/';
    }
}

static bool write_all(int fd, const char *bytes, size_t size)
{
    while (size) {
        ssize_t n = write(fd, bytes, size);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return false;
        bytes += n;
        size -= (size_t)n;
    }
    return true;
}

facet_result folder_add(const folder *f, const char *name, const void *bytes, size_t size, char *path,
                        size_t path_size, facet_error *error)
{
    if (!folder_name_is_plain(name))
        return fail(
            error, FACET_ERROR_ARGUMENT,
            "the name \"%.100s\" is not a relative name without \"..\" and without a dot or dash in front",
            name);
    int n = snprintf(path, path_size, "%s/in/%s", f->path, name);
    if (n < 0 || (size_t)n >= path_size)
        return fail(error, FACET_ERROR_ARGUMENT, "the name \"%.100s\" is too long", name);
    make_folders(path, strlen(f->path) + 4);
    int fd = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    bool is_written = fd >= 0 && write_all(fd, bytes, size);
    int code = errno;
    if (fd >= 0)
        close(fd);
    return is_written ? FACET_OK
                      : fail(error, FACET_ERROR_WRITE, "%s: it cannot be kept: %s", name, strerror(code));
}

/* ---- files that it made ---- */

typedef struct collection {
    answer *out;
    size_t bytes_left, prefix_length;
    facet_error *error;
} collection;

/* Reads a whole file into *file. */
static facet_result read_file(const char *path, size_t size, answer_file *file, facet_error *error)
{
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    file->bytes = malloc(size + 1);
    while (fd >= 0 && file->bytes && file->size < size) {
        ssize_t n = read(fd, file->bytes + file->size, size - file->size);
        if (n <= 0)
            break;
        file->size += (size_t)n;
    }
    if (fd >= 0)
        close(fd);
    return file->bytes && file->size == size
               ? FACET_OK
               : fail(error, FACET_ERROR_READ, "the result cannot be read back");
}

static facet_result collect_file(collection *c, const char *path, size_t size)
{
    answer_file file = {.name = strdup(path + c->prefix_length)};
    answer_file *grown = realloc(c->out->files, (c->out->file_count + 1) * sizeof *grown);
    facet_result result = FACET_OK;
    if (grown)
        c->out->files = grown;
    if (!grown || !file.name)
        result = fail_memory(c->error, "results", 0);
    else if (size > c->bytes_left)
        result = fail(c->error, FACET_ERROR_LIMIT,
                      "the result is larger than a response may be; name a file for it with output");
    if (result == FACET_OK)
        result = read_file(path, size, &file, c->error);
    if (result != FACET_OK) {
        free(file.name);
        free(file.bytes);
        return result;
    }
    c->bytes_left -= size;
    c->out->files[c->out->file_count++] = file;
    return FACET_OK;
}

/* Collects the files in a folder and its folders. */
static facet_result collect_folder(collection *c, const char *parent, int depth)
{
    struct dirent **entries = NULL;
    int count = depth < 8 ? scandir(parent, &entries, NULL, alphasort) : 0;
    facet_result result = FACET_OK;
    for (int i = 0; i < count; i++) {
        char path[PATH_SIZE];
        struct stat info;
        bool is_one =
            entries[i]->d_name[0] != '.' &&
            (size_t)snprintf(path, sizeof path, "%s/%s", parent, entries[i]->d_name) < sizeof path &&
            lstat(path, &info) == 0;
        free(entries[i]);
        if (result != FACET_OK || !is_one)
            continue;
        if (S_ISDIR(info.st_mode))
            result = collect_folder(c, path, depth + 1);
        else if (S_ISREG(info.st_mode))
            result = collect_file(c, path, (size_t)info.st_size);
    }
    free(entries);
    return result;
}

facet_result folder_collect(const folder *f, size_t max_bytes, answer *out, facet_error *error)
{
    char path[FOLDER_PATH_SIZE + 8];
    int length = snprintf(path, sizeof path, "%s/out", f->path);
    collection c = {out, max_bytes, (size_t)length + 1, error};
    return collect_folder(&c, path, 0);
}
