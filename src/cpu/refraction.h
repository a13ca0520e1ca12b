/* refraction.h - transmission in the preview: rays through thin walls and closed volumes, refracted by the
 * actual geometry.
 *
 * A transmissive surface is shaded as any other, with the prefiltered environment for its reflection; rays
 * find the radiance behind it. The first surface splits into as many rays as the quality has for roughness
 * and dispersion. Each then follows the strongest branch and, as long as its budget lasts, those of internal
 * reflections; the rest reads the environment, prefiltered for the lobe that the ray represents. All shares
 * add up to 1, so that in a constant environment glass has exactly its color.
 *
 * Rays without a hit that were only refracted see the background of the image: where that is transparent or a color,
 * glass lacks opacity. Others see the environment. Delta lights are not visible through volumes;
 * they light what is behind unshadowed. */
#ifndef CPU_REFRACTION_H
#define CPU_REFRACTION_H

#include "cpu/shading_scene.h"

struct surface_point;

/* Radiance (cd/m^2) of a surface with LAYER_TRANSMISSION, with reflection and emission; sets all of out but the
 * opacity. */
void refraction_shade(const shading_scene *scene, const shading_point *point, const struct surface_point *s,
                      shading_result *out);

#endif
