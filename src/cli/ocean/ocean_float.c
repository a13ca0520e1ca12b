/* ocean_float.c - a floating model (--with), which follows the best-fit plane of the water below it. */
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
 * distance in units of that of the nearest visible water. */
static const double FARTHEST = 1e6, SIZE_AWAY = 1.2, NEAREST = 1.15;

/* Sizes that cause a warning: m; peak wavelengths; pixels. The longest ship has 458 m. */
static const double MAX_SIZE = 1000.0, MAX_WAVES = 30.0, MIN_PIXELS = 2.0;

enum { GRID = 9 }; /* points along an edge of the footprint */

/* MODEL[@X,Z[,HEADING]]; an @ before a file's extension is part of its name. */
static facet_result read_berth(const ocean_run *run, char *path, size_t size, ocean_berth *out,
                               facet_error *error)
{
    const char *text = run->options.model, *at = strrchr(text, '@');
    *out = (ocean_berth){.has_place = false};
    double *n = out->numbers;
    if (at && !strpbrk(at, "./\\") && !strpbrk(at, "0123456789"))
        at = NULL;
    out->has_place = at && (value_numbers(at + 1, 2, n) || value_numbers(at + 1, 3, n));
    size_t length = out->has_place ? (size_t)(at - text) : strlen(text);
    bool is_far = fabs(n[0]) > FARTHEST || fabs(n[1]) > FARTHEST || fabs(n[2]) > FARTHEST;
    if (length == 0 || length >= size || is_far || (at && !out->has_place && !strchr(at, '.')))
        return option_fail(run->base.line, OPT_WITH,
                           "MODEL, MODEL@X,Z or MODEL@X,Z,DEGREES, in metres from -1e6 to 1e6", error);
    memcpy(path, text, length);
    path[length] = 0;
    return FACET_OK;
}

/* Warns of a model far from its file's origin: it floats near the origin of the sea. */
static void warn_of_origin(ocean_run *run, const char *path)
{
    double origin[3];
    facet_scene_get_origin(run->model, origin);
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

facet_result ocean_float_load(ocean_run *run, facet_error *error)
{
    char path[4096];
    facet_result result = read_berth(run, path, sizeof path, &run->berth, error);
    if (result != FACET_OK)
        return result;
    bool is_ogl1 = run->options.render.desc.shading == FACET_SHADING_OGL1;
    const facet_scene_desc desc = {.allocator = run->base.allocator,
                                   .log = messages_log(&run->base.messages),
                                   .thread_count = run->options.render.limits.thread_count,
                                   .max_texture_size = run->options.render.limits.max_texture_size,
                                   .legacy.keeps_materials = is_ogl1};
    interrupt_begin_reading(path);
    result = input_load(path, &desc, &run->model, error);
    if (result == FACET_OK && is_ogl1)
        result = facet_scene_convert_materials(run->model, FACET_MATERIAL_MODEL_OGL1, &desc.legacy, &desc.log,
                                               error);
    interrupt_end();
    if (result != FACET_OK)
        return result;
    /* before it is moved */
    if (!facet_scene_get_bounds(run->model, NULL, run->model_low, run->model_high))
        return fail(error, FACET_ERROR_ARGUMENT, "%s: it has no geometry to float", path);
    warn_of_origin(run, path);
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
static void matrix_of(const plane *p, const ocean_berth *b, float m[16])
{
    double c = cos(b->numbers[2] * DEGREE), s = sin(b->numbers[2] * DEGREE);
    double length = sqrt(1.0 + p->slope_x * p->slope_x + p->slope_z * p->slope_z);
    double n[3] = {-p->slope_x / length, 1.0 / length, -p->slope_z / length};
    double k = 1.0 / (1.0 + n[1]);
    const double tilt[3][3] = {{1.0 - k * n[0] * n[0], n[0], -k * n[0] * n[2]},
                               {-n[0], n[1], -n[2]},
                               {-k * n[0] * n[2], n[2], 1.0 - k * n[2] * n[2]}};
    const double turn[3][3] = {{c, 0.0, s}, {0.0, 1.0, 0.0}, {-s, 0.0, c}};
    const double to[3] = {b->numbers[0], p->height, b->numbers[1]};
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

/* Places the model ahead of the camera, all of it visible, with water in front. */
static void find_berth(ocean_run *run)
{
    const facet_camera camera = ocean_run_camera(run, &run->options);
    const float *low = run->model_low, *high = run->model_high;
    double x = (double)camera.target[0] - (double)camera.eye[0];
    double y = (double)camera.target[1] - (double)camera.eye[1];
    double z = (double)camera.target[2] - (double)camera.eye[2];
    double level = hypot(x, z), half = 0.5 * (double)camera.fov_y_rad;
    double width = fmax((double)high[0] - (double)low[0], (double)high[2] - (double)low[2]);
    double size = fmax(width, (double)high[1] - (double)low[1]);
    double lowest =
        tan(fmin(fmax(half - atan2(y, level), 0.05), 1.5)); /* edge of the image, below the level */
    double away = fmax(SIZE_AWAY * size / tan(half), NEAREST * fabs((double)camera.eye[1]) / lowest + width);
    run->berth.has_place = true;
    run->berth.numbers[0] = (double)camera.eye[0] + (level > 0.0 ? x / level * away : 0.0);
    run->berth.numbers[1] = (double)camera.eye[2] + (level > 0.0 ? z / level * away : 0.0);
}

/* Degrees from +Z towards +X, [0, 360). */
static double azimuth_of(double x, double z)
{
    double degrees = atan2(x, z) / DEGREE;
    return degrees < -0.5 ? degrees + 360.0 : fabs(degrees);
}

/* Warns if a given position is out of view, since the default heading follows the sun: if the bounding
 * sphere is outside of the cone around the image. */
static void warn_of_view(ocean_run *run)
{
    const facet_camera camera = ocean_run_camera(run, &run->options);
    const facet_render_desc *r = &run->options.render.desc;
    const float *low = run->model_low, *high = run->model_high;
    double size[3], to[3], along[3];
    const double at[3] = {run->berth.numbers[0], 0.0, run->berth.numbers[1]};
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
    char text[256];
    snprintf(text, sizeof text,
             "--with: the model at %g, %g is out of view: it lies towards %.0f degrees, and the camera looks "
             "towards %.0f (--heading, --target)",
             at[0], at[2], azimuth_of(to[0], to[2]), azimuth_of(along[0], along[2]));
    facet_log log = messages_log(&run->base.messages);
    log_warning(&log, "%s", text);
}

/* Height in the image of the bounding sphere, pixels; the camera may be inside. */
static double pixels_of(const ocean_run *run, double size)
{
    const facet_camera camera = ocean_run_camera(run, &run->options);
    double x = run->berth.numbers[0] - (double)camera.eye[0],
           z = run->berth.numbers[1] - (double)camera.eye[2];
    double away = fmax(hypot(hypot(x, z), (double)camera.eye[1]), 0.5 * size);
    return size / away / (2.0 * tan(0.5 * (double)camera.fov_y_rad)) * run->options.render.desc.height;
}

/* Warns of implausible sizes: a model in millimetres is a thousand times too large, one in kilometres
 * invisible. */
static void warn_of_size(ocean_run *run)
{
    const float *low = run->model_low, *high = run->model_high;
    double size = 0.0;
    for (int i = 0; i < 3; i++)
        size = fmax(size, (double)high[i] - (double)low[i]);
    const facet_sea_info sea = facet_sea_get_info(run->sea);
    double pixels = pixels_of(run, size);
    char text[512] = "";
    if (size > MAX_SIZE || (sea.peak_length_m > 0.0 && size > MAX_WAVES * sea.peak_length_m))
        snprintf(text, sizeof text,
                 "--with: the model is %.3g m large, and the highest waves are %.2g m high and %.3g m long; "
                 "models are in metres",
                 size, sea.height_m, sea.peak_length_m);
    else if (pixels < MIN_PIXELS)
        snprintf(text, sizeof text,
                 "--with: the model is %.3g m large, which is %.2g pixels of the image; models are in "
                 "metres, and MODEL@X,Z moves it nearer",
                 size, pixels);
    else if (high[1] < 0.0f)
        snprintf(
            text, sizeof text,
            "--with: the model is %.3g m large and %.3g m or more under water: its water line is y = 0, and "
            "it reaches from y = %.3g to %.3g m",
            size, -(double)high[1], (double)low[1], (double)high[1]);
    facet_log log = messages_log(&run->base.messages);
    if (*text)
        log_warning(&log, "%s", text);
}

facet_result ocean_float_place(ocean_run *run, facet_error *error)
{
    bool is_first = !run->is_afloat && run->options.has_image && !run->options.sweep;
    if (run->berth.has_place && is_first)
        warn_of_view(run);
    run->is_afloat = true;
    if (!run->berth.has_place)
        find_berth(run);
    if (is_first)
        warn_of_size(run);
    const ocean_berth b = run->berth;
    double c = cos(b.numbers[2] * DEGREE), s = sin(b.numbers[2] * DEGREE);
    double around[GRID * GRID][2], places[GRID * GRID][2];
    facet_sea_point points[GRID * GRID];
    const float *low = run->model_low, *high = run->model_high;
    for (int i = 0; i < GRID * GRID; i++) {
        double u = (double)(i % GRID) / (GRID - 1), v = (double)(i / GRID) / (GRID - 1);
        double x = (double)low[0] + u * ((double)high[0] - (double)low[0]);
        double z = (double)low[2] + v * ((double)high[2] - (double)low[2]);
        around[i][0] = c * x + s * z;
        around[i][1] = c * z - s * x;
        places[i][0] = b.numbers[0] + around[i][0];
        places[i][1] = b.numbers[1] + around[i][1];
    }
    facet_sea_get_points(run->sea, places[0], (size_t)GRID * GRID, points);
    plane p = fit_plane((const double(*)[2])around, points, (size_t)GRID * GRID);
    matrix_of(&p, &b, run->model_pose);
    return facet_scene_place(run->model, run->model_pose, error);
}
