/* layers_lobes.h - the contribution of one lobe, as in the sum: attenuated by the layers above it. The lobes
 * add up to layers_ibl() and layers_brdf_cos(), which are linear in the light of each lobe. For viewers that
 * show lobes separately. */
#ifndef SHADE_LAYERS_LOBES_H
#define SHADE_LAYERS_LOBES_H

#define ALONE_DIFFUSE 0
#define ALONE_SPECULAR 1
#define ALONE_CLEARCOAT 2
#define ALONE_SHEEN 3
#define ALONE_TRANSMISSION 4 /* diffuse transmission too */

/* The same boundary over a black base: no diffuse reflection or transmission. */
FN Layers layers_without_diffuse(Layers m)
{
    m.layers = (m.layers & ~LAYER_SCATTER) | LAYER_DIFFUSE_TRANSMISSION;
    m.diffuse_transmission = 1.0f;
    m.diffuse_transmission_color = vec3(0.0f);
    return m;
}

FN LayerLight layer_light_of(vec3 radiance)
{
    LayerLight light;
    light.specular = radiance;
    light.irradiance_over_pi = radiance;
    light.irradiance_back_over_pi = radiance;
    light.clearcoat = radiance;
    light.sheen = radiance;
    light.transmitted = radiance;
    light.rough.single = radiance;
    light.rough.multiple = radiance;
    light.rough_back = light.rough;
    return light;
}

/* Environment light of one lobe (ALONE_*), cd/m^2. Multiple scattering of the conserving mode counts as
 * specular, though it multiplies irradiance. */
FN vec3 layers_ibl_alone(Layers m, vec3 V, LayerTables t, LayerLight light, int energy, int lobe)
{
    LayerLight some = layer_light_of(vec3(0.0f));
    if (lobe == ALONE_CLEARCOAT)
        some.clearcoat = light.clearcoat;
    if (lobe == ALONE_SHEEN)
        some.sheen = light.sheen;
    if (lobe == ALONE_TRANSMISSION) {
        some.transmitted = light.transmitted;
        some.irradiance_back_over_pi = light.irradiance_back_over_pi;
        some.rough_back = light.rough_back;
    }
    if (lobe == ALONE_DIFFUSE || lobe == ALONE_SPECULAR) {
        some.specular = light.specular;
        some.irradiance_over_pi = light.irradiance_over_pi;
        some.rough = light.rough;
    }
    Layers black = layers_without_diffuse(m);
    if (lobe == ALONE_SPECULAR)
        m = black;
    vec3 radiance = layers_ibl(m, V, t, some, energy);
    if (lobe == ALONE_DIFFUSE)
        radiance -= layers_ibl(black, V, t, some, energy);
    return radiance;
}

/* The same for layers_brdf_cos(), 1/sr. */
FN vec3 layers_brdf_cos_alone(Layers m, vec3 V, vec3 L, int energy, LayerTables t, float sheen_E_L, int lobe)
{
    bool is_front = dot(m.base.N, L) > 0.0f;
    vec3 f = vec3(0.0f);
    if (is_front && (lobe == ALONE_DIFFUSE || lobe == ALONE_SPECULAR))
        f = layers_base_cos(layers_without_diffuse(m), V, L, energy, t, LOBES_ALL);
    if (is_front && lobe == ALONE_DIFFUSE)
        f = layers_base_cos(m, V, L, energy, t, LOBES_ALL) - f;
    if (!is_front && lobe == ALONE_TRANSMISSION)
        f = layers_base_cos(m, V, L, energy, t, LOBES_ALL);
    if (has_layer(m, LAYER_SHEEN)) {
        vec3 sheen = layers_sheen_cos(m, V, L, energy, t, sheen_E_L, vec3(0.0f));
        f = sel(lobe == ALONE_SHEEN, sheen, layers_sheen_cos(m, V, L, energy, t, sheen_E_L, f) - sheen);
    }
    uint coat = sel(lobe == ALONE_CLEARCOAT, LOBES_ALL, LOBES_ALL & ~LOBE_CLEARCOAT);
    if (has_layer(m, LAYER_CLEARCOAT))
        f = layers_clearcoat_cos(m, V, L, energy, t, f, coat);
    return f;
}

/* The same for layers_punctual(), cd/m^2. */
FN vec3 layers_punctual_alone(Layers m, vec3 P, vec3 V, Light l, int energy, LayerTables t, float sheen_E_L,
                              int lobe)
{
    LightSample light = light_illuminate(l, P);
    m.base.alpha = max(m.base.alpha, ALPHA_MIN);
    m.clearcoat_roughness = max(m.clearcoat_roughness, ROUGHNESS_MIN);
    return layers_brdf_cos_alone(m, V, light.L, energy, t, sheen_E_L, lobe) * light.E;
}

/* Factor on the base's specular lobe that replaces height-correlated Smith visibility by Schlick-GGX with k =
 * alpha / 2, as in older renderers. Karis 2013, equation 4; cosines above 0. */
FN float schlick_GGX_over_smith(float NdotL, float NdotV, float alpha)
{
    return V_SchlickGGX(NdotL, NdotV, k_ibl(alpha)) / V_SmithGGX(NdotL, NdotV, max(alpha, ALPHA_DELTA));
}

#endif
