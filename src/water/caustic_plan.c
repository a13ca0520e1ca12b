/* caustic_plan.c - caustic_map_of_image() of water_caustics.h: the layers of an image. Rays through the whole image, even if only a crop is rendered, find
 * the visible part of the bed, and below still water the part that a model may shade. */
#include <math.h>
#include <stdlib.h>

#include "water/water_caustics.h"
#include "water/water_setup.h"

enum { RAYS = 24, MAX_SEEN = RAYS * RAYS };

/* Contrast of the bed's light below which caustics on it are invisible. */
static const float MIN_SEEN = 0.002f;

/* A point of the bed. */
typedef struct seen_place {
    double distance_m, X, Z;
    float depth_m;
    float width_m; /* footprint of a pixel */
} seen_place;

typedef struct view {
    const water_setup *s;
    caustic_source source;
    float axis[2];
    seen_place places[MAX_SEEN]; /* the nearest first */
    uint32_t count;
    float depth_m; /* at the first */
} view;

/* ---- what is seen ---- */

static float width_at(const water_setup *s, double distance_m)
{
    float pixel = s->camera.pixel_size;
    return s->camera.is_orthographic ? pixel : pixel * (float)distance_m;
}

/* Distance at which a ray enters the water, taken as still. */
typedef struct entered {
    double at[3], above_m;
    vec3 down;
    bool is_there;
} entered;

static entered enter(const water_setup *s, float x, float y)
{
    float o[3], d[3];
    camera_rays_at(&s->camera, x, y, o, d);
    vec3 along = normalize(vec3(d[0], d[1], d[2]));
    entered e = {.at = {(double)o[0], (double)o[1], (double)o[2]}, .down = along, .is_there = true};
    if (s->is_below)
        return e;
    if (along[1] > -1e-3f)
        return (entered){.is_there = false};
    e.above_m = e.at[1] / -(double)along[1];
    for (int i = 0; i < 3; i++)
        e.at[i] += e.above_m * (double)along[i];
    e.down = water_refracted(s->water, along, vec3(0.0f, 1.0f, 0.0f));
    return e;
}

static bool see(const water_setup *s, float x, float y, seen_place *place)
{
    const facet_sea_bed *bed = &s->sea->desc.bed;
    const vec3 up = vec3(0.0f, 1.0f, 0.0f);
    entered e = enter(s, x, y);
    double closing = water_bed_rise(bed, e.down) - (double)e.down[1];
    double height = e.at[1] - water_bed_height(bed, e.at[0], e.at[2]);
    if (!e.is_there || closing < 1e-3 || height <= 0.0)
        return false;
    double below_m = height / closing;
    *place = (seen_place){.distance_m = e.above_m + below_m,
                          .X = e.at[0] + below_m * (double)e.down[0],
                          .Z = e.at[2] + below_m * (double)e.down[2]};
    place->depth_m = (float)-water_bed_height(bed, place->X, place->Z);
    place->width_m = width_at(s, place->distance_m);
    if (!s->is_below) {
        vec3 V = -refract(e.down, up, s->water.ior), C = water_slopes_at(s, place->width_m).covariance;
        place->width_m =
            max(place->width_m, 0.1f * water_bed_footprint(s->water, up, V, e.down, C, 0.0f, (float)below_m));
    }
    return place->depth_m > 0.0f;
}

static int nearer(const void *a, const void *b)
{
    double p = ((const seen_place *)a)->distance_m, q = ((const seen_place *)b)->distance_m;
    return (p > q) - (p < q);
}

static bool has_waves(const water_setup *s)
{
    return s->sea->waves.tile_count > 0;
}

/* Whether sunlight there may differ from that of open, still water. */
static bool has_structure(const water_setup *s, const seen_place *place)
{
    double low[2], high[2];
    if (has_waves(s))
        return true;
    bed_shadow_of_beam(s, place->depth_m, low, high);
    return place->X > low[0] && place->X < high[0] && place->Z > low[1] && place->Z < high[1];
}

/* The point below the eye stands in for a bed that is only seen in reflections. */
static void find_places(view *v)
{
    const water_setup *s = v->s;
    const facet_render_desc *r = s->desc;
    for (uint32_t i = 0; i < MAX_SEEN; i++) {
        float x = (float)(i % RAYS) / (RAYS - 1) * (float)r->width;
        float y = (float)(i / RAYS) / (RAYS - 1) * (float)r->height;
        seen_place *place = &v->places[v->count];
        v->count += see(s, x, y, place) && has_structure(s, place);
    }
    qsort(v->places, v->count, sizeof *v->places, nearer);
    if (v->count == 0 && has_waves(s)) {
        const float *eye = s->camera.origin;
        double X = (double)eye[0], Z = (double)eye[2], bed = water_bed_height(&s->sea->desc.bed, X, Z);
        v->places[v->count++] = (seen_place){.distance_m = fabs((double)eye[1] - bed),
                                             .X = X,
                                             .Z = Z,
                                             .depth_m = (float)fmax(-bed, 0.0),
                                             .width_m = width_at(s, fabs((double)eye[1] - bed))};
    }
    v->depth_m = v->count > 0 ? v->places[0].depth_m : 0.0f;
}

/* Whether the sun's beam, and its reflection from the bed, pass through the water at the shallowest place. */
static bool is_worth_it(const view *v)
{
    const water_setup *s = v->s;
    float depth = v->depth_m;
    for (uint32_t i = 0; i < v->count; i++)
        depth = min(depth, v->places[i].depth_m);
    vec3 transmitted = water_focused(s->water, water_bed_albedo(&s->sea->desc.bed), s->light.downwelling,
                                     s->beam, s->sunward[1], depth) *
                       water_transmittance(water_beam(s->water), depth);
    return max(max(transmitted[0], transmitted[1]), transmitted[2]) > MIN_SEEN;
}

/* ---- layers ---- */

/* Variance (m^2, along the axes) of the light's position for slopes of covariance C. */
static vec2 variance_by_slopes(const view *v, vec3 C, float depth)
{
    const float step = 0.01f;
    vec3 L = v->source.L;
    vec2 still = water_caustics_shift(&v->source, v->axis, L, vec2(0.0f), depth);
    vec2 x = (water_caustics_shift(&v->source, v->axis, L, vec2(step, 0.0f), depth) - still) * (1.0f / step);
    vec2 z = (water_caustics_shift(&v->source, v->axis, L, vec2(0.0f, step), depth) - still) * (1.0f / step);
    return x * x * C[0] + z * z * C[1] + x * z * (2.0f * C[2]);
}

/* Of light from the whole disc of the sun: a quarter of its radius squared, through still water. */
static vec2 variance_by_disc(const view *v, float depth)
{
    vec3 L = v->source.L, across = vec3(-v->axis[1], 0.0f, v->axis[0]), up = cross(across, L);
    vec2 still = water_caustics_shift(&v->source, v->axis, L, vec2(0.0f), depth);
    vec2 a = water_caustics_shift(&v->source, v->axis, normalize(L + across * SUN_RADIUS), vec2(0.0f), depth);
    vec2 b = water_caustics_shift(&v->source, v->axis, normalize(L + up * SUN_RADIUS), vec2(0.0f), depth);
    a = a - still;
    b = b - still;
    return (a * a + b * b) * 0.25f;
}

/* All except the center. */
static caustic_plan plan_for(const view *v, float texel_m, float depth)
{
    const vec3 least = vec3(SLOPE_VARIANCE_MIN, SLOPE_VARIANCE_MIN, 0.0f);
    water_slopes slopes = water_slopes_at(v->s, texel_m);
    vec2 spread = variance_by_slopes(v, slopes.covariance - least, depth) + variance_by_disc(v, depth);
    vec2 moved = variance_by_slopes(v, slopes.resolved, depth);
    const float *axis = v->axis;
    vec2 still = water_caustics_shift(&v->source, axis, v->source.L, vec2(0.0f), 1.0f);
    float heave = 1.0f + length(still); /* displacement of light by a wave of 1 m, m */
    return (caustic_plan){
        .texel_m = texel_m,
        .sigma_m = {sqrt(max(spread[0], 0.0f)), sqrt(max(spread[1], 0.0f))},
        .margin_m = 3.0f * (sqrt(max(moved[0] + moved[1], 0.0f)) + heave * v->s->march.deviation_m)};
}

/* Centers the layer on as many visible points as it covers, from the nearest one on. */
static void place_layer(const view *v, caustic_plan *p)
{
    double least[2] = {HUGE_VAL, HUGE_VAL}, most[2] = {-HUGE_VAL, -HUGE_VAL};
    const double size = 0.8 * (double)p->texel_m * CAUSTIC_SIZE;
    double a = (double)v->axis[0], b = (double)v->axis[1];
    for (uint32_t i = 0; i < v->count; i++) {
        double X = v->places[i].X, Z = v->places[i].Z, at[2] = {X * a + Z * b, Z * a - X * b};
        double low[2], high[2];
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(least[k], at[k]);
            high[k] = fmax(most[k], at[k]);
        }
        if (high[0] - low[0] > size || high[1] - low[1] > size)
            break;
        for (int k = 0; k < 2; k++) {
            least[k] = low[k];
            most[k] = high[k];
        }
    }
    const double step = 2.0 * (double)p->texel_m; /* keeps the points fixed for a moving eye */
    double u = step * floor(0.5 * (least[0] + most[0]) / step),
           w = step * floor(0.5 * (least[1] + most[1]) / step);
    p->middle[0] = u * a - w * b;
    p->middle[1] = u * b + w * a;
}

/* Texel size of the finest layer: a power of 2 as fine as pixels, and no finer than light is focused or
 * than waves let the bed be seen; not mostly margin. Below still water a quarter of that: a shadow's edge
 * is as wide as four texels, and there is no other detail. */
static float finest_texel(const view *v)
{
    int power = (int)ceilf(log2(clamp(v->places[0].width_m, 1e-4f, 1e4f))) - (has_waves(v->s) ? 0 : 2);
    for (; power < 14; power++) {
        caustic_plan p = plan_for(v, exp2((float)power), v->depth_m);
        if (p.texel_m >= 0.5f * min(p.sigma_m[0], p.sigma_m[1]) &&
            p.margin_m <= 0.25f * CAUSTIC_SIZE * p.texel_m)
            break;
    }
    return exp2((float)power);
}

/* ---- all ---- */

static bool has_caustics(const water_setup *s)
{
    const facet_sea_shading *shading = &s->desc->sea_shading;
    return sea_shading_is_complete(shading) && !shading->omits_caustics && water_has_bed(s) &&
           (has_waves(s) || s->model.is_there) && s->light.L[1] > 0.0f &&
           max(max(s->beam[0], s->beam[1]), s->beam[2]) > 0.0f;
}

static void begin(view *v, const water_setup *s)
{
    const facet_sea_bed *bed = &s->sea->desc.bed;
    *v = (view){.s = s};
    v->source = (caustic_source){.waves = &s->sea->waves,
                                 .water = s->water,
                                 .L = s->light.L,
                                 .bed_height = water_bed_height(bed, 0.0, 0.0),
                                 .bed_rise = {water_bed_rise(bed, vec3(1.0f, 0.0f, 0.0f)),
                                              water_bed_rise(bed, vec3(0.0f, 0.0f, 1.0f))},
                                 .model = s->model.is_there ? &s->model : NULL,
                                 .thread_count = s->desc->thread_count,
                                 .allocator = s->desc->allocator};
    float level = sqrt(s->light.L[0] * s->light.L[0] + s->light.L[2] * s->light.L[2]);
    v->axis[0] = level > 1e-4f ? s->light.L[0] / level : 1.0f;
    v->axis[1] = level > 1e-4f ? s->light.L[2] / level : 0.0f;
    find_places(v);
}

facet_result caustic_map_of_image(const water_setup *s, caustic_map *map, facet_error *error)
{
    *map = (caustic_map){.is_there = false};
    if (!has_caustics(s))
        return FACET_OK;
    view v;
    begin(&v, s);
    const caustic_source *source = &v.source;
    double closing = source->bed_rise[0] * -(double)s->sunward[0] +
                     source->bed_rise[1] * -(double)s->sunward[2] + (double)s->sunward[1];
    if (v.count == 0 || closing < 0.1 || !is_worth_it(&v)) /* below this, light travels along the bed */
        return FACET_OK;
    caustic_plan plans[CAUSTIC_LAYERS];
    float texel = finest_texel(&v);
    for (uint32_t l = 0; l < CAUSTIC_LAYERS; l++, texel *= CAUSTIC_WIDER) {
        plans[l] = plan_for(&v, texel, v.depth_m);
        place_layer(&v, &plans[l]);
    }
    return water_caustics_fill(source, v.axis, plans, map, error);
}
