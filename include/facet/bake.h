/* facet/bake.h - environments and reflectance LUTs prefiltered for real-time renderers. docs/bake.md has
 * conventions and accuracy. */
#ifndef FACET_BAKE_H
#define FACET_BAKE_H

#include "base.h"
#include "environment.h"
#include "image.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- cube maps ---- */

typedef enum facet_lobe {
    FACET_LOBE_GGX,     /* reflections: convolved with D N.L for N = V = R (Karis 2013) */
    FACET_LOBE_CHARLIE, /* the same for sheen (Estevez and Kulla 2017) */
    FACET_LOBE_LAMBERT, /* irradiance / pi, the radiance of a white diffuse surface; one level */
    FACET_LOBE_NONE     /* the environment itself; levels are means over texels */
} facet_lobe;

/* Perceptual roughness of level k of n. */
typedef enum facet_roughness_mapping {
    FACET_ROUGHNESS_MAPPING_LINEAR,  /* k / (n - 1): Khronos' viewer */
    FACET_ROUGHNESS_MAPPING_FILAMENT /* 1 - sqrt(1 - k / (n - 1)), so that k = (n - 1) r (2 - r): Filament */
} facet_roughness_mapping;

typedef enum facet_bake_method {
    FACET_BAKE_METHOD_AUTO,     /* spherical harmonics for wide lobes, sampling for narrow ones */
    FACET_BAKE_METHOD_SAMPLING, /* filtered importance sampling (Krivanek and Colbert 2008) */
    FACET_BAKE_METHOD_REFERENCE /* sums all texels of the environment: slow, the reference for the others */
} facet_bake_method;

enum { FACET_CUBE_MAX_LEVELS = 14 };

/* {0}: GGX, 256 texels, levels down to 16 texels. */
typedef struct facet_bake_desc {
    facet_allocator allocator;
    facet_progress progress;
    uint32_t thread_count; /* 0: facet_thread_count(); texels do not depend on it */
    facet_lobe lobe;
    uint32_t size;        /* texels along an edge of level 0, a power of two, [1, 8192]; 0: 256; Lambert 64 */
    uint32_t level_count; /* at most log2(size) + 1; 0: down to 16 texels but at least five; Lambert 1 */
    facet_roughness_mapping mapping;
    facet_bake_method method;
    uint32_t samples;   /* per texel, of sampling; 0: 1024 */
    float rotation_rad; /* as facet_render_desc.environment_rotation_rad */
    float ev;           /* stops; radiance is scaled by 2^ev */
    float clamp;        /* maximum of radiance before ev; facet_bake_stats has the loss; 0: none */
} facet_bake_desc;

typedef struct facet_bake_stats {
    double total_s;
    uint64_t samples;     /* texture reads of all levels */
    double clamped_share; /* of the environment's mean radiance that desc->clamp removed, [0, 1] */
} facet_bake_stats;

/* Linear Rec.709 radiance, 32-bit float. desc NULL: {0}. FACET_ERROR_ARGUMENT, _MEMORY, _LIMIT, _CANCELLED. */
FACET_API facet_result facet_cube_bake(facet_environment *environment, const facet_bake_desc *desc,
                                       facet_cube **cube, facet_error *error);
FACET_API void facet_cube_destroy(facet_cube *cube);
FACET_API uint32_t facet_cube_get_level_count(const facet_cube *cube);
/* Texels along an edge. */
FACET_API uint32_t facet_cube_get_size(const facet_cube *cube, uint32_t level);
/* Perceptual; 1 for Lambert, 0 for FACET_LOBE_NONE. */
FACET_API float facet_cube_get_roughness(const facet_cube *cube, uint32_t level);
/* RGBX, 4 floats per texel, X undefined; faces +X -X +Y -Y +Z -Z. */
FACET_API facet_image_view facet_cube_get_face(const facet_cube *cube, uint32_t level, uint32_t face);
FACET_API facet_bake_stats facet_cube_get_stats(const facet_cube *cube);

/* The same cube with x mirrored: texels of (x, y, z) are at (-x, y, z), where three.js looks up cube maps
 * that it did not render itself. allocator NULL: {0}. */
FACET_API facet_result facet_cube_create_mirrored(const facet_cube *cube, const facet_allocator *allocator,
                                                  facet_cube **mirrored, facet_error *error);

/* Error of a level against FACET_BAKE_METHOD_REFERENCE, over the compared texels and their channels. */
typedef struct facet_cube_error {
    double rms, max; /* of |texel - reference|, relative to the root mean square of the reference */
    double energy;   /* mean radiance of the level over that of the environment; 1: none lost */
    uint32_t texels; /* compared: all of small levels, a fixed selection of large ones */
} facet_cube_error;

/* errors: one per level. desc: as for baking the cube. */
FACET_API facet_result facet_cube_verify(const facet_cube *cube, facet_environment *environment,
                                         const facet_bake_desc *desc, facet_cube_error *errors,
                                         facet_error *error);

/* ---- cube maps as images and files ---- */

/* A level as one RGBA image, transparent where a cross has no face; any layout but FACET_LAYOUT_FACES.
 * height is that of equirectangular and octahedral images; 0: twice the size of the level. allocator NULL:
 * {0}. */
FACET_API facet_result facet_cube_unfold(const facet_cube *cube, uint32_t level, facet_layout layout,
                                         uint32_t height, const facet_allocator *allocator,
                                         facet_image **image, facet_error *error);
FACET_API facet_result facet_cube_copy_face(const facet_cube *cube, uint32_t level, uint32_t face,
                                            const facet_allocator *allocator, facet_image **image,
                                            facet_error *error);

/* A sheet for inspection: unfolded levels; spheres of eight roughnesses lit by the cube beside those lit
 * by the reference; the diffuse sphere by nine spherical harmonics beside the exact one. Tone-mapped,
 * opaque. */
typedef struct facet_sheet_desc {
    facet_allocator allocator;
    facet_progress progress;
    uint32_t thread_count; /* 0: facet_thread_count() */
    facet_bake_desc bake;  /* as for baking the cube */
    facet_tonemap tonemap;
    float exposure_ev;
    /* exposure_ev is added to what makes the sheet readable, near middle grey, in tenths of a stop */
    bool meters_exposure;
} facet_sheet_desc;
FACET_API facet_result facet_cube_draw_sheet(const facet_cube *cube, facet_environment *environment,
                                             const facet_sheet_desc *desc, facet_image **image,
                                             facet_error *error);

/* Texel formats of KTX2 files, by the names of Vulkan. */
typedef enum facet_texel_format {
    FACET_TEXEL_FORMAT_RGBA16F,
    FACET_TEXEL_FORMAT_RGBA32F,
    FACET_TEXEL_FORMAT_RGB9E5,    /* E5B9G9R9_UFLOAT_PACK32 */
    FACET_TEXEL_FORMAT_B10G11R11, /* B10G11R11_UFLOAT_PACK32 */
    FACET_TEXEL_FORMAT_RG16F,
    FACET_TEXEL_FORMAT_RG32F,
    FACET_TEXEL_FORMAT_R16F,
    FACET_TEXEL_FORMAT_R32F
} facet_texel_format;

typedef struct facet_ktx2_desc {
    facet_allocator allocator;
    uint32_t thread_count; /* 0: facet_thread_count(); the bytes do not depend on it */
    facet_texel_format format;
    uint32_t zstd_level; /* 1 to 19; 0: uncompressed. FACET_ERROR_UNSUPPORTED in builds without Zstandard */
} facet_ktx2_desc;

/* A KTX 2.0 file; values beyond the range of the format become its largest number. Release with
 * facet_bytes_destroy(), as all bytes below. */
FACET_API facet_result facet_cube_encode_ktx2(const facet_cube *cube, const facet_ktx2_desc *desc,
                                              unsigned char **bytes, size_t *size, facet_error *error);
/* Layer "" of an image as a 2D texture of one level. */
FACET_API facet_result facet_image_encode_ktx2(const facet_image *image, const facet_ktx2_desc *desc,
                                               unsigned char **bytes, size_t *size, facet_error *error);

typedef struct facet_ktx1_desc {
    facet_allocator allocator;
    uint32_t thread_count; /* 0: facet_thread_count(); the bytes do not depend on it */
    /* nine of FACET_SH_FORM_FOLDED, stored as text of the key "sh"; NULL: none */
    const float (*harmonics)[3];
} facet_ktx1_desc;

/* A KTX 1 file with texels R11F_G11F_B10F, as written by Filament's cmgen and read by its loaders. */
FACET_API facet_result facet_cube_encode_ktx1(const facet_cube *cube, const facet_ktx1_desc *desc,
                                              unsigned char **bytes, size_t *size, facet_error *error);

/* A PNG file of radiance in 8 bits, RGBM (Karis 2009; RGBMToLinear() of three.js): RGB = value / (M
 * range), M = alpha = ceil(255 max / range) / 255, straight, without transfer function, which
 * facet_image_save() would apply. range: the largest value, above 0; larger ones become range.
 * FACET_ERROR_ARGUMENT, _MEMORY. */
FACET_API facet_result facet_image_encode_rgbm(const facet_image *image, float range,
                                               const facet_image_save_desc *desc, unsigned char **bytes,
                                               size_t *size, facet_error *error);

/* ---- LUTs of directional albedo (split sum) ----
 *
 * Over N.V (x) and perceptual roughness (y), both at texel centers (i + 0.5) / size, rows from roughness 0. */

typedef enum facet_dfg_kind {
    /* RG: scale and bias of F0, Schlick's masking with k = alpha / 2 (Karis 2013) */
    FACET_DFG_KIND_SCHLICK,
    /* RG: the same, height-correlated Smith masking (Heitz 2014) */
    FACET_DFG_KIND_CORRELATED,
    /* R: integral of Fc, G: of 1, height-correlated: Filament's layout for energy compensation */
    FACET_DFG_KIND_MULTISCATTER,
    /* R: albedo of sheen, Charlie with its own masking (Estevez and Kulla 2017) */
    FACET_DFG_KIND_CHARLIE,
    /* R: the same with Neubelt's masking, as in Filament and Khronos' LUT */
    FACET_DFG_KIND_CHARLIE_NEUBELT,
    /* R: albedo of GGX, cosine-weighted mean over N.V; all columns are equal */
    FACET_DFG_KIND_GGX_AVERAGE,
    /* RG: as MULTISCATTER, B: as CHARLIE_NEUBELT: the LUT of Filament */
    FACET_DFG_KIND_FILAMENT
} facet_dfg_kind;

typedef struct facet_dfg_desc {
    facet_allocator allocator;
    facet_progress progress;
    uint32_t thread_count; /* 0: facet_thread_count() */
    facet_dfg_kind kind;
    uint32_t size; /* [16, 1024]; 0: 128 */
} facet_dfg_desc;

/* Layer "": RGBA, missing channels 0, alpha 1. By quadrature: errors below 1e-5, and below 1e-4 of values
 * above 4, which smooth sheen has at grazing angles. */
FACET_API facet_result facet_dfg_bake(const facet_dfg_desc *desc, facet_image **image, facet_error *error);
/* 1, 2 or 3. */
FACET_API uint32_t facet_dfg_get_channel_count(facet_dfg_kind kind);

/* ---- spherical harmonics ----
 *
 * Nine coefficients in the order 00, 1-1, 10, 11, 2-2, 2-1, 20, 21, 22 of the real basis
 *   Y = 0.282095, 0.488603 (y, z, x), 1.092548 (x y, y z), 0.315392 (3 z^2 - 1), 1.092548 x z, 0.546274 (x^2 - y^2)
 * without the Condon-Shortley phase; x, y, z of the direction in world space, right-handed, +Y up. In engines:
 *   three.js   RADIANCE as LightProbe.sh.coefficients: same basis, order and axes; its shaders apply A_l.
 *              Equirectangular images are oriented as in scene.environment. (Its LightProbeGenerator computes the
 *              same values.)
 *   Filament   FOLDED as IndirectLight::Builder::irradiance(3, sh), the output of cmgen --sh-shader and --deploy.
 *              IndirectLight::Builder::radiance() and cmgen --sh without --sh-shader use the Condon-Shortley phase:
 *              RADIANCE and IRRADIANCE with 1-1, 11, 2-1, 21 negated. cmgen puts the middle column of an image at
 *              +Z: rotation_rad -pi / 2 gives its values. It windows unless --sh-window no is given.
 *   Khronos    IRRADIANCE as irradianceCoefficients of EXT_lights_image_based (Babylon.js reads 1-1, 11, 2-1, 21
 *              negated). Khronos' viewer uses a cube map instead: FACET_LOBE_LAMBERT. */

typedef enum facet_sh_form {
    FACET_SH_FORM_RADIANCE,   /* L_lm = integral of L Y_lm */
    FACET_SH_FORM_IRRADIANCE, /* E_lm = A_l L_lm, A = pi, 2 pi / 3, pi / 4 (Ramamoorthi and Hanrahan 2001) */
    /* irradiance / pi with the constants of the basis folded in: sum of c times 1, y, z, x, xy, yz, 3z^2 -
     * 1, zx, x^2 - y^2; "pre-scaled" in Filament */
    FACET_SH_FORM_FOLDED
} facet_sh_form;

typedef struct facet_sh_desc {
    facet_allocator allocator;
    uint32_t thread_count; /* 0: facet_thread_count() */
    facet_sh_form form;
    float rotation_rad, ev, clamp; /* as facet_bake_desc */
    /* Reduces bands 1 and 2 of all channels alike, as little as keeps the irradiance non-negative (Sloan
     * 2017): removes ringing around a sun. */
    bool is_windowed;
} facet_sh_desc;

/* desc NULL: {0}. FACET_ERROR_ARGUMENT, _MEMORY. */
FACET_API facet_result facet_environment_project_sh(const facet_environment *environment,
                                                    const facet_sh_desc *desc, float coefficients[9][3],
                                                    facet_error *error);

#ifdef __cplusplus
}
#endif

#endif
