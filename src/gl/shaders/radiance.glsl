/* radiance.glsl - radiance from a surface towards the eye, in cd/m^2: emission, the prefiltered environment, every
 * light. These are the lookups for each layer; the formulas are in shade/, as are those of
 * src/cpu/surface_light.c. */

/* (A, B) of the split sum. */
vec2 dfg_at(vec2 point)
{
#ifdef HAS_SCHLICK_GGX
    return integrate_dfg_karis(point.y, point.x, 128u);
#else
    return table_dfg(point.x, point.y);
#endif
}

/* ---- a surface without layers ---- */

vec3 plain_radiance(Surface s, vec3 V)
{
    float NdotV = surface_NdotV(s, V);
    vec2 dfg = dfg_at(vec2(NdotV, s.perceptual_roughness));
    vec3 radiance = s.emissive;
#ifdef HAS_ENVIRONMENT
    vec3 specular = light_specular(normalize(reflect(-V, s.N)), s.perceptual_roughness);
    radiance += surface_ibl(s, NdotV, dfg, specular, light_irradiance_over_pi(s.N), energy);
#endif
#ifdef HAS_LIGHTS
    int count = light_count(v_position);
    for (int i = 0; i < count; i++)
        radiance += shade_punctual(s, v_position, V, light_at(i), energy, dfg);
#endif
    return radiance;
}

/* ---- layers ---- */

#ifdef HAS_LAYERS
LayerTables tables_of(Layers m, vec3 V)
{
    vec2 coat = vec2(0.0);
    vec2 through = vec2(0.0);
    float sheen_E = 0.0;
    vec3 glass = vec3(0.0);
#ifdef HAS_CLEARCOAT
    coat = dfg_at(vec2(layers_clearcoat_NdotV(m, V), m.clearcoat_roughness));
#endif
#ifdef HAS_TRANSMISSION
    through = dfg_at(layers_transmission_point(m, V, energy));
    if (layers_is_exact(m, energy)) {
        vec3 place = layers_glass_point(m, V, energy);
        glass = table_glass(place.x, place.y, place.z);
    }
#endif
#ifdef HAS_SHEEN
    sheen_E = table_sheen_albedo(surface_NdotV(m.base, V), m.sheen_roughness);
#endif
    return layer_tables(m, V, energy, dfg_at(layers_dfg_point(m, V, energy)), coat.x + coat.y, through.x + through.y, sheen_E,
                        glass);
}

#ifdef HAS_ENVIRONMENT
LayerLight environment_light_of(Layers m, vec3 V)
{
    LayerLight light;
    light.specular = light_specular(layers_reflection(m, V), m.base.perceptual_roughness);
    light.irradiance_over_pi = light_irradiance_over_pi(m.base.N);
    light.irradiance_back_over_pi = vec3(0.0);
    light.clearcoat = vec3(0.0);
    light.sheen = vec3(0.0);
    light.transmitted = vec3(0.0);
#ifdef HAS_DIFFUSE_TRANSMISSION
    light.irradiance_back_over_pi = light_irradiance_over_pi(-m.base.N);
    if (has_layer(m, LAYER_VOLUME))
        light.irradiance_back_over_pi *=
            volume_transmittance(m.attenuation_color, m.attenuation_distance, m.thickness);
#endif
#ifdef HAS_CLEARCOAT
    light.clearcoat = light_specular(layers_clearcoat_reflection(m, V), m.clearcoat_roughness);
#endif
#ifdef HAS_SHEEN
    light.sheen = light_sheen(normalize(reflect(-V, m.base.N)), m.sheen_roughness);
#endif
    return light;
}
#endif

/* All arriving light except from punctual lights. */
LayerLight layer_light(Layers m, vec3 V)
{
    LayerLight light;
#ifdef HAS_ENVIRONMENT
    light = environment_light_of(m, V);
#else
    light.specular = vec3(0.0);
    light.irradiance_over_pi = vec3(0.0);
    light.irradiance_back_over_pi = vec3(0.0);
    light.clearcoat = vec3(0.0);
    light.sheen = vec3(0.0);
    light.transmitted = vec3(0.0);
#endif
#ifdef HAS_TRANSMISSION
    if (has_layer(m, LAYER_TRANSMISSION))
        light.transmitted = transmitted_light(m, V);
#endif
    return light;
}

#ifdef HAS_LIGHTS
/* Of the sheen, at the cosine of a punctual light. */
float sheen_albedo_of(Layers m, Light l)
{
#ifdef HAS_SHEEN
    return table_sheen_albedo(clamp(dot(m.base.N, light_illuminate(l, v_position).L), 0.0, 1.0), m.sheen_roughness);
#else
    return 0.0;
#endif
}

/* What another visibility term of the base adds to the highlight of a punctual light. */
vec3 specular_variant(Layers m, vec3 V, Light l, LayerTables t)
{
#ifdef HAS_SCHLICK_GGX
    float NdotL = dot(m.base.N, light_illuminate(l, v_position).L);
    if (NdotL > 0.0)
        return layers_punctual_alone(m, v_position, V, l, energy, t, sheen_albedo_of(m, l), ALONE_SPECULAR) *
               (schlick_GGX_over_smith(min(NdotL, 1.0), surface_NdotV(m.base, V), max(m.base.alpha, ALPHA_MIN)) - 1.0);
#endif
    return vec3(0.0);
}
#endif

vec3 layered_radiance(Layers m, vec3 V)
{
    LayerTables t = tables_of(m, V);
    vec3 radiance = layers_emission(m, V);
#if defined(HAS_ENVIRONMENT) || defined(HAS_TRANSMISSION)
    radiance += layers_ibl(m, V, t, layer_light(m, V), energy);
#endif
#ifdef HAS_LIGHTS
    int count = light_count(v_position);
    for (int i = 0; i < count; i++) {
        Light l = light_at(i);
        radiance += layers_punctual(m, v_position, V, l, energy, t, sheen_albedo_of(m, l)) +
                    specular_variant(m, V, l, t);
    }
#endif
    return radiance;
}
#endif
