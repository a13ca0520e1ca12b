/* sea_preset.c - see sea_preset.h. */
#include "ocean/sea_preset.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/result.h"

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

/* No wind: a mirror that bends with what is left of a swell. */
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

/* Fully developed at 10 m/s, 2.24 m, 6.4 s; blue, poor water of the tropics. */
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
