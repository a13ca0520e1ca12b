/* radiance.glsl - what leaves a surface towards the eye, in cd/m^2: emission, the prefiltered surroundings, every light.
 * What is looked up for which layer; the formulas are in shade/, as are those of src/cpu/surface_light.c. */

/* ---- a surface without layers ---- */

vec3 plain_radiance(Surface s, vec3 V)
{
    float NdotV = surface_NdotV(s, V);
    vec2 dfg = table_dfg(NdotV, s.perceptual_roughness);
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
    coat = table_dfg(layers_clearcoat_NdotV(m, V), m.clearcoat_roughness);
#endif
#ifdef HAS_TRANSMISSION
    vec2 point = layers_transmission_point(m, V, energy);
    through = table_dfg(point.x, point.y);
    if (layers_is_exact(m, energy)) {
        vec3 place = layers_glass_point(m, V, energy);
        glass = table_glass(place.x, place.y, place.z);
    }
#endif
#ifdef HAS_SHEEN
    sheen_E = table_sheen_albedo(surface_NdotV(m.base, V), m.sheen_roughness);
#endif
    vec2 at = layers_dfg_point(m, V, energy);
    return layer_tables(m, V, energy, table_dfg(at.x, at.y), coat.x + coat.y, through.x + through.y, sheen_E,
                        glass);
}

#ifdef HAS_ENVIRONMENT
LayerLight surroundings_of(Layers m, vec3 V)
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

vec3 layered_radiance(Layers m, vec3 V)
{
    LayerTables t = tables_of(m, V);
    vec3 radiance = layers_emission(m, V);
    LayerLight light;
#ifdef HAS_ENVIRONMENT
    light = surroundings_of(m, V);
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
#if defined(HAS_ENVIRONMENT) || defined(HAS_TRANSMISSION)
    radiance += layers_ibl(m, V, t, light, energy);
#endif
#ifdef HAS_LIGHTS
    int count = light_count(v_position);
    for (int i = 0; i < count; i++) {
        Light l = light_at(i);
        float sheen_E_L = 0.0;
#ifdef HAS_SHEEN
        sheen_E_L = table_sheen_albedo(clamp(dot(m.base.N, light_illuminate(l, v_position).L), 0.0, 1.0),
                                       m.sheen_roughness);
#endif
        radiance += layers_punctual(m, v_position, V, l, energy, t, sheen_E_L);
    }
#endif
    return radiance;
}
#endif
