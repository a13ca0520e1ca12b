/* plot_vignette.h - the experiment of Murdoch's vignette "Shininess in OpenGL 1 versus glTF PBR" as it is programmed
 * there, in double precision: PBR and OpenGL 1 in the plane of incidence. Its PBR has the separable masking of glTF's text
 * before 2026, and max(x, 0) where that has a step, which shade does not have; with the step it is shade's
 * (plot_vignette_test.c). */
#ifndef PLOT_PLOT_VIGNETTE_H
#define PLOT_PLOT_VIGNETTE_H

#include <stdbool.h>

/* BRDF times N.L in 1/sr of one channel: eye at theta, light at phi, rad, in one plane. roughness is perceptual. */
double vignette_pbr(double theta, double phi, double roughness, double metallic, double base, bool has_ramp);
/* max(N.L, 0) diffuse + max(N.H, 0)^shininess specular. */
double vignette_ogl1(double theta, double phi, double shininess, double diffuse, double specular);

enum { VIGNETTE_POINTS = 33 };
double vignette_phi(int point); /* -80 to 80 degrees in steps of 5, as rad */

typedef struct vignette_parameters {
    double shininess, diffuse, specular;
    double error; /* relative root mean square over the points */
} vignette_parameters;

/* Root mean square of OpenGL 1 less target over that of target, at the vignette's points. */
double vignette_error(double theta, const double target[VIGNETTE_POINTS], double shininess, double diffuse,
                      double specular);
/* The parameters within OpenGL's ranges (shininess to 128, colors to 1) with the smallest error: the colors, on which
 * the model depends linearly, are solved for at each shininess, which is searched for. */
vignette_parameters vignette_fit(double theta, const double target[VIGNETTE_POINTS]);

#endif
