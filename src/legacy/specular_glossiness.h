/* specular_glossiness.h - one surface from KHR_materials_pbrSpecularGlossiness to metallic-roughness and back. */
#ifndef LEGACY_SPECULAR_GLOSSINESS_H
#define LEGACY_SPECULAR_GLOSSINESS_H

#include "legacy/fit.h"

/* To the core of glTF, whose dielectrics all reflect 0.04: loses specular colors. The sample code of the extension
 * (Khronos Group, convert-between-workflows): metallic solves
 *   d m^2 + (b_d (1 - max s) / (1 - d) + b_s - 2 d) m + d - b_s = 0,  d = 0.04, b: perceived brightness
 * and the base color is mixed by m^2 of what the diffuse and what the specular color ask for. */
void core_from_glossiness(const float diffuse[3], const float specular[3], float base_color[3],
                          float *metallic);

/* To diffuse and specular color:
 *   specular = lerp(F0 of the dielectric, base, m),  diffuse = (1 - m) base (1 - max F0) / (1 - max specular)
 * The quotient makes up for the base being weighted with 1 - max(F) of another F0; Schlick's (1 - w) is common to both.
 * Returns whether nothing is lost: F90 is 1 (specular 1, or all metal) and the diffuse color at most 1. */
bool glossiness_from_surface(const pbr_surface *in, float diffuse[3], float specular[3]);

/* The error of fit.h, section "metric", between two surfaces of glTF: the first is the source. */
fit_error compare_pbr(const pbr_surface *source, const pbr_surface *other);

#endif
