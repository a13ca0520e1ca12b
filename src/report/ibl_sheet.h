/* ibl_sheet.h - a sheet for inspecting a baked cube map, between ibl_sheet.c, which lays it out, and
 * ibl_sheet_balls.c, which draws its spheres. Radiance goes into a film; rows of it are independent. */
#ifndef REPORT_IBL_SHEET_H
#define REPORT_IBL_SHEET_H

#include "bake/bake.h"
#include "film/film.h"
#include "ibl/harmonics.h"
#include "ibl/sh.h"
#include "report/sheet_words.h"

/* Pixels. */
enum {
    SHEET_WIDTH = 1600,
    SHEET_MARGIN = 56,
    SHEET_SECTION = 60, /* height of a section's title */
    SHEET_SECTION_GAP = 44,
    SHEET_BALL = 148 /* diameter of a sphere */
};

enum { SHEET_MAX_WORDS = 160 };

/* Strength of text, 1: white. */
#define SHEET_STRONG 0.92f
#define SHEET_PLAIN 0.78f
#define SHEET_QUIET 0.55f

/* Position on the film, pixels. A cross is 4:3, a sphere square. */
typedef struct sheet_place {
    uint32_t x, y, width;
} sheet_place;

/* The film, whose values are radiance until the whole sheet is exposed. */
typedef struct sheet_canvas {
    film *film;
    uint32_t thread_count;
} sheet_canvas;

typedef struct ibl_sheet {
    const facet_cube *cube_map;
    const facet_environment *environment;
    const facet_sheet_desc *desc;
    const facet_bake_desc *bake;
    film film;
    sheet_canvas canvas;
    image cut; /* the environment clamped by desc->bake.clamp */
    const image *panorama;
    harmonics analysis;        /* of panorama */
    facet_cube filtered;       /* one level: the environment filtered for the reference of one sphere */
    float *values, *reference; /* of a sphere each */
    double harmonics[SH_COUNT][3];
    sheet_word words[SHEET_MAX_WORDS];
    uint32_t word_count;
    uint32_t step, step_count; /* for progress */
    uint32_t y;                /* where the next element goes */
} ibl_sheet;

/* Adds text at a position in a style; nothing if the text is empty. */
__attribute__((format(printf, 5, 6))) void sheet_write(ibl_sheet *s, sheet_word style, float x, float y,
                                                       const char *format, ...);
/* A line across the sheet, below it a title, and a remark on the right. */
void sheet_write_section(ibl_sheet *s, const char *title, const char *remark);
/* Reports a step to the progress callback. FACET_ERROR_CANCELLED. */
facet_result sheet_step(ibl_sheet *s, facet_error *error);
/* +Y above and -Y below the second of -X +Z +X -Z; a pixel is the mean of what it covers. */
void sheet_draw_cross(const sheet_canvas *canvas, sheet_place place, const cube *level);

/* ---- spheres (ibl_sheet_balls.c) ---- */

/* Spheres lit by the cube map above the same spheres lit by the environment, and diffuse ones lit by nine
 * harmonics; they start at s->y and advance it. FACET_ERROR_CANCELLED, _MEMORY. */
facet_result sheet_draw_balls(ibl_sheet *s, facet_error *error);
uint32_t sheet_balls_height(const facet_cube *c);
uint32_t sheet_ball_steps(const facet_cube *c); /* progress steps */
/* The degree of s->analysis that the spheres need. */
uint32_t sheet_analysis_degree(const facet_cube *c);

typedef enum ball_kind {
    BALL_CUBE,     /* levels of a cube map, read as a GPU does, along the mirror direction or the normal */
    BALL_IMAGE,    /* the image of the environment in the mirror direction */
    BALL_HARMONICS /* along the normal */
} ball_kind;

/* A sphere seen along -Z in orthographic projection. */
typedef struct sheet_ball {
    ball_kind kind;
    bool is_diffuse; /* along the normal */
    const facet_cube *cube_map;
    float lod; /* fractional level */
    const image *panorama;
    float rotation_cos, rotation_sin, environment_scale; /* of panorama */
    const float (*harmonics)[3];                         /* SH_COUNT of them, folded */
    uint32_t samples;                                    /* per pixel in each direction; 0: 1 */
} sheet_ball;

/* values: width^2 RGB radiances, 0 outside of the sphere. */
void sheet_shade_ball(const sheet_ball *ball, uint32_t width, uint32_t thread_count, float *values);
/* RMS of the difference over that of reference, over the pixels of the sphere. */
double sheet_compare_balls(const float *values, const float *reference, uint32_t width);

#endif
