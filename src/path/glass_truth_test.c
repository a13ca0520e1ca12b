/* Truth tests of transmission and specular reflection: slabs with all their internal reflections,
 * absorption, nested volumes, thin walls, leaves, facing mirrors, caustics. The sky is red above, green
 * below and blue all around, so that one image shows reflection, transmission and both. References are
 * closed forms in double. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "path/path_fixture.h"

/* Reflectance and transmittance of a stack of boundaries, for light from above and from below. */
typedef struct stack {
    double R, T, R_below, T_below;
} stack;

/* Puts b below a; light is reflected between them, incoherently: the geometric series of Stokes 1862. */
static stack stack_add(stack a, stack b)
{
    double loop = 1.0 / (1.0 - a.R_below * b.R);
    return (stack){.R = a.R + a.T * a.T_below * b.R * loop,
                   .T = a.T * b.T * loop,
                   .R_below = b.R_below + b.T_below * b.T * a.R_below * loop,
                   .T_below = b.T_below * a.T_below * loop};
}

/* A boundary at which n goes to m times n, for light from above at that cosine. */
static stack boundary(double cosine, double m)
{
    double F = truth_fresnel(cosine, m);
    return (stack){F, 1.0 - F, F, 1.0 - F};
}

/* A layer of that transmittance. */
static stack layer(double through)
{
    return (stack){0.0, through, 0.0, through};
}

/* A slab of 1 m and half size s. */
static fixture slab_of(scene_material material, double polar, float s)
{
    fixture f = truth_create();
    truth_set_sky(&f, 64, truth_sky_halves);
    truth_add_box(&f, fixture_add_material(&f, material), 0.0f, s, 0.5f, s);
    truth_set_camera(&f, polar, 0.0f, 0.0f, 0.1f);
    f.desc.samples = 256;
    return f;
}

/* So wide that light which leaves by its sides has been reflected too often to matter. */
static fixture slab(scene_material material, double polar)
{
    return slab_of(material, polar, 10.0f);
}

static void check_slab(fixture *f, stack expected, const char *what, double angle)
{
    truth_value v = truth_measure(f, 16);
    truth_assert_channel(&v, 0, expected.R, "%s at %g degrees, reflected", what, angle);
    truth_assert_channel(&v, 1, expected.T, "%s at %g degrees, transmitted", what, angle);
    truth_assert_channel(&v, 2, expected.R + expected.T, "%s at %g degrees, both", what, angle);
    fixture_destroy(f);
}

/* ---- slabs ---- */

/* R = 2 F / (1 + F), T = (1 - F) / (1 + F). */
static void a_slab_of_clear_glass_is_exact(void **state)
{
    (void)state;
    static const double iors[] = {1.33, 1.5, 2.42};
    static const double angles[] = {0.0, 30.0, 60.0, 70.0, 80.0};
    for (int i = 0; i < 3; i++)
        for (int a = 0; a < 5; a++) {
            double cosine = cos(truth_radians(angles[a]));
            double F = truth_fresnel(cosine, iors[i]);
            stack expected = {.R = 2.0 * F / (1.0 + F), .T = (1.0 - F) / (1.0 + F)};
            fixture f = slab(truth_glass((float)iors[i], 0.0f), angles[a]);
            check_slab(&f, expected, "clear slab", angles[a]);
        }
}

/* Each pass leaves t = exp(-sigma d / cos'): T = (1 - F)^2 t / (1 - F^2 t^2), R = F + F t T. */
static void an_absorbing_slab_is_exact(void **state)
{
    (void)state;
    static const double angles[] = {0.0, 45.0, 70.0};
    for (int a = 0; a < 3; a++) {
        double cosine = cos(truth_radians(angles[a]));
        double F = truth_fresnel(cosine, 1.5);
        double t = pow(0.4, 1.0 / (2.0 * truth_refracted(cosine, 1.5)));
        double T = (1.0 - F) * (1.0 - F) * t / (1.0 - F * F * t * t);
        scene_material m = truth_glass(1.5f, 0.0f);
        m.attenuation_distance = 2.0f;
        for (int c = 0; c < 3; c++)
            m.attenuation_color[c] = 0.4f;
        fixture f = slab(m, angles[a]);
        check_slab(&f, (stack){.R = F + F * t * T, .T = T}, "absorbing slab", angles[a]);
    }
}

/* Colors: a sky of 1, and each channel has its own coefficient. The base color tints at each crossing. */
static void a_colored_slab(void **state)
{
    (void)state;
    double cosine = cos(truth_radians(40.0));
    double F = truth_fresnel(cosine, 1.5);
    scene_material m = truth_glass(1.5f, 0.0f);
    m.attenuation_distance = 0.7f;
    for (int c = 0; c < 3; c++) {
        m.attenuation_color[c] = 0.2f + 0.3f * (float)c;
        m.base_color[c] = 1.0f - 0.2f * (float)c;
    }
    fixture f = slab(m, 40.0);
    truth_set_constant_sky(&f, 1.0f, 1.0f, 1.0f);
    f.desc.samples = 1024;
    truth_value v = truth_measure(&f, 16);
    for (int c = 0; c < 3; c++) {
        double t = pow((double)m.attenuation_color[c], 1.0 / (0.7 * truth_refracted(cosine, 1.5)));
        double b = (double)m.base_color[c];
        stack s = stack_add(stack_add((stack){F, (1.0 - F) * b, F, (1.0 - F) * b}, layer(t)),
                            (stack){F, (1.0 - F) * b, F, (1.0 - F) * b});
        truth_assert_channel(&v, c, s.R + s.T, "tinted glass of attenuation %g",
                             (double)m.attenuation_color[c]);
    }
    fixture_destroy(&f);
}

/* Without a step of index there is no boundary: exp(-sigma d) alone. Beer 1852. */
static void a_medium_without_a_boundary(void **state)
{
    (void)state;
    scene_material m = truth_glass(1.0f, 0.0f);
    m.attenuation_distance = 1.0f;
    for (int c = 0; c < 3; c++)
        m.attenuation_color[c] = 0.3f;
    for (int angle = 0; angle <= 60; angle += 30) {
        double T = pow(0.3, 1.0 / cos(truth_radians(angle)));
        fixture f = slab_of(m, angle, 2.0f);
        check_slab(&f, (stack){.T = T}, "ior 1", angle);
    }
}

/* The lossless index step, at every angle: nothing of a ball is lost, whatever its surface does. */
static void a_glass_ball_in_a_furnace(void **state)
{
    (void)state;
    static const float iors[] = {1.33f, 1.5f, 2.42f};
    for (int i = 0; i < 3; i++)
        for (int is_smooth = 0; is_smooth < 2; is_smooth++) {
            fixture f = truth_create();
            truth_set_constant_sky(&f, 1.0f, 1.0f, 1.0f);
            uint32_t glass = fixture_add_material(&f, truth_glass(iors[i], 0.0f));
            if (is_smooth)
                fixture_place(&f, fixture_add_sphere(&f, 128, glass), 0.0f, 0.0f, 0.0f, 1.0f);
            else
                truth_add_flat_sphere(&f, glass, 64, 0.0f, 1.0f);
            truth_set_camera(&f, 60.0, 0.0f, 0.0f, 2.2f);
            f.desc.width = f.desc.height = 16;
            f.desc.samples = 16;
            /* Total reflection keeps some light in a ball of flat triangles for long: of ior 2.42, 1.3 %
             * for more than 30 events, 0.03 % for more than 1000. */
            f.desc.path.max_depth = 4000;
            truth_value v = truth_measure(&f, 8);
            truth_assert_grey(&v, 1.0, "ior %g, %s", (double)iors[i], is_smooth ? "smooth normals" : "flat");
            fixture_destroy(&f);
        }
}

/* ---- nested volumes ---- */

/* A box of another index inside, not touching: four boundaries. */
static void a_slab_in_a_slab(void **state)
{
    (void)state;
    static const double angles[] = {0.0, 50.0, 70.0};
    for (int a = 0; a < 3; a++) {
        double c0 = cos(truth_radians(angles[a]));
        double c1 = truth_refracted(c0, 1.33);
        stack s = boundary(c0, 1.33);
        s = stack_add(s, boundary(c1, 1.6 / 1.33));
        double c2 = truth_refracted(c0, 1.6);
        s = stack_add(s, boundary(c2, 1.33 / 1.6));
        s = stack_add(s, boundary(c1, 1.0 / 1.33));
        fixture f = slab(truth_glass(1.33f, 0.0f), angles[a]);
        truth_add_box(&f, fixture_add_material(&f, truth_glass(1.6f, 0.0f)), 0.1f, 9.0f, 0.2f, 9.0f);
        check_slab(&f, s, "glass in water", angles[a]);
    }
}

/* A volume of the same index inside changes nothing, nor does one that overlaps. */
static void volumes_of_equal_index_are_one(void **state)
{
    (void)state;
    for (int is_overlapping = 0; is_overlapping < 2; is_overlapping++) {
        double F = truth_fresnel(cos(truth_radians(50.0)), 1.5);
        fixture f = slab(truth_glass(1.5f, 0.0f), 50.0);
        truth_add_box(&f, fixture_add_material(&f, truth_glass(1.5f, 0.0f)), is_overlapping ? 0.4f : 0.0f,
                      9.0f, 0.3f, 9.0f);
        check_slab(&f, (stack){.R = 2.0 * F / (1.0 + F), .T = (1.0 - F) / (1.0 + F)},
                   is_overlapping ? "overlapping" : "nested", 50.0);
    }
}

/* Where two volumes of different index overlap, the order of volumes must be the same from both sides.
 * Then transmittance is equal in both directions (Stokes), and no energy is lost. */
static void overlap_is_the_same_from_both_sides(void **state)
{
    (void)state;
    truth_value v[2];
    for (int is_below = 0; is_below < 2; is_below++) {
        fixture f = slab(truth_glass(1.33f, 0.0f), is_below ? 130.0 : 50.0);
        truth_add_box(&f, fixture_add_material(&f, truth_glass(1.8f, 0.0f)), 0.6f, 9.0f, 0.4f, 9.0f);
        v[is_below] = truth_measure(&f, 16);
        truth_assert_channel(&v[is_below], 2, 1.0, "overlap from %s, both", is_below ? "below" : "above");
        fixture_destroy(&f);
    }
    truth_assert_channel(&v[0], 1, v[1].mean[0], "transmitted down, against up");
    truth_assert_channel(&v[1], 0, v[0].mean[1], "transmitted up, against down");
}

/* ---- rough boundaries ---- */

/* Reflection at one boundary alone: transmitted light is absorbed at once. R and T of single scattering are
 * quadratures of exact Fresnel, D and the correlated G2. Multiple scattering is distributed in proportion, so that
 * R / (R + T) is reflected, within the accuracy of the tables, TRUTH_TABLES. */
static void a_rough_boundary_reflects(void **state)
{
    (void)state;
    static const struct {
        float ior, roughness;
        double NdotV, R, T;
    } cases[] = {{1.33f, 0.25f, 0.25, 0.194968220724, 0.789269741410},
                 {1.33f, 0.5f, 0.5, 0.043524002637, 0.919033588165},
                 {1.33f, 1.0f, 1.0, 0.006456358653, 0.916440062616},
                 {1.5f, 0.25f, 0.25, 0.233456163475, 0.749758477838},
                 {1.5f, 0.5f, 0.25, 0.118762007766, 0.802941599388},
                 {1.5f, 1.0f, 0.25, 0.038412163019, 0.662925273851},
                 {1.5f, 0.25f, 0.5, 0.088517433829, 0.908528785672},
                 {1.5f, 0.5f, 0.5, 0.066898507093, 0.893867651534},
                 {1.5f, 1.0f, 0.5, 0.023386870030, 0.718451210143},
                 {1.5f, 0.25f, 1.0, 0.039872530346, 0.959686694012},
                 {1.5f, 0.5f, 1.0, 0.037048663178, 0.954996008257},
                 {1.5f, 1.0f, 1.0, 0.012702412787, 0.880637578333},
                 {2.42f, 0.25f, 0.5, 0.209224288122, 0.787094355714},
                 {2.42f, 0.5f, 0.25, 0.209326105390, 0.711803035050},
                 {2.42f, 1.0f, 1.0, 0.053306530497, 0.724977702741}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        scene_material m = truth_glass(cases[i].ior, cases[i].roughness);
        m.attenuation_distance = 1e-6f;
        m.attenuation_color[0] = m.attenuation_color[1] = m.attenuation_color[2] = 1e-6f;
        fixture f = slab(m, acos(cases[i].NdotV) * 180.0 / TRUTH_PI);
        f.desc.samples = 512;
        truth_value v = truth_measure(&f, 16);
        double expected = cases[i].R / (cases[i].R + cases[i].T);
        double off = fabs(v.mean[2] - expected) - TRUTH_SIGMAS * v.error[2];
        print_message("ior %.2f, roughness %.2f, N.V %.2f: %.6f +- %.2g, expected %.6f\n",
                      (double)cases[i].ior, (double)cases[i].roughness, cases[i].NdotV, v.mean[2], v.error[2],
                      expected);
        assert_true(off < TRUTH_TABLES);
        fixture_destroy(&f);
    }
}

/* ---- thin walls and leaves ---- */

/* A thin wall reflects F and transmits the rest straight on, tinted. */
static void a_thin_wall(void **state)
{
    (void)state;
    for (int angle = 0; angle <= 75; angle += 25) {
        scene_material m = truth_glass(1.5f, 0.0f);
        m.extensions = SCENE_TRANSMISSION | SCENE_IOR;
        m.thickness = 0.0f;
        m.is_double_sided = true;
        for (int c = 0; c < 3; c++)
            m.base_color[c] = 0.5f;
        fixture f = truth_create();
        truth_set_sky(&f, 64, truth_sky_halves);
        truth_add_floor(&f, fixture_add_material(&f, m), 0.0f, 100.0f);
        truth_set_camera(&f, angle, 0.0f, 0.0f, 0.1f);
        f.desc.samples = 256;
        double F = truth_fresnel(cos(truth_radians(angle)), 1.5);
        check_slab(&f, (stack){.R = F, .T = 0.5 * (1.0 - F)}, "thin wall", angle);
    }
}

/* Diffuse reflection in the color of one side, transmission in its own; the same from below. */
static void a_leaf(void **state)
{
    (void)state;
    for (int is_below = 0; is_below < 2; is_below++) {
        scene_material m = truth_lambert(0.6f);
        m.extensions |= SCENE_DIFFUSE_TRANSMISSION;
        m.diffuse_transmission = 0.25f;
        for (int c = 0; c < 3; c++)
            m.diffuse_transmission_color[c] = 0.8f;
        m.is_double_sided = true;
        fixture f = truth_create();
        truth_set_sky(&f, 512, truth_sky_halves);
        truth_add_floor(&f, fixture_add_material(&f, m), 0.0f, 1000.0f);
        truth_set_camera(&f, is_below ? 150.0 : 30.0, 0.0f, 0.0f, 0.1f);
        f.desc.samples = 1024;
        truth_value v = truth_measure(&f, 16);
        truth_assert_channel(&v, is_below, 0.75 * 0.6, "leaf, its own side");
        truth_assert_channel(&v, !is_below, 0.25 * 0.8, "leaf, the other side");
        truth_assert_channel(&v, 2, 0.75 * 0.6 + 0.25 * 0.8, "leaf, both");
        fixture_destroy(&f);
    }
}

/* ---- mirrors ---- */

static void a_mirror_reflects_the_sky(void **state)
{
    (void)state;
    for (int angle = 0; angle <= 80; angle += 40) {
        fixture f = truth_create();
        truth_set_constant_sky(&f, 1.0f, 2.0f, 4.0f);
        truth_add_floor(&f, fixture_add_material(&f, truth_metal(0.9f, 0.5f, 0.2f, 0.0f)), 0.0f, 10.0f);
        truth_set_camera(&f, angle, 0.0f, 0.0f, 0.1f);
        truth_value v = truth_measure_pixels(&f);
        double cosine = cos(truth_radians(angle));
        truth_assert_channel(&v, 0, truth_schlick((double)0.9f, cosine), "mirror at %d degrees", angle);
        truth_assert_channel(&v, 1, 2.0 * truth_schlick(0.5, cosine), "mirror at %d degrees", angle);
        truth_assert_channel(&v, 2, 4.0 * truth_schlick((double)0.2f, cosine), "mirror at %d degrees", angle);
        assert_true(v.error[0] < 1e-6);
        fixture_destroy(&f);
    }
}

/* The emitter's radiance, for every sampling strategy. */
static void a_mirror_reflects_an_area_light(void **state)
{
    (void)state;
    for (int strategy = 0; strategy < 3; strategy++) {
        fixture f = truth_create();
        f.desc.path.light_sampling = (facet_light_sampling)strategy;
        truth_add_floor(&f, fixture_add_material(&f, truth_metal(0.8f, 0.8f, 0.8f, 0.0f)), 0.0f, 10.0f);
        truth_add_ceiling(&f, fixture_add_material(&f, truth_emitter(50.0f)), 2.0f, 6.0f);
        truth_set_camera(&f, 60.0, 0.0f, 0.0f, 0.1f);
        /* Nearer, below the light. */
        f.camera.eye[0] = 1.5f;
        f.camera.eye[1] = (float)(1.5 / tan(truth_radians(60.0)));
        truth_value v = truth_measure_pixels(&f);
        truth_assert_grey(&v, 50.0 * truth_schlick((double)0.8f, 0.5), "strategy %d", strategy);
        fixture_destroy(&f);
    }
}

/* Two mirrors face each other: light between them has been multiplied by F once per reflection. */
static void facing_mirrors(void **state)
{
    (void)state;
    double angle = truth_radians(30.0);
    fixture f = truth_create();
    truth_set_constant_sky(&f, 1.0f, 1.0f, 1.0f);
    uint32_t mirror = fixture_add_material(&f, truth_metal(0.9f, 0.7f, 0.3f, 0.0f));
    truth_add_floor(&f, mirror, 0.0f, 3.0f);
    truth_add_ceiling(&f, mirror, 1.0f, 3.0f);
    /* From x = 2.9 at y = 0.9 down and to -x. */
    f.camera = (facet_camera){.eye = {2.9f, 0.9f, 0.0f},
                              .target = {2.9f - (float)sin(angle), 0.9f - (float)cos(angle), 0.0f},
                              .ortho_height = 0.001f};
    int bounces = 0;
    for (double x = 2.9 - 0.9 * tan(angle); x > -3.0; x -= tan(angle))
        bounces++;
    assert_int_equal(bounces, 10);
    truth_value v = truth_measure_pixels(&f);
    truth_assert_channel(&v, 0, pow(truth_schlick((double)0.9f, cos(angle)), bounces), "10 mirrors");
    truth_assert_channel(&v, 1, pow(truth_schlick((double)0.7f, cos(angle)), bounces), "10 mirrors");
    truth_assert_channel(&v, 2, pow(truth_schlick((double)0.3f, cos(angle)), bounces), "10 mirrors");
    fixture_destroy(&f);
}

/* ---- caustics ---- */

/* In a room whose walls emit 1 - rho and reflect rho the radiance is 1 everywhere; glass and mirrors,
 * which absorb nothing, do not change that: the light that they remove from one place arrives at another,
 * by paths that only BSDF sampling finds. */
static void lossless_volumes_keep_the_energy_of_a_closed_room(void **state)
{
    (void)state;
    for (int strategy = 0; strategy < 3; strategy++) {
        fixture f = truth_create();
        f.desc.path.light_sampling = (facet_light_sampling)strategy;
        f.desc.path.max_depth = 400;
        scene_material wall = truth_lambert(0.6f);
        wall.emissive[0] = wall.emissive[1] = wall.emissive[2] = 0.4f;
        truth_add_box(&f, fixture_add_material(&f, wall), 0.0f, -3.0f, -3.0f, -3.0f);
        truth_add_flat_sphere(&f, fixture_add_material(&f, truth_glass(1.5f, 0.0f)), 24, -1.5f, 1.0f);
        truth_add_flat_sphere(&f, fixture_add_material(&f, truth_metal(1.0f, 1.0f, 1.0f, 0.0f)), 24, 1.5f,
                              1.0f);
        f.camera = (facet_camera){.eye = {2.5f, 0.5f, 2.0f}, .target = {0.0f, 0.0f, 0.0f}, .fov_y_rad = 1.4f};
        f.desc.width = f.desc.height = 16;
        f.desc.samples = 16;
        truth_value v = truth_measure(&f, 16);
        if (strategy == FACET_LIGHT_SAMPLING_LIGHTS)
            truth_assert_at_most(&v, 1.0, "lights only");
        truth_assert_grey(&v, 1.0, "strategy %d", strategy);
        fixture_destroy(&f);
    }
}

/* A square light over a floor, with a slab of glass between that is wider than both: the floor gets, from
 * each direction whose ray, moved aside by the slab, hits the light, L T(cos). Quadrature in double over
 * the hemisphere. */
static double irradiance_through_slab(double x, double half, double height, double thickness, double n)
{
    enum { STEPS = 1500 };
    double sum = 0.0;
    for (int i = 0; i < STEPS; i++)
        for (int k = 0; k < STEPS; k++) {
            /* The unit disc of projected solid angle. */
            double px = 2.0 * (i + 0.5) / STEPS - 1.0;
            double pz = 2.0 * (k + 0.5) / STEPS - 1.0;
            double sin2 = px * px + pz * pz;
            if (sin2 >= 0.9999)
                continue;
            double cosine = sqrt(1.0 - sin2);
            double inside = truth_refracted(cosine, n);
            /* Tangent per unit of sine: in air 1 / cos, in glass 1 / (n cos'). */
            double reach = (height - thickness) / cosine + thickness / (n * inside);
            if (fabs(x + px * reach) > half || fabs(pz * reach) > half)
                continue;
            double F = truth_fresnel(cosine, n);
            sum += (1.0 - F) / (1.0 + F);
        }
    return sum * 4.0 / ((double)STEPS * STEPS);
}

static void light_through_a_slab_on_a_floor(void **state)
{
    (void)state;
    double E = irradiance_through_slab(0.3, 0.5, 1.0, 0.4, 1.5);
    fixture f = truth_create();
    /* A patch so small that light which it reflects does not return to it. */
    truth_add_panel(&f, fixture_add_material(&f, truth_lambert(0.5f)), (float[3]){0.3f, 0.0f, 0.0f},
                    (float[3]){0.005f, 0.0f, 0.0f}, (float[3]){0.0f, 0.0f, -0.005f});
    truth_add_ceiling(&f, fixture_add_material(&f, truth_emitter(10.0f)), 1.0f, 0.5f);
    truth_add_box(&f, fixture_add_material(&f, truth_glass(1.5f, 0.0f)), 0.5f, 10.0f, 0.2f, 10.0f);
    f.camera =
        (facet_camera){.eye = {0.3f, 0.1f, 0.0f}, .ortho_height = 0.001f, .target = {0.3f, 0.0f, 0.0f}};
    f.desc.samples = 4096;
    truth_value v = truth_measure(&f, 16);
    truth_assert_grey(&v, 0.5 / TRUTH_PI * 10.0 * E, "through the slab");
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_slab_of_clear_glass_is_exact),
        cmocka_unit_test(an_absorbing_slab_is_exact),
        cmocka_unit_test(a_colored_slab),
        cmocka_unit_test(a_medium_without_a_boundary),
        cmocka_unit_test(a_glass_ball_in_a_furnace),
        cmocka_unit_test(a_slab_in_a_slab),
        cmocka_unit_test(volumes_of_equal_index_are_one),
        cmocka_unit_test(overlap_is_the_same_from_both_sides),
        cmocka_unit_test(a_rough_boundary_reflects),
        cmocka_unit_test(a_thin_wall),
        cmocka_unit_test(a_leaf),
        cmocka_unit_test(a_mirror_reflects_the_sky),
        cmocka_unit_test(a_mirror_reflects_an_area_light),
        cmocka_unit_test(facing_mirrors),
        cmocka_unit_test(lossless_volumes_keep_the_energy_of_a_closed_room),
        cmocka_unit_test(light_through_a_slab_on_a_floor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
