/* legacy.h - materials, lights and fog of OpenGL 1 programs and MTL files, kept beside a scene's glTF
 * materials: as they were read, or as conversions of those.
 *
 * Colors are in the encoding of the file: numbers that a legacy program displays on an 8-bit screen
 * unchanged. scene_legacy.colors says whether they are sRGB-encoded or linear when they become physical
 * quantities. */
#ifndef SCENE_LEGACY_H
#define SCENE_LEGACY_H

#include "scene/scene.h"

/* The largest light, color or offset in any file of legacy materials: far brighter than a screen, and its
 * square is a finite float. */
#define LEGACY_LARGEST 1e9f

/* Values that a file states; or-ed. Others have the value of legacy_material_default(). */
typedef enum legacy_field {
    LEGACY_AMBIENT = 1 << 0,
    LEGACY_DIFFUSE = 1 << 1,
    LEGACY_SPECULAR = 1 << 2,
    LEGACY_EMISSION = 1 << 3,
    LEGACY_SHININESS = 1 << 4,
    LEGACY_OPACITY = 1 << 5,
    LEGACY_ILLUM = 1 << 6,
    LEGACY_IOR = 1 << 7,                 /* Ni */
    LEGACY_TRANSMISSION_FILTER = 1 << 8, /* Tf */
    LEGACY_SHARPNESS = 1 << 9,
    LEGACY_ROUGHNESS = 1 << 10, /* Pr, and the rest of MTL's PBR extension */
    LEGACY_METALLIC = 1 << 11,
    LEGACY_SHEEN = 1 << 12,
    LEGACY_CLEARCOAT = 1 << 13,
    LEGACY_CLEARCOAT_ROUGHNESS = 1 << 14,
    LEGACY_ANISOTROPY = 1 << 15,
    LEGACY_ANISOTROPY_ROTATION = 1 << 16
} legacy_field;

/* The maps of a material, and the MTL statement of each. */
typedef enum legacy_map_slot {
    LEGACY_AMBIENT_MAP,      /* map_Ka */
    LEGACY_DIFFUSE_MAP,      /* map_Kd; rgl's one texture */
    LEGACY_SPECULAR_MAP,     /* map_Ks */
    LEGACY_EMISSION_MAP,     /* map_Ke */
    LEGACY_SHININESS_MAP,    /* map_Ns: [0, 1], times shininess */
    LEGACY_OPACITY_MAP,      /* map_d */
    LEGACY_BUMP_MAP,         /* bump, map_Bump */
    LEGACY_DISPLACEMENT_MAP, /* disp */
    LEGACY_DECAL_MAP,        /* decal */
    LEGACY_REFLECTION_MAP,   /* refl; the first of them */
    LEGACY_NORMAL_MAP,       /* norm */
    LEGACY_ROUGHNESS_MAP,    /* map_Pr */
    LEGACY_METALLIC_MAP,     /* map_Pm */
    LEGACY_SHEEN_MAP,        /* map_Ps */
    LEGACY_ORM_MAP,          /* map_ORM, map_RMA (channels as named) */
    LEGACY_MAP_COUNT
} legacy_map_slot;

/* A texture of a legacy material, with the options of its MTL statement. legacy_map_default(). */
typedef struct legacy_map {
    /* texture SCENE_NONE: no map. Offset and scale (-o, -s) are those of glTF's uv, whose v points down */
    scene_texture_ref ref;
    /* as written; NULL: no such statement. With a path but no ref.texture the file is missing */
    const char *path;
    float base, gain;      /* -mm: value' = base + gain value; 0, 1 */
    char channel;          /* -imfchan: r g b m l z; 0: the default of the statement */
    float bump_multiplier; /* -bm; 1 */
    const char *dropped;   /* options without a counterpart, as written: "-t 1 1 1 -texres 512"; NULL: none */
    const char *options;   /* all options as written, for writing them again; NULL: none */
    bool is_left_out;      /* its image was dropped from the scene: facet_legacy_desc.drops_sources */
} legacy_map;

/* rgl's textype and texmode (glTexEnv). */
typedef enum legacy_texture_type {
    LEGACY_RGB,
    LEGACY_RGBA,
    LEGACY_ALPHA,
    LEGACY_LUMINANCE,
    LEGACY_LUMINANCE_ALPHA
} legacy_texture_type;
typedef enum legacy_texture_mode {
    LEGACY_MODULATE,
    LEGACY_REPLACE,
    LEGACY_DECAL,
    LEGACY_BLEND,
    LEGACY_ADD
} legacy_texture_mode;

typedef struct legacy_material {
    const char *name;
    uint32_t fields;   /* LEGACY_AMBIENT .. */
    float ambient[3];  /* 0 */
    float diffuse[3];  /* 0.8; rgl's color, which vertex colors replace */
    float specular[3]; /* 0 */
    float emission[3]; /* 0 */
    float shininess;   /* 0; Blinn-Phong exponent, [0, 128] in OpenGL, to 1000 and beyond in MTL */
    float opacity;     /* 1: d, 1 - Tr, alpha */
    bool is_halo;      /* d -halo */
    bool is_transparency_ambiguous; /* only Tr was stated, or it contradicts d */
    int illum;                      /* -1: not stated */
    bool is_lit;                    /* true; false: diffuse is displayed unlit */
    bool is_smooth;                 /* true; false: one normal per face */
    bool has_fog;                   /* true */
    bool is_culled;                 /* false: two-sided */
    bool has_environment_map;       /* rgl's texenvmap: the texture is a sphere map */
    float ior;                      /* 1 */
    float transmission_filter[3];   /* 1 */
    float sharpness;                /* 60 */
    float roughness, metallic, sheen, clearcoat, clearcoat_roughness;
    float anisotropy, anisotropy_rotation; /* aniso; anisor in turns [0, 1] */
    legacy_texture_type texture_type;
    legacy_texture_mode texture_mode;
    legacy_map maps[LEGACY_MAP_COUNT];
    bool is_rma;         /* LEGACY_ORM_MAP: red holds roughness, green metallic, blue occlusion (map_RMA) */
    const char *unknown; /* statements without a counterpart, as lines; NULL: none */
    /* where in unknown the statements begin that the format defines: rgl's size, lwd, ..; NULL: none */
    const char *kept;
    /* of a comment "#facet-gltf": the glTF material from which these values were converted; NULL */
    const char *gltf_json;
    bool is_gltf_restored; /* the scene's glTF material is exactly that one and needs no conversion */
} legacy_material;

legacy_material legacy_material_default(void);
legacy_map legacy_map_default(void);
static inline bool legacy_has(const legacy_material *m, uint32_t field)
{
    return (m->fields & field) == field;
}
static inline bool legacy_has_map(const legacy_material *m, legacy_map_slot slot)
{
    return m->maps[slot].ref.texture != SCENE_NONE;
}

/* Whether the image of a map with a glTF counterpart was dropped, so that the material is not completely
 * known. */
bool legacy_lacks_images(const legacy_material *m);

/* A light of OpenGL 1 with rgl's features: no attenuation, no spots. */
typedef struct legacy_light {
    bool is_point;
    bool is_viewpoint_relative; /* position is in camera space */
    float position[3];          /* m; of a directional light: unit, from the surface to the light */
    float ambient[3], diffuse[3], specular[3]; /* in the encoding of material colors; 1 */
} legacy_light;

/* rgl's default: directional, viewpoint-relative, theta 0, phi 15 degrees, all white. */
legacy_light legacy_light_default(void);
/* The direction of rgl's angles: (0, 0, 1), rotated by -phi about x, then by theta about y. */
void legacy_light_direction(float theta_rad, float phi_rad, float out[3]);

typedef enum legacy_fog_mode {
    LEGACY_FOG_NONE,
    LEGACY_FOG_LINEAR,
    LEGACY_FOG_EXP,
    LEGACY_FOG_EXP2
} legacy_fog_mode;
typedef struct legacy_fog {
    legacy_fog_mode mode;
    float color[3];
    float scale; /* 1 */
} legacy_fog;

/* The OpenGL 1 materials, lights and fog of a scene. */
typedef struct scene_legacy {
    legacy_material *materials; /* one per material of the scene */
    uint32_t light_count;       /* 0: legacy_light_default() is used if the scene has no lights either */
    legacy_light *lights;
    legacy_fog fog;
    facet_legacy_colors colors; /* encoding; never FACET_LEGACY_COLORS_DEFAULT */
    facet_mtl_dialect dialect;  /* never FACET_MTL_DIALECT_AUTO */
    bool is_dialect_guessed;    /* from the file's first comment */
    bool is_source;             /* read from a file; false: converted from the glTF materials */
    /* rgl's rules: vertex colors replace diffuse ones, the texture applies to all of the light. False:
     * MTL's and glTF's rules: vertex colors and the diffuse map multiply the diffuse color. */
    bool is_rgl;
} scene_legacy;

/* Whether every material of the scene has a legacy one, read or converted. Extras of a glTF file alone may
 * have some only. */
bool scene_has_legacy_materials(const facet_scene *scene);

/* ---- surfaces as numbers: no textures, linear colors ---- */

/* Blinn-Phong as in OpenGL 1: not normalized, its highlight not multiplied by N.L. */
typedef struct ogl1_surface {
    float diffuse[3], specular[3]; /* [0, 1] to be displayable; larger values are allowed */
    float shininess;               /* >= 0; OpenGL allows up to 128 */
} ogl1_surface;

/* glTF's dielectric-metal mix with KHR_materials_specular and KHR_materials_ior. */
typedef struct pbr_surface {
    float base_color[3], metallic, perceptual_roughness;
    float ior;      /* 1.5; 0: F0 is specular_color */
    float specular; /* 1 */
    float specular_color[3];
} pbr_surface;

/* ---- what a conversion did ---- */

/* A remark on one material or on all; docs/legacy.md lists the codes. */
typedef struct conversion_warning {
    const char *code; /* "energy-gain" */
    const char *text; /* a sentence */
} conversion_warning;

/* How one material was converted, with the values on both sides for which the error was computed. */
typedef struct material_conversion {
    facet_conversion summary; /* facet.h; its strings live in the scene */
    legacy_material legacy;
    scene_material pbr;
    const scene_material *source; /* conversions between glTF's own models: the source of pbr; NULL */
    bool has_surfaces;            /* values for which the error was computed, textures at their means */
    ogl1_surface ogl1_surface;
    pbr_surface pbr_surface;
    uint32_t warning_count;
    const conversion_warning *warnings;
} material_conversion;

/* A scene's materials and images before some were dropped: facet_legacy_desc.drops_sources. */
typedef struct scene_conversion_source {
    scene_material *materials;
    legacy_material *legacy;
    uint32_t texture_count, image_count;
    scene_texture *textures;
    scene_image *images;
} scene_conversion_source;

typedef struct scene_conversion {
    facet_material_model to;
    uint32_t material_count; /* one per material of the scene, in its order */
    material_conversion *materials;
    uint32_t warning_count; /* of the whole scene: lights, fog */
    const conversion_warning *warnings;
    const scene_conversion_source *source; /* NULL: no image was dropped */
    /* factor of legacy lights: pi, or 1 unless requested */
    double light_scale;
} scene_conversion;

#endif
