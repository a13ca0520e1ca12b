/* plot_vignette.h - the computation of Murdoch's vignette "Shininess in OpenGL 1 versus glTF PBR" in
 * double precision: PBR and OpenGL 1 in the plane of incidence. Its PBR has the separable masking of the
 * glTF text before 2026, and max(x, 0) where that has a step, which shade/ does not have; with the step it
 * equals shade/ (plot_vignette_test.c). */
#ifndef PLOT_PLOT_VIGNETTE_H
#define PLOT_PLOT_VIGNETTE_H

#include <stdbool.h>

/* BRDF times N.L in 1/sr of one channel: eye at theta, light at phi, rad, in one plane. roughness is
 * perceptual. */
double vignette_pbr(double theta, double phi, double roughness, double metallic, double base, bool has_ramp);
/* max(N.L, 0) diffuse + max(N.H, 0)^shininess specular. */
double vignette_ogl1(double theta, double phi, double shininess, double diffuse, double specular);

enum { VIGNETTE_POINTS = 33 };
double vignette_phi(int point); /* -80 to 80 degrees in steps of 5, as rad */

typedef struct vignette_parameters {
    double shininess, diffuse, specular;
    double error; /* relative root mean square over the points */
} vignette_parameters;

/* RMS of OpenGL 1 minus target over that of target, at the points of the vignette. */
double vignette_error(double theta, const double target[VIGNETTE_POINTS], double shininess, double diffuse,
                      double specular);
/* The parameters within the ranges of OpenGL (shininess to 128, colors to 1) with the smallest error: a
 * search for the shininess, with linear least squares for the colors. */
vignette_parameters vignette_fit(double theta, const double target[VIGNETTE_POINTS]);

#endif
