/* cache.c - see cache.h. */
#define _POSIX_C_SOURCE 200809L
#include "ibl/cache.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/result.h"
#include "ibl/environment.h"

static const char prefix[] = "facet-";
static const char suffix[] = ".light";
enum { NAME_SIZE = 96 };

/* Header of an entry, in the machine's byte order: caches are not portable. */
typedef struct entry_header {
    char magic[8];
    uint64_t size;
    uint64_t hash; /* of the data, seeded with the entry's key */
} entry_header;
static const char magic[8] = {'F', 'A', 'C', 'E', 'T', 'L', 'T', '1'};

uint64_t cache_hash(uint64_t seed, const void *bytes, size_t size)
{
    /* eight bytes at a time: multiply, then fold the high bits, which depend on all, onto the low */
    const uint64_t prime = 0x9e3779b97f4a7c15u; /* 2^64 / golden ratio */
    const unsigned char *p = bytes;
    uint64_t hash = (seed ^ size) * prime;
    while (size) {
        uint64_t word = 0;
        size_t count = size < sizeof word ? size : sizeof word;
        memcpy(&word, p, count);
        hash = (hash ^ word) * prime;
        hash ^= hash >> 32;
        p += count;
        size -= count;
    }
    return hash;
}

/* Raise this whenever the same file is decoded to different texels, which invalidates the cache. */
enum { READER_VERSION = 1 };

void cache_identify(facet_environment *environment, const void *bytes, size_t size)
{
    if (environment->cache_folder)
        environment->hash =
            cache_hash(environment->hash + environment->layout + (READER_VERSION << 8), bytes, size);
}

facet_result cache_finish(facet_result result, facet_environment *made, facet_environment **environment)
{
    if (result != FACET_OK) {
        environment_release(made);
        return result;
    }
    cache_identify(made, made->panorama.pixels, made->panorama.height * image_row_size(&made->panorama));
    *environment = made;
    return FACET_OK;
}

/* Path of an entry, a block of mem_alloc(); NULL: out of memory. */
static char *entry_path(const facet_environment *e, const char *part, uint64_t key)
{
    char name[NAME_SIZE];
    snprintf(name, sizeof name, "%s%016" PRIx64 "-%s%s", prefix, key, part, suffix);
    return path_join(&e->allocator, e->cache_folder, name);
}

static uint64_t entry_key(const facet_environment *e, uint64_t recipe)
{
    return cache_hash(e->hash, &recipe, sizeof recipe);
}

bool cache_read(const facet_environment *environment, const char *part, uint64_t recipe, void *data,
                size_t size)
{
    if (!environment->cache_folder)
        return false;
    uint64_t key = entry_key(environment, recipe);
    char *path = entry_path(environment, part, key);
    file_bytes file = {0};
    bool is_good = false;
    struct stat status; /* reading a pipe without a writer would block */
    if (path && stat(path, &status) == 0 && S_ISREG(status.st_mode) &&
        file_open(path, sizeof(entry_header) + size, &environment->allocator, &file, NULL) == FACET_OK &&
        file.size == sizeof(entry_header) + size) {
        entry_header header;
        memcpy(&header, file.data, sizeof header);
        const unsigned char *from = file.data + sizeof header;
        is_good = memcmp(header.magic, magic, sizeof magic) == 0 && header.size == size &&
                  header.hash == cache_hash(key, from, size);
        if (is_good) {
            memcpy(data, from, size);
            utimensat(AT_FDCWD, path, NULL,
                      0); /* marks the entry as used; if that is not permitted it stays old */
        }
    }
    file_close(&file);
    mem_free(path);
    return is_good;
}

/* ---- keeping the folder small ---- */

static bool is_entry(const char *name)
{
    size_t length = strlen(name);
    return length < NAME_SIZE && length > sizeof prefix + sizeof suffix &&
           strncmp(name, prefix, sizeof prefix - 1) == 0 &&
           strcmp(name + length - (sizeof suffix - 1), suffix) == 0;
}

/* Size of all entries, and the least recently used one. */
static uint64_t survey(DIR *folder, char oldest[NAME_SIZE])
{
    uint64_t bytes = 0;
    struct timespec oldest_time = {0};
    oldest[0] = 0;
    rewinddir(folder);
    for (struct dirent *d = readdir(folder); d; d = readdir(folder)) {
        struct stat s;
        if (!is_entry(d->d_name) || fstatat(dirfd(folder), d->d_name, &s, AT_SYMLINK_NOFOLLOW) != 0 ||
            !S_ISREG(s.st_mode))
            continue;
        bytes += (uint64_t)s.st_size;
        bool is_older = s.st_mtim.tv_sec < oldest_time.tv_sec ||
                        (s.st_mtim.tv_sec == oldest_time.tv_sec && s.st_mtim.tv_nsec < oldest_time.tv_nsec);
        if (!oldest[0] || is_older) {
            oldest_time = s.st_mtim;
            memcpy(oldest, d->d_name, strlen(d->d_name) + 1);
        }
    }
    return bytes;
}

static void remove_oldest(const facet_environment *e)
{
    DIR *folder = opendir(e->cache_folder);
    if (!folder)
        return;
    char oldest[NAME_SIZE];
    while (survey(folder, oldest) > e->cache_bytes && oldest[0])
        if (unlinkat(dirfd(folder), oldest, 0) != 0)
            break;
    closedir(folder);
}

void cache_write(const facet_environment *environment, const char *part, uint64_t recipe, const void *data,
                 size_t size)
{
    if (!environment->cache_folder || sizeof(entry_header) + size > environment->cache_bytes)
        return;
    uint64_t key = entry_key(environment, recipe);
    char *path = entry_path(environment, part, key);
    unsigned char *entry = mem_alloc(&environment->allocator, sizeof(entry_header) + size, 1);
    facet_error error = {.message = "out of memory"};
    bool is_written = false;
    if (path && entry) {
        entry_header header = {.size = size, .hash = cache_hash(key, data, size)};
        memcpy(header.magic, magic, sizeof magic);
        memcpy(entry, &header, sizeof header);
        memcpy(entry + sizeof header, data, size);
        if (mkdir(environment->cache_folder, 0777) != 0 && errno != EEXIST)
            fail(&error, FACET_ERROR_WRITE, "%s: cannot be created: %s", environment->cache_folder,
                 strerror(errno));
        else
            is_written = file_replace(path, entry, sizeof header + size, &error) == FACET_OK;
    }
    if (is_written)
        remove_oldest(environment);
    else
        log_warning(&environment->log, "the prepared light cannot be cached: %s", error.message);
    mem_free(path);
    mem_free(entry);
}
