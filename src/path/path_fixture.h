/* path_fixture.h - scenes whose light is known in closed form, and means of images with the error that they
 * have: for the tests that prove that the path tracer's images may be called ground truth. Built on
 * preview_fixture.h.
 *
 * World: +Y up, floors and slabs lie in planes of constant y, lengths in m. Functions abort the test
 * where they fail. */
#ifndef PATH_FIXTURE_H
#define PATH_FIXTURE_H

#include "cpu/preview_fixture.h"

/* ---- scenes ---- */

/* Path tracing, conserving, box filter, one thread, no environment, the environment as background; 4 x 4
 * pixels, 64 samples, paths of 64 events. */
fixture truth_create(void);
/* Radiance c from everywhere. */
void truth_set_constant_sky(fixture *f, float r, float g, float b);
/* Radiance as a function of the unit direction d, at the middles of rows x 2 rows texels. */
typedef void truth_sky(const double d[3], float rgb[3]);
void truth_set_sky(fixture *f, uint32_t rows, truth_sky *sky);
/* Red from above the horizon, green from below, blue from everywhere: reflection and transmission of a
 * slab, and both. */
void truth_sky_halves(const double d[3], float rgb[3]);

/* Materials: white, specular 0, so that diffuse reflection is all there is; metal of a color; clear glass,
 * a volume. */
scene_material truth_lambert(float albedo);
scene_material truth_metal(float r, float g, float b, float roughness);
scene_material truth_glass(float ior, float roughness);
/* Black but for its light. */
scene_material truth_emitter(float radiance);

/* A parallelogram with corners c - u - v, c + u - v, c - u + v, c + u + v; it faces u x v. Texture
 * coordinates: (0, 0) to (1, 1) along u and v. Number of the new mesh, already placed, as for all that
 * follow. */
uint32_t truth_add_panel(fixture *f, uint32_t material, const float c[3], const float u[3], const float v[3]);
/* A square of half size s in the plane of height y that faces up. */
uint32_t truth_add_floor(fixture *f, uint32_t material, float y, float s);
/* The same, facing down. */
uint32_t truth_add_ceiling(fixture *f, uint32_t material, float y, float s);
/* A box around (0, y, 0) with flat sides; a negative half size turns it inside out: a room. */
uint32_t truth_add_box(fixture *f, uint32_t material, float y, float half_x, float half_y, float half_z);
/* A sphere of flat triangles, as closed as its surface is: normals and geometry agree. */
uint32_t truth_add_flat_sphere(fixture *f, uint32_t material, uint32_t columns, float y, float radius);

/* An orthographic camera that sees `height` m around the point (x, y, 0) from 10 m away, from the
 * direction at `polar` degrees from +Y, towards +X. */
void truth_set_camera(fixture *f, double polar_deg, float x, float y, float height);

/* ---- images ---- */

film truth_render(fixture *f, facet_render_stats *stats /* NULL: not wanted */);
facet_result truth_try_render(fixture *f, film *out, facet_render_stats *stats, facet_error *error);

/* A mean per channel (r, g, b, opacity), and its standard error from `count` independent values. */
typedef struct truth_value {
    double mean[4], error[4];
    uint32_t count;
} truth_value;

/* One image whose pixels all estimate the same number. */
truth_value truth_measure_pixels(fixture *f);
/* Pictures of seeds 1 to `count`; the mean of each over all its pixels is a value. */
truth_value truth_measure(fixture *f, uint32_t count);

/* Float paths multiply a few dozen rounded numbers, and float images have 24 bits: relative errors below
 * this are rounding. */
#define TRUTH_ROUNDING 2e-5
/* By how many standard errors a mean may be off. With 16 values (Student's t, 15 degrees of freedom)
 * chance exceeds it once in 1500 comparisons; seeds are fixed, so results repeat. */
#define TRUTH_SIGMAS 4.0

/* Fails unless the mean of channel is reference. format: its name in the message. */
void truth_assert_channel(const truth_value *v, int channel, double reference, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/* Unless r, g and b all are. */
void truth_assert_grey(const truth_value *v, double reference, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Unless no channel exceeds bound by more than three standard errors. */
void truth_assert_at_most(const truth_value *v, double bound, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Unless a - b is 0 within `sigmas` standard errors of the difference. */
void truth_assert_same(const truth_value *a, const truth_value *b, double sigmas, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* ---- the white furnace ---- */

/* Lobes with energy compensation read their albedo from tables, which are off by up to this:
 * layers_furnace_test.c has the same number. */
#define TRUTH_TABLES 2e-3

/* Radiance of a double-sided floor of the material towards `polar` degrees, in an environment of radiance
 * 1 above and below: 4096 samples a pixel. */
truth_value truth_furnace(scene_material material, double polar, facet_energy energy);
/* The same of a closed volume, a slab of 1 m, conserving. */
truth_value truth_furnace_volume(scene_material material, double polar);
/* Fails unless all of it is 1, within tables and four standard errors. */
void truth_assert_white(truth_value v, double tables, const char *what, double roughness, double polar);

/* ---- references, in double ---- */

#define TRUTH_PI 3.14159265358979323846
static inline double truth_radians(double degrees)
{
    return degrees * (TRUTH_PI / 180.0);
}
/* Fresnel's equations for unpolarised light; n: index beyond over index before. Total reflection: 1. */
double truth_fresnel(double cosine, double n);
/* The cosine behind the boundary; 0 at total reflection. Snell's law. */
double truth_refracted(double cosine, double n);
/* F0 + (1 - F0) (1 - cosine)^5. */
double truth_schlick(double F0, double cosine);
/* Irradiance over the radiance of a polygon of count corners, as seen from P on a surface of normal N; the
 * polygon is above the horizon and its corners go counter-clockwise seen from P. Lambert 1760. */
double truth_polygon_irradiance(const double P[3], const double N[3], const double (*corners)[3], int count);

#endif
