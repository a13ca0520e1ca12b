/* method.h - what clients may ask for: the verbs of the command that make something from files, with the
 * options that a request may give. */
#ifndef CLI_SERVE_METHOD_H
#define CLI_SERVE_METHOD_H

#include "cli/shared/options.h"

/* Place of an option in a request. */
typedef enum parameter_use {
    PARAMETER_VALUE,       /* text, numbers, flags */
    PARAMETER_INPUT,       /* a file or folder that is read: below the root */
    PARAMETER_ENVIRONMENT, /* a file that is read, or words (environment_input.h) */
    PARAMETER_OUTPUT,      /* a file that is written */
    PARAMETER_REFUSED      /* the server decides about it, or it reads and keeps files at will */
} parameter_use;

typedef struct method {
    const verb *verb;       /* its name is the method's */
    const char *inputs[3];  /* members of params that stand for arguments; ends with NULL */
    const char *input_help; /* what they are */
    bool makes_file;        /* without an output in params the result holds what was made */
    bool takes_environment; /* the input is one */
} method;

extern const method methods[]; /* ends with {NULL} */
enum { METHOD_COUNT = 5 };
const method *method_find(const char *name); /* NULL: none */
size_t method_index(const method *m);

parameter_use parameter_use_of(const option *o);

#endif
