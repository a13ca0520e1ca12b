/* gl_sea_block.c - see gl_sea_block.h. Values far from the origin are made relative to the eye here, in
 * double. */
#include "gl/sea/gl_sea_block.h"

#include <math.h>
#include <string.h>

#include "ocean/wave_patches.h"

#include "shade/shade.h"

static const float MAX_DISTANCE_M = 1e7f; /* as in water_trace.c */

static void set4(float to[4], const float xyz[3], float w)
{
    memcpy(to, xyz, 3 * sizeof *to);
    to[3] = w;
}

/* In [0, size). */
static float wrapped(double samples, uint32_t size)
{
    double rest = samples - (double)size * floor(samples / (double)size);
    return rest < (double)size ? (float)rest : 0.0f;
}

static void fill_tiles(const water_frame *p, const double eye[2], gl_sea_block *b)
{
    const waves *w = &p->sea->waves;
    for (uint32_t i = 0; i < w->tile_count; i++) {
        const wave_tile *t = &w->tiles[i];
        const float axes[4] = {t->cos_turn, t->sin_turn, (float)t->samples_per_m,
                               t->is_patched ? 1.0f : 0.0f};
        memcpy(b->axes[i], axes, sizeof axes);
        wave_rhombus at = wave_rhombus_at(t, eye[0], eye[1]);
        const float places[4] = {wrapped(eye[0] * t->cos_per_m + eye[1] * t->sin_per_m, t->size),
                                 wrapped(eye[1] * t->cos_per_m - eye[0] * t->sin_per_m, t->size), at.a, at.b};
        memcpy(b->places[i], places, sizeof places);
        b->lengths[i][0] = (float)(1.0 / t->length_m);
        b->lengths[i][1] = (float)(i * GL_SEA_PATCHES);
    }
    b->counts[0] = (int32_t)w->tile_count;
    b->counts[1] = w->tile_count ? (int32_t)w->tiles[0].level_count : 1;
    b->counts[2] = w->tile_count ? (int32_t)w->tiles[0].size : 1;
}

static void fill_slopes(const water_frame *p, gl_sea_block *b)
{
    const slope_filter *f = &p->sea->slopes;
    for (int i = 0; i < GL_SEA_FOOTPRINTS; i++) {
        const slope_covariance *c = &f->residual[i];
        const float residual[4] = {c->xx, c->zz, c->xz};
        memcpy(b->residual[i], residual, sizeof residual);
        b->moments[i][0] = f->curvature[i];
        b->moments[i][1] = f->rate[i];
    }
    const float total[3] = {f->total.xx, f->total.zz, f->total.xz};
    set4(b->total, total, p->roughness[0] >= 0.0f ? 1.0f : 0.0f);
    set4(b->rough, p->roughness, 0.0f);
}

static void fill_foam(const water_frame *p, const double eye[2], gl_sea_block *b)
{
    if (!p->foam)
        return;
    const waves_foam *f = p->foam;
    for (uint32_t i = 0; i < FOAM_READINGS; i++) {
        const foam_reading *r = &f->readings[i];
        const float axes[4] = {(float)r->along[0], (float)r->along[1], (float)r->across[0],
                               (float)r->across[1]};
        const float at[4] = {wrapped(eye[0] * r->along[0] + eye[1] * r->along[1], f->share.size),
                             wrapped(eye[0] * r->across[0] + eye[1] * r->across[1], f->share.size),
                             log2f(r->samples_per_m), r->weight};
        memcpy(b->foam_axes[i], axes, sizeof axes);
        memcpy(b->foam_places[i], at, sizeof at);
    }
    for (uint32_t level = 0; level < f->share.level_count; level++)
        for (uint32_t i = 0; i < FOAM_PATTERNS; i++)
            b->foam_hidden[level][1 + i] = f->patterns[i].hidden[level];
}

static void fill_water(const water_frame *p, gl_sea_block *b)
{
    const water_optics *o = &p->sea->optics;
    const facet_sea_shading *shading = &p->desc->sea_shading;
    set4(b->absorption, o->absorption, o->ior);
    set4(b->scattering, o->scattering, o->foam_albedo);
    set4(b->backscattering, o->backscattering,
         (float)(shading->normals == FACET_SEA_NORMALS_GGX ? WATER_GGX : WATER_BECKMANN));
    set4(b->reflectance, o->reflectance, (float)shading->masking);
    set4(b->pure_share, o->pure_share, shading->has_schlick_fresnel ? 1.0f : 0.0f);
    set4(b->sun, p->L, p->sun_fresnel);
    set4(b->sun_irradiance, p->sun_irradiance, p->sky_reflectance);
    set4(b->sky_irradiance, p->sky_irradiance, waves_glint_time(&p->sea->waves));
    set4(b->downwelling, p->downwelling, p->shutter_s);
    set4(b->beam, p->beam, p->disc_radius);
    set4(b->sunward, p->sunward, 0.0f);
    b->sky_at[0] = p->horizon_mu;
    set4(b->crest_beam, p->crest_beam, p->crest_wavenumber);
    set4(b->crest_sunward, p->crest_sunward, p->crest_amplitude_m);
    b->sky_at[1] = SEA_SKY_DISTANCE_KM;
}

static void fill_bed(const water_frame *p, const double eye[2], gl_sea_block *b)
{
    const facet_sea_bed *bed = &p->sea->desc.bed;
    double x = (double)bed->slope * (double)cos(bed->direction_rad),
           z = (double)bed->slope * (double)sin(bed->direction_rad);
    set4(b->bed, bed->albedo, (float)((double)bed->depth_m - x * eye[0] - z * eye[1]));
    b->bed_slope[0] = (float)x;
    b->bed_slope[1] = (float)z;
}

static void fill_caustics(const caustic_map *map, const double eye[2], gl_sea_block *b)
{
    if (!map)
        return;
    const float axis[4] = {map->axis[0], map->axis[1], 1.0f, 0.0f};
    memcpy(b->caustic_axis, axis, sizeof axis);
    for (int i = 0; i < CAUSTIC_LAYERS; i++) {
        const caustic_layer *l = &map->layers[i];
        const float layer[4] = {(float)(l->middle[0] - eye[0]), (float)(l->middle[1] - eye[1]),
                                2.0f / (l->texel_m * CAUSTIC_SIZE), l->texel_m};
        memcpy(b->caustics[i], layer, sizeof layer);
    }
}

static void fill_style(const facet_sea_shading *shading, gl_sea_block *b)
{
    const WaterStyle style = sea_water_style(shading);
    b->bed_slope[2] = style.perceptual_roughness;
    b->bed_slope[3] = shading->clamp;
    b->style[0] = style.stage;
    b->style[1] = style.variant;
    b->style[2] = style.has_foam;
    b->style[3] = style.has_sparkles;
}

void gl_sea_block_fill(const water_frame *p, const camera_rays *camera, const gl_sea_fan *fan,
                       gl_sea_block *b)
{
    const double eye[2] = {(double)camera->origin[0], (double)camera->origin[2]};
    uint32_t samples = p->desc->samples ? p->desc->samples : 1;
    *b = (gl_sea_block){
        .eye = {camera->origin[1], (float)p->fall, p->deviation_m, p->sea->waves.level_m},
        .ray = {camera->pixel_size, inversesqrt((float)samples), fan->near_m, 0.0f},
        .clip = {camera->near_m, fminf(camera->far_m, MAX_DISTANCE_M)},
        .fan = {fan->azimuth, fan->half_azimuth, fan->first_m, fan->step},
        .fan_ends = {(float)fan->columns, (float)(fan->wave_rows - 1), (float)fan->rows, fan->ratio},
        .fan_level = {(float)fan->level_row, fan->level_m},
        .shift = {fan->shift[0], fan->shift[1], fan->farthest_m, fan->width_rad}};
    fill_tiles(p, eye, b);
    fill_slopes(p, b);
    fill_foam(p, eye, b);
    fill_water(p, b);
    fill_bed(p, eye, b);
    fill_caustics(p->caustics, eye, b);
    fill_style(&p->desc->sea_shading, b);
}
