/* layers_ibl.h - the layered surface in an environment: weighted sums of prefiltered radiance. */
#ifndef SHADE_LAYERS_IBL_H
#define SHADE_LAYERS_IBL_H

/* A boundary in uniform light: factors of prefiltered radiance and of irradiance / pi. */
STRUCT(BoundaryIbl)
{
    vec3 single;
    vec3 multiple;
    float below;
};

/* The dielectric. Unless it is exact, a rough boundary seen from inside a volume takes F(N.V): there is no
 * LUT for it. */
FN BoundaryIbl boundary_ibl_base(Layers m, float NdotV, LayerTables t, int energy)
{
    vec3 F90 = vec3(m.base.F90);
    BoundaryIbl b;
    if (layers_is_exact(m, energy)) {
        ExactBoundary exact = exact_boundary(m, t);
        b.single = exact.R / exact.scale;
        b.multiple = exact.R - b.single;
    } else if (layers_is_inside(m)) {
        b.single = layers_F_base(m, NdotV);
        b.multiple = vec3(0.0f);
    } else {
        vec3 k = m.base.F0;
        if (energy == ENERGY_GLTF)
            k = F_Schlick_roughness(m.base.F0, F90, m.base.perceptual_roughness, NdotV);
        MultiScatter s = multiscatter_ibl(k, m.base.F0, F90, t.dfg);
        b.single = s.single;
        b.multiple = s.multiple;
    }
    b.below = 1.0f - max3(b.single + b.multiple);
    return b;
}

FN BoundaryIbl boundary_ibl_metal(Layers m, float NdotV, LayerTables t, int energy)
{
    vec3 one = vec3(1.0f);
    vec3 k = m.base.base_color;
    if (energy == ENERGY_GLTF)
        k = F_Schlick_roughness(k, one, m.base.perceptual_roughness, NdotV);
    MultiScatter s = multiscatter_ibl(k, m.base.base_color, one, t.dfg);
    BoundaryIbl b;
    b.single = s.single;
    b.multiple = s.multiple;
    b.below = 0.0f;
    return b;
}

/* A film of reflectance F: glTF's, as in Khronos' renderer, multiplies the radiance; the conserving one
 * has the lobe's albedo and multiple scattering. */
FN BoundaryIbl boundary_ibl_film(vec3 F, LayerTables t, int energy)
{
    BoundaryIbl b;
    b.single = F;
    b.multiple = vec3(0.0f);
    if (energy == ENERGY_CONSERVING) {
        MultiScatter s = multiscatter_ibl(F, F, F, t.dfg);
        b.single = s.single;
        b.multiple = s.multiple;
    }
    b.below = 1.0f - max3(b.single + b.multiple);
    return b;
}

FN BoundaryIbl mix_boundary(BoundaryIbl a, BoundaryIbl b, float weight)
{
    BoundaryIbl r;
    r.single = mix(a.single, b.single, weight);
    r.multiple = mix(a.multiple, b.multiple, weight);
    r.below = mix(a.below, b.below, weight);
    return r;
}

/* Dielectric and metal, each with its film, mixed. */
FN BoundaryIbl boundary_ibl(Layers m, float NdotV, LayerTables t, int energy)
{
    BoundaryIbl base = boundary_ibl_base(m, NdotV, t, energy);
    BoundaryIbl metal = boundary_ibl_metal(m, NdotV, t, energy);
    if (has_layer(m, LAYER_IRIDESCENCE)) {
        base = mix_boundary(base, boundary_ibl_film(t.film_F_base, t, energy), t.film_weight);
        metal = mix_boundary(metal, boundary_ibl_film(t.film_F_metal, t, energy), t.film_weight);
        metal.below = 0.0f;
    }
    return mix_boundary(base, metal, m.base.metallic);
}

/* Radiance from the eye's side and from behind, which differ in occlusion. */
STRUCT(LayeredRadiance)
{
    vec3 front;
    vec3 back;
};

/* Radiance of a rough diffuse lobe. */
FN vec3 layers_rough_ibl(Layers m, vec3 albedo, float NdotV, RoughLight light)
{
    return eon_reflected(albedo, NdotV, m.diffuse_roughness, light.single, light.multiple);
}

/* The base, below sheen and coat. */
FN LayeredRadiance layers_base_ibl(Layers m, float NdotV, LayerTables t, LayerLight light, int energy)
{
    BoundaryIbl b = boundary_ibl(m, NdotV, t, energy);
    BelowShares share = below_shares(m);
    vec3 multiple_radiance = sel(energy == ENERGY_GLTF, light.specular, light.irradiance_over_pi);
    vec3 diffuse = share.diffuse * light.irradiance_over_pi;
    vec3 diffuse_back = share.diffuse_back * light.irradiance_back_over_pi;
    if (has_layer(m, LAYER_DIFFUSE_ROUGHNESS)) {
        diffuse = share.plain * light.irradiance_over_pi +
                  layers_rough_ibl(m, m.base.base_color, NdotV, light.rough) * share.lobe;
        diffuse_back =
            share.plain_back * light.irradiance_back_over_pi +
            layers_rough_ibl(m, m.diffuse_transmission_color, NdotV, light.rough_back) * share.lobe_back;
    }
    LayeredRadiance r;
    r.front = b.single * light.specular + b.multiple * multiple_radiance + diffuse * b.below;
    r.back = vec3(0.0f);
    if (has_layer(m, LAYER_DIFFUSE_TRANSMISSION))
        r.back += diffuse_back * b.below;
    if (has_layer(m, LAYER_TRANSMISSION))
        r.back += share.specular * light.transmitted * b.below;
    return r;
}

/* The sheen lobe returns color E of uniform light and transmits sheen_scaling(). Where E exceeds 1, light
 * blurred over the rim no longer separates the rim's part: E is clamped to 1, as in the 8 bits of Khronos'
 * LUT; in the conserving mode color E is. */
FN LayeredRadiance layers_sheen_ibl(Layers m, LayerTables t, vec3 sheen, int energy, LayeredRadiance r)
{
    float E = t.sheen_E;
    float lobe = min(E, 1.0f);
    if (energy == ENERGY_CONSERVING)
        lobe = E / max(max3(m.sheen_color) * E, 1.0f);
    float left = sheen_scaling(m.sheen_color, E);
    r.front = m.sheen_color * sheen * lobe + r.front * left;
    r.back *= left;
    return r;
}

/* mix(r, coat, clearcoat F(N.V)). */
FN LayeredRadiance layers_clearcoat_ibl(Layers m, vec3 V, vec3 coat, LayeredRadiance r)
{
    float w = m.clearcoat * F_clearcoat(layers_clearcoat_NdotV(m, V));
    r.front = mix(r.front, coat, w);
    r.back *= 1.0f - w;
    return r;
}

/* Radiance (cd/m^2) of the environment towards V, with occlusion, without emission.
 *
 * Occlusion dims light from the hemisphere above, sheen and coat included, as in Khronos' renderer; light
 * from behind is not dimmed, since refracted rays have already been traced. */
FN vec3 layers_ibl(Layers m, vec3 V, LayerTables t, LayerLight light, int energy)
{
    float NdotV = surface_NdotV(m.base, V);
    if (m.layers == 0u)
        return surface_ibl(m.base, NdotV, t.dfg, light.specular, light.irradiance_over_pi, energy);
    LayeredRadiance r = layers_base_ibl(m, NdotV, t, light, energy);
    if (has_layer(m, LAYER_SHEEN))
        r = layers_sheen_ibl(m, t, light.sheen, energy, r);
    if (has_layer(m, LAYER_CLEARCOAT))
        r = layers_clearcoat_ibl(m, V, light.clearcoat, r);
    return r.front * m.base.occlusion + r.back;
}

#endif
