/* sky.c - clear skies as environments. */
#include "ibl/environment.h"

#include "base/result.h"

facet_result facet_environment_create_sky(const facet_sky_desc *sky, const facet_environment_desc *desc,
                                          facet_environment **environment, facet_error *error)
{
    (void)sky, (void)desc;
    *environment = NULL;
    return fail(error, FACET_ERROR_UNSUPPORTED, "sky: not there yet");
}

facet_result facet_environment_create_gradient(const float zenith[3], const float horizon[3],
                                               const float nadir[3], const facet_environment_desc *desc,
                                               facet_environment **environment, facet_error *error)
{
    (void)zenith, (void)horizon, (void)nadir, (void)desc;
    *environment = NULL;
    return fail(error, FACET_ERROR_UNSUPPORTED, "gradient: not there yet");
}
