/* ground_shadow.c - see ground_shadow.h. All points of the ground have one normal, so that one set of directions,
 * drawn in proportion to the light that arrives from them, serves all pixels. Each pixel traces a sixteenth of it, and
 * a kernel in which all sixteen parts have the same weight joins the pixels around (interleaved sampling, Keller and
 * Heidrich 2001). There is no noise: the same direction in each fourth pixel gives the same shadow, displaced. */
#include "cpu/ground_shadow.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "cpu/media.h"
#include "cpu/pixel.h"
#include "cpu/ray_trace.h"
#include "draw/render_watch.h"

enum {
    TABLE_COLUMNS = 256, /* of the environment's light on the ground */
    TABLE_ROWS = 64,
    MARGIN = 6, /* that the filters reach */
    GRAIN_ROWS = 4
};

/* Interleaved sampling (Keller and Heidrich 2001): each pixel of a square of 4 x 4 has its own part of a set of samples. */
enum { INTERLEAVE_SIDE = 4, INTERLEAVE_PARTS = INTERLEAVE_SIDE * INTERLEAVE_SIDE };

/* The part of a pixel: neighbors have parts that are far apart. Bayer 1973. */
static uint32_t interleave_part(uint32_t x, uint32_t y)
{
    static const uint8_t parts[INTERLEAVE_SIDE][INTERLEAVE_SIDE] = {
        {0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
    return parts[y % INTERLEAVE_SIDE][x % INTERLEAVE_SIDE];
}

/* Weights of the pixels -2 .. 2 away along an axis: of those with the same part together 1/4. */
static const float INTERLEAVE_WEIGHTS[5] = {0.125f, 0.25f, 0.25f, 0.25f, 0.125f};

/* Of the hidden share, that the filter removes. */
static const float STEP = 0.05f;

/* Rays per pixel, by what they are distributed as: powers of two. */
static const struct ray_counts {
    uint32_t light, cosine;
} RAYS[] = {
    [FACET_QUALITY_NORMAL] = {8, 4}, [FACET_QUALITY_DRAFT] = {4, 2}, [FACET_QUALITY_FINAL] = {32, 16}};

/* A direction of the hemisphere with its weights in the light on the ground, which add up to the share that is hidden:
 * blocked for the environment's light from there, less reflected times the radiance of what blocks it. */
typedef struct sky_ray {
    vec3 direction; /* unit */
    float blocked, reflected;
} sky_ray;

typedef struct ground_job {
    const ground_shadow_desc *desc;
    film *target;
    uint32_t left, top, width, height; /* the crop and MARGIN pixels around it, within the image */
    const struct ray_counts *counts;
    uint32_t rays;          /* per pixel, of both kinds */
    sky_ray *sky_rays;      /* INTERLEAVE_PARTS * rays */
    float sky;              /* illuminance by the environment, lx */
    ray_spread wide;        /* for colors that the ground receives */
    float *hidden, *smooth; /* shares of the light, per pixel */
    bool *is_wanted;        /* near a pixel in which the ground is visible */
    const float *from;
    float *to;
    bool is_along_x;
    render_watch watch;
    _Atomic uint64_t rays_traced;
} ground_job;

/* ---- directions of the environment's light ---- */

static float light_from(const light_setup *light, vec3 D)
{
    float d[3];
    float radiance[3];
    store3(D, d);
    light_background(light, d, 0.0f, radiance);
    float l = luminance(load3(radiance));
    return l > 0.0f && l < INFINITY ? l : 0.0f;
}

static vec3 upward(vec2 u)
{
    vec3 d = sample_cosine(u);
    return vec3(d[0], d[2], d[1]);
}

/* The place of x in a cumulative distribution of count steps, in [0, 1). */
static float invert(const float *sums, uint32_t count, float x)
{
    float wanted = x * sums[count];
    uint32_t low = 0;
    uint32_t high = count;
    while (high - low > 1) {
        uint32_t middle = (low + high) / 2;
        if (sums[middle] <= wanted)
            low = middle;
        else
            high = middle;
    }
    float step = sums[low + 1] - sums[low];
    float within = step > 0.0f ? clamp((wanted - sums[low]) / step, 0.0f, 1.0f) : 0.5f;
    return ((float)low + within) / (float)count;
}

/* The light on the ground over the square that sample_cosine() maps to the hemisphere, in which equal areas count
 * alike: cumulative over the rows (the elevation), and over the columns of each. */
typedef struct light_table {
    float rows[TABLE_ROWS + 1];
    float columns[TABLE_ROWS][TABLE_COLUMNS + 1];
} light_table;

static void fill_table(light_table *t, const light_setup *light)
{
    t->rows[0] = 0.0f;
    for (uint32_t y = 0; y < TABLE_ROWS; y++) {
        t->columns[y][0] = 0.0f;
        for (uint32_t x = 0; x < TABLE_COLUMNS; x++) {
            vec2 u = vec2(((float)x + 0.5f) / (float)TABLE_COLUMNS, ((float)y + 0.5f) / (float)TABLE_ROWS);
            t->columns[y][x + 1] = t->columns[y][x] + light_from(light, upward(u));
        }
        t->rows[y + 1] = t->rows[y] + t->columns[y][TABLE_COLUMNS];
    }
}

/* The radiance in the table at a point of the square. */
static float table_radiance(const light_table *t, vec2 u)
{
    uint32_t x = (uint32_t)min(u[0] * (float)TABLE_COLUMNS, (float)TABLE_COLUMNS - 1.0f);
    uint32_t y = (uint32_t)min(u[1] * (float)TABLE_ROWS, (float)TABLE_ROWS - 1.0f);
    return t->columns[y][x + 1] - t->columns[y][x];
}

/* Some rays are distributed as the light is, the others as the cosine, as is the light that the model reflects; both
 * count by the balance heuristic (Veach and Guibas 1995). Those of a pixel and those of a cell are nets of Sobol's
 * sequence. mean: of the radiance. */
static void draw_rays(ground_job *p, const light_table *t, float mean)
{
    const struct ray_counts *n = p->counts;
    for (uint32_t i = 0; i < INTERLEAVE_PARTS * p->rays; i++) {
        uint32_t part = i / p->rays;
        uint32_t k = i % p->rays;
        bool is_cosine = k >= n->light;
        vec2 u = is_cosine ? sobol_scrambled(part * n->cosine + k - n->light, 0x6f1d3b95u)
                           : sobol_scrambled(part * n->light + k, 0x2c1b3c6du);
        if (!is_cosine) {
            u[1] = invert(t->rows, TABLE_ROWS, u[1]);
            uint32_t row = (uint32_t)min(u[1] * (float)TABLE_ROWS, (float)TABLE_ROWS - 1.0f);
            u[0] = invert(t->columns[row], TABLE_COLUMNS, u[0]);
        }
        float L = table_radiance(t, u);
        float density = (float)n->light * L + (float)n->cosine * mean;
        p->sky_rays[i] =
            (sky_ray){.direction = upward(u), .blocked = L / density, .reflected = 1.0f / density};
    }
}

static facet_result find_rays(ground_job *p, facet_error *error)
{
    const light_setup *light = p->desc->scene->light;
    if (!light->has_background)
        return FACET_OK;
    light_table *table = mem_alloc(&p->desc->render->allocator, 1, sizeof *table);
    if (!table)
        return fail_memory(error, "the light on the ground", sizeof *table);
    fill_table(table, light);
    float mean = table->rows[TABLE_ROWS] / (float)(TABLE_ROWS * TABLE_COLUMNS);
    if (mean > 0.0f)
        draw_rays(p, table, mean);
    p->sky = mean * PI;
    mem_free(table);
    return FACET_OK;
}

/* ---- light that the model reflects ---- */

/* The base color at a hit, over a footprint of a few percent of the model. */
static float albedo_at(const ground_job *p, const visibility_hit *hit, const shading_ray *ray)
{
    const shading_scene *scene = p->desc->scene;
    if (scene->geometries->items[hit->geometry].primitive->mode != SCENE_TRIANGLES)
        return 0.0f;
    shading_ray wide = *ray;
    wide.spread = &p->wide;
    wide.footprint = 1.0f;
    shading_point point = {.hit = hit, .ray = &wide};
    shading_hit h = shading_hit_make(scene, &point);
    float base_color[4];
    surface_base_color(scene, &h, &scene->plans->items[hit->geometry], base_color);
    return clamp(luminance(load3(base_color)), 0.0f, 1.0f);
}

/* Luminance of what blocks a ray: a diffuse surface in the environment. */
static float reflected(const ground_job *p, const shading_ray *ray)
{
    const shading_scene *scene = p->desc->scene;
    visibility_hit hit;
    float N[3];
    float irradiance[3];
    if (!ray_trace_nearest(scene, ray, 0, &hit))
        return 0.0f;
    vec3 normal = load3(hit.normal);
    store3(normalize(dot(normal, load3(ray->direction)) > 0.0f ? -normal : normal), N);
    light_irradiance_over_pi(scene->light, N, irradiance);
    return albedo_at(p, &hit, ray) * luminance(load3(irradiance));
}

/* ---- one pixel ---- */

/* Where the ray through the middle of a pixel meets the ground, from above. */
static bool find_ground(const ground_job *p, uint32_t x, uint32_t y, vec3 *out)
{
    float origin[3];
    float direction[3];
    camera_rays_at(p->desc->scene->camera, (float)x + 0.5f, (float)y + 0.5f, origin, direction);
    float height = origin[1] - p->desc->height_m;
    if (!(height > 0.0f) || !(direction[1] < 0.0f))
        return false;
    vec3 P = load3(origin) - load3(direction) * (height / direction[1]);
    P[1] = p->desc->height_m;
    if (!(max3(abs(P)) < 1e15f))
        return false;
    P[1] += media_tolerance(max3(abs(P))); /* points of contact cast their shadow */
    *out = P;
    return true;
}

static shading_ray ray_from(vec3 P, vec3 L, float distance_m)
{
    static const ray_spread still = {.moves = false, .turns = false};
    shading_ray ray = {.far_t = distance_m, .spread = &still};
    store3(P, ray.origin);
    store3(L, ray.direction);
    return ray;
}

static float hidden_sky(const ground_job *p, vec3 P, uint32_t part)
{
    float hidden = 0.0f;
    for (uint32_t i = 0; i < p->rays; i++) {
        const sky_ray *sky = &p->sky_rays[part * p->rays + i];
        shading_ray ray = ray_from(P, sky->direction, INFINITY);
        float blocked = 1.0f - ray_trace_daylight(p->desc->scene, &ray);
        if (blocked > 0.0f)
            hidden += blocked * (sky->blocked - sky->reflected * reflected(p, &ray));
    }
    return hidden;
}

/* A direction to the sun's disc. */
static vec3 to_sun(const ground_job *p, vec3 L, uint32_t part)
{
    float diameter = p->desc->render->sun.diameter_rad;
    float radius = tan(0.5f * (diameter > 0.0f ? diameter : 0.00925f));
    vec2 u = sobol_scrambled(part, 0x51ed270bu);
    float r = radius * sqrt(u[0]);
    mat3 frame = basis_from_normal(L);
    return normalize(L + COL(frame, 0) * (r * cos(2.0f * PI * u[1])) +
                     COL(frame, 1) * (r * sin(2.0f * PI * u[1])));
}

/* Share of the light at P that the model blocks. */
static float hidden_at(ground_job *p, vec3 P, uint32_t part)
{
    const light_setup *light = p->desc->scene->light;
    float open = p->sky;
    float blocked = p->sky > 0.0f ? p->sky * hidden_sky(p, P, part) : 0.0f;
    uint64_t rays = p->sky > 0.0f ? p->rays : 0;
    if (light->punctual_count) {
        const float *lux = p->desc->render->sun.illuminance_lux;
        uint32_t sun = lux[0] + lux[1] + lux[2] > 0.0f ? light->punctual_count - 1 : UINT32_MAX;
        float point[3];
        uint32_t i;
        store3(P, point);
        for (light_cursor c = light_grid_at(&light->grid, point); light_cursor_next(&c, &i);) {
            LightSample l = light_illuminate(light->punctual[i], P);
            float E = luminance(l.E) * max(l.L[1], 0.0f);
            if (!(E > 0.0f))
                continue;
            open += E;
            shading_ray ray = ray_from(P, i == sun ? to_sun(p, l.L, part) : l.L,
                                       l.distance_m < 1e30f ? l.distance_m : INFINITY);
            blocked += E * (1.0f - ray_trace_daylight(p->desc->scene, &ray));
            rays++;
        }
    }
    atomic_fetch_add_explicit(&p->rays_traced, rays, memory_order_relaxed);
    return open > 0.0f ? blocked / open : 0.0f; /* clamped after the kernel */
}

/* ---- the image ---- */

static float fade_at(const ground_job *p, uint32_t x, uint32_t y)
{
    const facet_render_desc *render = p->desc->render;
    return ground_fade(
        vec2(((float)x + 0.5f) / (float)render->width, ((float)y + 0.5f) / (float)render->height));
}

static void trace_rows(void *context, size_t begin, size_t end)
{
    ground_job *p = context;
    for (size_t row = begin; row < end; row++) {
        render_watch_look(&p->watch);
        for (uint32_t column = 0; column < p->width && !render_watch_is_stopped(&p->watch); column++) {
            size_t i = row * p->width + column;
            uint32_t x = p->left + column;
            uint32_t y = p->top + (uint32_t)row;
            vec3 P;
            p->hidden[i] = 0.0f;
            if (p->is_wanted[i] && find_ground(p, x, y, &P))
                p->hidden[i] = hidden_at(p, P, interleave_part(x, y));
        }
    }
}

/* The value at an offset, within the area. */
static const float *value_near(const ground_job *p, uint32_t column, size_t row, int dx, int dy)
{
    int64_t x = (int64_t)column + dx;
    int64_t y = (int64_t)row + dy;
    x = x < 0 ? 0 : x >= p->width ? p->width - 1 : x;
    y = y < 0 ? 0 : y >= p->height ? p->height - 1 : y;
    return &p->from[(size_t)y * p->width + (size_t)x];
}

/* One axis of the kernel in which every residue of CELL has the weight 1 / 4: half of each end. */
static void smooth_rows(void *context, size_t begin, size_t end)
{
    const ground_job *p = context;
    for (size_t row = begin; row < end; row++)
        for (uint32_t column = 0; column < p->width; column++) {
            float sum = 0.0f;
            for (int k = -2; k <= 2; k++)
                sum += INTERLEAVE_WEIGHTS[k + 2] *
                       *value_near(p, column, row, p->is_along_x ? k : 0, p->is_along_x ? 0 : k);
            p->to[row * p->width + column] = sum;
        }
}

/* A level of the a-trous wavelet: 5 x 5 taps of a B3 spline two pixels apart, without those that differ by more than
 * the steps that are left (Dammertz et al. 2010). */
static void level_rows(void *context, size_t begin, size_t end)
{
    static const float spline[3] = {0.375f, 0.25f, 0.0625f};
    const ground_job *p = context;
    for (size_t row = begin; row < end; row++)
        for (uint32_t column = 0; column < p->width; column++) {
            float here = p->from[row * p->width + column];
            float sum = 0.0f;
            float total = 0.0f;
            for (int y = -2; y <= 2; y++)
                for (int x = -2; x <= 2; x++) {
                    float there = *value_near(p, column, row, 2 * x, 2 * y);
                    float off = (there - here) * (1.0f / STEP);
                    float w = spline[abs(x)] * spline[abs(y)] / (1.0f + off * off * off * off);
                    sum += w * there;
                    total += w;
                }
            p->to[row * p->width + column] = sum / total;
        }
}

static void composite_rows(void *context, size_t begin, size_t end)
{
    const ground_job *p = context;
    const facet_render_desc *render = p->desc->render;
    float scale = exp2f(render->exposure_ev);
    for (size_t row = begin; row < end; row++)
        for (uint32_t column = 0; column < p->target->width; column++) {
            uint32_t x = render->crop[0] + column;
            uint32_t y = render->crop[1] + (uint32_t)row;
            float *rgba = p->target->layers[0].pixels + 4 * (row * p->target->width + column);
            size_t i = (size_t)(y - p->top) * p->width + (x - p->left);
            float passes = 1.0f - rgba[3];
            if (passes > 0.0f)
                rgba[3] += passes * clamp(p->smooth[i], 0.0f, 1.0f) * fade_at(p, x, y);
            if (render->background == FACET_BACKGROUND_ENVIRONMENT)
                pixel_add_background(p->desc->scene, render->background_blur, scale, x, y, rgba);
        }
}

/* Marks the pixels that the kernel reads for one in which the ground may be visible. */
static void mark_wanted(ground_job *p)
{
    const uint32_t *crop = p->desc->render->crop;
    const film *f = p->target;
    for (uint32_t row = 0; row < f->height; row++)
        for (uint32_t column = 0; column < f->width; column++) {
            if (!(f->layers[0].pixels[4 * ((size_t)row * f->width + column) + 3] < 1.0f))
                continue;
            uint32_t x = crop[0] + column - p->left;
            uint32_t y = crop[1] + row - p->top;
            for (uint32_t b = y > MARGIN ? y - MARGIN : 0; b <= y + MARGIN && b < p->height; b++)
                for (uint32_t a = x > MARGIN ? x - MARGIN : 0; a <= x + MARGIN && a < p->width; a++)
                    p->is_wanted[(size_t)b * p->width + a] = true;
        }
}

/* The crop and a margin around it. */
static void find_area(ground_job *p)
{
    const facet_render_desc *render = p->desc->render;
    const uint32_t *crop = render->crop;
    uint32_t right = crop[0] + p->target->width + MARGIN;
    uint32_t bottom = crop[1] + p->target->height + MARGIN;
    p->left = crop[0] > MARGIN ? crop[0] - MARGIN : 0;
    p->top = crop[1] > MARGIN ? crop[1] - MARGIN : 0;
    p->width = (right < render->width ? right : render->width) - p->left;
    p->height = (bottom < render->height ? bottom : render->height) - p->top;
}

static void filter(ground_job *p, void (*rows)(void *, size_t, size_t), const float *from, float *to)
{
    p->from = from;
    p->to = to;
    parallel_for(p->desc->render->thread_count, p->height, GRAIN_ROWS, rows, p);
}

/* A thirtieth of the model's height along each axis. */
static void find_spread(ground_job *p)
{
    float size = p->desc->model_size_m * (1.0f / 30.0f);
    p->wide = (ray_spread){.origin_dx = {size, 0.0f, size}, .origin_dy = {0.0f, size, 0.0f}, .moves = true};
}

static facet_result draw(ground_job *p, facet_error *error)
{
    uint32_t threads = p->desc->render->thread_count;
    TRY(find_rays(p, error));
    find_spread(p);
    mark_wanted(p);
    render_watch_init(&p->watch, &p->desc->render->progress, "shade", p->desc->deadline_s, p->height);
    parallel_for(threads, p->height, GRAIN_ROWS, trace_rows, p);
    TRY(render_watch_explain(&p->watch, error));
    p->is_along_x = true;
    filter(p, smooth_rows, p->hidden, p->smooth);
    p->is_along_x = false;
    filter(p, smooth_rows, p->smooth, p->hidden);
    filter(p, level_rows, p->hidden, p->smooth);
    parallel_for(threads, p->target->height, GRAIN_ROWS, composite_rows, p);
    return FACET_OK;
}

facet_result ground_shadow_draw(const ground_shadow_desc *desc, film *target, facet_render_stats *stats,
                                facet_error *error)
{
    const facet_allocator *allocator = &desc->render->allocator;
    ground_job p = {.desc = desc, .target = target, .counts = &RAYS[desc->render->quality]};
    p.rays = p.counts->light + p.counts->cosine;
    find_area(&p);
    size_t count = (size_t)p.width * p.height;
    p.sky_rays = mem_alloc(allocator, (size_t)INTERLEAVE_PARTS * p.rays, sizeof *p.sky_rays);
    p.hidden = mem_alloc(allocator, count, sizeof *p.hidden);
    p.smooth = mem_alloc(allocator, count, sizeof *p.smooth);
    p.is_wanted = mem_zalloc(allocator, count, sizeof *p.is_wanted);
    facet_result result = p.sky_rays && p.hidden && p.smooth && p.is_wanted
                              ? draw(&p, error)
                              : fail_memory(error, "the shadow on the ground", 9 * count);
    stats->rays += atomic_load(&p.rays_traced);
    mem_free(p.sky_rays);
    mem_free(p.hidden);
    mem_free(p.smooth);
    mem_free(p.is_wanted);
    return result;
}
