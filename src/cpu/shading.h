/* shading.h - shading of a hit, and its description without light: as glTF or as OpenGL 1. */
#ifndef CPU_SHADING_H
#define CPU_SHADING_H

#include "cpu/shading_scene.h"

void shading_shade(const shading_scene *scene, const shading_point *point, shading_result *out);
void shading_describe(const shading_scene *scene, const shading_point *point, shading_description *out);

#endif
