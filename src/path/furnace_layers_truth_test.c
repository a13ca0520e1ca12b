/* The white furnace for combinations of layers: no set of one to three returns more than it got, and those
 * whose mixes lose nothing return all of it. 4096 samples for each of 16 pixels. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include <cmocka.h>

#include "path/path_fixture.h"

static const double VIEWS[] = {0.0, 60.0, 78.0};

typedef enum layer_kind {
    COAT,
    SHEEN,
    FILM,
    GRAIN,
    THIN_WALL,
    LEAF,
    HALF_METAL,
    VOLUME,
    CLAY,
    LAYER_KINDS
} layer_kind;

static void add_layer(scene_material *m, layer_kind kind, float amount)
{
    switch (kind) {
    case COAT:
        m->extensions |= SCENE_CLEARCOAT;
        m->clearcoat = 1.0f;
        m->clearcoat_roughness = amount;
        return;
    case SHEEN:
        m->extensions |= SCENE_SHEEN;
        m->sheen_color[0] = 1.0f;
        m->sheen_color[1] = 0.6f;
        m->sheen_color[2] = 0.2f;
        m->sheen_roughness = 0.1f + 0.9f * amount;
        return;
    case FILM:
        m->extensions |= SCENE_IRIDESCENCE;
        m->iridescence = 1.0f;
        m->iridescence_ior = 1.8f;
        m->iridescence_thickness_maximum = 300.0f + 300.0f * amount;
        return;
    case GRAIN:
        m->extensions |= SCENE_ANISOTROPY;
        m->anisotropy = amount;
        return;
    case THIN_WALL:
        m->extensions |= SCENE_TRANSMISSION;
        m->transmission = 0.8f;
        return;
    case LEAF:
        m->extensions |= SCENE_DIFFUSE_TRANSMISSION;
        m->diffuse_transmission = 0.5f;
        return;
    case HALF_METAL:
        m->metallic = 0.5f;
        return;
    case VOLUME:
        m->extensions |= SCENE_TRANSMISSION | SCENE_VOLUME | SCENE_IOR;
        m->transmission = 1.0f;
        m->thickness = 1.0f;
        m->ior = 1.4f;
        return;
    case CLAY:
        m->extensions |= SCENE_DIFFUSE_ROUGHNESS;
        m->diffuse_roughness = amount;
        return;
    case LAYER_KINDS:
        return;
    }
}

/* Whether the white material with these layers loses no light: the tables of anisotropy are bounds, thin
 * films scale the layers below by the largest of their channels, colored sheen takes its largest channel
 * from all, rough closed volumes lose energy. */
static bool is_lossless(uint32_t layers)
{
    return (layers & (1u << GRAIN | 1u << FILM | 1u << SHEEN | 1u << VOLUME)) == 0;
}

/* All sets of one to three layers, a roughness and a view each. */
static void layers_never_gain_energy(void **state)
{
    (void)state;
    static const float roughness[] = {0.2f, 0.5f, 0.9f};
    double highest = 0.0;
    uint32_t number = 0;
    for (uint32_t layers = 1; layers < 1u << LAYER_KINDS; layers++) {
        if (__builtin_popcount(layers) > 3)
            continue;
        float r = roughness[number % 3];
        double polar = VIEWS[number / 3 % 3];
        number++;
        scene_material m = truth_metal(1.0f, 1.0f, 1.0f, r);
        m.metallic = 0.0f;
        for (int kind = 0; kind < LAYER_KINDS; kind++)
            if (layers >> kind & 1u)
                add_layer(&m, (layer_kind)kind, 0.3f + 0.2f * (float)(number % 3));
        truth_value v = layers >> VOLUME & 1u ? truth_furnace_volume(m, polar)
                                              : truth_furnace(m, polar, FACET_ENERGY_CONSERVING);
        for (int c = 0; c < 3; c++)
            highest = fmax(highest, v.mean[c]);
        double tables = layers >> VOLUME & 1u ? 2.0 * TRUTH_TABLES : TRUTH_TABLES;
        truth_assert_at_most(&v, 1.0 + tables, "layers 0x%x, roughness %g, %g degrees", layers, (double)r,
                             polar);
        if (is_lossless(layers)) {
            char what[32];
            snprintf(what, sizeof what, "layers 0x%x", layers);
            truth_assert_white(v, TRUTH_TABLES, what, (double)r, polar);
        }
        for (int c = 0; c < 3; c++)
            assert_true(v.mean[c] > 0.3);
    }
    print_message("%u sets of layers, the highest returns %.5f\n", number, highest);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(layers_never_gain_energy)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
