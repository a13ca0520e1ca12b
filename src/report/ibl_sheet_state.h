/* ibl_sheet_state.h - a sheet while it is made: what ibl_sheet.c and ibl_sheet_balls.c share. */
#ifndef REPORT_IBL_SHEET_STATE_H
#define REPORT_IBL_SHEET_STATE_H

#include "ibl/harmonics.h"
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
    LABELS = 144, /* column of words left of balls */
    BALL = 148,
    BALL_STEP = 168,
    PAIR = BALL_STEP + BALL + 44, /* height of one ball over another with what is written below */
    TITLE = 82,
    SECTION = 60, /* height of its words */
    SECTION_GAP = 44,
    MAX_WORDS = 160,
    ROW_BALLS = 8,
    COLUMNS = 372 /* of coefficients */
};

#define DOT "  \xc2\xb7  "

/* Of words, 1 is white. */
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
    image cut; /* the environment where desc->bake.clamp cuts it */
    const image *picture;
    harmonics analysis;        /* of picture */
    facet_cube filtered;       /* one level: the environment filtered for the reference of one sphere */
    float *values, *reference; /* of a sphere each */
    double harmonics[SH_COUNT][3];
    sheet_word words[MAX_WORDS];
    uint32_t word_count;
    uint32_t step, step_count; /* for progress */
    uint32_t y;                /* where the next thing goes */
} sheet;

/* Words at a place, in a style; none are written where text comes out empty. */
void sheet_write(sheet *s, sheet_word style, float x, float y, const char *format, ...)
    __attribute__((format(printf, 5, 6)));
/* A line over the sheet, a title and a remark on the right under it. */
void sheet_write_section(sheet *s, const char *title, const char *remark);
/* Reports one more step to the caller's progress callback. FACET_ERROR_CANCELLED. */
facet_result sheet_step(sheet *s, facet_error *error);

/* The degree of s->analysis that the spheres need. */
uint32_t sheet_analysis_degree(const facet_cube *c);
/* Spheres lit by the cube map above the same spheres lit by the environment, and diffuse ones lit by nine harmonics; they start
 * at s->y and advance it. FACET_ERROR_CANCELLED, _MEMORY. */
facet_result sheet_draw_balls(sheet *s, facet_error *error);
uint32_t sheet_balls_height(const facet_cube *c);
uint32_t sheet_ball_steps(const facet_cube *c);

#endif
