/* radiance.glsl - the look-ups of shade/compose/surface_tables.h and surface_radiance.h, which follow. */

vec2 host_split_sum(vec2 point)
{
#ifdef HAS_SCHLICK_GGX
    return integrate_dfg_karis(point.y, point.x, 128u);
#else
    return table_dfg(point.x, point.y);
#endif
}

float host_sheen_albedo(float NdotV, float sheen_roughness)
{
    return table_sheen_albedo(NdotV, sheen_roughness);
}

vec3 host_glass(float NdotV, float perceptual_roughness, float eta)
{
    return table_glass(NdotV, perceptual_roughness, eta);
}

struct SurfaceHost
{
    vec3 P; /* m, relative to the eye */
    vec3 V;
    int energy;
};

SurfaceHost surface_host(vec3 V)
{
    return SurfaceHost(v_position, V, energy);
}

/* ---- environment ---- */

bool host_has_environment(SurfaceHost host)
{
#ifdef HAS_ENVIRONMENT
    return true;
#else
    return false;
#endif
}

vec3 host_specular(SurfaceHost host, vec3 R, float perceptual_roughness)
{
    return light_specular(R, perceptual_roughness);
}

vec3 host_sheen(SurfaceHost host, vec3 N, float sheen_roughness)
{
    return light_sheen(N, sheen_roughness);
}

vec3 host_irradiance_over_pi(SurfaceHost host, vec3 N)
{
    return light_irradiance_over_pi(N);
}

vec3 host_unoccluded_irradiance_over_pi(SurfaceHost host, vec3 N)
{
    return light_irradiance_over_pi(N);
}

vec3 host_ambient(SurfaceHost host)
{
    return vec3(1.0);
}

/* ---- volumes ---- */

struct VolumeExit
{
    float distance_m;
    vec3 normal;
};

/* The CPU traces a ray. */
VolumeExit host_exit(SurfaceHost host, Layers m)
{
    return VolumeExit(m.thickness, -m.base.N);
}

vec3 host_transmitted(SurfaceHost host, Layers m)
{
#ifdef HAS_TRANSMISSION
    return transmitted_light(m, host.V);
#else
    return vec3(0.0);
#endif
}

/* ---- punctual lights ---- */

struct LightCursor
{
    int light, count;
    bool has_light;
};

LightCursor host_first_light(SurfaceHost host)
{
    int count = light_count(host.P);
    return LightCursor(0, count, count > 0);
}

LightCursor host_next_light(SurfaceHost host, LightCursor c)
{
    return LightCursor(c.light + 1, c.count, c.light + 1 < c.count);
}

Light host_punctual(SurfaceHost host, LightCursor c)
{
    return light_at(c.light);
}

/* What another visibility term of the base adds to the highlight of a punctual light. */
vec3 specular_variant(SurfaceHost host, Layers m, Light l, LayerTables t, float sheen_E_L)
{
#ifdef HAS_SCHLICK_GGX
    float NdotL = dot(m.base.N, light_illuminate(l, host.P).L);
    if (NdotL > 0.0)
        return layers_punctual_alone(m, host.P, host.V, l, host.energy, t, sheen_E_L, ALONE_SPECULAR) *
               (schlick_GGX_over_smith(min(NdotL, 1.0), surface_NdotV(m.base, host.V), max(m.base.alpha, ALPHA_MIN)) - 1.0);
#endif
    return vec3(0.0);
}

vec3 host_reflected(SurfaceHost host, Layers m, Light l, LayerTables t, float sheen_E_L)
{
    return layers_punctual(m, host.P, host.V, l, host.energy, t, sheen_E_L) + specular_variant(host, m, l, t, sheen_E_L);
}
