/* water_air.c - see water_sky.h: the air between the eye and the sea. */
#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "water/water_sky.h"

/* Rows from the horizon to the nadir, dense at the horizon (sky_row()); columns from the sun's azimuth to the
 * opposite one, by the sine of half the angle: it takes only a square root, and radiance is smooth in it at
 * both ends. */
enum { ROWS = 64, COLUMNS = 64 };

/* ---- what is lost ---- */

/* Mean of e^(-h / scale) between two heights (km); (1 - e^(-x)) / x is the mean of e^-x over [0, x]. */
static float mean_density(float a_km, float b_km, float scale_km)
{
    float low = min(a_km, b_km), high = max(a_km, b_km);
    return exp(-low / scale_km) * air_path1((high - low) / scale_km, 1.0f);
}

/* Mean density of air and haze relative to sea level. */
static vec2 mean_densities(float a_km, float b_km)
{
    return vec2(mean_density(a_km, b_km, 8.0f), mean_density(a_km, b_km, 1.2f));
}

static vec3 transmittance_over(const water_sky *s, float length_km, float height_km)
{
    vec2 density = mean_densities(s->eye_km, max(height_km, 0.0f));
    vec3 column = vec3(density[0], density[1], 0.0f) * length_km;
    vec3 share[SKY_HALVES];
    for (int half = 0; half < SKY_HALVES; half++)
        share[half] = air_transmittance(s->air[half], column);
    vec3 color = atmosphere_color(s->air[0], share[0]) + atmosphere_color(s->air[1], share[1]);
    return clamp(color / s->white, 0.0f, 1.0f);
}

/* Distances of x / (1 - x) DISTANCE_KM, x from 0 to 1 in equal steps. */
static const float DISTANCE_KM = 20.0f;
enum { LAST_DISTANCE = WATER_SKY_DISTANCES - 1 };

void water_sky_fill_transmittance(water_sky *s)
{
    for (int i = 0; i < WATER_SKY_DISTANCES; i++)
        s->transmittance[i] =
            transmittance_over(s, DISTANCE_KM * (float)i / max((float)(LAST_DISTANCE - i), 1e-6f), 0.0f);
}

static vec3 transmittance_to_sea(const water_sky *s, float length_km)
{
    float x = length_km / (length_km + DISTANCE_KM) * LAST_DISTANCE;
    int i = (int)min(x, LAST_DISTANCE - 1.0f);
    return mix(s->transmittance[i], s->transmittance[i + 1], x - (float)i);
}

/* Over the whole distance to sea level, or to the horizon. */
static vec3 lost_to_sea(const water_sky *s, float mu)
{
    float whole_km = ray_to_ground(s->eye_km, mu);
    if (whole_km < 0.0f)
        whole_km = sqrt(height_square(s->eye_km));
    return max(1.0f - transmittance_over(s, max(whole_km, 1e-4f), 0.0f), 1e-12f);
}

/* ---- what is added ---- */

/* Rows of the eye view below the horizon, over (1 - transmittance). Distance grows towards the horizon faster
 * than rows get denser: between rows radiance is not linear, but this ratio is. */
static void divide_view(const water_sky *s)
{
    for (int i = 0; i < SKY_VIEW_DOWN; i++) {
        float angle = sky_view_zenith_angle(s->eye_km, -(float)i / (SKY_VIEW_DOWN - 1));
        vec3 share = 1.0f / lost_to_sea(s, min(cos(angle), s->horizon_mu));
        for (int a = 0; a < SKY_VIEW_AZIMUTHS; a++) {
            sky_light *l = &s->eye.rows[(SKY_VIEW_UP + i) * SKY_VIEW_AZIMUTHS + a];
            *l = (sky_light){l->rayleigh * share, l->haze * share, l->rest * share};
        }
    }
}

static void fill_rows(void *context, size_t begin, size_t end)
{
    const water_sky *s = context;
    for (size_t i = begin; i < end; i++) {
        float y = mix(s->horizon_mu, -1.0f, sky_rise((float)i / (ROWS - 1)));
        float level = sqrt(max(1.0f - y * y, 0.0f));
        for (int k = 0; k < COLUMNS; k++) {
            double longitude = s->sun_longitude + 2.0 * asin((double)k / (COLUMNS - 1));
            vec3 d = vec3(level * (float)cos(longitude), y, level * (float)sin(longitude));
            s->air_light[i * COLUMNS + (size_t)k] = water_sky_view(s, &s->eye, d, s->horizon_rad + 1e-5f, PI);
        }
    }
}

facet_result water_sky_fill_air(water_sky *s, const facet_allocator *allocator, uint32_t thread_count,
                                facet_error *error)
{
    s->air_light = mem_alloc(allocator, ROWS * COLUMNS, sizeof *s->air_light);
    if (!s->air_light)
        return fail_memory(error, "air", ROWS * COLUMNS * sizeof *s->air_light);
    divide_view(s);
    parallel_for(thread_count, ROWS, 4, fill_rows, s);
    return FACET_OK;
}

vec3 water_sky_air_light(const water_sky *s, vec3 d)
{
    if (!s->air_light)
        return water_sky_prefiltered(s, normalize(vec3(d[0], 0.0f, d[2]) + vec3(1e-9f, 0.0f, 0.0f)), 0.1f);
    float level = (d[0] * d[0] + d[2] * d[2]) * (s->L[0] * s->L[0] + s->L[2] * s->L[2]);
    float cosine = (d[0] * s->L[0] + d[2] * s->L[2]) * inversesqrt(max(level, 1e-30f));
    float x = sqrt(clamp(0.5f - 0.5f * cosine, 0.0f, 1.0f)) * (COLUMNS - 1);
    float y = sky_row((s->horizon_mu - d[1]) / (s->horizon_mu + 1.0f)) * (ROWS - 1);
    int column = (int)x < COLUMNS - 2 ? (int)x : COLUMNS - 2, row = (int)y < ROWS - 2 ? (int)y : ROWS - 2;
    const vec3 *at = s->air_light + row * COLUMNS + column;
    float along = x - (float)column;
    return mix(mix(at[0], at[1], along), mix(at[COLUMNS], at[COLUMNS + 1], along), y - (float)row);
}

/* In-scattering is uniform along a ray, so that it is proportional to (1 - transmittance). */
water_air water_sky_air(const water_sky *s, vec3 d, float distance_m, float height_m)
{
    float km = clamp(distance_m * 0.001f, 0.0f, 1e12f);
    vec3 transmittance =
        height_m > 0.0f ? transmittance_over(s, km, height_m * 0.001f) : transmittance_to_sea(s, km);
    return (water_air){transmittance, water_sky_air_light(s, d) * (1.0f - transmittance)};
}
