/* ogl1_host.h - look-ups of shade/compose/ogl1_*.h in closed form, for the parity cases. */

STRUCT(Ogl1Host)
{
    PhongFrame frame;
    PhongSurface surface;
    vec3 P;
    vec3 V;
    bool is_front;
    int maps; /* bits of PHONG_*_MAP */
};

FN vec3 host_P(Ogl1Host host)
{
    return host.P;
}

FN vec3 host_V(Ogl1Host host)
{
    return host.V;
}

FN bool host_is_front(Ogl1Host host)
{
    return host.is_front;
}

FN PhongFrame host_frame(Ogl1Host host)
{
    return host.frame;
}

FN PhongSurface host_surface(Ogl1Host host)
{
    return host.surface;
}

FN vec3 host_normal(Ogl1Host host)
{
    return normalize(vec3(0.1f, 0.2f, 1.0f) + host.P * 0.1f);
}

FN bool host_has_vertex_colors(Ogl1Host host)
{
    return host.P[0] > 0.0f;
}

FN PhongColor host_vertex_color(Ogl1Host host)
{
    PhongColor c;
    c.rgb = vec3(0.9f, 0.6f, 0.3f) * host.V[2];
    c.opacity = 0.8f;
    return c;
}

/* ---- light ---- */

STRUCT(Ogl1Cursor)
{
    int light;
    bool has_light;
};

FN Ogl1Cursor host_next_ogl1_light(Ogl1Host host, Ogl1Cursor c)
{
    c.light += 1;
    c.has_light = c.light < sel(host.is_front, 2, 3);
    return c;
}

FN Ogl1Cursor host_first_ogl1_light(Ogl1Host host)
{
    Ogl1Cursor c;
    c.light = -1;
    return host_next_ogl1_light(host, c);
}

/* The second one is a punctual light. */
FN PhongLight host_ogl1_light(Ogl1Host host, Ogl1Cursor c)
{
    vec3 position = vec3(float(c.light) - 1.0f, 2.0f, 0.0f);
    if (c.light != 1)
        return phong_light_point(position, vec3(0.1f), vec3(0.4f, 0.5f, 0.3f), vec3(0.2f));
    LightSample l = light_illuminate(light_point(position, vec3(20.0f, 10.0f, 30.0f), 0.0f), host.P);
    return phong_light_punctual(host_frame(host), l, l.L);
}

FN bool host_separates_highlight(Ogl1Host host)
{
    return host_frame(host).rules.separates_highlight;
}

FN bool host_is_lit(Ogl1Host host)
{
    return host.P[1] > -0.4f;
}

FN bool host_is_lit_at_vertices(Ogl1Host host)
{
    return host_frame(host).rules.is_lit_at_vertices;
}

FN PhongLit host_light_of_vertices(Ogl1Host host)
{
    PhongLit lit;
    lit.color = vec3(0.5f, 0.4f, 0.3f) * host.V[2];
    lit.highlight = vec3(0.2f);
    return lit;
}

/* ---- maps ---- */

FN bool host_has_map(Ogl1Host host, int map)
{
    return (host.maps >> map & 1) != 0;
}

FN PhongColor host_map_color(Ogl1Host host, int map)
{
    PhongColor c;
    c.rgb = vec3(0.2f, 0.5f, 0.1f) * float(map) + 0.1f * host.V;
    c.opacity = 0.7f;
    return c;
}

FN float host_map_scalar(Ogl1Host host, int map)
{
    return 0.1f * float(map) + 0.2f * host.V[2];
}

FN vec3 host_mapped_normal(Ogl1Host host)
{
    return normalize(host_normal(host) + vec3(0.2f, 0.0f, 0.0f));
}

FN bool host_is_see_through(Ogl1Host host)
{
    return host.is_front;
}
