/* library.h - shared libraries that are opened when they are needed, and their functions. */
#ifndef BASE_LIBRARY_H
#define BASE_LIBRARY_H

#include "facet/facet.h"

/* A function of a library and where its address goes. */
typedef struct library_symbol {
    const char *name;
    void *pointer; /* to the function pointer */
} library_symbol;

/* For lists of functions as F(STRUCT, SYMBOL, MEMBER): members of a struct, and the symbols that fill it.
 * The library's own header has the types. */
#define LIBRARY_MEMBER(out, symbol, member) __typeof__(symbol) *member;
#define LIBRARY_SYMBOL(out, symbol, member) {#symbol, &(out)->member},

/* How a library is opened, and the messages: "SUBJECT: NAMEADVICE" where it is missing, "SUBJECT: NAME has
 * no SYMBOLVERSION" where it lacks a function. */
typedef struct library_desc {
    const char *subject;  /* what needs it: "plot", "a.avif: AVIF" */
    const char *advice;   /* " is not installed; ..": what the user can do */
    const char *version;  /* "; X 1.2 or later was expected"; NULL: nothing */
    facet_result missing; /* the result where the library or a function is missing */
    bool stays;           /* never unloaded: the library, or one that it opens, does not support that */
    const library_symbol *symbols;
    size_t symbol_count;
} library_desc;

/* Opens the library name as *handle, for dlclose(), and finds its symbols. Fails with desc->missing, with
 * FACET_ERROR_MEMORY where there is no memory for it or for the libraries that it needs, and with
 * FACET_ERROR_SYSTEM and the reason where it is installed but cannot be opened. Where a symbol is missing,
 * *handle is open and remains the caller's to close. */
facet_result library_open(const char *name, const library_desc *desc, void **handle, facet_error *error);

/* Writes the version of the library name to version: text that its function returns. "": the library is not installed;
 * "unknown": it has no such function. */
void library_find_version(const char *name, const char *function, char *version, size_t size);

#endif
