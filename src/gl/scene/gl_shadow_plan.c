/* gl_shadow_plan.c - see gl_shadow_plan.h. */
#include "gl/scene/gl_shadow_plan.h"

#include <math.h>

#include "ibl/cube.h"

#include "shade/shade.h"

/* Wider spots (half angle) use six faces, because a plane would need endless texels: cos(55 degrees). */
static const float WIDE_COS = 0.5736f;

/* Casters closer to a light than a 2000th of the farthest distance are ignored: 24 bits of a + b / depth then
 * resolve depths to 1e-4, a tenth of a texel. */
static const double NEAREST = 1.0 / 2000.0;

static vec3 middle_of(const shadow_bounds *b)
{
    return vec3(0.5f * (b->min[0] + b->max[0]), 0.5f * (b->min[1] + b->max[1]),
                0.5f * (b->min[2] + b->max[2]));
}

static vec3 corner_of(const shadow_bounds *b, int i)
{
    return vec3(i & 1 ? b->max[0] : b->min[0], i & 2 ? b->max[1] : b->min[1], i & 4 ? b->max[2] : b->min[2]);
}

/* Distances from a point to the nearest and farthest point of the box. */
static void distances(const shadow_bounds *b, vec3 P, float *nearest, float *farthest)
{
    vec3 low = vec3(0.0f), high = vec3(0.0f);
    for (int i = 0; i < 3; i++) {
        low[i] = max(max(b->min[i] - P[i], P[i] - b->max[i]), 0.0f);
        high[i] = max(fabsf(b->min[i] - P[i]), fabsf(b->max[i] - P[i]));
    }
    *nearest = length(low);
    *farthest = length(high);
}

static bool is_spot(const Light *light)
{
    return !light->directional && light->spot_scale > 0.0f;
}

/* Cosine of the outer cone. */
static float spot_cosine(const Light *light)
{
    return -light->spot_offset / light->spot_scale;
}

static bool is_cube(const Light *light)
{
    return !light->directional && !(is_spot(light) && spot_cosine(light) > WIDE_COS);
}

float shadow_brightness(const Light *light, const shadow_bounds *bounds)
{
    float nearest = 1.0f, farthest = 1.0f,
          radius = 0.5f * length(corner_of(bounds, 7) - corner_of(bounds, 0));
    float lux = luminance(light->intensity);
    if (light->directional)
        return lux;
    distances(bounds, light->position, &nearest, &farthest);
    return lux * attenuation_range(max(nearest, 0.1f * radius), light->range);
}

uint32_t shadow_tile_count(const Light *light, const shadow_bounds *bounds)
{
    if (!(shadow_brightness(light, bounds) > 0.0f))
        return 0;
    return is_cube(light) ? 6 : 1;
}

/* ---- frusta ---- */

static void set3(float out[3], vec3 v)
{
    for (int i = 0; i < 3; i++)
        out[i] = v[i];
}

/* Share of a tile's texels that is not guard. */
static float open_share(uint32_t tile)
{
    return (float)(tile - 2 * GL_SHADOW_GUARD) / (float)tile;
}

/* Fitted around the bounds as seen along the light. */
static void set_parallel(gl_shadow_record *r, const Light *light, const shadow_bounds *bounds, uint32_t tile)
{
    vec3 forward = light->spot_direction;
    mat3 basis = basis_from_normal(forward);
    vec3 low = vec3(INFINITY), high = vec3(-INFINITY), middle = middle_of(bounds);
    for (int i = 0; i < 8; i++) {
        vec3 d = corner_of(bounds, i) - middle;
        vec3 at = vec3(dot(d, COL(basis, 0)), dot(d, COL(basis, 1)), dot(d, forward));
        low = min(low, at);
        high = max(high, at);
    }
    /* A flat scene gets some thickness, so that it lies within. */
    float size = max(max3(high - low), 1e-6f);
    float half_edge = 0.5f * max(high[0] - low[0], high[1] - low[1]) + 1e-3f * size;
    float depth = high[2] - low[2] + 0.02f * size;
    set3(r->origin, middle + forward * (low[2] - 0.01f * size));
    set3(r->right, COL(basis, 0) * (open_share(tile) / half_edge));
    set3(r->up, COL(basis, 1) * (open_share(tile) / half_edge));
    set3(r->forward, forward * (1.0f / depth));
    r->texel = 2.0f * half_edge / (open_share(tile) * (float)tile);
}

/* Range of depths from a light at a point, limited by NEAREST. */
static void set_depths(gl_shadow_record *r, const Light *light, const shadow_bounds *bounds)
{
    float nearest, farthest;
    distances(bounds, light->position, &nearest, &farthest);
    double far = 1.01 * fmax((double)farthest, 1e-6);
    if (light->range > 0.0f)
        far = fmin(far, 1.01 * (double)light->range);
    /* Depth along the axis is shorter than the distance, in a corner of a cube face by 1.74. */
    double near = fmax(0.55 * (double)nearest, NEAREST * far);
    near = fmin(near, 0.5 * far);
    r->depth_a = (float)(far / (far - near));
    r->depth_b = (float)(-far * near / (far - near));
}

static void set_spot(gl_shadow_record *r, const Light *light, uint32_t tile)
{
    mat3 basis = basis_from_normal(light->spot_direction);
    float cosine = spot_cosine(light);
    float tangent = max(sqrt(max(1.0f - cosine * cosine, 0.0f)) / cosine, 1e-3f);
    set3(r->right, COL(basis, 0) * (open_share(tile) / tangent));
    set3(r->up, COL(basis, 1) * (open_share(tile) / tangent));
    set3(r->forward, light->spot_direction);
    r->texel = 2.0f * tangent / (open_share(tile) * (float)tile);
}

gl_shadow_record shadow_record_make(const Light *light, const shadow_bounds *bounds, uint32_t first_tile,
                                    uint32_t tile)
{
    gl_shadow_record r = {.tile = (float)first_tile, .scale = 1.0f};
    if (light->directional) {
        r.kind = GL_SHADOW_PARALLEL;
        set_parallel(&r, light, bounds, tile);
        return r;
    }
    set3(r.origin, light->position);
    set_depths(&r, light, bounds);
    r.kind = GL_SHADOW_SPOT;
    if (!is_cube(light)) {
        set_spot(&r, light, tile);
        return r;
    }
    r.kind = GL_SHADOW_CUBE;
    r.scale = open_share(tile);
    r.texel = 2.0f / (open_share(tile) * (float)tile);
    return r;
}

/* ---- matrices ---- */

/* Axes of a tile: clip-space x and y are dot(d, .) (for cubes s and t); and forward. */
static void axes_of(const gl_shadow_record *r, uint32_t face, double x[3], double y[3], double forward[3])
{
    if ((int)r->kind == GL_SHADOW_CUBE) {
        cube_direction(face, 0.0, 0.0, forward);
        cube_direction(face, 1.0, 0.0, x);
        cube_direction(face, 0.0, 1.0, y);
    }
    for (int i = 0; i < 3; i++) {
        if ((int)r->kind == GL_SHADOW_CUBE) {
            x[i] = (x[i] - forward[i]) * (double)r->scale;
            y[i] = (y[i] - forward[i]) * (double)r->scale;
        } else {
            x[i] = (double)r->right[i];
            y[i] = (double)r->up[i];
            forward[i] = (double)r->forward[i];
        }
    }
}

void shadow_matrix(const gl_shadow_record *r, uint32_t face, const float eye[3], float out[16])
{
    bool is_parallel = (int)r->kind == GL_SHADOW_PARALLEL;
    double axes[3][3], rows[4][4];
    axes_of(r, face, axes[0], axes[1], axes[2]);
    /* Depth z in [0, 1] is dot(d, forward), or a + b / w; clip space has (2 z - 1) w. */
    double slope = is_parallel ? 2.0 : 2.0 * (double)r->depth_a - 1.0;
    double offset = is_parallel ? -1.0 : 2.0 * (double)r->depth_b;
    for (int i = 0; i < 3; i++) {
        rows[0][i] = axes[0][i];
        rows[1][i] = axes[1][i];
        rows[2][i] = axes[2][i] * slope;
        rows[3][i] = is_parallel ? 0.0 : axes[2][i];
    }
    rows[0][3] = rows[1][3] = 0.0;
    rows[2][3] = offset;
    rows[3][3] = is_parallel ? 1.0 : 0.0;
    for (int row = 0; row < 4; row++) {
        for (int i = 0; i < 3; i++) {
            rows[row][3] -= rows[row][i] * ((double)r->origin[i] - (double)eye[i]);
            out[4 * i + row] = (float)rows[row][i];
        }
        out[12 + row] = (float)rows[row][3];
    }
}
