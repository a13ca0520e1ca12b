/* phong.h - the lighting model of OpenGL 1: ambient, diffuse and Blinn-Phong specular light, texture
 * environments, fog; in the variants found in programs. Colors are display values, as in those programs; the
 * functions do not depend on whether they are encoded.
 *
 * Eye space: the eye at the origin, +X right, +Y up, +Z towards the viewer; visible points have a negative
 * z. Sources: OpenGL 2.1 specification, 2.14 (lighting), 2.11.4 (sphere maps), 3.8.13 (texture
 * environments), 3.9 (color sum), 3.10 (fog); the shaders of rgl 0.111 to 1.3 (D. Adler, D. Murdoch), one
 * of which is printed in the vignette "Shininess in OpenGL 1 versus glTF PBR" of rgl2gltf. */
#ifndef SHADE_PHONG_H
#define SHADE_PHONG_H

/* ---- variants ---- */

#define PHONG_VIGNETTE 0    /* the shader printed in the vignette */
#define PHONG_WEBGL 1       /* rgl's current WebGL shader */
#define PHONG_FIXED 2       /* fixed-function OpenGL 1 with its defaults */
#define PHONG_RGL_DESKTOP 3 /* the same as configured by rgl's desktop program */

/* Orientation of the normal before lighting. */
#define PHONG_SIDE_OF_EYE 0        /* towards the eye: N.V >= 0 */
#define PHONG_SIDE_OF_VIEW_PLANE 1 /* N.z >= 0: differs towards the border of an image */
#define PHONG_SIDE_OF_FACE 2       /* the visible face's (GL_LIGHT_MODEL_TWO_SIDE) */
#define PHONG_SIDE_AS_GIVEN 3      /* unchanged: back faces are lit like front faces */

STRUCT(PhongRules)
{
    int side;
    bool gates_highlight;     /* no highlight where N.L <= 0 */
    bool is_viewer_infinite;  /* V is (0, 0, 1) for the highlight */
    bool separates_highlight; /* added after the texture: GL_SEPARATE_SPECULAR_COLOR */
    bool has_attenuation;     /* lights have attenuation and spots */
    bool is_lit_at_vertices;  /* Gouraud: vertex colors are clamped to [0, 1], then interpolated */
    bool has_fixed_fog;       /* glFog's curves rather than those of the shaders */
    /* w of world directions in their transformation to eye space; 1 is an error of that program: see
     * seeds_test.c */
    float direction_w;
    vec3 global_ambient; /* times the material's ambient color */
};

/* A material's colors; shininess >= 0, to 128 in OpenGL. */
STRUCT(PhongMaterial)
{
    vec3 ambient;
    vec3 diffuse;
    vec3 specular;
    vec3 emission;
    float shininess;
};

/* A light in eye space. */
STRUCT(PhongLight)
{
    vec3 position; /* m; for a directional light the unit vector towards it */
    vec3 ambient;
    vec3 diffuse;
    vec3 specular;
    vec3 attenuation;    /* 1 / (a0 + a1 d + a2 d^2); (1, 0, 0): none */
    vec3 spot_direction; /* unit, from the light */
    float spot_exponent;
    float spot_cos; /* of the cone's half angle; -1: not a spot */
    bool is_point;
};

/* A color with its coverage. */
STRUCT(PhongColor)
{
    vec3 rgb;
    float opacity;
};

/* Lit color before textures: all light, or the highlight apart. */
STRUCT(PhongLit)
{
    vec3 color;
    vec3 highlight;
};

FN PhongRules phong_rules(int variant)
{
    bool is_fixed = variant == PHONG_FIXED || variant == PHONG_RGL_DESKTOP;
    PhongRules r;
    r.side = PHONG_SIDE_OF_EYE;
    if (variant == PHONG_WEBGL)
        r.side = PHONG_SIDE_OF_VIEW_PLANE;
    if (variant == PHONG_FIXED)
        r.side = PHONG_SIDE_AS_GIVEN;
    if (variant == PHONG_RGL_DESKTOP)
        r.side = PHONG_SIDE_OF_FACE;
    r.gates_highlight = is_fixed;
    r.is_viewer_infinite = variant == PHONG_FIXED;
    r.separates_highlight = is_fixed;
    r.has_attenuation = is_fixed;
    r.is_lit_at_vertices = is_fixed;
    r.has_fixed_fog = is_fixed;
    r.direction_w = sel(variant == PHONG_VIGNETTE, 1.0f, 0.0f);
    r.global_ambient = vec3(sel(variant == PHONG_FIXED, 0.2f, 0.0f));
    return r;
}

/* ---- the equation ---- */

/* cosine^shininess with 0^0 = 1, the limit of the exponent (GLSL leaves it and log(0) undefined). */
FN float phong_power(float cosine, float shininess)
{
    float lobe = pow(max(cosine, 1e-7f), shininess);
    return sel(cosine > 0.0f || shininess <= 0.0f, lobe, 0.0f);
}

/* N.H of the half vector between two directions; 0 for opposite ones. L need not be unit: the shaders use H =
 * normalize(L + V). */
FN float phong_NdotH(vec3 N, vec3 V, vec3 L)
{
    vec3 H = L + V;
    return max(dot(N, H) * inversesqrt(max(dot(H, H), 1e-20f)), 0.0f);
}

/* max(N.L, 0) Cd + max(N.H, 0)^s Cs under one white light. N, V, L unit. The highlight is neither
 * multiplied by N.L nor normalised: its peak is Cs for every s, and it is visible where N.L <= 0. */
FN vec3 phong_reflection(vec3 N, vec3 V, vec3 L, vec3 diffuse, vec3 specular, float shininess)
{
    return diffuse * max(dot(N, L), 0.0f) + specular * phong_power(phong_NdotH(N, V, L), shininess);
}

/* ---- normals and views ---- */

/* The normal used for lighting. is_front: the counter-clockwise side of the face is visible. */
FN vec3 phong_normal(PhongRules r, vec3 N, vec3 V, bool is_front)
{
    bool is_turned = r.side == PHONG_SIDE_OF_EYE && dot(N, V) < 0.0f;
    is_turned = is_turned || (r.side == PHONG_SIDE_OF_VIEW_PLANE && N[2] < 0.0f);
    is_turned = is_turned || (r.side == PHONG_SIDE_OF_FACE && !is_front);
    return sel(is_turned, -N, N);
}

/* The view vector of the highlight; V: the unit vector to the eye. */
FN vec3 phong_view(PhongRules r, vec3 V)
{
    return sel(r.is_viewer_infinite, vec3(0.0f, 0.0f, 1.0f), V);
}

/* A world position (w 1) or direction (w 0) in eye space: rotated by the columns of view, then translated. */
FN vec3 phong_to_eye(mat3 view, vec3 translation, vec3 p, float w)
{
    return mul(view, p) + translation * w;
}

/* ---- lights ---- */

/* L: unit, towards the light, eye space. */
FN PhongLight phong_light_directional(vec3 L, vec3 ambient, vec3 diffuse, vec3 specular)
{
    PhongLight l;
    l.position = L;
    l.ambient = ambient;
    l.diffuse = diffuse;
    l.specular = specular;
    l.attenuation = vec3(1.0f, 0.0f, 0.0f);
    l.spot_direction = vec3(0.0f, 0.0f, -1.0f);
    l.spot_exponent = 0.0f;
    l.spot_cos = -1.0f;
    l.is_point = false;
    return l;
}
FN PhongLight phong_light_point(vec3 position, vec3 ambient, vec3 diffuse, vec3 specular)
{
    PhongLight l = phong_light_directional(position, ambient, diffuse, specular);
    l.is_point = true;
    return l;
}

/* The vector towards the light at P: unit for a point light, position itself for a directional one. */
FN vec3 phong_light_vector(PhongLight l, vec3 P)
{
    vec3 d = l.position - P;
    return sel(l.is_point, d * inversesqrt(max(dot(d, d), 1e-20f)), l.position);
}

/* Attenuation of a point light's colors, ambient included, at P: distance attenuation times spot factor.
 * Directional lights have neither. */
FN float phong_light_share(PhongLight l, vec3 P)
{
    vec3 d = l.position - P;
    float distance = length(d);
    float attenuation =
        1.0f / max(l.attenuation[0] + distance * (l.attenuation[1] + distance * l.attenuation[2]), 1e-20f);
    float cosine = -dot(l.spot_direction, phong_light_vector(l, P));
    float spot = sel(cosine >= l.spot_cos, phong_power(cosine, l.spot_exponent), 0.0f);
    spot = sel(l.spot_cos <= -1.0f, 1.0f, spot);
    return sel(l.is_point, attenuation * spot, 1.0f);
}

/* ---- lighting ---- */

/* Emission and global ambient light. Once per point, for any number of lights. */
FN PhongLit phong_unlit_part(PhongRules r, PhongMaterial m)
{
    PhongLit lit;
    lit.color = m.emission + m.ambient * r.global_ambient;
    lit.highlight = vec3(0.0f);
    return lit;
}

/* Contribution of one light at P. N: of phong_normal(); V: unit, to the eye. Opacity is the material's for
 * any number of lights: rgl's WebGL shader adds it once per light, so that two lights make 0.5 opaque;
 * facet does not. */
FN PhongLit phong_light_part(PhongRules r, PhongMaterial m, PhongLight l, vec3 P, vec3 N, vec3 V)
{
    vec3 L = phong_light_vector(l, P);
    float NdotL = dot(N, L);
    float share = sel(r.has_attenuation, phong_light_share(l, P), 1.0f);
    float lobe = phong_power(phong_NdotH(N, phong_view(r, V), L), m.shininess);
    lobe = sel(r.gates_highlight && NdotL <= 0.0f, 0.0f, lobe);
    PhongLit lit;
    lit.color = (m.ambient * l.ambient + m.diffuse * l.diffuse * max(NdotL, 0.0f)) * share;
    lit.highlight = m.specular * l.specular * (lobe * share);
    return lit;
}
FN PhongLit phong_add(PhongLit a, PhongLit b)
{
    a.color += b.color;
    a.highlight += b.highlight;
    return a;
}

/* ---- textures ---- */

/* rgl's textype and texmode. */
#define PHONG_RGB 0
#define PHONG_RGBA 1
#define PHONG_ALPHA 2
#define PHONG_LUMINANCE 3
#define PHONG_LUMINANCE_ALPHA 4
#define PHONG_MODULATE 0
#define PHONG_REPLACE 1
#define PHONG_DECAL 2
#define PHONG_BLEND 3
#define PHONG_ADD 4

/* The texel by its type: missing colors are 1, luminance is the mean of the channels. */
FN PhongColor phong_texel(int type, PhongColor t)
{
    float mean = (t.rgb[0] + t.rgb[1] + t.rgb[2]) * (1.0f / 3.0f);
    if (type == PHONG_RGB || type == PHONG_LUMINANCE)
        t.opacity = 1.0f;
    if (type == PHONG_ALPHA)
        t.opacity = mean;
    if (type == PHONG_LUMINANCE || type == PHONG_LUMINANCE_ALPHA)
        t.rgb = vec3(mean);
    if (type == PHONG_ALPHA)
        t.rgb = vec3(1.0f);
    return t;
}

/* A lit color combined with a texel (0: no texture coverage, 1: full): rgl's table after glTexEnv, which
 * OpenGL leaves undefined for DECAL of types other than RGB and RGBA (rgl: REPLACE) and defines with a
 * constant color of 0 for BLEND. ALPHA keeps the color; REPLACE with luminance and alpha takes the texel's
 * alpha, with RGB and luminance it keeps the color's. */
FN PhongColor phong_texture(int type, int mode, PhongColor e, PhongColor texel)
{
    PhongColor t = phong_texel(type, texel);
    bool has_color = type != PHONG_ALPHA;
    bool has_opacity = type != PHONG_RGB && type != PHONG_LUMINANCE;
    PhongColor c;
    c.opacity = e.opacity * t.opacity;
    c.rgb = e.rgb * t.rgb;
    if (mode == PHONG_DECAL && type == PHONG_RGBA) {
        c.rgb = mix(e.rgb, t.rgb, t.opacity);
        c.opacity = e.opacity;
        return c;
    }
    if (mode == PHONG_REPLACE || mode == PHONG_DECAL) {
        c.rgb = sel(has_color, t.rgb, e.rgb);
        c.opacity = sel(has_opacity, t.opacity, e.opacity);
    }
    if (mode == PHONG_BLEND && has_color)
        c.rgb = (1.0f - t.rgb) * e.rgb;
    if (mode == PHONG_ADD && has_color)
        c.rgb = e.rgb + t.rgb;
    return c;
}

/* Texture coordinates of a sphere map, (0, 0) at its bottom left: r.xy / m + 1/2 with m = 2 sqrt(r.x^2 +
 * r.y^2 + (r.z + 1)^2) and r the reflected view direction. N unit, V the unit vector to the eye, eye
 * space. N = V = +Z maps to the center; the rim is the direction straight behind. OpenGL 2.1, 2.11.4. */
FN vec2 phong_sphere_map(vec3 N, vec3 V)
{
    vec3 r = reflect(-V, N);
    float z = r[2] + 1.0f;
    float scale = 0.5f * inversesqrt(max(r[0] * r[0] + r[1] * r[1] + z * z, 1e-12f));
    return vec2(r[0] * scale + 0.5f, r[1] * scale + 0.5f);
}

/* ---- fog ---- */

#define PHONG_FOG_NONE 0
#define PHONG_FOG_LINEAR 1
#define PHONG_FOG_EXP 2
#define PHONG_FOG_EXP2 3

STRUCT(PhongFog)
{
    int mode;
    vec3 color;
    float near_m; /* of the frustum, along the view axis */
    float far_m;  /* > near_m */
    float scale;  /* rgl's fogScale, > 0; 1 */
    float w;      /* phong_fog_w() */
};

/* near / far of a frustum that tightly encloses a sphere, as in rgl: (1 - sin(FOV / 2)) / (1 + sin(FOV / 2));
 * FOV 0 (orthographic) is drawn from two radii away, which gives 1/3. */
FN float phong_fog_w(float fov_rad)
{
    float s = sin(0.5f * fov_rad);
    return sel(fov_rad > 0.0f, (1.0f - s) / (1.0f + s), 1.0f / 3.0f);
}

/* Fog density at distance_m along the axis, [0, 1], by rgl's shaders: with c from 0 at near to 1 at far
 * and c' = mix(w, 1, c), scale c; 1 - exp(-scale c'); 1 - exp(-(scale c')^2). If w is near / far, c' is
 * distance / far. (The shaders write c as (y - z) / (y - x) with z < 0: x is -far, y is -near.) */
FN float phong_fog_share(PhongFog f, float distance_m)
{
    float c = (distance_m - f.near_m) / max(f.far_m - f.near_m, 1e-20f);
    float x = f.scale * sel(f.mode == PHONG_FOG_LINEAR, c, mix(f.w, 1.0f, c));
    float share = sel(f.mode == PHONG_FOG_LINEAR, x, 1.0f - exp(-x));
    share = sel(f.mode == PHONG_FOG_EXP2, 1.0f - exp(-x * x), share);
    return sel(f.mode == PHONG_FOG_NONE, 0.0f, clamp(share, 0.0f, 1.0f));
}

/* The same by glFog as configured by rgl's desktop program: start = near, end = near + (far - near) / scale,
 * density = scale / far. The specification gives the weight of the object's color: (end - z) / (end - start),
 * exp(-density z), exp(-(density z)^2). Linear fog equals that of the shaders; the others do if w is near /
 * far. */
FN float phong_fog_share_fixed(PhongFog f, float distance_m)
{
    float density = f.scale / max(f.far_m, 1e-20f);
    float x = density * distance_m;
    float end = (f.far_m - f.near_m) / f.scale;
    float object = (end - (distance_m - f.near_m)) / max(end, 1e-20f);
    object = sel(f.mode == PHONG_FOG_EXP, exp(-x), object);
    object = sel(f.mode == PHONG_FOG_EXP2, exp(-x * x), object);
    return sel(f.mode == PHONG_FOG_NONE, 0.0f, 1.0f - clamp(object, 0.0f, 1.0f));
}

FN vec3 phong_fogged(PhongRules r, PhongFog f, vec3 color, float distance_m)
{
    float share = sel(r.has_fixed_fog, phong_fog_share_fixed(f, distance_m), phong_fog_share(f, distance_m));
    return mix(color, f.color, share);
}

/* ---- opacity ---- */

/* MTL's "d -halo": 1 - (N.V) (1 - d): most transparent where the surface faces the eye. */
FN float phong_halo(float dissolve, float NdotV)
{
    return 1.0f - clamp(NdotV, 0.0f, 1.0f) * (1.0f - dissolve);
}

/* ---- an image and its materials ---- */

/* The same for a whole image. */
STRUCT(PhongFrame)
{
    PhongRules rules;
    PhongFog fog;
    bool is_encoded;      /* computed with encoded display values; false: with linear light */
    bool are_colors_srgb; /* colors of materials are sRGB; false: they are linear */
    bool has_rgl_colors;  /* vertex colors replace the diffuse color; false: they multiply it */
};

/* A material, its texture and fog. */
STRUCT(PhongSurface)
{
    PhongMaterial material;
    float opacity;
    int texture_type;
    int texture_mode;
    /* The texture multiplies all of the light, as by glTexEnv; false: the diffuse color, as in MTL and glTF. */
    bool has_texture_over_light;
    bool is_halo;
    bool has_fog;
};

/* Maps of a material. */
#define PHONG_AMBIENT_MAP 0
#define PHONG_DIFFUSE_MAP 1 /* the texture */
#define PHONG_SPECULAR_MAP 2
#define PHONG_EMISSION_MAP 3
#define PHONG_SHININESS_MAP 4
#define PHONG_OPACITY_MAP 5
#define PHONG_NORMAL_MAP 6
#define PHONG_MAP_COUNT 7

/* From linear light (vertex colors, punctual lights) to the values of the computation, and back. */
FN vec3 phong_from_linear(PhongFrame f, vec3 linear)
{
    return sel(f.is_encoded && f.are_colors_srgb, srgb_from_linear(linear), linear);
}
FN vec3 phong_to_linear(PhongFrame f, vec3 computed)
{
    return sel(f.is_encoded && f.are_colors_srgb, linear_from_srgb(computed), computed);
}

/* A punctual light of glTF at one point, L being its direction in eye space: a light of 1 is the irradiance pi. */
FN PhongLight phong_light_punctual(PhongFrame f, LightSample light, vec3 L)
{
    vec3 color = phong_from_linear(f, light.E * INV_PI);
    return phong_light_directional(L, vec3(0.0f), color, color);
}

FN PhongLit phong_with_highlight(PhongLit lit)
{
    lit.color += lit.highlight;
    lit.highlight = vec3(0.0f);
    return lit;
}

/* ---- the exponent as a microfacet distribution ---- */

/* Width of Beckmann's distribution with the slopes of cos^s: sqrt(2 / (s + 2)). Walter et al. 2007,
 * section 5.2 (s = 2 / alpha^2 - 2). glTF's alpha is perceptual_roughness^2: take another square root for
 * the latter. */
FN float alpha_from_shininess(float shininess)
{
    return sqrt(2.0f / (shininess + 2.0f));
}
FN float shininess_from_alpha(float alpha)
{
    return 2.0f / (alpha * alpha) - 2.0f;
}

/* Blinn-Phong's distribution of microfacet normals, in 1/sr: D = (s + 2) / (2 pi) (N.H)^s, = (N.H)^s / (pi
 * alpha^2). The integral of D (N.H) over the hemisphere is 1. Blinn 1977; Walter et al. 2007, equation 30. */
FN float D_BlinnPhong(float NdotH, float shininess)
{
    return (shininess + 2.0f) * (0.5f * INV_PI) * phong_power(NdotH, shininess);
}

/* Microfacet BRDF, in 1/sr, with D_BlinnPhong and the implicit G = N.L N.V: F0 (s + 2) / (8 pi) (N.H)^s. */
FN vec3 brdf_blinn_phong(vec3 F0, float NdotH, float shininess)
{
    return F0 * (0.25f * D_BlinnPhong(NdotH, shininess));
}

/* Normalisation of c (N.H)^s, in 1/sr: with it a surface seen head-on reflects the fraction c of its
 * incident light, (s + 2) (s + 4) / (8 pi (2^(-s/2) + s)). The usual (s + 8) / (8 pi) is up to 7.5 % more
 * (s = 9), 2.7 % at s = 64. Giesen 2009, "Phong and Blinn-Phong Normalization Factors". */
FN float blinn_phong_normalisation(float shininess)
{
    return (shininess + 2.0f) * (shininess + 4.0f) * (0.125f * INV_PI) /
           (exp2(-0.5f * shininess) + shininess);
}
FN float blinn_phong_normalisation_linear(float shininess)
{
    return (shininess + 8.0f) * (0.125f * INV_PI);
}

/* Cs of OpenGL 1 with the peak of brdf_blinn_phong() under a light of irradiance pi: F0 (s + 2) / 8, which
 * the legacy model shows for every N.L. */
FN vec3 phong_specular_from_F0(vec3 F0, float shininess)
{
    return F0 * (0.125f * (shininess + 2.0f));
}

#endif
