/* sky_image.c - see sky_image.h: the sun's disc, panoramas of skies, their illuminance, and the environments
 * made of them. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ibl/cache.h"
#include "ibl/environment.h"
#include "ibl/equirect.h"
#include "ibl/sky_image.h"

#include "shade/lang/lang_c_load.h"

/* ---- the sun ---- */

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

/* A sample of the disc: its direction and its share of the illuminance. */
typedef struct disc_part {
    double direction[3];
    vec3 illuminance;
} disc_part;

/* The disc's center and two directions across it, upwards and sideways. */
typedef struct disc_frame {
    double middle[3], up[3], side[3];
} disc_frame;

static disc_frame make_frame(const sky_sun_light *sun)
{
    double se = sin((double)sun->elevation_rad), ce = cos((double)sun->elevation_rad);
    double sa = sin((double)sun->azimuth_rad), ca = cos((double)sun->azimuth_rad);
    return (disc_frame){{sa * ce, se, ca * ce}, {-sa * se, ce, -ca * se}, {ca, 0.0, -sa}};
}

/* Sample part of count. The mean of the limb darkening over the disc is 1 - u / 3. */
static disc_part make_part(const sky_sun_light *sun, const disc_frame *frame, int part, int count)
{
    const double golden_angle = 2.399963229728653;
    double r = sqrt((part / 2 + 0.5) / (count / 2));
    double turn = golden_angle * (part / 2) * (part % 2 ? 1.0 : -1.0);
    double angle = r * (double)SUN_RADIUS;
    double up = sin(angle) * cos(turn), side = sin(angle) * sin(turn);
    double limb = (1.0 - limb_darkening * (1.0 - sqrt(1.0 - r * r))) / (1.0 - limb_darkening / 3.0);
    disc_part out;
    for (int i = 0; i < 3; i++)
        out.direction[i] = frame->middle[i] * cos(angle) + frame->up[i] * up + frame->side[i] * side;
    float elevation = (float)asin(fmax(-1.0, fmin(1.0, out.direction[1])));
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

void sky_sun_draw(const sky_sun_light *sun, image *panorama)
{
    disc_frame frame = make_frame(sun);
    uint32_t width = panorama->width, height = panorama->height;
    int finer = 1 + (int)(height / 2048);
    int count = PARTS * finer * finer; /* hundreds of samples per texel */
    for (int k = 0; k < count; k++) {
        disc_part part = make_part(sun, &frame, k, count);
        const double *d = part.direction;
        double u = 0.5 + (atan2)(d[2], d[0]) * 0.15915494309189535;
        double v = acos(fmax(-1.0, fmin(1.0, d[1]))) * 0.3183098861837907;
        uint32_t x = (uint32_t)fmin(fmax(u * width, 0.0), width - 1.0);
        uint32_t y = (uint32_t)fmin(v * height, height - 1.0);
        float per_sr = (float)(1.0 / equirect_texel_solid_angle(width, height, y));
        float *texel = (float *)panorama->pixels + 3 * ((size_t)y * width + x);
        for (int i = 0; i < 3; i++)
            texel[i] += part.illuminance[i] * per_sr;
    }
}

enum { FINE_SUB_ROWS = 16, BLOCK_ROWS = 32, BLOCK_COLUMNS = 64, CANDIDATES = 360 };

static const double half_turn = 3.14159265358979323846;

/* A panorama, and one of the two sky models. */
typedef struct image_job {
    image *panorama;
    sky_azimuth *columns; /* azimuths from the sun */
    double horizon;       /* angle from the zenith */
    float mu_sun, across_sun;
    const sky_view *view; /* NULL: Preetham's */
    PreethamSky preetham;
    const facet_allocator *allocator;
} image_job;

/* ---- rows ---- */

/* Adds the sky at a zenith angle to a row of the panorama. */
static void add_view_row(const image_job *job, double angle, float weight, float *texels)
{
    sky_light row[SKY_VIEW_AZIMUTHS];
    float mu = (float)cos(angle), across = (float)sin(angle) * job->across_sun;
    sky_view_fetch_row(job->view, (float)angle, row);
    for (uint32_t x = 0; x < job->panorama->width; x++) {
        float cos_angle = clamp(mu * job->mu_sun + across * job->columns[x].cosine, -1.0f, 1.0f);
        vec3 L = sky_view_radiance(job->view, row, &job->columns[x], cos_angle);
        for (int i = 0; i < 3; i++)
            texels[3 * x + (uint32_t)i] += L[i] * weight;
    }
}

static void add_preetham_row(const image_job *job, double angle, float weight, float *texels)
{
    float mu = (float)cos(angle), across = (float)sin(angle) * job->across_sun;
    for (uint32_t x = 0; x < job->panorama->width && angle < job->horizon; x++) {
        float cos_angle = clamp(mu * job->mu_sun + across * job->columns[x].cosine, -1.0f, 1.0f);
        vec3 L = preetham_radiance(job->preetham, mu, cos_angle);
        for (int i = 0; i < 3; i++)
            texels[3 * x + (uint32_t)i] += L[i] * weight;
    }
}

/* Rows are supersampled where the sky changes fast: at the horizon, and in coarse panoramas. */
static void draw_rows(void *context, size_t begin, size_t end)
{
    const image_job *job = context;
    double row_angle = half_turn / job->panorama->height;
    size_t row_floats = (size_t)job->panorama->width * 3;
    for (size_t y = begin; y < end; y++) {
        float *texels = (float *)job->panorama->pixels + y * row_floats;
        double top = (double)y * row_angle;
        bool is_fine = fabs(top + 0.5 * row_angle - job->horizon) < 2.0 * row_angle;
        int count = is_fine ? FINE_SUB_ROWS : (int)fmin(ceil(row_angle / 0.007), FINE_SUB_ROWS);
        double whole = cos(top) - cos(top + row_angle);
        memset(texels, 0, row_floats * sizeof *texels);
        for (int i = 0; i < count; i++) {
            double from = top + row_angle * i / count, to = top + row_angle * (i + 1) / count;
            float weight = (float)((cos(from) - cos(to)) / whole);
            if (job->view)
                add_view_row(job, 0.5 * (from + to), weight, texels);
            else
                add_preetham_row(job, 0.5 * (from + to), weight, texels);
        }
    }
}

static facet_result draw(image_job *job, float sun_azimuth_rad, uint32_t thread_count, facet_error *error)
{
    uint32_t width = job->panorama->width;
    job->columns = mem_alloc(job->allocator, width, sizeof *job->columns);
    if (!job->columns)
        return fail_memory(error, "sky", width * sizeof *job->columns);
    double sun = 0.5 * half_turn - (double)sun_azimuth_rad; /* longitude, from +X towards +Z */
    for (uint32_t x = 0; x < width; x++)
        job->columns[x] = sky_view_azimuth(2.0 * half_turn * ((x + 0.5) / width - 0.5) - sun);
    job->across_sun = sqrtf(max(1.0f - job->mu_sun * job->mu_sun, 0.0f));
    parallel_for(thread_count, job->panorama->height, 8, draw_rows, job);
    mem_free(job->columns);
    return FACET_OK;
}

facet_result sky_image_atmosphere(const sky_view *view, float sun_azimuth_rad,
                                  const facet_allocator *allocator, uint32_t thread_count, image *panorama,
                                  facet_error *error)
{
    image_job job = {.panorama = panorama,
                     .allocator = allocator,
                     .horizon = acos((double)horizon_mu(view->height_km)),
                     .mu_sun = view->mu_sun,
                     .view = view};
    return draw(&job, sun_azimuth_rad, thread_count, error);
}

/* ---- Preetham's ground ---- */

/* Illuminance of horizontal ground by the upper half of the panorama. */
static void sum_ground(const image *panorama, double out[3])
{
    out[0] = out[1] = out[2] = 0.0;
    for (uint32_t y = 0; y < panorama->height / 2; y++) {
        const float *row = (const float *)panorama->pixels + (size_t)y * panorama->width * 3;
        double sums[3] = {0.0, 0.0, 0.0};
        for (uint32_t x = 0; x < panorama->width; x++)
            for (int i = 0; i < 3; i++)
                sums[i] += (double)row[3 * x + (uint32_t)i];
        double cosine = cos((y + 0.5) * half_turn / panorama->height);
        for (int i = 0; i < 3; i++)
            out[i] += sums[i] * cosine * equirect_texel_solid_angle(panorama->width, panorama->height, y);
    }
}

/* sky_image_atmosphere() by Preetham's formula, with a diffuse ground lit by that sky and sun. */
static facet_result draw_preetham_sky(float turbidity, const sky_sun_light *sun, const float ground_albedo[3],
                                      const facet_allocator *allocator, uint32_t thread_count,
                                      image *panorama, facet_error *error)
{
    float zenith = 0.5f * PI - sun->elevation_rad;
    image_job job = {.panorama = panorama,
                     .allocator = allocator,
                     .horizon = 0.5 * half_turn,
                     .mu_sun = cosf(zenith),
                     .preetham = preetham_sky(turbidity, zenith)};
    TRY(draw(&job, sun->azimuth_rad, thread_count, error));
    double illuminance[3];
    sum_ground(panorama, illuminance);
    vec3 direct = sky_sun_illuminance(sun);
    float *texels = panorama->pixels;
    for (uint32_t y = panorama->height / 2; y < panorama->height; y++) {
        bool is_half = 2 * y + 1 == panorama->height; /* the horizon crosses the middle of the row */
        for (uint32_t x = 0; x < panorama->width; x++)
            for (uint32_t i = 0; i < 3; i++) {
                double light = illuminance[i] + (double)direct[i] * (double)job.mu_sun;
                texels[((size_t)y * panorama->width + x) * 3 + i] +=
                    (float)(light * (double)ground_albedo[i] / half_turn) * (is_half ? 0.5f : 1.0f);
            }
    }
    return FACET_OK;
}

/* ---- exposure ---- */

/* Illuminance vectors of blocks of texels: sums of luminance times solid angle times direction. */
typedef struct flux_blocks {
    const image *panorama;
    double vectors[BLOCK_ROWS][BLOCK_COLUMNS][3];
} flux_blocks;

static void sum_blocks(void *context, size_t begin, size_t end)
{
    flux_blocks *b = context;
    const image *p = b->panorama;
    for (size_t row = begin; row < end; row++)
        for (uint32_t y = (uint32_t)(row * p->height / BLOCK_ROWS);
             y < (uint32_t)((row + 1) * p->height / BLOCK_ROWS); y++) {
            double solid_angle = equirect_texel_solid_angle(p->width, p->height, y);
            const float *texel = (const float *)p->pixels + (size_t)y * p->width * 3;
            for (uint32_t x = 0; x < p->width; x++, texel += 3) {
                float d[3];
                equirect_direction(p->width, p->height, x, y, d);
                double flux = (double)luminance(load3(texel)) * solid_angle;
                double *sum = b->vectors[row][(uint64_t)x * BLOCK_COLUMNS / p->width];
                for (int i = 0; i < 3; i++)
                    sum[i] += flux * (double)d[i];
            }
        }
}

/* Largest illuminance in lx of any orientation, for a panorama that is symmetric about the vertical plane of
 * an azimuth. To 0.1 %. FACET_ERROR_MEMORY. */
static facet_result largest_illuminance(const image *panorama, float azimuth_rad,
                                        const facet_allocator *allocator, uint32_t thread_count, double *out,
                                        facet_error *error)
{
    flux_blocks *b = mem_zalloc(allocator, 1, sizeof *b);
    if (!b)
        return fail_memory(error, "sky", sizeof *b);
    b->panorama = panorama;
    parallel_for(thread_count, BLOCK_ROWS, 1, sum_blocks, b);
    double largest = 0.0;
    for (int c = 0; c < CANDIDATES; c++) {
        double elevation = 2.0 * half_turn * c / CANDIDATES;
        double n[3] = {cos(elevation) * sin((double)azimuth_rad), sin(elevation),
                       cos(elevation) * cos((double)azimuth_rad)};
        double sum = 0.0;
        for (int row = 0; row < BLOCK_ROWS; row++)
            for (int column = 0; column < BLOCK_COLUMNS; column++) {
                const double *v = b->vectors[row][column];
                sum += fmax(v[0] * n[0] + v[1] * n[1] + v[2] * n[2], 0.0);
            }
        largest = fmax(largest, sum);
    }
    mem_free(b);
    *out = largest;
    return FACET_OK;
}

enum { DEFAULT_HEIGHT = 512, DEFAULT_MAX_SIZE = 32768 };
static const float default_turbidity = 2.5f, max_turbidity = 10.0f, min_preetham_turbidity = 1.7f;
static const float max_altitude_m = 50000.0f;
static const float right_angle = 1.57079637f;
static const double darkest_lux =
    1.0; /* twice the light of a full moon; darker skies are not scaled to daylight */

/* ---- arguments of facet_environment_create_sky() ---- */

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

/* ---- environments ---- */

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
    TRY(draw_preetham_sky(sky->turbidity, &sun, sky->ground_albedo, &desc->allocator, desc->thread_count,
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
    TRY(largest_illuminance(panorama, sky->sun_azimuth_rad, &desc->allocator, desc->thread_count, &lux,
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
