/* sea_host.glsl - look-ups of shade/compose/sea_radiance.h: the water and its light, the bed and the light on it
 * (caustic_map.c and bed_shadow.c with textures). */
uniform highp sampler2D u_sea_means; /* means over microfacets: water_table.h */
uniform highp sampler2DArray u_sea_caustics;

#ifdef HAS_MODEL
uniform highp sampler2D u_sea_contact; /* sea_contact */
#endif

#define SeaPosition vec3 /* x, z from the eye; y over still water; m */

struct SeaHost
{
    uint random; /* of a pixel */
};

Water host_water(SeaHost host)
{
#ifdef HAS_OTHER_MICROFACETS
    ivec3 facets = ivec3(sea_backscattering.w, sea_reflectance.w, sea_pure_share.w);
#else
    /* constant, so the compiler removes the other models */
    const ivec3 facets = ivec3(WATER_BECKMANN, WATER_SCALES, 0);
#endif
    return Water(sea_absorption.w, sea_absorption.xyz, sea_scattering.xyz, sea_backscattering.xyz, sea_reflectance.xyz, sea_pure_share.xyz,
                 sea_sun_irradiance.w, sea_scattering.w, facets.x, facets.y, facets.z);
}

WaterLight host_light(SeaHost host)
{
    return WaterLight(sea_sun.xyz, sea_sun_irradiance.xyz, sea_sky_irradiance.xyz, sea_downwelling.xyz, sea_sun.w);
}

WaterCrest host_crest(SeaHost host)
{
    return WaterCrest(sea_crest_beam.xyz, sea_crest_sunward.xyz, sea_crest_beam.w, sea_crest_sunward.w);
}

vec3 host_sunbeam(SeaHost host)
{
    return sea_beam.xyz;
}

vec3 host_sunward(SeaHost host)
{
    return sea_sunward.xyz;
}

/* Channels: fresnel, escape, lift, spread. */
WaterMeans host_means(SeaHost host, float mu, float sigma)
{
    vec2 place = (water_table_place(mu, sigma) + 0.5) / vec2(WATER_TABLE_COLUMNS, WATER_TABLE_ROWS);
    vec4 means = textureLod(u_sea_means, place, 0.0);
    return WaterMeans(means.x, means.y, means.z, means.w, 0.0, 0.0);
}

bool host_is_below(SeaHost host)
{
#ifdef IS_BELOW
    return true;
#else
    return false;
#endif
}

/* ---- style and glints ---- */

bool host_has_glints(SeaHost host)
{
#ifdef HAS_GLINTS
    return true;
#else
    return false;
#endif
}

float host_shutter_s(SeaHost host)
{
    return sea_downwelling.w;
}

float host_glint_time(SeaHost host)
{
    return sea_sky_irradiance.w;
}

WaterStyle host_style(SeaHost host)
{
    return WaterStyle(sea_style.y, sea_style.x, sea_bed_slope.z, sea_style.z != 0, sea_style.w != 0);
}

/* ---- positions ---- */

vec3 host_along(vec3 P, vec3 d, float x)
{
    return P + x * d;
}

vec3 host_sunk(vec3 P)
{
    return vec3(P.x, min(P.y, 0.0), P.z);
}

float host_depth(vec3 P)
{
    return max(-P.y, 0.0);
}

/* ---- the bed ---- */

bool host_has_bed(SeaHost host)
{
#ifdef HAS_BED
    return true;
#else
    return false;
#endif
}

bool host_has_light_on_bed(SeaHost host)
{
    return sea_caustic_axis.z > 0.0 || sea_shadow.z > 0.0;
}

vec3 host_bed_albedo(SeaHost host)
{
    return sea_bed.xyz;
}

float host_bed_rise(SeaHost host, vec3 d)
{
    return dot(sea_bed_slope.xy, d.xz);
}

float host_bed_depth(SeaHost host, vec3 P)
{
    return sea_bed.w - dot(sea_bed_slope.xy, P.xz);
}

float host_over_bed(SeaHost host, vec3 P)
{
    return P.y + sea_bed.w - dot(sea_bed_slope.xy, P.xz);
}

float host_distance_to_bed(SeaHost host, vec3 P, vec3 d)
{
#ifdef HAS_BED
    float closing = dot(sea_bed_slope.xy, d.xz) - d.y;
    float above = host_over_bed(host, P);
    if (above <= 0.0)
        return 0.0;
    return closing > 1e-9 ? min(above / closing, WATER_FAR_M) : WATER_FAR_M;
#else
    return WATER_FAR_M;
#endif
}

/* bed_shadow_at(). */
vec2 host_bed_visibility(SeaHost host, vec3 P)
{
#ifdef HAS_MODEL
    vec2 place = (P.xz - sea_shadow.xy) * sea_shadow.zw;
    bool is_within = all(greaterThan(place, vec2(0.0))) && all(lessThan(place, vec2(1.0)));
    vec2 visibility = textureLod(u_sea_contact, place, 0.0).zw;
    return is_within ? visibility : vec2(1.0);
#else
    return vec2(1.0);
#endif
}

/* caustic_map_within(). */
vec2 host_caustics(SeaHost host, vec3 P, float width)
{
    float sum = 0.0;
    float beyond = 1.0;
    for (int l = 0; l < SEA_CAUSTIC_LAYERS && sea_caustic_axis.z > 0.0; l++) {
        vec2 from = P.xz - sea_caustics[l].xy;
        vec2 uv = sea_caustics[l].z * vec2(dot(from, sea_caustic_axis.xy), sea_caustic_axis.x * from.y - sea_caustic_axis.y * from.x);
        float cover = beyond * caustic_cover(uv);
        if (cover > 0.0)
            sum += cover * textureLod(u_sea_caustics, vec3(0.5 * uv + 0.5, float(l)), caustic_lod(width / sea_caustics[l].w)).x;
        beyond -= cover;
    }
    return vec2(sum, beyond);
}
