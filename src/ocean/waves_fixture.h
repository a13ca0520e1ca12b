/* waves_fixture.h - for tests: waves to look at, and places to look. */
#ifndef OCEAN_WAVES_FIXTURE_H
#define OCEAN_WAVES_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "ocean/sea.h"
#include "ocean/waves.h"
#include "tests/support/support.h"

/* The wind's waves are as high as 100 km let them grow. */
static inline facet_sea_desc desc_of(uint32_t resolution, uint32_t cascade_count, uint64_t seed)
{
    facet_sea_desc d = sea_default();
    d.fetch_m = 100e3f;
    d.resolution = resolution;
    d.cascade_count = cascade_count;
    d.seed = seed;
    d.thread_count = 2;
    return d;
}

static inline waves waves_of(facet_sea_desc d)
{
    sea_state s;
    waves w = {.tile_count = 0};
    facet_error error = {.message = ""};
    if (sea_state_create(&d, &s, &error) || waves_create(&d, &s, &w, &error))
        fail_msg("%s", error.message);
    return w;
}

#endif
