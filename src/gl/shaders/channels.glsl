/* channels.glsl - what of a surface is drawn instead of its light: facet_channel. */
#ifdef HAS_CHANNEL
#define CHANNEL_NORMAL 1
#define CHANNEL_BASE_COLOR 2
#define CHANNEL_ROUGHNESS 3
#define CHANNEL_METALLIC 4
#define CHANNEL_OCCLUSION 5
#define CHANNEL_OPACITY 6
#define CHANNEL_NDOTV 7
#define CHANNEL_DIFFUSE 8 /* and the other lobes, in the order of ALONE_* */
#define CHANNEL_EMISSION 13
#define CHANNEL_FURNACE 14

vec3 surface_channel(Surface s, vec3 V, float opacity)
{
    if (channel == CHANNEL_NORMAL)
        return 0.5 + 0.5 * s.N;
    if (channel == CHANNEL_BASE_COLOR)
        return s.base_color;
    if (channel == CHANNEL_ROUGHNESS)
        return vec3(s.perceptual_roughness);
    if (channel == CHANNEL_METALLIC)
        return vec3(s.metallic);
    if (channel == CHANNEL_OCCLUSION)
        return vec3(s.occlusion);
    if (channel == CHANNEL_OPACITY)
        return vec3(opacity);
    return vec3(surface_NdotV(s, V));
}

#ifdef IS_LIT
/* Of one lobe, of the emission, or under uniform light of 1. */
vec3 lobe_channel(Layers m, vec3 V)
{
    if (channel == CHANNEL_EMISSION)
        return layers_emission(m, V);
    SurfaceHost host = surface_host(V);
    LayerTables t = surface_tables(m, V, energy);
    if (channel == CHANNEL_FURNACE) {
        m.base.occlusion = 1.0;
        return layers_ibl(m, V, t, layer_light_of(vec3(1.0)), energy);
    }
    int lobe = channel - CHANNEL_DIFFUSE;
    vec3 radiance = layers_ibl_alone(m, V, t, layer_light(host, m, diffuse_exit(host, m)), energy, lobe);
    for (LightCursor c = host_first_light(host); c.has_light; c = host_next_light(host, c)) {
        Light l = host_punctual(host, c);
        float sheen_E_L = sheen_albedo_of_light(host, m, l);
        vec3 alone = layers_punctual_alone(m, host.P, V, l, energy, t, sheen_E_L, lobe);
        if (lobe == ALONE_SPECULAR)
            alone += specular_variant(host, m, l, t, sheen_E_L);
        radiance += alone;
    }
    return radiance;
}
#endif
#endif
