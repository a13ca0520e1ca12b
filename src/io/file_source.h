/* file_source.h - the files of a model: those of the file system, or those that the caller supplies
 * (facet_file_source). */
#ifndef IO_FILE_SOURCE_H
#define IO_FILE_SOURCE_H

#include "base/file.h"

static inline bool file_source_is_given(const facet_file_source *source)
{
    return source && source->open;
}

/* path without ".", "..", doubled and leading slashes: a block of mem_alloc(). NULL: no memory, or
 * (*leaves_top) the path leads above the topmost folder. */
char *file_source_path(const facet_allocator *allocator, const char *path, bool *leaves_top);

/* The part of a path of file_source_path() below a folder ("." is the topmost one). NULL: it is not below it. */
const char *file_source_below(const char *path, const char *folder, const facet_allocator *allocator);

/* The file at a path of file_source_path(), whose number is a hash of it. Fails with FACET_ERROR_READ
 * (there is no such file) and _LIMIT. */
facet_result file_source_open(const facet_file_source *source, const char *path, uint64_t max_bytes,
                              file_bytes *file, facet_error *error);
/* The number of that file. */
enum { FILE_SOURCE_DEVICE = 1 << 30 };
uint64_t file_source_number(const char *path);

/* The only path of the source that differs from path in case or in Unicode normalization; NULL: none, or several. */
const char *file_source_find_alike(const facet_file_source *source, const char *path);

/* The file of a model: of desc->files, else of the file system. Fails as file_open(). */
facet_result model_file_open(const char *path, const facet_scene_desc *desc, file_bytes *file,
                             facet_error *error);

#endif
