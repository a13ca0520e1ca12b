/* fit_reference_test.c - the fits against an independent computation (numpy and scipy in double, separable
 * masking), whose tables are below. facet renders height-correlated masking: those errors are held to
 * limits of acceptance, and differ mostly at high roughness. */
#include <math.h>
#include <string.h>

#include "legacy/fit_test_support.h"
#include "legacy/classic_materials.h"
#include "legacy/fit_linear.h"
#include "legacy/fit_minimize.h"

static const double pi = 3.14159265358979323846;
/* Three digits, at most three decimals; 1e-4 more for the two quadratures. */
static double printed_to(double printed)
{
    return (printed >= 10.0 ? 0.05 : printed >= 1.0 ? 0.005 : 0.0005) + 1e-4 * (1.0 + printed);
}
#define assert_printed(value, printed) assert_near(value, printed, printed_to(printed))

/* A fit passes within 5 % + .003 of the tabulated one. */
static double passing(double printed)
{
    return 1.05 * printed + 0.003;
}

static ogl1_surface grey_ogl1(float diffuse, float specular, float shininess)
{
    return (ogl1_surface){{diffuse, diffuse, diffuse}, {specular, specular, specular}, shininess};
}

static ogl1_surface brighter(const ogl1_surface *s, float scale)
{
    ogl1_surface out = *s;
    for (int k = 0; k < 3; k++) {
        out.diffuse[k] *= scale;
        out.specular[k] *= scale;
    }
    return out;
}

/* ---- section 4: the vignette ---- */

typedef struct vignette_row {
    double phi_deg, ramp, step, ogl1;
} vignette_row;
static const vignette_row vignette[] = {
    {-80.0, 0.007525289, 0.025238578, 0.180955960}, {-60.0, 0.027461554, 0.056860585, 0.676680616},
    {-30.0, 0.059375451, 0.079167267, 1.866025404}, {0.0, 0.076865935, 0.085290877, 1.176680616},
    {30.0, 0.068560865, 0.079167267, 0.866777947},  {60.0, 0.037513180, 0.056860585, 0.500000030},
    {80.0, 0.011890705, 0.025238578, 0.173648178}};

/* White metal of roughness 1 at a view angle of 30 degrees, light in the same plane. ramp: as in the
 * vignette, D times N.H and G times (H.L) (H.V). */
static void vignette_at(double phi, double *step, double *ramp, double *ogl1, double shape[2], double s)
{
    pbr_surface pbr = pbr_surface_default();
    pbr.metallic = 1.0f;
    ogl1_surface old = grey_ogl1(1.0f, 1.0f, (float)s);
    float V[3] = {(float)sin(pi / 6.0), 0.0f, (float)cos(pi / 6.0)};
    float L[3] = {(float)sin(phi), 0.0f, (float)cos(phi)};
    float radiance[3];
    pbr_radiance(&pbr, PBR_SEPARABLE, V, L, radiance);
    double h = 0.5 * (phi + pi / 6.0);
    double VdotH = cos(h - pi / 6.0);
    *step = (double)radiance[0] / pi;
    *ramp = *step * cos(h) * VdotH * VdotH;
    ogl1_radiance(&old, V, L, radiance);
    *ogl1 = (double)radiance[0];
    shape[0] = cos(phi);
    shape[1] = *ogl1 - cos(phi);
}

static void values_match_the_vignette(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof vignette / sizeof *vignette; i++) {
        double step, ramp, ogl1, shape[2];
        vignette_at(vignette[i].phi_deg * pi / 180.0, &step, &ramp, &ogl1, shape, 50.0);
        assert_near(step, vignette[i].step, 1e-7);
        assert_near(ramp, vignette[i].ramp, 1e-7);
        assert_near(ogl1, vignette[i].ogl1, 1e-5); /* powf of a rounded cosine */
    }
}

typedef struct vignette_fit {
    bool is_ramp;
    double drawn; /* relative to PBR */
} vignette_fit;

/* RMS of pi PBR less the best OGL1 in the box, relative; x: log(1 + s). */
static double vignette_error(void *context, const double *x)
{
    vignette_fit *f = context;
    fit_moments m = {{0.0, 0.0, 0.0}, {0.0, 0.0}, 0.0};
    double drawn = 0.0;
    double source = 0.0;
    for (int deg = -80; deg <= 80; deg += 5) {
        double step, ramp, ogl1, shape[2];
        vignette_at(deg * pi / 180.0, &step, &ramp, &ogl1, shape, expm1(*x));
        double plain = f->is_ramp ? ramp : step;
        double T = pi * plain;
        drawn += (ogl1 - plain) * (ogl1 - plain);
        source += plain * plain;
        for (int i = 0; i < 2; i++)
            m.wanted[i] += shape[i] * T;
        m.shapes[0] += shape[0] * shape[0];
        m.shapes[1] += shape[0] * shape[1];
        m.shapes[2] += shape[1] * shape[1];
        m.square += T * T;
    }
    f->drawn = sqrt(drawn / source);
    double factor[2];
    static const fit_bounds box = {{0.0, 0.0}, {1.0, 1.0}};
    return sqrt(fmax(fit_box(&m, &box, factor), 0.0) / m.square);
}

/* "The hopeless case is a 4 % fit." */
static void the_hopeless_case_fits_to_4_percent(void **state)
{
    (void)state;
    for (int is_ramp = 0; is_ramp < 2; is_ramp++) {
        vignette_fit f = {.is_ramp = is_ramp};
        double x = log(51.0);
        vignette_error(&f, &x);
        assert_printed(f.drawn, is_ramp ? 18.6 : 14.4);
        double least = fit_minimize_1(vignette_error, &f, 0.0, log(129.0), 60, 1e-4, &x);
        assert_printed(least, is_ramp ? 0.094 : 0.038);
    }
}

/* ---- 6.1: PBR to OpenGL 1 ---- */

typedef struct pbr_row {
    float roughness, metallic, base[2]; /* red; green and blue */
    double vignette, raw, naive, box, shininess, Cd, Cs, unlimited, display;
} pbr_row;
static const pbr_row pbr_rows[] = {
    {.1f, 0, {.5f, .5f}, 1.23, 1.08, .969, .959, 128, .468, 1, .506, .094},
    {.2f, 0, {.5f, .5f}, 2.33, 1.55, .697, .603, 128, .467, 1, .368, .093},
    {.3f, 0, {.5f, .5f}, 2.96, 1.84, .386, .236, 128, .467, .961, .210, .082},
    {.4f, 0, {.5f, .5f}, 3.20, 1.95, .211, .122, 92.5, .486, .459, .122, .098},
    {.5f, 0, {.5f, .5f}, 3.34, 2.05, .109, .071, 39.1, .486, .184, .071, .071},
    {.6f, 0, {.5f, .5f}, 3.44, 2.15, .049, .040, 18.9, .486, .084, .040, .040},
    {.8f, 0, {.5f, .5f}, 3.58, 2.36, .071, .012, 5.7, .491, .017, .012, .012},
    {1, 0, {.5f, .5f}, 3.68, 2.53, .128, .003, 0, .489, .003, .003, .003},
    {.3f, 0, {.8f, .1f}, 2.90, 1.88, .418, .254, 128, .755, .960, .227, .105},
    {.5f, 0, {.8f, .1f}, 3.32, 2.09, .126, .077, 39.0, .774, .184, .077, .077},
    {.8f, 0, {.8f, .1f}, 3.55, 2.34, .069, .014, 5.4, .779, .016, .014, .014},
    {.2f, .5f, {.5f, .5f}, 1.05, .955, .976, .944, 101, .453, 1, .319, .150},
    {.5f, .5f, {.5f, .5f}, 2.98, .964, .525, .216, 36.0, .244, 1, .212, .139},
    {.8f, .5f, {.5f, .5f}, 5.75, 3.74, .529, .083, 6.6, .271, .094, .083, .083},
    {.1f, 1, {1, 1}, .999, .997, .999, .999, 128, 1, 1, .292, .397},
    {.2f, 1, {1, 1}, .986, .963, .988, .981, 71, 1, 1, .290, .282},
    {.4f, 1, {1, 1}, 1.15, .696, .902, .785, 27.8, .893, 1, .270, .218},
    {.6f, 1, {1, 1}, 2.56, .726, .510, .334, 15.9, .470, 1, .227, .140},
    {.8f, 1, {1, 1}, 5.48, 4.33, .753, .169, 6.7, .339, .334, .169, .169},
    {1, 1, {1, 1}, 10.7, 12.8, 3.44, .132, 0, .233, .064, .132, .132},
    {.6f, 1, {.8f, .1f}, 3.16, .723, .512, .284, 16.8, .311, 1, .231, .159},
    {.8f, 1, {.8f, .1f}, 6.64, 4.32, .751, .171, 6.7, .270, .269, .171, .171}};
enum { PBR_ROWS = sizeof pbr_rows / sizeof *pbr_rows };

/* The rows of metallic 0.5 follow the vignette, which mixes the parameters (F0 of .04 and base, diffuse (1
 * - m) base (1 - F)), not glTF, which mixes the reflectances. The former is a dielectric with that F0,
 * which ior 0 can state. */
static pbr_surface row_surface(const pbr_row *row)
{
    pbr_surface s = pbr_surface_default();
    s.perceptual_roughness = row->roughness;
    s.metallic = row->metallic;
    for (int k = 0; k < 3; k++)
        s.base_color[k] = row->base[k > 0];
    if (row->metallic > 0.0f && row->metallic < 1.0f) {
        s.metallic = 0.0f;
        s.ior = 0.0f;
        for (int k = 0; k < 3; k++) {
            s.specular_color[k] = 0.04f * (1.0f - row->metallic) + row->metallic * s.base_color[k];
            s.base_color[k] *= 1.0f - row->metallic;
        }
    }
    return s;
}

static double E_of(const fit_metric *metric, const ogl1_surface *ogl1, const pbr_surface *pbr)
{
    return fit_compare(metric, ogl1, pbr, FIT_FROM_PBR).E;
}

/* Without the factor pi the legacy material is pi times too bright. */
static void errors_without_pi_match_the_table(void **state)
{
    (void)state;
    for (int i = 0; i < PBR_ROWS; i++) {
        const pbr_row *row = &pbr_rows[i];
        pbr_surface pbr = row_surface(row);
        ogl1_surface drawn = grey_ogl1(0.0f, (float)pi, 50.0f);
        for (int k = 0; k < 3; k++)
            drawn.diffuse[k] = (float)pi * row->base[k > 0];
        assert_printed(E_of(separable, &drawn, &pbr), row->vignette);
        ogl1_surface naive;
        pbr_to_ogl1_naive(&pbr, &naive);
        assert_printed(E_of(separable, &naive, &pbr), row->naive);
        naive = brighter(&naive, (float)pi);
        assert_printed(E_of(separable, &naive, &pbr), row->raw);
    }
}

static void fits_of_pbr_match_the_table(void **state)
{
    (void)state;
    for (int i = 0; i < PBR_ROWS; i++) {
        const pbr_row *row = &pbr_rows[i];
        pbr_surface pbr = row_surface(row);
        ogl1_surface box;
        ogl1_surface unlimited;
        ogl1_surface display;
        pbr_to_ogl1_fit(separable, &pbr, FACET_LEGACY_TARGET_LINEAR, FIT_DISPLAYABLE, &box);
        pbr_to_ogl1_fit(separable, &pbr, FACET_LEGACY_TARGET_LINEAR, FIT_UNLIMITED, &unlimited);
        pbr_to_ogl1_fit(separable, &pbr, FACET_LEGACY_TARGET_DISPLAY, FIT_DISPLAYABLE, &display);
        assert_printed(E_of(separable, &box, &pbr), row->box);
        assert_printed(E_of(separable, &unlimited, &pbr), row->unlimited);
        assert_near(box.shininess, row->shininess, 0.01 * row->shininess + 0.05);
        assert_near(box.diffuse[0], row->Cd, 0.0011);
        assert_near(box.specular[0], row->Cs, 0.0011);
        /* Kinks again; the white metal of roughness 0.2 is .008 better here than the tabulated simplex. */
        double E_display = fit_compare(separable, &display, &pbr, FIT_FROM_PBR).E_display;
        assert_true(E_display <= row->display + 0.0016);
        assert_true(E_display >= row->display - 0.0085);
    }
}

/* With height-correlated masking the same materials are fitted as well, except white metal of roughness 1:
 * GGX is flatter there, and further from a cosine lobe: .158 instead of .132, the optimum. */
static void fits_with_correlated_masking_are_as_good(void **state)
{
    (void)state;
    double sum[2] = {0.0, 0.0};
    double worst = 0.0;
    for (int i = 0; i < PBR_ROWS; i++) {
        const pbr_row *row = &pbr_rows[i];
        pbr_surface pbr = row_surface(row);
        ogl1_surface box;
        pbr_to_ogl1_fit(correlated, &pbr, FACET_LEGACY_TARGET_LINEAR, FIT_DISPLAYABLE, &box);
        double E = E_of(correlated, &box, &pbr);
        bool is_roughest_metal = row->roughness == 1.0f && row->metallic == 1.0f;
        if (is_roughest_metal)
            assert_near(E, 0.158, 0.001);
        else
            assert_true(E <= passing(row->box));
        sum[0] += row->box;
        sum[1] += E;
        worst = fmax(worst, fabs(E - row->box));
    }
    print_message("mean E: separable %.4f, correlated %.4f; largest difference %.4f\n", sum[0] / PBR_ROWS,
                  sum[1] / PBR_ROWS, worst);
}

/* ---- 6.2: OpenGL 1 to PBR ---- */

typedef struct ogl1_row {
    float Cs, shininess;
    double dim, naive, core, fit, emissive;
    double roughness, base, specular; /* 0: not tabulated */
} ogl1_row;
static const ogl1_row ogl1_rows[] = {{.1f, 8, .711, .098, .035, .030, .030, .668, .545, .073},
                                     {.1f, 32, .682, .089, .038, .020, .020, .515, .511, .026},
                                     {.1f, 128, .670, .291, .035, .011, .011, .367, .502, .0065},
                                     {.5f, 1, .857, .554, .169, .166, .056, 0, 0, 0},
                                     {.5f, 4, .830, .473, .114, .114, .103, .691, 1, .5},
                                     {.5f, 8, .807, .407, .105, .103, .103, .668, .831, .367},
                                     {.5f, 16, .777, .324, .099, .093, .093, .595, .646, .237},
                                     {.5f, 32, .741, .225, .098, .081, .081, .515, .562, .130},
                                     {.5f, 64, .707, .137, .103, .067, .067, .436, .527, .066},
                                     {.5f, 128, .682, .178, .111, .052, .052, .367, .513, .033},
                                     {1, 1, .908, .714, .434, .433, .088, 0, 0, 0},
                                     {1, 8, .867, .591, .207, .206, .158, .560, 1, .332},
                                     {1, 16, .839, .517, .142, .139, .139, .595, .923, .474},
                                     {1, 32, .802, .419, .140, .129, .129, .515, .646, .260},
                                     {1, 64, .757, .295, .143, .114, .114, .436, .559, .132},
                                     {1, 128, .712, .184, .151, .095, .095, .367, .526, .065}};
enum { OGL1_ROWS = sizeof ogl1_rows / sizeof *ogl1_rows };

static double E_to(const fit_metric *metric, const ogl1_surface *ogl1, const pbr_surface *pbr)
{
    return fit_compare(metric, ogl1, pbr, FIT_FROM_OGL1).E;
}

/* Naive: the light of OpenGL 1 unchanged, and times pi. */
static void naive_conversions_match_the_table(void **state)
{
    (void)state;
    for (int i = 0; i < OGL1_ROWS; i++) {
        const ogl1_row *row = &ogl1_rows[i];
        ogl1_surface ogl1 = grey_ogl1(0.5f, row->Cs, row->shininess);
        ogl1_surface bright = brighter(&ogl1, (float)pi);
        pbr_surface naive;
        ogl1_to_pbr_naive(&ogl1, &naive);
        assert_printed(E_to(separable, &ogl1, &naive), row->naive);
        assert_printed(E_to(separable, &bright, &naive), row->dim);
    }
}

/* The optima agree to the last digit, with the same parameters. At Cs .5, s 4 the table has a specular
 * factor of .5, the fit .354: E hardly changes between F90 = F0 and F90 = .5 with an F0 of .33. */
static void fits_of_ogl1_match_the_table(void **state)
{
    (void)state;
    for (int i = 0; i < OGL1_ROWS; i++) {
        const ogl1_row *row = &ogl1_rows[i];
        ogl1_surface ogl1 = grey_ogl1(0.5f, row->Cs, row->shininess);
        pbr_surface fit;
        pbr_surface core;
        ogl1_to_pbr_fit(separable, &ogl1, FACET_LEGACY_TARGET_LINEAR, &fit);
        ogl1_to_pbr_core_fit(separable, &ogl1, FACET_LEGACY_TARGET_LINEAR, &core);
        assert_printed(E_to(separable, &ogl1, &fit), row->fit);
        assert_printed(E_to(separable, &ogl1, &core), row->core);
        if (row->roughness > 0.0) {
            assert_near(fit.perceptual_roughness, row->roughness, 0.0016);
            assert_near(fit.base_color[0], row->base, 0.0016);
            if (row->shininess > 4.0f)
                assert_near(fit.specular, row->specular, 0.001);
        }
        ogl1_to_pbr_fit(correlated, &ogl1, FACET_LEGACY_TARGET_LINEAR, &fit);
        ogl1_to_pbr_core_fit(correlated, &ogl1, FACET_LEGACY_TARGET_LINEAR, &core);
        assert_true(E_to(correlated, &ogl1, &fit) <= passing(row->fit));
        assert_true(E_to(correlated, &ogl1, &core) <= passing(row->core));
    }
    ogl1_surface ogl1 = grey_ogl1(0.5f, 0.5f, 4.0f);
    pbr_surface printed = pbr_surface_default();
    printed.ior = 0.0f;
    printed.perceptual_roughness = 0.691f;
    printed.specular = 0.5f;
    for (int k = 0; k < 3; k++)
        printed.specular_color[k] = 0.66f;
    assert_printed(E_to(separable, &ogl1, &printed), 0.114);
}

/* A constant beside both: base (1 - F) n + F S + emission, constant F, for grey. x: roughness, F, twice the
 * emission: the tabulated errors are for at most .5 (without that limit Cs 1, s 1 has .073, not .088). */
typedef struct emissive_fit {
    float source[FIT_MAX_NODES], lobe[FIT_MAX_NODES];
    double square;
} emissive_fit;

static double emissive_error(void *context, const double *x)
{
    emissive_fit *f = context;
    fit_specular_lobe(separable, (float)x[0], f->lobe);
    fit_moments m = {{0.0, 0.0, 0.0}, {0.0, 0.0}, 0.0};
    for (size_t i = 0; i < separable->node_begin[FIT_VIEWS]; i++) {
        double w = (double)separable->weight[i];
        double shape = (1.0 - x[1]) * (double)separable->NdotL[i];
        double T = (double)f->source[i] - x[1] * (double)f->lobe[i] - 0.5 * x[2];
        m.shapes[0] += w * shape * shape;
        m.wanted[0] += w * shape * T;
        m.square += w * T * T;
    }
    static const fit_bounds base = {{0.0, 0.0}, {1.0, 0.0}};
    double factor[2];
    return sqrt(fmax(fit_box(&m, &base, factor), 0.0) / f->square);
}

/* With emission; conversions add no emission, so this is in the test only. */
static void fits_with_emission_match_the_table(void **state)
{
    (void)state;
    for (int i = 0; i < OGL1_ROWS; i++) {
        emissive_fit f;
        ogl1_surface ogl1 = grey_ogl1(0.5f, ogl1_rows[i].Cs, ogl1_rows[i].shininess);
        fit_highlight(separable, ogl1.shininess, f.lobe);
        fit_radiance_ogl1(separable, &ogl1, f.lobe, 0, f.source);
        f.square = 0.0;
        for (size_t n = 0; n < separable->node_begin[FIT_VIEWS]; n++)
            f.square += (double)separable->weight[n] * (double)f.source[n] * (double)f.source[n];
        pbr_surface start;
        ogl1_to_pbr_closed(&ogl1, &start);
        double least = (double)INFINITY;
        for (int emissive = 0; emissive < 2; emissive++) {
            double x[3] = {(double)start.perceptual_roughness, (double)start.specular, 0.6 * emissive};
            static const double step[3] = {0.1, 0.1, 0.1};
            fit_minimize_n(emissive_error, &f, 3, x, step, 1e-7, 300);
            least = fmin(least, fit_minimize_n(emissive_error, &f, 3, x, step, 1e-7, 300));
        }
        assert_printed(least, ogl1_rows[i].emissive);
    }
}

/* Optimal roughness, and share of Cs that becomes F0, by the exponent alone. */
typedef struct exponent_row {
    float shininess;
    double roughness, share; /* 0: not tabulated */
} exponent_row;
static const exponent_row exponent_rows[] = {
    {2, .816, 0},      {3, .764, 0},      {4, .734, .951},   {6, .696, .833},   {8, .668, .733},
    {10, .646, .652},  {12, .626, .579},  {16, .596, .476},  {20, .570, .396},  {24, .548, .337},
    {32, .514, .259},  {40, .488, .209},  {50, .464, .169},  {64, .436, .131},  {80, .412, .105},
    {100, .390, .084}, {128, .366, .065}, {200, .328, .042}, {400, .276, .021}, {1000, .218, .0082}};

/* The residual of (N.H)^s with n and S; x: roughness. */
typedef struct nearest_fit {
    float highlight[FIT_MAX_NODES], lobe[FIT_MAX_NODES];
    double factor[2];
} nearest_fit;

static double nearest_error(void *context, const double *x)
{
    nearest_fit *f = context;
    fit_moments m = {{0.0, 0.0, 0.0}, {0.0, 0.0}, 0.0};
    fit_specular_lobe(separable, (float)*x, f->lobe);
    for (size_t i = 0; i < separable->node_begin[FIT_VIEWS]; i++) {
        double w = (double)separable->weight[i];
        double n = (double)separable->NdotL[i];
        double S = (double)f->lobe[i];
        double T = (double)f->highlight[i];
        m.shapes[0] += w * n * n;
        m.shapes[1] += w * n * S;
        m.shapes[2] += w * S * S;
        m.wanted[0] += w * n * T;
        m.wanted[1] += w * S * T;
        m.square += w * T * T;
    }
    static const fit_bounds unbounded = {{-1e6, -1e6}, {1e6, 1e6}};
    return fit_box(&m, &unbounded, f->factor);
}

/* The LUT of the closed forms has height-correlated masking: within 2 % in roughness, and from s = 10 on
 * within 3 % in strength; below that up to 7 % less, since the lobe is brighter. */
static void closed_forms_match_the_table_of_exponents(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof exponent_rows / sizeof *exponent_rows; i++) {
        const exponent_row *row = &exponent_rows[i];
        nearest_fit f;
        double r;
        fit_highlight(separable, row->shininess, f.highlight);
        fit_minimize_1(nearest_error, &f, 0.1, 1.0, 40, 1e-4, &r);
        assert_near(r, row->roughness, 0.0016);
        assert_near(perceptual_roughness_from_shininess(row->shininess), row->roughness,
                    0.012 * row->roughness);
        if (row->share > 0.0) {
            double slack = row->shininess > 9.0f ? 0.03 : 0.07;
            assert_near(f.factor[1], row->share, 0.0055 * row->share + 0.0005);
            assert_near(reflectance_share_from_shininess(row->shininess), row->share,
                        slack * row->share + 0.0005);
        }
    }
}

/* ---- section 11: the classics ---- */

/* The closed form by formulas instead of the LUT. */
static void closed_by_formulas(const ogl1_surface *in, pbr_surface *out)
{
    float brightest = fmaxf(in->specular[0], fmaxf(in->specular[1], in->specular[2]));
    ogl1_to_pbr_naive(in, out);
    out->ior = 0.0f;
    out->specular = fminf(1.0f, brightest * 8.0f / (in->shininess + 2.0f));
    for (int k = 0; k < 3; k++) {
        float share = 1.0f - out->specular;
        out->specular_color[k] = brightest > 0.0f ? in->specular[k] / brightest : 1.0f;
        out->base_color[k] = share > 0.0f ? fminf(1.0f, in->diffuse[k] / share) : 1.0f;
    }
}

/* MTL's matte material is tabulated with .001 for formulas that are exact there: Cs of 0 leaves base = Cd. */
static void formulas_of_classic_materials_match_the_table(void **state)
{
    (void)state;
    double naive = 0.0;
    double closed = 0.0;
    for (int i = 0; i < CLASSIC_COUNT; i++) {
        const classic_material *c = &classic_materials[i];
        pbr_surface pbr;
        ogl1_to_pbr_naive(&c->surface, &pbr);
        double E = E_to(separable, &c->surface, &pbr);
        assert_printed(E, c->naive);
        naive += i < CLASSIC_USUAL ? E : 0.0;
        closed_by_formulas(&c->surface, &pbr);
        E = E_to(separable, &c->surface, &pbr);
        if (c->surface.specular[0] > 0.0f)
            assert_printed(E, c->closed);
        else
            assert_near(E, 0.0, 1e-6);
        closed += i < CLASSIC_USUAL ? E : 0.0;
    }
    assert_printed(naive / CLASSIC_USUAL, 0.278);
    assert_printed(closed / CLASSIC_USUAL, 0.100);
}

/* The optimum with separable masking to the last digit; with that of facet within the limits. */
static void fits_of_classic_materials_match_the_table(void **state)
{
    (void)state;
    double mean[2][2] = {{0.0, 0.0}, {0.0, 0.0}};
    for (int i = 0; i < CLASSIC_COUNT; i++)
        for (int j = 0; j < 2; j++) {
            const classic_material *c = &classic_materials[i];
            const fit_metric *metric = j ? correlated : separable;
            pbr_surface pbr;
            ogl1_to_pbr_fit(metric, &c->surface, FACET_LEGACY_TARGET_LINEAR, &pbr);
            double fit = E_to(metric, &c->surface, &pbr);
            ogl1_to_pbr_core_fit(metric, &c->surface, FACET_LEGACY_TARGET_LINEAR, &pbr);
            double core = E_to(metric, &c->surface, &pbr);
            assert_true(fit <= passing(c->fit) && core <= passing(c->core));
            if (metric == separable) {
                assert_printed(fit, c->fit);
                assert_printed(core, c->core);
            }
            mean[j][0] += i < CLASSIC_USUAL ? fit / CLASSIC_USUAL : 0.0;
            mean[j][1] += i < CLASSIC_USUAL ? core / CLASSIC_USUAL : 0.0;
        }
    print_message("mean E of fits: separable %.4f, core %.4f; correlated %.4f, core %.4f\n", mean[0][0],
                  mean[0][1], mean[1][0], mean[1][1]);
    assert_printed(mean[0][0], 0.097);
    assert_printed(mean[0][1], 0.128);
    assert_near(mean[1][0], 0.0977, 0.0001); /* no surface of this kind comes nearer: fit_property_test.c */
    assert_near(mean[1][1], 0.1282, 0.0001);
}

/* facet's closed forms, within the limit of 10 % + .005, and better on average than the formulas and the
 * table (.099). */
static void closed_forms_of_classic_materials_are_within_limits(void **state)
{
    (void)state;
    double mean = 0.0;
    double mean_core = 0.0;
    for (int i = 0; i < CLASSIC_COUNT; i++) {
        const classic_material *c = &classic_materials[i];
        pbr_surface pbr;
        ogl1_to_pbr_closed(&c->surface, &pbr);
        double E = E_to(correlated, &c->surface, &pbr);
        assert_true(E <= 1.1 * c->closed + 0.005);
        assert_true(E_to(separable, &c->surface, &pbr) <= 1.1 * c->closed + 0.005);
        mean += i < CLASSIC_USUAL ? E / CLASSIC_USUAL : 0.0;
        ogl1_to_pbr_core_closed(&c->surface, &pbr);
        E = E_to(correlated, &c->surface, &pbr);
        assert_true(E <= passing(c->core));
        mean_core += i < CLASSIC_USUAL ? E / CLASSIC_USUAL : 0.0;
    }
    print_message("mean E of closed forms: %.4f, core %.4f\n", mean, mean_core);
    assert_true(mean < 0.099);
    assert_true(mean_core < 0.1285);
}

/* The LUT adds no error: E of the box fits again. */
static void closed_forms_of_pbr_equal_the_fit(void **state)
{
    (void)state;
    for (int i = 0; i < PBR_ROWS; i++) {
        pbr_surface pbr = row_surface(&pbr_rows[i]);
        ogl1_surface fit;
        ogl1_surface closed;
        pbr_to_ogl1_fit(correlated, &pbr, FACET_LEGACY_TARGET_LINEAR, FIT_DISPLAYABLE, &fit);
        pbr_to_ogl1_closed(&pbr, &closed);
        assert_near(E_of(correlated, &closed, &pbr), E_of(correlated, &fit, &pbr), 2e-4);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_match_the_vignette),
        cmocka_unit_test(the_hopeless_case_fits_to_4_percent),
        cmocka_unit_test(errors_without_pi_match_the_table),
        cmocka_unit_test(fits_of_pbr_match_the_table),
        cmocka_unit_test(fits_with_correlated_masking_are_as_good),
        cmocka_unit_test(naive_conversions_match_the_table),
        cmocka_unit_test(fits_of_ogl1_match_the_table),
        cmocka_unit_test(fits_with_emission_match_the_table),
        cmocka_unit_test(closed_forms_match_the_table_of_exponents),
        cmocka_unit_test(formulas_of_classic_materials_match_the_table),
        cmocka_unit_test(fits_of_classic_materials_match_the_table),
        cmocka_unit_test(closed_forms_of_classic_materials_are_within_limits),
        cmocka_unit_test(closed_forms_of_pbr_equal_the_fit),
    };
    return cmocka_run_group_tests(tests, fit_test_setup, fit_test_teardown);
}
