/* water_frame.c - see water_frame.h. The images of the sky come from the functions that the CPU renderer
 * looks it up with. */
#include "water/water_frame.h"

#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "shade/lang/lang_c_load.h"

#include "water/water_objects.h"
#include "water/water_setup.h"

/* A frame and the data that it points to. */
typedef struct frame_parts {
    water_frame frame; /* first */
    water_setup setup;
    sea_contact *contact;
} frame_parts;

/* ---- the sky ---- */

typedef struct sky_drawing {
    water_sky sky; /* without the sun's disc */
    const water_setup *setup;
    float *texels;
} sky_drawing;

/* Unit direction of a column in [0, 1] and a sine of elevation. */
static vec3 direction_of(float turn, float y)
{
    vec2 level = sky_turned(turn) * sqrt(max(1.0f - y * y, 0.0f));
    return vec3(level[0], y, level[1]);
}

static vec3 disc_at(const sky_drawing *s, float x, float y)
{
    vec3 L = s->sky.L;
    float level = sqrt(L[0] * L[0] + L[2] * L[2]);
    vec3 right = level > 1e-6f ? vec3(-L[2], 0.0f, L[0]) / level : vec3(1.0f, 0.0f, 0.0f);
    vec3 up = cross(L, right) * -1.0f;
    up = up[1] < 0.0f ? up * -1.0f : up;
    return water_sky_disc(&s->setup->sky, normalize(L + (right * x + up * y) * s->setup->sky.disc_radius));
}

static void store(vec3 color, float last, float *texel)
{
    for (int k = 0; k < 3; k++)
        texel[k] = color[k];
    texel[3] = last;
}

static void draw_texel(const sky_drawing *s, uint32_t layer, float u, float v, float *texel)
{
    const water_sky *sky = &s->sky;
    float horizon = sky->horizon_mu;
    switch (layer) {
    case SEA_SKY_SEEN:
        store(water_sky_seen(sky, direction_of(u, mix(horizon, 1.0f, sky_rise(v)))), 1.0f, texel);
        break;
    case SEA_SKY_AIR:
        store(water_sky_air_light(sky, direction_of(u, mix(horizon, -1.0f, sky_rise(v)))), 1.0f, texel);
        break;
    case SEA_SKY_TRANSMITTANCE: {
        float distance_m = u / (1.0f - u) * SEA_SKY_DISTANCE_KM * 1000.0f;
        store(water_sky_air(sky, vec3(1.0f, 0.0f, 0.0f), distance_m, 0.0f).transmittance, 1.0f, texel);
        break;
    }
    default:
        store(disc_at(s, 2.0f * u - 1.0f, 2.0f * v - 1.0f), 1.0f, texel);
    }
}

static void draw_rows(void *context, size_t begin, size_t end)
{
    const sky_drawing *s = context;
    for (size_t i = begin; i < end; i++) {
        float v = ((float)(i % SEA_SKY_HEIGHT) + 0.5f) / SEA_SKY_HEIGHT;
        for (uint32_t x = 0; x < SEA_SKY_WIDTH; x++)
            draw_texel(s, (uint32_t)(i / SEA_SKY_HEIGHT), ((float)x + 0.5f) / SEA_SKY_WIDTH, v,
                       s->texels + 4 * (i * SEA_SKY_WIDTH + x));
    }
}

static void draw_lobes(void *context, size_t begin, size_t end)
{
    const sky_drawing *s = context;
    for (size_t i = begin; i < end; i++) {
        float v = ((float)(i % SEA_LOBE_HEIGHT) + 0.5f) / SEA_LOBE_HEIGHT;
        float perceptual_roughness = (float)(i / SEA_LOBE_HEIGHT) / (SEA_LOBE_LAYERS - 1);
        for (uint32_t x = 0; x < SEA_LOBE_WIDTH; x++) {
            vec3 R = direction_of(((float)x + 0.5f) / SEA_LOBE_WIDTH, sky_rise(v));
            store(water_sky_reflected(&s->sky, R, perceptual_roughness), 1.0f,
                  s->texels + 4 * (i * SEA_LOBE_WIDTH + x));
        }
    }
}

/* Images of row_count rows, unless they exist already. */
static facet_result draw_once(const water_setup *setup, size_t row_count, size_t width,
                              void (*draw)(void *, size_t, size_t), float **texels, facet_error *error)
{
    if (*texels)
        return FACET_OK;
    *texels = mem_alloc(&setup->cache->allocator, row_count * width, 4 * sizeof(float));
    if (!*texels)
        return fail_memory(error, "images of the sky", row_count * width * 4 * sizeof(float));
    sky_drawing s = {.sky = setup->sky, .setup = setup, .texels = *texels};
    s.sky.disc_radius = 0.0f;
    parallel_for(setup->desc->thread_count, row_count, 4, draw, &s);
    return FACET_OK;
}

static facet_result draw_sky(const water_setup *setup, water_frame *p, facet_error *error)
{
    water_light *lit = setup->cache->light;
    facet_result result =
        draw_once(setup, SEA_SKY_LAYERS * SEA_SKY_HEIGHT, SEA_SKY_WIDTH, draw_rows, &lit->images, error);
    if (result == FACET_OK && setup->sky.has_views)
        result = draw_once(setup, SEA_LOBE_LAYERS * SEA_LOBE_HEIGHT, SEA_LOBE_WIDTH, draw_lobes, &lit->lobes,
                           error);
    p->sky = lit->images;
    p->lobes = lit->lobes;
    return result;
}

/* ---- a model ---- */

typedef struct contact_job {
    const water_setup *setup;
    const water_frame *frame;
    sea_contact *contact;
} contact_job;

static void measure_contact(void *context, size_t begin, size_t end)
{
    const contact_job *t = context;
    const water_frame *p = t->frame;
    double width = (double)(p->contact_high[0] - p->contact_low[0]) / SEA_CONTACT_EDGE;
    double length = (double)(p->contact_high[1] - p->contact_low[1]) / SEA_CONTACT_EDGE;
    vec3 L = t->setup->light.L;
    const bed_shadow *shadow = &t->setup->shadow;
    for (size_t z = begin; z < end; z++)
        for (size_t x = 0; x < SEA_CONTACT_EDGE; x++) {
            double P[3] = {(double)p->contact_low[0] + ((double)x + 0.5) * width, 0.0,
                           (double)p->contact_low[1] + ((double)z + 0.5) * length};
            P[1] = (double)waves_height(&p->sea->waves, P[0], P[2], (float)fmin(width, length)) + 1e-3;
            sea_contact *to = &t->contact[z * SEA_CONTACT_EDGE + x];
            to->dry = water_model_is_dry(&t->setup->model, P) ? 1.0f : 0.0f;
            to->open = L[1] > 0.0f ? water_model_visibility(&t->setup->model, P, L, HUGE_VAL) : 1.0f;
            bed_shadow_texel bed = {1.0f, 1.0f};
            if (shadow->is_there)
                bed = shadow->texels[z * BED_SHADOW_EDGE + x];
            to->bed_sun = bed.sun;
            to->bed_rest = bed.rest;
        }
}

/* The model's bounds and its shadow on the water, at most eight times as long as the model; with an
 * unaffected border. */
static void choose_rectangle(const vec3 L, water_frame *p)
{
    float above = max(p->model_high[1] - p->model_water_m, 0.0f);
    float size = max(p->model_high[0] - p->model_low[0], p->model_high[2] - p->model_low[2]);
    float reach = L[1] > 0.0f ? min(above / L[1], 8.0f * max(size, above)) : 0.0f,
          edge = 0.05f * size + 0.01f;
    for (int i = 0; i < 2; i++) {
        float shift = -L[2 * i] * reach;
        p->contact_low[i] = p->model_low[2 * i] + min(shift, 0.0f) - edge;
        p->contact_high[i] = p->model_high[2 * i] + max(shift, 0.0f) + edge;
    }
}

enum { LEVELS_EDGE = 24 };

/* Minimum and maximum water level around the model, with a footprint of width_m. */
static void find_water_around(const water_setup *s, float width_m, water_frame *p)
{
    p->model_water_low_m = p->model_water_high_m = p->model_water_m;
    for (int i = 0; i < LEVELS_EDGE * LEVELS_EDGE; i++) {
        float at[2] = {(float)(i % LEVELS_EDGE), (float)(i / LEVELS_EDGE)};
        for (int k = 0; k < 2; k++)
            at[k] = mix(p->model_low[2 * k], p->model_high[2 * k], at[k] / (LEVELS_EDGE - 1));
        float y = waves_height(&s->sea->waves, (double)at[0], (double)at[1], width_m);
        p->model_water_low_m = min(p->model_water_low_m, y);
        p->model_water_high_m = max(p->model_water_high_m, y);
    }
}

static facet_result describe_model(const water_setup *s, sea_contact **contact, water_frame *p,
                                   facet_error *error)
{
    *contact = mem_alloc(&s->desc->allocator, SEA_CONTACT_EDGE * SEA_CONTACT_EDGE, sizeof **contact);
    if (!*contact)
        return fail_memory(error, "water around a model",
                           SEA_CONTACT_EDGE * SEA_CONTACT_EDGE * sizeof **contact);
    p->model_desc = &s->model.desc;
    memcpy(p->model_low, s->model.bounds_min, sizeof p->model_low);
    memcpy(p->model_high, s->model.bounds_max, sizeof p->model_high);
    float size = max(p->model_high[0] - p->model_low[0], p->model_high[2] - p->model_low[2]);
    p->model_water_m =
        waves_height(&s->sea->waves, 0.5 * ((double)p->model_low[0] + (double)p->model_high[0]),
                     0.5 * ((double)p->model_low[2] + (double)p->model_high[2]), size);
    find_water_around(s, size / LEVELS_EDGE, p);
    choose_rectangle(s->light.L, p);
    p->has_shadow = s->shadow.is_there;
    for (int i = 0; i < 2; i++) {
        p->shadow_low[i] = (float)s->shadow.low[i];
        p->shadow_high[i] = (float)s->shadow.high[i];
    }
    contact_job t = {s, p, *contact};
    parallel_for(s->desc->thread_count, SEA_CONTACT_EDGE, 4, measure_contact, &t);
    p->contact = *contact;
    return FACET_OK;
}

/* ---- all ---- */

static void describe(const water_setup *s, water_frame *p)
{
    const water_sky *sky = &s->sky;
    p->sea = s->sea;
    p->desc = s->desc;
    p->foam = s->foam.share.level_count ? &s->foam : NULL;
    p->table = &s->table;
    p->caustics = s->caustics.is_there ? &s->caustics : NULL;
    p->is_below = s->is_below;
    p->fall = s->march.fall;
    p->deviation_m = s->march.deviation_m;
    p->shutter_s = s->shutter_s;
    p->exposure = s->exposure;
    store3(s->roughness, p->roughness);
    store3(s->light.L, p->L);
    store3(s->light.sun_irradiance, p->sun_irradiance);
    store3(s->light.sky_irradiance, p->sky_irradiance);
    store3(s->light.downwelling, p->downwelling);
    p->sun_fresnel = s->light.sun_fresnel;
    p->sky_reflectance = s->water.sky_reflectance;
    store3(s->beam, p->beam);
    store3(s->sunward, p->sunward);
    p->horizon_mu = sky->horizon_mu;
    store3(s->crest.beam, p->crest_beam);
    store3(s->crest.sunward, p->crest_sunward);
    p->crest_wavenumber = s->crest.wavenumber;
    p->crest_amplitude_m = s->crest.amplitude;
    p->disc_radius = sky->disc_radius;
    p->reflected = sky->reflected;
    p->background = sky->background;
    p->light_scale = sky->scale;
    p->rotation_cos = sky->rotation_cos;
    p->rotation_sin = sky->rotation_sin;
    if (!s->identities)
        return;
    p->water_identity = &s->identities[WATER_OBJECT_WATER];
    p->bed_identity = water_has_bed(s) ? &s->identities[WATER_OBJECT_BED] : NULL;
}

facet_result water_frame_create(water_cache *cache, const facet_scene *scene, const facet_render_desc *desc,
                                water_frame **out, facet_render_stats *stats, facet_error *error)
{
    double begin = clock_seconds();
    *out = NULL;
    frame_parts *p = mem_zalloc(&desc->allocator, 1, sizeof *p);
    if (!p)
        return fail_memory(error, "an image of the sea", sizeof *p);
    facet_result result = water_setup_create(
        cache, scene, desc, WATER_SETUP_BED_LIGHT | WATER_SETUP_MODEL_LIGHT, &p->setup, stats, error);
    if (result == FACET_OK) {
        describe(&p->setup, &p->frame);
        result = draw_sky(&p->setup, &p->frame, error);
    }
    if (result == FACET_OK && scene) {
        p->frame.model = scene;
        result = describe_model(&p->setup, &p->contact, &p->frame, error);
    }
    stats->light_s += clock_seconds() - begin;
    if (result != FACET_OK) {
        water_frame_destroy(&p->frame);
        return result;
    }
    *out = &p->frame;
    return FACET_OK;
}

void water_frame_destroy(water_frame *frame)
{
    if (!frame)
        return;
    frame_parts *p = (frame_parts *)frame;
    water_setup_destroy(&p->setup);
    mem_free(p->contact);
    mem_free(p);
}
