/* light_environment.c - see light_environment.h. Making the densities: light_environment_build.c. */
#include <math.h>
#include <string.h>

#include "base/simd.h"
#include "path/light_choice.h"
#include "path/light_counts.h"

#include "path/light_environment_grid.h"

/* What a cell that reaches above the horizon counts at least, as a cosine. Of a sun in the map just below the horizon much
 * more would be too much (deviation of the estimated irradiance of 96 x 48 texels with one of 1e5, worst of 24 normals: .03:
 * 3.8; .01: 2.3; .003: 1.4), and much less too little for what else its cell holds. */
static const float DEFENSIVE_SHARE = 0.003f;

/* The last division whose begin, as above, is not behind index. */
static uint32_t division_of(uint32_t index, uint32_t size, uint32_t divisions)
{
    return (uint32_t)((((uint64_t)index + 1) * divisions - 1) / size);
}

/* ---- patches ---- */

/* Radiance at the corners of a patch. */
typedef struct patch {
    float upper_left, upper_right, lower_left, lower_right;
} patch;

static patch patch_at(const light_environment *e, uint32_t x, uint32_t y)
{
    uint32_t right = x + 1 < e->width ? x + 1 : 0;
    uint32_t upper = y > 0 ? y - 1 : 0;
    uint32_t lower = y + 1 < e->height ? y : y - 1;
    return (patch){radiance_at(e, x, upper), radiance_at(e, right, upper), radiance_at(e, x, lower),
                   radiance_at(e, right, lower)};
}

/* Density of the point (s, t) of a patch, relative to a uniform one. */
static float patch_density(const patch *p, float s, float t)
{
    float upper = mix(p->upper_left, p->upper_right, s);
    float lower = mix(p->lower_left, p->lower_right, s);
    return 4.0f * mix(upper, lower, t) / (p->upper_left + p->upper_right + p->lower_left + p->lower_right);
}

/* A number in [0, 1) with the density 2 mix(a, b, x) / (a + b). */
static float sample_linear(float u, float a, float b)
{
    float most = max(a, b); /* keeps the squares finite and above 0 */
    a /= most;
    b /= most;
    float x = u * (a + b) / (a + sqrt(mix(a * a, b * b, u)));
    return min(x, 0x1.fffffep-1f);
}

/* ---- directions ---- */

/* World to environment and back: draw/light_setup.c. */
static vec3 to_picture(const light_environment *e, vec3 d)
{
    return vec3(d[0] * e->rotation_cos - d[2] * e->rotation_sin, d[1],
                d[0] * e->rotation_sin + d[2] * e->rotation_cos);
}

static vec3 from_picture(const light_environment *e, vec3 d)
{
    return vec3(d[0] * e->rotation_cos + d[2] * e->rotation_sin, d[1],
                d[2] * e->rotation_cos - d[0] * e->rotation_sin);
}

/* Rows are mirrored into the upper half: the angle from the nearer pole comes from its half, of which cos would leave
 * nothing. */
static bool is_lower(const light_environment *e, uint32_t y)
{
    return 2 * y > e->height - 1;
}

/* The direction at (s, t) of patch (x, y): uniform numbers give uniform directions in it. */
static vec3 direction_in_patch(const light_environment *e, uint32_t x, uint32_t y, float s, float t)
{
    bool mirrored = is_lower(e, y);
    uint32_t row = mirrored ? e->height - 1 - y : y;
    float s2 = mix(e->half_sine2[row], e->half_sine2[row + 1], mirrored ? 1.0f - t : t);
    float sin_theta = 2.0f * sqrt(s2 * (1.0f - s2));
    float cos_theta = 1.0f - 2.0f * s2;
    float phi = 2.0f * PI * (((float)x + 0.5f + s) / (float)e->width - 0.5f);
    return vec3(sin_theta * cos(phi), mirrored ? -cos_theta : cos_theta, sin_theta * sin(phi));
}

typedef struct patch_point {
    uint32_t x, y;
    float s, t;
} patch_point;

/* Where the unit direction d of the picture is. */
static patch_point locate(const light_environment *e, vec3 d)
{
    equirect_point p = equirect_locate((float[3]){d[0], d[1], d[2]});
    float across = p.turns * (float)e->width + (0.5f * (float)e->width - 0.5f);
    across = across < 0.0f ? across + (float)e->width : across;
    float down = p.half_turns * (float)(e->height - 1) + 0.5f;
    patch_point point = {.x = (uint32_t)across, .y = (uint32_t)down};
    point.x = point.x < e->width ? point.x : e->width - 1; /* rounded up */
    point.y = point.y < e->height ? point.y : e->height - 1;
    point.s = clamp(across - (float)point.x, 0.0f, 1.0f);
    bool mirrored = is_lower(e, point.y);
    uint32_t row = mirrored ? e->height - 1 - point.y : point.y;
    float s2 = 0.5f * (d[0] * d[0] + d[2] * d[2]) / (1.0f + (mirrored ? -d[1] : d[1]));
    float t = (s2 - e->half_sine2[row]) / (e->half_sine2[row + 1] - e->half_sine2[row]);
    point.t = clamp(mirrored ? 1.0f - t : t, 0.0f, 1.0f);
    return point;
}

vec3 light_environment_radiance(const light_environment *e, vec3 d)
{
    vec3 turned = to_picture(e, d);
    rgbx c = equirect_fetch(e->picture, equirect_locate((float[3]){turned[0], turned[1], turned[2]}));
    return vec3(c[0], c[1], c[2]) * e->scale;
}

/* ---- sampling ---- */

/* Clamped cosine of a cell whose mean direction is at x and that spreads to both sides of it: the line from 0 at -spread to
 * the cosine itself, and not less than the defensive share wherever the cell reaches above the horizon. */
DISPATCH_AVX2 static void weigh_cells(const light_environment *restrict e, const float *restrict N,
                                      float *restrict cells)
{
    const float nx = N[0];
    const float ny = N[1];
    const float nz = N[2];
    for (int i = 0; i < CELLS; i++) {
        float x = nx * e->mean_x[i] + ny * e->mean_y[i] + nz * e->mean_z[i];
        float near = 0.5f * (x + e->spread[i]);
        float cosine = x > near ? x : near;
        float clamped = cosine > 0.0f ? cosine : 0.0f;
        float least = x + e->reach[i] > 0.0f ? DEFENSIVE_SHARE : 0.0f;
        cells[i] = e->power[i] * (clamped + least);
    }
}

void light_environment_see(const light_environment *e, vec3 N, light_environment_view *view)
{
    vec3 turned = to_picture(e, N);
    if (dot(N, N) > 0.0f)
        weigh_cells(e, (float[3]){turned[0], turned[1], turned[2]}, view->cells);
    else
        memcpy(view->cells, e->power, sizeof view->cells);
    for (int i = 0; i < BANDS; i++)
        view->bands[i] = 0.0f;
    for (int k = 0; k < BLOCKS; k++)
        for (int i = 0; i < BANDS; i++)
            view->bands[i] += view->cells[k * BANDS + i];
    view->irradiance = 0.0f;
    for (int i = 0; i < BANDS; i++)
        view->irradiance += view->bands[i];
}

float light_environment_sample(const light_environment *e, const light_environment_view *view,
                               const double u[2], vec3 *d)
{
    double across = u[0];
    double down = u[1];
    uint32_t band = (uint32_t)light_choose(view->bands, BANDS, &down);
    float blocks[BLOCKS];
    for (uint32_t k = 0; k < BLOCKS; k++)
        blocks[k] = view->cells[k * BANDS + band];
    uint32_t block = (uint32_t)light_choose(blocks, BLOCKS, &across);

    double row_probability;
    double column_probability;
    uint32_t top = band_begin(e, band);
    uint32_t left = block_begin(e, block);
    uint32_t y =
        top + (uint32_t)light_counts_find(e->rows + (size_t)block * e->height + top,
                                          band_begin(e, band + 1) - top, down, &row_probability, &down);
    uint32_t x = left + (uint32_t)light_counts_find(e->columns + (size_t)y * e->width + left,
                                                    block_begin(e, block + 1) - left, across,
                                                    &column_probability, &across);
    patch p = patch_at(e, x, y);
    float t = sample_linear((float)down, p.upper_left + p.upper_right, p.lower_left + p.lower_right);
    float s = sample_linear((float)across, mix(p.upper_left, p.lower_left, t),
                            mix(p.upper_right, p.lower_right, t));
    *d = from_picture(e, direction_in_patch(e, x, y, s, t));
    float cell_probability = view->cells[block * BANDS + band] / view->irradiance;
    return cell_probability * (float)row_probability * (float)column_probability * e->per_sr[y] *
           patch_density(&p, s, t);
}

float light_environment_pdf(const light_environment *e, const light_environment_view *view, vec3 d)
{
    patch_point at = locate(e, to_picture(e, d));
    uint32_t band = division_of(at.y, e->height, BANDS);
    uint32_t block = division_of(at.x, e->width, BLOCKS);
    float cell = view->cells[block * BANDS + band];
    if (!(cell > 0.0f))
        return 0.0f;
    uint32_t top = band_begin(e, band);
    uint32_t left = block_begin(e, block);
    double row = light_counts_probability(e->rows + (size_t)block * e->height + top, at.y - top);
    double column = light_counts_probability(e->columns + (size_t)at.y * e->width + left, at.x - left);
    if (!(row > 0.0 && column > 0.0))
        return 0.0f;
    patch p = patch_at(e, at.x, at.y);
    return cell / view->irradiance * (float)row * (float)column * e->per_sr[at.y] *
           patch_density(&p, at.s, at.t);
}
