/* sky_sun.c - see sky_sun.h. The disc is cut into parts of equal size along a spiral (Vogel 1979), which meets every grid evenly, and
 * its mirror image, so that both halves of the disc are the same. */
#include <math.h>

#include "ibl/equirect.h"
#include "ibl/sky_sun.h"

enum { PARTS = 16384, COLUMN_STEPS = 400 };
static const double limb_darkening = 0.6; /* in green; Cox 2000 */

static float node_elevation(float middle, int node)
{
    return middle + SUN_RADIUS * (2.0f * (float)node / (SKY_SUN_NODES - 1) - 1.0f);
}

sky_sun_light sky_sun_through_air(const Atmosphere air[SKY_HALVES], float height_km, float elevation_rad,
                                  float azimuth_rad)
{
    float horizon = horizon_mu(height_km);
    sky_sun_light sun = {elevation_rad, azimuth_rad, .horizon_rad = asinf(horizon)};
    for (int i = 0; i < SKY_SUN_NODES; i++) {
        float mu = max(sinf(node_elevation(elevation_rad, i)), horizon);
        vec3 column = air_column(height_km, mu, COLUMN_STEPS);
        sun.nodes[i] = atmosphere_color(air[0], air_transmittance(air[0], column)) +
                       atmosphere_color(air[1], air_transmittance(air[1], column));
    }
    return sun;
}

sky_sun_light sky_sun_preetham(float turbidity, float elevation_rad, float azimuth_rad)
{
    sky_sun_light sun = {elevation_rad, azimuth_rad, .horizon_rad = 0.0f};
    Atmosphere air[SKY_HALVES] = {atmosphere_earth(SKY_BANDS_FIRST), atmosphere_earth(SKY_BANDS_SECOND)};
    for (int i = 0; i < SKY_SUN_NODES; i++) {
        float zenith = clamp(0.5f * PI - node_elevation(elevation_rad, i), 0.0f, 0.5f * PI);
        sun.nodes[i] = atmosphere_color(air[0], preetham_sun(air[0], turbidity, zenith)) +
                       atmosphere_color(air[1], preetham_sun(air[1], turbidity, zenith));
    }
    return sun;
}

/* One part of the disc: where it is seen, and its share of the illuminance. */
typedef struct disc_part {
    double direction[3];
    vec3 illuminance;
} disc_part;

/* The disc's middle and two directions across it, upwards and to the side. */
typedef struct disc_frame {
    double middle[3], up[3], side[3];
} disc_frame;

static disc_frame make_frame(const sky_sun_light *sun)
{
    double se = (sin)((double)sun->elevation_rad), ce = (cos)((double)sun->elevation_rad);
    double sa = (sin)((double)sun->azimuth_rad), ca = (cos)((double)sun->azimuth_rad);
    return (disc_frame){{sa * ce, se, ca * ce}, {-sa * se, ce, -ca * se}, {ca, 0.0, -sa}};
}

/* Part number part of count. The mean over the disc of what darkens its limb is 1 - u / 3. */
static disc_part make_part(const sky_sun_light *sun, const disc_frame *frame, int part, int count)
{
    const double golden_angle = 2.399963229728653;
    double r = (sqrt)((part / 2 + 0.5) / (count / 2));
    double turn = golden_angle * (part / 2) * (part % 2 ? 1.0 : -1.0);
    double angle = r * (double)SUN_RADIUS;
    double up = (sin)(angle) * (cos)(turn), side = (sin)(angle) * (sin)(turn);
    double limb = (1.0 - limb_darkening * (1.0 - (sqrt)(1.0 - r * r))) / (1.0 - limb_darkening / 3.0);
    disc_part out;
    for (int i = 0; i < 3; i++)
        out.direction[i] = frame->middle[i] * (cos)(angle) + frame->up[i] * up + frame->side[i] * side;
    float elevation = (float)(asin)(fmax(-1.0, fmin(1.0, out.direction[1])));
    float x = (elevation - sun->elevation_rad) / SUN_RADIUS * 0.5f + 0.5f;
    x = clamp(x, 0.0f, 1.0f) * (SKY_SUN_NODES - 1);
    int node = (int)x < SKY_SUN_NODES - 2 ? (int)x : SKY_SUN_NODES - 2;
    vec3 light = mix(sun->nodes[node], sun->nodes[node + 1], x - (float)node);
    float share = elevation < sun->horizon_rad ? 0.0f : (float)(limb / count);
    out.illuminance = max(light, 0.0f) * share;
    return out;
}

vec3 sky_sun_illuminance(const sky_sun_light *sun)
{
    disc_frame frame = make_frame(sun);
    double sum[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < PARTS; k++) {
        disc_part part = make_part(sun, &frame, k, PARTS);
        for (int i = 0; i < 3; i++)
            sum[i] += (double)part.illuminance[i];
    }
    return vec3((float)sum[0], (float)sum[1], (float)sum[2]);
}

void sky_sun_draw(const sky_sun_light *sun, image *picture)
{
    disc_frame frame = make_frame(sun);
    uint32_t width = picture->width, height = picture->height;
    int finer = 1 + (int)(height / 2048);
    int count = PARTS * finer * finer; /* hundreds of parts per texel */
    for (int k = 0; k < count; k++) {
        disc_part part = make_part(sun, &frame, k, count);
        const double *d = part.direction;
        double u = 0.5 + (atan2)(d[2], d[0]) * 0.15915494309189535;
        double v = (acos)(fmax(-1.0, fmin(1.0, d[1]))) * 0.3183098861837907;
        uint32_t x = (uint32_t)fmin(fmax(u * width, 0.0), width - 1.0);
        uint32_t y = (uint32_t)fmin(v * height, height - 1.0);
        float per_sr = (float)(1.0 / equirect_texel_solid_angle(width, height, y));
        float *texel = (float *)picture->pixels + 3 * ((size_t)y * width + x);
        for (int i = 0; i < 3; i++)
            texel[i] += part.illuminance[i] * per_sr;
    }
}
