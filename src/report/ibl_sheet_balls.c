/* ibl_sheet_balls.c - the spheres of a sheet (ibl_sheet_state.h). */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bake/bake_lobe.h"
#include "base/result.h"
#include "ibl/sh.h"
#include "report/ibl_sheet_state.h"

/* value * 100 with as many decimals as say something. */
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

/* Whether there is a sphere for each of several roughnesses; otherwise the only one stands beside those of harmonics. */
static bool has_row(const facet_cube *c)
{
    return c->lobe == FACET_LOBE_GGX || c->lobe == FACET_LOBE_CHARLIE;
}

uint32_t sheet_analysis_degree(const facet_cube *c)
{
    enum { MIN_DEGREE = 256 }; /* a lower one would average texels of the environment beforehand */
    float kernel[HARMONICS_MAX_DEGREE + 1];
    uint32_t degree = 0;
    if (has_row(c)) {
        const bake_lobe narrowest =
            bake_lobe_create(c->lobe, ball_roughness(c->lobe, c->lobe == FACET_LOBE_GGX ? 1 : 0));
        bake_lobe_kernel(&narrowest, kernel, &degree);
    }
    return degree > MIN_DEGREE ? degree : MIN_DEGREE;
}

/* The environment filtered with a lobe into s->filtered, turned and scaled as the cube map is. */
static facet_result filter_reference(sheet *s, facet_lobe kind, float roughness, facet_error *error)
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

/* A mirror that shows the environment's image. */
static sheet_ball environment_ball(const sheet *s)
{
    double angle = (double)s->bake->rotation_rad;
    return (sheet_ball){.kind = BALL_PICTURE,
                        .picture = s->picture,
                        .rotation_cos = (float)cos(angle),
                        .rotation_sin = (float)sin(angle),
                        .environment_scale = exp2f(s->bake->ev)};
}

/* ---- spheres ---- */

/* One above the other; the difference below. */
static facet_result draw_pair(sheet *s, const sheet_ball *made, const sheet_ball *exact, uint32_t x,
                              const char *label, facet_error *error)
{
    sheet_place above = {x, s->y, BALL};
    sheet_place below = {x, s->y + BALL_STEP, BALL};
    float middle = (float)x + 0.5f * BALL;
    sheet_shade_ball(made, BALL, s->canvas.thread_count, s->values);
    sheet_draw_ball(&s->canvas, above, s->values);
    TRY(sheet_step(s, error));
    sheet_shade_ball(exact, BALL, s->canvas.thread_count, s->reference);
    sheet_draw_ball(&s->canvas, below, s->reference);
    char rms[NUMBER_SIZE];
    percent(sheet_compare_balls(s->values, s->reference, BALL), rms);
    float y = (float)(s->y + BALL_STEP + BALL + 24);
    sheet_write(s, (sheet_word){.size = 14, .strength = PLAIN, .align = WORD_CENTER}, middle, y, "%s", label);
    sheet_write(s, (sheet_word){.size = 14, .strength = STRONG, .align = WORD_CENTER, .is_bold = true},
                middle, y + 20.0f, "%s %%", rms);
    return sheet_step(s, error);
}

static void write_rows(sheet *s, const char *above, const char *what)
{
    float y = (float)s->y + 0.5f * BALL + 5.0f;
    sheet_word style = {.size = 14, .strength = PLAIN, .width = LABELS - 12};
    sheet_write(s, style, MARGIN, y, "%s", above);
    sheet_write(s, style, MARGIN, y + BALL_STEP, "reference");
    y = (float)(s->y + BALL_STEP + BALL + 24);
    style.strength = QUIET;
    sheet_write(s, style, MARGIN, y, "%s", what);
    sheet_write(s, style, MARGIN, y + 20.0f, "difference, RMS");
}

static float lod_of(const sheet *s, float roughness)
{
    float last = (float)(s->cube_map->level_count - 1);
    return last * (s->bake->mapping == FACET_ROUGHNESS_MAPPING_FILAMENT ? roughness * (2.0f - roughness)
                                                                        : roughness);
}

/* A sphere lit by the cube map for a roughness, above the same lit by the environment. */
static facet_result draw_cube_ball(sheet *s, float roughness, uint32_t x, const char *label,
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

static facet_result draw_row(sheet *s, facet_error *error)
{
    sheet_write_section(s, "Spheres that reflect all light, for eight roughnesses",
                        "read as a GPU does, between two levels; the reference is filtered for exactly this "
                        "roughness");
    write_rows(s, "this cube map", "roughness");
    for (uint32_t i = 0; i < ROW_BALLS; i++) {
        float roughness = ball_roughness(s->cube_map->lobe, i);
        char label[NUMBER_SIZE];
        number_label((double)roughness, 2, label);
        TRY(draw_cube_ball(s, roughness, MARGIN + LABELS + i * BALL_STEP, label, error));
    }
    s->y += PAIR + SECTION_GAP;
    return FACET_OK;
}

/* ---- harmonics ---- */

static void fold(const double radiance[SH_COUNT][3], float out[SH_COUNT][3])
{
    double irradiance[SH_COUNT][3];
    sh_irradiance(radiance, irradiance);
    sh_fold_over_pi((const double(*)[3])irradiance, out);
}

/* The coefficients beside the spheres that they light. */
static void write_harmonics(sheet *s, uint32_t x, const float plain[SH_COUNT][3],
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
    const float columns[2] = {(float)x + 36.0f, WIDTH - MARGIN - COLUMNS};
    float y = (float)s->y + 18.0f;
    double factors[2];
    char a[NUMBER_SIZE], b[NUMBER_SIZE];
    sh_window(narrowness, factors);
    number_label(factors[0], 3, a);
    number_label(factors[1], 3, b);
    sheet_word head = {.size = 14, .strength = QUIET};
    sheet_write(s, head, columns[0], y, "%s", "irradiance / \xcf\x80 = sum of");
    if (narrowness > 0.0)
        sheet_write(s, head, columns[1], y, "windowed: bands 1 and 2 times %s and %s", a, b);
    else
        sheet_write(s, head, columns[1], y, "windowed: the same, nothing is negative");
    for (int table = 0; table < 2; table++)
        for (int k = -1; k < SH_COUNT; k++) {
            float row = y + 34.0f + 24.0f * (float)(k + 1);
            sheet_word style = {.size = 14, .strength = k < 0 ? QUIET : PLAIN};
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

static facet_result draw_harmonics(sheet *s, facet_error *error)
{
    sheet_write_section(s, has_row(s->cube_map) ? "Diffuse spheres by nine spherical harmonics" : "Spheres",
                        "the reference is the environment filtered with the cosine lobe");
    write_rows(s, "approximate", "by");
    uint32_t x = MARGIN + LABELS;
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

/* ---- all of them ---- */

facet_result sheet_draw_balls(sheet *s, facet_error *error)
{
    if (has_row(s->cube_map))
        TRY(draw_row(s, error));
    return draw_harmonics(s, error);
}

uint32_t sheet_balls_height(const facet_cube *c)
{
    return (has_row(c) ? SECTION + PAIR + SECTION_GAP : 0) + SECTION + PAIR;
}

uint32_t sheet_ball_steps(const facet_cube *c)
{
    return 2 * ((has_row(c) ? ROW_BALLS : 1) + 2);
}
