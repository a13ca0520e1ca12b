/* environment.h - the state of a facet_environment: the panorama, and the parts of lights prepared from it. */
#ifndef IBL_ENVIRONMENT_H
#define IBL_ENVIRONMENT_H

#include <pthread.h>

#include "facet/facet.h"
#include "ibl/cube.h"
#include "ibl/harmonics.h"
#include "ibl/narrow.h"
#include "ibl/prefilter.h"
#include "image/image.h"

enum { REDUCED_COUNT = 4 }; /* full size, half, quarter, eighth */

/* Parts are prepared under the mutex when a light first needs them and never change afterwards, so that
 * lights read them without it. */
typedef struct light_parts {
    image reduced[REDUCED_COUNT]; /* [0] is not used: that is the panorama itself */
    cube levels[PREFILTER_LOBE_COUNT][PREFILTER_LEVEL_COUNT]; /* [][0] is not used */
    harmonics harmonics;                                      /* harmonics that the levels are made of */
    narrow narrow;                                            /* between roughness 0 and level 1 of GGX */
    bool has_narrow;
} light_parts;

struct facet_environment {
    facet_allocator allocator;
    facet_log log;
    cube irradiance_over_pi; /* if the source states it; else {0}, and the panorama's irradiance is used */
    image panorama;          /* equirectangular, F32 RGB, in [0, ENVIRONMENT_MAX_RADIANCE] */
    facet_layout layout;     /* of the source; {0}: equirectangular */
    uint32_t source_width, source_height; /* for facet_environment_info; 0: those of the panorama */
    uint64_t repaired_texels;
    bool is_studio; /* the panorama is that of studio_draw() */
    /* The cube map that the panorama was resampled from, in the same range; {0}: the source was not a cube
     * map */
    cube faces;
    uint64_t hash;      /* of the source, if there is a cache_folder */
    char *cache_folder; /* NULL: none */
    uint64_t cache_bytes;
    uint32_t reference_count; /* the caller's reference and one per light */
    pthread_mutex_t mutex;    /* guards reference_count and parts */
    light_parts parts;
};

/* Above the sun's 2e9 cd/m^2, and sums over the sphere stay finite. */
#define ENVIRONMENT_MAX_RADIANCE 1e12f

/* An environment with one reference and no panorama yet, for the functions that create environments.
 * FACET_ERROR_MEMORY. */
facet_result environment_create(const facet_environment_desc *desc, facet_environment **environment,
                                facet_error *error);
/* Clamps the panorama to [0, ENVIRONMENT_MAX_RADIANCE]; files may hold values that are not radiance. */
void environment_limit(facet_environment *environment, uint32_t thread_count);

/* Add and remove a reference; the last one releases everything. */
void environment_retain(facet_environment *environment);
void environment_release(facet_environment *environment);

#endif
