/* ocean_float.c - floating models (--with), which follow the best-fit plane of the water below them. */
#include "cli/ocean/ocean_run.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/value.h"

#define DEGREE 0.017453292519943295 /* pi / 180 */

/* Placement: farthest position, m; distance in units of that at which the model fills the image height;
 * distance in units of that of the nearest visible water; room in a row in units of the width. */
static const double FARTHEST = 1e6, SIZE_AWAY = 1.2, NEAREST = 1.15, ROW_SPACING = 1.5;

/* Sizes that cause a warning: m; peak wavelengths; pixels. The longest ship has 458 m. */
static const double MAX_SIZE = 1000.0, MAX_WAVES = 30.0, MIN_PIXELS = 2.0;

enum { GRID = 9 }; /* points along an edge of the footprint */

/* MODEL[@X,Z[,HEADING]]; an @ before a file's extension is part of its name. */
static facet_result read_berth(const char *text, ocean_model *out, facet_error *error)
{
    const char *at = strrchr(text, '@');
    double *n = out->berth;
    if (at && !strpbrk(at, "./\\") && !strpbrk(at, "0123456789"))
        at = NULL;
    out->is_placed = at && (value_numbers(at + 1, 2, n) || value_numbers(at + 1, 3, n));
    size_t length = out->is_placed ? (size_t)(at - text) : strlen(text);
    bool is_far = fabs(n[0]) > FARTHEST || fabs(n[1]) > FARTHEST || fabs(n[2]) > FARTHEST;
    if (length == 0 || length >= sizeof out->path || is_far || (at && !out->is_placed && !strchr(at, '.')))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--with: \"%s\" is not MODEL, MODEL@X,Z or MODEL@X,Z,DEGREES, in metres from -1e6 to 1e6",
                    text);
    memcpy(out->path, text, length);
    out->path[length] = 0;
    return FACET_OK;
}

/* Warns of a model far from its file's origin: it floats near the origin of the sea. */
static void warn_of_origin(ocean_run *run, const facet_scene *scene, const char *path)
{
    double origin[3];
    facet_scene_get_origin(scene, origin);
    if (origin[0] == 0.0 && origin[1] == 0.0 && origin[2] == 0.0)
        return;
    char text[4400];
    snprintf(text, sizeof text,
             "--with: %s is far from the origin of its file; it floats as if the origin were at %.15g, "
             "%.15g, %.15g",
             path, origin[0], origin[1], origin[2]);
    facet_log log = messages_log(&run->base.messages);
    log_warning(&log, "%s", text);
}

/* Loads a model and makes it a part of run->model. */
static facet_result load_model(ocean_run *run, ocean_model *m, facet_error *error)
{
    const render_options *o = &run->options.render;
    const facet_scene_desc desc = verb_run_scene_desc(&run->base);
    facet_scene *scene = NULL;
    interrupt_begin_reading(m->path);
    facet_result result = input_load_shaded(m->path, &desc, o->desc.shading, &scene, error);
    interrupt_end();
    if (result == FACET_OK && !facet_scene_get_bounds(scene, NULL, m->low, m->high)) /* before it is moved */
        result = fail(error, FACET_ERROR_ARGUMENT, "%s: it has no geometry to float", m->path);
    if (result == FACET_OK)
        warn_of_origin(run, scene, m->path);
    if (result == FACET_OK && run->model)
        result = facet_scene_append(run->model, scene, error);
    else if (result == FACET_OK)
        run->model = scene;
    if (result != FACET_OK)
        facet_scene_destroy(scene);
    return result;
}

facet_result ocean_float_load(ocean_run *run, facet_error *error)
{
    const ocean_options *o = &run->options;
    if (!o->model_count)
        return FACET_OK;
    run->models = calloc(o->model_count, sizeof *run->models);
    if (!run->models)
        return fail(error, FACET_ERROR_MEMORY, "out of memory: models");
    for (uint32_t i = 0; i < o->model_count; i++)
        TRY(read_berth(o->models[i], &run->models[i], error));
    for (uint32_t i = 0; i < o->model_count; i++)
        TRY(load_model(run, &run->models[i], error));
    if (o->render.desc.shading == FACET_SHADING_OGL1 && !facet_scene_has_legacy_materials(run->model))
        return fail(
            error, FACET_ERROR_ARGUMENT,
            "--shading: rgl's parameters and other models obey different rules of OpenGL 1; place one "
            "kind of them");
    facet_camera camera;
    run->has_camera = o->render.camera != NULL;
    if (run->has_camera) {
        TRY(facet_scene_find_camera(run->model, o->render.camera, &run->camera, error));
        TRY(facet_camera_from_scene(run->model, NULL, run->camera, &camera, error));
    }
    return FACET_OK;
}

/* y = height + slope_x x + slope_z z over a grid around the origin of its axes. */
typedef struct plane {
    double height, slope_x, slope_z;
} plane;

static plane fit_plane(const double (*places)[2], const facet_sea_point *points, size_t count)
{
    double sum = 0.0, x_sum = 0.0, z_sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        sum += (double)points[i].height_m / (double)count;
        x_sum += places[i][0] / (double)count;
        z_sum += places[i][1] / (double)count;
    }
    double xx = 0.0, zz = 0.0, xz = 0.0, xy = 0.0, zy = 0.0;
    for (size_t i = 0; i < count; i++) {
        double x = places[i][0] - x_sum, z = places[i][1] - z_sum, y = (double)points[i].height_m - sum;
        xx += x * x, zz += z * z, xz += x * z, xy += x * y, zy += z * y;
    }
    double determinant = xx * zz - xz * xz;
    if (!(determinant > 1e-12 * xx * zz)) /* zero width */
        return (plane){.height = sum};
    plane p = {.slope_x = (xy * zz - zy * xz) / determinant, .slope_z = (zy * xx - xy * xz) / determinant};
    p.height = sum - p.slope_x * x_sum - p.slope_z * z_sum;
    return p;
}

/* Columns of the pose: rotation by the heading about +Y, then of +Y to the plane's normal, then the
 * translation. */
static void matrix_of(const plane *p, const double berth[3], float m[16])
{
    double c = cos(berth[2] * DEGREE), s = sin(berth[2] * DEGREE);
    double length = sqrt(1.0 + p->slope_x * p->slope_x + p->slope_z * p->slope_z);
    double n[3] = {-p->slope_x / length, 1.0 / length, -p->slope_z / length};
    double k = 1.0 / (1.0 + n[1]);
    const double tilt[3][3] = {{1.0 - k * n[0] * n[0], n[0], -k * n[0] * n[2]},
                               {-n[0], n[1], -n[2]},
                               {-k * n[0] * n[2], n[2], 1.0 - k * n[2] * n[2]}};
    const double turn[3][3] = {{c, 0.0, s}, {0.0, 1.0, 0.0}, {-s, 0.0, c}};
    const double to[3] = {berth[0], p->height, berth[1]};
    for (int column = 0; column < 3; column++) {
        for (int row = 0; row < 3; row++) {
            double sum = 0.0;
            for (int i = 0; i < 3; i++)
                sum += tilt[row][i] * turn[i][column];
            m[4 * column + row] = (float)sum;
        }
        m[4 * column + 3] = 0.0f;
        m[12 + column] = (float)to[column];
    }
    m[15] = 1.0f;
}

/* The extent of a model on the water, and its largest one, m. */
static double width_of(const ocean_model *m)
{
    return fmax((double)m->high[0] - (double)m->low[0], (double)m->high[2] - (double)m->low[2]);
}

static double size_of(const ocean_model *m)
{
    return fmax(width_of(m), (double)m->high[1] - (double)m->low[1]);
}

/* Places the models without a position ahead of the camera, side by side, all of them visible, with water in
 * front. */
static void find_berths(ocean_run *run)
{
    const facet_camera camera = ocean_run_camera(run, &run->options);
    double x = (double)camera.target[0] - (double)camera.eye[0];
    double y = (double)camera.target[1] - (double)camera.eye[1];
    double z = (double)camera.target[2] - (double)camera.eye[2];
    double level = hypot(x, z), half = 0.5 * (double)camera.fov_y_rad;
    double row = 0.0, size = 0.0, width = 0.0;
    for (uint32_t i = 0; i < run->options.model_count; i++) {
        const ocean_model *m = &run->models[i];
        if (m->is_placed)
            continue;
        row += width_of(m) * (row > 0.0 ? ROW_SPACING : 1.0);
        width = fmax(width, width_of(m));
        size = fmax(size, size_of(m));
    }
    if (row > width) /* several: their row is as wide as the image */
        size = fmax(size, row * run->options.render.desc.height / run->options.render.desc.width);
    /* the edge of the image, below the level */
    double lowest = tan(fmin(fmax(half - atan2(y, level), 0.05), 1.5));
    double away = fmax(SIZE_AWAY * size / tan(half), NEAREST * fabs((double)camera.eye[1]) / lowest + width);
    double along[2] = {level > 0.0 ? x / level : 0.0, level > 0.0 ? z / level : 0.0}, begin = -0.5 * row;
    for (uint32_t i = 0; i < run->options.model_count; i++) {
        ocean_model *m = &run->models[i];
        if (m->is_placed)
            continue;
        bool is_first = begin == -0.5 * row;
        double room = width_of(m) * (is_first ? 1.0 : ROW_SPACING), aside = begin + room - 0.5 * width_of(m);
        m->is_placed = true;
        m->berth[0] = (double)camera.eye[0] + along[0] * away - along[1] * aside;
        m->berth[1] = (double)camera.eye[2] + along[1] * away + along[0] * aside;
        begin += room;
    }
}

/* Degrees from +Z towards +X, [0, 360). */
static double azimuth_of(double x, double z)
{
    double degrees = atan2(x, z) / DEGREE;
    return degrees < -0.5 ? degrees + 360.0 : fabs(degrees);
}

/* The name of a model in warnings. */
static const char *subject_of(const ocean_run *run, const ocean_model *m)
{
    return run->options.model_count > 1 ? m->path : "the model";
}

/* Warns if a given position is out of view, since the default heading follows the sun: if the bounding
 * sphere is outside of the cone around the image. */
static void warn_of_view(ocean_run *run, const ocean_model *m)
{
    const facet_camera camera = ocean_run_camera(run, &run->options);
    const facet_render_desc *r = &run->options.render.desc;
    const float *low = m->low, *high = m->high;
    double size[3], to[3], along[3];
    const double at[3] = {m->berth[0], 0.0, m->berth[1]};
    for (int i = 0; i < 3; i++) {
        size[i] = fmax(fabs((double)low[i]), fabs((double)high[i]));
        to[i] = at[i] - (double)camera.eye[i];
        along[i] = (double)camera.target[i] - (double)camera.eye[i];
    }
    double radius = hypot(hypot(size[0], size[1]), size[2]);
    double away = hypot(hypot(to[0], to[1]), to[2]), length = hypot(hypot(along[0], along[1]), along[2]);
    if (away <= radius || !(length > 0.0))
        return;
    double width = r->height > 0 ? (double)r->width / (double)r->height : 1.0;
    double half = atan(tan(0.5 * (double)camera.fov_y_rad) * hypot(1.0, width));
    double apart = acos(
        fmax(fmin((to[0] * along[0] + to[1] * along[1] + to[2] * along[2]) / (away * length), 1.0), -1.0));
    if (apart - asin(radius / away) <= half)
        return;
    char text[4400];
    snprintf(text, sizeof text,
             "--with: %s at %g, %g is out of view: it lies towards %.0f degrees, and the camera looks "
             "towards %.0f (--heading, --target)",
             subject_of(run, m), at[0], at[2], azimuth_of(to[0], to[2]), azimuth_of(along[0], along[2]));
    facet_log log = messages_log(&run->base.messages);
    log_warning(&log, "%s", text);
}

/* Height in the image of the bounding sphere, pixels; the camera may be inside. */
static double pixels_of(const ocean_run *run, const ocean_model *m, double size)
{
    const facet_camera camera = ocean_run_camera(run, &run->options);
    double x = m->berth[0] - (double)camera.eye[0], z = m->berth[1] - (double)camera.eye[2];
    double away = fmax(hypot(hypot(x, z), (double)camera.eye[1]), 0.5 * size);
    return size / away / (2.0 * tan(0.5 * (double)camera.fov_y_rad)) * run->options.render.desc.height;
}

/* Warns of implausible sizes: a model in millimetres is a thousand times too large, one in kilometres
 * invisible. */
static void warn_of_size(ocean_run *run, const ocean_model *m)
{
    const float *low = m->low, *high = m->high;
    double size = 0.0;
    for (int i = 0; i < 3; i++)
        size = fmax(size, (double)high[i] - (double)low[i]);
    const facet_sea_info sea = facet_sea_get_info(run->sea);
    double pixels = pixels_of(run, m, size);
    char text[4600] = "";
    if (size > MAX_SIZE || (sea.peak_length_m > 0.0 && size > MAX_WAVES * sea.peak_length_m))
        snprintf(text, sizeof text,
                 "--with: %s is %.3g m large, and the highest waves are %.2g m high and %.3g m long; "
                 "models are in metres",
                 subject_of(run, m), size, sea.height_m, sea.peak_length_m);
    else if (pixels < MIN_PIXELS)
        snprintf(text, sizeof text,
                 "--with: %s is %.3g m large, which is %.2g pixels of the image; models are in "
                 "metres, and MODEL@X,Z moves it nearer",
                 subject_of(run, m), size, pixels);
    else if (high[1] < 0.0f)
        snprintf(text, sizeof text,
                 "--with: %s is %.3g m large and %.3g m or more under water: its water line is y = 0, and "
                 "it reaches from y = %.3g to %.3g m",
                 subject_of(run, m), size, -(double)high[1], (double)low[1], (double)high[1]);
    facet_log log = messages_log(&run->base.messages);
    if (*text)
        log_warning(&log, "%s", text);
}

/* Puts a model on the best-fit plane of the water below it. */
static facet_result place(ocean_run *run, uint32_t part, facet_error *error)
{
    ocean_model *m = &run->models[part];
    const double *berth = m->berth;
    double c = cos(berth[2] * DEGREE), s = sin(berth[2] * DEGREE);
    double around[GRID * GRID][2], places[GRID * GRID][2];
    facet_sea_point points[GRID * GRID];
    for (int i = 0; i < GRID * GRID; i++) {
        double u = (double)(i % GRID) / (GRID - 1), v = (double)(i / GRID) / (GRID - 1);
        double x = (double)m->low[0] + u * ((double)m->high[0] - (double)m->low[0]);
        double z = (double)m->low[2] + v * ((double)m->high[2] - (double)m->low[2]);
        around[i][0] = c * x + s * z;
        around[i][1] = c * z - s * x;
        places[i][0] = berth[0] + around[i][0];
        places[i][1] = berth[1] + around[i][1];
    }
    facet_sea_get_points(run->sea, places[0], (size_t)GRID * GRID, points);
    plane p = fit_plane((const double(*)[2])around, points, (size_t)GRID * GRID);
    matrix_of(&p, berth, m->pose);
    return facet_scene_place_part(run->model, part, m->pose, error);
}

facet_result ocean_float_place(ocean_run *run, facet_error *error)
{
    const ocean_options *o = &run->options;
    bool warns = !run->is_afloat && o->has_image && !o->sweep;
    for (uint32_t i = 0; i < o->model_count && warns; i++)
        if (run->models[i].is_placed && !run->has_camera)
            warn_of_view(run, &run->models[i]);
    if (!run->is_afloat)
        find_berths(run);
    for (uint32_t i = 0; i < o->model_count; i++)
        TRY(place(run, i, error));
    run->is_afloat = true;
    for (uint32_t i = 0; i < o->model_count && warns; i++)
        warn_of_size(run, &run->models[i]);
    return FACET_OK;
}
