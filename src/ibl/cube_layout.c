/* cube_layout.c - see cube_layout.h. */
#include "ibl/cube_layout.h"

#include "base/result.h"

facet_layout layout_detect(uint32_t width, uint32_t height)
{
    return width == 2 * (uint64_t)height ? FACET_LAYOUT_EQUIRECTANGULAR : FACET_LAYOUT_AUTO;
}

facet_result layout_read(const image *picture, facet_layout layout, const char *name,
                         const facet_allocator *allocator, uint32_t thread_count, cube *out,
                         facet_error *error)
{
    (void)picture, (void)layout, (void)allocator, (void)thread_count, (void)out;
    return fail(error, FACET_ERROR_UNSUPPORTED, "%s: not there yet", name);
}

facet_result layout_write(const cube *c, facet_layout layout, uint32_t height,
                          const facet_allocator *allocator, uint32_t thread_count, image *out,
                          facet_error *error)
{
    (void)c, (void)layout, (void)height, (void)allocator, (void)thread_count, (void)out;
    return fail(error, FACET_ERROR_UNSUPPORTED, "bake: not there yet");
}
