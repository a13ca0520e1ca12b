/* ogl1_light.h - light at a point of a surface by OpenGL 1, in a fragment or at a vertex. Types and look-ups of the
 * host (see surface_radiance.h): src/cpu/ogl1_shade.c and src/gl/shaders/phong.glsl.
 *
 *     Ogl1Host      a point of a surface
 *     Ogl1Cursor    a place in the sequence of lights; has_light: not at its end
 *
 *     PhongFrame host_frame(host), PhongSurface host_surface(host)
 *     vec3 host_P(host), host_V(host)        eye space: m; unit, to the eye
 *     bool host_is_front(host)               which side is visible
 *     vec3 host_normal(host)                 unit, eye space, on the front
 *     bool host_has_vertex_colors(host)
 *     PhongColor host_vertex_color(host)     in the values of the computation
 *     bool host_separates_highlight(host)    to be added after the texture
 *     Ogl1Cursor host_first_ogl1_light(host), host_next_ogl1_light(host, cursor)
 *     PhongLight host_ogl1_light(host, cursor) */
#ifndef SHADE_COMPOSE_OGL1_LIGHT_H
#define SHADE_COMPOSE_OGL1_LIGHT_H
#include "shade/lang/lang_c_begin.h"

/* Diffuse color and opacity before any map. */
FN PhongColor ogl1_color(Ogl1Host host)
{
    PhongColor c;
    c.rgb = host_surface(host).material.diffuse;
    c.opacity = host_surface(host).opacity;
    if (host_has_vertex_colors(host)) {
        PhongColor vertex = host_vertex_color(host);
        c.rgb = sel(host_frame(host).has_rgl_colors, vertex.rgb, c.rgb * vertex.rgb);
        c.opacity *= vertex.opacity;
    }
    return c;
}

/* N: on the front. */
FN PhongLit ogl1_light_at(Ogl1Host host, PhongMaterial m, vec3 N)
{
    PhongRules r = host_frame(host).rules;
    vec3 lit_N = phong_normal(r, N, host_V(host), host_is_front(host));
    PhongLit lit = phong_unlit_part(r, m);
    for (Ogl1Cursor c = host_first_ogl1_light(host); c.has_light; c = host_next_ogl1_light(host, c))
        lit = phong_add(lit,
                        phong_light_part(r, m, host_ogl1_light(host, c), host_P(host), lit_N, host_V(host)));
    return lit;
}

/* At a corner of a triangle, clamped to the range of a color register for interpolation. */
FN PhongLit ogl1_light_at_corner(Ogl1Host host)
{
    PhongMaterial m = host_surface(host).material;
    m.diffuse = ogl1_color(host).rgb;
    PhongLit lit = ogl1_light_at(host, m, host_normal(host));
    if (!host_separates_highlight(host))
        lit = phong_with_highlight(lit);
    if (host_frame(host).is_encoded) {
        lit.color = clamp(lit.color, 0.0f, 1.0f);
        lit.highlight = clamp(lit.highlight, 0.0f, 1.0f);
    }
    return lit;
}

#include "shade/lang/lang_c_end.h"
#endif
