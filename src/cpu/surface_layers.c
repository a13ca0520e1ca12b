/* surface_layers.c - see surface_layers.h. */
#include "cpu/surface_layers.h"

#include <string.h>

#include "scene/identity.h"

surface_layers surface_layers_find(film *f)
{
    return (surface_layers){film_find(f, "depth"),    film_find(f, "normal"),   film_find(f, "albedo"),
                            film_find(f, "material"), film_find(f, "object"),   film_find(f, "instance"),
                            film_find(f, "uv"),       film_find(f, "occlusion")};
}

static void store(const film_layer *layer, size_t pixel, const float *values)
{
    if (layer)
        memcpy(layer->pixels + pixel * layer->channel_count, values, layer->channel_count * sizeof(float));
}

void surface_layers_store(const surface_layers *layers, size_t pixel, float depth_m,
                          const shading_description *surface, const scene_identity *identity)
{
    store(layers->depth, pixel, &depth_m);
    store(layers->normal, pixel, surface->normal);
    store(layers->albedo, pixel, surface->base_color);
    store(layers->uv, pixel, surface->uv);
    store(layers->occlusion, pixel, &surface->occlusion);
    if (!identity)
        return;
    store(layers->material, pixel, &identity->numbers[SCENE_IDENTITY_MATERIAL]);
    store(layers->object, pixel, &identity->numbers[SCENE_IDENTITY_OBJECT]);
    store(layers->instance, pixel, &identity->numbers[SCENE_IDENTITY_INSTANCE]);
}
