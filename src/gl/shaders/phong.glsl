/* phong.glsl - what OpenGL 1's shading needs of an image and of a material (gl_phong.c), and light at a point. The
 * eye space is that of shade/phong.h; values are those of the computation, encoded ones or linear light. */
layout(std140) uniform Ogl1
{
    vec4 ogl1_view[3];     /* rows: world to eye space, of the eye at w, m, for all views of an image */
    /* variant; 1: computed with encoded values; 1: colors are sRGB; number of lights, 0: punctual ones */
    ivec4 ogl1_modes;
    vec4 ogl1_ambient;     /* global; w: 1 rgl's colors */
    vec4 ogl1_fog_color;   /* w: mode */
    vec4 ogl1_fog;         /* near, far, m; scale; w */
    vec4 ogl1_lights[256]; /* four vectors each: position, 1: a point light; ambient; diffuse; specular */
};

layout(std140) uniform Material
{
    vec4 phong_ambient;  /* w: shininess */
    vec4 phong_diffuse;  /* w: opacity */
    vec4 phong_specular; /* w: type of the texture */
    vec4 phong_emission; /* w: its mode */
    /* 1: the texture is multiplied with all light; 1: halo; 1: fog; multiplier of bumps */
    vec4 phong_flags;
    /* three vectors each: rows of the transform, w: the set, 1: trilinear; base, gain, channel */
    vec4 phong_maps[21];
};

bool is_encoded()
{
    return ogl1_modes.y != 0;
}

vec3 ogl1_from_linear(vec3 linear)
{
    return is_encoded() && ogl1_modes.z != 0 ? srgb_from_linear(linear) : linear;
}

vec3 ogl1_to_linear(vec3 computed)
{
    return is_encoded() && ogl1_modes.z != 0 ? linear_from_srgb(computed) : computed;
}

PhongRules ogl1_rules()
{
    PhongRules r = phong_rules(ogl1_modes.x);
    r.global_ambient = ogl1_ambient.xyz;
    return r;
}

/* ---- places ---- */

/* A direction in eye space. */
vec3 to_eye_space(vec3 v)
{
    return vec3(dot(ogl1_view[0].xyz, v), dot(ogl1_view[1].xyz, v), dot(ogl1_view[2].xyz, v));
}

/* A point relative to the eye of the view. In a mirror the lights are where the image has them. */
vec3 point_in_eye_space(vec3 at)
{
    return to_eye_space(at + (eye.xyz - vec3(ogl1_view[0].w, ogl1_view[1].w, ogl1_view[2].w)));
}

vec3 view_in_eye_space(vec3 P)
{
    vec3 axis = vec3(0.0, 0.0, 1.0);
    return eye.w > 0.5 ? axis : normalize_or(-P, axis);
}

/* ---- colors ---- */

PhongMaterial phong_material(vec3 diffuse)
{
    PhongMaterial m;
    m.ambient = phong_ambient.xyz;
    m.diffuse = diffuse;
    m.specular = phong_specular.xyz;
    m.emission = phong_emission.xyz;
    m.shininess = phong_ambient.w;
    return m;
}

/* Diffuse color and opacity before any map; color: of a vertex or interpolated, in the values of the computation. */
PhongColor phong_color(vec4 color)
{
    PhongColor c;
    c.rgb = phong_diffuse.xyz;
    c.opacity = phong_diffuse.w;
#ifdef HAS_COLORS
    c.rgb = ogl1_ambient.w > 0.0 ? color.xyz : c.rgb * color.xyz;
    c.opacity *= color.w;
#endif
    return c;
}

/* ---- light ---- */

PhongLight ogl1_light(int i)
{
    vec4 position = ogl1_lights[4 * i];
    vec3 diffuse = ogl1_lights[4 * i + 2].xyz;
    vec3 specular = ogl1_lights[4 * i + 3].xyz;
    if (position.w > 0.0)
        return phong_light_point(position.xyz, ogl1_lights[4 * i + 1].xyz, diffuse, specular);
    return phong_light_directional(position.xyz, ogl1_lights[4 * i + 1].xyz, diffuse, specular);
}

#ifdef HAS_LIGHTS
/* A punctual light of glTF as a light that shines on this point only: legacy light 1 is the irradiance pi. */
PhongLight ogl1_punctual(Light light, vec3 P)
{
    LightSample l = light_illuminate(light, P);
    vec3 color = ogl1_from_linear(l.E * INV_PI);
    return phong_light_directional(to_eye_space(l.L), vec3(0.0), color, color);
}
#endif

/* at: the point relative to the eye in world directions. N: as in the mesh, in eye space. */
PhongLit light_at_point(PhongMaterial m, vec3 at, vec3 N, bool is_front)
{
    PhongRules r = ogl1_rules();
    vec3 P = point_in_eye_space(at);
    vec3 V = view_in_eye_space(P);
    vec3 lit_N = phong_normal(r, N, V, is_front);
    PhongLit lit = phong_unlit_part(r, m);
    for (int i = 0; i < ogl1_modes.w; i++)
        lit = phong_add(lit, phong_light_part(r, m, ogl1_light(i), P, lit_N, V));
#ifdef HAS_LIGHTS
    int count = ogl1_modes.w > 0 ? 0 : light_count(at);
    for (int i = 0; i < count; i++)
        lit = phong_add(lit, phong_light_part(r, m, ogl1_punctual(light_at(i), at), P, lit_N, V));
#endif
    return lit;
}

PhongLit with_highlight(PhongLit lit)
{
    lit.color += lit.highlight;
    lit.highlight = vec3(0.0);
    return lit;
}

/* At a corner, before interpolation: clamped to the range of a color register. */
PhongLit light_at_corner(vec4 color, vec3 at, vec3 N, bool is_front)
{
    PhongLit lit = light_at_point(phong_material(phong_color(color).rgb), at, N, is_front);
#ifndef HAS_DIFFUSE_MAP
    lit = with_highlight(lit);
#endif
    if (is_encoded()) {
        lit.color = clamp(lit.color, 0.0, 1.0);
        lit.highlight = clamp(lit.highlight, 0.0, 1.0);
    }
    return lit;
}
