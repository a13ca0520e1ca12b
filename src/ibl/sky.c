/* sky.c - clear skies as environments: checks of the description, and scaling to an illuminance. sky_image.c
 * draws them. */
#include <assert.h>
#include <math.h>

#include "base/parallel.h"
#include "base/result.h"
#include "ibl/cache.h"
#include "ibl/environment.h"
#include "ibl/sky_image.h"

enum { DEFAULT_HEIGHT = 512, DEFAULT_MAX_SIZE = 32768 };
static const float default_turbidity = 2.5f, max_turbidity = 10.0f, min_preetham_turbidity = 1.7f;
static const float max_altitude_m = 50000.0f;
static const float right_angle = 1.57079637f;
static const double darkest_lux =
    1.0; /* twice the light of a full moon; darker skies are not scaled to daylight */

/* ---- arguments ---- */

static bool is_within(float x, float minimum, float maximum)
{
    return x >= minimum && x <= maximum; /* false for NaN */
}

static facet_result check(const facet_sky_desc *sky, uint32_t max_size, facet_error *error)
{
    bool is_preetham = sky->model == FACET_SKY_MODEL_PREETHAM;
    float least = is_preetham ? min_preetham_turbidity : 1.0f;
    double degrees = (double)sky->sun_elevation_rad * 57.29577951308232;
    if (!is_within(sky->sun_elevation_rad, -right_angle, right_angle) || !isfinite(sky->sun_azimuth_rad))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "sky: the sun is %g degrees above the horizon; -90 to 90 were expected", degrees);
    if (is_preetham && sky->sun_elevation_rad < 0.0f)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "sky: the sun is %.4g degrees below the horizon; Preetham's formula has no twilight, the "
                    "atmosphere has",
                    -degrees);
    if (sky->turbidity != 0.0f && !is_within(sky->turbidity, least, max_turbidity))
        return fail(error, FACET_ERROR_ARGUMENT, "sky: the turbidity is %g; %g to %g were expected",
                    (double)sky->turbidity, (double)least, (double)max_turbidity);
    for (int i = 0; i < 3; i++)
        if (!is_within(sky->ground_albedo[i], 0.0f, 1.0f))
            return fail(error, FACET_ERROR_ARGUMENT,
                        "sky: the albedo of the ground is %g; 0 to 1 were expected",
                        (double)sky->ground_albedo[i]);
    if (!is_within(sky->altitude_m, 0.0f, max_altitude_m))
        return fail(error, FACET_ERROR_ARGUMENT, "sky: the altitude is %g m; 0 to %g were expected",
                    (double)sky->altitude_m, (double)max_altitude_m);
    if (!(sky->illuminance_lux >= 0.0f) || !isfinite(sky->illuminance_lux))
        return fail(error, FACET_ERROR_ARGUMENT, "sky: the illuminance is %g lx; 0 or more was expected",
                    (double)sky->illuminance_lux);
    if (sky->height == 1 || sky->height > max_size / 2)
        return fail(error, FACET_ERROR_ARGUMENT, "sky: a height of %u texels; 2 to %u were expected",
                    (unsigned)sky->height, (unsigned)(max_size / 2));
    return FACET_OK;
}

/* ---- drawing ---- */

static facet_result draw_atmosphere(const facet_sky_desc *sky, const facet_environment_desc *desc,
                                    image *panorama, facet_error *error)
{
    Atmosphere air[SKY_HALVES];
    sky_luts tables = {.columns = NULL};
    sky_view view = {.rows = NULL};
    float altitude_km = sky->altitude_m * 0.001f;
    sky_atmosphere(sky->turbidity, sky->ground_albedo, air);
    facet_result result = sky_luts_create(air, &desc->allocator, desc->thread_count, &tables, error);
    if (result == FACET_OK)
        result = sky_view_create(&tables, altitude_km, sky->sun_elevation_rad, &desc->allocator,
                                 desc->thread_count, &view, error);
    if (result == FACET_OK)
        result = sky_image_atmosphere(&view, sky->sun_azimuth_rad, &desc->allocator, desc->thread_count,
                                      panorama, error);
    if (result == FACET_OK && !sky->omits_disc) {
        sky_sun_light sun =
            sky_sun_through_air(air, altitude_km, sky->sun_elevation_rad, sky->sun_azimuth_rad);
        sky_sun_draw(&sun, panorama);
    }
    sky_view_destroy(&view);
    sky_luts_destroy(&tables);
    return result;
}

static facet_result draw_preetham(const facet_sky_desc *sky, const facet_environment_desc *desc,
                                  image *panorama, facet_error *error)
{
    sky_sun_light sun = sky_sun_preetham(sky->turbidity, sky->sun_elevation_rad, sky->sun_azimuth_rad);
    TRY(sky_image_preetham(sky->turbidity, &sun, sky->ground_albedo, &desc->allocator, desc->thread_count,
                           panorama, error));
    if (!sky->omits_disc)
        sky_sun_draw(&sun, panorama);
    return FACET_OK;
}

/* Scales the panorama so that the most illuminated orientation receives the requested illuminance. */
typedef struct scaling {
    image *panorama;
    float factor;
} scaling;

static void scale_rows(void *context, size_t begin, size_t end)
{
    const scaling *s = context;
    size_t row = (size_t)s->panorama->width * 3;
    float *p = s->panorama->pixels;
    for (size_t i = begin * row; i < end * row; i++)
        p[i] *= s->factor;
}

static facet_result expose(const facet_sky_desc *sky, const facet_environment_desc *desc, image *panorama,
                           facet_error *error)
{
    double lux = 0.0;
    if (sky->illuminance_lux == 0.0f)
        return FACET_OK;
    TRY(sky_image_illuminance(panorama, sky->sun_azimuth_rad, &desc->allocator, desc->thread_count, &lux,
                              error));
    scaling s = {panorama, (float)((double)sky->illuminance_lux / fmax(lux, darkest_lux))};
    parallel_for(desc->thread_count, panorama->height, 16, scale_rows, &s);
    return FACET_OK;
}

facet_result facet_environment_create_sky(const facet_sky_desc *sky, const facet_environment_desc *desc,
                                          facet_environment **environment, facet_error *error)
{
    assert(sky && environment);
    static const facet_environment_desc default_desc;
    *environment = NULL;
    desc = desc ? desc : &default_desc;
    facet_environment *e = NULL;
    TRY(check(sky, desc->max_size ? desc->max_size : DEFAULT_MAX_SIZE, error));
    TRY(environment_create(desc, &e, error));
    facet_sky_desc s = *sky;
    s.turbidity = s.turbidity != 0.0f ? s.turbidity : default_turbidity;
    s.height = s.height ? s.height : DEFAULT_HEIGHT;
    facet_result result =
        image_create(&e->allocator, 2 * s.height, s.height, 3, IMAGE_F32, &e->panorama, error);
    if (result == FACET_OK)
        result = (s.model == FACET_SKY_MODEL_PREETHAM ? draw_preetham : draw_atmosphere)(&s, desc,
                                                                                         &e->panorama, error);
    if (result == FACET_OK)
        result = expose(&s, desc, &e->panorama, error);
    if (result == FACET_OK)
        environment_limit(e, desc->thread_count);
    return cache_finish(result, e, environment);
}
