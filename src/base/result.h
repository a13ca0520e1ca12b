/* result.h - how functions fail: a code and one sentence. */
#ifndef BASE_RESULT_H
#define BASE_RESULT_H

#include "facet/facet.h"

#undef fail /* the test framework has a macro of that name; tests use fail_msg() */

/* Writes the sentence to error (NULL: not wanted) and returns result, so that a caller can write
 *     return fail(error, FACET_ERROR_INVALID, "%s: accessor %u: ...", name, i); */
facet_result fail(facet_error *error, facet_result result, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* fail() for a failed allocation: "out of memory: WHAT (SIZE bytes)", without the bytes where size is 0
 * (unknown). */
facet_result fail_memory(facet_error *error, const char *what, size_t size);

/* Returns from the calling function with call's result unless that is FACET_OK. For functions of type
 * facet_result that have nothing to release at that point; the others use goto done. */
#define TRY(call)                                                                                            \
    do {                                                                                                     \
        facet_result try_result = (call);                                                                    \
        if (try_result != FACET_OK)                                                                          \
            return try_result;                                                                               \
    } while (0)

/* Sends one formatted message to log, if there is one. Control characters become '?'. */
void log_message(const facet_log *log, facet_log_level level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* log_message() of FACET_LOG_LEVEL_WARNING. */
void log_warning(const facet_log *log, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
