/* studio_harmonics_none.c - studio_harmonics.c for browsers, where bytes to download cost more than the
 * milliseconds of the analysis. */
#include "ibl/studio_draw.h"

facet_result studio_harmonics(const image *panorama, const facet_allocator *allocator, uint32_t thread_count,
                              harmonics *out, facet_error *error)
{
    return harmonics_create(panorama, STUDIO_DEGREE, allocator, thread_count, out, error);
}
