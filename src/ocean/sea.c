/* sea.c - a sea is made of its parts, and given up. */
#include "ocean/sea.h"

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
    sea_kept_put(&sea->light, NULL);
    sea_kept_put(&sea->foam_history, NULL);
    waves_destroy(&sea->waves);
    mem_free(sea);
}
