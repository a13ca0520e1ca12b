/* file.h - reads and writes whole files, and handles file names. */
#ifndef BASE_FILE_H
#define BASE_FILE_H

#include "facet/facet.h"

/* The bytes of a file: read, or mapped where it has 256 MiB or more. */
typedef struct file_bytes {
    const unsigned char
        *data; /* followed by at least one readable byte of 0, unless somebody else supplies it */
    size_t size;
    void *mapping; /* for file_close() */
    size_t mapping_size;
    uint64_t device, number; /* identify a regular file under any name; number 0: none */
    const char *path;        /* of its owner, who sets it; NULL: unknown */
    /* of a file that somebody else supplies: file_close() gives it back; NULL: nothing to do */
    void (*release)(void *user, const void *data, size_t size);
    void *user;
} file_bytes;

/* The limit that the max_file_bytes of a desc stands for, of which 0 is the default. */
static inline uint64_t file_limit(uint64_t max_file_bytes)
{
    return max_file_bytes ? max_file_bytes : (uint64_t)4 << 30;
}

/* Opens path for reading as a whole. Fails with FACET_ERROR_READ (missing, a folder, no permission), _LIMIT
 * where it is larger than max_bytes (0: no limit), _MEMORY. A mapped file must not shrink while it is open. */
facet_result file_open(const char *path, uint64_t max_bytes, const facet_allocator *allocator,
                       file_bytes *file, facet_error *error);
/* The same of an open file descriptor, which stays open; path is for messages. */
facet_result file_open_descriptor(int fd, const char *path, uint64_t max_bytes,
                                  const facet_allocator *allocator, file_bytes *file, facet_error *error);
void file_close(file_bytes *file); /* {0} is allowed; leaves {0} */
/* Whether path refers to the file that was opened, possibly by another name. */
bool file_is_at(const file_bytes *file, const char *path);

/* Writes size bytes to path: to a temporary file beside it, which is flushed to disk and renamed; after a
 * failure (FACET_ERROR_WRITE) path is unchanged and no temporary remains. An existing path that is not a
 * regular file (a device, a pipe) is written directly, and so is /dev/stdout. Any other link is replaced,
 * not followed: a user who can create links in a folder must not choose which file is overwritten.
 * An empty file of the user's is filled in place: a program may have created it and hold it open to read the
 * result, as thumbnailing services do, and nothing of value can be lost. */
facet_result file_write(const char *path, const void *data, size_t size, facet_error *error);
/* Whether path has the name of such a temporary file: NAME.xxxxxxxx, eight hexadecimal digits. It may remain where a process
 * was killed and the file system has no files without names. */
bool file_is_temporary(const char *path);
/* The same as file_write(), but replaces whatever is at path except a folder: for files of facet's own. */
facet_result file_replace(const char *path, const void *data, size_t size, facet_error *error);

/* A file that is written to disk but not yet in place. {0}: none. */
typedef struct file_stage {
    char *path, *temporary; /* temporary NULL: a device or pipe, already written */
} file_stage;

/* The two halves of file_write(), for several files that must appear together: stage them all, then commit
 * them. A commit rarely fails, and leaves {0}; so does a discard, after which path is unchanged. */
facet_result file_stage_write(const char *path, const void *data, size_t size, file_stage *stage,
                              facet_error *error);
facet_result file_stage_commit(file_stage *stage, facet_error *error);
void file_stage_discard(file_stage *stage); /* {0} is allowed */

/* Joins folder and the relative path name into a block of mem_alloc(); NULL: no memory. */
char *path_join(const facet_allocator *allocator, const char *folder, const char *name);
/* The folder of path without trailing slash, "." where it has none; a block of mem_alloc(). */
char *path_folder(const facet_allocator *allocator, const char *path);
/* The part behind the last slash. */
const char *path_base_name(const char *path);
/* The part behind the last dot of the base name, or "". */
const char *path_extension(const char *path);
/* Opens path for reading (a pipe without waiting for a writer) if it is folder or below it after links are
 * resolved. The opened file is the one that was checked: if a link is replaced in between, the call fails.
 * Returns a file descriptor, or -1 with errno, which is EXDEV if path leads out of folder. */
int path_open_inside(const char *path, const char *folder);

#endif
