/* water_look.h - looks that are not physics: those of before (shade/water_before.h), and the steps from there to now. */
#ifndef WATER_WATER_LOOK_H
#define WATER_WATER_LOOK_H

#include "water/water_shade.h"

/* Stages of facet_sea_shading: 1 Schlick's formula with water's ior, 2 a microfacet highlight, 3 light of the sky and the sun in place of
 * constants, 4 refraction and absorption in place of a base color, 5 foam and glints: all of it. */

/* As linear numbers that a display's sRGB encoding takes to what the look had shown. */
vec3 water_look_sky(vec3 d);
vec3 water_look_shade(const water_setup *s, const water_place *p, vec3 d);

/* Stage 3: radiance (cd/m^2) of a surface that reflects and has a base color, in the light of the sky. */
vec3 water_look_painted(const water_setup *s, const water_place *p);

#endif
