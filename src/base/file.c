/* file.c - see file.h. */
#define _GNU_SOURCE
#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/result.h"

/* Reads the rest of fd; for pipes and devices, whose size is unknown. */
static facet_result read_stream(int fd, const char *path, uint64_t max_bytes,
                                const facet_allocator *allocator, file_bytes *file, facet_error *error)
{
    unsigned char *data = NULL;
    size_t capacity = 0;
    size_t size = 0;
    for (;;) {
        if (!mem_reserve(allocator, (void **)&data, &capacity, size + 64 * 1024 + 1, 1)) {
            mem_free(data);
            return fail(error, FACET_ERROR_MEMORY, "%s: out of memory after %zu bytes", path, size);
        }
        ssize_t got = read(fd, data + size, capacity - size - 1);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0) {
            mem_free(data);
            return fail(error, FACET_ERROR_READ, "%s: cannot be read: %s", path, strerror(errno));
        }
        size += (size_t)got;
        if (max_bytes && size > max_bytes) {
            mem_free(data);
            return fail(error, FACET_ERROR_LIMIT, "%s: is larger than the limit of %llu bytes", path,
                        (unsigned long long)max_bytes);
        }
        if (got == 0)
            break;
    }
    data[size] = 0;
    *file = (file_bytes){.data = data, .size = size, .mapping = data, .mapping_size = 0};
    return FACET_OK;
}

/* Larger files are mapped: malformed ones are usually rejected after the first bytes, and the rest is
 * never read. Smaller ones are read, so that they may be truncated or rewritten while in use, which would
 * crash a process with a mapping. */
static const size_t MAPPED_FROM = (size_t)256 << 20;

/* Reads a file of size bytes. */
static facet_result read_sized(int fd, const char *path, size_t size, const facet_allocator *allocator,
                               file_bytes *file, facet_error *error)
{
    unsigned char *data = mem_alloc(allocator, size + 1, 1);
    if (!data)
        return fail_memory(error, path, size + 1);
    size_t at = 0;
    while (at < size) {
        ssize_t got = read(fd, data + at, size - at);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0) {
            mem_free(data);
            return fail(error, FACET_ERROR_READ, "%s: cannot be read: %s", path,
                        got < 0 ? strerror(errno) : "it became shorter meanwhile");
        }
        at += (size_t)got;
    }
    data[size] = 0;
    *file = (file_bytes){.data = data, .size = size, .mapping = data};
    return FACET_OK;
}

facet_result file_open_descriptor(int fd, const char *path, uint64_t max_bytes,
                                  const facet_allocator *allocator, file_bytes *file, facet_error *error)
{
    *file = (file_bytes){0};
    facet_result result;
    struct stat status;
    if (fstat(fd, &status) != 0) {
        result = fail(error, FACET_ERROR_READ, "%s: cannot be read: %s", path, strerror(errno));
    } else if (S_ISDIR(status.st_mode)) {
        result = fail(error, FACET_ERROR_READ, "%s: is a folder, not a file", path);
    } else if (!S_ISREG(status.st_mode)) {
        result = read_stream(fd, path, max_bytes, allocator, file, error);
    } else if (max_bytes && (uint64_t)status.st_size > max_bytes) {
        result = fail(error, FACET_ERROR_LIMIT, "%s: %llu bytes is larger than the limit of %llu", path,
                      (unsigned long long)status.st_size, (unsigned long long)max_bytes);
    } else {
        /* The byte behind the end must be 0: a file that fills its last page exactly is read, not mapped. */
        size_t size = (size_t)status.st_size;
        size_t page = (size_t)sysconf(_SC_PAGESIZE);
        bool is_mapped = size >= MAPPED_FROM && size % page;
        void *mapping = is_mapped ? mmap(NULL, size, PROT_READ, MAP_PRIVATE, fd, 0) : MAP_FAILED;
        if (mapping != MAP_FAILED) {
            *file = (file_bytes){.data = mapping, .size = size, .mapping = mapping, .mapping_size = size};
            result = FACET_OK;
        } else if (size) {
            result = read_sized(fd, path, size, allocator, file, error);
        } else { /* as files in /proc report */
            result = read_stream(fd, path, max_bytes, allocator, file, error);
        }
    }
    if (result == FACET_OK && S_ISREG(status.st_mode)) {
        file->device = (uint64_t)status.st_dev;
        file->number = (uint64_t)status.st_ino;
    }
    return result;
}

facet_result file_open(const char *path, uint64_t max_bytes, const facet_allocator *allocator,
                       file_bytes *file, facet_error *error)
{
    *file = (file_bytes){0};
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    if (fd < 0)
        return fail(error, FACET_ERROR_READ, "%s: cannot be opened: %s", path, strerror(errno));
    facet_result result = file_open_descriptor(fd, path, max_bytes, allocator, file, error);
    close(fd);
    return result;
}

bool file_is_at(const file_bytes *file, const char *path)
{
    struct stat status;
    return file->number && stat(path, &status) == 0 && (uint64_t)status.st_dev == file->device &&
           (uint64_t)status.st_ino == file->number;
}

void file_close(file_bytes *file)
{
    if (file->release)
        file->release(file->user, file->data, file->size);
    if (file->mapping_size)
        munmap(file->mapping, file->mapping_size);
    else
        mem_free(file->mapping);
    *file = (file_bytes){0};
}

static bool write_all(int fd, const unsigned char *data, size_t size)
{
    while (size) {
        ssize_t put = write(fd, data, size);
        if (put < 0 && errno == EINTR)
            continue;
        if (put <= 0)
            return false;
        data += put;
        size -= (size_t)put;
    }
    return true;
}

static facet_result write_directly(const char *path, const void *data, size_t size, facet_error *error)
{
    int fd = open(path, O_WRONLY | O_TRUNC | O_CLOEXEC);
    if (fd < 0)
        return fail(error, FACET_ERROR_WRITE, "%s: cannot be opened for writing: %s", path, strerror(errno));
    bool written = write_all(fd, data, size);
    int code = errno;
    if (close(fd) != 0 && written) {
        written = false;
        code = errno;
    }
    return written ? FACET_OK
                   : fail(error, FACET_ERROR_WRITE, "%s: cannot be written: %s", path, strerror(code));
}

/* Whether path names an open descriptor of this process, such as /dev/stdout, a link that root could replace. */
static bool is_descriptor(const char *path)
{
    static const char *const folders[] = {"/dev/fd/", "/proc/self/fd/"};
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
        size_t length = strlen(folders[i]);
        const char *number = path + length;
        if (strncmp(path, folders[i], length) == 0 && *number &&
            strspn(number, "0123456789") == strlen(number))
            return true;
    }
    return strcmp(path, "/dev/stdout") == 0 || strcmp(path, "/dev/stderr") == 0;
}

/* Whether path is such a name, or a link to it. */
static bool leads_to_descriptor(const char *path)
{
    char target[64];
    ssize_t length = readlink(path, target, sizeof target - 1);
    target[length > 0 ? length : 0] = 0;
    return is_descriptor(path) || is_descriptor(target);
}

/* Tries names beside path until one is free for make(), which returns a descriptor, or -1 with errno. *name: the path, for
 * free(). Negative: see errno. */
static int try_names(const char *path, int (*make)(const char *name, int user), int user, char **name)
{
    enum { MAX_LENGTH = 240, ATTEMPTS = 100 }; /* of the 255 bytes of a file name */
    const char *base = path_base_name(path);
    int fd = -1;
    *name = NULL;
    for (int i = 0; i < ATTEMPTS && fd < 0; i++) {
        struct timespec now;
        clock_gettime(CLOCK_MONOTONIC, &now);
        uint32_t number = (uint32_t)now.tv_nsec * 2654435761u ^ (uint32_t)getpid() * 40503u ^
                          (uint32_t)((uintptr_t)&now >> 4) ^ (uint32_t)i;
        free(*name);
        if (asprintf(name, "%.*s%.*s.%08x", (int)(base - path), path, MAX_LENGTH, base, number) < 0) {
            *name = NULL;
            errno = ENOMEM;
            return -1;
        }
        fd = make(*name, user);
        if (fd < 0 && errno != EEXIST)
            return -1;
    }
    return fd;
}

/* A new file of that name, with mode 666 less the umask. */
static int create_named(const char *name, int unused)
{
    (void)unused;
    return open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
}

/* Gives a name to a file without one. */
static int link_unnamed(const char *name, int fd)
{
    char link[64];
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    return linkat(AT_FDCWD, link, AT_FDCWD, name, AT_SYMLINK_FOLLOW) == 0 ? fd : -1;
}

/* A new file without a name in the folder of path: nothing is left of it if the process is killed. -1: the file system has
 * none such. */
static int create_unnamed(const char *path)
{
    char *folder = path_folder(NULL, path);
    int fd = folder ? open(folder, O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666) : -1;
    mem_free(folder);
    return fd;
}

/* Writes a temporary, to which *name leads afterwards; closes the descriptor. False: see errno. */
static bool fill_temporary(int fd, const char *path, mode_t mode, const void *data, size_t size, char **name)
{
    bool is_good = (!mode || fchmod(fd, mode) == 0) && write_all(fd, data, size) && fsync(fd) == 0 &&
                   (*name || try_names(path, link_unnamed, fd, name) >= 0);
    int code = errno;
    if (close(fd) != 0 && is_good)
        return false;
    errno = code;
    return is_good;
}

bool file_is_temporary(const char *path)
{
    const char *dot = strrchr(path_base_name(path), '.');
    return dot && dot != path_base_name(path) && strlen(dot + 1) == 8 &&
           strspn(dot + 1, "0123456789abcdef") == 8;
}

/* Writes the temporary of a stage; its destination is not a folder. */
static facet_result stage_regular(const char *path, const void *data, size_t size, file_stage *stage,
                                  facet_error *error)
{
    struct stat old;
    mode_t mode = lstat(path, &old) == 0 && S_ISREG(old.st_mode) ? old.st_mode & 0777 : 0;
    *stage = (file_stage){.path = strdup(path)};
    int fd = stage->path ? create_unnamed(path) : -1;
    if (fd >= 0 && fill_temporary(fd, path, mode, data, size, &stage->temporary))
        return FACET_OK;
    free(stage->temporary); /* of a name that could not be linked */
    fd = stage->path ? try_names(path, create_named, 0, &stage->temporary) : -1;
    if (fd < 0) {
        int code = stage->path ? errno : ENOMEM;
        free(stage->temporary);
        free(stage->path);
        *stage = (file_stage){0};
        return fail(error, FACET_ERROR_WRITE, "%s: cannot be created: %s", path, strerror(code));
    }
    if (fill_temporary(fd, path, mode, data, size, &stage->temporary))
        return FACET_OK;
    int code = errno;
    file_stage_discard(stage);
    return fail(error, FACET_ERROR_WRITE, "%s: cannot be written: %s", path, strerror(code));
}

facet_result file_stage_write(const char *path, const void *data, size_t size, file_stage *stage,
                              facet_error *error)
{
    struct stat status;
    *stage = (file_stage){0};
    if (stat(path, &status) == 0 && S_ISDIR(status.st_mode))
        return fail(error, FACET_ERROR_WRITE, "%s: is a folder, not a file", path);
    bool is_stream = lstat(path, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISLNK(status.st_mode);
    return is_stream || leads_to_descriptor(path) ? write_directly(path, data, size, error)
                                                  : stage_regular(path, data, size, stage, error);
}

facet_result file_stage_commit(file_stage *stage, facet_error *error)
{
    facet_result result = FACET_OK;
    if (stage->temporary && rename(stage->temporary, stage->path) != 0)
        result = fail(error, FACET_ERROR_WRITE, "%s: cannot be written: %s", stage->path, strerror(errno));
    if (result == FACET_OK) { /* the temporary was renamed */
        free(stage->temporary);
        stage->temporary = NULL;
    }
    file_stage_discard(stage);
    return result;
}

void file_stage_discard(file_stage *stage)
{
    if (stage->temporary)
        unlink(stage->temporary);
    free(stage->temporary);
    free(stage->path);
    *stage = (file_stage){0};
}

facet_result file_replace(const char *path, const void *data, size_t size, facet_error *error)
{
    struct stat old;
    file_stage stage = {0};
    if (lstat(path, &old) == 0 && S_ISDIR(old.st_mode))
        return fail(error, FACET_ERROR_WRITE, "%s: is a folder, not a file", path);
    TRY(stage_regular(path, data, size, &stage, error));
    return file_stage_commit(&stage, error);
}

/* Opens path if it is an empty regular file under one name that belongs to the user of this process; -1: it is not. */
static int open_empty(const char *path)
{
    struct stat status;
    if (lstat(path, &status) != 0 || !S_ISREG(status.st_mode) || status.st_size != 0)
        return -1;
    int fd = open(path, O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (fd >= 0 && (fstat(fd, &status) != 0 || !S_ISREG(status.st_mode) || status.st_size != 0 ||
                    status.st_nlink != 1 || status.st_uid != geteuid())) {
        close(fd);
        fd = -1;
    }
    return fd;
}

/* Fills an empty file; after a failure it is empty again. Closes the descriptor. */
static facet_result fill_empty(int fd, const char *path, const void *data, size_t size, facet_error *error)
{
    bool is_good = write_all(fd, data, size) && fsync(fd) == 0;
    int code = errno;
    if (!is_good && ftruncate(fd, 0) != 0)
        code = errno;
    close(fd);
    return is_good ? FACET_OK
                   : fail(error, FACET_ERROR_WRITE, "%s: cannot be written: %s", path, strerror(code));
}

facet_result file_write(const char *path, const void *data, size_t size, facet_error *error)
{
    file_stage stage;
    int fd = open_empty(path);
    if (fd >= 0)
        return fill_empty(fd, path, data, size, error);
    TRY(file_stage_write(path, data, size, &stage, error));
    return file_stage_commit(&stage, error);
}

char *path_join(const facet_allocator *allocator, const char *folder, const char *name)
{
    size_t folder_length = strlen(folder);
    size_t name_length = strlen(name);
    char *path = mem_alloc(allocator, folder_length + name_length + 2, 1);
    if (!path)
        return NULL;
    memcpy(path, folder, folder_length);
    size_t at = folder_length;
    if (at && path[at - 1] != '/')
        path[at++] = '/';
    memcpy(path + at, name, name_length + 1);
    return path;
}

char *path_folder(const facet_allocator *allocator, const char *path)
{
    const char *slash = strrchr(path, '/');
    size_t length = !slash ? 1 : slash == path ? 1 : (size_t)(slash - path);
    char *folder = mem_alloc(allocator, length + 1, 1);
    if (!folder)
        return NULL;
    memcpy(folder, slash ? path : ".", length);
    folder[length] = 0;
    return folder;
}

const char *path_base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

const char *path_extension(const char *path)
{
    const char *point = strrchr(path_base_name(path), '.');
    return point ? point + 1 : "";
}

/* The part of real_path below real_folder, both without links; NULL: it is not below. */
static const char *path_below(const char *real_path, const char *real_folder)
{
    size_t length = strlen(real_folder);
    if (length == 1) /* "/" */
        return real_path + 1;
    bool is_below = strncmp(real_path, real_folder, length) == 0 && strchr("/", real_path[length]);
    return is_below ? real_path + length + (real_path[length] == '/') : NULL;
}

/* Opens a path without links below a folder, and follows none: a link there was put in meanwhile. */
static int open_without_links(const char *real_folder, const char *below)
{
    int at = open(real_folder, O_PATH | O_DIRECTORY | O_CLOEXEC);
    for (bool is_last = false; at >= 0 && !is_last;) {
        char name[NAME_MAX + 1];
        size_t length = strcspn(below, "/");
        is_last = below[length] == 0;
        int flags = O_NOFOLLOW | O_CLOEXEC | (is_last ? O_RDONLY | O_NONBLOCK : O_PATH | O_DIRECTORY);
        int next = -1;
        if (length < sizeof name) {
            memcpy(name, below, length);
            name[length] = 0;
            next = openat(at, length ? name : ".", flags);
        } else {
            errno = ENAMETOOLONG;
        }
        int code = errno;
        close(at);
        errno = code;
        at = next;
        below += length + !is_last;
    }
    return at;
}

int path_open_inside(const char *path, const char *folder)
{
    char *real_path = realpath(path, NULL);
    char *real_folder = real_path ? realpath(folder, NULL) : NULL;
    int fd = -1;
    if (real_folder) {
        const char *below = path_below(real_path, real_folder);
        if (below)
            fd = open_without_links(real_folder, below);
        else
            errno = EXDEV;
    }
    int code = errno;
    free(real_path);
    free(real_folder);
    errno = code;
    return fd;
}
