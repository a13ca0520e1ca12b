/* uri.h - which files a model may open. */
#ifndef IO_URI_H
#define IO_URI_H

#include "scene/scene.h"

/* The folder where file names in a model start, and the root that they may not leave. */
typedef struct file_scope {
    facet_scene *scene; /* owns the opened files */
    const facet_allocator *allocator;
    const facet_log *log;
    const facet_file_source *files; /* NULL, or {0}: the file system */
    const char *folder;             /* of the model; NULL: the model is read from memory */
    const char *root;               /* folder that names may reach; NULL: folder */
    uint64_t max_file_bytes;        /* larger files are refused */
    bool allows_absolute;           /* absolute names are tried, as they may lead below the root */
    bool is_literal;                /* alike names are not tried */
} file_scope;

/* Reads a model from bytes; folder: of its file, NULL: none. */
typedef facet_result io_loader(const char *bytes, size_t size, const char *source, const char *folder,
                               const facet_scene_desc *desc, facet_scene **scene, facet_error *error);
/* Opens a file, calls load with its bytes and folder, and notes the file in the scene. *scene is NULL on
 * failure. */
facet_result io_load_file(io_loader *load, const char *path, const facet_scene_desc *desc,
                          facet_scene **scene, facet_error *error);

/* FACET_ERROR_LIMIT for a model in memory that is larger than desc allows. */
facet_result io_check_size(size_t size, const char *name, const facet_scene_desc *desc, facet_error *error);

/* The bytes of a URI or file name. */
typedef struct uri_bytes {
    const unsigned char *data;
    size_t size;
    /* Set by file_scope_open(): the path of the file below the folder, in the scene's arena, and its index
     * in the scene's files, the same for all names of a file. */
    const char *name;
    uint32_t file;
    facet_result result;
    char message[512]; /* without the place in the model */
} uri_bytes;

/* Maps a regular file below the root; all names of a file share one mapping, which is closed with the
 * scene. The name is tried as written; then with Windows separators, with an escaped space, without "?.."
 * or "#..", and with %20 decoded; then as the only name in its folder that differs in case or in Unicode
 * normalization. A warning reports when another name than the written one is read, separators aside.
 * shown: the name for messages. False: *message and
 * *result give the reason. */
bool file_scope_open(const file_scope *scope, const char *name, const char *shown, uri_bytes *out);
/* The bytes of a URI: data: decoded into the arena of the scene, or a file by file_scope_open(). Never
 * uses the network. False: *message and *result give the reason. */
bool uri_load(const file_scope *scope, const char *uri, uri_bytes *out);

#endif
