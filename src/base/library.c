/* library.c - see library.h. */
#include "base/library.h"

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

#include "base/result.h"

/* Whether a message of dlerror() reports a lack of memory; glibc has no code for that. */
static bool is_about_memory(const char *reason)
{
    static const char *const words[] = {"llocate", "failed to map segment", "out of memory"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strstr(reason, words[i]))
            return true;
    return false;
}

static facet_result find_symbols(const char *name, const library_desc *desc, void *handle, facet_error *error)
{
    for (size_t i = 0; i < desc->symbol_count; i++) {
        void *address = dlsym(handle, desc->symbols[i].name);
        if (!address)
            return fail(error, desc->missing, "%s: %s has no %s%s", desc->subject, name,
                        desc->symbols[i].name, desc->version ? desc->version : "");
        memcpy(desc->symbols[i].pointer, &address, sizeof address);
    }
    return FACET_OK;
}

facet_result library_open(const char *name, const library_desc *desc, void **handle, facet_error *error)
{
    *handle = dlopen(name, RTLD_NOW | RTLD_LOCAL | (desc->stays ? RTLD_NODELETE : 0));
    if (*handle)
        return find_symbols(name, desc, *handle, error);
    const char *reason = dlerror();
    reason = reason ? reason : "";
    if (is_about_memory(reason))
        return fail(error, FACET_ERROR_MEMORY, "%s: out of memory: opening %s", desc->subject, name);
    /* "libX.so.2: cannot open shared object file: No such file or directory": this library, not one of its
     * dependencies */
    bool is_missing = strncmp(reason, name, strlen(name)) == 0 && strstr(reason, "No such file");
    if (is_missing)
        return fail(error, desc->missing, "%s: %s%s", desc->subject, name, desc->advice);
    return fail(error, FACET_ERROR_SYSTEM, "%s: %s cannot be opened: %.400s", desc->subject, name, reason);
}

void library_find_version(const char *name, const char *function, char *version, size_t size)
{
    /* it stays loaded: libraries such as GnuTLS do not support unloading */
    void *handle = dlopen(name, RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE);
    const char *(*get)(void) = NULL;
    void *address = handle ? dlsym(handle, function) : NULL;
    memcpy(&get, &address, sizeof get);
    snprintf(version, size, "%s", get ? get() : handle ? "unknown" : "");
    if (handle)
        dlclose(handle);
}
