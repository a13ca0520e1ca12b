/* gl_sea_mesh.c - see gl_sea_mesh.h. */
#include "gl/sea/gl_sea_mesh.h"

#include <math.h>

#include "base/memory.h"
#include "base/result.h"
#include "gl/core/gl_api.h"

static const double CELL_PIXELS = 4.0, MAX_NODES = 6e5, MAX_DISTANCE_M = 1e5;
static const double PI_D = 3.14159265358979323846;
static const double MIN_LEVEL = 0.2; /* horizontal part of rays below which the whole circle is needed */
enum { PROBES = 33 };

static double turned(double azimuth, double from)
{
    double a = azimuth - from;
    return a - 2.0 * PI_D * floor(a / (2.0 * PI_D) + 0.5);
}

/* Azimuths in view; a whole circle where the eye looks up or down. */
static void find_azimuths(const camera_rays *rays, uint32_t width, uint32_t height, gl_sea_fan *fan)
{
    double middle = atan2((double)rays->direction[2], (double)rays->direction[0]), half = 0.0;
    for (int i = 0; i < PROBES * PROBES; i++) {
        float o[3], d[3];
        camera_rays_at(rays, (float)width * (float)(i % PROBES) / (PROBES - 1),
                       (float)height * (float)(i / PROBES) / (PROBES - 1), o, d);
        double level = hypot((double)d[0], (double)d[2]);
        bool is_steep = level < MIN_LEVEL * hypot(level, (double)d[1]);
        half = fmax(half, is_steep ? PI_D : fabs(turned(atan2((double)d[2], (double)d[0]), middle)));
    }
    fan->azimuth = (float)middle;
    fan->half_azimuth = (float)fmin(half * 1.05 + 0.02, PI_D);
}

/* Distance at which all waves together are a tenth of a pixel high. */
static double last_waves(const water_frame *p, double pixel_rad, double from)
{
    double r = from;
    for (; r < MAX_DISTANCE_M; r *= 1.3) {
        wave_bounds there = waves_bounds(&p->sea->waves, (float)(pixel_rad * r));
        if ((double)(there.highest - there.lowest) < 0.1 * pixel_rad * r)
            break;
    }
    return r;
}

static double horizon_m(const water_frame *p, double eye_y)
{
    return p->fall > 0.0 ? sqrt(fmax(fabs(eye_y), 1.0) / p->fall) : MAX_DISTANCE_M;
}

static uint32_t at_most(double count, uint32_t most)
{
    return count < (double)most ? (uint32_t)count : most;
}

gl_sea_fan gl_sea_fan_of(const water_frame *p, const camera_rays *camera, uint32_t max_nodes)
{
    const facet_render_desc *r = p->desc;
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
    double standing = asinh(level / first), lying = 1.0 - level / last; /* rows per step of 1 */
    double step = fmin(CELL_PIXELS * pixel, 0.05);
    double nodes = (standing + lying) / step * angle / step;
    step *= nodes > MAX_NODES ? sqrt(nodes / MAX_NODES) : 1.0;
    fan.columns = at_most(angle / step + 3.0, max_nodes);
    fan.level_row = at_most(standing / step + 1.0, max_nodes / 2);
    fan.step = (float)(standing / fan.level_row);
    fan.level_m = (float)level;
    fan.wave_rows = fan.level_row + at_most(lying / (double)fan.step, max_nodes / 2 - 256) + 1;
    double beyond = 1.5 * horizon_m(p, eye_y) + 1000.0;
    fan.rows = fan.wave_rows + at_most(fmax(log(beyond / last), 0.0) / log((double)fan.ratio) + 2.0, 254);
    fan.width_rad = (float)(0.5 * step);
    return fan;
}

/* ---- indices ---- */

/* Columns of a band of the mesh. Software rasterizers cache 256 vertices, which holds two rows of a band. */
enum { BAND_COLUMNS = 64 };

static size_t index_count(const gl_sea_fan *fan)
{
    size_t bands = (fan->columns - 1 + BAND_COLUMNS - 1) / BAND_COLUMNS;
    return (size_t)(fan->rows - 1) * (2 * ((size_t)fan->columns - 1 + bands) + 2 * bands);
}

static void fill_indices(const gl_sea_fan *fan, uint32_t *indices)
{
    size_t at = 0;
    for (uint32_t begin = 0; begin + 1 < fan->columns; begin += BAND_COLUMNS) {
        uint32_t left = fan->columns - 1 - begin, last = left < BAND_COLUMNS ? left : BAND_COLUMNS;
        for (uint32_t row = 0; row + 1 < fan->rows; row++) {
            uint32_t first = row * fan->columns + begin;
            indices[at++] = first;
            for (uint32_t column = 0; column <= last; column++) {
                indices[at++] = first + column;
                indices[at++] = first + fan->columns + column;
            }
            indices[at] = indices[at - 1];
            at++;
        }
    }
}

facet_result gl_sea_mesh_update(gl_sea_mesh *m, gl_context *context, const gl_sea_fan *fan,
                                const facet_allocator *allocator, facet_error *error)
{
    if (m->columns == fan->columns && m->rows == fan->rows)
        return FACET_OK;
    size_t count = index_count(fan);
    uint32_t *indices = mem_alloc(allocator, count, sizeof *indices);
    if (!indices)
        return fail_memory(error, "a sea's mesh", count * sizeof *indices);
    fill_indices(fan, indices);
    gl_sea_mesh_destroy(m);
    glGenVertexArrays(1, &m->array);
    glGenBuffers(1, &m->indices);
    glBindVertexArray(m->array);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, m->indices);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(count * sizeof *indices), indices, GL_STATIC_DRAW);
    glBindVertexArray(0);
    mem_free(indices);
    m->columns = fan->columns;
    m->rows = fan->rows;
    m->index_count = (uint32_t)count;
    return gl_context_check(context, "a sea's mesh", error);
}

void gl_sea_mesh_draw(const gl_sea_mesh *m)
{
    glBindVertexArray(m->array);
    glDrawElements(GL_TRIANGLE_STRIP, (GLsizei)m->index_count, GL_UNSIGNED_INT, NULL);
}

void gl_sea_mesh_destroy(gl_sea_mesh *m)
{
    glDeleteVertexArrays(1, &m->array);
    glDeleteBuffers(1, &m->indices);
    *m = (gl_sea_mesh){.array = 0};
}
