/* ibl_sheet.c - see ibl_sheet.h. From the top: the title; the levels as crosses; spheres lit by the cube
 * map above the same spheres lit by the environment filtered for exactly their roughness, and the
 * difference; diffuse spheres lit by nine harmonics. */
#include "report/ibl_sheet.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "bake/bake_lobe.h"
#include "base/memory.h"
#include "base/result.h"
#include "ibl/environment.h"
#include "ibl/harmonics.h"
#include "ibl/sh.h"
#include "plot/chart_number.h"
#include "report/ibl_sheet_draw.h"
#include "report/ibl_sheet_words.h"

/* Pixels. */
enum {
    WIDTH = 1600,
    MARGIN = 56,
    CROSS_GAP = 40,
    LEVEL_GAP = 24,
    CAPTION = 34,
    LABELS = 144, /* column of text left of the spheres */
    BALL = 148,
    BALL_STEP = 168,
    PAIR = BALL_STEP + BALL + 44, /* height of a pair of spheres with their text */
    TITLE = 82,
    SECTION = 60, /* height of its title */
    SECTION_GAP = 44,
    MAX_WORDS = 160,
    ROW_BALLS = 8,
    COLUMNS = 372 /* of coefficients */
};

#define DOT "  \xc2\xb7  "

/* Strength of text, 1: white. */
static const float STRONG = 0.92f;
static const float PLAIN = 0.78f;
static const float QUIET = 0.55f;
static const float LINE = 0.14f;
typedef struct sheet {
    const facet_cube *cube_map;
    const facet_environment *environment;
    const facet_sheet_desc *desc;
    const facet_bake_desc *bake;
    film film;
    sheet_canvas canvas;
    image cut; /* the environment clamped by desc->bake.clamp */
    const image *picture;
    harmonics analysis;        /* of picture */
    facet_cube filtered;       /* one level: the environment filtered for the reference of one sphere */
    float *values, *reference; /* of a sphere each */
    double harmonics[SH_COUNT][3];
    sheet_word words[MAX_WORDS];
    uint32_t word_count;
    uint32_t step, step_count; /* for progress */
    uint32_t y;                /* where the next element goes */
} sheet;

/* sRGB (30, 32, 36) in linear light: bright spheres stand out, and so do black ones. */
static const float BACKGROUND[3] = {0.01298f, 0.01444f, 0.01764f};

/* ---- words ---- */

/* Adds text at a position in a style; nothing if the text is empty. */
__attribute__((format(printf, 5, 6))) static void sheet_write(sheet *s, sheet_word style, float x, float y,
                                                              const char *format, ...)
{
    sheet_word *w = &s->words[s->word_count];
    *w = style;
    w->x = x;
    w->y = y;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(w->text, sizeof w->text, format, arguments);
    va_end(arguments);
    s->word_count += w->text[0] != 0; /* empty text would be a line */
}

/* A line across the sheet, below it a title, and a remark on the right. */
static void sheet_write_section(sheet *s, const char *title, const char *remark)
{
    s->words[s->word_count++] =
        (sheet_word){.x = MARGIN, .y = (float)s->y, .width = WIDTH - 2 * MARGIN, .strength = LINE};
    s->y += 34;
    sheet_write(s, (sheet_word){.size = 17, .strength = STRONG, .is_bold = true}, MARGIN, (float)s->y, "%s",
                title);
    sheet_write(s, (sheet_word){.size = 14, .strength = QUIET, .align = WORD_RIGHT}, WIDTH - MARGIN,
                (float)s->y, "%s", remark);
    s->y += 26;
}

static void write_title(sheet *s)
{
    static const char *const titles[] = {"Reflections (GGX)", "Sheen (Charlie)", "Irradiance (Lambert)",
                                         "Environment"};
    const facet_cube *c = s->cube_map;
    uint32_t last = c->level_count - 1;
    char mapping[64] = "";
    if (last > 0 && c->lobe <= FACET_LOBE_CHARLIE)
        snprintf(mapping, sizeof mapping,
                 s->bake->mapping == FACET_ROUGHNESS_MAPPING_FILAMENT
                     ? "  \xc2\xb7  roughness of level k: 1 \xe2\x88\x92 \xe2\x88\x9a(1 \xe2\x88\x92 k/%u)"
                     : "  \xc2\xb7  roughness of level k: k/%u",
                 last);
    s->y += 26;
    sheet_write(s, (sheet_word){.size = 28, .strength = STRONG, .is_bold = true}, MARGIN, (float)s->y, "%s",
                titles[c->lobe]);
    char ev[NUMBER_SIZE];
    number_label((double)s->desc->exposure_ev, 1, ev);
    static const char *const operators[] = {
        "none", "neutral", "ACES", "ACES (Narkowicz)", "AgX", "Reinhard", "Reinhard, extended", "Hable"};
    sheet_write(s, (sheet_word){.size = 14, .strength = QUIET, .align = WORD_RIGHT}, WIDTH - MARGIN,
                (float)s->y, "exposure %s EV  \xc2\xb7  tone mapping: %s", ev, operators[s->desc->tonemap]);
    s->y += 28;
    sheet_write(s, (sheet_word){.size = 15, .strength = PLAIN}, MARGIN, (float)s->y,
                "cube map of %u \xc3\x97 %u texels  \xc2\xb7  %u level%s%s", c->levels[0].size,
                c->levels[0].size, c->level_count, last ? "s" : "", mapping);
    s->y += 28;
}

/* ---- progress ---- */

/* Reports a step to the progress callback. FACET_ERROR_CANCELLED. */
static facet_result sheet_step(sheet *s, facet_error *error)
{
    s->step++;
    const facet_progress *p = &s->desc->progress;
    if (!p->report || p->report(p->user, "sheet", (double)s->step / s->step_count))
        return FACET_OK;
    return fail(error, FACET_ERROR_CANCELLED, "sheet: cancelled after %u of %u steps", s->step,
                s->step_count);
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

/* The degree of s->analysis that the spheres need. */
static uint32_t sheet_analysis_degree(const facet_cube *c)
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

/* A mirror sphere that shows the image of the environment. */
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

/* A pair of spheres, with their difference below. */
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

/* Writes the coefficients beside the spheres that they light. */
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

/* Spheres lit by the cube map above the same spheres lit by the environment, and diffuse ones lit by nine
 * harmonics; they start at s->y and advance it. FACET_ERROR_CANCELLED, _MEMORY. */
static facet_result sheet_draw_balls(sheet *s, facet_error *error)
{
    if (has_row(s->cube_map))
        TRY(draw_row(s, error));
    return draw_harmonics(s, error);
}

static uint32_t sheet_balls_height(const facet_cube *c)
{
    return (has_row(c) ? SECTION + PAIR + SECTION_GAP : 0) + SECTION + PAIR;
}

static uint32_t sheet_ball_steps(const facet_cube *c)
{
    return 2 * ((has_row(c) ? ROW_BALLS : 1) + 2);
}

/* ---- levels ---- */

/* Two decimals, or three where two would round misleadingly. */
static void roughness_label(float roughness, char out[NUMBER_SIZE])
{
    double hundredths = 100.0 * (double)roughness;
    number_label((double)roughness, fabs(hundredths - round(hundredths)) < 1e-3 ? 2 : 3, out);
}

static void write_level(sheet *s, uint32_t level, sheet_place place)
{
    char roughness[NUMBER_SIZE];
    roughness_label(s->cube_map->roughness[level], roughness);
    uint32_t size = s->cube_map->levels[level].size;
    bool is_narrow = place.width < 300;
    bool has_roughness = s->cube_map->lobe <= FACET_LOBE_CHARLIE;
    sheet_write(s, (sheet_word){.size = is_narrow ? 12 : 14, .strength = PLAIN, .width = (float)place.width},
                (float)place.x, (float)(place.y + place.width / 4 * 3 + 22),
                "%s%u" DOT "%u \xc3\x97 %u%s%s%s", is_narrow ? "" : "level ", level, size, size,
                has_roughness ? DOT : "", has_roughness && !is_narrow ? "roughness " : "",
                has_roughness ? roughness : "");
}

/* Level 0 is on the left, the others in rows and columns at its right, of the same height in total. */
typedef struct level_grid {
    uint32_t columns;
    uint32_t first, width; /* of crosses: level 0's and the others' */
    uint32_t height;       /* of all */
} level_grid;

/* With r rows of c columns, first * 3/4 + CAPTION = r (width * 3/4 + CAPTION) and first + c width + gaps =
 * room are two linear equations; c is chosen such that level 0 takes about half of the sheet. */
static level_grid plan_levels(const facet_cube *c)
{
    const double room = WIDTH - 2 * MARGIN;
    const double half = 0.5 * room;
    uint32_t others = c->level_count - 1;
    level_grid best = {.columns = 1, .first = (uint32_t)half / 4 * 4};
    double nearest = (double)INFINITY;
    for (uint32_t columns = 1; columns <= others; columns++) {
        double rows = (double)((others + columns - 1) / columns);
        double gaps = CROSS_GAP + (columns - 1.0) * LEVEL_GAP;
        double first =
            (rows * 0.75 * (room - gaps) / columns + (rows - 1.0) * CAPTION) / (0.75 + rows * 0.75 / columns);
        double width = (room - gaps - first) / columns;
        if (fabs(first - half) < nearest && width >= 120.0) {
            nearest = fabs(first - half);
            best = (level_grid){
                .columns = columns, .first = (uint32_t)first / 4 * 4, .width = (uint32_t)width / 4 * 4};
        }
    }
    best.height = best.first / 4 * 3 + CAPTION;
    return best;
}

static facet_result draw_levels(sheet *s, facet_error *error)
{
    sheet_write_section(s, "Levels", "");
    const facet_cube *c = s->cube_map;
    level_grid g = plan_levels(c);
    sheet_place place = {MARGIN, s->y, g.first};
    sheet_draw_cross(&s->canvas, place, &c->levels[0]);
    write_level(s, 0, place);
    uint32_t rows = (c->level_count - 1 + g.columns - 1) / g.columns;
    for (uint32_t i = 0; i + 1 < c->level_count; i++) {
        place = (sheet_place){MARGIN + g.first + CROSS_GAP + i % g.columns * (g.width + LEVEL_GAP),
                              s->y + i / g.columns * (g.height / rows), g.width};
        sheet_draw_cross(&s->canvas, place, &c->levels[i + 1]);
        write_level(s, i + 1, place);
    }
    s->y += g.height + SECTION_GAP;
    return sheet_step(s, error);
}

/* ---- the sheet ---- */

static facet_result prepare(sheet *s, facet_error *error)
{
    const facet_allocator *allocator = &s->desc->allocator;
    const image *whole = &s->environment->panorama;
    s->picture = whole;
    if (s->bake->clamp > 0.0f) {
        TRY(image_create(allocator, whole->width, whole->height, 3, IMAGE_F32, &s->cut, error));
        const float *from = whole->pixels;
        float *to = s->cut.pixels;
        for (size_t k = 0; k < (size_t)whole->width * whole->height * 3; k++)
            to[k] = fminf(from[k], s->bake->clamp);
        s->picture = &s->cut;
    }
    s->values = mem_alloc(allocator, BALL * BALL * 3, 2 * sizeof(float));
    if (!s->values)
        return fail_memory(error, "sheet", BALL * BALL * 6 * sizeof(float));
    s->reference = s->values + BALL * BALL * 3;
    TRY(harmonics_create(s->picture, sheet_analysis_degree(s->cube_map), allocator, s->desc->thread_count,
                         &s->analysis, error));
    TRY(sh_project(s->picture, allocator, s->desc->thread_count, s->harmonics, error));
    sh_rotate(s->harmonics, (double)s->bake->rotation_rad);
    for (int k = 0; k < SH_COUNT; k++)
        for (int i = 0; i < 3; i++)
            s->harmonics[k][i] *= exp2((double)s->bake->ev);
    return FACET_OK;
}

static uint32_t sheet_height(const facet_cube *c)
{
    return 2 * MARGIN + TITLE + SECTION + plan_levels(c).height + SECTION_GAP + sheet_balls_height(c);
}

facet_result ibl_sheet_draw(const facet_cube *cube_map, const facet_environment *environment,
                            const facet_sheet_desc *desc, image *out, facet_error *error)
{
    *out = (image){0};
    sheet *s = mem_zalloc(&desc->allocator, 1, sizeof *s);
    if (!s)
        return fail_memory(error, "sheet", sizeof *s);
    s->cube_map = cube_map;
    s->environment = environment;
    s->desc = desc;
    s->bake = &desc->bake;
    s->step_count = 1 + sheet_ball_steps(cube_map);
    s->y = MARGIN;
    facet_result result = film_create(&desc->allocator, WIDTH, sheet_height(cube_map), 0, &s->film, error);
    if (result == FACET_OK)
        result = prepare(s, error);
    if (result != FACET_OK)
        goto done;
    s->canvas = (sheet_canvas){&s->film, exp2f(desc->exposure_ev), desc->thread_count};
    write_title(s);
    result = draw_levels(s, error);
    if (result == FACET_OK)
        result = sheet_draw_balls(s, error);
    if (result != FACET_OK)
        goto done;
    film_tone_map(&s->film, desc->tonemap, BACKGROUND, desc->thread_count);
    *out = (image){.pixels = s->film.layers[0].pixels,
                   .width = WIDTH,
                   .height = s->film.height,
                   .channel_count = 4,
                   .type = IMAGE_F32};
    s->film.layers[0].pixels = NULL;
    facet_error remark;
    result = sheet_write_words(s->words, s->word_count, &desc->allocator, out, &remark);
    if (result == FACET_ERROR_SYSTEM || result == FACET_ERROR_UNSUPPORTED) {
        log_warning(&environment->log, "sheet: no words: %s", remark.message);
        result = FACET_OK;
    }
    if (result != FACET_OK) {
        fail(error, result, "%s", remark.message);
        image_destroy(out);
    }
done:
    film_destroy(&s->film);
    image_destroy(&s->cut);
    harmonics_destroy(&s->analysis);
    cube_destroy(&s->filtered.levels[0]);
    mem_free(s->values);
    mem_free(s);
    return result;
}
