/* phong.frag - a material of OpenGL 1. The order is OpenGL's, as in src/cpu/ogl1_shade.c: light, texture, the
 * highlight where it is separate, fog, clamp. All formulas are in shade/phong.h. */
uniform highp sampler2D u_material0;
uniform highp sampler2D u_material1;
uniform highp sampler2D u_material2;
uniform highp sampler2D u_material3;
uniform highp sampler2D u_material4;
uniform highp sampler2D u_material5;
uniform highp sampler2D u_material6;
#ifdef IS_AT_VERTICES
#ifdef IS_FLAT
flat in vec3 v_corner;
flat in vec4 v_corner_color;
#else
in vec3 v_front;
in vec3 v_front_highlight;
in vec3 v_back;
in vec3 v_back_highlight;
#endif
#endif

/* Indices of maps: gl_phong.c. */
#define AMBIENT_MAP 0
#define DIFFUSE_MAP 1
#define SPECULAR_MAP 2
#define EMISSION_MAP 3
#define SHININESS_MAP 4
#define OPACITY_MAP 5
#define NORMAL_MAP 6

/* ---- normals in eye space, on the front side ---- */

vec3 face_in_eye_space()
{
    vec3 n = cross(dFdx(v_position), dFdy(v_position));
    vec3 V = view_direction();
    n = normalize_or(n, V);
    return to_eye_space(dot(n, V) < 0.0 ? -n : n) * seen_side();
}

vec3 point_normal()
{
    vec3 face = face_in_eye_space();
#if defined(IS_FLAT) && !defined(IS_SPRITE)
    return face;
#else
    return normalize_or(to_eye_space(v_normal), face);
#endif
}

/* ---- maps ---- */

vec4 map_texel(sampler2D image, int map)
{
    vec4 row_u = phong_maps[3 * map];
    vec4 row_v = phong_maps[3 * map + 1];
    vec2 uv = texcoord_transform(texcoord_of_set(int(row_u.w)), row_u.xyz, row_v.xyz);
    return filtered_texel(image, uv, row_v.w > 0.0);
}

PhongColor map_color(vec4 texel, int map)
{
    vec4 values = phong_maps[3 * map + 2];
    PhongColor c;
    c.rgb = values.x + texel.xyz * values.y;
    c.opacity = texel.w;
    return c;
}

/* base + gain times the selected channel: 0 to 3; 4: luminance. */
float map_scalar(vec4 texel, int map)
{
    vec4 values = phong_maps[3 * map + 2];
    int channel = int(values.z);
    return values.x + values.y * (channel < 4 ? texel[channel] : luminance(texel.xyz));
}

vec3 mapped_normal()
{
    vec3 N = point_normal();
#if defined(HAS_NORMAL_MAP) && defined(HAS_TANGENTS)
    vec3 n = normal_from_texel(map_texel(u_material6, NORMAL_MAP).xyz, phong_flags.w);
    ShadingFrame f = frame_from_tangent(v_normal, v_tangent, v_handedness, 1.0);
    N = normalize_or(to_eye_space(f.T * n.x + f.B * n.y + f.N * n.z), N);
#endif
    return N;
}

#ifdef HAS_DIFFUSE_MAP
vec4 diffuse_texel()
{
#if defined(IS_SPHERE_MAP) && !defined(IS_SPRITE)
    vec3 V = view_in_eye_space(point_in_eye_space(v_position));
    vec2 at = phong_sphere_map(phong_normal(ogl1_rules(), point_normal(), V, gl_FrontFacing), V);
    return filtered_texel(u_material1, vec2(at.x, 1.0 - at.y), phong_maps[3 * DIFFUSE_MAP + 1].w > 0.0);
#else
    return map_texel(u_material1, DIFFUSE_MAP);
#endif
}
#endif

PhongColor with_texture(PhongColor c)
{
#ifdef HAS_DIFFUSE_MAP
    return phong_texture(int(phong_specular.w), int(phong_emission.w), c, map_color(diffuse_texel(), DIFFUSE_MAP));
#else
    return c;
#endif
}

/* ---- light ---- */

PhongMaterial mapped_material(vec3 diffuse)
{
    PhongMaterial m = phong_material(diffuse);
#ifdef HAS_AMBIENT_MAP
    m.ambient *= map_color(map_texel(u_material0, AMBIENT_MAP), AMBIENT_MAP).rgb;
#endif
#ifdef HAS_SPECULAR_MAP
    m.specular *= map_color(map_texel(u_material2, SPECULAR_MAP), SPECULAR_MAP).rgb;
#endif
#ifdef HAS_EMISSION_MAP
    m.emission *= map_color(map_texel(u_material3, EMISSION_MAP), EMISSION_MAP).rgb;
#endif
#ifdef HAS_SHININESS_MAP
    m.shininess = max(m.shininess * map_scalar(map_texel(u_material4, SHININESS_MAP), SHININESS_MAP), 0.0);
#endif
    return m;
}

PhongLit light_of_fragment(vec3 diffuse)
{
#ifdef IS_AT_VERTICES
#ifdef IS_FLAT
    return light_at_corner(v_corner_color, v_corner, point_normal(), gl_FrontFacing);
#else
    PhongLit lit;
    lit.color = gl_FrontFacing ? v_front : v_back;
    lit.highlight = gl_FrontFacing ? v_front_highlight : v_back_highlight;
    return lit;
#endif
#else
    return with_highlight(light_at_point(mapped_material(diffuse), v_position, mapped_normal(), gl_FrontFacing));
#endif
}

/* ---- color and opacity ---- */

/* Including vertex colors and the opacity map, without the diffuse map. */
PhongColor base_color()
{
#if defined(IS_AT_VERTICES) && defined(IS_FLAT)
    PhongColor c = phong_color(v_corner_color);
#else
    PhongColor c = phong_color(v_color);
#endif
    if (phong_flags.y > 0.0) {
        vec3 V = view_in_eye_space(point_in_eye_space(v_position));
        c.opacity = phong_halo(c.opacity, abs(dot(point_normal(), V)));
    }
#ifdef HAS_OPACITY_MAP
    c.opacity *= map_scalar(map_texel(u_material5, OPACITY_MAP), OPACITY_MAP);
#endif
    return c;
}

/* The lit fragment before fog. */
PhongColor lit_color()
{
    bool is_over = phong_flags.x > 0.0;
    PhongColor base = base_color();
    PhongColor c = base;
    if (!is_over)
        c = with_texture(base);
#ifdef IS_LIT
    PhongLit lit = light_of_fragment(c.rgb);
#else
    PhongLit lit;
    lit.color = c.rgb;
    lit.highlight = vec3(0.0);
#endif
    c.rgb = lit.color;
    if (is_over)
        c = with_texture(c);
    c.rgb += lit.highlight;
    return c;
}

float seen_opacity(float opacity)
{
#ifdef IS_SEE_THROUGH
    return clamp(opacity, 0.0, 1.0);
#else
    return 1.0;
#endif
}

#ifndef AOVS
vec3 with_fog(PhongRules r, vec3 color)
{
    PhongFog f;
    f.mode = int(ogl1_fog_color.w);
    f.color = ogl1_fog_color.xyz;
    f.near_m = ogl1_fog.x;
    f.far_m = ogl1_fog.y;
    f.scale = ogl1_fog.z;
    f.w = ogl1_fog.w;
    return phong_flags.z > 0.0 ? phong_fogged(r, f, color, -point_in_eye_space(v_position).z) : color;
}

void main()
{
    PhongRules r = ogl1_rules();
    PhongColor c = lit_color();
    if (is_encoded() && r.is_lit_at_vertices)
        c.rgb = clamp(c.rgb, 0.0, 1.0); /* after the color sum, before fog */
    c.rgb = with_fog(r, c.rgb);
    if (is_encoded())
        c.rgb = clamp(c.rgb, 0.0, 1.0);
    put_fragment(is_encoded() ? c.rgb : c.rgb * exposure, seen_opacity(c.opacity));
}
#else
void main()
{
    PhongColor c = with_texture(base_color());
    vec3 N = mapped_normal() * seen_side();
    vec3 world = ogl1_view[0].xyz * N.x + ogl1_view[1].xyz * N.y + ogl1_view[2].xyz * N.z;
    put_aovs(world, ogl1_to_linear(c.rgb), 1.0, seen_opacity(c.opacity));
}
#endif
