/* view_load.h - reads models and environments on a thread of its own, so that the window stays responsive. */
#ifndef VIEW_VIEW_LOAD_H
#define VIEW_VIEW_LOAD_H

#include "gl/gl_entry.h"

/* What to read. Names are copied. */
typedef struct view_request {
    bool wants_model;
    const char *path; /* NULL: the built-in scene */
    bool wants_environment;
    const char *environment; /* NULL: the first one, or the model's own */
    /* The environment is read for this model, where the request names none to read: it may have its own
     * light. */
    const facet_view_model *model;
} view_request;

/* The result; the caller owns it. */
typedef struct view_loaded {
    bool has_model, has_environment; /* were read */
    facet_view_model model;
    float low[3], high[3]; /* bounds of the model */
    facet_environment *environment;
    char *path, *environment_name; /* as in the request; blocks of malloc() */
    bool wanted_model, wanted_environment;
    facet_error error; /* result FACET_OK: everything was read */
} view_loaded;

typedef struct view_loader view_loader;

/* wake is called from the loader's thread when a result is ready. desc and host must outlive it.
 * FACET_ERROR_MEMORY. */
facet_result view_load_create(const gl_host *host, const facet_view_desc *desc, void (*wake)(void *user),
                              void *user, view_loader **out, facet_error *error);
void view_load_destroy(view_loader *l); /* NULL is allowed; waits for the current request */
/* Replaces a request that has not begun. False: out of memory. */
bool view_load_request(view_loader *l, const view_request *request);
bool view_load_is_busy(view_loader *l); /* also while a result waits to be taken */
bool view_load_take(view_loader *l, view_loaded *out);
void view_loaded_destroy(const gl_host *host, view_loaded *loaded);

#endif
