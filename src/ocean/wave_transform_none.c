/* wave_transform_none.c - in place of wave_transform_kiss.c where there is no kissfft. */
#include "ocean/wave_transform.h"

#include "base/result.h"

#ifdef __EMSCRIPTEN__
static const char reason[] = "the command in WebAssembly has none; the page ocean.html draws it";
#else
static const char reason[] = "this facet was built without kissfft (Debian: libkissfft-dev)";
#endif

facet_result wave_transform_create(const waves *w, wave_transform **out, facet_error *error)
{
    (void)w;
    *out = NULL;
    return fail(error, FACET_ERROR_UNSUPPORTED, "a sea with waves: %s", reason);
}

void wave_transform_destroy(wave_transform *t)
{
    (void)t;
}

void wave_transform_run(wave_transform *t, waves *w)
{
    (void)t;
    (void)w;
}

void wave_transform_pair(const wave_transform *t, const waves *w, const wave_pair *p)
{
    (void)t;
    (void)w;
    (void)p;
}
