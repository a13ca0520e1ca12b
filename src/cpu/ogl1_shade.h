/* ogl1_shade.h - from a hit to the color that OpenGL 1 gives it: what shading.h has for glTF. */
#ifndef CPU_OGL1_SHADE_H
#define CPU_OGL1_SHADE_H

#include "cpu/shading_scene.h"

/* [0, 1]; 1 is opaque. */
float ogl1_opacity(const shading_scene *scene, const shading_point *point);
/* out->radiance: the display's encoded numbers in [0, 1], or linear light where the render's ogl1.is_linear. */
void ogl1_shade(const shading_scene *scene, const shading_point *point, shading_result *out);
void ogl1_describe(const shading_scene *scene, const shading_point *point, shading_description *out);
/* A composited pixel (premultiplied) as linear light: its color is what the display makes of its numbers. */
void ogl1_develop(const shading_scene *scene, float rgba[4]);

#endif
