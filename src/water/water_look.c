/* water_look.c - see water_look.h. */
#include <math.h>

#include "water/water_look.h"

/* Displays were given c^0.95 as it is; the numbers here are encoded later. */
static vec3 shown(vec3 c)
{
    return linear_from_srgb(before_display(c));
}

vec3 water_look_sky(vec3 d)
{
    return shown(before_sky(d));
}

vec3 water_look_shade(const water_setup *s, const water_place *p, vec3 d)
{
    const facet_sea_shading *look = &s->desc->sea_shading;
    int variant = look->style == FACET_SEA_STYLE_LEGACY_WRITTEN ? BEFORE_WRITTEN : BEFORE_INTENDED;
    int stage = look->style != FACET_SEA_STYLE_PHYSICAL ? BEFORE_STAGE_NONE
                : look->stage == 1                      ? BEFORE_STAGE_FRESNEL
                                                        : BEFORE_STAGE_COOK_TORRANCE;
    float perceptual_roughness =
        look->perceptual_roughness > 0.0f ? look->perceptual_roughness : BEFORE_ROUGHNESS;
    vec2 slope = slope_from_normal(p->point.N);
    float sparkle = 0.0f;
    if (!look->omits_glints) { /* noise in the water, about one cell in ten */
        GlintCell cell = glint_cell(vec2((float)p->rest[0], (float)p->rest[1]), vec2(p->footprint_m), 1.0f);
        sparkle = glint_uniform(cell.key) > 0.9f ? 1.0f : 0.0f;
    }
    float foam = look->omits_foam ? 0.0f : before_foam(length(slope));
    return shown(before_shade(variant, stage, d, p->point.N, s->light.L, (float)p->P[1], sparkle, foam,
                              s->water.ior, perceptual_roughness));
}

vec3 water_look_painted(const water_setup *s, const water_place *p)
{
    float given = s->desc->sea_shading.perceptual_roughness;
    float perceptual_roughness = given > 0.0f ? given : BEFORE_ROUGHNESS;
    vec3 sky = water_sky_reflected(&s->sky, painted_mirror(p->point.N, p->V), perceptual_roughness);
    return painted_water(s->light, p->point.N, p->V, s->water.ior, perceptual_roughness, sky);
}
