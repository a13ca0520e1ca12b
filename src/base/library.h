/* library.h - shared libraries that are opened when they are needed. */
#ifndef BASE_LIBRARY_H
#define BASE_LIBRARY_H

#include "facet/facet.h"

/* How a library is opened, and what is said where it is missing: "SUBJECT: NAMEADVICE". */
typedef struct library_desc {
    const char *subject;  /* what needs it: "plot", "a.avif: AVIF" */
    const char *advice;   /* " is not installed; ..": what the user can do */
    facet_result missing; /* the result where there is no such library */
    bool stays;           /* it is never unloaded: it, or what it opens, does not bear that */
} library_desc;

/* Opens the library name as *handle, for dlsym() and dlclose(). Fails with desc->missing, with FACET_ERROR_MEMORY where
 * there is no memory for it or for the libraries that it needs, and with FACET_ERROR_SYSTEM and the reason where it
 * is there but cannot be opened. */
facet_result library_open(const char *name, const library_desc *desc, void **handle, facet_error *error);

#endif
