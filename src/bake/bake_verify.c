/* bake_verify.c - how far a cube map is from the reference. */
#include "bake/bake.h"

#include "base/result.h"

facet_result facet_cube_verify(const facet_cube *c, facet_environment *environment,
                               const facet_bake_desc *desc, facet_cube_error *errors, facet_error *error)
{
    (void)c, (void)environment, (void)desc, (void)errors;
    return fail(error, FACET_ERROR_UNSUPPORTED, "bake: not there yet");
}
