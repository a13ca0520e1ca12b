/* water_mesh.c - see water_mesh.h: the lattice, vertices and triangles of the surface, and triangles that a
 * hull cuts. */
#include "base/memory.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/result.h"
#include "water/water_mesh.h"
#include "water/water_objects.h"
#include "water/water_place.h"

/* The footprint equals the vertex spacing. */
static const double WIDTH_OF_SPACING = 1.0;
enum { HALVINGS = 14 };

typedef struct surface {
    const water_setup *s;
    const water_mesh_lattice *l;
    render_watch *watch; /* NULL: never stopped */
    float *positions, *normals, *water;
    unsigned char *is_dry;
    uint32_t *indices;
    uint32_t vertex_count, index_count;
} surface;

/* ---- vertices ---- */

static double fallen(const water_setup *s, const water_mesh_lattice *l, double X, double Z)
{
    double x = X - l->center[0], z = Z - l->center[1];
    return s->march.fall * (x * x + z * z);
}

static void fill_water(const water_setup *s, const double rest[2], float footprint, float *out)
{
    water_slopes slopes = water_slopes_at(s, footprint);
    for (int i = 0; i < 3; i++)
        out[i] = slopes.covariance[i];
    out[3] = water_foam_at(s, rest, footprint);
}

static void fill_vertex(const surface *f, uint32_t row, uint32_t column)
{
    const water_setup *s = f->s;
    const water_mesh_lattice *l = f->l;
    double r = l->radii[row], a = l->azimuths[column];
    const double rest[2] = {l->center[0] + r * cos(a), l->center[1] + r * sin(a)};
    double spacing = fmax(l->row_steps[row], r * l->column_steps[column]);
    float footprint = (float)(WIDTH_OF_SPACING * spacing);
    wave_point p = waves_at(&s->sea->waves, rest[0], rest[1], footprint);
    wave_shape shape = wave_shape_of(&p);
    size_t at = (size_t)row * l->column_count + column;
    double X = rest[0] + (double)p.displacement[0], Z = rest[1] + (double)p.displacement[1];
    f->positions[3 * at] = (float)X;
    f->positions[3 * at + 1] = (float)((double)p.height_m - fallen(s, l, X, Z));
    f->positions[3 * at + 2] = (float)Z;
    memcpy(f->normals + 3 * at, shape.normal, sizeof shape.normal);
    fill_water(s, rest, footprint, f->water + SCENE_WATER_VALUES * at);
}

static void fill_rows(void *context, size_t begin, size_t end)
{
    const surface *f = context;
    for (size_t row = begin; row < end && !(f->watch && render_watch_is_stopped(f->watch)); row++) {
        for (uint32_t column = 0; column < f->l->column_count; column++)
            fill_vertex(f, (uint32_t)row, column);
        if (f->watch)
            render_watch_look(f->watch);
    }
}

/* The last column is the first: no seam. */
static void close_circle(const surface *f)
{
    uint32_t count = f->l->column_count;
    for (size_t row = 0; row < f->l->row_count; row++) {
        size_t from = row * count, to = from + count - 1;
        memcpy(f->positions + 3 * to, f->positions + 3 * from, 3 * sizeof(float));
        memcpy(f->normals + 3 * to, f->normals + 3 * from, 3 * sizeof(float));
        memcpy(f->water + SCENE_WATER_VALUES * to, f->water + SCENE_WATER_VALUES * from,
               SCENE_WATER_VALUES * sizeof(float));
    }
}

/* ---- hulls ---- */

static bool is_dry(const surface *f, const float P[3])
{
    return water_model_is_dry(&f->s->model, (const double[3]){(double)P[0], (double)P[1], (double)P[2]});
}

static void find_dry(void *context, size_t begin, size_t end)
{
    const surface *f = context;
    for (size_t i = begin; i < end; i++)
        f->is_dry[i] = is_dry(f, f->positions + 3 * i);
}

static void mix_values(float *values, uint32_t width, uint32_t a, uint32_t b, float share, uint32_t to)
{
    for (uint32_t i = 0; i < width; i++) {
        float x = values[(size_t)width * a + i], y = values[(size_t)width * b + i];
        values[(size_t)width * to + i] = x + (y - x) * share;
    }
}

/* A new vertex on an edge from a wet to a dry vertex, at the waterline. */
static uint32_t cut(surface *f, uint32_t wet, uint32_t dry)
{
    float low = 0.0f, high = 1.0f;
    uint32_t to = f->vertex_count++;
    for (int i = 0; i < HALVINGS; i++) {
        float middle = 0.5f * (low + high);
        mix_values(f->positions, 3, wet, dry, middle, to);
        if (is_dry(f, f->positions + 3 * (size_t)to))
            high = middle;
        else
            low = middle;
    }
    mix_values(f->positions, 3, wet, dry, high, to);
    mix_values(f->normals, 3, wet, dry, high, to);
    mix_values(f->water, SCENE_WATER_VALUES, wet, dry, high, to);
    return to;
}

static void put(surface *f, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t corners[3] = {a, b, c};
    memcpy(f->indices + f->index_count, corners, sizeof corners);
    f->index_count += 3;
}

/* The wet part of a triangle. */
static void put_wet(surface *f, const uint32_t corners[3])
{
    int count = 0, first = 0;
    for (int i = 0; i < 3; i++)
        count += !f->is_dry[corners[i]];
    if (count == 0)
        return;
    if (count == 3) {
        put(f, corners[0], corners[1], corners[2]);
        return;
    }
    while (f->is_dry[corners[first]] != (count == 2)) /* the vertex that differs from the two others */
        first++;
    uint32_t a = corners[first], b = corners[(first + 1) % 3], c = corners[(first + 2) % 3];
    if (count == 1) {
        uint32_t ab = cut(f, a, b), ac = cut(f, a, c);
        put(f, a, ab, ac);
    } else {
        uint32_t ab = cut(f, b, a), ac = cut(f, c, a);
        put(f, ab, b, c);
        put(f, ab, c, ac);
    }
}

/* ---- triangles ---- */

/* Triangles of one quad, facing up; one at the innermost ring, which has no inner edge. */
static uint32_t corners_of(const water_mesh_lattice *l, size_t square, uint32_t out[2][3])
{
    uint32_t columns = l->column_count, row = (uint32_t)(square / (columns - 1));
    uint32_t a = row * columns + (uint32_t)(square % (columns - 1)), b = a + columns;
    const uint32_t both[2][3] = {{a, b + 1, b}, {a, a + 1, b + 1}};
    memcpy(out, both, sizeof both);
    return row ? 2 : 1;
}

/* Clips triangles at a hull. */
static size_t count_cut(const surface *f)
{
    const water_mesh_lattice *l = f->l;
    size_t squares = (size_t)(l->column_count - 1) * (l->row_count - 1), count = 0;
    for (size_t i = 0; i < squares; i++) {
        uint32_t corners[2][3];
        uint32_t n = corners_of(l, i, corners);
        for (uint32_t t = 0; t < n; t++) {
            int dry = f->is_dry[corners[t][0]] + f->is_dry[corners[t][1]] + f->is_dry[corners[t][2]];
            count += dry == 1 || dry == 2;
        }
    }
    return count;
}

static void fill_triangles(surface *f)
{
    const water_mesh_lattice *l = f->l;
    size_t squares = (size_t)(l->column_count - 1) * (l->row_count - 1);
    for (size_t i = 0; i < squares; i++) {
        uint32_t corners[2][3];
        uint32_t n = corners_of(l, i, corners);
        for (uint32_t t = 0; t < n; t++)
            put_wet(f, corners[t]);
    }
}

static void bound(scene_primitive *p)
{
    for (int k = 0; k < 3; k++) {
        p->bounds_min[k] = p->bounds_max[k] = p->positions[k];
        for (uint32_t i = 1; i < p->vertex_count; i++) {
            p->bounds_min[k] = min(p->bounds_min[k], p->positions[3 * (size_t)i + (size_t)k]);
            p->bounds_max[k] = max(p->bounds_max[k], p->positions[3 * (size_t)i + (size_t)k]);
        }
    }
}

/* The number of vertices that a hull adds is only known with its triangles: arrays are reallocated. */
static bool grow(surface *f, arena *memory, size_t cuts)
{
    size_t count = (size_t)f->vertex_count + 2 * cuts;
    float *positions = arena_alloc(memory, count, 3 * sizeof(float));
    float *normals = arena_alloc(memory, count, 3 * sizeof(float));
    float *water = arena_alloc(memory, count, SCENE_WATER_VALUES * sizeof(float));
    if (!positions || !normals || !water)
        return false;
    memcpy(positions, f->positions, f->vertex_count * 3 * sizeof(float));
    memcpy(normals, f->normals, f->vertex_count * 3 * sizeof(float));
    memcpy(water, f->water, f->vertex_count * SCENE_WATER_VALUES * sizeof(float));
    f->positions = positions;
    f->normals = normals;
    f->water = water;
    return true;
}

static scene_primitive primitive_of(const surface *f)
{
    scene_primitive p = {.mode = SCENE_TRIANGLES,
                         .vertex_count = f->vertex_count,
                         .index_count = f->index_count,
                         .indices = f->indices,
                         .positions = f->positions,
                         .normals = f->normals,
                         .water = f->water};
    bound(&p);
    return p;
}

bool water_mesh_surface(const water_setup *s, const water_mesh_lattice *l, render_watch *watch, arena *memory,
                        scene_primitive *out)
{
    size_t vertices = (size_t)l->column_count * l->row_count;
    size_t triangles = 2 * (size_t)(l->column_count - 1) * (l->row_count - 1), cuts = 0;
    uint32_t threads = s->desc->thread_count;
    surface f = {.s = s, .l = l, .watch = watch, .vertex_count = (uint32_t)vertices};
    f.positions = arena_alloc(memory, vertices, 3 * sizeof(float));
    f.normals = arena_alloc(memory, vertices, 3 * sizeof(float));
    f.water = arena_alloc(memory, vertices, SCENE_WATER_VALUES * sizeof(float));
    f.is_dry = arena_zalloc(memory, vertices, 1);
    if (!f.positions || !f.normals || !f.water || !f.is_dry)
        return false;
    *out = (scene_primitive){0};
    parallel_for(threads, l->row_count, 4, fill_rows, &f);
    if (watch && render_watch_is_stopped(watch))
        return true;
    close_circle(&f);
    if (s->model.is_there) {
        parallel_for(threads, vertices, 256, find_dry, &f);
        cuts = count_cut(&f);
    }
    f.indices = arena_alloc(memory, triangles + cuts, 3 * sizeof(uint32_t));
    if (!f.indices || (cuts > 0 && !grow(&f, memory, cuts)))
        return false;
    fill_triangles(&f);
    *out = primitive_of(&f);
    return true;
}

/* ---- the bed ---- */

enum { BED_COLUMNS = 129, BED_ROWS = 96 };
static const double BED_NEAREST_M = 0.5;

/* Rings whose radii grow by a constant factor: between two of them the plane drops by less than is visible. */
bool water_mesh_bed(const water_setup *s, const water_mesh_lattice *l, arena *memory, scene_primitive *out)
{
    const facet_sea_bed *bed = &s->sea->desc.bed;
    const size_t vertices = (size_t)BED_COLUMNS * BED_ROWS;
    water_mesh_lattice rings = {.column_count = BED_COLUMNS, .row_count = BED_ROWS};
    surface f = {.s = s, .l = &rings, .vertex_count = (uint32_t)vertices};
    f.positions = arena_alloc(memory, vertices, 3 * sizeof(float));
    f.normals = arena_alloc(memory, vertices, 3 * sizeof(float));
    f.is_dry = arena_zalloc(memory, vertices, 1);
    f.indices = arena_alloc(memory, 2 * (size_t)(BED_COLUMNS - 1) * (BED_ROWS - 1), 3 * sizeof(uint32_t));
    if (!f.positions || !f.normals || !f.is_dry || !f.indices)
        return false;
    double far_m = l->radii[l->row_count - 1];
    vec3 N = water_bed_normal(bed);
    for (size_t at = 0; at < vertices; at++) {
        uint32_t row = (uint32_t)(at / BED_COLUMNS),
                 column = (uint32_t)(at % BED_COLUMNS) % (BED_COLUMNS - 1);
        double r = row ? BED_NEAREST_M * pow(far_m / BED_NEAREST_M, (row - 1.0) / (BED_ROWS - 2.0)) : 0.0;
        double a = 6.283185307179586 * column / (BED_COLUMNS - 1);
        double X = l->center[0] + r * cos(a), Z = l->center[1] + r * sin(a);
        f.positions[3 * at] = (float)X;
        f.positions[3 * at + 1] = (float)(water_bed_height(bed, X, Z) - fallen(s, l, X, Z));
        f.positions[3 * at + 2] = (float)Z;
        for (size_t i = 0; i < 3; i++)
            f.normals[3 * at + i] = N[i];
    }
    fill_triangles(&f);
    *out = primitive_of(&f);
    return true;
}

/* ---- the lattice ---- */

static const double TURN = 6.283185307179586;
static const double NEAREST_M = 0.2;  /* minimum height of the eye above the water, for the spacing */
static const double WIDEST_RAD = 0.1; /* between columns behind the eye */
static const double GROWTH = 1.15;    /* ratio of successive columns beside the image */
static const double BEYOND_M = 20e3;  /* beyond the horizon, or of the extent where there is none */
static const double LONGEST = 0.05;   /* relative to the distance, between rows */
static const double FINEST = 0.5;     /* of a pixel: samples are finer than pixels */
static const double PARALLEL = 0.004; /* rad between columns, where rays are parallel */

/* Parameters of the spacing. */
typedef struct lattice_view {
    double middle, half; /* azimuth range of the image */
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
    if (c->is_orthographic) { /* around the image center */
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

/* Columns of one half of the circle, from the image center on; out NULL: counts only. */
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

static uint32_t fill_radii(const water_setup *s, const lattice_view *v, double scale, double *out)
{
    uint32_t count = 0;
    double r = 0.0;
    for (;;) {
        if (out)
            out[count] = r;
        count++;
        if (r >= v->far_m)
            return count;
        double distance_m = hypot(r, v->height_m), rise = (v->height_m + s->march.fall * r * r) / distance_m;
        double width = scale * fmax(v->step_rad * distance_m, v->width_m);
        double step = v->width_m > 0.0 ? width : (double)water_march_footprint(&s->march, (float)width, rise);
        r += fmax(fmin(step, fmax(LONGEST * r, width)), 1e-3);
    }
}

/* The larger of the distances to both neighbors. */
static void fill_steps(const double *at, uint32_t count, double *steps)
{
    for (uint32_t i = 0; i < count; i++) {
        double before = i ? at[i] - at[i - 1] : 0.0, after = i + 1 < count ? at[i + 1] - at[i] : 0.0;
        steps[i] = fmax(before, after);
    }
}

/* The half is mirrored; where both ends meet, a column is doubled. */
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
        l->row_count = fill_radii(s, &v, scale, NULL);
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
    fill_radii(s, &v, scale, l->radii);
    fill_steps(l->azimuths, l->column_count, l->column_steps);
    fill_steps(l->radii, l->row_count, l->row_steps);
    return true;
}

/* ---- triangles beside a model ---- */

/* 70 bytes each with their two triangles, and about as much again for the BVH. */
enum { MAX_VERTICES = 2000000 };

static bool fill(const water_setup *s, facet_scene *scene, const facet_scene *with, render_watch *watch)
{
    scene_primitive water, bed;
    water_mesh_lattice l;
    bool has_bed = water_has_bed(s);
    return water_mesh_lattice_create(s, MAX_VERTICES, scene->arena, &l) &&
           water_mesh_surface(s, &l, watch, scene->arena, &water) &&
           (!has_bed || water_mesh_bed(s, &l, scene->arena, &bed)) &&
           water_objects_add(with, s->sea, &water, has_bed ? &bed : NULL, scene);
}

facet_result water_mesh_scene(const water_setup *s, const facet_scene *with, double deadline_s,
                              facet_scene **out, facet_error *error)
{
    *out = NULL;
    render_watch watch;
    render_watch_init(&watch, &s->desc->progress, "prepare", deadline_s, 1.0);
    facet_scene *scene;
    facet_result result = scene_create(&s->desc->allocator, "sea", &scene, error);
    if (result != FACET_OK)
        return result;
    result = fill(s, scene, with, &watch)
                 ? render_watch_explain(&watch, error)
                 : fail_memory(error, "triangles of a sea", (size_t)MAX_VERTICES * 70);
    if (result == FACET_OK)
        *out = scene;
    else
        scene_destroy(scene);
    return result;
}
