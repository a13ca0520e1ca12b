/* picture.c - see picture.h. */
#include "cli/render/picture.h"

#include "cli/shared/input.h"
#include "cli/shared/interrupt.h"

/* A cube map as a panorama with size columns. */
static facet_result load_cube(const char *path, uint32_t size, const render_options *o,
                              const facet_allocator *allocator, facet_image **image, facet_error *error)
{
    const facet_environment_desc desc = {.allocator = *allocator, .thread_count = o->limits.thread_count};
    facet_bake_desc bake = {.allocator = *allocator,
                            .thread_count = o->limits.thread_count,
                            .lobe = FACET_LOBE_NONE,
                            .size = 1,
                            .level_count = 1};
    while (bake.size < size / 2 && bake.size < 4096)
        bake.size *= 2;
    facet_environment *environment = NULL;
    facet_cube *cube = NULL;
    facet_result result = input_load_environment(path, &desc, &environment, error);
    if (result == FACET_OK)
        result = facet_cube_bake(environment, &bake, &cube, error);
    if (result == FACET_OK)
        result = facet_cube_unfold(cube, 0, FACET_LAYOUT_EQUIRECTANGULAR, size / 2 ? size / 2 : 1, allocator,
                                   image, error);
    facet_cube_destroy(cube);
    facet_environment_destroy(environment);
    return result;
}

facet_result picture_load(const char *path, const render_options *o, const facet_allocator *allocator,
                          facet_image **image, facet_error *error)
{
    const facet_image_load_desc load = {.allocator = *allocator, .thread_count = o->limits.thread_count};
    const uint32_t size = o->desc.width > o->desc.height ? o->desc.width : o->desc.height;
    const facet_thumbnail_desc thumbnail = {.allocator = *allocator,
                                            .thread_count = o->limits.thread_count,
                                            .size = size,
                                            .tonemap = o->desc.tonemap,
                                            .exposure_ev = o->desc.exposure_ev};
    facet_image *whole = NULL;
    *image = NULL;
    interrupt_begin_reading(input_name(path));
    facet_result result = input_load_image(path, &load, &whole, error);
    if (result == FACET_ERROR_UNSUPPORTED || result == FACET_ERROR_INVALID) {
        facet_error second;
        if (load_cube(path, size, o, allocator, &whole, &second) == FACET_OK)
            result = FACET_OK;
    }
    interrupt_end();
    if (result == FACET_OK)
        result = facet_image_create_thumbnail(whole, &thumbnail, image, error);
    facet_image_destroy(whole);
    return result;
}
