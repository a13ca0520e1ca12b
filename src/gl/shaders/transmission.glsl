/* transmission.glsl - light transmitted through a surface: the opaque image behind it, blurred by its mip levels;
 * beyond, the environment. The CPU traces rays (src/cpu/refraction.c); here a ray is a line from where light
 * enters a closed volume to where it leaves it, and a position in the image. */
#ifdef HAS_TRANSMISSION
uniform highp sampler2D u_opaque; /* premultiplied, with exposure */

/* ---- the opaque image ---- */

/* Where a point (m, relative to the eye) is seen, [0, 1] in the image. What is behind the eye is far outside. */
vec2 place_in_image(vec3 P)
{
    vec2 at = vec2(dot(P, right.xyz) / dot(right.xyz, right.xyz), dot(P, up.xyz) / dot(up.xyz, up.xyz));
    if (eye.w < 0.5)
        at /= max(dot(P, forward.xyz), 1e-6);
    return (at + 0.5 * frame_size.xy - frame_size.zw) / vec2(textureSize(u_opaque, 0));
}

/* Uniform cubic B-spline over the texels of a level by four bilinear lookups: coarse levels show no blocks. Sigg
 * and Hadwiger 2005. */
vec4 smooth_texel(vec2 at, int level)
{
    vec2 size = vec2(textureSize(u_opaque, level));
    vec2 x = at * size - 0.5;
    vec2 f = fract(x);
    vec2 base = floor(x) + 0.5;
    vec2 f2 = f * f;
    vec2 w0 = (1.0 - f) * (1.0 - f) * (1.0 - f) / 6.0;
    vec2 w1 = (4.0 - 6.0 * f2 + 3.0 * f2 * f) / 6.0;
    vec2 w3 = f2 * f / 6.0;
    vec2 low = w0 + w1;
    vec2 a = (base - 1.0 + w1 / low) / size;
    vec2 b = (base + 1.0 + w3 / (1.0 - low)) / size;
    float lod = float(level);
    return mix(mix(textureLod(u_opaque, b, lod), textureLod(u_opaque, vec2(a.x, b.y), lod), low.x),
               mix(textureLod(u_opaque, vec2(b.x, a.y), lod), textureLod(u_opaque, a, lod), low.x), low.y);
}

/* Radiance (premultiplied) and coverage of opaque surfaces. Beyond the border the image's edge is repeated for a
 * short distance, then there is nothing. */
vec4 opaque_at(vec2 at, float lod)
{
    vec2 beyond = max(max(-at, at - 1.0), 0.0);
    float share = 1.0 - smoothstep(0.0, 0.1, max(beyond.x, beyond.y));
    int level = int(lod);
    vec4 c = level == 0 ? textureLod(u_opaque, at, 0.0) : smooth_texel(at, level);
    if (lod > float(level))
        c = mix(c, smooth_texel(at, level + 1), lod - float(level));
    return vec4(c.xyz / exposure, c.w) * share;
}

/* Level of the image, as in Khronos' renderer: log2(width) r clamp(2 ior - 2, 0, 1). */
float opaque_lod(Layers m)
{
    float blur = m.base.perceptual_roughness * (m.ior < 1.0 ? 1.0 : clamp(2.0 * m.ior - 2.0, 0.0, 1.0));
    return blur * log2(float(textureSize(u_opaque, 0).x));
}

/* ---- environment ---- */

/* The environment in a direction. */
vec3 environment_seen(vec3 D, float alpha2)
{
    if (environment_is_sharp(alpha2, background_blur) && light_atlas.z > 0.0)
        return light_background(D);
    return light_specular(D, environment_blur(alpha2, background_blur));
}

/* The share of the light at the boundary that comes from the background of the image instead, and the radiance of the
 * environment there, unseen. backdrop_channels: those of the ray. */
vec3 backdrop_share = vec3(0.0);
vec3 backdrop_unseen = vec3(0.0);
vec3 backdrop_channels = vec3(1.0);

/* Times a factor, by which it reaches the boundary. */
vec3 light_behind(vec2 at, vec3 D, float lod, float alpha2, vec3 factor)
{
    vec4 c = opaque_at(at, lod);
    if (c.w >= 1.0)
        return c.xyz * factor;
    vec3 environment = environment_seen(D, alpha2);
    if (backdrop.w == 0.0)
        return (c.xyz + environment * (1.0 - c.w)) * factor;
    vec3 share = factor * backdrop_channels * (1.0 - c.w);
    backdrop_share += share;
    backdrop_unseen += share * environment;
    return c.xyz * factor;
}

/* ---- a thin wall ---- */

vec3 light_through_wall(Layers m, vec3 V)
{
    float alpha = layers_transmission_alpha(m);
    return light_behind(gl_FragCoord.xy / vec2(textureSize(u_opaque, 0)), -V, opaque_lod(m), alpha * alpha, vec3(1.0));
}

/* ---- a closed volume ---- */

/* Light that a scattering medium sends along a ray: that of the environment ahead of it and behind it. */
vec3 scattered_light(Layers m, vec3 D)
{
    return m.multiscatter_color * scattered_ambient(light_irradiance_over_pi(D), light_irradiance_over_pi(-D), m.scatter_anisotropy);
}

/* Through the far side too, which tints as the near one does. What is reflected inside leaves elsewhere and is
 * replaced by what arrives from there: no energy is lost. */
vec3 light_through_volume(Layers m, vec3 V, float eta)
{
    vec3 D = refract_or_zero(-V, m.base.N, eta);
    vec3 P = v_position + D * m.thickness;
    float own = refracted_alpha(m.base.alpha, eta);
    vec3 T = volume_transmittance(m.attenuation_color, m.attenuation_distance, m.thickness);
    vec3 light = light_behind(place_in_image(P), D, opaque_lod(m), own * own, m.base.base_color * T);
    if (has_layer(m, LAYER_SCATTER))
        light += (1.0 - T) * scattered_light(m, D);
    return light;
}

/* Out of a volume that the eye is in, or whose near side is missing. */
vec3 light_out_of_volume(Layers m, vec3 V, float eta)
{
    vec3 D = refract_or_zero(-V, m.base.N, eta);
    float own = refracted_alpha(m.base.alpha, eta);
    if (dot(D, D) < 0.5)
        return environment_seen(normalize(reflect(-V, m.base.N)), m.base.alpha * m.base.alpha);
    return light_behind(place_in_image(v_position + D * m.thickness), D, opaque_lod(m), own * own, vec3(1.0));
}

/* ---- both ---- */

vec3 transmitted_light_of_ior(Layers m, vec3 V, float eta)
{
    if (layers_is_inside(m))
        return light_out_of_volume(m, V, eta);
    return light_through_volume(m, V, eta);
}

/* One layer of the image. */
vec3 light_in_image(Layers m, vec3 V)
{
    if (!has_layer(m, LAYER_VOLUME))
        return light_through_wall(m, V);
#ifdef HAS_DISPERSION
    vec3 light = vec3(0.0);
    for (int channel = 0; channel < 3; channel++) {
        backdrop_channels = vec3(channel == 0, channel == 1, channel == 2);
        light += transmitted_light_of_ior(m, V, layers_eta(m, channel)) * backdrop_channels;
    }
    return light;
#else
    return transmitted_light_of_ior(m, V, max(m.eta, 1e-3));
#endif
}

#if defined(IS_TRACING)
vec3 traced_light(Layers m, vec3 V); /* glass.glsl */
#elif defined(IS_TRACED)
uniform highp sampler2DArray u_traced; /* gl_glass.h */

/* How far a pixel's traced surface is from the one that is shaded, in pixels; huge: another material, or none. */
float traced_distance(ivec2 at, float pixel)
{
    float material = texelFetch(u_traced, ivec3(at, 1), 0).w;
    if (abs(material - volume_factors.z - 1.0) > 0.5)
        return 1e30;
    return abs(texelFetch(u_traced, ivec3(at, 0), 0).w - dot(v_position, forward.xyz)) / pixel;
}

/* Found by the rays of this pixel, or, where it has another surface in its middle, by those of the most similar one
 * around it. Where none is similar, the surface is thinner than a pixel. */
vec3 traced_light(Layers m, vec3 V)
{
    float pixel = length(right.xyz) * (eye.w > 0.5 ? 1.0 : dot(v_position, forward.xyz));
    ivec2 size = textureSize(u_traced, 0).xy, middle = ivec2(gl_FragCoord.xy), best = middle;
    float least = traced_distance(middle, pixel);
    if (least > 4.0)
        for (int i = 0; i < 9; i++) {
            ivec2 offset = ivec2(i % 3, i / 3) - 1, at = clamp(middle + offset, ivec2(0), size - 1);
            float far = traced_distance(at, pixel) + 2.0 * length(vec2(offset));
            if (far < least) {
                least = far;
                best = at;
            }
        }
    if (least >= 1e30)
        return light_in_image(m, V);
    backdrop_share = texelFetch(u_traced, ivec3(best, 1), 0).xyz;
    backdrop_unseen = texelFetch(u_traced, ivec3(best, 2), 0).xyz;
    return texelFetch(u_traced, ivec3(best, 0), 0).xyz;
}
#endif

/* Radiance (cd/m^2) that reaches the boundary from behind: LayerLight.transmitted. */
vec3 transmitted_light(Layers m, vec3 V)
{
#if defined(IS_TRACED) || defined(IS_TRACING)
    return traced_light(m, V);
#else
    return light_in_image(m, V);
#endif
}
#endif
