/* sea.frag - a pixel of an image of the sea, or of its layers: the surface, or what is visible where there is none.
 * Which of both, and how waves are read, is decided before (sea_class.frag). */
/* resting position of the visible water, from the eye, m; distance, m; the closing rate of rays, 0: there is no
 * water */
uniform highp sampler2D u_sea_seen;

/* Distance within which the model hides the surface. */
float sea_reach(SeaPlace p)
{
#ifdef HAS_MODEL
    if (sea_contact_at(p.at.xz).x > 0.5) /* a hull displaces it */
        return 1e9;
#endif
    return p.t;
}

#ifdef AOVS
layout(location = 0) out highp vec4 aov_normal_depth; /* as in surface_io.glsl */
layout(location = 1) out highp vec4 aov_color_occlusion;
layout(location = 2) out highp vec4 aov_number_texcoord;

#ifdef HAS_MODEL
uniform highp sampler2D u_sea_model_normal; /* the same three of the model */
uniform highp sampler2D u_sea_model_albedo;
uniform highp sampler2D u_sea_model_number;
#endif

const float SEA_NOTHING = -1.0;
const float SEA_WATER = 0.0;
const float SEA_BED = 1.0;
const float SEA_OBJECTS = 2.0; /* numbers of the model's geometries follow */

/* A surface t m away along d, or the model where it is nearer than `reach` m. */
void sea_put_aovs(float number, vec3 N, vec3 albedo, vec3 d, float t, float reach, ivec2 pixel)
{
    float cosine = dot(d, forward.xyz);
    aov_normal_depth = vec4(N, t * cosine);
    aov_color_occlusion = vec4(albedo, 1.0);
    aov_number_texcoord = vec4(number, 0.0, 0.0, number == SEA_NOTHING ? 0.0 : 1.0);
#ifdef HAS_MODEL
    vec4 model = texelFetch(u_sea_model_number, pixel, 0);
    vec4 normal_depth = texelFetch(u_sea_model_normal, pixel, 0);
    if (model.w > 0.0 && normal_depth.w <= reach * cosine) {
        aov_normal_depth = normal_depth;
        aov_color_occlusion = texelFetch(u_sea_model_albedo, pixel, 0);
        aov_number_texcoord = vec4(model.x + SEA_OBJECTS, model.yzw);
    }
#endif
}

/* Distance to the bed that the eye sees without the surface in front of it; 1e9: it sees none. */
float sea_bare_bed(SeaHost host, vec3 d)
{
#ifdef HAS_BED
#ifdef IS_BELOW
    float t = host_distance_to_bed(host, vec3(0.0, sea_eye.x, 0.0), d);
    return t < WATER_FAR_M ? t : 1e9;
#else
    float land = sea_land(d);
    return land > 0.0 ? land : 1e9;
#endif
#else
    return 1e9;
#endif
}

void sea_put_beside(SeaHost host, vec3 d, ivec2 pixel)
{
    float bed = sea_bare_bed(host, d);
    vec3 N = normalize(vec3(-sea_bed_slope.x, 1.0, -sea_bed_slope.y));
    sea_put_aovs(bed < 1e9 ? SEA_BED : SEA_NOTHING, N, sea_bed.xyz, d, bed, bed, pixel);
}

void sea_put_pixel(SeaHost host, vec3 d, vec4 seen, ivec2 pixel)
{
    if (sea_bare_bed(host, d) < seen.z) {
        sea_put_beside(host, d, pixel);
        return;
    }
    Water w = host_water(host);
    SeaPlace p = sea_place(d, seen);
#ifdef IS_BELOW
    vec3 N = -water_faced(p.point.N, d);
    float F = water_fresnel_inside(w, clamp(-dot(N, d), 0.0, 1.0));
#else
    vec3 N = p.point.N;
    float F = water_fresnel(w, clamp(dot(N, p.V), 0.0, 1.0));
#endif
    sea_put_aovs(SEA_WATER, N, vec3(mix(F, w.foam_albedo, p.point.foam)), d, p.t, sea_reach(p), pixel);
}
#else
layout(location = 0) out highp vec4 fragment;

#ifdef HAS_MODEL
/* The model where it is nearer than t m, over what is behind it; both as the eye sees them (legacy: exposed). */
vec3 sea_model_over(SeaHost host, vec3 behind, vec3 d, float t, ivec2 pixel)
{
    SeaModel m = sea_model_at(pixel, d / dot(d, forward.xyz));
    float distance = length(m.at);
    if (m.color.w <= 0.0 || distance > t)
        return behind;
    vec3 L = m.color.xyz / m.color.w;
#if defined(IS_LEGACY)
    L = sea_exposed(L).xyz;
#elif defined(IS_BELOW)
    L = sea_model_behind_water(host, L, sea_eye.x + m.at.y, max(-sea_eye.x, 0.0), d, distance);
#else
    L = sea_through_air(L, d, distance);
#endif
    return mix(behind, L, m.color.w);
}
#else
vec3 sea_model_over(SeaHost host, vec3 behind, vec3 d, float t, ivec2 pixel)
{
    return behind;
}
#endif

#if defined(IS_LEGACY)
vec4 sea_pixel(SeaHost host, vec3 d, vec4 seen, ivec2 pixel)
{
    SeaPlace p = sea_place(d, seen);
    return vec4(sea_model_over(host, sea_legacy(host, p, d), d, sea_reach(p), pixel), 1.0);
}
vec4 sea_beside(SeaHost host, vec3 d, ivec2 pixel)
{
    return vec4(sea_model_over(host, water_legacy_linear(water_legacy_sky(d)), d, 1e9, pixel), 1.0);
}
#elif defined(IS_BELOW)
vec4 sea_beside(SeaHost host, vec3 d, ivec2 pixel)
{
    return sea_exposed(sea_model_over(host, sea_seen_through_water(host, vec3(0.0, sea_eye.x, 0.0), d, 0.0, sea_ray.x * sea_ray.y * dot(d, forward.xyz)), d, 1e9, pixel));
}
vec4 sea_pixel(SeaHost host, vec3 d, vec4 seen, ivec2 pixel)
{
    if (seen.z < host_distance_to_bed(host, vec3(0.0, sea_eye.x, 0.0), d)) {
        SeaPlace p = sea_place(d, seen);
        return sea_exposed(sea_model_over(host, sea_shade_below(host, p, d, p.t, max(-sea_eye.x, 0.0)), d, seen.z, pixel));
    }
    return sea_beside(host, d, pixel);
}
#else
vec4 sea_beside(SeaHost host, vec3 d, ivec2 pixel)
{
    float t = 1e9;
    vec3 radiance = sea_sky_seen(d);
#ifdef HAS_BED
    float land = sea_land(d);
    if (land > 0.0) {
        t = land;
        radiance = sea_land_seen(host, d, land);
    }
#endif
    return sea_exposed(sea_model_over(host, radiance, d, t, pixel));
}
vec4 sea_pixel(SeaHost host, vec3 d, vec4 seen, ivec2 pixel)
{
#ifdef HAS_BED
    float land = sea_land(d);
    if (land > 0.0 && land < seen.z)
        return sea_beside(host, d, pixel);
#endif
    SeaPlace p = sea_place(d, seen);
#ifdef IS_PAINTED
    vec3 radiance = sea_painted(host, p);
#else
    vec3 radiance = sea_shade(host, p);
#endif
    return sea_exposed(sea_model_over(host, sea_through_air(radiance, d, p.t), d, sea_reach(p), pixel));
}
#endif
#endif

void main()
{
    vec2 place = gl_FragCoord.xy + frame_size.zw - 0.5 * frame_size.xy;
    vec3 d = normalize(forward.xyz + right.xyz * place.x + up.xyz * place.y);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    SeaHost host = SeaHost(hash_uint(uint(pixel.y) * 65536u + uint(pixel.x)));
#if defined(AOVS) && defined(IS_BESIDE)
    sea_put_beside(host, d, pixel);
#elif defined(AOVS)
    sea_put_pixel(host, d, texelFetch(u_sea_seen, pixel, 0), pixel);
#elif defined(IS_BESIDE)
    fragment = sea_beside(host, d, pixel);
#else
    fragment = sea_pixel(host, d, texelFetch(u_sea_seen, pixel, 0), pixel);
#endif
}
