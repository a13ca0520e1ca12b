/* facet/base.h - results, memory, messages, progress, version: what every other header needs. */
#ifndef FACET_BASE_H
#define FACET_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define FACET_API
#else
#define FACET_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- objects ----
 *
 * Opaque; each is created by a function that can fail and released by its _destroy function, which accepts NULL. */

typedef struct facet_budget facet_budget;
typedef struct facet_scene facet_scene;
typedef struct facet_environment facet_environment;
typedef struct facet_image facet_image;
typedef struct facet_renderer facet_renderer;
typedef struct facet_cube facet_cube;
typedef struct facet_sea facet_sea;

/* ---- results ---- */

typedef enum facet_result {
    FACET_OK = 0,
    FACET_ERROR_ARGUMENT,    /* an argument or a field of a desc is out of range or contradicts another */
    FACET_ERROR_READ,        /* an input cannot be read: it is missing, permission is denied, I/O fails */
    FACET_ERROR_INVALID,     /* an input was read and is not valid */
    FACET_ERROR_UNSUPPORTED, /* an input needs a feature that facet or this build lacks */
    FACET_ERROR_WRITE,       /* an output cannot be written */
    FACET_ERROR_LIMIT,       /* a limit that the caller set is exceeded: file size, texture size, time */
    FACET_ERROR_MEMORY,      /* out of memory, or over the limit of a facet_budget */
    FACET_ERROR_SYSTEM,      /* the machine lacks something: a display, a graphics driver, a library */
    FACET_ERROR_CANCELLED,   /* the progress callback asked to stop */
    FACET_ERROR_BUG          /* an internal check failed; please report it */
} facet_result;

/* One sentence that names the file, the place in it and what was expected. */
typedef struct facet_error {
    facet_result result;
    char message[1024]; /* UTF-8, ends with 0, without newline */
} facet_error;

/* ---- memory ---- */

/* The source of memory; {0}: malloc. allocate returns NULL when out of memory; release receives the size
 * that was requested. Both are called from several threads at once. */
typedef struct facet_allocator {
    void *user;
    void *(*allocate)(void *user, size_t size);
    void (*release)(void *user, void *memory, size_t size);
} facet_allocator;

/* A counting allocator with a limit (limit_bytes 0: none) that several calls share. Destroy it after
 * everything that was allocated from it is released. */
FACET_API facet_result facet_budget_create(uint64_t limit_bytes, facet_budget **budget, facet_error *error);
FACET_API void facet_budget_destroy(facet_budget *budget);
FACET_API facet_allocator facet_budget_allocator(facet_budget *budget);
FACET_API uint64_t facet_budget_used_bytes(const facet_budget *budget);
FACET_API uint64_t facet_budget_peak_bytes(const facet_budget *budget);

/* Releases text that the library returned. NULL is allowed. */
FACET_API void facet_text_destroy(char *text);

/* Releases bytes that the library returned. NULL is allowed. */
FACET_API void facet_bytes_destroy(unsigned char *bytes);

/* Writes bytes to a temporary file beside path and renames it: path is written whole or not at all. An empty regular file of
 * the user's is filled in place instead: a program may hold it open to read the result. */
FACET_API facet_result facet_bytes_save(const void *bytes, size_t size, const char *path, facet_error *error);

/* ---- messages and progress ---- */

/* Further levels may come. */
typedef enum facet_log_level {
    FACET_LOG_LEVEL_WARNING, /* something is lost or approximated, and the operation goes on */
    /* information: the graphics driver in use, harmless violations of a file format */
    FACET_LOG_LEVEL_DETAIL,
    FACET_LOG_LEVEL_HINT /* the result is as asked for; an option that is named may serve better */
} facet_log_level;

/* Message callback; {0}: silent. It may be called from any thread, one call at a time per operation. */
typedef struct facet_log {
    void *user;
    void (*message)(void *user, facet_log_level level, const char *text);
} facet_log;

/* Progress callback; it returns false to cancel the operation. {0}: none. stage is a static string,
 * fraction lies in [0, 1]. */
typedef struct facet_progress {
    void *user;
    bool (*report)(void *user, const char *stage, double fraction);
} facet_progress;

/* ---- version and machine ---- */

/* The semantic version of these headers, which is that of facet: the build reads it from here. */
#define FACET_VERSION_MAJOR 0
#define FACET_VERSION_MINOR 2
#define FACET_VERSION_PATCH 0

/* The number in the name libfacet.so.N, raised by every release that changes the layout of a struct, or removes or changes a
 * function. */
#define FACET_ABI_VERSION 0

/* "MAJOR.MINOR.PATCH" of the library that runs. */
FACET_API const char *facet_version(void);

/* Version, compiler, libraries with their versions, CPU and thread count, one line each. Writes at most
 * size bytes with the closing 0 and returns the length of the whole text. */
FACET_API size_t facet_build_report(char *text, size_t size);

/* A library that facet uses. */
typedef struct facet_library_info {
    const char *name;          /* "OpenEXR" */
    const char *license;       /* SPDX expression */
    const char *built_version; /* that facet was built with; "": this build does without the library */
    const char *file;       /* of a library that is opened when it is needed: "libavif.so.15"; NULL: linked */
    char found_version[64]; /* on this machine; "": missing */
} facet_library_info;

FACET_API uint32_t facet_get_library_count(void);
/* Opens a library that is opened when needed for the time of the call. */
FACET_API facet_library_info facet_get_library(uint32_t index);

/* The number of CPUs that this process may use under its affinity and cgroup quota; at least 1. */
FACET_API uint32_t facet_thread_count(void);

#ifdef __cplusplus
}
#endif

#endif
