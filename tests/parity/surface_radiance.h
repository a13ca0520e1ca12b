/* surface_radiance.h - parity cases: composed radiance of a surface, with the look-ups of surface_host.h. */

FN SurfaceHost parity_surface_host(vec2 u)
{
    SurfaceHost host;
    host.P = vec3(u[0] - 0.5f, u[1] - 0.5f, 0.0f);
    host.V = parity_V(u);
    host.energy = sel(u[1] < 0.5f, ENERGY_GLTF, ENERGY_CONSERVING);
    host.is_dark = u[0] * 16.0f - floor(u[0] * 16.0f) < 0.2f;
    return host;
}

/* ---- surface_tables.h ---- */

FN vec3 case_surface_tables(vec2 u)
{
    Layers m = parity_layers(u);
    LayerTables t = surface_tables(m, parity_V(u), sel(u[1] < 0.5f, ENERGY_GLTF, ENERGY_CONSERVING));
    return vec3(t.dfg[0], t.dfg[1], t.sheen_E) + t.glass + vec3(t.clearcoat_E, t.transmission_E, 0.0f);
}

/* ---- surface_radiance.h ---- */

FN vec3 case_plain_radiance(vec2 u)
{
    return plain_radiance(parity_surface_host(u), parity_surface(u));
}

FN vec3 case_rough_light(vec2 u)
{
    SurfaceHost host = parity_surface_host(u);
    vec3 N = normalize(vec3(u[0] - 0.5f, 0.2f, 1.0f));
    RoughLight light = rough_light(host, N, host.V, clamp(dot(N, host.V), 0.0f, 1.0f), u[1]);
    return light.single + light.multiple * 0.5f;
}

FN vec3 case_layer_light(vec2 u)
{
    SurfaceHost host = parity_surface_host(u);
    Layers m = parity_layers(u);
    VolumeExit e = diffuse_exit(host, m);
    LayerLight light = layer_light(host, m, e);
    Light l = host_punctual(host, host_first_light(host));
    return light.specular + light.irradiance_over_pi + light.irradiance_back_over_pi + light.clearcoat +
           light.sheen + light.transmitted + light.rough.single + light.rough_back.multiple + e.normal +
           e.distance_m + sheen_albedo_of_light(host, m, l) + base_specular(host, m);
}

FN vec3 case_layered_radiance(vec2 u)
{
    SurfaceHost host = parity_surface_host(u);
    Layers m = parity_layers(u);
    return layered_radiance(host, m, surface_tables(m, host.V, host.energy));
}
