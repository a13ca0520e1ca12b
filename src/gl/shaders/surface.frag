/* surface.frag - radiance (cd/m^2, premultiplied) of a material, or what a window shows of it. */
#ifdef AOVS
void main()
{
    read_texels();
    vec4 color = base_color();
    vec3 V = view_direction();
    vec3 N = shading_normal(V);
    float occlusion = 1.0;
#ifdef IS_LIT
    occlusion = surface_of_material(N, color.xyz).occlusion;
#endif
    put_aovs(N, color.xyz, occlusion, coverage(color.w));
}
#else
#ifdef HAS_LAYERS
/* s: without anti-aliasing. */
Layers antialiased_layers(Surface s, vec3 V)
{
    Layers m = layers_of_material(s, V);
#ifdef HAS_SPECULAR_ANTIALIASING
    vec3 dN_dx = dFdx(s.N), dN_dy = dFdy(s.N);
    m.base = surface_specular_aa(m.base, dN_dx, dN_dy);
    m.clearcoat_roughness = roughness_specular_aa(m.clearcoat_roughness, dN_dx, dN_dy);
#endif
    return m;
}
#endif

#ifdef IS_TRACING
void main()
{
    read_texels();
    vec3 V = view_direction(), plane = cross(dFdx(v_position), dFdy(v_position));
    rays_normal = normalize(dot(plane, V) < 0.0 ? -plane : plane);
    vec4 color = base_color();
    Layers m = antialiased_layers(surface_of_material(shading_normal(V), color.xyz), V);
    if (coverage(color.w) < 0.5)
        discard;
    traced_radiance = vec4(traced_light(m, V), dot(v_position, forward.xyz));
    traced_backdrop = vec4(backdrop_share, volume_factors.z + 1.0);
    traced_unseen = vec4(backdrop_unseen, 0.0);
}
#else
/* Without lighting: surfaces without normals, or with KHR_materials_unlit. glTF 2.0, 3.7.2.1. */
vec3 unlit_radiance(vec3 color)
{
#ifdef IS_UNLIT
    return color;
#else
    return color + emissive_factor.xyz * EMISSIVE_TEXEL.xyz;
#endif
}

/* ---- a channel in place of light: facet_channel ---- */

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

/* ---- light ---- */

float behind = 0.0; /* share of the background that is seen through glass */

#ifdef IS_LIT
/* s: without anti-aliasing. */
vec3 lit_radiance(Surface s, vec3 V)
{
#ifdef HAS_LAYERS
    Layers m = antialiased_layers(s, V);
#ifdef HAS_CHANNEL
    return lobe_channel(m, V);
#else
    LayerTables tables = surface_tables(m, V, energy);
    vec3 radiance = layered_radiance(surface_host(V), m, tables);
#ifdef HAS_TRANSMISSION
    if (backdrop.w > 0.0) {
        m.base.occlusion = 1.0;
        LayerLight one = layer_light_of(vec3(0.0));
        one.transmitted = vec3(1.0);
        vec3 through = layers_ibl(m, V, tables, one, energy);
        behind = backdrop_passes(through * backdrop_share);
        radiance += backdrop_radiance(through * backdrop_share, through * backdrop_unseen, backdrop.xyz, backdrop.w > 1.5);
    }
#endif
    return radiance;
#endif
#else
#ifdef HAS_SPECULAR_ANTIALIASING
    s = surface_specular_aa(s, dFdx(s.N), dFdy(s.N));
#endif
    return plain_radiance(surface_host(V), s);
#endif
}
#endif

/* The output: light, or the channel in its place. */
vec3 shaded(vec3 color, float opacity)
{
#if defined(IS_LIT) || defined(HAS_CHANNEL)
    vec3 V = view_direction();
    Surface s = surface_of_material(shading_normal(V), color);
#endif
#ifdef HAS_CHANNEL
    if (channel < CHANNEL_DIFFUSE)
        return surface_channel(s, V, opacity);
#endif
#ifdef IS_LIT
    return lit_radiance(s, V);
#else
#ifdef HAS_CHANNEL
    if (channel != CHANNEL_EMISSION)
        return vec3(0.0);
#endif
    return unlit_radiance(color);
#endif
}

#ifdef HAS_ALPHA_MASK
/* The coverage of the pixel by a mask whose alpha varies linearly across it; OpenGL turns it into samples. */
float mask_share(float alpha)
{
    float change = fwidth(alpha);
    if (change < 1e-4)
        return coverage(alpha);
    return clamp((alpha - emissive_factor.w) / change + 0.5, 0.0, 1.0);
}
#endif

void main()
{
    read_texels();
    vec4 color = base_color();
    float opacity = coverage(color.w);
    vec3 radiance = shaded(color.xyz, opacity);
    float scale = exposure;
#ifdef IS_DISPLAYED
    radiance = display_encode(display_color(radiance * exposure));
    scale = 1.0;
#endif
#ifdef HAS_ALPHA_MASK
#ifdef HAS_TRANSMISSION
    bool is_covering = false; /* opacity is what shows the background */
#else
    bool is_covering = has_coverage != 0;
#endif
    if (is_covering)
        opacity = mask_share(color.w);
    if (opacity < (is_covering ? 1.0 / 512.0 : 0.5))
        discard;
    radiance /= opacity; /* put_fragment() multiplies by it: coverage is by samples */
#endif
#ifdef HAS_CHANNEL
    if (channel == CHANNEL_OPACITY)
        opacity = 1.0;
#endif
    put_fragment(radiance * scale, opacity);
#ifdef HAS_TRANSMISSION
    fragment.w *= 1.0 - behind;
#endif
}
#endif
#endif
