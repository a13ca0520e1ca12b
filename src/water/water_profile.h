/* water_profile.h - the sea as one eye sees it, for all rays of an image at once.
 *
 * Every ray from an eye keeps its azimuth. Along an azimuth the surface at the distance r is seen under
 * the elevation whose tangent is
 *   e(r) = (eta(r) - y_eye - r^2 / (2 R)) / r
 * and a ray of tangent e meets the first r that has as much: the greatest e so far grows with r, so it is
 * found by bisection. The surface is sampled 4 pixels apart along and across, where waves that are shorter
 * are less than a tenth of a pixel high; the place that is found is corrected by the surface as it is. */
#ifndef WATER_WATER_PROFILE_H
#define WATER_WATER_PROFILE_H

#include "draw/camera_rays.h"
#include "water/water_march.h"

/* A surface sample. */
typedef struct profile_sample {
    float height_m, displacement[2];
} profile_sample;

typedef struct water_profile {
    const water_march *march;
    double origin[3];
    bool is_below;
    double first_azimuth, columns_per_rad;
    uint32_t column_count, row_count; /* 0: there is none */
    double first_m, rows_per_log;     /* distance of row 0; rows per natural logarithm of distance */
    /* column_count columns of row_count: running maximum of e (seen from below: of -e); allocated by
     * mem_alloc() */
    float *tangents;
    uint32_t finer;          /* columns per column of samples */
    profile_sample *samples; /* column_count / finer + 1 columns of row_count */
} water_profile;

/* For the part (x, y, width, height in pixels) of an image. Empty, as not needed, for parallel rays and still
 * water. FACET_ERROR_MEMORY. */
facet_result water_profile_create(const water_march *m, const camera_rays *rays, const uint32_t part[4],
                                  bool is_below, uint32_t thread_count, const facet_allocator *allocator,
                                  water_profile *out, facet_error *error);
/* Azimuth range of the part's rays that are not too steep: center, from +X towards +Z, and half width. False:
 * none. */
bool water_profile_azimuths(const camera_rays *rays, const uint32_t part[4], double *middle, double *half);
void water_profile_destroy(water_profile *p); /* {0} is allowed */

/* As water_march_find(), for a ray from the eye. */
bool water_profile_find(const water_profile *p, const march_ray *ray, march_hit *hit);

/* The same in two steps. The first, in a tenth of the time, finds an approximate place; the second refines it
 * on the exact surface. A place may also be interpolated between those of several nearby rays. */
typedef struct profile_place {
    double t;
    double closing;        /* rate at which the ray approaches the surface there, m per m */
    double slack_m;        /* error bound of the distance; 0: exact */
    float displacement[2]; /* of the water nearby */
} profile_place;
/* Search state of the previous ray of the pixel; {0}: none. It saves time and changes results only by
 * rounding. */
typedef struct profile_nearby {
    uint32_t row;
    double azimuth, x, z;
} profile_nearby;
bool water_profile_look(const water_profile *p, const march_ray *ray, profile_nearby *nearby,
                        profile_place *out);
#endif
