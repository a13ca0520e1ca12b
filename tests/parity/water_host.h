/* water_host.h - look-ups of shade/compose/sea_radiance.h in closed form, for the parity cases. */

STRUCT(SeaHost)
{
    vec2 u;
    bool is_below;
    bool has_bed;
    bool has_model;
};

STRUCT(SeaPosition)
{
    vec3 at;
};

STRUCT(SeaSlopes)
{
    vec3 resolved;
    float curvature;
    float rate;
};

STRUCT(SeaPlace)
{
    SeaPosition P;
    vec3 V;
    WaterPoint point;
    SeaSlopes slopes;
    float footprint_m;
    float pixel_m;
    float height_m;
    float cosine;
};

FN Water host_water(SeaHost host)
{
    Water w;
    w.ior = 1.34f;
    w.absorption = vec3(0.33f, 0.06f, 0.02f + 0.1f * host.u[1]);
    w.scattering = vec3(0.09f, 0.11f, 0.14f);
    w.backscattering = vec3(0.002f, 0.003f, 0.005f);
    w.reflectance = vec3(0.001f, 0.006f, 0.024f);
    w.pure_share = vec3(0.01f, 0.02f, 0.03f);
    w.sky_reflectance = 0.06f;
    w.foam_albedo = 0.5f;
    w.normals = WATER_BECKMANN;
    w.masking = WATER_SCALES;
    w.is_schlick = 0;
    return w;
}

FN WaterLight host_light(SeaHost host)
{
    WaterLight light;
    light.L = normalize(vec3(0.5f - host.u[0], 0.6f, 0.3f));
    light.sun_irradiance = vec3(5.0f, 4.0f, 3.0f);
    light.sky_irradiance = vec3(1.0f, 2.0f, 3.0f);
    light.sun_fresnel = 0.1f;
    light.downwelling = water_downwelling(host_water(host), light);
    return light;
}

FN WaterCrest host_crest(SeaHost host)
{
    return water_crest_beam(host_water(host), host_light(host), 0.05f, 0.3f, 1.5f);
}

FN vec3 host_sunbeam(SeaHost host)
{
    return water_beam_below(host_water(host), host_light(host));
}

FN vec3 host_sunward(SeaHost host)
{
    return -water_refracted(host_water(host), -host_light(host).L, vec3(0.0f, 1.0f, 0.0f));
}

FN WaterMeans host_means(SeaHost host, float mu, float sigma)
{
    WaterMeans m;
    m.fresnel = 0.9f - 0.2f * mu + 0.1f * host.u[0];
    m.escape = 0.95f;
    m.lift = 0.3f * sigma;
    m.spread = 0.1f * sigma;
    m.below = 0.0f;
    m.elevation = 0.0f;
    return m;
}

FN vec3 host_sky(SeaHost host, vec3 R, float perceptual_roughness)
{
    return mix(vec3(2.0f) + R, vec3(1.5f, 1.7f, 1.9f + host.u[0]), perceptual_roughness);
}

FN bool host_is_below(SeaHost host)
{
    return host.is_below;
}

FN bool host_has_glints(SeaHost host)
{
    return !host.is_below;
}

FN float host_shutter_s(SeaHost host)
{
    return 0.01f + 0.01f * host.u[0];
}

FN float host_glint_time(SeaHost host)
{
    return 3.7f + sel(host.is_below, 1.0f, 0.0f);
}

FN vec2 host_rest_from_eye(SeaHost host, SeaPlace p)
{
    return vec2(3.0f + 0.1f * host.u[0], 4.0f + 0.1f * p.height_m);
}

FN vec2 host_rest(SeaHost host, SeaPlace p)
{
    return host_rest_from_eye(host, p) + 1.0f;
}

FN WaterStyle host_style(SeaHost host)
{
    WaterStyle s;
    s.variant = int(host.u[0] * 1.99f);
    s.stage = int(host.u[1] * 2.99f);
    s.perceptual_roughness = 0.3f;
    s.has_foam = true;
    s.has_sparkles = true;
    return s;
}

FN SeaPosition host_position(SeaPlace p)
{
    return p.P;
}

FN float host_height(SeaPlace p)
{
    return p.P.at[1];
}

FN SeaPosition host_along(SeaPosition P, vec3 d, float x)
{
    SeaPosition r;
    r.at = P.at + d * x;
    return r;
}

FN SeaPosition host_sunk(SeaPosition P)
{
    SeaPosition r;
    r.at = vec3(P.at[0], min(P.at[1], 0.0f), P.at[2]);
    return r;
}

FN float host_depth(SeaPosition P)
{
    return max(-P.at[1], 0.0f);
}

FN bool host_has_bed(SeaHost host)
{
    return host.has_bed;
}

FN bool host_has_light_on_bed(SeaHost host)
{
    return host.has_bed;
}

FN vec3 host_bed_albedo(SeaHost host)
{
    return vec3(0.5f, 0.4f, 0.3f + 0.1f * host.u[0]);
}

FN float host_bed_rise(SeaHost host, vec3 d)
{
    return 0.1f * host.u[1] * d[0];
}

FN float host_bed_depth(SeaHost host, SeaPosition P)
{
    return 6.0f - 0.1f * host.u[1] * P.at[0];
}

FN float host_over_bed(SeaHost host, SeaPosition P)
{
    return P.at[1] + host_bed_depth(host, P);
}

FN float host_distance_to_bed(SeaHost host, SeaPosition P, vec3 d)
{
    float closing = max(host_bed_rise(host, d) - d[1], 1e-3f);
    return sel(host.has_bed, min(host_over_bed(host, P) / closing, 100.0f), WATER_FAR_M);
}

FN vec2 host_bed_visibility(SeaHost host, SeaPosition P)
{
    return vec2(0.7f + 0.1f * host.u[0], 0.9f - 0.01f * min(abs(P.at[0]), 9.0f));
}

FN vec2 host_caustics(SeaHost host, SeaPosition P, float width)
{
    return vec2(0.6f + 0.2f * host.u[1] + 0.01f * min(width + abs(P.at[2]), 9.0f), 0.3f);
}

FN bool host_has_model(SeaHost host)
{
    return host.has_model;
}

FN vec3 host_model_low(SeaHost host, SeaPlace p)
{
    return vec3(-3.0f, -1.0f - host.u[0], -9.0f) - p.P.at;
}

FN vec3 host_model_high(SeaHost host, SeaPlace p)
{
    return vec3(3.0f, 2.0f + host.u[1], -4.0f) - p.P.at;
}

FN float host_sun_visibility(SeaHost host, SeaPlace p)
{
    return 0.8f - 0.1f * host.u[0] + 0.01f * p.height_m;
}

FN FacetHit host_model_hit(SeaHost host, SeaPlace p, vec3 d, bool is_transmitted, bool is_alone)
{
    FacetHit hit;
    hit.opacity = sel(is_transmitted, 0.4f, 0.8f) * clamp(0.5f - d[2], 0.0f, 1.0f);
    hit.radiance = vec3(0.5f, 0.6f, 0.7f) + 0.1f * d;
    hit.distance = sel(is_alone, 4.0f, 3.0f + host.u[0]);
    hit.height = p.P.at[1] + d[1] * hit.distance;
    hit.depth = max(-p.P.at[1], 0.0f);
    return hit;
}

FN int host_facet_count(SeaHost host)
{
    return sel(host.is_below, 4, 5);
}

FN uint host_random(SeaHost host)
{
    return hash_uint(sel(host.is_below, 7u, 9u));
}
