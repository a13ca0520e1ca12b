/* surface_host.h - look-ups of shade/compose/surface_*.h in closed form, for the parity cases. */

/* ---- LUTs ---- */

FN vec2 host_split_sum(vec2 point)
{
    return vec2(0.9f - 0.4f * point[1] * point[0], 0.05f + 0.1f * point[1]);
}

FN float host_sheen_albedo(float NdotV, float sheen_roughness)
{
    return 0.2f + 0.3f * NdotV * sheen_roughness;
}

FN vec3 host_glass(float NdotV, float perceptual_roughness, float eta)
{
    return vec3(0.1f + 0.2f * NdotV, 0.9f - 0.1f * perceptual_roughness, 0.8f + 0.1f * min(eta, 1.0f));
}

/* ---- environment ---- */

STRUCT(SurfaceHost)
{
    vec3 P;
    vec3 V;
    int energy;
    bool is_dark; /* without an environment */
};

FN bool host_has_environment(SurfaceHost host)
{
    return !host.is_dark;
}

FN vec3 host_specular(SurfaceHost host, vec3 R, float perceptual_roughness)
{
    return mix(vec3(1.0f) + R + host.P, vec3(0.7f, 0.8f, 0.9f), perceptual_roughness);
}

FN vec3 host_sheen(SurfaceHost host, vec3 N, float sheen_roughness)
{
    return vec3(1.1f) + host.P + N * (0.5f - 0.4f * sheen_roughness);
}

FN vec3 host_irradiance_over_pi(SurfaceHost host, vec3 N)
{
    return vec3(0.6f) + host.P * 0.1f + N * 0.3f;
}

FN vec3 host_unoccluded_irradiance_over_pi(SurfaceHost host, vec3 N)
{
    return vec3(0.6f) + host.P * 0.1f + N * (0.3f + 0.1f * N[1]);
}

FN vec3 host_ambient(SurfaceHost host)
{
    return vec3(0.8f, 0.9f, 0.7f) - host.P * 0.1f;
}

/* ---- volumes ---- */

STRUCT(VolumeExit)
{
    float distance_m;
    vec3 normal;
};

FN VolumeExit host_exit(SurfaceHost host, Layers m)
{
    VolumeExit e;
    e.distance_m = 2.0f * m.thickness + 0.1f * host.V[2];
    e.normal = normalize(vec3(0.1f, 0.2f, -1.0f));
    return e;
}

FN vec3 host_transmitted(SurfaceHost host, Layers m)
{
    return vec3(0.5f, 0.7f, 0.6f) * (m.transmission * host.V[2]);
}

/* ---- punctual lights ---- */

STRUCT(LightCursor)
{
    int light;
    bool has_light;
};

FN LightCursor host_first_light(SurfaceHost host)
{
    LightCursor c;
    c.light = sel(host.is_dark, 1, 0);
    c.has_light = true;
    return c;
}

FN LightCursor host_next_light(SurfaceHost host, LightCursor c)
{
    c.light += 1;
    c.has_light = c.light < sel(host.is_dark, 2, 3);
    return c;
}

FN Light host_punctual(SurfaceHost host, LightCursor c)
{
    return light_point(host.V + vec3(2.0f * float(c.light) - 1.5f, 0.5f, 2.0f), vec3(3.0f, 2.0f, 1.0f), 0.0f);
}

FN vec3 host_reflected(SurfaceHost host, Layers m, Light l, LayerTables t, float sheen_E_L)
{
    return layers_punctual(m, host.P, host.V, l, host.energy, t, sheen_E_L);
}
