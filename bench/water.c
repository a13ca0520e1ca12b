/* water.c - nanoseconds per shade of a sea's surface: the legacy style, the physical model, and its parts.
 * Waves, sky and bed are looked up beforehand. Each line is the median of RUNS runs and its ratio to the
 * first line. */
#include <stdio.h>

#include "base/clock.h"
#include "median.h"

#include "shade/shade.h"

enum { COUNT = 1024, PASSES = 40, RUNS = 41 };

#if defined(__clang__)
#define COMPILER "clang " __clang_version__
#else
#define COMPILER "gcc " __VERSION__
#endif

/* Inputs of shading, as a renderer has them. */
typedef struct hit {
    vec3 N, V, slopes, sky, table; /* table: fresnel, escape, lift */
    float spread, y, sparkle, count;
    GlintCell cell;
} hit;
static hit hits[COUNT];
static vec3 shaded[COUNT];
static Water water;
static WaterLight light;

static void before(void)
{
    for (int i = 0; i < COUNT; ++i)
        shaded[i] =
            water_legacy_shade(WATER_LEGACY_INTENDED, WATER_LEGACY_STAGE_NONE, -hits[i].V, hits[i].N,
                               WATER_LEGACY_SUN_DIRECTION, hits[i].y, hits[i].sparkle, 0.1f, 1.33f, 0.1f);
}

static WaterPoint point_of(const hit *h)
{
    WaterPoint p;
    p.N = h->N;
    p.covariance = h->slopes;
    p.foam = 0.1f;
    return p;
}
static inline vec3 shade(const Water *w, const hit *h, float glint, vec3 below)
{
    WaterPoint p = point_of(h);
    WaterSpecular m = water_specular(*w, p, h->V, h->table[0], h->table[1], h->table[2], h->spread);
    vec3 sun = water_sun(*w, p, light, h->V) * glint;
    return water_radiance(water_parts(*w, p, light, m, h->sky * m.R[1], sun, below)) + m.perceptual_roughness;
}
static void physical(void)
{
    vec3 deep = water_from_deep(water, light.downwelling);
    for (int i = 0; i < COUNT; ++i)
        shaded[i] = shade(&water, &hits[i], 1.0f, deep);
}
static void physical_schlick(void)
{
    Water w = water;
    w.is_schlick = 1;
    vec3 deep = water_from_deep(water, light.downwelling);
    for (int i = 0; i < COUNT; ++i)
        shaded[i] = shade(&w, &hits[i], 1.0f, deep);
}
static void physical_glints(void)
{
    vec3 deep = water_from_deep(water, light.downwelling);
    for (int i = 0; i < COUNT; ++i)
        shaded[i] = shade(&water, &hits[i], glint_variate(hits[i].cell, hits[i].count, 1.0f, 0.02f), deep);
}
static void physical_bed(void)
{
    for (int i = 0; i < COUNT; ++i) {
        vec3 d = water_refracted(water, -hits[i].V, hits[i].N);
        WaterBed bed;
        bed.albedo = hits[i].sky;
        bed.mean_albedo = vec3(0.4f);
        bed.depth = 5.0f;
        bed.path_length = 5.0f / max(-d[1], 0.1f);
        shaded[i] = shade(&water, &hits[i], 1.0f, water_from_bed(water, light.downwelling, bed));
    }
}
static void sun_alone(void)
{
    for (int i = 0; i < COUNT; ++i)
        shaded[i] = water_sun(water, point_of(&hits[i]), light, hits[i].V);
}
static void glints_alone(void)
{
    for (int i = 0; i < COUNT; ++i)
        shaded[i] = vec3(glint_variate(hits[i].cell, hits[i].count, 1.0f, 0.02f));
}
static void cells_alone(void)
{
    for (int i = 0; i < COUNT; ++i)
        shaded[i] = vec3(glint_uniform(
            glint_cell(vec2(hits[i].y, hits[i].spread), vec2(0.01f, 0.03f), hits[i].count).key));
}
static void fit_alone(void)
{
    for (int i = 0; i < COUNT; ++i)
        shaded[i] = vec3(water_mean_fresnel_fit(hits[i].V[1], hits[i].spread, 1.34f));
}

/* Median nanoseconds per shade. */
static double measure(void (*kernel)(void))
{
    double runs[RUNS];
    for (int r = 0; r < RUNS; ++r) {
        double start = clock_seconds();
        for (int p = 0; p < PASSES; ++p) {
            kernel();
            __asm__ volatile("" ::"r"(shaded), "r"(hits) : "memory"); /* both are used */
        }
        runs[r] = (clock_seconds() - start) * 1e9 / ((double)PASSES * COUNT);
    }
    return median(runs, RUNS);
}

static uint32_t rng_state = 1;
static float uniform(void)
{
    rng_state = rng_state * 1664525u + 1013904223u;
    return (float)(rng_state >> 8u) / 16777216.0f;
}

/* A fresh breeze in the afternoon, chlorophyll 0.2 mg/m^3. */
static void prepare(void)
{
    water.ior = 1.34f;
    water.absorption = vec3(0.332f, 0.062f, 0.029f);
    water.scattering = vec3(0.095f, 0.114f, 0.142f);
    water.backscattering = vec3(0.0017f, 0.0027f, 0.0050f);
    water.reflectance = vec3(0.0f, 0.0064f, 0.0242f);
    water.pure_share = vec3(0.01f, 0.017f, 0.03f);
    water.sky_reflectance = 0.06f;
    water.foam_albedo = 0.4f;
    water.normals = WATER_BECKMANN;
    water.masking = WATER_SCALES;
    water.is_schlick = 0;
    light.L = WATER_LEGACY_SUN_DIRECTION;
    light.sun_irradiance = vec3(1e5f, 9e4f, 8e4f);
    light.sky_irradiance = vec3(1e4f, 1.2e4f, 1.6e4f);
    light.sun_fresnel = 0.03f;
    light.downwelling = water_downwelling(water, light);
    for (int i = 0; i < COUNT; ++i) {
        hit *h = &hits[i];
        float phi = 6.28f * uniform(), elevation = 0.02f + 0.9f * uniform();
        h->V = normalize(vec3(cos(phi), elevation, sin(phi)));
        h->N = normal_from_slope(vec2(0.3f * (uniform() - 0.5f), 0.3f * (uniform() - 0.5f)));
        h->slopes = vec3(0.01f + 0.01f * uniform(), 0.01f, 0.003f * uniform());
        h->sky = vec3(uniform(), uniform(), uniform());
        h->table = vec3(0.7f + 0.3f * uniform(), 0.9f, 0.1f * uniform());
        h->spread = 0.1f * uniform();
        h->y = uniform();
        h->sparkle = uniform();
        h->count = 0.1f + 20.0f * uniform();
        h->cell = glint_cell(vec2(h->y, h->spread), vec2(0.01f, 0.03f), h->count);
    }
}

int main(void)
{
    prepare();
    static const struct {
        const char *name;
        void (*kernel)(void);
    } lines[] = {{"before: Blinn and Phong", before},
                 {"physical", physical},
                 {"physical, Schlick's Fresnel", physical_schlick},
                 {"physical, with glints", physical_glints},
                 {"physical, with a bed", physical_bed},
                 {"of it: the sun in the facets", sun_alone},
                 {"of it: the glints' variate", glints_alone},
                 {"of it: the glints' cell", cells_alone},
                 {"Bruneton's fit, without a table", fit_alone}};
    printf("%s\n", COMPILER);
    double base = 0.0;
    for (size_t i = 0; i < sizeof lines / sizeof *lines; ++i) {
        double ns = measure(lines[i].kernel);
        base = i == 0 ? ns : base;
        printf("%-34s %7.2f ns  x %5.2f\n", lines[i].name, ns, ns / base);
    }
    return 0;
}
