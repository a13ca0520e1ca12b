/* ocean_api.c - the part of facet.h about the sea. */
#include "api/api.h"
#include "api/gl_library.h"
#include "api/ocean_path.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ocean/sea.h"
#include "ocean/sea_maps.h"
#include "ocean/sea_mesh.h"
#include "ocean/sea_preset.h"
#include "film/meter.h"
#include "water/water_exposure.h"
#include "water/water_picture.h"
#include "water/water_render.h"

/* ---- seas ---- */

facet_sea_desc facet_sea_default(void)
{
    return sea_default();
}

uint32_t facet_sea_get_preset_count(void)
{
    return sea_preset_count();
}

const char *facet_sea_get_preset_name(uint32_t index)
{
    return sea_preset_name(index);
}

facet_result facet_sea_preset(const char *name, facet_sea_desc *desc, facet_error *error)
{
    return sea_preset(name, desc, error);
}

facet_result facet_sea_create(const facet_sea_desc *desc, facet_sea **sea, facet_error *error)
{
    static const facet_sea_desc defaults;
    return sea_create(desc ? desc : &defaults, sea, error);
}

/* Keeps what draws a sea, or gives up the one that was kept. */
static void keep_gl(facet_sea *sea, gl_sea *used)
{
    const gl_entry *gl;
    gl_sea *other = atomic_exchange(&sea->gl, used);
    if (other && gl_library_open(&gl, NULL) == FACET_OK)
        gl->destroy_sea(other);
}

void facet_sea_destroy(facet_sea *sea)
{
    if (sea)
        keep_gl(sea, NULL);
    sea_destroy(sea);
}

facet_result facet_sea_set_time(facet_sea *sea, double time_s, facet_error *error)
{
    if (!isfinite(time_s))
        return fail(error, FACET_ERROR_ARGUMENT, "sea: its time is not a finite number");
    double loop = sea->waves.loop_s; /* to the last bit, and with it all that depends on time beside waves */
    if (loop > 0.0 && fabs(time_s) >= 0x1p52 * loop) /* farther away than whole loops can be counted */
        time_s = fmod(time_s, loop);
    time_s = loop > 0.0 ? time_s - loop * floor(time_s / loop) : time_s;
    if (time_s != sea->waves.time_s) /* else they are there */
        waves_set_time(&sea->waves, time_s);
    return FACET_OK;
}

/* ---- what is known of them ---- */

/* Along the wind and across. */
static void turn_slopes(slope_covariance c, double direction, double out[2])
{
    double x = cos(direction), z = sin(direction);
    double xx = (double)c.xx, zz = (double)c.zz, xz = (double)c.xz;
    out[0] = fmax(x * x * xx + z * z * zz + 2.0 * x * z * xz, 0.0);
    out[1] = fmax(z * z * xx + x * x * zz - 2.0 * x * z * xz, 0.0);
}

facet_sea_info facet_sea_get_info(const facet_sea *sea)
{
    const waves *w = &sea->waves;
    const sea_state *s = &w->state;
    const water_optics *o = &sea->optics;
    facet_sea_info info = {
        .foam_coverage = (double)sea->foam.coverage, .ior = (double)o->ior, .tile_count = w->tile_count};
    double peak_k = sea_state_peak_k(s);
    if (peak_k > 0.0) {
        info.height_m = 4.0 * sqrt(sea_state_moments(s, 0.0, ENDLESS).height);
        info.peak_period_s = 6.283185307179586 / wave_omega(peak_k, s->depth_m);
        info.peak_length_m = 6.283185307179586 / peak_k;
    }
    const slope_covariance *total = &sea->slopes.total, *rest = &sea->slopes.residual[0];
    slope_covariance resolved = {total->xx - rest->xx, total->zz - rest->zz, total->xz - rest->xz};
    turn_slopes(*total, s->wind_direction, info.slope_variance);
    turn_slopes(resolved, s->wind_direction, info.resolved_slope_variance);
    for (int i = 0; i < 3; i++) {
        info.absorption[i] = (double)o->absorption[i];
        info.scattering[i] = (double)o->scattering[i];
        info.backscattering[i] = (double)o->backscattering[i];
        info.reflectance[i] = (double)o->reflectance[i];
    }
    for (uint32_t i = 0; i < w->tile_count; i++) {
        info.tile_length_m[i] = w->tiles[i].length_m;
        info.tile_turn_rad[i] = w->tiles[i].turn;
    }
    return info;
}

/* ---- points ---- */

typedef struct questions {
    const waves *w;
    const double *positions;
    facet_sea_point *points;
} questions;

static void answer(void *context, size_t begin, size_t end)
{
    const questions *q = context;
    for (size_t i = begin; i < end; i++) {
        double rest[2];
        wave_point p = waves_above(q->w, q->positions[2 * i], q->positions[2 * i + 1], 0.0f, rest);
        wave_shape shape = wave_shape_of(&p);
        facet_sea_point *out = &q->points[i];
        *out = (facet_sea_point){.height_m = p.height_m,
                                 .velocity_mps = (float)waves_velocity(q->w, rest[0], rest[1]),
                                 .jacobian = shape.jacobian};
        memcpy(out->normal, shape.normal, sizeof out->normal);
    }
}

void facet_sea_get_points(const facet_sea *sea, const double *positions, size_t count,
                          facet_sea_point *points)
{
    questions q = {&sea->waves, positions, points};
    parallel_for(count > 16 ? sea->desc.thread_count : 1, count, 16, answer, &q);
}

/* ---- maps, meshes ---- */

static const struct {
    const char *name;
    uint32_t channel_count;
    const char *channel_names[4];
} map_layers[] = {{"", 4, {"R", "G", "B", "A"}},
                  {"normal", 3, {"normal.X", "normal.Y", "normal.Z"}},
                  {"slope", 2, {"slope.X", "slope.Z"}},
                  {"jacobian", 1, {"jacobian.J"}},
                  {"foam", 1, {"foam.A"}}};
enum { MAP_LAYERS = sizeof map_layers / sizeof *map_layers };

static facet_result create_layers(const facet_allocator *allocator, uint32_t size, film *f,
                                  facet_error *error)
{
    f->width = f->height = size;
    for (uint32_t i = 0; i < MAP_LAYERS; i++) {
        size_t channels = map_layers[i].channel_count;
        float *pixels = mem_alloc(allocator, (size_t)size * size, channels * sizeof(float));
        if (!pixels)
            return fail_memory(error, "maps of a sea", (size_t)size * size * channels * sizeof(float));
        f->layers[f->layer_count++] = (film_layer){.name = map_layers[i].name,
                                                   .channel_names = map_layers[i].channel_names,
                                                   .channel_count = map_layers[i].channel_count,
                                                   .pixels = pixels};
    }
    return FACET_OK;
}

static void fill_maps(const facet_sea *sea, uint32_t tile, film *f)
{
    float others = sea_others_variance(sea, tile);
    for (size_t at = 0; at < (size_t)f->width * f->height; at++) {
        sea_texel t = sea_texel_of(sea, tile, others, (uint32_t)(at % f->width), (uint32_t)(at / f->width));
        memcpy(f->layers[0].pixels + 4 * at, t.displacement, sizeof t.displacement);
        f->layers[0].pixels[4 * at + 3] = 1.0f;
        memcpy(f->layers[1].pixels + 3 * at, t.normal, sizeof t.normal);
        memcpy(f->layers[2].pixels + 2 * at, t.slope, sizeof t.slope);
        f->layers[3].pixels[at] = t.jacobian;
        f->layers[4].pixels[at] = t.foam;
    }
}

facet_result facet_sea_create_maps(const facet_sea *sea, uint32_t tile, const facet_allocator *allocator,
                                   facet_image **image, facet_error *error)
{
    *image = NULL;
    if (tile >= sea->waves.tile_count)
        return fail(error, FACET_ERROR_ARGUMENT, "sea: there is no tile %u; it has %u, counted from 0", tile,
                    sea->waves.tile_count);
    facet_image *made = mem_zalloc(allocator, 1, sizeof *made);
    if (!made)
        return fail_memory(error, "image", sizeof *made);
    facet_result result = create_layers(allocator, sea->waves.tiles[tile].size, &made->film, error);
    if (result != FACET_OK) {
        facet_image_destroy(made);
        return result;
    }
    fill_maps(sea, tile, &made->film);
    *image = made;
    return FACET_OK;
}

facet_result facet_sea_create_mesh(const facet_sea *sea, const facet_sea_mesh_desc *desc, facet_scene **scene,
                                   facet_error *error)
{
    const facet_sea_mesh_desc defaults = {0};
    return sea_mesh_create(sea, desc ? desc : &defaults, scene, error);
}

/* ---- pictures ---- */

static const float EYE_M = 3.0f, CLEARANCE_M = 1.0f, FOV_RAD = 0.61f, /* a lens of 38 mm */
    DIP_RAD = 0.07f;

facet_camera facet_sea_camera(const facet_sea *sea, float height_m, float azimuth_rad)
{
    height_m = isfinite(height_m) ? height_m : 0.0f;
    azimuth_rad = isfinite(azimuth_rad) ? azimuth_rad : 0.0f;
    float waves_m = 4.0f * (float)sqrt(sea_state_moments(&sea->waves.state, 0.0, ENDLESS).height);
    float y = height_m != 0.0f ? height_m : fmaxf(EYE_M, waves_m);
    float water = waves_height(&sea->waves, 0.0, 0.0, 0.0f);
    if (y > 0.0f)
        y = fmaxf(y, water + CLEARANCE_M);
    float x = sinf(azimuth_rad) * cosf(DIP_RAD), z = cosf(azimuth_rad) * cosf(DIP_RAD);
    return (facet_camera){.eye = {0.0f, y, 0.0f}, .target = {x, y - sinf(DIP_RAD), z}, .fov_y_rad = FOV_RAD};
}

static facet_result check_look(const facet_sea_shading *look, facet_error *error)
{
    if ((unsigned)look->style > FACET_SEA_STYLE_LEGACY_INTENDED ||
        (unsigned)look->normals > FACET_SEA_NORMALS_GGX ||
        (unsigned)look->masking > FACET_SEA_MASKING_SCHLICK_KARIS || look->stage > 5)
        return fail(error, FACET_ERROR_ARGUMENT, "look: before %d, normals %d, masking %d, stage %u; no such",
                    (int)look->style, (int)look->normals, (int)look->masking, look->stage);
    float r = look->perceptual_roughness;
    if (r != 0.0f && !(r >= 0.001f && r <= 1.0f))
        return fail(error, FACET_ERROR_ARGUMENT, "look: a roughness of %g is not within [0.001, 1]",
                    (double)r);
    if (!(look->clamp >= 0.0f && look->clamp < INFINITY))
        return fail(error, FACET_ERROR_ARGUMENT, "look: a clamp of %g is not 0 or more", (double)look->clamp);
    return FACET_OK;
}

/* Whether path tracing has it: what is there, and nothing in its place. */
static bool is_physical(const facet_sea_shading *look)
{
    return look->style == FACET_SEA_STYLE_PHYSICAL && look->stage == 0 &&
           look->normals == FACET_SEA_NORMALS_BECKMANN && look->masking == FACET_SEA_MASKING_SCALES &&
           !look->omits_glints && !look->omits_caustics && !(look->clamp > 0.0f);
}

/* The desc (NULL: defaults) with nothing left open; *camera is where the camera of one that has none is kept. */
static facet_result resolve_sea(const facet_sea *sea, const facet_sea_render_desc *asked,
                                facet_sea_render_desc *out, facet_camera *camera, facet_error *error)
{
    const facet_sea_render_desc defaults = {0}, *desc = asked ? asked : &defaults;
    *out = *desc;
    facet_renderer_kind renderer = desc->render.renderer;
    facet_result result = check_look(&desc->shading, error);
    if (result == FACET_OK && renderer == FACET_RENDERER_KIND_PATH && !is_physical(&desc->shading))
        result =
            fail(error, FACET_ERROR_ARGUMENT,
                 "look: path tracing knows no stages, no look of before, no other normals or masking, no "
                 "glints or caustics to leave out and no clamp");
    if (result == FACET_OK && renderer != FACET_RENDERER_KIND_PATH &&
        renderer != FACET_RENDERER_KIND_PREVIEW && renderer != FACET_RENDERER_KIND_GL)
        result = fail(error, FACET_ERROR_ARGUMENT, "sea: renderer %d does not draw it", (int)renderer);
    if (result == FACET_OK)
        result = render_desc_resolve(&desc->render, &out->render, error);
    if (result == FACET_OK && !out->render.camera) {
        *camera = facet_sea_camera(sea, 0.0f, out->sky.sun_azimuth_rad);
        out->render.camera = camera;
    }
    return result;
}

/* What the sea keeps is taken while it is in use: several threads may draw one sea. */
static facet_result draw_gl(const facet_sea *sea, const facet_scene *scene, const facet_sea_render_desc *d,
                            facet_image *image, facet_error *error)
{
    facet_sea *kept = (facet_sea *)(uintptr_t)sea;
    const gl_entry *gl;
    water_picture *picture = NULL;
    facet_result result = gl_library_open(&gl, error);
    if (result != FACET_OK)
        return result;
    gl_sea *renderer = atomic_exchange(&kept->gl, NULL);
    if (!renderer)
        result = gl->create_sea(&sea->desc.allocator, &renderer, error);
    if (result == FACET_OK)
        result = water_picture_create(sea, scene, d, &picture, &image->stats, error);
    if (result == FACET_OK)
        result = gl->draw_sea(renderer, water_picture_get(picture), &image->film, &image->stats, error);
    water_picture_destroy(picture);
    if (renderer)
        keep_gl(kept, renderer);
    return result;
}

static facet_result draw(const facet_sea *sea, const facet_scene *scene, const facet_sea_render_desc *d,
                         facet_image *image, facet_error *error)
{
    const facet_render_desc *r = &d->render;
    facet_result result = film_create(&r->allocator, r->crop[2], r->crop[3], 0, &image->film, error);
    if (result == FACET_OK)
        result = r->renderer == FACET_RENDERER_KIND_GL
                     ? draw_gl(sea, scene, d, image, error)
                     : water_render(sea, scene, d, &image->film, &image->stats, error);
    if (result == FACET_OK)
        film_develop(&image->film, r->tonemap, NULL, r->thread_count);
    return result;
}

facet_result facet_sea_render(const facet_sea *sea, const facet_scene *scene,
                              const facet_sea_render_desc *desc, facet_image **image, facet_error *error)
{
    *image = NULL;
    facet_sea_render_desc d;
    facet_camera camera;
    facet_result result = resolve_sea(sea, desc, &d, &camera, error);
    if (result != FACET_OK)
        return result;
    water_warn_of_eye(sea, &d);
    if (d.render.renderer == FACET_RENDERER_KIND_PATH)
        return ocean_path_render(sea, scene, &d, image, error);
    facet_image *made = mem_zalloc(&d.render.allocator, 1, sizeof *made);
    if (!made)
        return fail_memory(error, "image", sizeof *made);
    result = draw(sea, scene, &d, made, error);
    if (result == FACET_OK)
        *image = made;
    else
        facet_image_destroy(made);
    return result;
}

facet_result facet_sea_meter(const facet_sea *sea, const facet_sea_render_desc *desc, double *ev100,
                             facet_error *error)
{
    facet_sea_render_desc d;
    facet_camera camera;
    *ev100 = 0.0;
    facet_result result = resolve_sea(sea, desc, &d, &camera, error);
    return result == FACET_OK ? water_exposure_ev100(sea, &d, ev100, error) : result;
}

float facet_exposure_from_ev100(double ev100)
{
    return (float)meter_exposure_ev(ev100);
}
