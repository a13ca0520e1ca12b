/* bake_dfg.c - tables of reflectance over view and roughness. */
#include "bake/bake.h"

#include "base/result.h"

uint32_t facet_dfg_get_channel_count(facet_dfg_kind kind)
{
    static const uint32_t counts[] = {2, 2, 2, 1, 1, 1, 3};
    return counts[kind];
}

facet_result bake_dfg(const facet_dfg_desc *desc, image *out, facet_error *error)
{
    (void)desc, (void)out;
    return fail(error, FACET_ERROR_UNSUPPORTED, "bake: not there yet");
}
