/* sky_luts.c - see sky_luts.h: the loops around shade/sky.h. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

#include "ibl/sky_luts.h"

#include "shade/lang/lang_c_load.h"

enum {
    COLUMN_STEPS = 64,
    BOUNCE_STEPS = 12,
    BOUNCE_POLAR = 10, /* directions from zenith to nadir, densest at the horizon: mu = x |x| */
    BOUNCE_AZIMUTH =
        4, /* azimuths in the half circle from the sun, densest there; the other half mirrors it */
    IRRADIANCE_POLAR = 24,
    IRRADIANCE_AZIMUTH = 12,
    IRRADIANCE_STEPS = 32
};

/* Bilinear with texel centers as on a GPU; texels are stride vectors apart. */
static inline vec3 fetch(const vec3 *table, int stride, int width, int height, vec2 place)
{
    float x = place[0] * (float)width - 0.5f;
    float y = place[1] * (float)height - 0.5f;
    x = clamp(x, 0.0f, (float)(width - 1));
    y = clamp(y, 0.0f, (float)(height - 1));
    int x0 = (int)x < width - 2 ? (int)x : width - 2;
    int y0 = (int)y < height - 2 ? (int)y : height - 2;
    float wx = x - (float)x0;
    float wy = y - (float)y0;
    const vec3 *p = table + stride * (y0 * width + x0);
    const vec3 *q = p + stride * width;
    vec3 a = p[0] + (p[stride] - p[0]) * wx;
    vec3 b = q[0] + (q[stride] - q[0]) * wx;
    return a + (b - a) * wy;
}

static inline vec3 sun_column(const sky_luts *t, float height_km, float mu)
{
    return fetch(t->columns, 1, COLUMN_TABLE_WIDTH, COLUMN_TABLE_HEIGHT, column_table_place(height_km, mu));
}

/* Transmittance from the sun to a height, including sun_visibility(). */
static void sky_sun(const sky_luts *t, float height_km, float mu_sun, vec3 out[SKY_HALVES])
{
    vec3 column = sun_column(t, height_km, mu_sun);
    for (int half = 0; half < SKY_HALVES; half++)
        out[half] = table_sun(t->air[half], column, height_km, mu_sun);
}

static AirField fetch_field(const AirField *table, vec2 place)
{
    const int stride = (int)(sizeof *table / sizeof(vec3)), size = BOUNCE_TABLE_SIZE;
    return air_field(
        fetch(&table->mean, stride, size, size, place), fetch(&table->P2, stride, size, size, place),
        fetch(&table->up, stride, size, size, place), fetch(&table->sunward, stride, size, size, place));
}

/* bounces NULL: multiply scattered light is isotropic with radiance 1. */
static void march(const sky_luts *t, AirField *const *bounces, const sky_ray *ray, float length_km, int steps,
                  AirLight out[SKY_HALVES])
{
    out[0] = out[1] = air_light_none();
    for (int i = 0; i < steps; i++) {
        float begin = ray_share((float)i, (float)steps) * length_km;
        float end = ray_share((float)(i + 1), (float)steps) * length_km;
        float middle = 0.5f * (begin + end);
        float height = ray_height(ray->height_km, ray->mu, middle);
        float mu_sun = ray_mu_sun(ray->height_km, middle, ray->mu_sun, ray->cos_angle, height);
        float mu = ray_mu(ray->height_km, ray->mu, middle, height);
        float sunward = sunward_part(mu, mu_sun, ray->cos_angle);
        vec3 density = air_density(height);
        vec2 place = bounce_table_place(height, mu_sun);
        vec3 sun[SKY_HALVES];
        sky_sun(t, height, mu_sun, sun);
        for (int half = 0; half < SKY_HALVES; half++) {
            AirField field = bounces ? fetch_field(bounces[half], place) : air_field_even(vec3(1.0f));
            out[half] =
                air_light_step(t->air[half], out[half], density, end - begin, sun[half], field, mu, sunward);
        }
    }
}

void sky_march(const sky_luts *t, const sky_ray *ray, float length_km, int steps, AirLight out[SKY_HALVES])
{
    march(t, t->bounces, ray, length_km, steps, out);
}

/* ---- filling ---- */

static void fill_columns(void *context, size_t begin, size_t end)
{
    const sky_luts *t = context;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < COLUMN_TABLE_WIDTH; x++) {
            vec2 ray = column_table_ray(vec2(((float)x + 0.5f) / (float)COLUMN_TABLE_WIDTH,
                                             ((float)y + 0.5f) / (float)COLUMN_TABLE_HEIGHT));
            t->columns[y * COLUMN_TABLE_WIDTH + (size_t)x] = air_column(ray[0], ray[1], COLUMN_STEPS);
        }
}

/* A ray from a height; polar angle and azimuth from the sun are given by their cosines. */
static sky_ray make_ray(float height_km, float mu, float mu_sun, float cos_azimuth)
{
    float across = sqrt(max(1.0f - mu * mu, 0.0f) * max(1.0f - mu_sun * mu_sun, 0.0f));
    return (sky_ray){height_km, mu, mu_sun, clamp(mu * mu_sun + across * cos_azimuth, -1.0f, 1.0f)};
}

/* Irradiance of the ground by the sky for the sun of column x of the bounce LUT: single scattering plus an
 * estimate of the rest, within a tenth of the total. */
static void fill_sky(sky_luts *t, int x)
{
    const float scattered_again = 0.4f;
    float mu_sun = bounce_table_ray(vec2(((float)x + 0.5f) / (float)BOUNCE_TABLE_SIZE, 0.0f))[1];
    t->skies[0][x] = t->skies[1][x] = vec3(0.0f);
    for (int p = 0; p < BOUNCE_POLAR; p++)
        for (int a = 0; a < BOUNCE_AZIMUTH; a++) {
            AirLight light[SKY_HALVES];
            float mu = sqrt(((float)p + 0.5f) / (float)BOUNCE_POLAR);
            float y = ((float)a + 0.5f) / (float)BOUNCE_AZIMUTH;
            sky_ray ray = make_ray(0.0f, mu, mu_sun, cos(PI * y * y));
            march(t, NULL, &ray, ray_to_top(0.0f, mu), BOUNCE_STEPS, light);
            for (int half = 0; half < SKY_HALVES; half++) {
                light[half].multiple = vec3(0.0f);
                t->skies[half][x] +=
                    air_radiance(t->air[half], light[half], ray.cos_angle) * y *
                    (2.0f * PI * (1.0f + scattered_again) / (float)(BOUNCE_POLAR * BOUNCE_AZIMUTH));
            }
        }
}

static void light_ground(const sky_luts *t, float mu_sun, vec3 out[SKY_HALVES])
{
    float x = bounce_table_place(0.0f, mu_sun)[0] * (float)BOUNCE_TABLE_SIZE - 0.5f;
    int first = (int)x < BOUNCE_TABLE_SIZE - 2 ? (int)x : BOUNCE_TABLE_SIZE - 2;
    sky_sun(t, 0.0f, mu_sun, out);
    for (int half = 0; half < SKY_HALVES; half++) {
        const vec3 *sky = t->skies[half] + first;
        out[half] = out[half] * max(mu_sun, 0.0f) + mix(sky[0], sky[1], x - (float)first);
    }
}

static void add_bounce(const sky_luts *t, const sky_ray *ray, float share, AirBounce sums[SKY_HALVES])
{
    AirLight light[SKY_HALVES];
    vec3 ground[SKY_HALVES] = {vec3(0.0f), vec3(0.0f)};
    float to_ground = ray_to_ground(ray->height_km, ray->mu);
    float length_km = to_ground >= 0.0f ? to_ground : ray_to_top(ray->height_km, ray->mu);
    float sunward = sunward_part(ray->mu, ray->mu_sun, ray->cos_angle);
    march(t, NULL, ray, length_km, BOUNCE_STEPS, light);
    if (to_ground >= 0.0f)
        light_ground(t, ray_mu_sun(ray->height_km, length_km, ray->mu_sun, ray->cos_angle, 0.0f), ground);
    for (int half = 0; half < SKY_HALVES; half++)
        sums[half] = air_bounce_add(t->air[half], sums[half], light[half], ray->mu, sunward, ray->cos_angle,
                                    ground[half], share);
}

static void fill_bounces(void *context, size_t begin, size_t end)
{
    const sky_luts *t = context;
    for (size_t i = begin; i < end; i++) {
        vec2 place =
            bounce_table_ray(vec2(((float)(i % BOUNCE_TABLE_SIZE) + 0.5f) / (float)BOUNCE_TABLE_SIZE,
                                  ((float)(i / BOUNCE_TABLE_SIZE) + 0.5f) / (float)BOUNCE_TABLE_SIZE));
        AirBounce sums[SKY_HALVES] = {air_bounce_none(), air_bounce_none()};
        for (int p = 0; p < BOUNCE_POLAR; p++)
            for (int a = 0; a < BOUNCE_AZIMUTH; a++) {
                float x = 1.0f - 2.0f * ((float)p + 0.5f) / (float)BOUNCE_POLAR;
                float y = ((float)a + 0.5f) / (float)BOUNCE_AZIMUTH;
                float share = abs(x) * y * (4.0f / (float)(BOUNCE_POLAR * BOUNCE_AZIMUTH));
                sky_ray ray = make_ray(place[0], x * abs(x), place[1], cos(PI * y * y));
                add_bounce(t, &ray, share, sums);
            }
        for (int half = 0; half < SKY_HALVES; half++)
            t->bounces[half][i] = air_bounce_field(sums[half]);
    }
}

facet_result sky_luts_create(const Atmosphere air[SKY_HALVES], const facet_allocator *allocator,
                             uint32_t thread_count, sky_luts *out, facet_error *error)
{
    const size_t column_count = (size_t)COLUMN_TABLE_WIDTH * COLUMN_TABLE_HEIGHT;
    const size_t bounce_count = (size_t)BOUNCE_TABLE_SIZE * BOUNCE_TABLE_SIZE;
    *out = (sky_luts){.air = {air[0], air[1]},
                      .columns = mem_alloc(allocator, column_count, sizeof *out->columns),
                      .bounces = {mem_alloc(allocator, SKY_HALVES * bounce_count, sizeof(AirField))}};
    if (!out->columns || !out->bounces[0]) {
        sky_luts_destroy(out);
        return fail_memory(error, "sky", column_count * sizeof(vec3) + 2 * bounce_count * sizeof(AirField));
    }
    out->bounces[1] = out->bounces[0] + bounce_count;
    parallel_for(thread_count, COLUMN_TABLE_HEIGHT, 4, fill_columns, out);
    for (int x = 0; x < BOUNCE_TABLE_SIZE; x++)
        fill_sky(out, x);
    parallel_for(thread_count, bounce_count, 16, fill_bounces, out);
    return FACET_OK;
}

void sky_luts_destroy(sky_luts *t)
{
    mem_free(t->columns);
    mem_free(t->bounces[0]);
    *t = (sky_luts){.columns = NULL};
}

/* ---- queries ---- */

void sky_atmosphere(float turbidity, const float ground_albedo[3], Atmosphere air[SKY_HALVES])
{
    static const float angstrom = 0.6f, scattering_albedo = 0.98f, g = 0.76f; /* atmosphere_earth()'s */
    for (int half = 0; half < SKY_HALVES; half++) {
        Atmosphere a = atmosphere_earth(half == 0 ? SKY_BANDS_FIRST : SKY_BANDS_SECOND);
        a = atmosphere_with_haze(a, haze_depth_from_turbidity(turbidity), angstrom, scattering_albedo, g);
        a.ground_albedo = load3(ground_albedo);
        air[half] = a;
    }
}

/* E = integral of L mu d_omega; with w = mu^2 it is half that of L over w and azimuth. */
void sky_irradiance(const sky_luts *t, float mu_sun, vec3 out[SKY_HALVES])
{
    out[0] = out[1] = vec3(0.0f);
    for (int p = 0; p < IRRADIANCE_POLAR; p++)
        for (int a = 0; a < IRRADIANCE_AZIMUTH; a++) {
            AirLight light[SKY_HALVES];
            float mu = sqrt(((float)p + 0.5f) / (float)IRRADIANCE_POLAR);
            float azimuth = PI * ((float)a + 0.5f) / (float)IRRADIANCE_AZIMUTH;
            sky_ray ray = make_ray(0.0f, mu, mu_sun, cos(azimuth));
            sky_march(t, &ray, ray_to_top(0.0f, mu), IRRADIANCE_STEPS, light);
            for (int half = 0; half < SKY_HALVES; half++)
                out[half] = out[half] + air_radiance(t->air[half], light[half], ray.cos_angle) *
                                            (PI / (float)(IRRADIANCE_POLAR * IRRADIANCE_AZIMUTH));
        }
}

/* ---- the view from a point: its ground ---- */

enum { VIEW_STEPS = 48, GROUND_NODES = 17 };

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

static void fill_ground(void *context, size_t begin, size_t end)
{
    view_job *job = context;
    ground_light *g = &job->ground;
    for (size_t i = begin; i < end; i++)
        sky_irradiance(job->tables, cosf(g->first + g->step * (float)i), g->sky[i]);
}

static void light_view_ground(view_job *job, uint32_t thread_count)
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

/* ---- the view: rows ---- */

static sky_light light_along(const view_job *job, const sky_ray *ray, bool is_ground)
{
    const sky_luts *t = job->tables;
    AirLight light[SKY_HALVES];
    float to_ground = ray_to_ground(ray->height_km, ray->mu);
    to_ground = to_ground < 0.0f ? sqrtf(height_square(ray->height_km))
                                 : to_ground; /* the ray just misses the horizon */
    float length_km = is_ground ? to_ground : ray_to_top(ray->height_km, ray->mu);
    sky_march(t, ray, length_km, length_km > 1e-6f ? VIEW_STEPS : 0, light);
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
    light_view_ground(&job, thread_count);
    parallel_for(thread_count, SKY_VIEW_UP + SKY_VIEW_DOWN, 4, fill_rows, &job);
    return FACET_OK;
}

void sky_view_destroy(sky_view *v)
{
    mem_free(v->rows);
    *v = (sky_view){.rows = NULL};
}

/* ---- the view: lookup ---- */

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
