/* specular_glossiness.h - one surface from KHR_materials_pbrSpecularGlossiness to metallic-roughness and
 * back. */
#ifndef LEGACY_SPECULAR_GLOSSINESS_H
#define LEGACY_SPECULAR_GLOSSINESS_H

#include "legacy/fit.h"

/* Core glTF, whose dielectrics all have F0 = 0.04: loses specular colors. As in the sample code of the
 * extension (Khronos Group, convert-between-workflows), metallic solves
 *   d m^2 + (b_d (1 - max s) / (1 - d) + b_s - 2 d) m + d - b_s = 0,  d = 0.04, b: perceived brightness
 * and the base color mixes those of the diffuse and the specular color by m^2. */
void core_from_glossiness(const float diffuse[3], const float specular[3], float base_color[3],
                          float *metallic);

/* To diffuse and specular color:
 *   specular = lerp(F0 of the dielectric, base, m),  diffuse = (1 - m) base (1 - max F0) / (1 - max specular)
 * The quotient compensates that the base is weighted with 1 - max(F) of another F0; Schlick's (1 - w) is
 * common to both. Returns whether this is lossless: F90 is 1 (specular 1, or all metal) and the diffuse
 * color at most 1. */
bool glossiness_from_surface(const pbr_surface *in, float diffuse[3], float specular[3]);

/* The error of fit.h between two PBR surfaces, of which the first is the source. */
fit_error compare_pbr(const pbr_surface *source, const pbr_surface *other);

#endif
