/* ibl_sheet.c - see ibl_sheet.h. From the top: the title; the levels as crosses; spheres lit by the cube map above the same
 * spheres lit by the environment filtered for exactly their roughness, and the difference; diffuse spheres lit by nine
 * harmonics. */
#include "report/ibl_sheet.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "base/memory.h"
#include "base/result.h"
#include "ibl/environment.h"
#include "ibl/sh.h"
#include "report/ibl_sheet_state.h"

#define DOT "  \xc2\xb7  "

/* A calm dark grey, sRGB (30, 32, 36), in linear light: bright balls stand out, black ones too. */
static const float BACKGROUND[3] = {0.01298f, 0.01444f, 0.01764f};

/* ---- words ---- */

void sheet_write(sheet *s, sheet_word style, float x, float y, const char *format, ...)
{
    sheet_word *w = &s->words[s->word_count];
    *w = style;
    w->x = x;
    w->y = y;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(w->text, sizeof w->text, format, arguments);
    va_end(arguments);
    s->word_count += w->text[0] != 0; /* a word without letters would be a line */
}

/* A line over the sheet, and what comes under it. */
void sheet_write_section(sheet *s, const char *title, const char *remark)
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

facet_result sheet_step(sheet *s, facet_error *error)
{
    s->step++;
    const facet_progress *p = &s->desc->progress;
    if (!p->report || p->report(p->user, "sheet", (double)s->step / s->step_count))
        return FACET_OK;
    return fail(error, FACET_ERROR_CANCELLED, "sheet: cancelled after %u of %u steps", s->step,
                s->step_count);
}

/* ---- levels ---- */

/* Two decimals, or three where two would lie. */
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

/* Level 0 is on the left, the others in rows and columns right of it, which are as high. */
typedef struct level_grid {
    uint32_t columns;
    uint32_t first, width; /* of crosses: level 0's and the others' */
    uint32_t height;       /* of all */
} level_grid;

/* With r rows of c columns, first * 3/4 + CAPTION = r (width * 3/4 + CAPTION) and first + c width + gaps = room are two lines
 * that cross; c is the one for which level 0 is nearest to half the sheet. */
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
    const image *whole = &s->environment->picture;
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
    film_develop(&s->film, desc->tonemap, BACKGROUND, desc->thread_count);
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
