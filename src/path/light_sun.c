/* light_sun.c - see light_sun.h. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "path/light_sun.h"

static const double DEFAULT_DIAMETER_RAD = 0.53 * 3.14159265358979323846 / 180.0;
static const double LEAST_RADIUS_RAD = 5e-5;

static bool is_light(const float channels[3])
{
    bool is_any = false;
    for (int i = 0; i < 3; i++) {
        if (!isfinite(channels[i]) || channels[i] > 1e20f)
            return false;
        is_any |= channels[i] > 0.0f;
    }
    return is_any;
}

light_sun light_sun_create(const facet_sun *desc)
{
    light_sun sun = {.pdf = 0.0f};
    if (!is_light(desc->illuminance_lux) || !isfinite(desc->azimuth_rad) || !isfinite(desc->elevation_rad) ||
        isnan(desc->diameter_rad))
        return sun;
    double radius = 0.5 * (desc->diameter_rad > 0.0f ? (double)desc->diameter_rad : DEFAULT_DIAMETER_RAD);
    double half_pi = 0.5 * 3.14159265358979323846;
    radius = radius < LEAST_RADIUS_RAD ? LEAST_RADIUS_RAD : radius > half_pi ? half_pi : radius;
    double azimuth = (double)desc->azimuth_rad;
    double elevation = (double)desc->elevation_rad;
    double half_sine = (sin)(0.5 * radius);
    double sine = (sin)(radius);
    sun.direction = vec3((float)((cos)(elevation) * (sin)(azimuth)), (float)(sin)(elevation),
                         (float)((cos)(elevation) * (cos)(azimuth)));
    for (int i = 0; i < 3; i++)
        sun.illuminance[i] = max(desc->illuminance_lux[i], 0.0f);
    /* The projected solid angle of a disc around the normal is pi sin^2(radius). */
    sun.radiance = sun.illuminance * (float)(1.0 / (3.14159265358979323846 * sine * sine));
    sun.sin_radius = (float)sine;
    sun.height = (float)(2.0 * half_sine * half_sine);
    sun.chord2 = (float)(4.0 * half_sine * half_sine);
    sun.pdf = (float)(1.0 / (2.0 * 3.14159265358979323846 * 2.0 * half_sine * half_sine));
    return sun;
}

float light_sun_irradiance(const light_sun *sun, vec3 N)
{
    float all = (sun->illuminance[0] + sun->illuminance[1] + sun->illuminance[2]) * (1.0f / 3.0f);
    if (!(dot(N, N) > 0.0f))
        return all;
    float x = dot(N, sun->direction);
    return all * max(max(x, 0.5f * (x + sun->sin_radius)), 0.0f);
}

vec3 light_sun_sample(const light_sun *sun, vec2 u)
{
    float height = sun->height * u[0];
    float r = sqrt(height * (2.0f - height)); /* sin^2 = 1 - (1 - height)^2 */
    float phi = 2.0f * PI * u[1];
    return normalize(mul(basis_from_normal(sun->direction), vec3(r * cos(phi), r * sin(phi), 1.0f - height)));
}
