/* water_look.c - see water_look.h. */
#include <math.h>

#include "water/water_look.h"

static const float STAGE_ROUGHNESS = 0.1f; /* perceptual, where none is given: the widest that was planned */

bool water_look_is_before(const facet_sea_look *look)
{
    return look->before != FACET_SEA_PHYSICAL || look->stage == 1 || look->stage == 2;
}

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
    const facet_sea_look *look = &s->desc->look;
    int variant = look->before == FACET_SEA_BEFORE_WRITTEN ? BEFORE_WRITTEN : BEFORE_INTENDED;
    int stage = look->before != FACET_SEA_PHYSICAL ? BEFORE_STAGE_NONE
                : look->stage == 1                 ? BEFORE_STAGE_FRESNEL
                                                   : BEFORE_STAGE_COOK_TORRANCE;
    float perceptual_roughness =
        look->perceptual_roughness > 0.0f ? look->perceptual_roughness : STAGE_ROUGHNESS;
    vec2 slope = slope_from_normal(p->point.N);
    float sparkle = 0.0f;
    if (!look->no_glints) { /* noise in the water, about one cell in ten */
        uint cell = glint_cell(vec2((float)p->rest[0], (float)p->rest[1]), vec2(p->footprint_m));
        sparkle = glint_uniform(cell) > 0.9f ? 1.0f : 0.0f;
    }
    float foam = look->no_foam ? 0.0f : before_foam(length(slope));
    return shown(before_shade(variant, stage, d, p->point.N, s->light.L, (float)p->P[1], sparkle, foam,
                              s->water.ior, perceptual_roughness));
}

/* The sky in a mirror of Schlick's reflectance, the sun in GGX of one roughness, and a matt base color below:
 *   F L_sky + F D V N.L E + (1 - F) albedo / pi (E N.L + E_sky) */
vec3 water_look_painted(const water_setup *s, const water_place *p)
{
    const vec3 albedo = vec3(0.0f, 0.3f, 0.5f);
    const WaterLight *light = &s->light;
    vec3 N = p->point.N, V = p->V, L = light->L;
    float given = s->desc->look.perceptual_roughness;
    float perceptual_roughness = given > 0.0f ? given : STAGE_ROUGHNESS;
    float NdotV = clamp(dot(N, V), NDOTV_MIN, 1.0f), NdotL = clamp(dot(N, L), 0.0f, 1.0f);
    vec3 R = reflect(-V, N), H = normalize(V + L);
    float F = F_Schlick1(F0_from_ior(s->water.ior), 1.0f, NdotV);
    vec3 sky =
        water_sky_reflected(&s->sky, normalize(vec3(R[0], max(R[1], 0.0f), R[2])), perceptual_roughness);
    float alpha = max(alpha_from_roughness(perceptual_roughness), ALPHA_MIN);
    float FH = F_Schlick1(F0_from_ior(s->water.ior), 1.0f, clamp(dot(V, H), 0.0f, 1.0f));
    float specular =
        FH * D_GGX_stable(max(dot(N, H), 0.0f), cross(N, H), alpha) * V_SmithGGX(NdotL, NdotV, alpha) * NdotL;
    vec3 E = light->sun_irradiance * NdotL + light->sky_irradiance;
    return sky * F + light->sun_irradiance * specular + albedo * E * (INV_PI * (1.0f - F));
}
