/* facet/render.h - rendering: ray-cast preview, path tracing, OpenGL; shading as in glTF or OpenGL 1;
 * exposure. */
#ifndef FACET_RENDER_H
#define FACET_RENDER_H

#include "base.h"
#include "camera.h"
#include "environment.h"
#include "image.h"
#include "part.h"
#include "scene.h"
#include "sea.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- renderers and shading models ---- */

typedef enum facet_renderer_kind {
    FACET_RENDERER_KIND_PREVIEW, /* CPU: one bounce of prefiltered light, no shadows, as real-time viewers */
    FACET_RENDERER_KIND_PATH,    /* CPU: path tracing, unbiased except where facet_path_desc says so */
    FACET_RENDERER_KIND_GL       /* the preview's image by OpenGL; FACET_ERROR_SYSTEM where there is none */
} facet_renderer_kind;

typedef enum facet_shading {
    FACET_SHADING_GLTF, /* physically based, as glTF defines it */
    /* OpenGL 1: the legacy materials of the scene under its lights, without environment */
    FACET_SHADING_OGL1
} facet_shading;

typedef enum facet_energy {
    FACET_ENERGY_CONSERVING, /* multiple scattering compensated: no surface reflects more than it receives */
    /* As Khronos' renderer: punctual lights by the formulas of the glTF specification, without multiple
     * scattering; the environment with it */
    FACET_ENERGY_GLTF
} facet_energy;

/* Sample counts; see facet_render_desc.samples. */
typedef enum facet_quality { FACET_QUALITY_NORMAL, FACET_QUALITY_DRAFT, FACET_QUALITY_FINAL } facet_quality;

/* Variants of FACET_SHADING_OGL1; docs/shading-model.md, "OpenGL 1". */
typedef enum facet_ogl1_variant {
    FACET_OGL1_VARIANT_VIGNETTE, /* per pixel, normals flipped towards the eye, highlights not gated by N.L */
    /* rgl's WebGL shader: normals flipped where they face away from the view plane */
    FACET_OGL1_VARIANT_WEBGL,
    /* fixed-function OpenGL 1: per vertex, one-sided, infinite viewer, highlights gated by N.L, global
     * ambient 0.2 */
    FACET_OGL1_VARIANT_FIXED,
    /* the same with the state of rgl's windows: two-sided, local viewer, no global ambient */
    FACET_OGL1_VARIANT_RGL_DESKTOP
} facet_ogl1_variant;

/* {0}: vignette, in display values. */
typedef struct facet_ogl1_desc {
    facet_ogl1_variant variant;
    /* adds and blends linear light without clamping; false: sRGB-encoded display values, as OpenGL 1 did */
    bool is_linear;
    bool ignores_fog;
    /* FACET_OGL1_VARIANT_VIGNETTE: directions of directional lights are transformed with w = 1, which adds
     * the position of the camera, as the vignette's formula is printed; false: as it is meant */
    bool translates_directions;
} facet_ogl1_desc;

/* ---- path tracing ---- */

/* Reconstruction filter of a pixel, importance sampled: each sample belongs to one pixel. */
typedef enum facet_filter {
    FACET_FILTER_BLACKMAN_HARRIS, /* radius 1.5 px */
    FACET_FILTER_BOX,             /* 1 px wide: pixels share no samples */
    FACET_FILTER_MITCHELL         /* B = C = 1/3, radius 2 px; has negative lobes */
} facet_filter;

/* Sampling of direct light. Each strategy is unbiased by itself and noisy in different places. */
typedef enum facet_light_sampling {
    FACET_LIGHT_SAMPLING_MIS,   /* multiple importance sampling of lights and BSDF */
    FACET_LIGHT_SAMPLING_BSDF,  /* BSDF sampling; delta lights are still sampled */
    FACET_LIGHT_SAMPLING_LIGHTS /* light sampling (NEE); specular lobes still sample the BSDF */
} facet_light_sampling;

/* Read by FACET_RENDERER_KIND_PATH. {0}: unbiased. */
typedef struct facet_path_desc {
    /* Surface and volume interactions of a path: 1: direct light only; 0: 64. Longer paths are truncated. */
    uint32_t max_depth;
    uint32_t seed;
    facet_filter filter;
    facet_light_sampling light_sampling;
    /* Adaptive sampling: a region is finished when its standard error, relative to its display value, is
     * below this; samples is then the maximum. 0: every pixel gets all samples. */
    float noise;
    /* Biased: indirect contributions to a sample are clamped to this, cd/m^2; 0: not. */
    float clamp;
    /* Biased: shadow rays pass transmissive surfaces without refraction, tinted; false: only BSDF samples
     * find light through them. */
    bool has_straight_shadows;
    /* Biased: filters noise, guided by albedo and normal. */
    bool denoises;
    /* Motion blur: the image is the mean over pose.time_s to time_s + shutter_s; 0: an instant. */
    float shutter_s;
    /* An .exr file that keeps the state: written every checkpoint_interval_s, at the time limit, when
     * cancelled and at the end. If it cannot be written, log gets a warning and
     * facet_render_stats.has_lost_checkpoint is set. NULL: none. FACET_ERROR_ARGUMENT: the file exists and
     * resumes is false. */
    const char *checkpoint_path;
    double checkpoint_interval_s; /* 0: 60 */
    /* Continues from the checkpoint, which must be of the same image (FACET_ERROR_ARGUMENT); starts if
     * there is none. */
    bool resumes;
    /* A cancelled render returns the image so far if each pixel has a sample
     * (facet_render_stats.is_partial), as at the time limit; false: FACET_ERROR_CANCELLED. */
    bool keeps_cancelled;
    /* Called from a thread of the renderer after passes, except the last, with the image so far, valid
     * during the call. Denoised images, apart from the shadow on the ground, come at 2, 4, 8 .. samples.
     * NULL: none. */
    void (*pass)(void *pass_user, const facet_image *image, uint32_t samples);
    void *pass_user;
} facet_path_desc;

/* ---- OpenGL ---- */

/* What is drawn of a surface. Channels other than light are not tone-mapped and have a black background. */
typedef enum facet_channel {
    FACET_CHANNEL_LIGHT,      /* all light */
    FACET_CHANNEL_NORMAL,     /* unit shading normal in world space, (N + 1) / 2 */
    FACET_CHANNEL_BASE_COLOR, /* linear */
    FACET_CHANNEL_ROUGHNESS,  /* perceptual */
    FACET_CHANNEL_METALLIC,
    FACET_CHANNEL_OCCLUSION,
    FACET_CHANNEL_OPACITY,
    FACET_CHANNEL_NDOTV,
    FACET_CHANNEL_DIFFUSE, /* this and the following: light of one lobe, weighted as in the whole */
    FACET_CHANNEL_SPECULAR,
    FACET_CHANNEL_CLEARCOAT,
    FACET_CHANNEL_SHEEN,
    FACET_CHANNEL_TRANSMISSION, /* and diffuse transmission */
    FACET_CHANNEL_EMISSION,
    /* furnace test: radiance 1 from everywhere; 1 where no energy is lost or created */
    FACET_CHANNEL_FURNACE,
    FACET_CHANNEL_COUNT
} facet_channel;

/* Formulas of the specular lobe and of the energy below it. */
typedef enum facet_brdf {
    FACET_BRDF_ENERGY,      /* by facet_energy; height-correlated Smith masking */
    FACET_BRDF_SCHLICK_GGX, /* separable masking, k = alpha / 2 (Karis 2013) */
    FACET_BRDF_MULTISCATTER /* height-correlated, with multiple scattering for FACET_ENERGY_GLTF too */
} facet_brdf;

/* Order of compositing transparent surfaces (Porter and Duff 1984). */
typedef enum facet_transparency {
    FACET_TRANSPARENCY_SORTED,  /* triangles from back to front; wrong only where they intersect */
    FACET_TRANSPARENCY_PEELED,  /* per pixel, up to 8 layers (Everitt 2001) */
    FACET_TRANSPARENCY_WEIGHTED /* order-independent and approximate (McGuire and Bavoil 2013), fastest */
} facet_transparency;

/* Read by FACET_RENDERER_KIND_GL. {0}: as the preview. */
typedef struct facet_gl_desc {
    facet_channel channel;
    facet_brdf brdf;
    facet_transparency transparency;
    bool has_shadows; /* shadow maps of punctual lights and the sun; the preview has none */
    float bloom;      /* share of the light that a lens scatters, [0, 1]; 0: none */
} facet_gl_desc;

/* ---- the image ---- */

/* Glass shows the background where light is only refracted and meets nothing else; in a transparent image as a lack of
 * opacity. What it reflects, inside too, is the environment. */
typedef enum facet_background {
    FACET_BACKGROUND_TRANSPARENT,
    FACET_BACKGROUND_COLOR,      /* background_color, display-referred linear, behind the tone-mapped model */
    FACET_BACKGROUND_ENVIRONMENT /* the environment, tone-mapped with the model */
} facet_background;

typedef enum facet_ground {
    FACET_GROUND_NONE,
    /* Shadow catcher: an invisible plane below the lowest point of the model; only the light that the
     * model blocks is drawn, as dark opacity, which fades to 0 at the border of the image.
     * FACET_RENDERER_KIND_PREVIEW traces a few rays to the environment and the lights;
     * FACET_RENDERER_KIND_GL draws the occlusion of a uniform sky. */
    FACET_GROUND_SHADOW
} facet_ground;

/* Of the preview: the model dims the diffuse light of the environment where it hides it. Path tracing computes that
 * anyway; OpenGL has none. */
typedef enum facet_ambient_occlusion {
    FACET_AMBIENT_OCCLUSION_AUTO, /* with FACET_GROUND_SHADOW only */
    FACET_AMBIENT_OCCLUSION_OFF,
    FACET_AMBIENT_OCCLUSION_ON /* FACET_ERROR_ARGUMENT for OpenGL, FACET_SHADING_OGL1 and seas */
} facet_ambient_occlusion;

/* Arbitrary output variables: further layers of the image; combine them by or. Each is of the nearest
 * surface at the center of the pixel, unfiltered; 0 where nothing is hit (depth: infinity).
 * FACET_RENDERER_KIND_PATH: normal and albedo are means over the samples of a pixel, for denoisers: seen
 * through specular reflection and clear glass. */
typedef enum facet_aov {
    FACET_AOV_DEPTH = 1u << 0,       /* m along the axis of the camera; channel "Z" */
    FACET_AOV_NORMAL = 1u << 1,      /* unit shading normal in world space; channels "normal.X" .. */
    FACET_AOV_ALBEDO = 1u << 2,      /* base color, linear; channels "albedo.R" .. */
    FACET_AOV_MATERIAL_ID = 1u << 3, /* index of the material plus 1; channel "material.id" */
    FACET_AOV_UV = 1u << 4,          /* TEXCOORD_0; channels "uv.U", "uv.V" */
    FACET_AOV_OCCLUSION = 1u << 5,   /* occlusion texture, 1: unoccluded; channel "occlusion.A" */
    /* FACET_RENDERER_KIND_PATH: variance of the pixel's mean, per channel, in squared units; "variance.R" .. */
    FACET_AOV_VARIANCE = 1u << 6,
    /* FACET_RENDERER_KIND_PATH: samples of the pixel; channel "samples.N" */
    FACET_AOV_SAMPLES = 1u << 7,
    FACET_AOV_OBJECT_ID = 1u << 8, /* index of the node plus 1; channel "object.id" */
    /* number, from 1, among all instances of all nodes with a mesh (EXT_mesh_gpu_instancing has several
     * per node); channel "instance.id" */
    FACET_AOV_INSTANCE_ID = 1u << 9,
    /* Cryptomatte 1.2.0 by names of nodes, of materials, of instances ("NODE#NUMBER"): the six IDs of the
     * largest coverage with their coverage, in 3 layers "CryptoObject00" .. "02" of 4 channels (ID,
     * coverage, ID, coverage). Coverage sums to the opacity (OpenGL: of the nearest surfaces of 16
     * samples). Manifests are in the metadata of an .exr. FACET_RENDERER_KIND_PATH: not with path.resumes,
     * and complete in the final image only. */
    FACET_AOV_CRYPTO_OBJECT = 1u << 10,
    FACET_AOV_CRYPTO_MATERIAL = 1u << 11,
    FACET_AOV_CRYPTO_INSTANCE = 1u << 12,
    FACET_AOV_CRYPTOMATTE = FACET_AOV_CRYPTO_OBJECT | FACET_AOV_CRYPTO_MATERIAL | FACET_AOV_CRYPTO_INSTANCE
} facet_aov;

/* Instruction set of the ray-triangle kernels on x86-64; elsewhere there is one. AVX2 and AVX-512 use
 * fused multiply-adds, which round differently: a few pixels of an image differ by one code value.
 * FACET_ERROR_SYSTEM: the CPU lacks the set that is named. */
typedef enum facet_isa {
    FACET_ISA_PORTABLE, /* the widest without fused multiply-adds: SSE2, SSE4.2 and AVX give the same bytes */
    FACET_ISA_NATIVE,   /* the widest of this CPU; previews take 7 to 19 % less time */
    FACET_ISA_SSE2,
    FACET_ISA_SSE4_2,
    FACET_ISA_AVX,
    FACET_ISA_AVX2,
    FACET_ISA_AVX512
} facet_isa;

/* {0}: a preview of 1024 x 768 of the whole model under its own lights, transparent background, linear. */
typedef struct facet_render_desc {
    facet_allocator allocator;
    facet_log log;
    facet_progress progress;
    uint32_t thread_count;  /* 0: facet_thread_count(); the image does not depend on it */
    uint32_t width, height; /* pixels; 0: 1024 x 768 */
    uint32_t crop[4];       /* x, y, width, height of the part to render; {0}: all */
    facet_part_desc part;   /* of what crop leaves, for one of several processes; {0}: all of it */
    facet_pose_desc pose;   /* what of the scene, and when */
    /* NULL: of facet_orbit_default(); in a sea of facet_sea_camera(), which ignores the scene */
    const facet_camera *camera;
    facet_environment *environment; /* NULL: none, black */
    float environment_rotation_rad; /* around +Y, positive rotates the light from +Z towards +X */
    float environment_ev;           /* stops; the environment is scaled by 2^environment_ev */
    bool ignores_scene_lights;      /* no KHR_lights_punctual, no lights of legacy files */
    facet_background background;
    float background_color[3]; /* linear Rec.709, [0, 1] */
    float background_blur;     /* perceptual roughness of the environment as background, [0, 1] */
    facet_sun sun;
    facet_ground ground;
    const facet_sea *sea; /* around the scene, unchanged while it is rendered; NULL: none */
    facet_sky_desc sky;   /* above the sea if environment is NULL, with its sun */
    facet_sea_shading sea_shading;
    facet_renderer_kind renderer;
    facet_path_desc path;
    facet_gl_desc gl;
    facet_quality quality;
    /* Per pixel; 0: by quality (facet_renderer_info.samples). Preview: coverage samples, draft 1, normal 4,
     * final 16, at most 4096. Path: draft 16, normal 64, final 512, at most 2^24. */
    uint32_t samples;
    facet_energy energy;
    /* FACET_SHADING_OGL1 is meant for FACET_TONEMAP_NONE. FACET_ERROR_ARGUMENT without legacy materials,
     * and for the environment as background. */
    facet_shading shading;
    facet_ogl1_desc ogl1;
    /* Widens highlights by the variance of normals within a pixel (Kaplanyan and Tokuyoshi 2019): fewer
     * sparkles, but not what real-time viewers show. */
    bool has_specular_antialiasing;
    facet_ambient_occlusion ambient_occlusion;
    /* Preview: decodes textures in full where a reduced size would do, since the mips of a JPEG that is
     * decoded at half size differ slightly. Slower. Path tracing and OpenGL always do. */
    bool decodes_whole_textures;
    facet_isa isa;
    float exposure_ev; /* stops; radiance is scaled by 2^exposure_ev before tone mapping */
    /* Automatic exposure: exposure_ev is relative to what facet_renderer_meter() measures of this image. */
    bool meters_exposure;
    facet_tonemap tonemap;
    uint32_t aovs; /* facet_aov, combined by or */
    /* 0: none; past it FACET_ERROR_LIMIT. FACET_RENDERER_KIND_PATH returns the image so far if each pixel
     * has a sample. */
    double time_limit_s;
} facet_render_desc;

/* ---- what a renderer can do ---- */

/* Combined by or. */
typedef enum facet_renderer_feature {
    FACET_RENDERER_FEATURE_PATH = 1u << 0,        /* traces paths: reads facet_path_desc */
    FACET_RENDERER_FEATURE_GL = 1u << 1,          /* reads facet_gl_desc */
    FACET_RENDERER_FEATURE_GROUND = 1u << 2,      /* FACET_GROUND_SHADOW */
    FACET_RENDERER_FEATURE_OGL1 = 1u << 3,        /* FACET_SHADING_OGL1 */
    FACET_RENDERER_FEATURE_SPECULAR_AA = 1u << 4, /* facet_render_desc.has_specular_antialiasing */
    /* all of facet_sea_shading, legacy styles and stages included; else the physical style */
    FACET_RENDERER_FEATURE_SEA_STYLES = 1u << 5,
    FACET_RENDERER_FEATURE_VIEW = 1u << 6,             /* facet_view() shows it */
    FACET_RENDERER_FEATURE_AMBIENT_OCCLUSION = 1u << 7 /* facet_render_desc.ambient_occlusion, or always */
} facet_renderer_feature;

typedef struct facet_renderer_info {
    const char *name;     /* "preview", "path", "gl": that of facet render --renderer */
    uint32_t features;    /* facet_renderer_feature */
    uint32_t aovs;        /* facet_aov that it renders */
    uint32_t samples[3];  /* per pixel, by facet_quality */
    uint32_t max_samples; /* per pixel */
} facet_renderer_info;
/* {0} past the last renderer. */
FACET_API facet_renderer_info facet_renderer_get_info(facet_renderer_kind kind);

/* ---- rendering ---- */

/* Renders one image with the renderer that desc names. The image has the layer "" (RGBA, float, linear,
 * premultiplied) and the layers of desc->aovs.
 *
 * In a sea (desc->sea) scene NULL renders water only. camera NULL: of facet_sea_camera(); cameras are at
 * most 50 km high under the atmosphere's sky. _PREVIEW renders the endless sea; _GL the same image, for
 * perspective cameras; _PATH traces paths through the waves as triangles out to the horizon: of
 * sea_shading it reads omits_foam, has_schlick_fresnel and perceptual_roughness. The punctual lights of
 * the scene light the scene; with _PATH the water, too. background is the sky. Fails with
 * FACET_ERROR_ARGUMENT in a sea for a ground. With FACET_SHADING_OGL1 the displayed color, decoded and divided
 * by 2^exposure_ev, counts as radiance of the model, under the lights of that shading alone. */
FACET_API facet_result facet_render(const facet_scene *scene, const facet_render_desc *desc,
                                    facet_image **image, facet_error *error);

/* Renders several images of one scene, such as frames and views. What they share (textures, tangents, BVHs
 * of what does not move, OpenGL objects) is kept. Each image equals that of facet_render() to the last
 * bit. The scene must outlive the renderer; one image at a time. Between images the scene may change
 * (facet_scene_append(), facet_scene_place_part(), ..): a new place costs what a frame of an animation does,
 * other changes prepare the whole scene anew. allocator NULL: {0}; that of a desc serves its image only.
 * scene NULL: for descs with a sea, whose sky and foam are kept. */
FACET_API facet_result facet_renderer_create(const facet_scene *scene, const facet_allocator *allocator,
                                             facet_renderer **renderer, facet_error *error);
FACET_API facet_result facet_renderer_render(facet_renderer *renderer, const facet_render_desc *desc,
                                             facet_image **image, facet_error *error);
FACET_API void facet_renderer_destroy(facet_renderer *renderer);

/* Work and wall-clock seconds of the render that made an image; zeros for other images. */
typedef struct facet_render_stats {
    double textures_s, geometry_s, light_s, shade_s, total_s; /* geometry: tangents and BVH; stages overlap */
    uint64_t rays, shades, decoded_texels;
    uint32_t thread_count;
    /* FACET_RENDERER_KIND_PATH: */
    uint64_t samples;         /* over all pixels */
    uint64_t dropped_samples; /* not finite, counted as black: a NaN in the model, or a defect of facet */
    bool has_lost_checkpoint; /* the checkpoint could not be written at the end */
    /* the time limit, or cancelling, came before the samples or the noise asked for */
    bool is_partial;
    double denoise_s;
} facet_render_stats;
FACET_API facet_render_stats facet_image_get_render_stats(const facet_image *image);

/* ---- exposure ---- */

/* EV at ISO 100 that brings the log-average luminance of the model, and of the environment where it is the background, to
 * 0.22 of white (Reinhard et al. 2002). Measures a small image: by path tracing (128 pixels, 16 samples, denoised) for
 * FACET_RENDERER_KIND_PATH, else by the preview with its ambient occlusion; without the shadow on the ground. With a sea, the sea
 * without the scene and without glints is measured. Meter sequences once; their frames would flicker otherwise. Where nothing is
 * visible or all is black, the exposure is 0 and log gets a warning. desc NULL: {0}. Fails as
 * facet_render(), and with FACET_ERROR_ARGUMENT for FACET_SHADING_OGL1, which has display values. */
FACET_API facet_result facet_renderer_meter(facet_renderer *renderer, const facet_render_desc *desc,
                                            double *ev100, facet_error *error);

/* The exposure_ev of a camera set to ev100 (ISO 12232; Lagarde and de Rousiers 2014). */
FACET_API float facet_exposure_from_ev100(double ev100);

/* ---- the sea by itself ---- */

/* A facet_render_desc whose sea, sky and sea_shading are these. */
typedef struct facet_sea_render_desc {
    facet_render_desc render;
    facet_sky_desc sky;
    facet_sea_shading shading;
} facet_sea_render_desc;

/* facet_render() and facet_renderer_meter() for a single image of a sea. Each prepares the sky anew: metering
 * and rendering, and sequences, are faster with a facet_renderer. desc NULL: {0}. */
FACET_API facet_result facet_sea_render(const facet_sea *sea, const facet_scene *scene,
                                        const facet_sea_render_desc *desc, facet_image **image,
                                        facet_error *error);
FACET_API facet_result facet_sea_meter(const facet_sea *sea, const facet_sea_render_desc *desc, double *ev100,
                                       facet_error *error);

#ifdef __cplusplus
}
#endif

#endif
