/* specular_aa.h - antialiasing of highlights on curved or bumpy surfaces. */
#ifndef SHADE_SPECULAR_AA_H
#define SHADE_SPECULAR_AA_H

/* GGX width that includes the normals within a pixel: their variance, from the difference of the unit
 * normal to the next pixel right and down, is added to alpha^2:
 *   alpha'^2 = min(alpha^2 + min(2 s^2 (|dN/dx|^2 + |dN/dy|^2), 0.18), 1),  s = 1/2 pixel
 * Kaplanyan et al. 2016; Tokuyoshi and Kaplanyan 2019, "Improved Geometric Specular Antialiasing". Not for
 * renderers that integrate over the pixel. */
FN float alpha_specular_aa(float alpha, vec3 dN_dx, vec3 dN_dy)
{
    float kernel = min(0.5f * (dot(dN_dx, dN_dx) + dot(dN_dy, dN_dy)), 0.18f);
    return sqrt(min(alpha * alpha + kernel, 1.0f));
}

#endif
