/* ibl_sheet_draw.h - images on a sheet: unfolded cube maps, and spheres lit by a cube map or by the
 * reference, drawn into a film of radiance. Rows are independent. */
#ifndef REPORT_IBL_SHEET_DRAW_H
#define REPORT_IBL_SHEET_DRAW_H

#include "bake/bake.h"
#include "film/film.h"
#include "ibl/sh.h"

/* Position on the film, pixels. A cross is 4:3, a sphere square. */
typedef struct sheet_place {
    uint32_t x, y, width;
} sheet_place;

/* The film and its scale. */
typedef struct sheet_canvas {
    film *film;
    float scale; /* film value per radiance */
    uint32_t thread_count;
} sheet_canvas;

/* +Y above and -Y below the second of -X +Z +X -Z; a pixel is the mean of what it covers. */
void sheet_draw_cross(const sheet_canvas *canvas, sheet_place place, const cube *level);

typedef enum ball_kind {
    BALL_CUBE,     /* levels of a cube map, read as a GPU does, along the mirror direction or the normal */
    BALL_PICTURE,  /* the image of the environment in the mirror direction */
    BALL_HARMONICS /* along the normal */
} ball_kind;

/* A sphere seen along -Z in orthographic projection. */
typedef struct sheet_ball {
    ball_kind kind;
    bool is_diffuse; /* along the normal */
    const facet_cube *cube_map;
    float lod; /* fractional level */
    const image *picture;
    float rotation_cos, rotation_sin, environment_scale; /* of picture */
    const float (*harmonics)[3];                         /* SH_COUNT of them, folded */
    uint32_t samples;                                    /* per pixel in each direction; 0: 1 */
} sheet_ball;

/* values: width^2 RGB radiances, 0 outside of the sphere. */
void sheet_shade_ball(const sheet_ball *ball, uint32_t width, uint32_t thread_count, float *values);
/* Blends them into the film with an antialiased edge. */
void sheet_draw_ball(const sheet_canvas *canvas, sheet_place place, const float *values);
/* RMS of the difference over that of reference, over the pixels of the sphere. */
double sheet_compare_balls(const float *values, const float *reference, uint32_t width);

#endif
