/* environment.h - what a facet_environment holds: the image, and the parts of lights that were prepared of it. */
#ifndef IBL_ENVIRONMENT_H
#define IBL_ENVIRONMENT_H

#include <pthread.h>

#include "facet/facet.h"
#include "ibl/cube.h"
#include "ibl/harmonics.h"
#include "ibl/narrow.h"
#include "ibl/prefilter.h"
#include "image/image.h"

enum { REDUCED_COUNT = 4 }; /* in full size, half, quarter, eighth */

/* Parts are prepared when a light first asks for them, under the mutex; from then on they never change, so that lights
 * read them without it. */
typedef struct light_parts {
    image reduced[REDUCED_COUNT];                             /* [0] is not used: that is the image itself */
    cube levels[PREFILTER_LOBE_COUNT][PREFILTER_LEVEL_COUNT]; /* [][0] is not used */
    harmonics harmonics;                                      /* what levels are made of */
    narrow narrow;                                            /* between mirrors and level 1 of GGX */
    bool has_narrow;
} light_parts;

struct facet_environment {
    facet_allocator allocator;
    facet_log log;
    cube irradiance_over_pi; /* where the source says what it is; else {0}, and it is that of the image */
    image panorama;          /* equirectangular, F32 RGB, in [0, ENVIRONMENT_MAX_RADIANCE] */
    facet_layout layout;     /* of the source; {0}: equirectangular, as image is */
    uint32_t source_width, source_height; /* as facet_environment_info has them; 0: those of image */
    uint64_t repaired_texels;
    cube faces;         /* what image was resampled from, in its range; {0}: the source was no cube map */
    uint64_t hash;      /* of what the image was made from, where there is a cache_folder */
    char *cache_folder; /* NULL: none */
    uint64_t cache_bytes;
    uint32_t reference_count; /* the caller's and one per light */
    pthread_mutex_t mutex;    /* guards the two below and the one above */
    light_parts parts;
};

/* Above the sun's 2e9 cd/m^2 and such that sums over a sphere stay finite. */
#define ENVIRONMENT_MAX_RADIANCE 1e12f

/* For what makes environments: one without an image, as desc says and with one reference. FACET_ERROR_MEMORY. */
facet_result environment_create(const facet_environment_desc *desc, facet_environment **environment,
                                facet_error *error);
/* Brings the image's values into [0, ENVIRONMENT_MAX_RADIANCE]; a file may hold what no light is. */
void environment_limit(facet_environment *environment, uint32_t thread_count);

/* Another reference, and one less: the last one releases everything. */
void environment_retain(facet_environment *environment);
void environment_release(facet_environment *environment);

#endif
