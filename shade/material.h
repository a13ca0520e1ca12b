/* material.h - the semantics of glTF material parameters: from factors and texels to the surface and its
 * layers. Which channel of which texture scales which factor, as specified by each KHR_materials_*, is
 * defined here only.
 *
 * Texels are linear, and 1 in every channel without a texture. A layered surface starts with
 * layers_from_surface(); each with_...() adds a layer and sets its bit if its factor is above 0. */
#ifndef SHADE_MATERIAL_H
#define SHADE_MATERIAL_H

#define ALPHA_MODE_OPAQUE 0
#define ALPHA_MODE_MASK 1
#define ALPHA_MODE_BLEND 2

/* Factors of the core, KHR_materials_ior, _specular, _emissive_strength and _pbrSpecularGlossiness. */
STRUCT(MaterialFactors)
{
    float metallic;
    float perceptual_roughness;
    float ior; /* 0: F0 = 1 */
    float specular;
    vec3 specular_color; /* of specular-glossiness: specularFactor */
    float glossiness;    /* of specular-glossiness */
    float occlusion_strength;
    vec3 emissive; /* factor times strength, cd/m^2 */
};

/* Interpolated tangent, bitangent and normal in world space on the visible side: neither unit nor exactly
 * orthogonal, as in MikkTSpace (2008) and the tools that bake for it. */
STRUCT(ShadingFrame)
{
    vec3 T;
    vec3 B;
    vec3 N;
};

/* ---- texture coordinates, color, opacity ---- */

/* KHR_texture_transform, by the rows of its matrix. */
FN vec2 texcoord_transform(vec2 uv, vec3 row_u, vec3 row_v)
{
    return vec2(row_u[0] * uv[0] + row_u[1] * uv[1] + row_u[2],
                row_v[0] * uv[0] + row_v[1] * uv[1] + row_v[2]);
}

/* Factor, texture and COLOR_0, each linear; opacity is the same of the fourth channel. glTF 2.0, 3.9.2. */
FN vec3 material_base_color(vec3 factor, vec3 texel, vec3 vertex_color)
{
    return texel * (factor * vertex_color);
}

/* Coverage from the opacity by alphaMode (one of ALPHA_MODE_*): 0 transparent, 1 opaque. glTF 2.0, 3.9.4. */
FN float material_coverage(int alpha_mode, float opacity, float cutoff)
{
    if (alpha_mode == ALPHA_MODE_MASK)
        return sel(opacity >= cutoff, 1.0f, 0.0f);
    if (alpha_mode == ALPHA_MODE_BLEND)
        return clamp(opacity, 0.0f, 1.0f);
    return 1.0f;
}

/* ---- normals ---- */

/* v normalised, or `otherwise` if it has no direction. */
FN vec3 normalize_or(vec3 v, vec3 otherwise)
{
    float length2 = dot(v, v);
    if (length2 > 1e-30f)
        return v * inversesqrt(length2);
    return otherwise;
}

/* From the interpolated normal on the visible side (side 1: the front, -1: the back), the tangent of the
 * front and its handedness, -1 or 1, negated for mirrored instances. glTF 2.0, 3.7.2.1. */
FN ShadingFrame frame_from_tangent(vec3 N, vec3 T, float handedness, float side)
{
    ShadingFrame f;
    f.N = N;
    f.T = T * side;
    f.B = cross(f.N, f.T) * (handedness * side);
    return f;
}

/* From texture coordinates: T is dP/du of P(u, v) = p0 + e1 s + e2 t from the changes uv1 and uv2 along e1
 * and e2. B points to decreasing v, up in an image (glTF 2.0, 3.9.3: green is +Y). T is unit, or 0 where
 * (u, v) is degenerate. */
FN ShadingFrame frame_from_texcoord(vec3 N, vec3 e1, vec3 e2, vec2 uv1, vec2 uv2, float side)
{
    ShadingFrame f;
    f.N = N;
    f.T = vec3(0.0f);
    f.B = vec3(0.0f);
    float determinant = uv1[0] * uv2[1] - uv2[0] * uv1[1];
    float direction = sel(determinant < 0.0f, -1.0f, 1.0f);
    vec3 T = (e1 * uv2[1] - e2 * uv1[1]) * direction;
    vec3 B = (e1 * uv2[0] - e2 * uv1[0]) * direction;
    T -= N * (dot(N, T) / max(dot(N, N), 1e-30f));
    float T2 = dot(T, T);
    if ((determinant < 0.0f || determinant > 0.0f) && T2 > 0.0f) {
        f.T = T * (inversesqrt(T2) * side);
        f.B = cross(N, f.T);
        f.B *= sel(dot(f.B, B) < 0.0f, -side, side);
    }
    return f;
}

/* The frame of a texture whose coordinates KHR_texture_transform maps by the rows of its matrix, from that of the
 * untransformed coordinates: T along the transformed u, B towards the smaller transformed v. With M the
 * upper left 2x2 of the matrix, dP/du' is the first column of M^-1 in the basis of dP/du = T and dP/dv = -B,
 * up to the length: det(M) (M22 T + M21 B); B turns with T, and the other way where M mirrors. Exact where the
 * untransformed coordinates are not sheared and as dense along u as along v. Unchanged if M is singular. The
 * extension does not mention tangents; Khronos' sample renderer decided that they follow the texture (its
 * pull request 16, 2024). */
FN ShadingFrame frame_transformed(ShadingFrame f, vec3 row_u, vec3 row_v)
{
    float determinant = row_u[0] * row_v[1] - row_u[1] * row_v[0];
    if (!(determinant < 0.0f || determinant > 0.0f))
        return f;
    float mirror = sel(determinant < 0.0f, -1.0f, 1.0f);
    vec2 along = normalize(vec2(row_v[1], row_v[0])) * mirror;
    ShadingFrame g = f;
    g.T = f.T * along[0] + f.B * along[1];
    g.B = (f.B * along[0] - f.T * along[1]) * mirror;
    return g;
}

FN bool frame_has_tangent(ShadingFrame f)
{
    return dot(f.T, f.T) > 0.0f;
}

/* The vector of a normal-map texel, with its scale; 0 if the texel is no normal (no texture, or one that
 * could not be decoded and reads as white). glTF 2.0, 3.9.3. */
FN vec3 normal_from_texel(vec3 texel, float scale)
{
    if (texel[0] >= 1.0f && texel[1] >= 1.0f && texel[2] >= 1.0f)
        return vec3(0.0f);
    vec3 c = texel * 2.0f - 1.0f;
    return vec3(c[0] * scale, c[1] * scale, c[2]);
}

/* Vector n of a frame in world space, unit; `otherwise` if it has no direction. */
FN vec3 frame_normal(ShadingFrame f, vec3 n, vec3 otherwise)
{
    return normalize_or(f.T * n[0] + f.B * n[1] + f.N * n[2], otherwise);
}

/* ---- the surface ---- */

/* Metallic-roughness. N unit, on the visible side; base_color of material_base_color(). Channels: green
 * roughness, blue metallic; red occlusion; alpha specular. */
FN Surface material_surface(MaterialFactors f, vec3 N, vec3 base_color, vec3 metallic_roughness_texel,
                            float occlusion_texel, vec3 emissive_texel, float specular_texel,
                            vec3 specular_color_texel)
{
    return surface_from_gltf(N, base_color, f.metallic * metallic_roughness_texel[2],
                             f.perceptual_roughness * metallic_roughness_texel[1], f.ior,
                             f.specular * specular_texel, f.specular_color * specular_color_texel,
                             occlusion_from_texel(occlusion_texel, f.occlusion_strength),
                             f.emissive * emissive_texel);
}

/* Specular-glossiness: the texel's color and alpha. */
FN Surface material_surface_glossy(MaterialFactors f, vec3 N, vec3 diffuse, vec3 specular_texel,
                                   float glossiness_texel, float occlusion_texel, vec3 emissive_texel)
{
    return surface_from_specular_glossiness(
        N, diffuse, f.specular_color * specular_texel, f.glossiness * glossiness_texel,
        occlusion_from_texel(occlusion_texel, f.occlusion_strength), f.emissive * emissive_texel);
}

/* ---- layers ---- */

/* KHR_materials_ior; is_inside: the eye is on the inner side of a volume's boundary. */
FN Layers with_ior(Layers m, float ior, bool is_inside)
{
    m.ior = ior;
    m.eta = sel(is_inside, 1.0f / max(ior, 1.0f), ior);
    return m;
}

/* KHR_materials_clearcoat: red, green. The caller sets clearcoat_N. */
FN Layers with_clearcoat(Layers m, float clearcoat, float roughness, vec3 texel, vec3 roughness_texel)
{
    m.clearcoat = clearcoat * texel[0];
    if (m.clearcoat > 0.0f)
        m.layers |= LAYER_CLEARCOAT;
    m.clearcoat_roughness = clamp(roughness * roughness_texel[1], 0.0f, 1.0f);
    return m;
}

/* KHR_materials_sheen: color, alpha. */
FN Layers with_sheen(Layers m, vec3 color, float roughness, vec3 color_texel, float roughness_texel)
{
    m.sheen_color = clamp(color * color_texel, 0.0f, 1.0f);
    if (max3(m.sheen_color) > 0.0f)
        m.layers |= LAYER_SHEEN;
    m.sheen_roughness = clamp(roughness * roughness_texel, 0.0f, 1.0f);
    return m;
}

/* KHR_materials_iridescence: red; green interpolates from the minimum to the maximum thickness. */
FN Layers with_iridescence(Layers m, float iridescence, float ior, float minimum_nm, float maximum_nm,
                           vec3 texel, vec3 thickness_texel)
{
    m.iridescence = clamp(iridescence * texel[0], 0.0f, 1.0f);
    if (m.iridescence > 0.0f)
        m.layers |= LAYER_IRIDESCENCE;
    m.iridescence_ior = max(ior, 1.0f);
    m.iridescence_thickness_nm = max(mix(minimum_nm, maximum_nm, thickness_texel[1]), 0.0f);
    return m;
}

/* KHR_materials_anisotropy: blue. */
FN float anisotropy_strength(float anisotropy, vec3 texel)
{
    return clamp(anisotropy * texel[2], 0.0f, 1.0f);
}

/* Direction of the texel, red and green; (1, 0) without a texture, or if it could not be decoded. */
FN vec2 anisotropy_texel_direction(vec3 texel)
{
    vec2 d = vec2(2.0f * texel[0] - 1.0f, 2.0f * texel[1] - 1.0f);
    if ((texel[0] >= 1.0f && texel[1] >= 1.0f) || !(dot(d, d) > 1e-6f))
        return vec2(1.0f, 0.0f);
    return d;
}

/* strength of anisotropy_strength(), above 0. Without effect if the frame's tangent is along N. */
FN Layers with_anisotropy(Layers m, float strength, float rotation_rad, vec3 texel, ShadingFrame f)
{
    m.anisotropy = strength;
    vec2 d = anisotropy_direction(anisotropy_texel_direction(texel), rotation_rad);
    vec3 T = f.T * d[0] + f.B * d[1];
    T -= m.base.N * dot(m.base.N, T);
    float T2 = dot(T, T);
    if (T2 > 1e-12f) {
        m.layers |= LAYER_ANISOTROPY;
        m.anisotropy_T = T * inversesqrt(T2);
        m.anisotropy_B = cross(m.base.N, m.anisotropy_T);
    }
    return m;
}

/* KHR_materials_transmission: red. Metals do not transmit. */
FN Layers with_transmission(Layers m, float transmission, vec3 texel)
{
    m.transmission = clamp(transmission * texel[0], 0.0f, 1.0f);
    if (m.transmission > 0.0f && m.base.metallic < 1.0f)
        m.layers |= LAYER_TRANSMISSION;
    return m;
}

/* KHR_materials_diffuse_transmission: alpha, color. */
FN Layers with_diffuse_transmission(Layers m, float diffuse_transmission, vec3 color, float texel,
                                    vec3 color_texel)
{
    m.diffuse_transmission = clamp(diffuse_transmission * texel, 0.0f, 1.0f);
    m.diffuse_transmission_color = clamp(color * color_texel, 0.0f, 1.0f);
    if (m.diffuse_transmission > 0.0f && m.base.metallic < 1.0f)
        m.layers |= LAYER_DIFFUSE_TRANSMISSION;
    return m;
}

/* KHR_materials_volume (thickness: green; m, in world scale) and _dispersion; after the transmission layers. */
FN Layers with_volume(Layers m, float thickness, vec3 texel, vec3 attenuation_color,
                      float attenuation_distance, float dispersion)
{
    if (!has_layer(m, LAYER_TRANSMISSION) && !has_layer(m, LAYER_DIFFUSE_TRANSMISSION))
        return m;
    m.layers |= LAYER_VOLUME;
    if (dispersion > 0.0f && m.ior > 1.0f)
        m.layers |= LAYER_DISPERSION;
    m.thickness = thickness * texel[1];
    m.attenuation_color = attenuation_color;
    m.attenuation_distance = attenuation_distance;
    m.dispersion = dispersion;
    return m;
}

/* KHR_materials_volume_scatter; after with_volume(). */
FN Layers with_scatter(Layers m, vec3 multiscatter_color, float anisotropy)
{
    if (!has_layer(m, LAYER_VOLUME))
        return m;
    m.multiscatter_color = clamp(multiscatter_color, 0.0f, 1.0f);
    if (max3(m.multiscatter_color) > 0.0f)
        m.layers |= LAYER_SCATTER;
    m.scatter_anisotropy = anisotropy;
    return m;
}

/* KHR_materials_diffuse_roughness: red. */
FN Layers with_diffuse_roughness(Layers m, float roughness, vec3 texel)
{
    m.diffuse_roughness = clamp(roughness * texel[0], 0.0f, 1.0f);
    if (m.diffuse_roughness > 0.0f && m.base.metallic < 1.0f)
        m.layers |= LAYER_DIFFUSE_ROUGHNESS;
    return m;
}

/* ---- specular anti-aliasing ---- */

/* Perceptual roughness for alpha_specular_aa(). */
FN float roughness_specular_aa(float perceptual_roughness, vec3 dN_dx, vec3 dN_dy)
{
    return sqrt(alpha_specular_aa(alpha_from_roughness(perceptual_roughness), dN_dx, dN_dy));
}

FN Surface surface_specular_aa(Surface s, vec3 dN_dx, vec3 dN_dy)
{
    s.perceptual_roughness = roughness_specular_aa(s.perceptual_roughness, dN_dx, dN_dy);
    s.alpha = alpha_from_roughness(s.perceptual_roughness);
    return s;
}

#endif
