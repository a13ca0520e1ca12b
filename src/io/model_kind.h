/* model_kind.h - what kind of model file bytes are, by their content and, where that says nothing, by the name. */
#ifndef IO_MODEL_KIND_H
#define IO_MODEL_KIND_H

#include "facet/facet.h"

typedef enum model_kind {
    MODEL_UNKNOWN,
    MODEL_GLTF,
    MODEL_OBJ,
    MODEL_PARAMETERS, /* rgl's */
    MODEL_STL,
    MODEL_PLY,
    MODEL_FOREIGN /* model_kind_refuse() says what it is */
} model_kind;

/* name: of the file, whose extension counts where the content says nothing. */
model_kind model_kind_detect(const void *bytes, size_t size, const char *name);

/* Fails with what a file is that facet does not read, and with the usual way to one that it reads: FACET_ERROR_UNSUPPORTED;
 * FACET_ERROR_INVALID of MODEL_UNKNOWN. */
facet_result model_kind_refuse(const void *bytes, size_t size, const char *name, facet_error *error);

#endif
