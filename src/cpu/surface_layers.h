/* surface_layers.h - the layers of a film that describe the nearest surface. */
#ifndef CPU_SURFACE_LAYERS_H
#define CPU_SURFACE_LAYERS_H

#include "cpu/shading_scene.h"
#include "film/film.h"

struct scene_identity; /* scene/identity.h */

/* Those that a film has; NULL: not requested. */
typedef struct surface_layers {
    film_layer *depth, *normal, *albedo, *material, *object, *instance, *uv, *occlusion;
} surface_layers;

surface_layers surface_layers_find(film *f);
/* identity: NULL where no layer needs it. */
void surface_layers_store(const surface_layers *layers, size_t pixel, float depth_m,
                          const shading_description *surface, const struct scene_identity *identity);

#endif
