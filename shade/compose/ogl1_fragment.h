/* ogl1_fragment.h - a fragment by OpenGL 1, in its order: light, texture, the highlight where it is separate, fog,
 * clamp. Look-ups of the host besides those of ogl1_light.h; map is one of PHONG_*_MAP:
 *
 *     bool host_has_map(host, map)
 *     PhongColor host_map_color(host, map)    with base and gain
 *     float host_map_scalar(host, map)        of the selected channel, with base and gain
 *     vec3 host_mapped_normal(host)           host_normal() bent by the normal map
 *     bool host_is_lit(host), host_is_lit_at_vertices(host), host_is_see_through(host)
 *     PhongLit host_light_of_vertices(host)   light of ogl1_light_at_corner(), interpolated; flat: of the last corner
 */
#ifndef SHADE_COMPOSE_OGL1_FRAGMENT_H
#define SHADE_COMPOSE_OGL1_FRAGMENT_H
#include "shade/lang/lang_c_begin.h"

/* ---- light ---- */

/* Applies the maps of the lighting terms to their constants. */
FN PhongMaterial ogl1_mapped_material(Ogl1Host host, vec3 diffuse)
{
    PhongMaterial m = host_surface(host).material;
    m.diffuse = diffuse;
    if (host_has_map(host, PHONG_AMBIENT_MAP))
        m.ambient *= host_map_color(host, PHONG_AMBIENT_MAP).rgb;
    if (host_has_map(host, PHONG_SPECULAR_MAP))
        m.specular *= host_map_color(host, PHONG_SPECULAR_MAP).rgb;
    if (host_has_map(host, PHONG_EMISSION_MAP))
        m.emission *= host_map_color(host, PHONG_EMISSION_MAP).rgb;
    if (host_has_map(host, PHONG_SHININESS_MAP))
        m.shininess = max(m.shininess * host_map_scalar(host, PHONG_SHININESS_MAP), 0.0f);
    return m;
}

FN PhongLit ogl1_light(Ogl1Host host, vec3 diffuse)
{
    if (host_is_lit_at_vertices(host))
        return host_light_of_vertices(host);
    return phong_with_highlight(
        ogl1_light_at(host, ogl1_mapped_material(host, diffuse), host_mapped_normal(host)));
}

/* ---- color and opacity ---- */

FN PhongColor ogl1_with_texture(Ogl1Host host, PhongColor c)
{
    if (!host_has_map(host, PHONG_DIFFUSE_MAP))
        return c;
    return phong_texture(host_surface(host).texture_type, host_surface(host).texture_mode, c,
                         host_map_color(host, PHONG_DIFFUSE_MAP));
}

/* Diffuse color and opacity with vertex colors and the opacity map, without the diffuse map. */
FN PhongColor ogl1_base_color(Ogl1Host host)
{
    PhongColor c = ogl1_color(host);
    if (host_surface(host).is_halo)
        c.opacity = phong_halo(c.opacity, abs(dot(host_normal(host), host_V(host))));
    if (host_has_map(host, PHONG_OPACITY_MAP))
        c.opacity *= host_map_scalar(host, PHONG_OPACITY_MAP);
    return c;
}

/* The lit fragment before fog. */
FN PhongColor ogl1_lit_color(Ogl1Host host)
{
    bool is_over = host_surface(host).has_texture_over_light;
    PhongColor c = ogl1_base_color(host);
    if (!is_over)
        c = ogl1_with_texture(host, c);
    PhongLit lit;
    lit.color = c.rgb;
    lit.highlight = vec3(0.0f);
    if (host_is_lit(host))
        lit = ogl1_light(host, c.rgb);
    c.rgb = lit.color;
    if (is_over)
        c = ogl1_with_texture(host, c);
    c.rgb += lit.highlight;
    return c;
}

/* Coverage of a color with this opacity. */
FN float ogl1_coverage(Ogl1Host host, float opacity)
{
    return sel(host_is_see_through(host), clamp(opacity, 0.0f, 1.0f), 1.0f);
}

/* Display-encoded values in [0, 1], or linear light; and coverage. */
FN PhongColor ogl1_fragment(Ogl1Host host)
{
    PhongColor c = ogl1_lit_color(host);
    if (host_frame(host).is_encoded && host_frame(host).rules.is_lit_at_vertices)
        c.rgb = clamp(c.rgb, 0.0f, 1.0f); /* the color sum, before fog */
    if (host_surface(host).has_fog)
        c.rgb = phong_fogged(host_frame(host).rules, host_frame(host).fog, c.rgb, -host_P(host)[2]);
    if (host_frame(host).is_encoded)
        c.rgb = clamp(c.rgb, 0.0f, 1.0f);
    c.opacity = ogl1_coverage(host, c.opacity);
    return c;
}

#include "shade/lang/lang_c_end.h"
#endif
