/* answer.h - how a request ended, and what that is called in each protocol. */
#ifndef CLI_SERVE_ANSWER_H
#define CLI_SERVE_ANSWER_H

#include "base/result.h"

#include <jansson.h>

typedef enum answer_kind {
    ANSWER_DONE,
    ANSWER_USAGE,       /* a parameter is wrong or missing */
    ANSWER_NO_METHOD,   /* there is no such method or page */
    ANSWER_WRONG_VERB,  /* HTTP: another method than those of the page */
    ANSWER_FORBIDDEN,   /* a path leads out of the root; HTTP: another host is meant */
    ANSWER_MISSING,     /* an input cannot be read */
    ANSWER_INVALID,     /* an input is not valid */
    ANSWER_UNSUPPORTED, /* an input needs a feature that facet lacks */
    ANSWER_UNWRITABLE,
    ANSWER_TOO_LARGE, /* a limit of size or memory */
    ANSWER_TIMED_OUT,
    ANSWER_ENVIRONMENT, /* the machine lacks something */
    ANSWER_BUG,         /* the job crashed */
    ANSWER_BUSY,        /* the queue is full */
    ANSWER_STOPPING,    /* the server ends */
    ANSWER_CANCELLED,
    ANSWER_KIND_COUNT
} answer_kind;

typedef struct answer_code {
    int exit_code; /* of the command */
    int rpc_code;  /* of an error of JSON-RPC; 0: none */
    int http_status;
    const char *word;
} answer_code;
extern const answer_code answer_codes[ANSWER_KIND_COUNT];

/* The kind of a failure of the command; timed_out tells the two limits apart. */
answer_kind answer_kind_of(int exit_code, bool timed_out);

/* A file that a request made. */
typedef struct answer_file {
    char *name; /* "image.png" */
    unsigned char *bytes;
    size_t size;
} answer_file;

typedef struct answer {
    answer_kind kind;
    int exit_code;      /* as of the command; 1 with ANSWER_DONE: the result is negative */
    char message[1024]; /* one sentence, unless kind is ANSWER_DONE */
    json_t *report;     /* the object of --json; NULL: none */
    answer_file *files;
    size_t file_count;
    double seconds; /* of the job */
} answer;

/* Writes a failure to *out, which is {0}, and returns false. */
bool answer_fail(answer *out, answer_kind kind, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void answer_destroy(answer *out); /* {0} is allowed */

/* The media type of a file by its name: "image/png". */
const char *media_type_of(const char *name);

#endif
