/* refraction.h - what is seen through glass: rays through thin walls and through bodies, as the real geometry bends them.
 *
 * A surface that lets light through is shaded as any other, with the prefiltered environment for what it reflects; what
 * comes from behind it is followed by rays. The first surface splits into as many as the quality has it for roughness
 * and dispersion. Each then follows the way that carries most and, as long as its budget lasts, those that branch off by
 * internal reflection; what is left reads the environment, prefiltered for the lobe of directions that the ray stands
 * for. All shares add up to 1, so that in a constant environment glass has exactly its color.
 *
 * Rays that meet nothing see the environment, also where the image's background is transparent or a color: glass is
 * opaque in the image (glTF's alpha is coverage). Light sources without size are not seen through bodies by way of
 * rays; they shine on what is behind unshadowed. */
#ifndef CPU_REFRACTION_H
#define CPU_REFRACTION_H

#include "cpu/shading_scene.h"

struct surface_point;

/* Radiance (cd/m^2) of a surface with LAYER_TRANSMISSION, all of it: with what it reflects and emits. Returns the number
 * of rays. */
uint64_t refraction_shade(const shading_scene *scene, const shading_point *point,
                          const struct surface_point *s, float radiance[3]);

#endif
