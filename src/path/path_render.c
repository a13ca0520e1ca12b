/* path_render.c - see path_render.h. Pixels are independent of each other: a pixel's samples are numbered,
 * and a pass draws all pixels up to one number. The image depends on these numbers alone. */
#include "path/path_render.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "draw/render_watch.h"
#include "cpu/tiles.h"
#include "film/film.h"
#include "film/matte.h"
#include "path/path_checkpoint.h"
#include "path/path_film.h"
#include "path/path_key.h"
#include "path/path_lights.h"
#include "scene/identity.h"

enum {
    TILE = 16,          /* pixels along a side */
    MAX_PASS = 16,      /* samples per pixel */
    SHUTTER_SAMPLES = 4 /* per pixel and instant: preparing one costs about as much as these */
};

/* The rendering of one image. */
typedef struct path_job {
    const facet_render_desc *desc;
    prepared_scene *prepared;
    const struct path_surface *surface;
    film *target;
    facet_render_stats *stats;
    double deadline_s;
    path_film *sums;
    uint32_t first, end; /* samples of a pixel, numbered from 0 */
    path_key key;
    double saved_s; /* when the checkpoint was written, or rendering begun */
    float ground_y;
    matte_layers mattes; /* of target; sums until resolve_film() */
    /* of one instant of the shutter */
    facet_render_desc instant; /* desc at its time */
    render_setup setup;
    path_lights *lights;
    path_scene scene;
    /* of one pass */
    uint32_t goal; /* samples per pixel after the pass */
    /* sample count of the pixels that are drawn; 0: those of path_film_needs_more() */
    uint32_t cut_off_at;
    uint32_t tile_columns;
    render_watch watch;
    _Atomic uint64_t rays;
} path_job;

/* ---- a pass ---- */

/* Draws one pixel up to the goal. Returns the number of rays. */
static uint64_t draw_pixel(path_job *p, uint32_t x, uint32_t y, size_t pixel)
{
    uint64_t rays = 0;
    const uint32_t *crop = p->desc->crop;
    for (uint32_t i = p->first + path_film_samples(p->sums, pixel); i < p->goal; i++) {
        path_sample sample;
        path_trace(&p->scene, crop[0] + x, crop[1] + y, i, &sample);
        path_film_add(p->sums, pixel, &sample);
        if (p->mattes.aovs && sample.first_share != 0.0f)
            matte_add(&p->mattes, pixel, p->setup.identities[sample.first_geometry].hashes,
                      sample.first_share);
        rays += sample.rays;
    }
    return rays;
}

static void draw_tile(path_job *p, uint32_t tile)
{
    uint32_t left = tile % p->tile_columns * TILE;
    uint32_t top = tile / p->tile_columns * TILE;
    uint32_t right = left + TILE < p->target->width ? left + TILE : p->target->width;
    uint32_t bottom = top + TILE < p->target->height ? top + TILE : p->target->height;
    uint64_t rays = 0;
    uint64_t done = 0;
    for (uint32_t y = top; y < bottom; y++) {
        render_watch_look(&p->watch);
        if (render_watch_is_stopped(&p->watch))
            break;
        for (uint32_t x = left; x < right; x++) {
            size_t pixel = (size_t)y * p->target->width + x;
            uint32_t before = p->first + path_film_samples(p->sums, pixel);
            if (p->cut_off_at ? before == p->cut_off_at : path_film_needs_more(p->sums, pixel))
                rays += draw_pixel(p, x, y, pixel);
            done += p->goal > before ? p->goal - before : 0;
        }
    }
    atomic_fetch_add(&p->rays, rays);
    render_watch_add(&p->watch, done);
}

static void draw_tiles(void *context, size_t begin, size_t end)
{
    path_job *p = context;
    for (size_t tile = begin; tile < end; tile++) {
        if (render_watch_is_stopped(&p->watch))
            return;
        draw_tile(p, (uint32_t)tile);
    }
}

static void draw_pass(path_job *p, uint32_t goal)
{
    p->goal = goal;
    uint32_t rows = (p->target->height + TILE - 1) / TILE;
    p->tile_columns = (p->target->width + TILE - 1) / TILE;
    parallel_for(p->desc->thread_count, (size_t)rows * p->tile_columns, 1, draw_tiles, p);
}

/* ---- an instant ---- */

static void end_instant(path_job *p)
{
    path_lights_destroy(p->lights);
    p->lights = NULL;
    render_setup_destroy(&p->setup);
    p->setup = (render_setup){0};
}

static facet_result begin_instant(path_job *p, facet_error *error)
{
    const facet_render_desc *desc = &p->instant;
    end_instant(p);
    p->setup = (render_setup){.prepared = p->prepared,
                              .desc = desc,
                              .stats = p->stats,
                              .reads_everywhere = true,
                              .samples_light = true};
    TRY(render_setup_create(&p->setup, error));
    TRY(path_lights_create(&p->setup, &p->lights, error));
    p->scene = (path_scene){.setup = &p->setup,
                            .lights = p->lights,
                            .has_ground = desc->ground == FACET_GROUND_SHADOW,
                            .ground_y = p->ground_y,
                            .draws_background = desc->background == FACET_BACKGROUND_ENVIRONMENT,
                            .surface = p->surface,
                            .finds_first = p->mattes.aovs != 0};
    if (p->surface)
        p->scene.max_radiance = desc->sea_shading.clamp * exp2f(-desc->exposure_ev);
    return FACET_OK;
}

/* The time of instant i as a share of the shutter's: the sequence 0.5, 0.25, 0.75, .. covers it evenly for
 * any number of instants. */
static double shutter_share(uint32_t i)
{
    double share = 0.0;
    double bit = 0.5;
    for (uint32_t n = i + 1; n; n >>= 1, bit *= 0.5)
        share += n & 1 ? bit : 0.0;
    return share;
}

/* The sample count at which the current pass of a pixel with `goal` samples ends: 1, 2, 4, .. MAX_PASS,
 * and its multiples, independent of where an image was begun or interrupted. */
static uint32_t next_goal(const path_job *p, uint32_t goal)
{
    uint32_t step = MAX_PASS;
    if (p->desc->path.shutter_s > 0.0f)
        step = SHUTTER_SAMPLES;
    else if (goal < MAX_PASS)
        for (step = 1; step <= goal;)
            step *= 2;
    uint64_t next = ((uint64_t)goal / step + 1) * step;
    return next < p->end ? (uint32_t)next : p->end;
}

static facet_result next_instant(path_job *p, uint32_t goal, facet_error *error)
{
    bool is_moving = p->desc->path.shutter_s > 0.0f;
    if (p->lights && !is_moving)
        return FACET_OK;
    if (is_moving)
        p->instant.pose.time_s =
            p->desc->pose.time_s + (double)p->desc->path.shutter_s * shutter_share(goal / SHUTTER_SAMPLES);
    return begin_instant(p, error);
}

/* ---- checkpoints ---- */

/* A checkpoint that cannot be written is a warning. */
static void save(path_job *p)
{
    const char *path = p->desc->path.checkpoint_path;
    facet_error error;
    p->saved_s = clock_seconds();
    if (!path)
        return;
    p->stats->has_lost_checkpoint =
        path_film_save(p->sums, p->key.hex, path, p->desc->thread_count, &error) != FACET_OK;
    if (p->stats->has_lost_checkpoint && p->desc->log.message)
        p->desc->log.message(p->desc->log.user, FACET_LOG_LEVEL_WARNING, error.message);
}

static void save_from_time_to_time(path_job *p)
{
    double interval = p->desc->path.checkpoint_interval_s;
    if (clock_seconds() - p->saved_s > (interval > 0.0 ? interval : 60.0))
        save(p);
}

static facet_result resume(path_job *p, facet_error *error)
{
    p->saved_s = clock_seconds();
    if (!p->desc->path.checkpoint_path)
        return FACET_OK;
    const char *path = p->desc->path.checkpoint_path;
    bool exists = false;
    TRY(path_key_create(p->prepared, p->desc, &p->key, error));
    return p->desc->path.resumes ? path_film_load(p->sums, p->key.hex, path, &exists, error)
                                 : path_checkpoint_check(path, error);
}

/* ---- the image ---- */

typedef struct sample_range {
    uint32_t fewest, most; /* of any pixel */
} sample_range;

static sample_range count_samples(const path_job *p)
{
    sample_range range = {.fewest = UINT32_MAX};
    for (size_t i = 0; i < (size_t)p->target->width * p->target->height; i++) {
        uint32_t n = p->first + path_film_samples(p->sums, i);
        range.fewest = n < range.fewest ? n : range.fewest;
        range.most = n > range.most ? n : range.most;
    }
    return range;
}

/* The sample count at which the passes of a checkpoint resume. Adaptive ones where the last one ended, so
 * that regions are judged at the same counts as without the interruption; others at the smallest, since
 * the samples of an open shutter belong to their instant. */
static uint32_t first_goal(const path_job *p)
{
    sample_range range = count_samples(p);
    bool is_adaptive = p->desc->path.noise > 0.0f && range.most < p->end;
    return is_adaptive ? range.most : range.fewest;
}

/* Whether regions are judged before the pass that begins at goal. A pass in which an earlier, shorter
 * render ended is first completed. */
static bool judges_at(const path_job *p, uint32_t goal)
{
    if (p->desc->path.shutter_s > 0.0f)
        return goal % SHUTTER_SAMPLES == 0;
    return goal % MAX_PASS == 0 || (goal < MAX_PASS && (goal & (goal - 1)) == 0);
}

/* Selects the pixels of the next pass: those that are still noisy, or those that an interrupted pass left
 * out. True: none is noisy. */
static bool judge(path_job *p, uint32_t goal)
{
    p->cut_off_at = 0;
    if (p->desc->path.noise > 0.0f && !judges_at(p, goal)) {
        p->cut_off_at = goal;
        return false;
    }
    path_film_update(p->sums, p->desc->path.noise, p->desc->thread_count);
    return path_film_share_done(p->sums) >= 1.0f;
}

/* Calls desc->path.pass, without an image: the caller has the film. Denoising takes its time and is not
 * worth it before the noise has halved; the shadow on the ground stays noisy, since its filter is for
 * films that get no more samples. */
static void report_pass(path_job *p, uint32_t goal)
{
    const facet_path_desc *path = &p->desc->path;
    bool is_power_of_two = (goal & (goal - 1)) == 0;
    if (!path->pass || goal >= p->desc->samples || (path->denoises && !is_power_of_two))
        return;
    float scale = exp2f(p->desc->exposure_ev);
    path_film_resolve(p->sums, scale, p->target, p->desc->thread_count);
    if (path->denoises && goal > 1 && path_film_denoise(p->sums, p->desc, scale, p->target, NULL) != FACET_OK)
        return;
    path->pass(path->pass_user, NULL, goal);
}

/* Draws pass after pass until all is done, or the watch stops. */
static facet_result draw_passes(path_job *p, facet_error *error)
{
    uint32_t goal = first_goal(p);
    while (goal < p->end && !render_watch_is_stopped(&p->watch)) {
        if (judge(p, goal))
            break;
        TRY(next_instant(p, goal, error));
        goal = next_goal(p, goal);
        draw_pass(p, goal);
        if (!render_watch_is_stopped(&p->watch)) {
            save_from_time_to_time(p);
            report_pass(p, goal);
        }
    }
    return FACET_OK;
}

/* Maps the reason that ended the passes to a result. The time limit, and a cancellation with
 * keeps_cancelled, leave an image where each pixel has a sample; a part has all of its samples. */
static facet_result conclude(path_job *p, facet_error *error)
{
    facet_result ended = (facet_result)atomic_load(&p->watch.result);
    save(p);
    if (ended == FACET_OK)
        return FACET_OK;
    bool is_limit = ended == FACET_ERROR_LIMIT;
    if (p->target->keeps_sums ||
        (!is_limit && !(ended == FACET_ERROR_CANCELLED && p->desc->path.keeps_cancelled)))
        return render_watch_explain(&p->watch, error);
    if (count_samples(p).fewest == p->first)
        return fail(error, ended, "%s before every pixel had a sample; there is no image",
                    is_limit ? "the time limit was reached" : "interrupted");
    p->stats->is_partial = true;
    return FACET_OK;
}

static facet_result draw(path_job *p, facet_error *error)
{
    double start = clock_seconds();
    const facet_render_desc *desc = p->desc;
    TRY(resume(p, error));
    uint64_t pixel_count = (uint64_t)p->target->width * p->target->height;
    render_watch_init(&p->watch, &desc->progress, "sample", p->deadline_s,
                      (double)pixel_count * (double)(p->end - p->first));
    atomic_store(&p->watch.done, path_film_total_samples(p->sums));
    facet_result result = draw_passes(p, error);
    if (result == FACET_OK)
        result = conclude(p, error);
    p->stats->shade_s = clock_seconds() - start;
    return result;
}

/* ---- the result ---- */

/* Draws the layers that are not means over samples: those of the first instant. */
static facet_result draw_aovs(path_job *p, facet_error *error)
{
    facet_render_desc desc = *p->desc;
    desc.aovs &= ~(uint32_t)(PATH_FILM_AOVS | FACET_AOV_CRYPTOMATTE);
    if (!desc.aovs)
        return FACET_OK;
    tiles_desc tiles = {.render = &desc, .scene = &p->setup.shading, .identities = p->setup.identities};
    return tiles_draw_aovs(&tiles, p->target, p->stats, error);
}

static void warn_dropped(const path_job *p)
{
    const facet_log *log = &p->desc->log;
    if (p->stats->dropped_samples == 0 || !log->message)
        return;
    char message[256];
    snprintf(message, sizeof message,
             "%llu of %llu light samples were not finite and count as black: a value of the model or of a "
             "light is not finite",
             (unsigned long long)p->stats->dropped_samples, (unsigned long long)p->stats->samples);
    log->message(log->user, FACET_LOG_LEVEL_WARNING, message);
}

/* Counts the samples, and makes the layers of them; a part keeps the samples' sums. */
static facet_result resolve_film(path_job *p, facet_error *error)
{
    p->stats->samples = path_film_total_samples(p->sums);
    p->stats->dropped_samples = path_film_dropped(p->sums);
    p->stats->rays += atomic_load(&p->rays);
    warn_dropped(p);
    if (!p->target->keeps_sums)
        return path_film_finish(p->sums, p->desc, p->target, &p->stats->denoise_s, error);
    path_film_give_layers(p->sums, p->target);
    return FACET_OK;
}

/* All of it; the caller releases what p holds. *has_setup: the first instant was prepared. */
static facet_result render_image(path_job *p, bool *has_setup, facet_error *error)
{
    const facet_render_desc *desc = p->desc;
    TRY(render_check_limits(desc, "prepare", 0.0, p->deadline_s, error));
    TRY(prepared_scene_pose(p->prepared, desc, error));
    p->ground_y = p->prepared->pose.bounds_min[1];
    TRY(begin_instant(p, error));
    *has_setup = true;
    TRY(path_film_create(&desc->allocator, p->target->width, p->target->height, p->scene.has_ground, &p->sums,
                         error));
    path_film_set_scale(p->sums, exp2f(desc->exposure_ev));
    TRY(draw_aovs(p, error));
    TRY(draw(p, error));
    TRY(resolve_film(p, error));
    return p->stats->is_partial ? FACET_OK : render_check_limits(desc, "sample", 1.0, 0.0, error);
}

static facet_result attempt(const void *surface, prepared_scene *prepared, const facet_render_desc *desc,
                            double deadline_s, film *target, facet_render_stats *stats, bool *has_setup,
                            facet_error *error)
{
    *stats = (facet_render_stats){.thread_count = desc->thread_count};
    *has_setup = false;
    path_job p = {.desc = desc,
                  .instant = *desc,
                  .prepared = prepared,
                  .surface = surface,
                  .target = target,
                  .stats = stats,
                  .end = desc->samples,
                  .mattes = matte_find(target),
                  .deadline_s = deadline_s};
    if (desc->part.count && desc->part.split == FACET_PART_SPLIT_SAMPLES)
        path_part_get_samples(&desc->part, desc->samples, &p.first, &p.end);
    matte_clear(&p.mattes, (size_t)target->width * target->height); /* a failed attempt may have filled it */
    facet_result result = render_image(&p, has_setup, error);
    path_film_destroy(p.sums);
    end_instant(&p);
    return result;
}

facet_result path_render_prepared(prepared_scene *p, const facet_render_desc *desc,
                                  const struct path_surface *surface, film *target, facet_render_stats *stats,
                                  facet_error *error)
{
    return render_with_prepared(attempt, surface, p, desc, target, stats, error);
}
