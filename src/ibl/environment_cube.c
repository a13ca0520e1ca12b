/* environment_cube.c - environments that are read from cube maps, and what an environment says of itself. */
#include "ibl/environment.h"

#include "base/result.h"

facet_result facet_environment_load_faces(const char *const paths[6], const facet_environment_desc *desc,
                                          facet_environment **environment, facet_error *error)
{
    (void)paths, (void)desc;
    *environment = NULL;
    return fail(error, FACET_ERROR_UNSUPPORTED, "faces: not there yet");
}

facet_result facet_environment_get_info(const facet_environment *environment, facet_environment_info *info,
                                        facet_error *error)
{
    (void)environment, (void)info;
    return fail(error, FACET_ERROR_UNSUPPORTED, "information: not there yet");
}
