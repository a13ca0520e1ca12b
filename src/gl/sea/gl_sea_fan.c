/* gl_sea_fan.c - see gl_sea_fan.h. */
#include "gl/sea/gl_sea_fan.h"

#include <math.h>

static const double CELL_PIXELS = 4.0, MOST_NODES = 6e5, LONGEST_M = 1e5;
static const double PI_D = 3.14159265358979323846;
static const double STEEPEST_LEVEL = 0.2; /* level part of rays that need no whole circle */
enum { PROBES = 33 };

static double turned(double azimuth, double from)
{
    double a = azimuth - from;
    return a - 2.0 * PI_D * floor(a / (2.0 * PI_D) + 0.5);
}

/* Azimuths that are seen; a whole circle where the eye looks up or down. */
static void find_azimuths(const camera_rays *rays, uint32_t width, uint32_t height, gl_sea_fan *fan)
{
    double middle = atan2((double)rays->direction[2], (double)rays->direction[0]), half = 0.0;
    for (int i = 0; i < PROBES * PROBES; i++) {
        float o[3], d[3];
        camera_rays_at(rays, (float)width * (float)(i % PROBES) / (PROBES - 1),
                       (float)height * (float)(i / PROBES) / (PROBES - 1), o, d);
        double level = hypot((double)d[0], (double)d[2]);
        bool is_steep = level < STEEPEST_LEVEL * hypot(level, (double)d[1]);
        half = fmax(half, is_steep ? PI_D : fabs(turned(atan2((double)d[2], (double)d[0]), middle)));
    }
    fan->azimuth = (float)middle;
    fan->half_azimuth = (float)fmin(half * 1.05 + 0.02, PI_D);
}

/* Distance at which all waves together are a tenth of a pixel high. */
static double last_waves(const sea_picture *p, double pixel_rad, double from)
{
    double r = from;
    for (; r < LONGEST_M; r *= 1.3) {
        wave_bounds there = waves_bounds(&p->sea->waves, (float)(pixel_rad * r));
        if ((double)(there.highest - there.lowest) < 0.1 * pixel_rad * r)
            break;
    }
    return r;
}

static double horizon_m(const sea_picture *p, double eye_y)
{
    return p->fall > 0.0 ? sqrt(fmax(fabs(eye_y), 1.0) / p->fall) : LONGEST_M;
}

static uint32_t at_most(double count, uint32_t most)
{
    return count < (double)most ? (uint32_t)count : most;
}

gl_sea_fan gl_sea_fan_of(const sea_picture *p, const camera_rays *camera, uint32_t most_nodes)
{
    const facet_render_desc *r = &p->desc->render;
    const waves *w = &p->sea->waves;
    gl_sea_fan fan = {.ratio = 1.1f, .farthest_m = waves_bounds(w, 0.0f).farthest};
    find_azimuths(camera, r->width, r->height, &fan);
    double pixel = (double)camera->pixel_size, eye_y = (double)camera->origin[1];
    float moved[2] = {0.0f, 0.0f};
    float water = waves_height_near(w, (double)camera->origin[0], (double)camera->origin[2], 0.0f, moved);
    fan.shift[0] = -moved[0];
    fan.shift[1] = -moved[1];
    double clear = fabs(eye_y - (double)water);
    fan.first_m = (float)fmax(0.5 * clear, 0.05);
    fan.near_m = (float)fmax(0.1 * clear, 0.01);
    double last = last_waves(p, pixel, 4.0 * (double)fan.first_m);
    double first = (double)fan.first_m, angle = 2.0 * (double)fan.half_azimuth;
    double level = fmin(fmax(2.0 * (double)p->deviation_m / (CELL_PIXELS * pixel), 4.0 * first), last);
    double standing = asinh(level / first), lying = 1.0 - level / last; /* rows of a step of 1 */
    double step = fmin(CELL_PIXELS * pixel, 0.05);
    double nodes = (standing + lying) / step * angle / step;
    step *= nodes > MOST_NODES ? sqrt(nodes / MOST_NODES) : 1.0;
    fan.columns = at_most(angle / step + 3.0, most_nodes);
    fan.level_row = at_most(standing / step + 1.0, most_nodes / 2);
    fan.step = (float)(standing / fan.level_row);
    fan.level_m = (float)level;
    fan.wave_rows = fan.level_row + at_most(lying / (double)fan.step, most_nodes / 2 - 256) + 1;
    double beyond = 1.5 * horizon_m(p, eye_y) + 1000.0;
    fan.rows = fan.wave_rows + at_most(fmax(log(beyond / last), 0.0) / log((double)fan.ratio) + 2.0, 254);
    fan.width_rad = (float)(0.5 * step);
    return fan;
}
