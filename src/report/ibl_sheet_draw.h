/* ibl_sheet_draw.h - the pictures on a sheet: cube maps unfolded, and balls that show what light a cube map holds, or what
 * light is. They are drawn into a film of radiance; rows are independent. */
#ifndef REPORT_IBL_SHEET_DRAW_H
#define REPORT_IBL_SHEET_DRAW_H

#include "bake/bake.h"
#include "film/film.h"
#include "ibl/sh.h"

/* Where on the film; pixels. A cross is 4 to 3, a ball square. */
typedef struct sheet_place {
    uint32_t x, y, width;
} sheet_place;

/* What is behind a film's numbers. */
typedef struct sheet_canvas {
    film *film;
    float scale; /* radiance to numbers */
    uint32_t thread_count;
} sheet_canvas;

/* +Y above and -Y below the second of -X +Z +X -Z; a pixel is the mean of what it covers. */
void sheet_draw_cross(const sheet_canvas *canvas, sheet_place place, const cube *level);

typedef enum ball_kind {
    BALL_CUBE,     /* levels of a cube map, read as a GPU does, along the mirror direction or the normal */
    BALL_PICTURE,  /* the environment's picture in the mirror direction */
    BALL_HARMONICS /* along the normal */
} ball_kind;

/* A ball seen from +Z along -Z, in parallel. */
typedef struct sheet_ball {
    ball_kind kind;
    bool is_diffuse; /* along the normal */
    const facet_cube *cube_map;
    float lod; /* level with fraction */
    const image *picture;
    float rotation_cos, rotation_sin, environment_scale; /* of picture */
    const float (*harmonics)[3];                         /* SH_COUNT of them, folded */
    uint32_t samples;                                    /* each way in a pixel; 0: 1 */
} sheet_ball;

/* values: width^2 x RGB of place, radiance, 0 outside of the ball. */
void sheet_shade_ball(const sheet_ball *ball, uint32_t width, uint32_t thread_count, float *values);
/* Lays them on the film with a soft edge. */
void sheet_draw_ball(const sheet_canvas *canvas, sheet_place place, const float *values);
/* Root mean square of the difference over that of reference, over the ball's pixels. */
double sheet_compare_balls(const float *values, const float *reference, uint32_t width);

#endif
