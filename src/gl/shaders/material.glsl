/* material.glsl - from a material's parameters and texels (gl_material.c, gl_program_text.c) to the surface and
 * its layers, by shade/material.h. Texels are read before any branch: mip levels follow from the coordinates of
 * neighboring fragments. */
layout(std140) uniform Material
{
    vec4 base_color_factor;
    vec4 emissive_factor;       /* w: alpha cutoff */
    vec4 specular_color_factor; /* w: specular */
    vec4 core_factors;          /* metallic, perceptual roughness, ior, glossiness */
    vec4 map_scales;            /* normal, occlusion strength, clearcoat normal; transmission */
    vec4 clearcoat_factors;     /* clearcoat, roughness; anisotropy, rotation */
    vec4 iridescence_factors;   /* iridescence, ior, minimum and maximum of the thickness */
    vec4 sheen_factors;         /* color; roughness */
    vec4 attenuation;           /* color; distance */
    vec4 diffuse_transmission_factors; /* color; factor */
    vec4 scatter_factors;              /* color; anisotropy */
    vec4 volume_factors;               /* thickness, dispersion; w: diffuse roughness */
    vec4 texcoord_rows[42];            /* by slot: rows of the transform; w: the set; 1: trilinear */
};

/* ---- texels ---- */

vec2 texcoord_of_slot(int slot)
{
    vec4 row_u = texcoord_rows[2 * slot];
    return texcoord_transform(texcoord_of_set(int(row_u.w)), row_u.xyz, texcoord_rows[2 * slot + 1].xyz);
}

#define DECLARE_TEXEL(texel, image, slot) vec4 texel;
EACH_TEXTURE(DECLARE_TEXEL)

/* At the coordinates of a slot and with the filter of its sampler. */
vec4 texel_of_slot(sampler2D image, int slot)
{
    return filtered_texel(image, texcoord_of_slot(slot), texcoord_rows[2 * slot + 1].w > 0.0);
}

/* Reads all texels, each once. To find the footprint takes longer than to read a texel: where all textures have the same
 * one, their probes share it, and a loop. */
void read_texels()
{
#ifdef FIRST_TEXTURE_SLOT
#define FIRST_PROBE(texel, image, slot) texel = textureLod(image, p.at, p.lod);
#define NEXT_PROBE(texel, image, slot) texel += textureLod(image, at, p.lod);
#define MEAN_OF_PROBES(texel, image, slot) texel /= float(p.count);
    Probes p = probes_at(vec2(textureSize(u_material0, 0)), texcoord_of_slot(FIRST_TEXTURE_SLOT));
    EACH_TEXTURE(FIRST_PROBE)
    for (int i = 1; i < p.count; i++) {
        vec2 at = p.at + p.stride * float(i);
        EACH_TEXTURE(NEXT_PROBE)
    }
    EACH_TEXTURE(MEAN_OF_PROBES)
#else
#define READ_TEXEL(texel, image, slot) texel = texel_of_slot(image, slot);
    EACH_TEXTURE(READ_TEXEL)
#endif
}

/* ---- color and opacity ---- */

/* Linear; the alpha before its mode is applied. */
vec4 base_color()
{
    vec4 texel = BASE_COLOR_TEXEL;
#ifdef HAS_COLORS
    vec4 color = max(v_color, 0.0); /* extrapolated beyond the triangle's edge it may be negative */
#else
    vec4 color = vec4(1.0);
#endif
    return vec4(material_base_color(base_color_factor.xyz, texel.xyz, color.xyz),
                texel.w * (base_color_factor.w * color.w));
}

float coverage(float alpha)
{
#if defined(HAS_ALPHA_MASK)
    return material_coverage(ALPHA_MODE_MASK, alpha, emissive_factor.w);
#elif defined(HAS_ALPHA_BLEND)
    return material_coverage(ALPHA_MODE_BLEND, alpha, 0.0);
#else
    return 1.0;
#endif
}

/* ---- normals ---- */

/* Slots of textures that hold vectors (scene_texture_slot). */
const int NORMAL_SLOT = 2;
const int CLEARCOAT_NORMAL_SLOT = 9;
const int ANISOTROPY_SLOT = 16;

int texcoord_set_of_slot(int slot)
{
    return int(texcoord_rows[2 * slot].w);
}

/* Unit, from the vertices alone. */
vec3 smooth_normal(vec3 V)
{
    return normalize_or(v_normal * seen_side(), V);
}

/* From the screen-space derivatives of a texture coordinate. */
ShadingFrame frame_of_texcoord(int set)
{
    vec2 uv = texcoord_of_set(set);
    return frame_from_texcoord(v_normal * seen_side(), dFdx(v_position), dFdy(v_position), dFdx(uv), dFdy(uv),
                               seen_side());
}

/* That of vectors in the texture of a slot, from that of its untransformed coordinates. */
ShadingFrame frame_of_slot(ShadingFrame f, int slot)
{
    return frame_transformed(f, texcoord_rows[2 * slot].xyz, texcoord_rows[2 * slot + 1].xyz);
}

#ifdef HAS_TANGENTS
ShadingFrame frame_of_tangents()
{
    return frame_from_tangent(v_normal * seen_side(), v_tangent, v_handedness, seen_side());
}
#endif

vec3 shading_normal(vec3 V)
{
    vec3 N = smooth_normal(V);
#if defined(HAS_NORMAL_TEXTURE) && defined(HAS_TANGENTS)
    ShadingFrame f = frame_of_slot(frame_of_tangents(), NORMAL_SLOT);
    return frame_normal(f, normal_from_texel(NORMAL_TEXEL.xyz, map_scales.x), N);
#else
    return N;
#endif
}

/* ---- the surface ---- */

Surface surface_of_material(vec3 N, vec3 color)
{
    MaterialFactors f;
    f.metallic = core_factors.x;
    f.perceptual_roughness = core_factors.y;
    f.ior = core_factors.z;
    f.specular = specular_color_factor.w;
    f.specular_color = specular_color_factor.xyz;
    f.glossiness = core_factors.w;
    f.occlusion_strength = map_scales.y;
    f.emissive = emissive_factor.xyz;
    float occlusion = OCCLUSION_TEXEL.x;
    vec3 emissive = EMISSIVE_TEXEL.xyz;
#ifdef IS_GLOSSY
    vec4 texel = SPECULAR_GLOSSINESS_TEXEL;
    return material_surface_glossy(f, N, color, texel.xyz, texel.w, occlusion, emissive);
#else
    return material_surface(f, N, color, METALLIC_ROUGHNESS_TEXEL.xyz, occlusion, emissive, SPECULAR_TEXEL.w,
                            SPECULAR_COLOR_TEXEL.xyz);
#endif
}

/* ---- layers ---- */

#ifdef HAS_CLEARCOAT
vec3 clearcoat_normal(vec3 V)
{
    vec3 N = smooth_normal(V);
#ifdef HAS_CLEARCOAT_NORMAL_TEXTURE
    int set = texcoord_set_of_slot(CLEARCOAT_NORMAL_SLOT);
#if defined(HAS_TANGENTS) && defined(HAS_NORMAL_TEXTURE)
    /* The tangents are those of the base's normal texture. */
    ShadingFrame f = frame_of_texcoord(set);
    if (texcoord_set_of_slot(NORMAL_SLOT) == set)
        f = frame_of_tangents();
#elif defined(HAS_TANGENTS)
    ShadingFrame f = frame_of_tangents();
#else
    ShadingFrame f = frame_of_texcoord(set);
#endif
    vec3 n = normal_from_texel(CLEARCOAT_NORMAL_TEXEL.xyz, map_scales.z);
    if (frame_has_tangent(f))
        N = frame_normal(frame_of_slot(f, CLEARCOAT_NORMAL_SLOT), n, N);
#endif
    return N;
}
#endif

#ifdef HAS_ANISOTROPY
Layers with_anisotropy_of_material(Layers m)
{
    vec3 texel = ANISOTROPY_TEXEL.xyz;
#ifdef HAS_TANGENTS
    ShadingFrame f = frame_of_tangents();
#else
    ShadingFrame f = frame_of_texcoord(texcoord_set_of_slot(ANISOTROPY_SLOT));
#endif
    f = frame_of_slot(f, ANISOTROPY_SLOT);
    float strength = anisotropy_strength(clearcoat_factors.z, texel);
    if (strength > 0.0)
        m = with_anisotropy(m, strength, clearcoat_factors.w, texel, f);
    return m;
}
#endif

#ifdef HAS_LAYERS
Layers layers_of_material(Surface s, vec3 V)
{
    Layers m = layers_from_surface(s);
#ifdef IS_VOLUME
    m = with_ior(m, core_factors.z, !gl_FrontFacing);
#else
    m = with_ior(m, core_factors.z, false);
#endif
#ifdef HAS_CLEARCOAT
    m = with_clearcoat(m, clearcoat_factors.x, clearcoat_factors.y, CLEARCOAT_TEXEL.xyz,
                       CLEARCOAT_ROUGHNESS_TEXEL.xyz);
    m.clearcoat_N = clearcoat_normal(V);
#endif
#ifdef HAS_SHEEN
    m = with_sheen(m, sheen_factors.xyz, sheen_factors.w, SHEEN_COLOR_TEXEL.xyz, SHEEN_ROUGHNESS_TEXEL.w);
#endif
#ifdef HAS_IRIDESCENCE
    m = with_iridescence(m, iridescence_factors.x, iridescence_factors.y, iridescence_factors.z,
                         iridescence_factors.w, IRIDESCENCE_TEXEL.xyz, IRIDESCENCE_THICKNESS_TEXEL.xyz);
#endif
#ifdef HAS_ANISOTROPY
    m = with_anisotropy_of_material(m);
#endif
#ifdef HAS_TRANSMISSION
    m = with_transmission(m, map_scales.w, TRANSMISSION_TEXEL.xyz);
#endif
#ifdef HAS_DIFFUSE_TRANSMISSION
    m = with_diffuse_transmission(m, diffuse_transmission_factors.w, diffuse_transmission_factors.xyz,
                                  DIFFUSE_TRANSMISSION_TEXEL.w, DIFFUSE_TRANSMISSION_COLOR_TEXEL.xyz);
#endif
#ifdef HAS_VOLUME
    m = with_volume(m, volume_factors.x * v_instance.x, THICKNESS_TEXEL.xyz, attenuation.xyz, attenuation.w,
                    volume_factors.y);
#endif
#ifdef HAS_SCATTER
    m = with_scatter(m, scatter_factors.xyz, scatter_factors.w);
#endif
#ifdef HAS_DIFFUSE_ROUGHNESS
    m = with_diffuse_roughness(m, volume_factors.w, DIFFUSE_ROUGHNESS_TEXEL.xyz);
#endif
    m.layers &= MATERIAL_LAYERS; /* constant, so the compiler removes the other layers */
    return m;
}
#endif
