/* bake_sh.c - an environment as nine spherical harmonics. */
#include "bake/bake.h"

#include "base/result.h"

facet_result facet_environment_project_sh(const facet_environment *environment, const facet_sh_desc *desc,
                                          float coefficients[9][3], facet_error *error)
{
    (void)environment, (void)desc, (void)coefficients;
    return fail(error, FACET_ERROR_UNSUPPORTED, "bake: not there yet");
}
