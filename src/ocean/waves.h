/* waves.h - a sea sampled from its spectrum: the sum of periodic tiles of different length, each with its
 * band of wavenumbers. Everything is a function of seed and time, independent of resolution and threads.
 *
 * The longest tile, and those with the peak of the wind sea or the swell, are read without repetition: see
 * wave_patches.h. */
#ifndef OCEAN_WAVES_H
#define OCEAN_WAVES_H

#include "ocean/sea_state.h"

enum { WAVES_MAX_TILES = SEA_MAX_BANDS, WAVES_MAX_LEVELS = 11 };

/* Fields of a texel, at a rest position of the water. Texel i of a row lies at i length / size. */
typedef enum wave_field {
    WAVE_DX,  /* displacement, m, choppiness included, in the tile's axes */
    WAVE_ETA, /* height, m */
    WAVE_DZ,
    WAVE_ETA_X, /* slopes of ETA */
    WAVE_ETA_Z,
    WAVE_DXX, /* derivatives of the displacement, choppiness included */
    WAVE_DZZ,
    WAVE_DXZ,
    WAVE_FIELDS
} wave_field;

/* Bounds of a level's texels, and so of everything read from it. */
typedef struct wave_bounds {
    float highest, lowest; /* of ETA, m */
    float steepest;        /* slope of the displaced surface of this tile alone */
    float farthest;        /* displacement, m */
} wave_bounds;

typedef struct wave_tile {
    double length_m;
    bool is_patched;
    double turn; /* rad: rotation of the tile's axes from +X towards +Z */
    double k_from, k_to;
    uint32_t size;        /* samples along an edge */
    uint32_t level_count; /* means of 2 x 2, down to one texel */
    /* each (size >> l)^2 texels of WAVE_FIELDS; rows along the tile's z */
    float *levels[WAVES_MAX_LEVELS];
    wave_bounds bounds[WAVES_MAX_LEVELS];
    double samples_per_m;        /* size / length_m */
    double cos_per_m, sin_per_m; /* of turn, times samples_per_m: from world to samples */
    float cos_turn, sin_turn;
} wave_tile;

typedef struct waves {
    sea_state state;
    double choppiness, loop_s;
    uint64_t seed;
    double time_s;
    float level_m;       /* added to ETA so that the mean of the surface, from above, is 0 */
    uint32_t tile_count; /* 0: flat */
    wave_tile tiles[WAVES_MAX_TILES];
    struct wave_amplitudes *amplitudes[WAVES_MAX_TILES]; /* wave_amplitudes.h */
    struct wave_transform *transform;                    /* wave_transform.h */
    facet_allocator allocator;
    uint32_t thread_count;
} waves;

/* At time 0. sea_state_create() has checked desc. FACET_ERROR_MEMORY; FACET_ERROR_UNSUPPORTED: facet was
 * built without kissfft, and there are waves. */
facet_result waves_create(const facet_sea_desc *desc, const sea_state *state, waves *out, facet_error *error);
/* The time of glints, with a resolution of 1 ms in float: it wraps every 4.5 hours. */
static inline float waves_glint_time(const waves *w)
{
    const double again_s = 16384.0;
    double time_s = fmod(w->time_s, again_s);
    return (float)(time_s < 0.0 ? time_s + again_s : time_s);
}
/* Allocates nothing and never fails after waves_create(). */
void waves_set_time(waves *w, double time_s);
void waves_destroy(waves *w); /* {0} is allowed */

/* Bounds of the surface filtered to a footprint (m), relative to still water (level_m included): elevation,
 * steepest slope, largest displacement. steepest sums the bounds of the tiles, which suffices for marching
 * unless crests of different tiles fold over each other. */
wave_bounds waves_bounds(const waves *w, float footprint_m);

/* The water at rest position (x, z): sums over all tiles in world axes, each averaged over a square of the
 * footprint (m) and interpolated. Tiles with only shorter waves add nothing. */
typedef struct wave_point {
    float displacement[2]; /* along X and Z, m */
    float height_m;        /* with level_m */
    float slope[2];        /* of ETA */
    float Dxx, Dzz, Dxz;
} wave_point;
wave_point waves_at(const waves *w, double x, double z, float footprint_m);
/* The surface at the world position (X, Z), found by iteration. rest: rest position of the water there. */
wave_point waves_above(const waves *w, double X, double Z, float footprint_m, double rest[2]);
/* Height alone, for marching. Linear between samples, where the others are cubic: they differ by a
 * hundredth of the height. */
float waves_height(const waves *w, double X, double Z, float footprint_m);
/* The same, starting from a displacement estimate, such as that of a nearby place, and returning the one
 * found: half the time for short steps. {0, 0}: no estimate. */
float waves_height_near(const waves *w, double X, double Z, float footprint_m, float displacement[2]);
/* Vertical velocity of the water at rest position (x, z), m/s: a sum over all waves, about 50 us. */
double waves_velocity(const waves *w, double x, double z);

/* The geometry of a wave_point: exact normal of the displaced surface (Y > 0), Jacobian, convergence q =
 * -(Dxx + Dzz). */
typedef struct wave_shape {
    float normal[3];
    float jacobian;
    float convergence;
} wave_shape;
wave_shape wave_shape_of(const wave_point *p);

/* ---- filtered slopes ---- */

/* Covariance of slopes in world axes: xx, zz, xz. */
typedef struct slope_covariance {
    float xx, zz, xz;
} slope_covariance;

/* Tables over the footprint, made once per sea. */
typedef struct slope_filter {
    slope_covariance total; /* Cox and Munk's, along the wind */
    /* total minus the slopes that a footprint resolves; of footprints slope_filter_footprint(i) */
    slope_covariance residual[64];
    float curvature[64], rate[64]; /* sea_moments.k4 (1/m^2) and mean omega (rad/s) of the unresolved waves */
    float convergence_variance[64]; /* of q within the footprint */
} slope_filter;
void slope_filter_create(const waves *w, slope_filter *out);
float slope_filter_footprint(uint32_t i); /* m, geometric from 1 mm to 100 km */
/* Fractional index of a footprint, [0, 63]. */
float slope_filter_place(float footprint_m);

/* ---- foam ---- */

/* A crest breaks where q exceeds a threshold, chosen so that the broken area, from above, matches
 * whitecap_coverage(). INFINITY: no foam. sigma: standard deviation of q over all tiles. */
typedef struct foam_rule {
    float threshold, active_threshold; /* of all foam, and of the tenth that is active */
    float sigma;
    float coverage;
} foam_rule;
foam_rule foam_rule_create(const waves *w);
/* Foam coverage of a footprint, [0, 1], from mean and variance of q in it. */
float foam_coverage(const foam_rule *r, float mean, float variance, float threshold);

#endif
