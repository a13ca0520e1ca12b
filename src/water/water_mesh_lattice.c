/* water_mesh_lattice.c - where a sea's vertices are: see water_mesh.h. */
#include <math.h>
#include <string.h>

#include "water/water_mesh.h"

static const double TURN = 6.283185307179586;
static const double NEAREST_M = 0.2;  /* of the eye to the water, as far as spacing is concerned */
static const double WIDEST_RAD = 0.1; /* between columns behind the eye */
static const double GROWTH = 1.15;    /* from column to column beside the picture */
static const double BEYOND_M = 20e3;  /* past the horizon, or across where there is none */
static const double LONGEST = 0.05;   /* of the distance, from row to row */
static const double FINEST = 0.5;     /* of a pixel: samples are finer than pixels */
static const double PARALLEL = 0.004; /* rad between columns, where rays are parallel */

/* What spacing follows from. */
typedef struct lattice_view {
    double middle, half; /* azimuths of the picture */
    double step_rad;     /* between its columns */
    double width_m;      /* of a sample, where rays are parallel */
    double height_m, far_m;
} lattice_view;

static lattice_view view_of(const water_setup *s, water_mesh_lattice *l)
{
    const camera_rays *c = &s->camera;
    const uint32_t whole[4] = {0, 0, s->desc->width, s->desc->height};
    lattice_view v = {.step_rad = (double)c->pixel_size, .far_m = BEYOND_M};
    l->center[0] = (double)c->origin[0];
    l->center[1] = (double)c->origin[2];
    if (c->is_orthographic) { /* around what is in the middle */
        float o[3], d[3];
        camera_rays_at(c, 0.5f * (float)whole[2], 0.5f * (float)whole[3], o, d);
        double t = fabsf(d[1]) > 1e-3f ? -(double)o[1] / (double)d[1] : 0.0;
        l->center[0] = (double)o[0] + t * (double)d[0];
        l->center[1] = (double)o[2] + t * (double)d[2];
        v.half = 0.5 * TURN;
        v.step_rad = PARALLEL;
        v.width_m = (double)c->pixel_size;
        return v;
    }
    double water = (double)waves_height(&s->sea->waves, l->center[0], l->center[1], 0.0f);
    v.height_m = fmax(fabs((double)c->origin[1] - water), NEAREST_M);
    if (!water_profile_azimuths(c, whole, &v.middle, &v.half))
        v.half = 0.5 * TURN;
    if (s->march.fall > 0.0)
        v.far_m += 1.1 * sqrt(v.height_m / s->march.fall);
    return v;
}

/* Columns of one half of the circle, from the middle of the picture on; out NULL: counted only. */
static uint32_t fill_half(const lattice_view *v, double scale, double *out)
{
    double step = v->step_rad * scale, angle = 0.0;
    uint32_t count = 0;
    while (angle < 0.5 * TURN - 0.5 * step) {
        if (out)
            out[count] = angle;
        count++;
        if (angle >= v->half)
            step = fmin(step * GROWTH, fmax(WIDEST_RAD, step));
        angle += step;
    }
    return count;
}

static uint32_t fill_rows(const water_setup *s, const lattice_view *v, double scale, double *out)
{
    uint32_t count = 0;
    double r = 0.0;
    for (;;) {
        if (out)
            out[count] = r;
        count++;
        if (r >= v->far_m)
            return count;
        double way = hypot(r, v->height_m), rise = (v->height_m + s->march.fall * r * r) / way;
        double width = scale * fmax(v->step_rad * way, v->width_m);
        double step = v->width_m > 0.0 ? width : (double)water_march_footprint(&s->march, (float)width, rise);
        r += fmax(fmin(step, fmax(LONGEST * r, width)), 1e-3);
    }
}

/* The larger of both neighbors' distances. */
static void fill_steps(const double *at, uint32_t count, double *steps)
{
    for (uint32_t i = 0; i < count; i++) {
        double before = i ? at[i] - at[i - 1] : 0.0, after = i + 1 < count ? at[i + 1] - at[i] : 0.0;
        steps[i] = fmax(before, after);
    }
}

/* The half is mirrored; where both ends meet there is a column twice. */
static void fill_columns(const lattice_view *v, double scale, water_mesh_lattice *l)
{
    uint32_t half = (l->column_count + 1) / 2;
    double *right = l->azimuths + half - 1;
    fill_half(v, scale, right);
    right[half - 1] = 0.5 * TURN;
    for (uint32_t i = 1; i < half; i++)
        right[-(ptrdiff_t)i] = -right[i];
    for (uint32_t i = 0; i < l->column_count; i++)
        l->azimuths[i] += v->middle;
}

bool water_mesh_lattice_create(const water_setup *s, uint32_t most, arena *memory, water_mesh_lattice *l)
{
    memset(l, 0, sizeof *l);
    lattice_view v = view_of(s, l);
    double scale = FINEST;
    for (;;) {
        l->column_count = 2 * (fill_half(&v, scale, NULL) + 1) - 1;
        l->row_count = fill_rows(s, &v, scale, NULL);
        double count = (double)l->column_count * (double)l->row_count;
        if (count <= (double)most)
            break;
        scale *= fmax(sqrt(count / (double)most), 1.01);
    }
    l->azimuths = arena_alloc(memory, l->column_count, sizeof(double));
    l->radii = arena_alloc(memory, l->row_count, sizeof(double));
    l->column_steps = arena_alloc(memory, l->column_count, sizeof(double));
    l->row_steps = arena_alloc(memory, l->row_count, sizeof(double));
    if (!l->azimuths || !l->radii || !l->column_steps || !l->row_steps)
        return false;
    fill_columns(&v, scale, l);
    fill_rows(s, &v, scale, l->radii);
    fill_steps(l->azimuths, l->column_count, l->column_steps);
    fill_steps(l->radii, l->row_count, l->row_steps);
    return true;
}
