/* camera_rays.h - from a camera to the rays through an image, and where in a pixel they are sampled. */
#ifndef DRAW_CAMERA_RAYS_H
#define DRAW_CAMERA_RAYS_H

#include "facet/facet.h"

/* The ray through image position (x, y) (pixels; (0, 0) is the top left corner, the middle of a pixel is at
 * 0.5) is
 *     origin + X origin_dx + Y origin_dy + t (direction + X direction_dx + Y direction_dy)
 * with X = x - middle[0], Y = y - middle[1]. Directions are not of unit length: t is the depth along the
 * camera's axis in m. A perspective camera has origin_d* = 0, an orthographic one direction_d* = 0. */
typedef struct camera_rays {
    float origin[3], origin_dx[3], origin_dy[3];
    float direction[3], direction_dx[3], direction_dy[3];
    float middle[2];
    float near_m, far_m; /* far_m: infinity where there is no limit */
    float pixel_size;    /* height of a pixel in m, for a perspective camera at depth 1 m */
    bool is_orthographic;
} camera_rays;

/* For the whole image of width x height pixels. A camera made for another aspect ratio shows its whole
 * view, and more on two sides. Fails with FACET_ERROR_ARGUMENT for a camera without a view direction. */
facet_result camera_rays_create(const facet_camera *camera, uint32_t width, uint32_t height,
                                camera_rays *rays, facet_error *error);

/* One ray. */
static inline void camera_rays_at(const camera_rays *rays, float x, float y, float origin[3],
                                  float direction[3])
{
    float X = x - rays->middle[0];
    float Y = y - rays->middle[1];
    for (int i = 0; i < 3; i++) {
        origin[i] = rays->origin[i] + X * rays->origin_dx[i] + Y * rays->origin_dy[i];
        direction[i] = rays->direction[i] + X * rays->direction_dx[i] + Y * rays->direction_dy[i];
    }
}

/* Image position, pixels, and depth along the axis of a point, m from camera->origin; false: not in front of the
 * camera. */
static inline bool camera_rays_project(const camera_rays *rays, const float point[3], float at[2],
                                       float *depth_m)
{
    const float *dx = rays->is_orthographic ? rays->origin_dx : rays->direction_dx;
    const float *dy = rays->is_orthographic ? rays->origin_dy : rays->direction_dy;
    float x = 0.0f, y = 0.0f, depth = 0.0f;
    for (int i = 0; i < 3; i++) {
        x += point[i] * dx[i];
        y += point[i] * dy[i];
        depth += point[i] * rays->direction[i];
    }
    float pixel2 = rays->pixel_size * rays->pixel_size;
    float divisor = rays->is_orthographic ? pixel2 : pixel2 * depth;
    if (!(divisor > 0.0f))
        return false;
    at[0] = x / divisor + rays->middle[0];
    at[1] = y / divisor + rays->middle[1];
    *depth_m = depth;
    return true;
}

/* Height of a pixel in m at that depth; negative depths count as 0. */
static inline float camera_rays_pixel_size(const camera_rays *rays, float depth_m)
{
    return rays->is_orthographic ? rays->pixel_size : rays->pixel_size * (depth_m > 0.0f ? depth_m : 0.0f);
}

/* Writes count points in (0, 1)^2, x and y interleaved; the same in every pixel. Each of count columns and
 * each of count rows holds one point, so that edges near the axes show count + 1 shades; 1: the middle. */
void sample_pattern(uint32_t count, float *points);

#endif
