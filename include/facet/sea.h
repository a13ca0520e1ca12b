/* facet/sea.h - the ocean: spectra of waves, water optics, rendering, maps and meshes. docs/ocean.md has the
 * formulas and their sources.
 *
 * Still water is at y = 0. Directions of wind, swell, waves and the slope of the bed are angles from +X
 * towards +Z of where they go to (the bed: rises); those of sun and camera are angles from +Z towards +X. */
#ifndef FACET_SEA_H
#define FACET_SEA_H

#include "base.h"
#include "camera.h"
#include "environment.h"
#include "image.h"
#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- waves and water ---- */

typedef enum facet_sea_spectrum {
    /* Hasselmann et al. 1973, limited to the fully developed sea; in shallow water times the factor of
     * Bouws et al. 1985 (TMA) */
    FACET_SEA_SPECTRUM_JONSWAP,
    FACET_SEA_SPECTRUM_PIERSON_MOSKOWITZ, /* fully developed, independent of fetch (1964) */
    FACET_SEA_SPECTRUM_ELFOUHAILY         /* et al. 1997: one spectrum down to capillary waves */
} facet_sea_spectrum;

typedef enum facet_sea_spreading {
    FACET_SEA_SPREADING_HASSELMANN,     /* et al. 1980 */
    FACET_SEA_SPREADING_DONELAN_BANNER, /* Donelan, Hamilton and Hui 1985; Banner 1990 */
    FACET_SEA_SPREADING_COSINE          /* 2 / pi cos^2, downwind only */
} facet_sea_spreading;

/* Waves from far away, added to those of the wind. {0}: none. */
typedef struct facet_swell {
    float height_m; /* significant height, [0, 30], at most 0.142 of the peak's deep-water wavelength */
    float period_s; /* of the peak, (0, 40] */
    float direction_rad;
    float peakedness; /* JONSWAP's gamma, [1, 20]; 0: 7 */
    float elongation; /* [0, 1]; 1: crests as long as in Horvath 2015 */
} facet_swell;

/* Inherent optical properties, by Jerlov's water type or by content. */
typedef enum facet_water_kind {
    FACET_WATER_KIND_CHLOROPHYLL, /* open ocean (Morel 1988); content 0 is pure sea water */
    FACET_WATER_KIND_JERLOV_I,
    FACET_WATER_KIND_JERLOV_IA,
    FACET_WATER_KIND_JERLOV_IB,
    FACET_WATER_KIND_JERLOV_II,
    FACET_WATER_KIND_JERLOV_III,
    FACET_WATER_KIND_JERLOV_1C,
    FACET_WATER_KIND_JERLOV_3C,
    FACET_WATER_KIND_JERLOV_5C,
    FACET_WATER_KIND_JERLOV_7C,
    FACET_WATER_KIND_JERLOV_9C,
    FACET_WATER_KIND_COEFFICIENTS /* absorption, scattering and backscattering as given */
} facet_water_kind;

typedef struct facet_water {
    facet_water_kind kind;
    float chlorophyll_mg_m3; /* [0, 30] */
    /* 1/m, linear Rec.709; FACET_WATER_KIND_COEFFICIENTS only */
    float absorption[3], scattering[3], backscattering[3];
    float salinity; /* g of salt per kg, [0, 40] */
    float temperature_C;
    float ior;         /* [1, 2]; 0: by salinity and temperature at 550 nm (Quan and Fry 1995) */
    float foam_albedo; /* of fresh foam, [0, 1] */
} facet_water;

/* The sea bed, a plane. */
typedef struct facet_sea_bed {
    float depth_m; /* below the origin, (0, inf); 0: no bed */
    float slope;   /* rise per distance, [0, 1], towards direction_rad */
    float direction_rad;
    float albedo[3]; /* [0, 1] */
} facet_sea_bed;

/* {0}: still, fresh, pure water without a bed. facet_sea_default() is a sea. */
typedef struct facet_sea_desc {
    facet_allocator allocator;
    facet_log log;
    uint32_t thread_count; /* 0: facet_thread_count(); waves do not depend on it */
    float wind_mps;        /* mean at 10 m above the water, [0, 40] */
    float wind_direction_rad;
    float fetch_m; /* at least 100; INFINITY or 0: unlimited */
    facet_sea_spectrum spectrum;
    facet_sea_spreading spreading;
    float peakedness; /* JONSWAP's gamma, [1, 20]; 0: 3.3 */
    facet_swell swell;
    float choppiness;       /* horizontal displacement over the physical one, [0, 2]; 1: physical */
    double loop_s;          /* period after which the waves repeat, [0.1, 1e6]; 0: never */
    uint32_t resolution;    /* samples along an edge of a tile of waves, a power of two, [32, 1024]; 0: 256 */
    uint32_t cascade_count; /* tiles of different length, [1, 4]; 0: 3 */
    uint64_t seed;          /* of the random phases */
    facet_water water;
    facet_sea_bed bed; /* its depth shapes the waves too */
} facet_sea_desc;

/* 10 m/s along +X, unlimited fetch, chlorophyll 0.2 mg/m^3, salinity 35, 20 C, deep water, tiles of 256. */
FACET_API facet_sea_desc facet_sea_default(void);

/* Named seas: "glass", "breeze", "trade-wind", "gale", "lagoon", "harbour"; NULL past the end. */
FACET_API uint32_t facet_sea_get_preset_count(void);
FACET_API const char *facet_sea_get_preset_name(uint32_t index);
/* FACET_ERROR_ARGUMENT: no such name. */
FACET_API facet_result facet_sea_preset(const char *name, facet_sea_desc *desc, facet_error *error);

/* The sea at time 0. FACET_ERROR_ARGUMENT: a value is out of range, or the bed rises above the water at
 * the origin; FACET_ERROR_MEMORY. */
FACET_API facet_result facet_sea_create(const facet_sea_desc *desc, facet_sea **sea, facet_error *error);
FACET_API void facet_sea_destroy(facet_sea *sea);

/* Any finite time, forwards or backwards. No other thread may use the sea meanwhile. FACET_ERROR_ARGUMENT:
 * not finite. */
FACET_API facet_result facet_sea_set_time(facet_sea *sea, double time_s, facet_error *error);

/* ---- what is known of a sea ---- */

/* Statistics by the spectrum, and the optical properties. */
typedef struct facet_sea_info {
    double height_m;                     /* significant wave height, 4 standard deviations */
    double peak_period_s, peak_length_m; /* of wind waves or swell, whichever is higher; 0: flat */
    double slope_variance[2];            /* of all waves, along wind and across (Cox and Munk 1954) */
    double resolved_slope_variance[2];   /* of the waves in the tiles */
    double foam_coverage;                /* fraction of the area (Monahan and O'Muircheartaigh 1980) */
    double ior;
    double absorption[3], scattering[3], backscattering[3]; /* 1/m */
    double reflectance[3]; /* pi R_rs, diffuse, of deep water just above the surface */
    uint32_t tile_count;   /* 0: flat */
    double tile_length_m[4];
    double tile_turn_rad[4]; /* rotation of a tile's axes from +X towards +Z */
} facet_sea_info;
FACET_API facet_sea_info facet_sea_get_info(const facet_sea *sea);

typedef struct facet_sea_point {
    float height_m;
    float normal[3];
    float velocity_mps; /* vertical, of the water there, which also moves horizontally */
    float jacobian;     /* area over that of the water at rest; negative: folded */
} facet_sea_point;

/* The surface above or below count positions, pairs of x and z, for buoyancy. Some 50 us each, on the sea's
 * threads. */
FACET_API void facet_sea_get_points(const facet_sea *sea, const double *positions, size_t count,
                                    facet_sea_point *points);

/* A tile of waves for real-time renderers that sum tiles themselves. Tiles repeat every tile_length_m in
 * axes rotated by tile_turn_rad. Layers: "" RGBA, displacement along the tile's x, upwards and along its
 * z, m, and 1; "normal" (3, unit, of the displaced surface of this tile alone); "slope" (2, of the
 * height); "jacobian" (1); "foam" (1, expected foam coverage, [0, 1]). Rows follow the tile's z from its
 * origin; texel i is at i length / size. allocator NULL: {0}. FACET_ERROR_ARGUMENT: no such tile;
 * FACET_ERROR_MEMORY. */
FACET_API facet_result facet_sea_create_maps(const facet_sea *sea, uint32_t tile,
                                             const facet_allocator *allocator, facet_image **image,
                                             facet_error *error);

typedef struct facet_sea_mesh_desc {
    facet_allocator allocator;
    float size_m;       /* at rest; 0: the longest tile, 100 m where the sea is flat */
    uint32_t samples;   /* vertices along an edge, [2, 4096]; 0: 512 */
    double center_m[2]; /* x and z */
    float refinement;   /* vertex density at the center over that of an even grid, [1, 1000]; 0: 1 */
    bool omits_bed;
} facet_sea_mesh_desc;

/* A square of the surface and, if there is one, of the bed as a scene. The material of the water has the
 * sea's coefficients: KHR_materials_ior, _transmission and _volume (absorption and backscattering). desc
 * NULL: {0}. FACET_ERROR_ARGUMENT, _MEMORY. */
FACET_API facet_result facet_sea_create_mesh(const facet_sea *sea, const facet_sea_mesh_desc *desc,
                                             facet_scene **scene, facet_error *error);

/* ---- rendering ---- */

/* Distribution of the slopes that are finer than a pixel. */
typedef enum facet_sea_normals {
    FACET_SEA_NORMALS_BECKMANN, /* Gaussian, as those of the sea nearly are */
    FACET_SEA_NORMALS_GGX       /* the same width with longer tails */
} facet_sea_normals;

typedef enum facet_sea_masking {
    FACET_SEA_MASKING_SCALES, /* across wave scales, resolved or not; GGX has Smith's */
    FACET_SEA_MASKING_SMITH,  /* height-correlated Smith, of uncorrelated microfacets */
    /* separable, k = (r + 1)^2 / 8: too dark at grazing angles, for comparison */
    FACET_SEA_MASKING_SCHLICK_KARIS
} facet_sea_masking;

/* docs/ocean.md, "The legacy style". */
typedef enum facet_sea_style {
    FACET_SEA_STYLE_PHYSICAL,
    FACET_SEA_STYLE_LEGACY_WRITTEN, /* A: the legacy formulas as written */
    FACET_SEA_STYLE_LEGACY_INTENDED /* B: the legacy formulas with the intended signs */
} facet_sea_style;

/* {0}: physical. */
typedef struct facet_sea_shading {
    facet_sea_style style;
    facet_sea_normals normals;
    facet_sea_masking masking;
    bool has_schlick_fresnel;   /* Schlick's approximation instead of the exact equations */
    float perceptual_roughness; /* of the unresolved waves, [0.001, 1]; 0: by their slopes */
    bool omits_glints, omits_foam;
    bool omits_caustics; /* lights the bed evenly */
    uint32_t stage;      /* 1 to 5: steps from the legacy style to the physical one; 0: all */
    float clamp;         /* maximum of radiance times exposure; 0: none */
} facet_sea_shading;

/* A view from above the origin: height_m above the still water (0: 3 m, more in high seas; negative: under
 * water) and at least a metre above the waves there, towards azimuth_rad (from +Z towards +X, as
 * facet_sky_desc.sun_azimuth_rad, not as the directions of wind and waves), just below the horizon. */
FACET_API facet_camera facet_sea_camera(const facet_sea *sea, float height_m, float azimuth_rad);

#ifdef __cplusplus
}
#endif

#endif
