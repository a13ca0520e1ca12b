/* ogl1_maps.c - see ogl1_maps.h. */
#include "draw/ogl1_maps.h"

#include "shade/shade.h"

#define BIT(slot) (1u << (slot))

static const uint32_t OPACITY_MAPS = BIT(LEGACY_DIFFUSE_MAP) | BIT(LEGACY_OPACITY_MAP);
static const uint32_t LIGHT_MAPS = BIT(LEGACY_AMBIENT_MAP) | BIT(LEGACY_SPECULAR_MAP) |
                                   BIT(LEGACY_EMISSION_MAP) | BIT(LEGACY_SHININESS_MAP) |
                                   BIT(LEGACY_NORMAL_MAP);
static const uint32_t COLOR_MAPS =
    BIT(LEGACY_AMBIENT_MAP) | BIT(LEGACY_DIFFUSE_MAP) | BIT(LEGACY_SPECULAR_MAP) | BIT(LEGACY_EMISSION_MAP);

uint32_t ogl1_maps(const render_geometry *g, facet_ogl1_variant variant)
{
    uint32_t bits = OPACITY_MAPS;
    if (g->is_lit && !phong_rules((int)variant).is_lit_at_vertices)
        bits |= LIGHT_MAPS;
    for (int slot = 0; slot < LEGACY_MAP_COUNT; slot++)
        if (!legacy_has_map(g->legacy, (legacy_map_slot)slot))
            bits &= ~BIT(slot);
    return bits;
}

uint32_t ogl1_drawn_maps(const render_geometry *g, facet_ogl1_variant variant)
{
    uint32_t maps = ogl1_maps(g, variant);
    return g->tangents ? maps : maps & ~BIT(LEGACY_NORMAL_MAP);
}

bool ogl1_map_is_color(const legacy_material *m, legacy_map_slot slot, bool is_linear)
{
    bool is_opacity = slot == LEGACY_DIFFUSE_MAP && m->texture_type == LEGACY_ALPHA;
    return is_linear && (COLOR_MAPS & BIT(slot)) && !is_opacity;
}

bool ogl1_map_is_spherical(const legacy_material *m, legacy_map_slot slot)
{
    return slot == LEGACY_DIFFUSE_MAP && m->has_environment_map;
}

float ogl1_map_scalar(const legacy_map *map, const float texel[4])
{
    float value = luminance(vec3(texel[0], texel[1], texel[2]));
    switch (map->channel) {
    case 'r':
        value = texel[0];
        break;
    case 'g':
        value = texel[1];
        break;
    case 'b':
        value = texel[2];
        break;
    case 'm':
        value = texel[3];
        break;
    default:
        break;
    }
    return map->base + map->gain * value;
}
