/* ibl_sheet.c - a sheet for inspecting a baked cube map: see report.h. From the top: the title; the levels as
 * crosses; spheres lit by the cube map above the same spheres lit by the environment filtered for exactly
 * their roughness, and the difference; diffuse spheres lit by nine harmonics. */
#include "report/ibl_sheet.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "film/meter.h"
#include "ibl/environment.h"
#include "plot/chart_ticks.h"
#include "report/report.h"

/* Pixels. */
enum { CROSS_GAP = 40, LEVEL_GAP = 24, CAPTION = 34, TITLE = 82, TITLE_LINE = 26 };

#define DOT "  \xc2\xb7  "

static const float LINE_STRENGTH = 0.14f;
/* sRGB (30, 32, 36) in linear light: bright spheres stand out, and so do black ones. */
static const float BACKGROUND[3] = {0.01298f, 0.01444f, 0.01764f};

/* ---- words ---- */

void sheet_write(ibl_sheet *s, sheet_word style, float x, float y, const char *format, ...)
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

void sheet_write_section(ibl_sheet *s, const char *title, const char *remark)
{
    s->words[s->word_count++] = (sheet_word){.x = SHEET_MARGIN,
                                             .y = (float)s->y,
                                             .width = SHEET_WIDTH - 2 * SHEET_MARGIN,
                                             .strength = LINE_STRENGTH};
    s->y += 34;
    sheet_write(s, (sheet_word){.size = 17, .strength = SHEET_STRONG, .is_bold = true}, SHEET_MARGIN,
                (float)s->y, "%s", title);
    sheet_write(s, (sheet_word){.size = 14, .strength = SHEET_QUIET, .align = WORD_RIGHT},
                SHEET_WIDTH - SHEET_MARGIN, (float)s->y, "%s", remark);
    s->y += 26;
}

facet_result sheet_step(ibl_sheet *s, facet_error *error)
{
    s->step++;
    const facet_progress *p = &s->desc->progress;
    if (!p->report || p->report(p->user, "sheet", (double)s->step / s->step_count))
        return FACET_OK;
    return fail(error, FACET_ERROR_CANCELLED, "sheet: cancelled after %u of %u steps", s->step,
                s->step_count);
}

/* ---- title ---- */

static void write_title(ibl_sheet *s)
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
    s->y += TITLE_LINE;
    sheet_write(s, (sheet_word){.size = 28, .strength = SHEET_STRONG, .is_bold = true}, SHEET_MARGIN,
                (float)s->y, "%s", titles[c->lobe]);
    s->y += 28;
    sheet_write(s, (sheet_word){.size = 15, .strength = SHEET_PLAIN}, SHEET_MARGIN, (float)s->y,
                "cube map of %u \xc3\x97 %u texels  \xc2\xb7  %u level%s%s", c->levels[0].size,
                c->levels[0].size, c->level_count, last ? "s" : "", mapping);
    s->y += 28;
}

/* On the right of the title. */
static void write_exposure(ibl_sheet *s, double exposure_ev)
{
    static const char *const operators[] = {
        "none", "neutral", "ACES", "ACES (Narkowicz)", "AgX", "Reinhard", "Reinhard, extended", "Hable"};
    char ev[NUMBER_SIZE];
    number_label(exposure_ev, 1, ev);
    sheet_write(s, (sheet_word){.size = 14, .strength = SHEET_QUIET, .align = WORD_RIGHT},
                SHEET_WIDTH - SHEET_MARGIN, SHEET_MARGIN + TITLE_LINE,
                "exposure %s EV" DOT "tone mapping: %s", ev, operators[s->desc->tonemap]);
}

/* ---- crosses ---- */

typedef struct cross_job {
    const sheet_canvas *canvas;
    sheet_place place;
    const cube *level;
} cross_job;

static void draw_cross_rows(void *context, size_t begin, size_t end)
{
    static const int faces[3][4] = {{-1, 2, -1, -1}, {1, 4, 0, 5}, {-1, 3, -1, -1}};
    enum { MAX_SAMPLES = 16 };
    const cross_job *job = context;
    const film *f = job->canvas->film;
    uint32_t edge = job->place.width / 4;
    /* as many samples as a pixel covers texels; one where a texel covers pixels */
    uint32_t samples = (job->level->size + edge - 1) / edge;
    samples = samples < MAX_SAMPLES ? samples : MAX_SAMPLES;
    for (size_t y = begin; y < end; y++)
        for (uint32_t x = 0; x < 4 * edge; x++) {
            int face = faces[y / edge][x / edge];
            if (face < 0)
                continue;
            rgbx sum = rgbx_splat(0.0f);
            for (uint32_t v = 0; v < samples; v++)
                for (uint32_t u = 0; u < samples; u++) {
                    float s = ((float)(x % edge) + ((float)u + 0.5f) / (float)samples) / (float)edge;
                    float t = ((float)(y % edge) + ((float)v + 0.5f) / (float)samples) / (float)edge;
                    sum += cube_fetch(job->level,
                                      (cube_point){(uint32_t)face, 2.0f * s - 1.0f, 2.0f * t - 1.0f});
                }
            sum *= 1.0f / (float)(samples * samples);
            float *pixel = f->layers[0].pixels + 4 * ((job->place.y + y) * f->width + job->place.x + x);
            for (int c = 0; c < 3; c++)
                pixel[c] = sum[c];
            pixel[3] = 1.0f;
        }
}

void sheet_draw_cross(const sheet_canvas *canvas, sheet_place place, const cube *level)
{
    cross_job job = {canvas, place, level};
    parallel_for(canvas->thread_count, (size_t)place.width / 4 * 3, 4, draw_cross_rows, &job);
}

/* ---- levels ---- */

/* Two decimals, or three where two would round misleadingly. */
static void roughness_label(float roughness, char out[NUMBER_SIZE])
{
    double hundredths = 100.0 * (double)roughness;
    number_label((double)roughness, fabs(hundredths - round(hundredths)) < 1e-3 ? 2 : 3, out);
}

static void write_level(ibl_sheet *s, uint32_t level, sheet_place place)
{
    char roughness[NUMBER_SIZE];
    roughness_label(s->cube_map->roughness[level], roughness);
    uint32_t size = s->cube_map->levels[level].size;
    bool is_narrow = place.width < 300;
    bool has_roughness = s->cube_map->lobe <= FACET_LOBE_CHARLIE;
    sheet_write(
        s, (sheet_word){.size = is_narrow ? 12 : 14, .strength = SHEET_PLAIN, .width = (float)place.width},
        (float)place.x, (float)(place.y + place.width / 4 * 3 + 22), "%s%u" DOT "%u \xc3\x97 %u%s%s%s",
        is_narrow ? "" : "level ", level, size, size, has_roughness ? DOT : "",
        has_roughness && !is_narrow ? "roughness " : "", has_roughness ? roughness : "");
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
    const double room = SHEET_WIDTH - 2 * SHEET_MARGIN;
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

static facet_result draw_levels(ibl_sheet *s, facet_error *error)
{
    sheet_write_section(s, "Levels", "");
    const facet_cube *c = s->cube_map;
    level_grid g = plan_levels(c);
    sheet_place place = {SHEET_MARGIN, s->y, g.first};
    sheet_draw_cross(&s->canvas, place, &c->levels[0]);
    write_level(s, 0, place);
    uint32_t rows = (c->level_count - 1 + g.columns - 1) / g.columns;
    for (uint32_t i = 0; i + 1 < c->level_count; i++) {
        place = (sheet_place){SHEET_MARGIN + g.first + CROSS_GAP + i % g.columns * (g.width + LEVEL_GAP),
                              s->y + i / g.columns * (g.height / rows), g.width};
        sheet_draw_cross(&s->canvas, place, &c->levels[i + 1]);
        write_level(s, i + 1, place);
    }
    s->y += g.height + SHEET_SECTION_GAP;
    return sheet_step(s, error);
}

/* ---- the sheet ---- */

static facet_result prepare(ibl_sheet *s, facet_error *error)
{
    const facet_allocator *allocator = &s->desc->allocator;
    const image *whole = &s->environment->panorama;
    s->panorama = whole;
    if (s->bake->clamp > 0.0f) {
        TRY(image_create(allocator, whole->width, whole->height, 3, IMAGE_F32, &s->cut, error));
        const float *from = whole->pixels;
        float *to = s->cut.pixels;
        for (size_t k = 0; k < (size_t)whole->width * whole->height * 3; k++)
            to[k] = fminf(from[k], s->bake->clamp);
        s->panorama = &s->cut;
    }
    s->values = mem_alloc(allocator, SHEET_BALL * SHEET_BALL * 3, 2 * sizeof(float));
    if (!s->values)
        return fail_memory(error, "sheet", SHEET_BALL * SHEET_BALL * 6 * sizeof(float));
    s->reference = s->values + SHEET_BALL * SHEET_BALL * 3;
    TRY(harmonics_create(s->panorama, sheet_analysis_degree(s->cube_map), allocator, s->desc->thread_count,
                         &s->analysis, error));
    TRY(sh_project(s->panorama, allocator, s->desc->thread_count, s->harmonics, error));
    sh_rotate(s->harmonics, (double)s->bake->rotation_rad);
    for (int k = 0; k < SH_COUNT; k++)
        for (int i = 0; i < 3; i++)
            s->harmonics[k][i] *= exp2((double)s->bake->ev);
    return FACET_OK;
}

static uint32_t sheet_height(const facet_cube *c)
{
    return 2 * SHEET_MARGIN + TITLE + SHEET_SECTION + plan_levels(c).height + SHEET_SECTION_GAP +
           sheet_balls_height(c);
}

/* Stops that bring what has been drawn to middle grey: its log average, as the eye judges a picture. Small bright lights
 * among black, as in a studio, would then leave rough levels and diffuse spheres white; it is darker by up to MOST_DARKER
 * stops, until the mean, which these levels show everywhere, is at most MOST_MEAN of white. */
static double metered_ev(const film *f)
{
    static const double MOST_MEAN = 0.4;
    static const double MOST_DARKER = 1.5;
    double average = film_meter(f);
    if (!(average > 0.0))
        return 0.0;
    double grey = log2(METER_KEY / average);
    double readable = log2(MOST_MEAN / film_average(f));
    return round(10.0 * fmax(grey - MOST_DARKER, fmin(grey, readable))) / 10.0;
}

/* Exposes what has been drawn, and writes the exposure beside the title. */
static void expose(ibl_sheet *s)
{
    double ev = (double)s->desc->exposure_ev;
    if (s->desc->meters_exposure)
        ev += metered_ev(&s->film);
    const float scale = (float)exp2(ev);
    float *pixel = s->film.layers[0].pixels;
    for (size_t i = (size_t)s->film.width * s->film.height; i-- > 0; pixel += 4)
        for (int k = 0; k < 3; k++)
            pixel[k] *= scale;
    write_exposure(s, ev);
}

facet_result ibl_sheet_draw(const facet_cube *cube_map, const facet_environment *environment,
                            const facet_sheet_desc *desc, image *out, facet_error *error)
{
    *out = (image){0};
    ibl_sheet *s = mem_zalloc(&desc->allocator, 1, sizeof *s);
    if (!s)
        return fail_memory(error, "sheet", sizeof *s);
    s->cube_map = cube_map;
    s->environment = environment;
    s->desc = desc;
    s->bake = &desc->bake;
    s->step_count = 1 + sheet_ball_steps(cube_map);
    s->y = SHEET_MARGIN;
    facet_result result =
        film_create(&desc->allocator, SHEET_WIDTH, sheet_height(cube_map), 0, &s->film, error);
    if (result == FACET_OK)
        result = prepare(s, error);
    if (result != FACET_OK)
        goto done;
    s->canvas = (sheet_canvas){&s->film, desc->thread_count};
    write_title(s);
    result = draw_levels(s, error);
    if (result == FACET_OK)
        result = sheet_draw_balls(s, error);
    if (result != FACET_OK)
        goto done;
    expose(s);
    film_tone_map(&s->film, desc->tonemap, BACKGROUND, desc->thread_count);
    *out = (image){.pixels = s->film.layers[0].pixels,
                   .width = SHEET_WIDTH,
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
