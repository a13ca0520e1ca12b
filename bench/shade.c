/* shade.c - nanoseconds per evaluation of the shader library: the whole surface, one hit at a time, and the
 * scalar terms, one at a time and in vectorisable loops over arrays of float. Each line is the median of RUNS
 * runs and its speedup over the line that it is compared with. bench/shade.sh runs it with gcc and clang. */
#include <stdio.h>

#include "base/clock.h"
#include "median.h"

#include "shade/shade.h"

enum { COUNT = 1024, PASSES = 100, RUNS = 41 }; /* 1024 samples stay in the first-level cache */

#if defined(__clang__)
#define COMPILER "clang " __clang_version__
#define SCALAR_LOOP _Pragma("clang loop vectorize(disable) interleave(disable)")
#define SCALAR_FUNCTION
#else
#define COMPILER "gcc " __VERSION__
#define SCALAR_LOOP
#define SCALAR_FUNCTION __attribute__((optimize("no-tree-vectorize")))
#endif
#if defined(__x86_64__)
#define CLONES __attribute__((target_clones("avx2", "default")))
#else
#define CLONES
#endif

/* ---- the surface, one hit at a time ---- */

typedef struct hit {
    Surface surface;
    vec3 V, L;
} hit;
static hit hits[COUNT];
static vec3 shaded[COUNT];

static __attribute__((noinline)) vec3 evaluate_once(const hit *h)
{
    return surface_brdf_cos(h->surface, h->V, h->L);
}
static void surface_by_call(void)
{
    for (int i = 0; i < COUNT; ++i)
        shaded[i] = evaluate_once(&hits[i]);
}
static void surface_inlined(void)
{
    for (int i = 0; i < COUNT; ++i)
        shaded[i] = surface_brdf_cos(hits[i].surface, hits[i].V, hits[i].L);
}
static void surface_conserving(void)
{
    for (int i = 0; i < COUNT; ++i)
        shaded[i] = surface_brdf_cos_energy(hits[i].surface, hits[i].V, hits[i].L, ENERGY_CONSERVING,
                                            vec2(0.7f, 0.1f));
}
static void surface_image_based(void)
{
    for (int i = 0; i < COUNT; ++i)
        shaded[i] =
            surface_ibl(hits[i].surface, hits[i].L[2], vec2(0.7f, 0.1f), hits[i].V, hits[i].L, ENERGY_GLTF);
}
static void visible_normals(void)
{
    for (int i = 0; i < COUNT; ++i)
        shaded[i] = mul(basis_from_normal(hits[i].surface.N),
                        sample_VNDF_GGX(vec2(hits[i].surface.base_color[0], hits[i].surface.base_color[1]),
                                        hits[i].V, hits[i].surface.alpha, hits[i].surface.alpha));
}

/* ---- terms over arrays ---- */

typedef struct cosines {
    _Alignas(64) float NdotL[COUNT], NdotV[COUNT], NdotH[COUNT], VdotH[COUNT], alpha[COUNT];
} cosines;
static cosines in;
static _Alignas(64) float out[COUNT];

static inline float term_DV(const cosines *c, int i)
{
    return D_GGX(c->NdotH[i], c->alpha[i]) * V_SmithGGX(c->NdotL[i], c->NdotV[i], c->alpha[i]);
}
static inline float term_DVF(const cosines *c, int i)
{
    return term_DV(c, i) * F_Schlick1(0.04f, 1.0f, c->VdotH[i]);
}
/* Lambert under a dielectric: the glTF mix for one channel. */
static inline float term_mix(const cosines *c, int i)
{
    float F = F_Schlick1(0.04f, 1.0f, c->VdotH[i]);
    return (F * term_DV(c, i) + (1.0f - F) * 0.8f * INV_PI) * c->NdotL[i];
}

#define LOOPS(term)                                                                                          \
    SCALAR_FUNCTION static void term##_scalar(void)                                                          \
    {                                                                                                        \
        SCALAR_LOOP                                                                                          \
        for (int i = 0; i < COUNT; ++i)                                                                      \
            out[i] = term(&in, i);                                                                           \
    }                                                                                                        \
    static void term##_loop(void)                                                                            \
    {                                                                                                        \
        for (int i = 0; i < COUNT; ++i)                                                                      \
            out[i] = term(&in, i);                                                                           \
    }                                                                                                        \
    CLONES static void term##_clones(void)                                                                   \
    {                                                                                                        \
        for (int i = 0; i < COUNT; ++i)                                                                      \
            out[i] = term(&in, i);                                                                           \
    }

LOOPS(term_DV)
LOOPS(term_DVF)
LOOPS(term_mix)

/* ---- measuring ---- */

/* Median nanoseconds per sample. */
static double measure(void (*kernel)(void))
{
    double runs[RUNS];
    for (int r = 0; r < RUNS; ++r) {
        double start = clock_seconds();
        for (int p = 0; p < PASSES; ++p) {
            kernel();
            __asm__ volatile("" ::"r"(shaded), "r"(out), "r"(hits), "r"(&in)
                             : "memory"); /* in and out are used */
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
static vec3 direction(void) /* above the horizon */
{
    float z = 0.05f + 0.95f * uniform(), phi = 2.0f * PI * uniform();
    float r = sqrt(max(1.0f - z * z, 0.0f));
    return vec3(r * cos(phi), r * sin(phi), z);
}

int main(void)
{
    for (int i = 0; i < COUNT; ++i) {
        float r = uniform(), g = uniform(), b = uniform();
        hits[i].V = direction();
        hits[i].L = direction();
        hits[i].surface = surface_from_metallic_roughness(vec3(0.0f, 0.0f, 1.0f), vec3(r, g, b), uniform(),
                                                          0.05f + 0.95f * uniform());
        in.NdotL[i] = 0.05f + 0.95f * uniform();
        in.NdotV[i] = 0.05f + 0.95f * uniform();
        in.NdotH[i] = uniform();
        in.VdotH[i] = uniform();
        in.alpha[i] = 0.05f + 0.95f * uniform();
    }
    static const struct {
        const char *name;
        void (*kernel)(void);
        bool starts_group; /* the lines below are compared with this one */
    } lines[] = {{"surface_brdf_cos, call per hit", surface_by_call, true},
                 {"surface_brdf_cos, inlined", surface_inlined, false},
                 {"surface_brdf_cos_energy, conserving", surface_conserving, false},
                 {"surface_ibl", surface_image_based, false},
                 {"sample_VNDF_GGX with its basis", visible_normals, false},
                 {"D V, scalar", term_DV_scalar, true},
                 {"D V, loop, build's instruction set", term_DV_loop, false},
                 {"D V, loop, dispatched", term_DV_clones, false},
                 {"D V F, scalar", term_DVF_scalar, true},
                 {"D V F, loop, build's instruction set", term_DVF_loop, false},
                 {"D V F, loop, dispatched", term_DVF_clones, false},
                 {"glTF mix of one channel, scalar", term_mix_scalar, true},
                 {"glTF mix of one channel, loop", term_mix_loop, false},
                 {"glTF mix of one channel, dispatched", term_mix_clones, false}};
    printf("%s\n", COMPILER);
    double base = 1.0;
    for (size_t i = 0; i < sizeof lines / sizeof *lines; ++i) {
        double ns = measure(lines[i].kernel);
        base = lines[i].starts_group ? ns : base;
        printf("%-38s %7.2f ns  x %5.2f\n", lines[i].name, ns, base / ns);
    }
    return 0;
}
