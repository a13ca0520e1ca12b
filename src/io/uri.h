/* uri.h - which files a model may open. */
#ifndef IO_URI_H
#define IO_URI_H

#include "scene/scene.h"

/* Where names of files in a model start, and how far they reach. */
typedef struct file_scope {
    facet_scene *scene; /* keeps what is opened */
    const facet_allocator *allocator;
    const facet_log *log;
    const char *folder;      /* of the model; NULL: read from memory, there is none */
    const char *root;        /* folder that names may reach; NULL: folder */
    uint64_t max_file_bytes; /* larger files are refused */
    bool allows_absolute;    /* names that begin with a slash are looked at: they may lead below the root */
    bool is_literal;         /* names that are only alike do not count */
} file_scope;

/* Reads a model from bytes; folder: of its file, NULL: none. */
typedef facet_result io_loader(const char *bytes, size_t size, const char *source, const char *folder,
                               const facet_scene_desc *desc, facet_scene **scene, facet_error *error);
/* Opens a file, calls load with its bytes and folder, and notes the file in the scene. *scene is NULL on failure. */
facet_result io_load_file(io_loader *load, const char *path, const facet_scene_desc *desc,
                          facet_scene **scene, facet_error *error);

/* FACET_ERROR_LIMIT for a model in memory that is larger than desc allows. */
facet_result io_check_size(size_t size, const char *name, const facet_scene_desc *desc, facet_error *error);

/* The bytes that a name stands for. */
typedef struct uri_bytes {
    const unsigned char *data;
    size_t size;
    const char *name; /* of file_scope_open(): the file's own, below the folder; in the scene's arena */
    uint32_t file;    /* of file_scope_open(): index in the scene's files, one for all names of a file */
    facet_result result;
    char message[512]; /* without the place */
} uri_bytes;

/* Maps a regular file below the root, once for all its names; it is closed with the scene. The name is taken as it is
 * written; where there is no such file, with the separators of Windows, with a blank for a backslash and a blank, without
 * "?.." or "#..", with %20 decoded; then as the only name in its folder that differs in upper and lower case or in
 * Unicode's form. A warning says where another name than the written one is read, separators apart. shown: the name for
 * messages. False: *message says why, and *result. */
bool file_scope_open(const file_scope *scope, const char *name, const char *shown, uri_bytes *out);
/* The bytes of a URI: data: decoded into the arena of the scene, or a file by file_scope_open(). Never uses the network.
 * False: *message says why, and *result. */
bool uri_load(const file_scope *scope, const char *uri, uri_bytes *out);

#endif
