/* sky_view.c - see sky_view.h. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

#include "ibl/sky_view.h"

enum { STEPS = 48, GROUND_NODES = 17 };

/* Irradiance of the ground by the sky for the sun's zenith angles within view. */
typedef struct ground_light {
    float first, step; /* rad */
    vec3 sky[GROUND_NODES][SKY_HALVES];
    int count;
} ground_light;

typedef struct view_job {
    const sky_luts *tables;
    const sky_view *view;
    ground_light ground;
} view_job;

/* ---- ground ---- */

static void fill_ground(void *context, size_t begin, size_t end)
{
    view_job *job = context;
    ground_light *g = &job->ground;
    for (size_t i = begin; i < end; i++)
        sky_irradiance(job->tables, cosf(g->first + g->step * (float)i), g->sky[i]);
}

static void light_ground(view_job *job, uint32_t thread_count)
{
    ground_light *g = &job->ground;
    float reach = acosf(EARTH_RADIUS_KM / (EARTH_RADIUS_KM + job->view->height_km));
    float zenith = acosf(job->view->mu_sun);
    bool is_one = reach < 1e-4f; /* all visible ground has the same sun */
    g->first = is_one ? zenith : max(zenith - reach, 0.0f);
    g->count = is_one ? 1 : GROUND_NODES;
    g->step = is_one ? 1.0f : (min(zenith + reach, PI) - g->first) / (float)(GROUND_NODES - 1);
    parallel_for(thread_count, (size_t)g->count, 1, fill_ground, job);
}

/* Radiance of the ground where the sun has mu_sun, per half. */
static void ground_radiance(const sky_luts *t, const ground_light *g, float mu_sun, vec3 out[SKY_HALVES])
{
    float x = clamp((acosf(mu_sun) - g->first) / g->step, 0.0f, (float)(g->count - 1));
    int node = (int)x < g->count - 2 ? (int)x : g->count - 2;
    node = node > 0 ? node : 0;
    int next = g->count > 1 ? node + 1 : node;
    vec3 sun[SKY_HALVES];
    sky_sun(t, 0.0f, mu_sun, sun);
    for (int half = 0; half < SKY_HALVES; half++) {
        vec3 sky = mix(g->sky[node][half], g->sky[next][half], x - (float)node);
        out[half] = (sun[half] * max(mu_sun, 0.0f) + sky) * t->air[half].ground_albedo * INV_PI;
    }
}

/* ---- rows ---- */

static sky_light light_along(const view_job *job, const sky_ray *ray, bool is_ground)
{
    const sky_luts *t = job->tables;
    AirLight light[SKY_HALVES];
    float to_ground = ray_to_ground(ray->height_km, ray->mu);
    to_ground = to_ground < 0.0f ? sqrtf(height_square(ray->height_km))
                                 : to_ground; /* the ray just misses the horizon */
    float length_km = is_ground ? to_ground : ray_to_top(ray->height_km, ray->mu);
    sky_march(t, ray, length_km, length_km > 1e-6f ? STEPS : 0, light);
    vec3 ground[SKY_HALVES] = {vec3(0.0f), vec3(0.0f)};
    if (is_ground)
        ground_radiance(t, &job->ground,
                        ray_mu_sun(ray->height_km, length_km, ray->mu_sun, ray->cos_angle, 0.0f), ground);
    vec3 rayleigh[SKY_HALVES], haze[SKY_HALVES], rest[SKY_HALVES];
    for (int half = 0; half < SKY_HALVES; half++) {
        rayleigh[half] = light[half].rayleigh;
        haze[half] = light[half].haze;
        rest[half] = light[half].multiple + light[half].transmittance * ground[half];
    }
    return (sky_light){sky_color(t, rayleigh), sky_color(t, haze), sky_color(t, rest)};
}

static void fill_rows(void *context, size_t begin, size_t end)
{
    const view_job *job = context;
    const sky_view *v = job->view;
    float horizon = acosf(horizon_mu(v->height_km));
    for (size_t i = begin; i < end; i++) {
        bool is_ground = i >= SKY_VIEW_UP;
        float row =
            is_ground ? -(float)(i - SKY_VIEW_UP) / (SKY_VIEW_DOWN - 1) : (float)i / (SKY_VIEW_UP - 1);
        float angle = sky_view_zenith_angle(v->height_km, row);
        float mu = cosf(is_ground ? max(angle, horizon) : angle);
        float across = sqrtf(max(1.0f - mu * mu, 0.0f) * max(1.0f - v->mu_sun * v->mu_sun, 0.0f));
        for (int a = 0; a < SKY_VIEW_AZIMUTHS; a++) {
            float cos_azimuth = cosf(PI * (float)a / (SKY_VIEW_AZIMUTHS - 1));
            sky_ray ray = {v->height_km, mu, v->mu_sun,
                           clamp(mu * v->mu_sun + across * cos_azimuth, -1.0f, 1.0f)};
            v->rows[i * SKY_VIEW_AZIMUTHS + (size_t)a] = light_along(job, &ray, is_ground);
        }
    }
}

facet_result sky_view_create(const sky_luts *tables, float altitude_km, float sun_elevation_rad,
                             const facet_allocator *allocator, uint32_t thread_count, sky_view *out,
                             facet_error *error)
{
    const size_t count = (size_t)(SKY_VIEW_UP + SKY_VIEW_DOWN) * SKY_VIEW_AZIMUTHS;
    *out = (sky_view){.height_km = altitude_km,
                      .mu_sun = sinf(sun_elevation_rad),
                      .haze_g = tables->air[0].haze_g,
                      .rows = mem_alloc(allocator, count, sizeof *out->rows)};
    if (!out->rows)
        return fail_memory(error, "sky", count * sizeof *out->rows);
    view_job job = {.tables = tables, .view = out};
    light_ground(&job, thread_count);
    parallel_for(thread_count, SKY_VIEW_UP + SKY_VIEW_DOWN, 4, fill_rows, &job);
    return FACET_OK;
}

void sky_view_destroy(sky_view *v)
{
    mem_free(v->rows);
    *v = (sky_view){.rows = NULL};
}

/* ---- lookup ---- */

/* Weights of nodes -1, 0, 1, 2 at x in [0, 1]. Catmull and Rom 1974. */
static void cubic_weights(float x, float weights[4])
{
    weights[0] = x * (-0.5f + x * (1.0f - 0.5f * x));
    weights[1] = 1.0f + x * x * (-2.5f + 1.5f * x);
    weights[2] = x * (0.5f + x * (2.0f - 1.5f * x));
    weights[3] = x * x * (-0.5f + 0.5f * x);
}

/* Four rows and their weights. */
typedef struct row_place {
    const sky_light *rows[4];
    float weights[4];
} row_place;

static row_place find_rows(const sky_view *v, float zenith_angle)
{
    row_place place;
    float row = sky_view_row(v->height_km, zenith_angle);
    int count = row >= 0.0f ? SKY_VIEW_UP : SKY_VIEW_DOWN;
    const sky_light *rows = row >= 0.0f ? v->rows : v->rows + (size_t)SKY_VIEW_UP * SKY_VIEW_AZIMUTHS;
    float x = fabsf(row) * (float)(count - 1);
    int first = (int)x < count - 2 ? (int)x : count - 2;
    cubic_weights(x - (float)first, place.weights);
    for (int k = 0; k < 4; k++) {
        int node = first - 1 + k;
        node = node < 0 ? 0 : node > count - 1 ? count - 1 : node;
        place.rows[k] = rows + (size_t)node * SKY_VIEW_AZIMUTHS;
    }
    return place;
}

static inline void add_light(sky_light *sum, const sky_light *l, float weight)
{
    sum->rayleigh += l->rayleigh * weight;
    sum->haze += l->haze * weight;
    sum->rest += l->rest * weight;
}

void sky_view_fetch_row(const sky_view *v, float zenith_angle, sky_light out[SKY_VIEW_AZIMUTHS])
{
    row_place place = find_rows(v, zenith_angle);
    for (int a = 0; a < SKY_VIEW_AZIMUTHS; a++) {
        sky_light sum = {vec3(0.0f), vec3(0.0f), vec3(0.0f)};
        for (int k = 0; k < 4; k++)
            add_light(&sum, place.rows[k] + a, place.weights[k]);
        out[a] = sum;
    }
}

sky_azimuth sky_view_azimuth(double radians)
{
    const double turn = 6.283185307179586;
    double a = fabs((remainder)(radians, turn)); /* [0, pi] */
    float x = (float)(a / (0.5 * turn) * (SKY_VIEW_AZIMUTHS - 1));
    int first = (int)x < SKY_VIEW_AZIMUTHS - 2 ? (int)x : SKY_VIEW_AZIMUTHS - 2;
    sky_azimuth out = {.cosine = cosf((float)a)};
    cubic_weights(x - (float)first, out.weights);
    for (int k = 0; k < 4; k++) { /* the other half is the mirror image */
        int node = first - 1 + k < 0 ? 1 : first - 1 + k;
        out.nodes[k] = node < SKY_VIEW_AZIMUTHS ? node : 2 * (SKY_VIEW_AZIMUTHS - 1) - node;
    }
    return out;
}

static vec3 with_phases(const sky_view *v, const sky_light *l, float cos_angle)
{
    return max(l->rayleigh * phase_rayleigh(cos_angle) + l->haze * phase_HG(cos_angle, v->haze_g) + l->rest,
               0.0f);
}

vec3 sky_view_radiance(const sky_view *v, const sky_light row[SKY_VIEW_AZIMUTHS], const sky_azimuth *azimuth,
                       float cos_angle)
{
    sky_light sum = {vec3(0.0f), vec3(0.0f), vec3(0.0f)};
    for (int k = 0; k < 4; k++)
        add_light(&sum, row + azimuth->nodes[k], azimuth->weights[k]);
    return with_phases(v, &sum, cos_angle);
}

vec3 sky_view_at(const sky_view *v, float zenith_angle, const sky_azimuth *azimuth, float cos_angle)
{
    row_place place = find_rows(v, zenith_angle);
    sky_light sum = {vec3(0.0f), vec3(0.0f), vec3(0.0f)};
    for (int a = 0; a < 4; a++)
        for (int k = 0; k < 4; k++)
            add_light(&sum, place.rows[k] + azimuth->nodes[a], place.weights[k] * azimuth->weights[a]);
    return with_phases(v, &sum, cos_angle);
}
