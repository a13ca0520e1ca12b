/* image_layer.h - an image's layer by name, for tests of the public headers. */
#ifndef API_IMAGE_LAYER_H
#define API_IMAGE_LAYER_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "facet/facet.h"

/* The layer's pixels; fails the test if there is no such layer, or if its channel_count differs. */
static inline const float *layer_of(const facet_image *image, const char *name, uint32_t channel_count)
{
    for (uint32_t i = 0; i < facet_image_get_layer_count(image); i++) {
        facet_image_view view = facet_image_get_layer(image, i);
        if (strcmp(view.name, name) == 0) {
            assert_int_equal(view.channel_count, channel_count);
            return view.pixels;
        }
    }
    fail_msg("there is no layer %s", name);
    return NULL;
}

#endif
