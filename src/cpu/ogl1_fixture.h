/* ogl1_fixture.h - scenes with legacy materials for tests, and OpenGL 1's shading of a quad in double,
 * written without shade/phong.h. */
#ifndef CPU_OGL1_FIXTURE_H
#define CPU_OGL1_FIXTURE_H

#include "cpu/preview_fixture.h"
#include "scene/legacy.h"

/* Gives the scene legacy materials at their defaults, as many as it may hold, and room for 8 lights. */
scene_legacy *ogl1_fixture_legacy(fixture *f);
/* One sample per pixel, without environment, FACET_SHADING_OGL1, perspective from (1.5, 1, 3) to the
 * origin. */
void ogl1_fixture_camera(fixture *f);

/* 8 x 8 pixels of 2 m, seen head on from afar, under a white light at the camera: N = V = L for surfaces
 * that face +Z. */
fixture ogl1_fixture_head_on(scene_legacy **legacy);

/* The fixture's quad with one material: everything that its color depends on, in the values that lighting
 * uses. */
typedef struct ogl1_quad {
    facet_ogl1_variant variant;
    facet_camera camera;
    uint32_t size; /* of the image, pixels */
    double ambient[3], diffuse[3], specular[3], emission[3], shininess;
    double normals[4][3]; /* unit, per vertex */
    double colors[4][3];  /* vertex colors; take part where has_colors */
    bool has_colors, is_flat, is_linear;
    uint32_t light_count;
    legacy_light lights[8];
    legacy_fog fog;
    double near_m, far_m, fog_w;
    double direction_w;
    double global_ambient;
} ogl1_quad;

/* Color at the center of pixel (x, y), clamped where is_linear is false; false: the quad is not there. */
bool ogl1_quad_color(const ogl1_quad *q, uint32_t x, uint32_t y, double rgb[3]);
/* Renders and compares every pixel: values to 2e-5, 8-bit codes exactly, except within 2e-5 of the
 * threshold between two codes. At least `least` pixels must show the quad. */
void ogl1_quad_check(fixture *f, const ogl1_quad *q, uint32_t least, const char *what);
/* The sRGB transfer function, in double. */
double ogl1_decode(double encoded);
double ogl1_encode(double linear);

#endif
