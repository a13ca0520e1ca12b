/* film_channels.h - the layers of a film as channels of an OpenEXR file. */
#ifndef FILM_FILM_CHANNELS_H
#define FILM_FILM_CHANNELS_H

#include "film/film.h"
#include "image/image.h"

/* For writing. width: of the film. */
static inline image_layer film_layer_to_image(const film_layer *layer, uint32_t width)
{
    return (image_layer){.channel_names = layer->channel_names,
                         .channel_count = layer->channel_count,
                         .pixels = layer->pixels,
                         .row_stride_bytes = (size_t)width * layer->channel_count * sizeof(float),
                         .needs_float = layer->needs_float,
                         .is_integer = layer->is_integer};
}

/* For reading. Returns the number of channels. */
static inline uint32_t film_layer_list_channels(const film_layer *layer, uint32_t width,
                                                image_channel *channels)
{
    for (uint32_t c = 0; c < layer->channel_count; c++)
        channels[c] =
            (image_channel){.name = layer->channel_names[c],
                            .first = layer->pixels + c,
                            .is_integer = layer->is_integer,
                            .texel_stride_bytes = layer->channel_count * sizeof(float),
                            .row_stride_bytes = (size_t)width * layer->channel_count * sizeof(float)};
    return layer->channel_count;
}

#endif
