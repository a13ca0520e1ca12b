/* facet/environment.h - light from all directions: images, cube maps, skies, gradients; and the sun. */
#ifndef FACET_ENVIRONMENT_H
#define FACET_ENVIRONMENT_H

#include "base.h"
#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- images of the sphere of directions ---- */

/* Faces are those of cube maps in Direct3D and OpenGL, in the order +X -X +Y -Y +Z -Z, seen from inside
 * with +Y up unless said otherwise. */
typedef enum facet_layout {
    FACET_LAYOUT_AUTO,             /* by the ratio of the edges: 2:1, 4:3, 3:4, 6:1, 1:6 */
    FACET_LAYOUT_EQUIRECTANGULAR,  /* 2:1, see facet_environment_load() */
    FACET_LAYOUT_CROSS_HORIZONTAL, /* 4:3: -X +Z +X -Z, with +Y above and -Y below +Z */
    FACET_LAYOUT_CROSS_VERTICAL,   /* 3:4: +Y; -X +Z +X; -Y; -Z rotated by 180 degrees */
    FACET_LAYOUT_STRIP_HORIZONTAL, /* 6:1, faces from the left */
    FACET_LAYOUT_STRIP_VERTICAL,   /* 1:6, faces from the top */
    FACET_LAYOUT_OCTAHEDRAL,       /* 1:1, +Y in the center, -Y in the corners (Cigolle et al. 2014) */
    FACET_LAYOUT_FACES             /* six images; only for writing cube maps */
} facet_layout;

/* {0}: malloc, silent. */
typedef struct facet_environment_desc {
    facet_allocator allocator;
    facet_log log;
    uint32_t thread_count;    /* 0: facet_thread_count() */
    uint64_t max_file_bytes;  /* larger files are refused; 0: 4 GiB */
    uint32_t max_size;        /* texels along an edge; 0: 32768 */
    const char *cache_folder; /* where prefiltered environments are cached; NULL: no cache */
    uint64_t cache_bytes;     /* size limit of the cache; 0: 256 MiB */
    facet_layout layout;      /* of the image; ignored for cube map files (KTX2), which state it */
} facet_environment_desc;

/* Reads an image (.hdr, .exr, or an 8-bit format, decoded from sRGB) in any of the layouts, or a cube map
 * (.ktx2, level 0). Equirectangular: direction d (unit, +Y up) is at u = 0.5 + atan2(d.z, d.x) / 2pi from
 * the left and v = acos(d.y) / pi from the top, before rotation. Texels are cd/m^2. FACET_ERROR_INVALID:
 * the ratio of the edges fits no layout; within 5 % of 2:1 the image is stretched, with a warning. */
FACET_API facet_result facet_environment_load(const char *path, const facet_environment_desc *desc,
                                              facet_environment **environment, facet_error *error);
FACET_API facet_result facet_environment_load_memory(const void *bytes, size_t size, const char *name,
                                                     const facet_environment_desc *desc,
                                                     facet_environment **environment, facet_error *error);
/* Six images, faces +X -X +Y -Y +Z -Z. FACET_ERROR_INVALID: they are not square or not of one size. */
FACET_API facet_result facet_environment_load_faces(const char *const paths[6],
                                                    const facet_environment_desc *desc,
                                                    facet_environment **environment, facet_error *error);
/* The built-in neutral studio: soft boxes in a grey room, white on average. */
FACET_API facet_result facet_environment_create_studio(const facet_environment_desc *desc,
                                                       facet_environment **environment, facet_error *error);
/* The same radiance (cd/m^2, linear Rec.709, finite and at least 0) from everywhere. */
FACET_API facet_result facet_environment_create_constant(const float radiance[3],
                                                         const facet_environment_desc *desc,
                                                         facet_environment **environment, facet_error *error);
/* Radiance (cd/m^2, linear Rec.709) of zenith, horizon and nadir, interpolated linearly in the height d.y
 * of a direction. */
FACET_API facet_result facet_environment_create_gradient(const float zenith[3], const float horizon[3],
                                                         const float nadir[3],
                                                         const facet_environment_desc *desc,
                                                         facet_environment **environment, facet_error *error);
/* The image-based light of the model for the pose's scene (EXT_lights_image_based). FACET_ERROR_ARGUMENT:
 * it has none; see facet_scene_has_environment(). */
FACET_API facet_result facet_environment_create_from_scene(const facet_scene *scene,
                                                           const facet_pose_desc *pose,
                                                           const facet_environment_desc *desc,
                                                           facet_environment **environment,
                                                           facet_error *error);
FACET_API bool facet_scene_has_environment(const facet_scene *scene, const facet_pose_desc *pose);
FACET_API void facet_environment_destroy(facet_environment *environment);

/* Prepares now what renders filter of the environment when they first need it: reflections of every roughness, sheen and
 * irradiance. For processes that are forked afterwards and share it; images do not depend on it. thread_count 0:
 * facet_thread_count(). FACET_ERROR_MEMORY. */
FACET_API facet_result facet_environment_prepare(facet_environment *environment, uint32_t thread_count,
                                                 facet_error *error);

typedef struct facet_environment_info {
    facet_layout layout;
    uint32_t width, height; /* of the image, or of a face of a cube map */
    /* with NaN or negative values, replaced by 0, or infinity, by the largest number */
    uint64_t repaired_texels;
    double mean[3];     /* radiance over the sphere, cd/m^2 */
    float max_radiance; /* of any channel */
} facet_environment_info;
FACET_API facet_result facet_environment_get_info(const facet_environment *environment,
                                                  facet_environment_info *info, facet_error *error);

/* ---- skies and the sun ---- */

typedef enum facet_sky_model {
    FACET_SKY_MODEL_ATMOSPHERE, /* scattering of all orders in the Earth's atmosphere (Hillaire 2020) */
    FACET_SKY_MODEL_PREETHAM    /* the fit of Preetham, Shirley and Smits (1999) */
} facet_sky_model;

/* A clear sky by day. {0}: sun on the horizon towards +Z, standard air. */
typedef struct facet_sky_desc {
    facet_sky_model model;
    /* [-pi/2, pi/2]; Preetham: not below the horizon, else FACET_ERROR_ARGUMENT */
    float sun_elevation_rad;
    float sun_azimuth_rad;  /* from +Z towards +X, as in facet_orbit */
    float turbidity;        /* [1.7, 10], of the atmosphere from 1 (no haze); 0: 2.5 */
    float ground_albedo[3]; /* [0, 1], seen below the horizon and, in the atmosphere, in the sky */
    float altitude_m;       /* of the eye above the ground, [0, 50 000]; atmosphere only */
    bool omits_disc;        /* leaves out the sun's disc, not its light scattered in the air */
    uint32_t height;        /* texels; 0: 512 */
    /* The sky is scaled to this illuminance of the surface that receives most; illuminances below 1 lx
     * count as 1. pi: a white surface in this light has 1 cd/m^2. 0: physical units. */
    float illuminance_lux;
} facet_sky_desc;

/* Texels are cd/m^2: some 10^4 for a blue sky, 10^9 for the sun, whose energy is spread over the texels
 * that it covers. */
FACET_API facet_result facet_environment_create_sky(const facet_sky_desc *sky,
                                                    const facet_environment_desc *desc,
                                                    facet_environment **environment, facet_error *error);

/* A disc of uniform radiance at infinite distance. {0}: none. */
typedef struct facet_sun {
    float azimuth_rad;        /* around +Y; 0: from +Z, positive: towards +X, as in facet_orbit */
    float elevation_rad;      /* above the horizon */
    float illuminance_lux[3]; /* on a surface that faces it, linear Rec.709; 0: no sun */
    float diameter_rad;       /* 0: 0.53 degrees, that of the real sun */
} facet_sun;

#ifdef __cplusplus
}
#endif

#endif
