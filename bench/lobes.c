/* lobes.c - nanoseconds per path vertex in the shader library, one thread, LUT values given: lobe
 * probabilities, a sampled direction with its density, its value, and for light samples value and density of
 * another direction.
 *
 *     lobes [RUNS]     default: 21; prints minima of CPU time */
#include <stdio.h>
#include <stdlib.h>

#include "median.h"

#include "shade/shade.h"

enum { COUNT = 512, PASSES = 40 };

typedef struct vertex {
    Layers m;
    LayerTables t;
    LayersLobes p;
    vec3 V, L;
    float u_lobe;
    vec2 u;
} vertex;

static vertex vertices[COUNT];
static vec3 directions[COUNT];
static volatile float sink;

/* ---- surfaces ---- */

static Layers plain(float metallic)
{
    Layers m = layers_from_surface(
        surface_from_metallic_roughness(vec3(0.0f, 0.0f, 1.0f), vec3(0.8f, 0.5f, 0.3f), metallic, 0.4f));
    m.clearcoat = 1.0f;
    m.clearcoat_roughness = 0.2f;
    m.sheen_color = vec3(0.8f);
    m.sheen_roughness = 0.5f;
    m.anisotropy = 0.7f;
    m.iridescence = 1.0f;
    m.iridescence_thickness_nm = 400.0f;
    m.transmission = 1.0f;
    m.diffuse_transmission = 0.5f;
    return m;
}

static void fill(Layers m)
{
    for (uint i = 0; i < COUNT; ++i) {
        vertex *v = &vertices[i];
        vec2 u = hammersley(i, COUNT);
        v->V = sample_cosine(vec2(u[1], u[0]) * 0.98f + 0.01f);
        v->L = sample_cosine(u);
        if (i % 2 && m.layers & (LAYER_TRANSMISSION | LAYER_DIFFUSE_TRANSMISSION))
            v->L = -v->L;
        v->m = m;
        if (m.layers & LAYER_VOLUME && i % 2)
            v->m.eta = 1.0f / m.eta;
        vec3 glass = vec3(0.0f);
        if (layers_is_exact(m, ENERGY_CONSERVING))
            glass = integrate_glass(m.base.perceptual_roughness, v->V[2], layers_fresnel_eta(v->m), 256u);
        v->t =
            layer_tables(v->m, v->V, ENERGY_CONSERVING,
                         integrate_dfg(m.base.perceptual_roughness, v->V[2], 64u), 0.95f, 0.9f, 0.3f, glass);
        v->p = layers_lobes(v->m, v->V, ENERGY_CONSERVING, v->t);
        v->u_lobe = radical_inverse(i * 7919u);
        v->u = vec2(radical_inverse(i * 104729u), u[0]);
    }
}

/* ---- measured functions ---- */

static __attribute__((noinline)) LayersLobes lobes_of(const vertex *v)
{
    return layers_lobes(v->m, v->V, ENERGY_CONSERVING, v->t);
}
static __attribute__((noinline)) LayersSample sample_of(const vertex *v)
{
    return layers_sample(v->m, v->p, v->V, v->u_lobe, v->u, ENERGY_CONSERVING, v->t);
}
static __attribute__((noinline)) vec3 value_of(const vertex *v, vec3 L)
{
    return layers_scatter_cos(v->m, v->V, L, ENERGY_CONSERVING, v->t, 0.3f);
}
static __attribute__((noinline)) float pdf_of(const vertex *v, vec3 L)
{
    return layers_pdf(v->m, v->p, v->V, L);
}

static float run(int what)
{
    float sum = 0.0f;
    for (int i = 0; i < COUNT; ++i) {
        const vertex *v = &vertices[i];
        if (what == 0)
            sum += lobes_of(v).diffuse;
        else if (what == 1) {
            LayersSample s = sample_of(v);
            directions[i] = s.L;
            sum += s.pdf;
        } else if (what == 2)
            sum += value_of(v, directions[i])[0];
        else
            sum += value_of(v, v->L)[0] + pdf_of(v, v->L);
    }
    return sum;
}

static double measure(int what, int runs)
{
    double least = HUGE_VAL;
    for (int r = 0; r < runs; ++r) {
        double start = cpu_seconds();
        for (int pass = 0; pass < PASSES; ++pass)
            sink = run(what);
        least = fmin(least, 1e9 * (cpu_seconds() - start) / ((double)COUNT * PASSES));
    }
    return least;
}

int main(int argc, char **argv)
{
    int runs = argc > 1 ? atoi(argv[1]) : 21;
    static const struct {
        const char *name;
        uint layers;
        float metallic, roughness;
    } rows[] = {{"plain dielectric", 0u, 0.0f, 0.4f},
                {"metal", 0u, 1.0f, 0.4f},
                {"mirror", 0u, 1.0f, 0.0f},
                {"clearcoat", LAYER_CLEARCOAT, 0.0f, 0.4f},
                {"sheen", LAYER_SHEEN, 0.0f, 0.4f},
                {"iridescence", LAYER_IRIDESCENCE, 0.0f, 0.4f},
                {"anisotropy", LAYER_ANISOTROPY, 0.0f, 0.4f},
                {"diffuse transmission", LAYER_DIFFUSE_TRANSMISSION, 0.0f, 0.4f},
                {"thin wall, rough", LAYER_TRANSMISSION, 0.0f, 0.4f},
                {"glass, smooth", LAYER_TRANSMISSION | LAYER_VOLUME, 0.0f, 0.0f},
                {"glass, rough", LAYER_TRANSMISSION | LAYER_VOLUME, 0.0f, 0.4f},
                {"all of them", 127u, 0.2f, 0.4f}};
    printf("%-24s %8s %8s %8s %8s   ns\n", "", "lobes", "sample", "value", "light");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        Layers m = plain(rows[i].metallic);
        m.layers = rows[i].layers;
        m.base.perceptual_roughness = rows[i].roughness;
        m.base.alpha = alpha_from_roughness(rows[i].roughness);
        fill(m);
        printf("%-24s", rows[i].name);
        for (int what = 0; what < 4; what++)
            printf(" %8.1f", measure(what, runs));
        printf("\n");
    }
    return 0;
}
