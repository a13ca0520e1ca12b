/* facet/legacy.h - materials of OpenGL 1 (MTL files, rgl) and of glTF, converted into each other.
 * docs/legacy.md has the formulas and the definition of the errors. */
#ifndef FACET_LEGACY_H
#define FACET_LEGACY_H

#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- how materials are converted ---- */

typedef enum facet_material_model {
    FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS,  /* glTF 2.0 with its extensions */
    FACET_MATERIAL_MODEL_SPECULAR_GLOSSINESS, /* KHR_materials_pbrSpecularGlossiness */
    FACET_MATERIAL_MODEL_OGL1                 /* fixed-function OpenGL 1 (Blinn-Phong), as in MTL and rgl */
} facet_material_model;

typedef enum facet_legacy_method {
    FACET_LEGACY_METHOD_CLOSED, /* LUTs and closed forms where the target is linear radiance, else a fit */
    FACET_LEGACY_METHOD_FIT     /* numerical minimization of the error */
} facet_legacy_method;

/* Which glTF parameters a conversion may use. */
typedef enum facet_legacy_profile {
    /* with KHR_materials_specular and KHR_materials_ior: the smallest error */
    FACET_LEGACY_PROFILE_SPECULAR_IOR,
    FACET_LEGACY_PROFILE_CORE /* base color, metallic and roughness only */
} facet_legacy_profile;

/* The quantity of which a conversion minimizes the error (docs/legacy.md, "The error"). */
typedef enum facet_legacy_target {
    /* _DRAWN to OpenGL 1 and from rgl's parameters, whose programs add light in display values; _LINEAR
     * from MTL, whose readers today add linear light */
    FACET_LEGACY_TARGET_AUTO,
    FACET_LEGACY_TARGET_LINEAR,  /* radiance */
    FACET_LEGACY_TARGET_DISPLAY, /* radiance clamped to [0, 1] */
    FACET_LEGACY_TARGET_DRAWN    /* the output of an OpenGL 1 program: sums of display values, clamped */
} facet_legacy_target;

/* Encoding of the colors in MTL and rgl files. */
typedef enum facet_legacy_colors {
    FACET_LEGACY_COLORS_DEFAULT, /* sRGB */
    FACET_LEGACY_COLORS_SRGB,
    FACET_LEGACY_COLORS_LINEAR
} facet_legacy_colors;

/* Exporters that write MTL files with meanings of their own. */
typedef enum facet_mtl_dialect {
    FACET_MTL_DIALECT_AUTO, /* by the first comment of the file, else SPEC */
    /* Wavefront's specification to the letter: Ns 0 is a highlight everywhere */
    FACET_MTL_DIALECT_SPEC,
    FACET_MTL_DIALECT_BLENDER27,   /* Ns = 1.96078 (hardness - 1) */
    FACET_MTL_DIALECT_BLENDER28,   /* Ns = (30 (1 - r))^2 */
    FACET_MTL_DIALECT_BLENDER3,    /* Ns = 1000 (1 - r)^2, metallic in Ka */
    FACET_MTL_DIALECT_OBJ2GLTF_MR, /* obj2gltf --metallicRoughness: metallic in Ks, roughness in Ns */
    FACET_MTL_DIALECT_OBJ2GLTF_SG  /* obj2gltf --specularGlossiness: glossiness in Ns */
} facet_mtl_dialect;

/* Whether illum 0 and 1, which switch highlights off, are honored. */
typedef enum facet_mtl_illum {
    FACET_MTL_ILLUM_AUTO,  /* only where Ks is black or the exporter is known to write them on purpose */
    FACET_MTL_ILLUM_HONOR, /* always */
    FACET_MTL_ILLUM_IGNORE /* never */
} facet_mtl_illum;

typedef enum facet_legacy_ambient {
    FACET_LEGACY_AMBIENT_DROP,     /* ambient light belongs to the scene, not to the material */
    FACET_LEGACY_AMBIENT_EMISSIVE, /* added to the emission, as under ambient light of 1 */
    FACET_LEGACY_AMBIENT_OCCLUSION /* its map becomes the occlusion texture */
} facet_legacy_ambient;

/* {0}: closed form, specular and ior, automatic target, sRGB colors, light intensities times pi. */
typedef struct facet_legacy_desc {
    facet_legacy_method method;
    facet_legacy_profile profile;
    facet_legacy_target target;
    facet_legacy_colors colors;
    facet_mtl_dialect dialect;
    facet_mtl_illum illum;
    facet_legacy_ambient ambient;
    /* From OGL1: keep the hue of the diffuse color where a broad white highlight would turn the base color
     * white. The report states the larger error. */
    bool keeps_hue;
    /* Reading: do not convert; the glTF materials are defaults. For rendering as OpenGL 1 only. */
    bool keeps_materials;
    /* Ni, Tf and illum 4, 6, 7, 9 become transmission; false: opacity becomes alpha. */
    bool has_glass;
    /* illum 3, 5, 7, 8: Ks is a reflectance, and the environment is reflected; false: Ks is a highlight. */
    bool has_mirrors;
    /* Textures that only the source materials use are removed from the scene; the reverse conversion is
     * then fitted. After that, converting to METALLIC_ROUGHNESS leaves the materials unchanged. */
    bool drops_sources;
    /* Intensities of legacy lights stay; false: they are multiplied by pi, which makes the two models agree. */
    bool keeps_light;
    /* To OGL1: the occlusion texture darkens the diffuse one. */
    bool bakes_occlusion;
    /* To OGL1: fit again even where the values that the material was converted from are still known. */
    bool ignores_source;
} facet_legacy_desc;

/* ---- conversions and their errors ---- */

/* By facet_conversion.error_graded. */
typedef enum facet_conversion_grade {
    FACET_CONVERSION_GRADE_GOOD, /* < 0.05 */
    FACET_CONVERSION_GRADE_FAIR, /* < 0.12 */
    FACET_CONVERSION_GRADE_POOR, /* < 0.30 */
    FACET_CONVERSION_GRADE_BAD
} facet_conversion_grade;

/* The conversion of one material. Errors are relative RMS differences of radiance over light directions of
 * the hemisphere and view angles of 0, 30 and 60 degrees (docs/legacy.md, "The error"); NAN where there is
 * none. Texts live as long as the scene. */
typedef struct facet_conversion {
    const char *name;      /* of the material */
    const char *source;    /* "mtl", "ogl1", "metallic-roughness", "specular-glossiness" */
    const char *method;    /* "closed", "fit", "exact" (lossless), "source" (the known original), "none" */
    const char *profile;   /* "specular+ior", "core", "ogl1", .. */
    double error;          /* E, of linear radiance */
    double error_display;  /* E of radiance clamped to [0, 1] */
    double error_drawn;    /* the same with OpenGL 1 adding display values, as its programs did */
    double error_graded;   /* error_drawn where the target is FACET_LEGACY_TARGET_DRAWN, else error_display */
    double error_naive;    /* E of the formula that most converters use */
    double error_core;     /* E in viewers that lack the extensions */
    double error_views[3]; /* E of each view angle */
    facet_conversion_grade grade;
    facet_conversion_grade grade_drawn; /* of error_drawn */
    bool is_graded_as_drawn;            /* error_graded is error_drawn */
    uint32_t warning_count;
} facet_conversion;

/* Converts all materials of a scene; no other thread may use the scene meanwhile.
 * FACET_MATERIAL_MODEL_OGL1 keeps the glTF materials and adds their counterparts, for facet_scene_save()
 * and FACET_SHADING_OGL1. desc, log NULL: {0}. What is lost goes to log and into the report. Fails with
 * FACET_ERROR_MEMORY. */
FACET_API facet_result facet_scene_convert_materials(facet_scene *scene, facet_material_model to,
                                                     const facet_legacy_desc *desc, const facet_log *log,
                                                     facet_error *error);
FACET_API bool facet_scene_has_legacy_materials(const facet_scene *scene);

/* The last conversion, which may be that of loading: one entry per material in their order; 0: there was
 * none. */
FACET_API uint32_t facet_scene_get_conversion_count(const facet_scene *scene);
/* {0} past the end. */
FACET_API facet_conversion facet_scene_get_conversion(const facet_scene *scene, uint32_t index);

typedef enum facet_report_format {
    FACET_REPORT_FORMAT_JSON,
    FACET_REPORT_FORMAT_HTML /* one self-contained file with a pair of spheres and curves for each material */
} facet_report_format;

/* The last conversion as text: values before and after, errors, warnings. Release *text with
 * facet_text_destroy(). */
FACET_API facet_result facet_scene_report_conversion(const facet_scene *scene, facet_report_format format,
                                                     char **text, facet_error *error);

#ifdef __cplusplus
}
#endif

#endif
