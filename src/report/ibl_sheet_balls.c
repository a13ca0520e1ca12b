/* ibl_sheet_balls.c - see ibl_sheet.h: spheres lit by a cube map, by the environment filtered for exactly
 * their roughness, and by harmonics. */
#include "report/ibl_sheet.h"

#include <math.h>
#include <string.h>

#include "bake/bake_lobe.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ibl/equirect.h"
#include "plot/chart_ticks.h"

/* Pixels. */
enum {
    LABELS = 144, /* column of text left of the spheres */
    BALL_STEP = 168,
    PAIR = BALL_STEP + SHEET_BALL + 44, /* height of a pair of spheres with their text */
    ROW_BALLS = 8,
    COLUMNS = 372 /* of coefficients */
};

/* ---- shading ---- */

/* Trilinear lookup at lod. */
static rgbx read_cube(const facet_cube *c, float lod, const float d[3])
{
    float last = (float)(c->level_count - 1);
    lod = lod < 0.0f ? 0.0f : lod > last ? last : lod;
    uint32_t level = (uint32_t)lod;
    float fraction = lod - (float)level;
    cube_point p = cube_locate(d[0], d[1], d[2]);
    rgbx a = cube_fetch(&c->levels[level], p);
    if (fraction == 0.0f)
        return a;
    return a + (cube_fetch(&c->levels[level + 1], p) - a) * fraction;
}

static rgbx light_along(const sheet_ball *b, const float d[3])
{
    const float e[3] = {d[0] * b->rotation_cos - d[2] * b->rotation_sin, d[1],
                        d[0] * b->rotation_sin + d[2] * b->rotation_cos};
    float out[3];
    if (b->kind == BALL_CUBE)
        return read_cube(b->cube_map, b->lod, d);
    if (b->kind == BALL_IMAGE)
        return equirect_fetch(b->panorama, equirect_locate(e)) * b->environment_scale;
    sh_evaluate(b->harmonics, d, out);
    return (rgbx){out[0], out[1], out[2], 0.0f};
}

typedef struct ball_job {
    const sheet_ball *ball;
    uint32_t width;
    float *values;
} ball_job;

/* Distance from the center, 1 on the rim; u to the right, v up. */
static float ball_radius(uint32_t width, float x, float y, float *u, float *v)
{
    *u = 2.0f * x / (float)width - 1.0f;
    *v = 1.0f - 2.0f * y / (float)width;
    return sqrtf(*u * *u + *v * *v);
}

/* A pixel on the rim gets the light of the nearest point of the sphere. */
static void ball_direction(const sheet_ball *b, float u, float v, float radius, float d[3])
{
    const float most = 0.9999f;
    if (radius > most) {
        u *= most / radius;
        v *= most / radius;
    }
    float z = sqrtf(1.0f - u * u - v * v);
    d[0] = b->is_diffuse ? u : 2.0f * z * u; /* V = +Z: R = 2 (N.V) N - V */
    d[1] = b->is_diffuse ? v : 2.0f * z * v;
    d[2] = b->is_diffuse ? z : 2.0f * z * z - 1.0f;
}

static void shade_rows(void *context, size_t begin, size_t end)
{
    const ball_job *job = context;
    const sheet_ball *b = job->ball;
    uint32_t samples = b->samples ? b->samples : 1;
    float rim = 1.0f + 2.0f / (float)job->width;
    for (size_t y = begin; y < end; y++)
        for (uint32_t x = 0; x < job->width; x++) {
            float u, v, d[3];
            float *out = job->values + 3 * (y * job->width + x);
            out[0] = out[1] = out[2] = 0.0f;
            if (ball_radius(job->width, (float)x + 0.5f, (float)y + 0.5f, &u, &v) > rim)
                continue;
            rgbx sum = rgbx_splat(0.0f);
            for (uint32_t k = 0; k < samples * samples; k++) {
                float px = (float)x + ((float)(k % samples) + 0.5f) / (float)samples;
                float py = (float)y + ((float)(k / samples) + 0.5f) / (float)samples;
                float radius = ball_radius(job->width, px, py, &u, &v);
                ball_direction(b, u, v, radius, d);
                sum += light_along(b, d);
            }
            sum *= 1.0f / (float)(samples * samples);
            for (int c = 0; c < 3; c++)
                out[c] = sum[c];
        }
}

void sheet_shade_ball(const sheet_ball *ball, uint32_t width, uint32_t thread_count, float *values)
{
    ball_job job = {ball, width, values};
    parallel_for(thread_count, width, 2, shade_rows, &job);
}

/* Blends values into the film with an antialiased edge. */
static void sheet_draw_ball(const sheet_canvas *canvas, sheet_place place, const float *values)
{
    const film *f = canvas->film;
    uint32_t width = place.width;
    for (uint32_t y = 0; y < width; y++)
        for (uint32_t x = 0; x < width; x++) {
            float u, v;
            float radius = ball_radius(width, (float)x + 0.5f, (float)y + 0.5f, &u, &v);
            float opacity = (1.0f - radius) * 0.5f * (float)width + 0.5f;
            opacity = opacity < 0.0f ? 0.0f : opacity > 1.0f ? 1.0f : opacity;
            const float *value = values + 3 * ((size_t)y * width + x);
            float *pixel = f->layers[0].pixels + 4 * ((size_t)(place.y + y) * f->width + place.x + x);
            for (int c = 0; c < 3; c++)
                pixel[c] = value[c] * opacity;
            pixel[3] = opacity;
        }
}

double sheet_compare_balls(const float *values, const float *reference, uint32_t width)
{
    double difference = 0.0;
    double whole = 0.0;
    for (uint32_t y = 0; y < width; y++)
        for (uint32_t x = 0; x < width; x++) {
            float u, v;
            if (ball_radius(width, (float)x + 0.5f, (float)y + 0.5f, &u, &v) >= 1.0f)
                continue;
            size_t k = 3 * ((size_t)y * width + x);
            for (int c = 0; c < 3; c++) {
                double a = (double)values[k + (size_t)c];
                double b = (double)reference[k + (size_t)c];
                difference += (a - b) * (a - b);
                whole += b * b;
            }
        }
    return whole > 0.0 ? sqrt(difference / whole) : difference > 0.0 ? (double)INFINITY : 0.0;
}

/* value * 100 with its significant decimals. */
static void percent(double value, char out[NUMBER_SIZE])
{
    value *= 100.0;
    number_label(value, value < 0.1 ? 3 : value < 10.0 ? 2 : value < 100.0 ? 1 : 0, out);
}

/* ---- references ---- */

/* The perceptual roughness of sphere i, from the smoothest to the roughest. */
static float ball_roughness(facet_lobe lobe, uint32_t i)
{
    return lobe == FACET_LOBE_GGX ? (float)i / 7.0f : 0.3f + 0.1f * (float)i;
}

/* Whether there is a sphere for each of several roughnesses; otherwise the only one is beside those of
 * harmonics. */
static bool has_row(const facet_cube *c)
{
    return c->lobe == FACET_LOBE_GGX || c->lobe == FACET_LOBE_CHARLIE;
}

uint32_t sheet_analysis_degree(const facet_cube *c)
{
    enum { MIN_DEGREE = 256 }; /* a lower one would blur texels of the environment */
    float kernel[HARMONICS_MAX_DEGREE + 1];
    uint32_t degree = 0;
    if (has_row(c)) {
        const bake_lobe narrowest =
            bake_lobe_create(c->lobe, ball_roughness(c->lobe, c->lobe == FACET_LOBE_GGX ? 1 : 0));
        bake_lobe_kernel(&narrowest, kernel, &degree);
    }
    return degree > MIN_DEGREE ? degree : MIN_DEGREE;
}

/* The environment filtered with a lobe into s->filtered, rotated and scaled as the cube map. */
static facet_result filter_reference(ibl_sheet *s, facet_lobe kind, float roughness, facet_error *error)
{
    enum { MIN_SIZE = 64, MAX_SIZE = 512 };
    float kernel[HARMONICS_MAX_DEGREE + 1];
    uint32_t degree, size = MIN_SIZE;
    const bake_lobe lobe = bake_lobe_create(kind, roughness);
    bake_lobe_kernel(&lobe, kernel, &degree);
    while (size < MAX_SIZE && size < 2 * degree)
        size *= 2;
    cube_destroy(&s->filtered.levels[0]);
    s->filtered = (facet_cube){.lobe = kind, .level_count = 1, .roughness = {roughness}};
    return harmonics_filter(&s->analysis,
                            &(harmonics_filter_desc){.kernel = kernel,
                                                     .degree = degree,
                                                     .rotation_rad = (double)s->bake->rotation_rad,
                                                     .scale = exp2f(s->bake->ev),
                                                     .size = size,
                                                     .allocator = &s->desc->allocator,
                                                     .thread_count = s->desc->thread_count},
                            &s->filtered.levels[0], error);
}

/* A mirror sphere that shows the image of the environment. */
static sheet_ball environment_ball(const ibl_sheet *s)
{
    double angle = (double)s->bake->rotation_rad;
    return (sheet_ball){.kind = BALL_IMAGE,
                        .panorama = s->panorama,
                        .rotation_cos = (float)cos(angle),
                        .rotation_sin = (float)sin(angle),
                        .environment_scale = exp2f(s->bake->ev)};
}

/* ---- pairs ---- */

/* A pair of spheres, with their difference below. */
static facet_result draw_pair(ibl_sheet *s, const sheet_ball *made, const sheet_ball *exact, uint32_t x,
                              const char *label, facet_error *error)
{
    sheet_place above = {x, s->y, SHEET_BALL};
    sheet_place below = {x, s->y + BALL_STEP, SHEET_BALL};
    float middle = (float)x + 0.5f * SHEET_BALL;
    sheet_shade_ball(made, SHEET_BALL, s->canvas.thread_count, s->values);
    sheet_draw_ball(&s->canvas, above, s->values);
    TRY(sheet_step(s, error));
    sheet_shade_ball(exact, SHEET_BALL, s->canvas.thread_count, s->reference);
    sheet_draw_ball(&s->canvas, below, s->reference);
    char rms[NUMBER_SIZE];
    percent(sheet_compare_balls(s->values, s->reference, SHEET_BALL), rms);
    float y = (float)(s->y + BALL_STEP + SHEET_BALL + 24);
    sheet_write(s, (sheet_word){.size = 14, .strength = SHEET_PLAIN, .align = WORD_CENTER}, middle, y, "%s",
                label);
    sheet_write(s, (sheet_word){.size = 14, .strength = SHEET_STRONG, .align = WORD_CENTER, .is_bold = true},
                middle, y + 20.0f, "%s %%", rms);
    return sheet_step(s, error);
}

static void write_rows(ibl_sheet *s, const char *above, const char *what)
{
    float y = (float)s->y + 0.5f * SHEET_BALL + 5.0f;
    sheet_word style = {.size = 14, .strength = SHEET_PLAIN, .width = LABELS - 12};
    sheet_write(s, style, SHEET_MARGIN, y, "%s", above);
    sheet_write(s, style, SHEET_MARGIN, y + BALL_STEP, "reference");
    y = (float)(s->y + BALL_STEP + SHEET_BALL + 24);
    style.strength = SHEET_QUIET;
    sheet_write(s, style, SHEET_MARGIN, y, "%s", what);
    sheet_write(s, style, SHEET_MARGIN, y + 20.0f, "difference, RMS");
}

static float lod_of(const ibl_sheet *s, float roughness)
{
    float last = (float)(s->cube_map->level_count - 1);
    return last * (s->bake->mapping == FACET_ROUGHNESS_MAPPING_FILAMENT ? roughness * (2.0f - roughness)
                                                                        : roughness);
}

/* A sphere lit by the cube map for a roughness, above the same lit by the environment. */
static facet_result draw_cube_ball(ibl_sheet *s, float roughness, uint32_t x, const char *label,
                                   facet_error *error)
{
    facet_lobe lobe = s->cube_map->lobe;
    bool is_mirror = lobe == FACET_LOBE_NONE || (lobe == FACET_LOBE_GGX && roughness == 0.0f);
    sheet_ball made = {.kind = BALL_CUBE,
                       .cube_map = s->cube_map,
                       .lod = has_row(s->cube_map) ? lod_of(s, roughness) : 0.0f,
                       .is_diffuse = lobe == FACET_LOBE_LAMBERT,
                       .samples = is_mirror ? 4 : 1};
    sheet_ball exact = made;
    if (is_mirror)
        exact = environment_ball(s);
    else
        TRY(filter_reference(s, lobe, roughness, error));
    exact.cube_map = &s->filtered;
    exact.lod = 0.0f;
    exact.samples = made.samples;
    return draw_pair(s, &made, &exact, x, label, error);
}

static facet_result draw_row(ibl_sheet *s, facet_error *error)
{
    sheet_write_section(s, "Spheres that reflect all light, for eight roughnesses",
                        "read as a GPU does, between two levels; the reference is filtered for exactly this "
                        "roughness");
    write_rows(s, "this cube map", "roughness");
    for (uint32_t i = 0; i < ROW_BALLS; i++) {
        float roughness = ball_roughness(s->cube_map->lobe, i);
        char label[NUMBER_SIZE];
        number_label((double)roughness, 2, label);
        TRY(draw_cube_ball(s, roughness, SHEET_MARGIN + LABELS + i * BALL_STEP, label, error));
    }
    s->y += PAIR + SHEET_SECTION_GAP;
    return FACET_OK;
}

/* ---- harmonics ---- */

static void fold(const double radiance[SH_COUNT][3], float out[SH_COUNT][3])
{
    double irradiance[SH_COUNT][3];
    sh_irradiance(radiance, irradiance);
    sh_fold_over_pi((const double(*)[3])irradiance, out);
}

/* Writes the coefficients beside the spheres that they light. */
static void write_harmonics(ibl_sheet *s, uint32_t x, const float plain[SH_COUNT][3],
                            const float windowed[SH_COUNT][3], double narrowness)
{
    static const char *const names[SH_COUNT] = {"1",
                                                "y",
                                                "z",
                                                "x",
                                                "xy",
                                                "yz",
                                                "3z\xc2\xb2 \xe2\x88\x92 1",
                                                "zx",
                                                "x\xc2\xb2 \xe2\x88\x92 y\xc2\xb2"};
    static const char *const heads[3] = {"R", "G", "B"};
    const float columns[2] = {(float)x + 36.0f, SHEET_WIDTH - SHEET_MARGIN - COLUMNS};
    float y = (float)s->y + 18.0f;
    double factors[2];
    char a[NUMBER_SIZE], b[NUMBER_SIZE];
    sh_window(narrowness, factors);
    number_label(factors[0], 3, a);
    number_label(factors[1], 3, b);
    sheet_word head = {.size = 14, .strength = SHEET_QUIET};
    sheet_write(s, head, columns[0], y, "%s", "irradiance / \xcf\x80 = sum of");
    if (narrowness > 0.0)
        sheet_write(s, head, columns[1], y, "windowed: bands 1 and 2 times %s and %s", a, b);
    else
        sheet_write(s, head, columns[1], y, "windowed: the same, nothing is negative");
    for (int table = 0; table < 2; table++)
        for (int k = -1; k < SH_COUNT; k++) {
            float row = y + 34.0f + 24.0f * (float)(k + 1);
            sheet_word style = {.size = 14, .strength = k < 0 ? SHEET_QUIET : SHEET_PLAIN};
            if (k >= 0)
                sheet_write(s, style, columns[table], row, "%s", names[k]);
            style.align = WORD_RIGHT;
            for (int i = 0; i < 3; i++) {
                number_label((double)(table ? windowed : plain)[k < 0 ? 0 : k][i], 4, a);
                sheet_write(s, style, columns[table] + COLUMNS - 95.0f * (float)(2 - i), row, "%s",
                            k < 0 ? heads[i] : a);
            }
        }
}

static facet_result draw_harmonics(ibl_sheet *s, facet_error *error)
{
    sheet_write_section(s, has_row(s->cube_map) ? "Diffuse spheres by nine spherical harmonics" : "Spheres",
                        "the reference is the environment filtered with the cosine lobe");
    write_rows(s, "approximate", "by");
    uint32_t x = SHEET_MARGIN + LABELS;
    if (!has_row(s->cube_map)) {
        TRY(draw_cube_ball(s, 0.0f, x, s->cube_map->lobe == FACET_LOBE_NONE ? "mirror" : "cube map", error));
        x += BALL_STEP;
    }
    double windowed[SH_COUNT][3];
    memcpy(windowed, s->harmonics, sizeof windowed);
    double narrowness = sh_dering(windowed);
    float folded[2][SH_COUNT][3];
    fold((const double(*)[3])s->harmonics, folded[0]);
    fold((const double(*)[3])windowed, folded[1]);
    TRY(filter_reference(s, FACET_LOBE_LAMBERT, 1.0f, error));
    const sheet_ball exact = {.kind = BALL_CUBE, .cube_map = &s->filtered, .is_diffuse = true};
    static const char *const labels[2] = {"harmonics", "windowed"};
    for (uint32_t i = 0; i < 2; i++, x += BALL_STEP) {
        sheet_ball made = {
            .kind = BALL_HARMONICS, .is_diffuse = true, .harmonics = (const float(*)[3])folded[i]};
        TRY(draw_pair(s, &made, &exact, x, labels[i], error));
    }
    write_harmonics(s, x, (const float(*)[3])folded[0], (const float(*)[3])folded[1], narrowness);
    s->y += PAIR;
    return FACET_OK;
}

facet_result sheet_draw_balls(ibl_sheet *s, facet_error *error)
{
    if (has_row(s->cube_map))
        TRY(draw_row(s, error));
    return draw_harmonics(s, error);
}

uint32_t sheet_balls_height(const facet_cube *c)
{
    return (has_row(c) ? SHEET_SECTION + PAIR + SHEET_SECTION_GAP : 0) + SHEET_SECTION + PAIR;
}

uint32_t sheet_ball_steps(const facet_cube *c)
{
    return 2 * ((has_row(c) ? ROW_BALLS : 1) + 2);
}
