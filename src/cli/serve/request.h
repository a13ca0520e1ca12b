/* request.h - what one request asks for, checked and turned into a job: parameters become words of the
 * command line, paths are checked against the root, limits are added. */
#ifndef CLI_SERVE_REQUEST_H
#define CLI_SERVE_REQUEST_H

#include "cli/jobs/job.h"
#include "cli/jobs/job_options.h"
#include "cli/serve/answer.h"
#include "cli/serve/folder.h"
#include "cli/serve/method.h"
#include "cli/serve/root.h"

/* What holds for all requests. */
typedef struct request_limits {
    root root;
    double time_limit_s;
    uint64_t max_memory_bytes; /* of a job */
    uint32_t max_texture_size; /* 0: the default */
    uint32_t max_threads;      /* of a job */
    uint64_t max_body_bytes;   /* of an input */
    folder folder;             /* made with the first request that needs one */
    uint64_t last_request;     /* number of the last request */
} request_limits;

enum { REQUEST_NAME_SIZE = 128, REQUEST_MAX_OUTPUT_BYTES = 256 << 20 };

typedef struct request {
    const method *method;
    job_words words;
    folder folder;                  /* "" where it needs none */
    unsigned char *input;           /* standard input; NULL: none */
    size_t input_size, held_bytes;  /* held_bytes: of all inputs that came with it */
    char name[REQUEST_NAME_SIZE];   /* of its input, for messages */
    char output[REQUEST_NAME_SIZE]; /* of the file that comes through the job's output; "": none */
    bool has_threads;               /* the words state them */
} request;

/* Bytes that come as the first input, besides the parameters: the body of a POST. bytes NULL: none. request_create()
 * takes them, for free(). */
typedef struct request_body {
    unsigned char *bytes;
    size_t size;
} request_body;

/* Reads the parameters: the inputs of the method (a path, or an object with base64 and perhaps name and files),
 * output, and options by their long names. params NULL: none. True: *out is for request_destroy(). */
bool request_create(request_limits *limits, const method *m, const json_t *params, request_body body,
                    request *out, answer *refusal);
void request_destroy(request *r); /* {0} is allowed */

/* Writes the word of an environment (environment_input.h, takes as there) to path: a file below the root with links
 * resolved, or the same words. False, with the reason in *refusal: it is none, or its files are outside or missing. */
bool request_find_environment(const root *r, const char *place, const char *text, unsigned takes,
                              char path[ROOT_PATH_SIZE], answer *refusal);

/* The job of a request, whose words stay with it. thread_count is added unless the request states it. */
job_request request_job(request *r, const request_limits *limits, uint32_t thread_count);

/* Turns the result of its job into an answer, with the files that it made. */
void request_finish(request *r, job_result *result, answer *out);

#endif
