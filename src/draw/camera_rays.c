/* camera_rays.c - see camera_rays.h. The basis is computed in double: that costs nothing, and keeps the
 * rays of a telephoto camera far from the origin exact to the last bits. */
#include "draw/camera_rays.h"

#include <math.h>

#include "base/result.h"

typedef struct basis {
    double right[3], up[3], forward[3];
} basis;

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross3(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static bool normalize3(double a[3])
{
    double length = sqrt(dot3(a, a));
    if (!(length > 0.0) || !isfinite(length))
        return false;
    for (int i = 0; i < 3; i++)
        a[i] /= length;
    return true;
}

/* Right, up and forward of the camera; false: its view direction is undefined. */
static bool camera_basis(const facet_camera *camera, basis *b)
{
    for (int i = 0; i < 3; i++) {
        b->forward[i] = (double)camera->target[i] - (double)camera->eye[i];
        b->up[i] = (double)camera->up[i];
    }
    if (!normalize3(b->forward))
        return false;
    if (!normalize3(b->up)) {
        bool looks_along_y = fabs(b->forward[1]) > 0.999999;
        b->up[0] = 0.0;
        b->up[1] = looks_along_y ? 0.0 : 1.0;
        b->up[2] = looks_along_y ? -1.0 : 0.0;
    }
    cross3(b->forward, b->up, b->right);
    if (dot3(b->right, b->right) < 1e-16 || !normalize3(b->right))
        return false;
    cross3(b->right, b->forward, b->up);
    return true;
}

/* Whether vectors that vary over the image as middle + x dx + y dy stay within Embree's limit: it aborts the
 * process beyond 1.8e18. */
static bool is_within_reach(const float middle[3], const float dx[3], const float dy[3], uint32_t width,
                            uint32_t height)
{
    for (int i = 0; i < 3; i++) {
        double most = fabs((double)middle[i]) + fabs((double)dx[i]) * width + fabs((double)dy[i]) * height;
        if (!(most <= 1e18))
            return false;
    }
    return true;
}

facet_result camera_rays_create(const facet_camera *camera, uint32_t width, uint32_t height,
                                camera_rays *rays, facet_error *error)
{
    basis b;
    if (!camera_basis(camera, &b))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "camera: eye and target must be two points, and up not along the line between them");
    double aspect = (double)width / (double)height;
    /* An image narrower than the camera was made for: keep the width, show more above and below. */
    double fit =
        camera->aspect > 0.0f && aspect < (double)camera->aspect ? (double)camera->aspect / aspect : 1.0;
    bool is_orthographic = !(camera->fov_y_rad > 0.0f);
    double extent =
        is_orthographic ? (double)camera->ortho_height : 2.0 * tan(0.5 * (double)camera->fov_y_rad);
    double pixel = extent * fit / (double)height;
    if (!(pixel > 0.0) || !isfinite(pixel) || camera->fov_y_rad >= 3.14159f)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "camera: the field of view must be between 0 and 180 degrees, or the height above 0");

    *rays = (camera_rays){.middle = {0.5f * (float)width, 0.5f * (float)height},
                          .near_m = camera->near_m > 0.0f ? camera->near_m : 0.0f,
                          .far_m = camera->far_m > 0.0f ? camera->far_m : INFINITY,
                          .pixel_size = (float)pixel,
                          .is_orthographic = is_orthographic};
    float *dx = is_orthographic ? rays->origin_dx : rays->direction_dx;
    float *dy = is_orthographic ? rays->origin_dy : rays->direction_dy;
    for (int i = 0; i < 3; i++) {
        rays->origin[i] = camera->eye[i];
        rays->direction[i] = (float)b.forward[i];
        dx[i] = (float)(b.right[i] * pixel);
        dy[i] = (float)(-b.up[i] * pixel);
    }
    if (!is_within_reach(rays->origin, rays->origin_dx, rays->origin_dy, width, height) ||
        !is_within_reach(rays->direction, rays->direction_dx, rays->direction_dy, width, height))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "camera: the view is too wide or too far away; its corners must be within 1e18 m");
    return FACET_OK;
}

/* ---- samples in a pixel ---- */

/* Rank-1 lattices (Korobov 1959) with the generator that keeps the points farthest apart on a torus; for 4
 * points the rotated grid, which is not such a lattice. */

/* Smallest squared distance of point i to point 0, in units of (1 / count)^2. */
static uint64_t lattice_distance2(uint32_t count, uint32_t generator)
{
    uint64_t nearest = UINT64_MAX;
    for (uint32_t i = 1; i <= count / 2; i++) {
        uint64_t x = i;
        uint64_t y = (uint64_t)i * generator % count;
        if (y > count - y)
            y = count - y;
        uint64_t distance2 = x * x + y * y;
        nearest = distance2 < nearest ? distance2 : nearest;
        if (x * x >= nearest)
            break;
    }
    return nearest;
}

static uint32_t greatest_common_divisor(uint32_t a, uint32_t b)
{
    while (b) {
        uint32_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

static uint32_t best_generator(uint32_t count)
{
    uint32_t best = 1;
    uint64_t best_distance2 = 0;
    for (uint32_t generator = 1; generator < count; generator++) {
        if (greatest_common_divisor(generator, count) != 1)
            continue;
        uint64_t distance2 = lattice_distance2(count, generator);
        if (distance2 > best_distance2) {
            best = generator;
            best_distance2 = distance2;
        }
    }
    return best;
}

void sample_pattern(uint32_t count, float *points)
{
    static const uint8_t rotated_grid[4] = {2, 0, 3, 1};
    uint32_t generator = best_generator(count);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t row = count == 4 ? rotated_grid[i] : (uint32_t)((uint64_t)i * generator % count);
        points[2 * i] = ((float)i + 0.5f) / (float)count;
        points[2 * i + 1] = ((float)row + 0.5f) / (float)count;
    }
}
