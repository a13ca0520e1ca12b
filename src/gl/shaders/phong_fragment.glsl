/* phong_fragment.glsl - the host of shade/compose/ogl1_fragment.h. */
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

Ogl1Host fragment_host()
{
#if defined(IS_AT_VERTICES) && defined(IS_FLAT)
    vec4 color = v_corner_color;
#else
    vec4 color = v_color;
#endif
    return ogl1_host(v_position, point_normal(), color, gl_FrontFacing);
}

/* ---- light ---- */

bool host_is_lit(Ogl1Host host)
{
#ifdef IS_LIT
    return true;
#else
    return false;
#endif
}

bool host_is_lit_at_vertices(Ogl1Host host)
{
#ifdef IS_AT_VERTICES
    return true;
#else
    return false;
#endif
}

PhongLit host_light_of_vertices(Ogl1Host host)
{
    PhongLit lit;
#ifdef IS_AT_VERTICES
#ifdef IS_FLAT
    lit = ogl1_light_at_corner(ogl1_host(v_corner, host.N, v_corner_color, gl_FrontFacing));
#else
    lit.color = gl_FrontFacing ? v_front : v_back;
    lit.highlight = gl_FrontFacing ? v_front_highlight : v_back_highlight;
#endif
#endif
    return lit;
}

/* ---- maps ---- */

bool host_has_map(Ogl1Host host, int map)
{
#ifdef HAS_AMBIENT_MAP
    if (map == PHONG_AMBIENT_MAP)
        return true;
#endif
#ifdef HAS_DIFFUSE_MAP
    if (map == PHONG_DIFFUSE_MAP)
        return true;
#endif
#ifdef HAS_SPECULAR_MAP
    if (map == PHONG_SPECULAR_MAP)
        return true;
#endif
#ifdef HAS_EMISSION_MAP
    if (map == PHONG_EMISSION_MAP)
        return true;
#endif
#ifdef HAS_SHININESS_MAP
    if (map == PHONG_SHININESS_MAP)
        return true;
#endif
#ifdef HAS_OPACITY_MAP
    if (map == PHONG_OPACITY_MAP)
        return true;
#endif
    return false;
}

vec4 image_texel(sampler2D image, int map)
{
    vec4 row_u = phong_maps[3 * map];
    vec4 row_v = phong_maps[3 * map + 1];
    vec2 uv = texcoord_transform(texcoord_of_set(int(row_u.w)), row_u.xyz, row_v.xyz);
    return filtered_texel(image, uv, row_v.w > 0.0);
}

vec4 diffuse_texel(Ogl1Host host)
{
#if defined(IS_SPHERE_MAP) && !defined(IS_SPRITE)
    vec2 at = phong_sphere_map(phong_normal(host_frame(host).rules, host.N, host.V, host.is_front), host.V);
    return filtered_texel(u_material1, vec2(at.x, 1.0 - at.y), phong_maps[3 * PHONG_DIFFUSE_MAP + 1].w > 0.0);
#else
    return image_texel(u_material1, PHONG_DIFFUSE_MAP);
#endif
}

/* map is a constant: one branch remains. */
vec4 map_texel(Ogl1Host host, int map)
{
    if (map == PHONG_AMBIENT_MAP)
        return image_texel(u_material0, map);
    if (map == PHONG_DIFFUSE_MAP)
        return diffuse_texel(host);
    if (map == PHONG_SPECULAR_MAP)
        return image_texel(u_material2, map);
    if (map == PHONG_EMISSION_MAP)
        return image_texel(u_material3, map);
    if (map == PHONG_SHININESS_MAP)
        return image_texel(u_material4, map);
    return image_texel(u_material5, map);
}

PhongColor host_map_color(Ogl1Host host, int map)
{
    vec4 texel = map_texel(host, map);
    vec4 values = phong_maps[3 * map + 2];
    return PhongColor(values.x + texel.xyz * values.y, texel.w);
}

/* base + gain times the selected channel: 0 to 3; 4: luminance. */
float host_map_scalar(Ogl1Host host, int map)
{
    vec4 texel = map_texel(host, map);
    vec4 values = phong_maps[3 * map + 2];
    int channel = int(values.z);
    return values.x + values.y * (channel < 4 ? texel[channel] : luminance(texel.xyz));
}

vec3 host_mapped_normal(Ogl1Host host)
{
    vec3 N = host.N;
#if defined(HAS_NORMAL_MAP) && defined(HAS_TANGENTS)
    vec3 n = normal_from_texel(image_texel(u_material6, PHONG_NORMAL_MAP).xyz, phong_flags.w);
    ShadingFrame f = frame_transformed(frame_from_tangent(v_normal, v_tangent, v_handedness, 1.0),
                                       phong_maps[3 * PHONG_NORMAL_MAP].xyz,
                                       phong_maps[3 * PHONG_NORMAL_MAP + 1].xyz);
    N = normalize_or(to_eye_space(f.T * n.x + f.B * n.y + f.N * n.z), N);
#endif
    return N;
}

bool host_is_see_through(Ogl1Host host)
{
#ifdef IS_SEE_THROUGH
    return true;
#else
    return false;
#endif
}
