/* ocean_api.c - the functions of facet/sea.h. */
#include "api/api.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ocean/sea.h"
#include "film/meter.h"

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

void facet_sea_destroy(facet_sea *sea)
{
    sea_destroy(sea);
}

facet_result facet_sea_set_time(facet_sea *sea, double time_s, facet_error *error)
{
    if (!isfinite(time_s))
        return fail(error, FACET_ERROR_ARGUMENT, "sea: its time is not a finite number");
    double loop = sea->waves.loop_s; /* exactly periodic, and with it everything else that depends on time */
    if (loop > 0.0 && fabs(time_s) >= 0x1p52 * loop) /* too far away to count whole loops */
        time_s = fmod(time_s, loop);
    time_s = loop > 0.0 ? time_s - loop * floor(time_s / loop) : time_s;
    if (time_s != sea->waves.time_s) /* else nothing changes */
        waves_set_time(&sea->waves, time_s);
    return FACET_OK;
}

/* ---- what is known of them ---- */

/* Slope variance along and across the wind. */
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

/* ---- images ---- */

facet_camera facet_sea_camera(const facet_sea *sea, float height_m, float azimuth_rad)
{
    return sea_camera(sea, height_m, azimuth_rad);
}

/* desc (NULL: {0}) as facet_render() takes it. */
static facet_render_desc in_sea(const facet_sea *sea, const facet_sea_render_desc *desc)
{
    static const facet_sea_render_desc defaults = {.shading = {0}};
    const facet_sea_render_desc *d = desc ? desc : &defaults;
    facet_render_desc render = d->render;
    render.sea = sea;
    render.sky = d->sky;
    render.sea_shading = d->shading;
    return render;
}

facet_result facet_sea_render(const facet_sea *sea, const facet_scene *scene,
                              const facet_sea_render_desc *desc, facet_image **image, facet_error *error)
{
    const facet_render_desc render = in_sea(sea, desc);
    return facet_render(scene, &render, image, error);
}

facet_result facet_sea_meter(const facet_sea *sea, const facet_sea_render_desc *desc, double *ev100,
                             facet_error *error)
{
    *ev100 = 0.0;
    facet_renderer *renderer;
    const facet_render_desc render = in_sea(sea, desc);
    TRY(facet_renderer_create(NULL, &render.allocator, &renderer, error));
    facet_result result = facet_renderer_meter(renderer, &render, ev100, error);
    facet_renderer_destroy(renderer);
    return result;
}

float facet_exposure_from_ev100(double ev100)
{
    return (float)meter_exposure_ev(ev100);
}
