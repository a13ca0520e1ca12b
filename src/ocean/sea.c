/* sea.c - creation of a sea, its default camera, presets and maps. */
#include "ocean/sea.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"

/* Replaces 0 by the default where it is not a valid value. */
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

/* ---- presets ---- */

static const float DEGREE = 0.017453292f;

facet_sea_desc sea_default(void)
{
    return (facet_sea_desc){
        .wind_mps = 10.0f,
        .fetch_m = INFINITY,
        .peakedness = 3.3f,
        .choppiness = 1.0f,
        .resolution = 256,
        .cascade_count = 3,
        .seed = 1,
        .water = {
            .chlorophyll_mg_m3 = 0.2f, .salinity = 35.0f, .temperature_C = 20.0f, .foam_albedo = 0.55f}};
}

/* No wind: a mirror bent by the remains of a swell. */
static void glass(facet_sea_desc *d)
{
    d->wind_mps = 0.0f;
    d->swell = (facet_swell){
        .height_m = 0.4f, .period_s = 7.0f, .direction_rad = 25.0f * DEGREE, .elongation = 0.8f};
    d->water.chlorophyll_mg_m3 = 0.1f;
}

/* 5 m/s: 0.56 m, 3.2 s. */
static void breeze(facet_sea_desc *d)
{
    d->wind_mps = 5.0f;
    d->water.chlorophyll_mg_m3 = 0.3f;
}

/* Fully developed at 10 m/s, 2.24 m, 6.4 s; blue, oligotrophic water of the tropics. */
static void trade_wind(facet_sea_desc *d)
{
    d->water.chlorophyll_mg_m3 = 0.08f;
    d->water.salinity = 36.0f;
    d->water.temperature_C = 26.0f;
}

/* 20 m/s over 500 km: 8.98 m, 12.8 s. */
static void gale(facet_sea_desc *d)
{
    d->wind_mps = 20.0f;
    d->fetch_m = 500e3f;
    d->water.chlorophyll_mg_m3 = 0.5f;
    d->water.temperature_C = 8.0f;
    d->cascade_count = 4;
}

/* 3 m over coral sand, behind a reef. */
static void lagoon(facet_sea_desc *d)
{
    d->wind_mps = 4.0f;
    d->fetch_m = 1500.0f;
    d->water.chlorophyll_mg_m3 = 0.1f;
    d->water.temperature_C = 28.0f;
    d->bed = (facet_sea_bed){.depth_m = 3.0f, .albedo = {0.50f, 0.46f, 0.38f}};
}

/* Green coastal water over mud. */
static void harbour(facet_sea_desc *d)
{
    d->wind_mps = 3.0f;
    d->fetch_m = 800.0f;
    d->water.kind = FACET_WATER_KIND_JERLOV_3C;
    d->water.salinity = 30.0f;
    d->water.temperature_C = 14.0f;
    d->bed = (facet_sea_bed){.depth_m = 8.0f, .albedo = {0.12f, 0.10f, 0.07f}};
}

static const struct {
    const char *name;
    void (*change)(facet_sea_desc *d); /* of the default */
} presets[] = {{"glass", glass}, {"breeze", breeze}, {"trade-wind", trade_wind},
               {"gale", gale},   {"lagoon", lagoon}, {"harbour", harbour}};
enum { PRESETS = sizeof presets / sizeof *presets };

uint32_t sea_preset_count(void)
{
    return PRESETS;
}

const char *sea_preset_name(uint32_t index)
{
    return index < PRESETS ? presets[index].name : NULL;
}

facet_result sea_preset(const char *name, facet_sea_desc *desc, facet_error *error)
{
    for (uint32_t i = 0; name && i < PRESETS; i++)
        if (strcmp(name, presets[i].name) == 0) {
            *desc = sea_default();
            presets[i].change(desc);
            return FACET_OK;
        }
    char names[128] = "";
    for (uint32_t i = 0, at = 0; i < PRESETS && at < sizeof names; i++)
        at += (uint32_t)snprintf(names + at, sizeof names - at, "%s%s", i ? ", " : "", presets[i].name);
    return fail(error, FACET_ERROR_ARGUMENT, "sea: there is no preset '%s' among %s", name ? name : "",
                names);
}

/* ---- maps ---- */

/* The total minus this tile's share by the spectrum. */
float sea_others_variance(const facet_sea *sea, uint32_t tile)
{
    const waves *w = &sea->waves;
    const wave_tile *t = &w->tiles[tile];
    double own = sea_state_moments(&w->state, t->k_from, t->k_to).convergence * w->choppiness * w->choppiness;
    double all = (double)sea->foam.sigma * (double)sea->foam.sigma;
    return own < all ? (float)(all - own) : 0.0f;
}

sea_texel sea_texel_of(const facet_sea *sea, uint32_t tile, float others_variance, uint32_t column,
                       uint32_t row)
{
    const wave_tile *t = &sea->waves.tiles[tile];
    const float *f = t->levels[0] + ((size_t)row * t->size + column) * WAVE_FIELDS;
    const wave_point p = {.displacement = {f[WAVE_DX], f[WAVE_DZ]},
                          .height_m = f[WAVE_ETA],
                          .slope = {f[WAVE_ETA_X], f[WAVE_ETA_Z]},
                          .Dxx = f[WAVE_DXX],
                          .Dzz = f[WAVE_DZZ],
                          .Dxz = f[WAVE_DXZ]};
    wave_shape shape = wave_shape_of(&p);
    sea_texel out = {.displacement = {f[WAVE_DX], f[WAVE_ETA], f[WAVE_DZ]},
                     .slope = {f[WAVE_ETA_X], f[WAVE_ETA_Z]},
                     .jacobian = shape.jacobian,
                     .foam =
                         foam_coverage(&sea->foam, shape.convergence, others_variance, sea->foam.threshold)};
    memcpy(out.normal, shape.normal, sizeof out.normal);
    return out;
}
