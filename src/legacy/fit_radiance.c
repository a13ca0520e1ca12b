/* fit_radiance.c - both models at one pair of directions. */
#include <math.h>
#include <string.h>

#include "legacy/fit.h"

#include "shade/shade.h"

void ogl1_radiance(const ogl1_surface *s, const float V[3], const float L[3], float out[3])
{
    vec3 radiance = phong_reflection(vec3(0.0f, 0.0f, 1.0f), vec3(V[0], V[1], V[2]), vec3(L[0], L[1], L[2]),
                                     vec3(s->diffuse[0], s->diffuse[1], s->diffuse[2]),
                                     vec3(s->specular[0], s->specular[1], s->specular[2]), s->shininess);
    for (int k = 0; k < 3; k++)
        out[k] = radiance[k];
}

/* The renderer's own function; separable masking by the ratio of the two visibilities. */
void pbr_radiance(const pbr_surface *p, pbr_masking masking, const float V[3], const float L[3], float out[3])
{
    vec3 v = vec3(V[0], V[1], V[2]);
    vec3 l = vec3(L[0], L[1], L[2]);
    Surface s = surface_from_gltf(
        vec3(0.0f, 0.0f, 1.0f), vec3(p->base_color[0], p->base_color[1], p->base_color[2]), p->metallic,
        p->perceptual_roughness, p->ior, p->specular,
        vec3(p->specular_color[0], p->specular_color[1], p->specular_color[2]), 1.0f, vec3(0.0f));
    SurfaceLobes lobes = surface_lobes_cos(s, v, l, ENERGY_GLTF, vec2(0.0f));
    if (masking == PBR_SEPARABLE && L[2] > 0.0f) {
        float alpha = max(s.alpha, ALPHA_MIRROR);
        float NdotL = min(L[2], 1.0f);
        float NdotV = surface_NdotV(s, v);
        lobes.specular *= V_SmithGGX_separable(NdotL, NdotV, alpha) / V_SmithGGX(NdotL, NdotV, alpha);
    }
    vec3 radiance = (lobes.specular + lobes.diffuse) * PI;
    for (int k = 0; k < 3; k++)
        out[k] = radiance[k];
}
