/* sea.c - a sea is made of its parts, and given up. */
#include "ocean/sea.h"

#include <math.h>
#include <stdatomic.h>

#include "base/memory.h"
#include "base/result.h"
#include "ocean/sea_preset.h"

/* 0 stands for the default where it is no number of a sea. */
static facet_sea_desc complete(const facet_sea_desc *desc)
{
    facet_sea_desc d = *desc, otherwise = sea_default();
    d.fetch_m = d.fetch_m != 0.0f ? d.fetch_m : otherwise.fetch_m;
    d.peakedness = d.peakedness != 0.0f ? d.peakedness : otherwise.peakedness;
    d.resolution = d.resolution ? d.resolution : otherwise.resolution;
    d.cascade_count = d.cascade_count ? d.cascade_count : otherwise.cascade_count;
    return d;
}

facet_result sea_create(const facet_sea_desc *asked, facet_sea **sea, facet_error *error)
{
    *sea = NULL;
    const facet_sea_desc d = complete(asked), *desc = &d;
    sea_state state;
    water_optics optics;
    facet_result result = sea_state_create(desc, &state, error);
    if (!result)
        result = water_optics_create(&desc->water, &optics, error);
    if (result)
        return result;
    facet_sea *s = mem_zalloc(&desc->allocator, 1, sizeof *s);
    if (!s)
        return fail_memory(error, "a sea", sizeof *s);
    static _Atomic uint64_t last_serial;
    s->serial = atomic_fetch_add(&last_serial, 1) + 1;
    s->desc = *desc;
    s->optics = optics;
    result = waves_create(desc, &state, &s->waves, error);
    if (result) {
        mem_free(s);
        return result;
    }
    slope_filter_create(&s->waves, &s->slopes);
    s->foam = foam_rule_create(&s->waves);
    *sea = s;
    return FACET_OK;
}

void sea_destroy(facet_sea *sea)
{
    if (!sea)
        return;
    waves_destroy(&sea->waves);
    mem_free(sea);
}

/* ---- a camera ---- */

static const float EYE_M = 3.0f, CLEARANCE_M = 1.0f, FOV_RAD = 0.61f, /* a lens of 38 mm */
    DIP_RAD = 0.07f;

facet_camera sea_camera(const facet_sea *sea, float height_m, float azimuth_rad)
{
    height_m = isfinite(height_m) ? height_m : 0.0f;
    azimuth_rad = isfinite(azimuth_rad) ? azimuth_rad : 0.0f;
    float waves_m = 4.0f * (float)sqrt(sea_state_moments(&sea->waves.state, 0.0, ENDLESS).height);
    float y = height_m != 0.0f ? height_m : fmaxf(EYE_M, waves_m);
    float water = waves_height(&sea->waves, 0.0, 0.0, 0.0f);
    if (y > 0.0f)
        y = fmaxf(y, water + CLEARANCE_M);
    float x = sinf(azimuth_rad) * cosf(DIP_RAD), z = cosf(azimuth_rad) * cosf(DIP_RAD);
    return (facet_camera){.eye = {0.0f, y, 0.0f}, .target = {x, y - sinf(DIP_RAD), z}, .fov_y_rad = FOV_RAD};
}
