/* water_setup.c - see water_setup.h. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ibl/environment.h"
#include "ibl/equirect.h"
#include "shade/lang/lang_c_load.h"

#include "water/water_caustics.h"
#include "water/water_objects.h"
#include "water/water_render.h"
#include "water/water_shade.h"

_Static_assert(FACET_SEA_MASKING_SCALES == WATER_SCALES && FACET_SEA_MASKING_SMITH == WATER_SMITH &&
                   FACET_SEA_MASKING_SCHLICK_KARIS == WATER_SCHLICK_KARIS,
               "styles and shaders have the same numbers");

static const float SHUTTER_S = 0.01f;

static void fill_water(water_setup *s)
{
    const water_optics *o = &s->sea->optics;
    const facet_sea_shading *shading = &s->desc->sea_shading;
    s->water.ior = o->ior;
    s->water.absorption = load3(o->absorption);
    s->water.scattering = load3(o->scattering);
    s->water.backscattering = load3(o->backscattering);
    s->water.reflectance = load3(o->reflectance);
    s->water.pure_share = load3(o->pure_share);
    s->water.foam_albedo = o->foam_albedo;
    s->water.normals = shading->normals == FACET_SEA_NORMALS_GGX ? WATER_GGX : WATER_BECKMANN;
    s->water.masking = (int)shading->masking;
    s->water.is_schlick = shading->has_schlick_fresnel;
}

static void fill_light(water_setup *s)
{
    float sigma = water_sigma_of(water_slopes_of(&s->sea->slopes.total));
    Water *w = &s->water;
    w->sky_reflectance = water_table_sky_reflectance(&s->table, sigma);
    s->light.L = s->sky.L;
    s->light.sun_irradiance = s->sky.sun_irradiance;
    s->light.sky_irradiance = s->sky.sky_irradiance;
    s->light.sun_fresnel = water_table_fresnel(&s->table, max(s->sky.L[1], 0.0f), sigma);
    s->light.downwelling = water_downwelling(*w, s->light);
    s->beam = water_beam_below(*w, s->light);
    vec3 L = vec3(s->sky.L[0], max(s->sky.L[1], 0.0f), s->sky.L[2]);
    s->sunward = -water_refracted(*w, -normalize(L), vec3(0.0f, 1.0f, 0.0f));
}

/* A sine wave with the height of the sea and the length of its highest waves. */
static void fill_crest(water_setup *s)
{
    vec3 L = s->light.L, slopes = water_slopes_of(&s->sea->slopes.total);
    float variance = slope_variance(slopes, vec2(L[0], L[2])) / max(L[0] * L[0] + L[2] * L[2], 1e-8f);
    float wavenumber = (float)sea_state_peak_k(&s->sea->waves.state);
    float amplitude = wavenumber > 0.0f ? sqrt(2.0f) * s->march.deviation_m : 0.0f;
    s->crest = water_crest_beam(s->water, s->light, variance, wavenumber, amplitude);
}

static bool is_under_water(const facet_sea *sea, const float eye[3])
{
    return eye[1] < waves_height(&sea->waves, (double)eye[0], (double)eye[2], 0.0f);
}

/* ---- what a model sees ---- */

/* Rows of the panorama that a model sees: the sky, and the mean radiance of the sea. */
enum { AROUND_HEIGHT = 128 };

static bool has_foam(const water_setup *s)
{
    return s->foam.share.level_count > 0;
}

/* Mean coverage by foam. Where there is foam, its amount is a quarter: of a coverage of 0.105 at 20 m/s, the
 * mean square is 0.025. */
static float foam_on_average(const water_setup *s)
{
    return water_foam_cover(s->sea->foam.coverage, 0.25f);
}

/* Radiance from a direction: of the sky, or the mean over the whole sea; over a bed, with the depth at the
 * origin. */
static vec3 surroundings(const water_setup *s, vec3 d)
{
    if (d[1] >= 0.0f)
        return water_sky_reflected(&s->sky, d, 0.0f);
    float means[4], mu = max(-d[1], 1e-3f);
    WaterPoint point;
    point.N = vec3(0.0f, 1.0f, 0.0f);
    point.covariance = water_slopes_of(&s->sea->slopes.total);
    point.foam = 0.0f;
    water_table_at(&s->table, mu, water_sigma_of(point.covariance), means);
    WaterSpecular m = water_specular(s->water, point, -d, means[0], means[1], means[2], means[3]);
    vec3 sky = water_sky_reflected(&s->sky, m.R, m.perceptual_roughness);
    vec3 below = water_from_still(s, s->sea->desc.bed.depth_m, water_refracted(s->water, d, point.N));
    vec3 L = mix(below * (1.0f / (s->water.ior * s->water.ior)), sky, m.fresnel);
    return has_foam(s) ? mix(L, water_foam(s->water, s->light, point.N), foam_on_average(s)) : L;
}

typedef struct surroundings_drawing {
    const water_setup *setup;
    const image *panorama;
} surroundings_drawing;

static void draw_surroundings(void *context, size_t begin, size_t end)
{
    const surroundings_drawing *drawing = context;
    const water_setup *s = drawing->setup;
    const image *panorama = drawing->panorama;
    for (size_t y = begin; y < end; y++) {
        float *texel = (float *)panorama->pixels + y * panorama->width * 3;
        for (uint32_t x = 0; x < panorama->width; x++, texel += 3) {
            float d[3];
            equirect_direction(panorama->width, panorama->height, (double)x, (double)y, d);
            vec3 L = surroundings(s, vec3(d[0], d[1], d[2]));
            for (int i = 0; i < 3; i++)
                texel[i] = L[i];
        }
    }
}

/* Makes s->cache->light->around, once per light. FACET_ERROR_MEMORY. */
static facet_result prepare_surroundings(water_setup *s, facet_error *error)
{
    const facet_render_desc *r = s->desc;
    const facet_environment_desc desc = {.allocator = s->cache->allocator};
    facet_environment *around;
    if (s->cache->light->around && s->cache->light->around_has_foam == has_foam(s))
        return FACET_OK;
    facet_result result = environment_create(&desc, &around, error);
    if (result == FACET_OK)
        result = image_create(&desc.allocator, 2 * AROUND_HEIGHT, AROUND_HEIGHT, 3, IMAGE_F32,
                              &around->panorama, error);
    if (result != FACET_OK) {
        if (around)
            environment_release(around);
        return result;
    }
    surroundings_drawing drawing = {s, &around->panorama};
    parallel_for(r->thread_count, AROUND_HEIGHT, 8, draw_surroundings, &drawing);
    environment_limit(around, r->thread_count);
    if (s->cache->light->around)
        environment_release(s->cache->light->around);
    s->cache->light->around = around;
    s->cache->light->around_has_foam = has_foam(s);
    return FACET_OK;
}

static facet_result add_model(water_setup *s, const facet_scene *scene, bool is_lit,
                              facet_render_stats *stats, facet_error *error)
{
    if (is_lit)
        TRY(prepare_surroundings(s, error));
    facet_environment *around = is_lit ? s->cache->light->around : NULL;
    return water_model_create(scene, s->desc, &s->sky, around, stats, &s->model, error);
}

/* ---- all ---- */

static facet_result make_foam(water_setup *s, facet_error *error)
{
    const facet_sea *sea = s->sea;
    return waves_foam_create(&sea->waves, &sea->foam, foam_decay_s((double)sea->desc.water.salinity),
                             &s->cache->allocator, &s->cache->foam, &s->foam, error);
}

facet_result water_setup_create(water_cache *cache, const facet_scene *scene, const facet_render_desc *desc,
                                uint32_t needs, water_setup *s, facet_render_stats *stats, facet_error *error)
{
    const facet_render_desc *r = desc;
    const facet_sea *sea = desc->sea;
    memset(s, 0, sizeof *s);
    water_cache_begin(cache, desc);
    s->cache = cache;
    s->sea = sea;
    s->desc = desc;
    s->exposure = exp2(r->exposure_ev);
    s->shutter_s = SHUTTER_S;
    facet_result result = camera_rays_create(r->camera, r->width, r->height, &s->camera, error);
    if (result != FACET_OK)
        return result;
    s->footprint = inversesqrt((float)(r->samples ? r->samples : 1));
    s->is_below = is_under_water(sea, s->camera.origin);
    s->march = water_march_of(&sea->waves, &sea->slopes, !s->camera.is_orthographic);
    const uint32_t whole[4] = {0, 0, r->width, r->height}; /* so that a crop shows the same */
    if (needs & WATER_SETUP_PROFILE)
        result = water_profile_create(&s->march, &s->camera, whole, s->is_below, r->thread_count,
                                      &r->allocator, &s->profile, error);
    bool has_foam = sea_shading_is_complete(&desc->sea_shading) && !desc->sea_shading.omits_foam &&
                    sea->foam.threshold < HUGE_VALF;
    if (result == FACET_OK && has_foam)
        result = make_foam(s, error);
    float rows_per_rad = s->camera.is_orthographic ? 1000.0f : 1.0f / s->camera.pixel_size;
    if (result == FACET_OK)
        result = water_light_update(cache, desc, s->camera.origin[1], rows_per_rad, error);
    if (result != FACET_OK)
        return result;
    s->sky = cache->light->sky;
    s->table = cache->light->table;
    fill_water(s);
    fill_light(s);
    fill_crest(s);
    if (desc->aovs & SCENE_IDENTITY_AOVS)
        TRY(water_objects_identify(scene, sea, &desc->allocator, &s->identities, error));
    float perceptual_roughness = desc->sea_shading.perceptual_roughness;
    s->roughness = perceptual_roughness > 0.0f ? slopes_from_roughness(perceptual_roughness) : vec3(-1.0f);
    if (scene)
        result = add_model(s, scene, needs & WATER_SETUP_MODEL_LIGHT, stats, error);
    if (!(needs & WATER_SETUP_BED_LIGHT))
        return result;
    if (result == FACET_OK)
        result = caustic_map_of_image(s, &s->caustics, error);
    return result == FACET_OK ? bed_shadow_of_image(s, &s->shadow, error) : result;
}

void water_setup_destroy(water_setup *s)
{
    water_model_destroy(&s->model);
    bed_shadow_destroy(&s->shadow);
    caustic_map_destroy(&s->caustics);
    water_profile_destroy(&s->profile);
    waves_foam_destroy(&s->foam);
    mem_free(s->identities);
    memset(s, 0, sizeof *s);
}

water_slopes water_slopes_at(const water_setup *s, float footprint_m)
{
    const slope_filter *f = &s->sea->slopes;
    float place = slope_filter_place(footprint_m);
    uint32_t i = place < 62.0f ? (uint32_t)place : 62;
    float share = place - (float)i;
    vec3 C = mix(water_slopes_of(&f->residual[i]), water_slopes_of(&f->residual[i + 1]), share);
    vec3 resolved = water_slopes_of(&f->total) - C;
    if (s->roughness[0] >= 0.0f)
        C = C - water_slopes_of(&f->residual[0]) + s->roughness;
    vec3 least = vec3(SLOPE_VARIANCE_MIN, SLOPE_VARIANCE_MIN, 0.0f);
    return (water_slopes){.covariance = vec3(max(C[0], 0.0f), max(C[1], 0.0f), C[2]) + least,
                          .resolved =
                              vec3(max(resolved[0], 0.0f), max(resolved[1], 0.0f), resolved[2]) + least,
                          .curvature = mix(f->curvature[i], f->curvature[i + 1], share),
                          .rate = mix(f->rate[i], f->rate[i + 1], share)};
}

void water_warn_of_eye(const facet_render_desc *d)
{
    const facet_sea *sea = d->sea;
    const float *eye = d->camera->eye;
    const facet_sea_bed *bed = &sea->desc.bed;
    double below = water_bed_height(bed, (double)eye[0], (double)eye[2]) - (double)eye[1];
    bool is_below = is_under_water(sea, eye);
    if (sea_has_bed(bed) && below > 0.0)
        log_warning(&d->log, "sea: the camera is %.3g m below the bed; the image will be dark", below);
    else if (is_below != (eye[1] < 0.0f))
        log_warning(&d->log, "sea: the camera, %.3g m %s still water, is %s", fabs((double)eye[1]),
                    is_below ? "above" : "below",
                    is_below ? "inside of a wave" : "over a trough, in the air");
}
