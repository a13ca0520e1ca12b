/* water_pixel.c - see water_pixel.h. */
#include "water/water_pixel.h"

#include <math.h>

#include "water/water_trace.h"

static vec3 trace(const water_setup *s, float x, float y, float footprint, uint32_t random)
{
    water_sample p = water_sample_begin(s, x, y, footprint, random);
    march_hit sea;
    bool is_met = water_profile_find(&s->profile, &p.ray, &sea);
    return water_sample_shade(&p, is_met, &sea);
}

/* ---- groups of samples ---- */

enum { MOST_GROUPED = 16 };

/* Samples of a pixel that meet one piece of water, or nothing. */
typedef struct group {
    bool is_met;
    float x, y;        /* sums over the samples */
    double distance_m; /* sum */
    double closing;    /* of the first */
    uint32_t count;
    const water_sight *sights[MOST_GROUPED];
} group;

/* Groups of a pixel. */
typedef struct grouping {
    const water_setup *s;
    uint32_t sample_count, group_count;
    water_sight sights[MOST_GROUPED];
    group groups[MOST_GROUPED];
} grouping;

/* Whether t is in the piece of water that a pixel shows at the place of a group: within what it covers of a slope. */
static bool is_one_piece(const group *g, const profile_place *place, float pixel_size)
{
    double t = g->distance_m / g->count, closing = fmin(g->closing, place->closing);
    return fabs(place->t - t) < t * (double)pixel_size * (1.5 + 1.5 / fmax(closing, 0.03));
}

static bool joins(const water_setup *s, const group *g, bool is_met, const profile_place *place)
{
    if (g->is_met != is_met)
        return false;
    return !is_met || is_one_piece(g, place, s->camera.pixel_size);
}

static void add(grouping *p, float x, float y, bool is_met, const water_sight *sight)
{
    uint32_t k = 0;
    while (k < p->group_count && !joins(p->s, &p->groups[k], is_met, &sight->place))
        k++;
    group *g = &p->groups[k];
    if (k == p->group_count) {
        g->is_met = is_met;
        g->x = g->y = 0.0f;
        g->distance_m = 0.0;
        g->closing = sight->place.closing;
        g->count = 0;
        p->group_count++;
    }
    g->sights[g->count++] = sight;
    g->x += x;
    g->y += y;
    g->distance_m += sight->place.t;
}

static vec3 shade_group(const grouping *p, const group *g)
{
    const water_setup *s = p->s;
    float n = (float)g->count;
    water_sample one = water_sample_begin(s, g->x / n, g->y / n, sqrt(n / (float)p->sample_count), 0);
    march_hit sea = {.t = 0.0};
    water_place place;
    if (g->is_met) {
        place = water_place_of_samples(s, &one.ray, g->sights, g->count, &sea);
        one.place = &place;
    }
    return water_sample_shade(&one, g->is_met, &sea);
}

/* A disc has an edge that a sample may show. */
static bool is_near_sun(const water_setup *s, vec3 d)
{
    vec3 off = d - s->sky.L;
    float reach = s->sky.disc_radius + 2.0f * s->camera.pixel_size;
    return s->sky.disc_radius > 0.0f && dot(off, off) < reach * reach;
}

static bool can_group(const water_setup *s, uint32_t count)
{
    bool has_land = water_has_bed(s) && s->sea->desc.bed.slope > 0.0f;
    return count > 1 && count <= MOST_GROUPED && s->desc->quality != FACET_QUALITY_FINAL && !s->is_below &&
           !s->model.is_there && !has_land && !s->camera.is_orthographic;
}

static vec3 trace_grouped(const water_setup *s, float x, float y, const float *pattern, uint32_t count)
{
    grouping p;
    p.s = s;
    p.sample_count = count;
    p.group_count = 0;
    profile_nearby nearby = {.row = 0};
    vec3 sum = vec3(0.0f);
    for (uint32_t i = 0; i < count; i++) {
        float px = x + pattern[2 * i], py = y + pattern[2 * i + 1];
        water_sample one = water_sample_begin(s, px, py, s->footprint, 0);
        water_sight *sight = &p.sights[i];
        sight->place = (profile_place){.closing = 1.0};
        for (int k = 0; k < 3; k++)
            sight->direction[k] = one.ray.direction[k];
        bool is_met = water_profile_look(&s->profile, &one.ray, &nearby, &sight->place);
        if (!is_met && is_near_sun(s, one.d))
            sum = sum + water_sample_shade(&one, false, NULL);
        else
            add(&p, px, py, is_met, sight);
    }
    for (uint32_t k = 0; k < p.group_count; k++)
        sum = sum + shade_group(&p, &p.groups[k]) * (float)p.groups[k].count;
    return sum * (1.0f / (float)count);
}

vec3 water_pixel_trace(const water_setup *s, uint32_t x, uint32_t y, const float *pattern, uint32_t count)
{
    if (can_group(s, count))
        return trace_grouped(s, (float)x, (float)y, pattern, count);
    vec3 sum = vec3(0.0f);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t random = hash_uint(hash_uint(y * 65536u + x) + i);
        sum = sum + trace(s, (float)x + pattern[2 * i], (float)y + pattern[2 * i + 1], s->footprint, random);
    }
    return sum * (1.0f / (float)count);
}
