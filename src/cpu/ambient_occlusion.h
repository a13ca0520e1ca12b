/* ambient_occlusion.h - the share of the environment's diffuse light that reaches a surface past the model, for the
 * preview: FACET_AMBIENT_OCCLUSION_ON.
 *
 * The openness of a point is the cosine-weighted share of its hemisphere in which no surface blocks rays, however far
 * away. Glass lets light pass. Surfaces around reflect: see ambient_interreflection() of shade/ibl.h. The occlusion of
 * a texture and this one describe the same, so that the darker of both counts. */
#ifndef CPU_AMBIENT_OCCLUSION_H
#define CPU_AMBIENT_OCCLUSION_H

#include "cpu/raster.h"
#include "cpu/surface_point.h"
#include "draw/render_watch.h"

typedef struct ambient_desc {
    const shading_scene *scene;
    const raster *raster; /* finds the first hits; NULL: they are traced */
    uint32_t width, height, thread_count;
    uint32_t crop[4]; /* x, y, width, height of the pixels that are shaded */
    const facet_allocator *allocator;
    render_watch *watch;
} ambient_desc;

/* The openness of the first hits of an image. */
typedef struct ambient_image ambient_image;

/* Traces the rays, and filters. A pixel's value depends neither on the crop nor on the threads. Ends early where the watch
 * stops. Adds to *rays. NULL: no memory. */
ambient_image *ambient_image_create(const ambient_desc *desc, uint64_t *rays);
void ambient_image_destroy(ambient_image *image); /* NULL is allowed */

/* The factor of the environment's diffuse light at a surface in a pixel of the crop, before the occlusion of its texture. Traces
 * rays where no pixel near by has a point of the same surface; adds to *rays. */
vec3 ambient_factor(const ambient_image *image, const shading_point *point, const surface_point *s,
                    uint64_t *rays);

#endif
