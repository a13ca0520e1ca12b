/* ogl1_shade.h - shading of a hit by OpenGL 1: the counterpart of shading.h for glTF. */
#ifndef CPU_OGL1_SHADE_H
#define CPU_OGL1_SHADE_H

#include "cpu/shading_scene.h"

/* [0, 1]; 1 is opaque. */
float ogl1_opacity(const shading_scene *scene, const shading_point *point);
/* out->radiance: display-encoded values in [0, 1], or linear light where the render's ogl1.is_linear. */
void ogl1_shade(const shading_scene *scene, const shading_point *point, shading_result *out);
void ogl1_describe(const shading_scene *scene, const shading_point *point, shading_description *out);
/* Converts a composited pixel (premultiplied) to linear light, by the display's transfer function. */
void ogl1_develop(const shading_scene *scene, float rgba[4]);

#endif
