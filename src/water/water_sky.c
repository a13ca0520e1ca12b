/* water_sky.c - see water_sky.h. */
#include "base/memory.h"

#include <math.h>
#include <string.h>

#include "base/result.h"
#include "ibl/environment.h"
#include "ibl/equirect.h"
#include "ibl/sky_image.h"
#include "water/water_sky.h"

enum { IMAGE_HEIGHT = 256 };

/* Clear air over a sea, haze of optical depth 0.06, and the albedo of a sea. */
static const float MARITIME_TURBIDITY = 1.55f, SEA_ALBEDO = 0.06f;
static const float MIN_EYE_KM = 0.001f; /* below this, a LUT of floats resolves no difference */
static const float MAX_EYE_KM = 50.0f;  /* as for facet_sky_desc.altitude_m */
/* Up to this height the eye's sky is that of the sea, except for the horizon. */
static const float SAME_VIEW_KM = 0.05f;

static inline float luminance_of(vec3 c)
{
    return 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
}

/* ---- the sun ---- */

static void place_sun(water_sky *s, float elevation_rad, float azimuth_rad)
{
    double e = (double)elevation_rad, a = (double)azimuth_rad;
    s->L = vec3((float)(cos(e) * sin(a)), (float)sin(e), (float)(cos(e) * cos(a)));
    s->sun_longitude = 1.5707963267948966 - a;
}

/* facet_sun with an image as environment: a disc of uniform radiance. */
static void take_sun(water_sky *s, const facet_sun *sun)
{
    float radius = sun->diameter_rad > 0.0f ? 0.5f * sun->diameter_rad : SUN_RADIUS;
    place_sun(s, sun->elevation_rad, sun->azimuth_rad);
    for (int i = 0; i < 3; i++)
        s->sun_irradiance[i] = s->L[1] > 0.0f ? max(sun->illuminance_lux[i], 0.0f) : 0.0f;
    if (luminance_of(s->sun_irradiance) > 0.0f) {
        s->disc_radius = min(radius, 0.5f * PI);
        float sine = sin(s->disc_radius);
        s->disc_radiance = s->sun_irradiance * (INV_PI / (sine * sine));
    }
}

/* ---- the atmosphere ---- */

static facet_result check(const facet_sky_desc *sky, float eye_height_m, facet_error *error)
{
    static const float right_angle = 1.57079637f;
    if (!(fabsf(sky->sun_elevation_rad) <= right_angle) || !isfinite(sky->sun_azimuth_rad))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "sky: the sun is %g degrees above the horizon; -90 to 90 are",
                    (double)sky->sun_elevation_rad * 57.29577951308232);
    if (sky->turbidity != 0.0f && !(sky->turbidity >= 1.0f && sky->turbidity <= 10.0f))
        return fail(error, FACET_ERROR_ARGUMENT, "sky: the turbidity is %g; 1 to 10 are possible",
                    (double)sky->turbidity);
    for (int i = 0; i < 3; i++)
        if (!(sky->ground_albedo[i] >= 0.0f && sky->ground_albedo[i] <= 1.0f))
            return fail(error, FACET_ERROR_ARGUMENT,
                        "sky: the albedo of the ground is %g; 0 to 1 are possible",
                        (double)sky->ground_albedo[i]);
    if (!(sky->illuminance_lux >= 0.0f) || !isfinite(sky->illuminance_lux))
        return fail(error, FACET_ERROR_ARGUMENT, "sky: the illuminance is %g lx; 0 or more is possible",
                    (double)sky->illuminance_lux);
    if (sky->model != FACET_SKY_MODEL_PREETHAM && eye_height_m > 1000.0f * MAX_EYE_KM)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "sky: the eye is %g km high; %g are possible, as the air is not seen from outside",
                    (double)eye_height_m * 0.001, (double)MAX_EYE_KM);
    return FACET_OK;
}

static void choose_air(const facet_sky_desc *sky, Atmosphere air[SKY_HALVES])
{
    const float *given = sky->ground_albedo;
    bool is_black = given[0] == 0.0f && given[1] == 0.0f && given[2] == 0.0f;
    const float sea[3] = {SEA_ALBEDO, SEA_ALBEDO, SEA_ALBEDO};
    sky_atmosphere(sky->turbidity != 0.0f ? sky->turbidity : MARITIME_TURBIDITY, is_black ? sea : given, air);
}

static void fill_air(const facet_sky_desc *sky, water_sky *s)
{
    choose_air(sky, s->air);
    s->white = atmosphere_color(s->air[0], vec3(1.0f)) + atmosphere_color(s->air[1], vec3(1.0f));
}

/* The same air over black ground: a view below the horizon is in-scattering alone. */
static sky_luts over_black(const sky_luts *t)
{
    sky_luts dark = *t;
    dark.air[0].ground_albedo = dark.air[1].ground_albedo = vec3(0.0f);
    return dark;
}

static facet_result make_views(const facet_render_desc *desc, water_sky *s, facet_error *error)
{
    const facet_render_desc *r = desc;
    float elevation = desc->sky.sun_elevation_rad;
    sky_luts dark = over_black(&s->tables);
    facet_result result =
        sky_view_create(&dark, s->eye_km, elevation, &r->allocator, r->thread_count, &s->eye, error);
    if (result == FACET_OK && s->eye_km > SAME_VIEW_KM)
        result = sky_view_create(&dark, 0.0f, elevation, &r->allocator, r->thread_count, &s->low, error);
    return result;
}

static void light_by_air(const facet_sky_desc *sky, water_sky *s)
{
    vec3 share[SKY_HALVES];
    sky_sun_light sun = sky_sun_through_air(s->air, 0.0f, sky->sun_elevation_rad, sky->sun_azimuth_rad);
    s->sun_irradiance = max(sky_sun_illuminance(&sun), 0.0f);
    sky_irradiance(&s->tables, s->L[1], share);
    s->sky_irradiance = max(sky_color(&s->tables, share), 0.0f);
}

/* ---- images ---- */

static facet_result make_environment(const facet_allocator *allocator, uint32_t width, uint32_t height,
                                     facet_environment **out, facet_error *error)
{
    const facet_environment_desc desc = {.allocator = *allocator};
    facet_result result = environment_create(&desc, out, error);
    if (result == FACET_OK)
        result = image_create(allocator, width, height, 3, IMAGE_F32, &(*out)->panorama, error);
    return result;
}

static void mirror_at_horizon(image *panorama)
{
    size_t row = (size_t)panorama->width * 3;
    float *pixels = panorama->pixels;
    for (uint32_t y = (panorama->height + 1) / 2; y < panorama->height; y++)
        memcpy(pixels + y * row, pixels + (panorama->height - 1 - y) * row, row * sizeof *pixels);
}

/* Prefilters the environment, whose pixels are filled already. */
static facet_result prepare_reflections(const facet_render_desc *desc, water_sky *s, facet_error *error)
{
    mirror_at_horizon(&s->mirrored->panorama);
    environment_limit(s->mirrored, desc->thread_count);
    const ibl_light_desc light = {.thread_count = desc->thread_count,
                                  .needs_irradiance = true,
                                  .needs_specular = true,
                                  .max_roughness = 1.0f};
    return ibl_light_prepare(s->mirrored, &light, &s->reflected, error);
}

static facet_result use_views(const facet_render_desc *desc, water_sky *s, facet_error *error)
{
    const facet_render_desc *r = desc;
    facet_result result = make_views(desc, s, error);
    if (result == FACET_OK)
        result = make_environment(&r->allocator, 2 * IMAGE_HEIGHT, IMAGE_HEIGHT, &s->mirrored, error);
    if (result == FACET_OK)
        result = sky_image_atmosphere(water_sky_low(s), desc->sky.sun_azimuth_rad, &r->allocator,
                                      r->thread_count, &s->mirrored->panorama, error);
    if (result == FACET_OK)
        result = prepare_reflections(desc, s, error);
    if (result == FACET_OK && !desc->sky.omits_disc && s->L[1] > -SUN_RADIUS - 0.2f) {
        s->disc =
            sky_sun_through_air(s->air, s->eye_km, desc->sky.sun_elevation_rad, desc->sky.sun_azimuth_rad);
        s->disc_radius = SUN_RADIUS;
    }
    return result;
}

static facet_result use_image(const facet_render_desc *desc, facet_environment *environment,
                              float rows_per_rad, water_sky *s, facet_error *error)
{
    const image *panorama = &environment->panorama;
    const facet_allocator *allocator = &desc->allocator;
    facet_result result = make_environment(allocator, panorama->width, panorama->height, &s->mirrored, error);
    if (result != FACET_OK)
        return result;
    memcpy(s->mirrored->panorama.pixels, panorama->pixels, image_row_size(panorama) * panorama->height);
    result = prepare_reflections(desc, s, error);
    const ibl_light_desc light = {.thread_count = desc->thread_count,
                                  .needs_background = true,
                                  .background_size = (uint32_t)clamp(rows_per_rad, 1.0f, 1e6f)};
    if (result == FACET_OK)
        result = ibl_light_prepare(environment, &light, &s->background, error);
    if (result != FACET_OK)
        return result;
    const float up[3] = {0.0f, 1.0f, 0.0f};
    float E[3];
    ibl_irradiance_over_pi(s->reflected, up, E);
    s->sky_irradiance = vec3(E[0], E[1], E[2]) * (PI * s->scale);
    return FACET_OK;
}

/* Preetham's sky is an image like any other, with a sun. */
static facet_result use_preetham(const facet_render_desc *desc, float rows_per_rad, water_sky *s,
                                 facet_error *error)
{
    const facet_environment_desc environment_desc = {.allocator = desc->allocator,
                                                     .thread_count = desc->thread_count};
    facet_environment *sky = NULL;
    facet_sky_desc without = desc->sky;
    without.omits_disc = true;
    without.illuminance_lux = 0.0f;
    facet_result result = facet_environment_create_sky(&without, &environment_desc, &sky, error);
    if (result == FACET_OK)
        result = use_image(desc, sky, rows_per_rad, s, error);
    facet_environment_destroy(sky);
    float turbidity = desc->sky.turbidity != 0.0f ? desc->sky.turbidity : 2.5f;
    if (result == FACET_OK) {
        sky_sun_light sun =
            sky_sun_preetham(turbidity, desc->sky.sun_elevation_rad, desc->sky.sun_azimuth_rad);
        vec3 E = max(sky_sun_illuminance(&sun), 0.0f);
        const facet_sun disc = {.azimuth_rad = desc->sky.sun_azimuth_rad,
                                .elevation_rad = desc->sky.sun_elevation_rad,
                                .illuminance_lux = {E[0], E[1], E[2]}};
        take_sun(s, &disc);
        s->disc_radius = desc->sky.omits_disc ? 0.0f : s->disc_radius;
    }
    return result;
}

/* Scales the sky so that the most strongly lit surface, about the one that faces the sun, has desc's
 * illuminance. */
static void scale_light(const facet_sky_desc *sky, water_sky *s)
{
    float lux = luminance_of(s->sun_irradiance + s->sky_irradiance);
    if (sky->illuminance_lux > 0.0f)
        s->scale = sky->illuminance_lux / max(lux, 1.0f);
    s->sun_irradiance = s->sun_irradiance * s->scale;
    s->sky_irradiance = s->sky_irradiance * s->scale;
    s->disc_radiance = s->disc_radiance * s->scale;
}

/* ---- making ---- */

static facet_result begin(const facet_render_desc *desc, float eye_height_m, water_sky *s, facet_error *error)
{
    memset(s, 0, sizeof *s);
    s->scale = s->rotation_cos = 1.0f;
    facet_result result = desc->environment ? FACET_OK : check(&desc->sky, eye_height_m, error);
    if (result != FACET_OK)
        return result;
    place_sun(s, desc->sky.sun_elevation_rad, desc->sky.sun_azimuth_rad);
    fill_air(&desc->sky, s);
    s->has_views = !desc->environment && desc->sky.model != FACET_SKY_MODEL_PREETHAM;
    if (s->has_views)
        result = sky_luts_create(s->air, &desc->allocator, desc->thread_count, &s->tables, error);
    return result;
}

static void rotate(const facet_render_desc *r, water_sky *s)
{
    s->rotation_cos = cos(r->environment_rotation_rad);
    s->rotation_sin = sin(r->environment_rotation_rad);
    s->scale = exp2(r->environment_ev);
}

facet_result water_sky_create(const facet_render_desc *desc, float eye_height_m, float rows_per_rad,
                              water_sky *s, facet_error *error)
{
    facet_result result = begin(desc, eye_height_m, s, error);
    if (result != FACET_OK)
        return result;
    s->eye_km = clamp(eye_height_m * 0.001f, MIN_EYE_KM, MAX_EYE_KM);
    s->horizon_mu = horizon_mu(s->eye_km);
    s->horizon_rad = acos(s->horizon_mu);
    water_sky_fill_transmittance(s);
    if (desc->environment) {
        rotate(desc, s);
        result = use_image(desc, desc->environment, rows_per_rad, s, error);
        take_sun(s, &desc->sun);
    } else if (desc->sky.model == FACET_SKY_MODEL_PREETHAM) {
        result = use_preetham(desc, rows_per_rad, s, error);
        scale_light(&desc->sky, s);
    } else {
        light_by_air(&desc->sky, s);
        result = use_views(desc, s, error);
        scale_light(&desc->sky, s);
        if (result == FACET_OK)
            result = water_sky_fill_air(s, &desc->allocator, desc->thread_count, error);
    }
    return result;
}

void water_sky_destroy(water_sky *s)
{
    sky_view_destroy(&s->eye);
    sky_view_destroy(&s->low);
    mem_free(s->air_light);
    sky_luts_destroy(&s->tables);
    ibl_light_release(s->reflected);
    ibl_light_release(s->background);
    if (s->mirrored)
        environment_release(s->mirrored);
    memset(s, 0, sizeof *s);
}

/* ---- lookups ---- */

static const float LIMB_DARKENING = 0.6f; /* in green; Cox 2000 */

/* ---- the sky ---- */

vec3 water_sky_view(const water_sky *s, const sky_view *v, vec3 d, float least_angle, float most_angle)
{
    float angle = equirect_atan2(sqrt(d[0] * d[0] + d[2] * d[2]), d[1]);
    sky_azimuth azimuth = sky_view_azimuth((double)equirect_atan2(d[2], d[0]) - s->sun_longitude);
    return sky_view_at(v, clamp(angle, least_angle, most_angle), &azimuth, clamp(dot(d, s->L), -1.0f, 1.0f)) *
           s->scale;
}

static vec3 rotated(const water_sky *s, vec3 d)
{
    return vec3(d[0] * s->rotation_cos - d[2] * s->rotation_sin, d[1],
                d[0] * s->rotation_sin + d[2] * s->rotation_cos);
}

vec3 water_sky_prefiltered(const water_sky *s, vec3 d, float perceptual_roughness)
{
    vec3 r = rotated(s, d);
    const float R[3] = {r[0], r[1], r[2]};
    float out[3];
    ibl_specular(s->reflected, R, perceptual_roughness, out);
    return vec3(out[0], out[1], out[2]) * s->scale;
}

/* Limb darkening: 1 - u (1 - sqrt(1 - r^2)), over its mean 1 - u / 3; and the transmitted color at this
 * height. */
static vec3 disc_through_air(const water_sky *s, vec3 d, float r2)
{
    float elevation = asin(clamp(d[1], -1.0f, 1.0f));
    float x = (elevation - s->disc.elevation_rad) / SUN_RADIUS * 0.5f + 0.5f;
    x = clamp(x, 0.0f, 1.0f) * (float)(SKY_SUN_NODES - 1);
    int node = (int)x < SKY_SUN_NODES - 2 ? (int)x : SKY_SUN_NODES - 2;
    vec3 light = max(mix(s->disc.nodes[node], s->disc.nodes[node + 1], x - (float)node), 0.0f);
    float limb =
        (1.0f - LIMB_DARKENING * (1.0f - sqrt(max(1.0f - r2, 0.0f)))) / (1.0f - LIMB_DARKENING / 3.0f);
    return elevation < s->disc.horizon_rad ? vec3(0.0f) : light * (limb * s->scale / SUN_SOLID_ANGLE);
}

vec3 water_sky_disc(const water_sky *s, vec3 d)
{
    vec3 off = d - s->L;
    float r2 = dot(off, off) / max(s->disc_radius * s->disc_radius, 1e-12f);
    if (s->disc_radius <= 0.0f || r2 >= 1.0f)
        return vec3(0.0f);
    return s->has_views ? disc_through_air(s, d, r2) : s->disc_radiance;
}

vec3 water_sky_seen(const water_sky *s, vec3 d)
{
    vec3 disc = water_sky_disc(s, d);
    if (s->has_views)
        return water_sky_view(s, &s->eye, d, 0.0f, s->horizon_rad) + disc;
    vec3 r = rotated(s, normalize(vec3(d[0], max(d[1], 0.0f), d[2])));
    const float direction[3] = {r[0], r[1], r[2]};
    float out[3];
    ibl_background(s->background, direction, 0.0f, out);
    return vec3(out[0], out[1], out[2]) * s->scale + disc;
}

vec3 water_sky_reflected(const water_sky *s, vec3 R, float perceptual_roughness)
{
    /* Lobes narrower than 0.02 in alpha count as mirrors under a sky without a disc; texels of an image would
     * show. */
    const float as_mirror = 0.14f;
    vec3 up = vec3(R[0], abs(R[1]), R[2]);
    float share = s->has_views ? clamp(perceptual_roughness / as_mirror, 0.0f, 1.0f) : 1.0f;
    vec3 sum = vec3(0.0f);
    if (share < 1.0f)
        sum = water_sky_view(s, water_sky_low(s), up, 0.0f, 0.5f * PI) * (1.0f - share);
    if (share > 0.0f)
        sum = sum + water_sky_prefiltered(s, up, perceptual_roughness) * share;
    return sum;
}
