/* Truth tests of light on diffuse surfaces: skies, emitters of known form factor, delta lights, the sun's
 * disc and its penumbra, interreflection in a closed room. References are closed forms or quadrature in
 * double. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "ibl/environment.h"
#include "ibl/equirect.h"
#include "path/path_fixture.h"

/* ---- skies ---- */

/* Lambert's law under a sky that is the same everywhere: radiance = albedo, wherever one looks. */
static void a_lambert_sphere_under_a_constant_sky(void **state)
{
    (void)state;
    static const float albedos[] = {0.18f, 0.5f, 1.0f};
    for (int i = 0; i < 3; i++) {
        fixture f = truth_create();
        truth_set_constant_sky(&f, 1.0f, 2.0f, 0.5f);
        truth_add_flat_sphere(&f, fixture_add_material(&f, truth_lambert(albedos[i])), 32, 0.0f, 1.0f);
        truth_set_camera(&f, 60.0, 0.0f, 0.0f, 1.4f);
        truth_value v = truth_measure(&f, 16);
        for (int c = 0; c < 3; c++)
            truth_assert_channel(&v, c,
                                 (double)albedos[i] * (c == 0   ? 1.0
                                                       : c == 1 ? 2.0
                                                                : 0.5),
                                 "albedo %g", (double)albedos[i]);
        truth_assert_channel(&v, 3, 1.0, "opacity");
        fixture_destroy(&f);
    }
}

static void sky_that_brightens_upwards(const double d[3], float rgb[3])
{
    rgb[0] = (float)(0.5 + 0.5 * d[1]);
    rgb[1] = (float)fmax(d[1], 0.0);
    rgb[2] = d[1] > 0.0 ? 1.0f : 0.0f;
}

/* On a surface tilted by t: sky (1 + y) / 2 gives E / pi = 1/2 + cos t / 3, the upper half (1 + cos t) /
 * 2, and max(y, 0) gives [sin t + (pi - t) cos t] 2 / (3 pi), the kernel of irradiance of a clamped cosine
 * (linear in solid angle: Ramamoorthi and Hanrahan 2001 have its harmonics; the sum is the arc-cosine
 * kernel of order 1, Cho and Saul 2009, over 3 / 2). */
static void tilted_surfaces_under_skies_of_the_height(void **state)
{
    (void)state;
    for (int tilt = 0; tilt <= 150; tilt += 30) {
        double t = truth_radians(tilt);
        fixture f = truth_create();
        f.desc.samples = 256;
        truth_set_sky(&f, 512, sky_that_brightens_upwards);
        float side = 0.5f;
        float u[3] = {side * (float)cos(t), -side * (float)sin(t), 0.0f};
        float v[3] = {0.0f, 0.0f, -side};
        truth_add_panel(&f, fixture_add_material(&f, truth_lambert(0.8f)), (float[3]){0.0f, 0.0f, 0.0f}, u,
                        v);
        truth_set_camera(&f, tilt, 0.0f, 0.0f, 0.01f);
        truth_value value = truth_measure_pixels(&f);
        truth_assert_channel(&value, 0, 0.8 * (0.5 + cos(t) / 3.0), "linear sky, tilt %d", tilt);
        truth_assert_channel(&value, 2, 0.8 * 0.5 * (1.0 + cos(t)), "upper half, tilt %d", tilt);
        truth_assert_channel(&value, 1, 0.8 * 2.0 / (3.0 * TRUTH_PI) * (sin(t) + (TRUTH_PI - t) * cos(t)),
                             "cosine sky, tilt %d", tilt);
        fixture_destroy(&f);
    }
}

/* ---- glossy surfaces ---- */

/* GGX with the height-correlated Smith term and reflectance 1 for light from the whole upper hemisphere of
 * a panel that faces +Z: the sum over all texels of the image at 2048 x 1024, in double. V in the plane of
 * x and z. NULL: radiance 1 from everywhere. */
static double reflected_by_quadrature(const image *picture, double angle, double alpha)
{
    enum { WIDTH = 2048, HEIGHT = 1024 };
    double a2 = alpha * alpha;
    double V[3] = {sin(angle), 0.0, cos(angle)};
    double sum = 0.0;
    for (uint32_t y = 0; y < HEIGHT; y++) {
        double solid_angle = equirect_texel_solid_angle(WIDTH, HEIGHT, y);
        for (uint32_t x = 0; x < WIDTH; x++) {
            float d[3], rgb[3] = {1.0f, 1.0f, 1.0f};
            equirect_direction(WIDTH, HEIGHT, x, y, d);
            if (d[2] <= 0.0f)
                continue;
            if (picture)
                equirect_lookup(picture, d, rgb);
            double L[3] = {(double)d[0], (double)d[1], (double)d[2]};
            double H[3] = {V[0] + L[0], V[1] + L[1], V[2] + L[2]};
            double NdotH = H[2] / sqrt(H[0] * H[0] + H[1] * H[1] + H[2] * H[2]);
            double t = NdotH * NdotH * (a2 - 1.0) + 1.0;
            double D = a2 / (TRUTH_PI * t * t);
            double masking =
                L[2] * sqrt(V[2] * V[2] * (1.0 - a2) + a2) + V[2] * sqrt(L[2] * L[2] * (1.0 - a2) + a2);
            sum += solid_angle * (double)rgb[1] * D * 0.5 / masking * L[2];
        }
    }
    return sum;
}

/* In the studio: soft boxes in a grey room, 40 times as bright. */
static void a_glossy_metal_in_the_studio(void **state)
{
    (void)state;
    static const float roughness[] = {0.3f, 0.5f, 0.9f};
    for (int r = 0; r < 3; r++)
        for (int i = 0; i < 3; i++) {
            double angle = 0.6 * i;
            fixture f = truth_create();
            f.desc.samples = 1024;
            truth_add_panel(&f, fixture_add_material(&f, truth_metal(1.0f, 1.0f, 1.0f, roughness[r])),
                            (float[3]){0.0f, 0.0f, 0.0f}, (float[3]){0.5f, 0.0f, 0.0f},
                            (float[3]){0.0f, 0.5f, 0.0f});
            f.camera = (facet_camera){.eye = {10.0f * (float)sin(angle), 0.0f, 10.0f * (float)cos(angle)},
                                      .ortho_height = 0.01f};
            assert_int_equal(facet_environment_create_studio(NULL, &f.environment, NULL), FACET_OK);
            truth_value v = truth_measure_pixels(&f);
            double alpha = (double)roughness[r] * (double)roughness[r];
            /* a white metal with multiple scattering reflects all light */
            double expected = reflected_by_quadrature(&f.environment->panorama, angle, alpha) /
                              reflected_by_quadrature(NULL, angle, alpha);
            truth_assert_channel(&v, 1, expected, "roughness %g, %g rad", (double)roughness[r], angle);
            fixture_destroy(&f);
        }
}

/* ---- emitters ---- */

static void a_square_light_over_a_plane(void **state)
{
    (void)state;
    static const double corners[4][3] = {
        {-0.5, 1.0, -0.5}, {0.5, 1.0, -0.5}, {0.5, 1.0, 0.5}, {-0.5, 1.0, 0.5}};
    static const double up[3] = {0.0, 1.0, 0.0};
    /* In the middle also the textbook's form (Howell's catalogue, C-11): four corners with a = b = 1/2. */
    double a = 0.5 / sqrt(1.25);
    double middle = 4.0 * 0.5 * (2.0 * a * atan(a));
    double polygon = truth_polygon_irradiance((double[3]){0.0, 0.0, 0.0}, up, corners, 4);
    assert_true(fabs(polygon - middle) < 1e-12);
    for (int i = 0; i < 4; i++) {
        double x = 0.4 * i;
        fixture f = truth_create();
        truth_add_floor(&f, fixture_add_material(&f, truth_lambert(0.6f)), 0.0f, 20.0f);
        truth_add_ceiling(&f, fixture_add_material(&f, truth_emitter(7.0f)), 1.0f, 0.5f);
        truth_set_camera(&f, -75.0, (float)x, 0.0f, 0.001f);
        truth_value v = truth_measure_pixels(&f);
        double E = 7.0 * truth_polygon_irradiance((double[3]){x, 0.0, 0.0}, up, corners, 4);
        truth_assert_grey(&v, 0.6 / TRUTH_PI * E, "plane at x = %g", x);
        fixture_destroy(&f);
    }
}

/* A wall beside the light: the light is seen by a surface that stands upright. */
static void a_square_light_beside_a_wall(void **state)
{
    (void)state;
    static const double corners[4][3] = {
        {0.5, 1.0, -0.5}, {1.5, 1.0, -0.5}, {1.5, 1.0, 0.5}, {0.5, 1.0, 0.5}};
    static const double N[3] = {1.0, 0.0, 0.0};
    fixture f = truth_create();
    truth_add_panel(&f, fixture_add_material(&f, truth_lambert(0.5f)), (float[3]){0.0f, 0.0f, 0.0f},
                    (float[3]){0.0f, 0.5f, 0.0f}, (float[3]){0.0f, 0.0f, 0.5f});
    truth_add_panel(&f, fixture_add_material(&f, truth_emitter(3.0f)), (float[3]){1.0f, 1.0f, 0.0f},
                    (float[3]){0.5f, 0.0f, 0.0f}, (float[3]){0.0f, 0.0f, 0.5f});
    truth_set_camera(&f, 90.0, 0.0f, 0.0f, 0.001f);
    truth_value v = truth_measure_pixels(&f);
    double E = 3.0 * truth_polygon_irradiance((double[3]){0.0, 0.0, 0.0}, N, corners, 4);
    truth_assert_grey(&v, 0.5 / TRUTH_PI * E, "wall");
    fixture_destroy(&f);
}

/* E = pi L (R / d)^2 below a sphere: the square of the sine under which it is seen. Its triangles are seen
 * as a polygon of 256 corners on the circle, whose area is sin(2 pi / 256) / (2 pi / 256) of the disc's. */
static void an_emissive_sphere_over_a_plane(void **state)
{
    (void)state;
    double polygon = sin(2.0 * TRUTH_PI / 256.0) / (2.0 * TRUTH_PI / 256.0);
    for (int i = 0; i < 2; i++) {
        double distance = i ? 4.0 : 1.25;
        fixture f = truth_create();
        truth_add_floor(&f, fixture_add_material(&f, truth_lambert(0.5f)), 0.0f, 20.0f);
        truth_add_flat_sphere(&f, fixture_add_material(&f, truth_emitter(2.0f)), 256, (float)distance, 1.0f);
        truth_set_camera(&f, 84.0, 0.0f, 0.0f, 0.001f);
        f.desc.path.max_depth = 1;
        truth_value v = truth_measure_pixels(&f);
        /* The sphere touches nothing and is black itself, so that nothing comes back from it. */
        double E = TRUTH_PI * 2.0 / (distance * distance) * polygon;
        truth_assert_grey(&v, 0.5 / TRUTH_PI * E, "sphere %g m up", distance);
        fixture_destroy(&f);
    }
}

/* ---- lights without size ---- */

static fixture floor_under(scene_light light, float x, float y, const float rotation[4])
{
    fixture f = truth_create();
    f.desc.samples = 4;
    truth_add_floor(&f, fixture_add_material(&f, truth_lambert(0.5f)), 0.0f, 20.0f);
    fixture_add_light(&f, light, x, y, 0.0f);
    memcpy(f.scene->nodes[f.scene->node_count - 1].rotation, rotation, 4 * sizeof(float));
    truth_set_camera(&f, -30.0, 0.0f, 0.0f, 0.0001f);
    return f;
}

/* -Z turned to -Y. */
static const float DOWN[4] = {-0.70710678f, 0.0f, 0.0f, 0.70710678f};

static void check_light(fixture *f, double illuminance, const char *what)
{
    truth_value v = truth_measure_pixels(f);
    for (int c = 0; c < 3; c++)
        truth_assert_channel(&v, c,
                             0.5 / TRUTH_PI * illuminance *
                                 (c == 0   ? 1.0
                                  : c == 1 ? 0.5
                                           : 0.25),
                             "%s", what);
    /* One light and one surface: only the position in the pixel is random. */
    assert_true(v.error[0] <= 5e-5 * v.mean[0]);
    fixture_destroy(f);
}

static void delta_lights_are_exact(void **state)
{
    (void)state;
    scene_light light = {.name = "", .color = {1.0f, 0.5f, 0.25f}, .intensity = 100.0f};
    light.type = SCENE_LIGHT_POINT;
    for (int i = 1; i <= 4; i *= 2) {
        fixture f = floor_under(light, (float)i, (float)i, DOWN);
        /* Inverse square and cosine: 45 degrees, i sqrt 2 away. */
        check_light(&f, 100.0 / (2.0 * i * i) * sqrt(0.5), "point light");
    }
    light.type = SCENE_LIGHT_DIRECTIONAL;
    fixture f = floor_under(light, 3.0f, 5.0f, (float[4]){-0.38268343f, 0.0f, 0.0f, 0.92387953f});
    check_light(&f, 100.0 * sqrt(0.5), "directional light at 45 degrees");
    light.type = SCENE_LIGHT_SPOT;
    light.inner_cone_rad = 0.3f;
    light.outer_cone_rad = 0.6f;
    f = floor_under(light, 0.2f, 2.0f, DOWN);
    double d2 = 4.04;
    check_light(&f, 100.0 / d2 * 2.0 / sqrt(d2), "spot, inner cone");
    f = floor_under(light, 1.0f, 2.0f, DOWN);
    d2 = 5.0;
    double scale = (2.0 / sqrt(d2) - cos(0.6)) / (cos(0.3) - cos(0.6)); /* KHR_lights_punctual, squared */
    check_light(&f, 100.0 / d2 * 2.0 / sqrt(d2) * scale * scale, "spot, between the cones");
    f = floor_under(light, 2.0f, 2.0f, DOWN);
    check_light(&f, 0.0, "spot, outside");
}

/* A wall between light and floor. */
static void delta_lights_cast_sharp_shadows(void **state)
{
    (void)state;
    scene_light light = {
        .name = "", .color = {1.0f, 1.0f, 1.0f}, .intensity = 100.0f, .type = SCENE_LIGHT_POINT};
    for (int i = 0; i < 2; i++) {
        fixture f = floor_under(light, 2.0f, 2.0f, DOWN);
        float x = i ? 0.999f : 1.001f; /* the wall's edge; the ray passes x = 1 at y = 1 */
        truth_add_panel(&f, fixture_add_material(&f, truth_lambert(0.0f)), (float[3]){x + 1.0f, 1.0f, 0.0f},
                        (float[3]){1.0f, 0.0f, 0.0f}, (float[3]){0.0f, 0.0f, -1.0f});
        truth_value v = truth_measure_pixels(&f);
        truth_assert_grey(&v, i ? 0.0 : 0.5 / TRUTH_PI * 100.0 / 8.0 * sqrt(0.5), "edge at %g", (double)x);
        fixture_destroy(&f);
    }
}

/* ---- the sun ---- */

static void the_sun_gives_its_illuminance(void **state)
{
    (void)state;
    static const float diameters[] = {0.0f, 0.05f, 0.5f};
    for (int i = 0; i < 3; i++)
        for (int elevation = 30; elevation <= 90; elevation += 30) {
            fixture f = truth_create();
            f.desc.sun = (facet_sun){.elevation_rad = (float)truth_radians(elevation),
                                     .azimuth_rad = 1.0f,
                                     .illuminance_lux = {100.0f, 50.0f, 10.0f},
                                     .diameter_rad = diameters[i]};
            truth_add_floor(&f, fixture_add_material(&f, truth_lambert(0.5f)), 0.0f, 20.0f);
            truth_set_camera(&f, 20.0, 0.0f, 0.0f, 0.001f);
            truth_value v = truth_measure_pixels(&f);
            /* A disc that is wholly above the horizon: its projected solid angle is that of its middle. */
            double E = 0.5 / TRUTH_PI * sin(truth_radians(elevation));
            truth_assert_channel(&v, 0, 100.0 * E, "sun of %g rad at %d degrees", (double)diameters[i],
                                 elevation);
            truth_assert_channel(&v, 1, 50.0 * E, "sun of %g rad at %d degrees", (double)diameters[i],
                                 elevation);
            truth_assert_channel(&v, 2, 10.0 * E, "sun of %g rad at %d degrees", (double)diameters[i],
                                 elevation);
            fixture_destroy(&f);
        }
}

/* The sun seen directly has the radiance E / (pi sin^2 r), inside of its radius r and nowhere else. */
static void the_sun_is_seen_as_a_disc(void **state)
{
    (void)state;
    double radius = 0.1;
    for (int i = 0; i < 4; i++) {
        double off = i < 2 ? radius * (i ? 0.95 : 0.0) : radius * (i == 2 ? 1.05 : 3.0);
        fixture f = truth_create();
        f.desc.sun = (facet_sun){.elevation_rad = 0.3f,
                                 .illuminance_lux = {10.0f, 10.0f, 10.0f},
                                 .diameter_rad = (float)(2.0 * radius)};
        double elevation = 0.3 + off;
        f.camera = (facet_camera){.target = {0.0f, (float)sin(elevation), (float)cos(elevation)},
                                  .ortho_height = 0.01f};
        truth_add_floor(&f, fixture_add_material(&f, truth_lambert(0.5f)), -1.0f, 1.0f);
        truth_value v = truth_measure_pixels(&f);
        truth_assert_grey(&v, i < 2 ? 10.0 / (TRUTH_PI * sin(radius) * sin(radius)) : 0.0, "%g rad off", off);
        fixture_destroy(&f);
    }
}

/* The share of the disc of a sun of that radius in the zenith that is left of a line x = s h, y free, z =
 * h: by the projected solid angle, where the line is the half of an ellipse x = sin(atan s) sqrt(1 - y^2)
 * (Nusselt 1928). */
static double share_of_disc(double s, double radius)
{
    enum { STEPS = 20000 };
    double R = sin(radius);
    double edge = s / sqrt(1.0 + s * s);
    double area = 0.0;
    for (int i = 0; i < STEPS; i++) {
        double y = R * (2.0 * (i + 0.5) / STEPS - 1.0);
        double half = sqrt(R * R - y * y);
        double x = edge * sqrt(1.0 - y * y);
        area += (fmin(fmax(x, -half), half) + half) * 2.0 * R / STEPS;
    }
    return area / (TRUTH_PI * R * R);
}

static void the_penumbra_of_an_edge(void **state)
{
    (void)state;
    double radius = 0.1;
    for (int i = -3; i <= 3; i++) {
        double x = 0.04 * i; /* the edge is above x = 0, 1 m up; the penumbra is 0.2 m wide */
        fixture f = truth_create();
        f.desc.samples = 256;
        f.desc.sun = (facet_sun){.elevation_rad = (float)truth_radians(90.0),
                                 .illuminance_lux = {10.0f, 10.0f, 10.0f},
                                 .diameter_rad = (float)(2.0 * radius)};
        truth_add_floor(&f, fixture_add_material(&f, truth_lambert(0.5f)), 0.0f, 20.0f);
        truth_add_panel(&f, fixture_add_material(&f, truth_lambert(0.0f)), (float[3]){1.0f, 1.0f, 0.0f},
                        (float[3]){1.0f, 0.0f, 0.0f}, (float[3]){0.0f, 0.0f, -5.0f});
        truth_set_camera(&f, -60.0, (float)x, 0.0f, 0.0001f);
        truth_value v = truth_measure_pixels(&f);
        double E = 10.0 * share_of_disc(-x, radius);
        truth_assert_grey(&v, 0.5 / TRUTH_PI * E, "%g m from the edge", x);
        fixture_destroy(&f);
    }
}

/* ---- interreflection ---- */

/* Walls that emit L and reflect rho have the radiance L (1 + rho + rho^2 ..) = L / (1 - rho); a path of D
 * events finds the first D + 1 terms. */
static void a_closed_room_sums_the_geometric_series(void **state)
{
    (void)state;
    static const uint32_t depths[] = {1, 2, 5, 64};
    static const float albedos[] = {0.3f, 0.8f};
    for (int a = 0; a < 2; a++)
        for (int i = 0; i < 4; i++) {
            fixture f = truth_create();
            f.desc.path.max_depth = depths[i];
            scene_material wall = truth_lambert(albedos[a]);
            wall.emissive[0] = wall.emissive[1] = wall.emissive[2] = 0.5f;
            truth_add_box(&f, fixture_add_material(&f, wall), 0.0f, -1.0f, -1.0f, -1.0f);
            f.camera = (facet_camera){.eye = {0.3f, 0.1f, 0.2f}, .fov_y_rad = 1.0f};
            truth_value v = truth_measure(&f, 16);
            double rho = (double)albedos[a];
            double sum = (1.0 - pow(rho, depths[i] + 1.0)) / (1.0 - rho);
            truth_assert_grey(&v, 0.5 * sum, "albedo %g, %u events", rho, depths[i]);
            fixture_destroy(&f);
        }
}

/* A light in a closed room: its power, pi L A, is absorbed by the walls and by itself. */
static void a_room_absorbs_the_flux_of_its_light(void **state)
{
    (void)state;
    double rho = 0.5;
    double absorbed = 0.0, error2 = 0.0;
    for (int wall = 0; wall < 6; wall++) {
        fixture f = truth_create();
        f.desc.width = f.desc.height = 8;
        uint32_t white = fixture_add_material(&f, truth_lambert((float)rho));
        truth_add_box(&f, white, 0.0f, -1.0f, -1.0f, -1.0f);
        /* A plate that emits on both sides, with the walls' albedo 0: it absorbs all incident light. */
        scene_material emitter = truth_emitter(1.0f);
        emitter.is_double_sided = true;
        truth_add_panel(&f, fixture_add_material(&f, emitter), (float[3]){0.2f, 0.1f, 0.0f},
                        (float[3]){0.3f, 0.0f, 0.0f}, (float[3]){0.0f, 0.2f, 0.0f});
        float axis[3] = {0};
        axis[wall / 2] = wall & 1 ? -1.0f : 1.0f;
        /* From just before the wall, so that nothing is in between: radiance of a Lambertian wall is that
         * of every direction. */
        for (int i = 0; i < 3; i++) {
            f.camera.eye[i] = 0.9999f * axis[i];
            f.camera.target[i] = axis[i];
            f.camera.up[i] = axis[(i + 1) % 3];
        }
        f.camera.ortho_height = 2.0f;
        truth_value v = truth_measure(&f, 16);
        /* Radiance = rho E / pi; the wall of 4 m^2 absorbs (1 - rho) E. */
        absorbed += 4.0 * (1.0 - rho) / rho * TRUTH_PI * v.mean[0];
        error2 += pow(4.0 * (1.0 - rho) / rho * TRUTH_PI * v.error[0], 2.0);
        fixture_destroy(&f);
    }
    /* Irradiance on the light's two sides: measured by a negligible albedo, less their emission. */
    double caught = 0.0;
    for (int side = 0; side < 2; side++) {
        fixture f = truth_create();
        f.desc.width = f.desc.height = 8;
        truth_add_box(&f, fixture_add_material(&f, truth_lambert((float)rho)), 0.0f, -1.0f, -1.0f, -1.0f);
        scene_material emitter = truth_lambert(1e-3f);
        emitter.emissive[0] = emitter.emissive[1] = emitter.emissive[2] = 1.0f;
        emitter.is_double_sided = true;
        truth_add_panel(&f, fixture_add_material(&f, emitter), (float[3]){0.2f, 0.1f, 0.0f},
                        (float[3]){0.3f, 0.0f, 0.0f}, (float[3]){0.0f, 0.2f, 0.0f});
        f.camera = (facet_camera){
            .eye = {0.2f, 0.1f, side ? -0.001f : 0.001f}, .target = {0.2f, 0.1f, 0.0f}, .ortho_height = 0.4f};
        f.desc.width = 12;
        f.desc.samples = 256;
        truth_value v = truth_measure(&f, 16);
        caught += 0.24 * TRUTH_PI * (v.mean[0] - 1.0) / 1e-3;
        error2 += pow(0.24 * TRUTH_PI * v.error[0] / 1e-3, 2.0);
        fixture_destroy(&f);
    }
    double emitted = 2.0 * 0.24 * TRUTH_PI;
    /* The plate of albedo 1e-3 adds less than that part of what it catches. */
    if (fabs(absorbed + caught - emitted) > TRUTH_SIGMAS * sqrt(error2) + 2e-3 * caught)
        fail_msg("absorbed %.6f + caught %.6f is not the emitted %.6f; standard error %.2g", absorbed, caught,
                 emitted, sqrt(error2));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lambert_sphere_under_a_constant_sky),
        cmocka_unit_test(tilted_surfaces_under_skies_of_the_height),
        cmocka_unit_test(a_glossy_metal_in_the_studio),
        cmocka_unit_test(a_square_light_over_a_plane),
        cmocka_unit_test(a_square_light_beside_a_wall),
        cmocka_unit_test(an_emissive_sphere_over_a_plane),
        cmocka_unit_test(delta_lights_are_exact),
        cmocka_unit_test(delta_lights_cast_sharp_shadows),
        cmocka_unit_test(the_sun_gives_its_illuminance),
        cmocka_unit_test(the_sun_is_seen_as_a_disc),
        cmocka_unit_test(the_penumbra_of_an_edge),
        cmocka_unit_test(a_closed_room_sums_the_geometric_series),
        cmocka_unit_test(a_room_absorbs_the_flux_of_its_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
