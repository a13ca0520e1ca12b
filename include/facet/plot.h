/* facet/plot.h - charts of BRDFs, their terms, LUTs, tone mapping and conversion errors as SVG, PDF, PNG,
 * CSV or JSON. */
#ifndef FACET_PLOT_H
#define FACET_PLOT_H

#include "base.h"
#include "render.h"
#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- materials ---- */

typedef enum facet_plot_model {
    FACET_PLOT_MODEL_PBR,
    FACET_PLOT_MODEL_OGL1,
    FACET_PLOT_MODEL_MERL /* measured (Matusik et al. 2003) */
} facet_plot_model;

/* Start from facet_plot_material_default(), whose values are given below. Colors are linear, [0, 1]. */
typedef struct facet_plot_material {
    const char *label; /* NULL: composed of the parameters */
    facet_plot_model model;
    /* FACET_PLOT_MODEL_PBR: parameters of glTF */
    float base_color[3], metallic, perceptual_roughness;          /* 1; 0; 0.5 */
    float ior, specular, specular_color[3];                       /* 1.5; 1; 1 */
    float clearcoat, clearcoat_roughness;                         /* 0 */
    float sheen_color[3], sheen_roughness;                        /* 0 */
    float anisotropy, anisotropy_rotation_rad;                    /* 0 */
    float iridescence, iridescence_ior, iridescence_thickness_nm; /* 0; 1.3; 400 */
    float diffuse_roughness;                                      /* 0 */
    /* FACET_PLOT_MODEL_OGL1 */
    float diffuse[3], ogl1_specular[3], shininess; /* 0.8; 1; 50 */
    /* FACET_PLOT_MODEL_MERL: the file */
    const char *path;
} facet_plot_material;
FACET_API facet_plot_material facet_plot_material_default(void);

/* The factors of a material of a scene, without textures; of the legacy material where model is
 * FACET_PLOT_MODEL_OGL1. */
FACET_API facet_result facet_plot_material_from_scene(const facet_scene *scene, uint32_t material,
                                                      facet_plot_model model, facet_plot_material *out,
                                                      facet_error *error);

/* ---- plots ---- */

typedef enum facet_plot_kind {
    /* PBR and OpenGL 1 over the light angle, the best fit, their difference (Murdoch's vignette "Shininess in
     * OpenGL 1 versus glTF PBR", extended) */
    FACET_PLOT_KIND_LEGACY,
    FACET_PLOT_KIND_BRDF,       /* polar slices of the lobes in the plane of incidence */
    FACET_PLOT_KIND_SLICE,      /* the same as curves over the light angle */
    FACET_PLOT_KIND_HEMISPHERE, /* over all light directions, in false color */
    FACET_PLOT_KIND_LOBE,       /* over all light directions, as a surface in space */
    FACET_PLOT_KIND_TERMS,      /* D, V and F over their cosines */
    FACET_PLOT_KIND_ALBEDO,     /* directional albedo over the view angle */
    FACET_PLOT_KIND_FURNACE,    /* furnace test over roughness */
    FACET_PLOT_KIND_DFG,        /* split-sum LUTs */
    FACET_PLOT_KIND_TONE,       /* tone mapping: display over scene luminance */
    FACET_PLOT_KIND_FRESNEL,    /* of water and other media over the angle, exact and Schlick's */
    FACET_PLOT_KIND_ERROR       /* error of the fits between the models over roughness */
} facet_plot_kind;

typedef enum facet_plot_format {
    FACET_PLOT_FORMAT_SVG,
    FACET_PLOT_FORMAT_PDF,
    FACET_PLOT_FORMAT_PNG,
    FACET_PLOT_FORMAT_CSV, /* the plotted numbers; works without cairo */
    FACET_PLOT_FORMAT_JSON /* the same, with colors and the places of the panels in the drawing */
} facet_plot_format;

enum { FACET_PLOT_MAX_MATERIALS = 16, FACET_PLOT_MAX_ANGLES = 8 };

/* The fit of the other model to a material. */
typedef struct facet_plot_fit {
    bool is_found;              /* false: there is no such material, or the kind shows no fits */
    char name[96];              /* label of the material */
    char description[160];      /* such as "metal (1, 0.77, 0.34), diffuse 0.02, roughness 0.3" */
    facet_plot_material fitted; /* label: NULL */
    bool is_of_measured;        /* log_rms is the error; false: E, E_display and E_drawn are */
    /* over all directions, relative to the RMS of the material, as in facet_conversion */
    float E, E_display, E_drawn;
    float log_rms; /* RMS of the difference of log(1 + f cos) over that of the measured values */
} facet_plot_fit;

/* {0}: the vignette with its own values. */
typedef struct facet_plot_desc {
    facet_allocator allocator;
    uint32_t thread_count; /* 0: facet_thread_count() */
    facet_plot_kind kind;
    uint32_t material_count; /* at most FACET_PLOT_MAX_MATERIALS; 0: examples that suit the kind */
    const facet_plot_material *materials;
    uint32_t angle_count;     /* at most FACET_PLOT_MAX_ANGLES; 0: 30 degrees, or what suits the kind */
    const float *angles_rad;  /* view angles from the normal, [0, pi/2) */
    bool has_heaviside_ramp;  /* FACET_PLOT_KIND_LEGACY: max(x, 0) of the vignette where glTF has a step */
    bool has_separable_smith; /* separable masking as in the vignette; false: height-correlated */
    bool has_fit;             /* the best fit of the other model to each material; MERL: of PBR */
    /* has_fit: receives FACET_PLOT_MAX_MATERIALS fits by index of the material; NULL: none */
    facet_plot_fit *fits;
    bool is_logarithmic;   /* the value axis */
    bool has_cosine;       /* multiplies a BRDF by the cosine of the light */
    bool has_shared_scale; /* FACET_PLOT_KIND_BRDF: one scale for all lobes; false: each by its own peak */
    facet_energy energy; /* FACET_PLOT_KIND_LEGACY, has_fit: not read, glTF's BRDF, to which fits are made */
    const char *title;   /* NULL: of the kind; "": none */
    uint32_t width, height; /* pixels, or 1/96 inch; 0: 960 x 640 or what suits the kind */
    bool is_dark;           /* light lines on a dark background */
} facet_plot_desc;

/* The bytes of a file; release with facet_bytes_destroy(). FACET_ERROR_SYSTEM: cairo is missing (CSV works
 * without); FACET_ERROR_READ, _INVALID: of a measured BRDF. */
FACET_API facet_result facet_plot_encode(const facet_plot_desc *desc, facet_plot_format format,
                                         unsigned char **bytes, size_t *size, facet_error *error);

#ifdef __cplusplus
}
#endif

#endif
