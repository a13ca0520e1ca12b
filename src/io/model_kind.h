/* model_kind.h - recognizes the format of a model by content and, where that is ambiguous, by file name. */
#ifndef IO_MODEL_KIND_H
#define IO_MODEL_KIND_H

#include "facet/facet.h"

typedef enum model_kind {
    MODEL_UNKNOWN,
    MODEL_GLTF,
    MODEL_OBJ,
    MODEL_PARAMETERS, /* rgl's JSON */
    MODEL_STL,
    MODEL_PLY,
    MODEL_FOREIGN /* another format: see model_kind_refuse() */
} model_kind;

/* name: of the file; its extension decides where the content is ambiguous. */
model_kind model_kind_detect(const void *bytes, size_t size, const char *name);

/* Fails with the name of a format that facet does not read and the usual way to convert it:
 * FACET_ERROR_UNSUPPORTED; FACET_ERROR_INVALID of MODEL_UNKNOWN. */
facet_result model_kind_refuse(const void *bytes, size_t size, const char *name, facet_error *error);

#endif
