/* gl_camera.c - see gl_camera.h. */
#include "gl/scene/gl_camera.h"

#include <math.h>

#include "draw/camera_rays.h"
#include "gl/core/gl_api.h"

static const double NEAREST = 1e-6;        /* near plane over the largest depth */
static const double NEAREST_COARSE = 1e-4; /* the same without reversed depth */

/* Range of depths of the scene along the camera's axis. */
static void depth_range(const camera_rays *c, const float bounds_min[3], const float bounds_max[3],
                        double *low, double *high)
{
    *low = (double)INFINITY;
    *high = -(double)INFINITY;
    for (int corner = 0; corner < 8; corner++) {
        double depth = 0.0;
        for (int i = 0; i < 3; i++) {
            float at = corner >> i & 1 ? bounds_max[i] : bounds_min[i];
            depth += ((double)at - (double)c->origin[i]) * (double)c->direction[i];
        }
        *low = fmin(*low, depth);
        *high = fmax(*high, depth);
    }
}

/* Clip-space z is a * depth + b, with w = depth (orthographic: 1). The far plane leaves room for the
 * ground, as far behind the scene as the scene is deep. */
static void depth_terms(const gl_context *context, const camera_rays *c, double low, double high, double *a,
                        double *b)
{
    bool is_reversed = context->has_clip_control;
    /* A flat scene seen from the front has no depth, but the depths of its points are rounded. */
    double size = fmax(high - low, fmax(1e-3 * fmax(fabs(low), fabs(high)), 1e-6));
    double far = fmin((double)c->far_m, fmax(high, 0.0) + size);
    double near = fmax((double)c->near_m, low - 0.01 * size);
    if (!c->is_orthographic) {
        near = is_reversed ? fmax((double)c->near_m, NEAREST * far) : fmax(near, NEAREST_COARSE * far);
        far = is_reversed ? (double)c->far_m : far;
    }
    far = far > near ? far : near + fmax(1.0, fabs(near));
    double depth = far - near;
    if (c->is_orthographic) {
        *a = is_reversed ? -1.0 / depth : 2.0 / depth;
        *b = is_reversed ? far / depth : -(far + near) / depth;
    } else if (isinf(far)) {
        *a = 0.0;
        *b = near;
    } else {
        *a = is_reversed ? -near / depth : (far + near) / depth;
        *b = is_reversed ? far * near / depth : -2.0 * far * near / depth;
    }
}

void gl_camera_set(const gl_context *context, const camera_rays *c, const float bounds_min[3],
                   const float bounds_max[3], uint32_t width, uint32_t height, const gl_view *view,
                   gl_frame_block *block)
{
    const float *dx = c->is_orthographic ? c->origin_dx : c->direction_dx;
    const float *dy = c->is_orthographic ? c->origin_dy : c->direction_dy;
    double scale = view->scale, low, high, a, b;
    double corner_x = (double)view->x + (double)view->jitter[0];
    double top = (double)view->y + (double)view->jitter[1];
    double corner_y = height * scale - top - view->height; /* from the bottom */
    bool is_top_down = gl_context_is_top_down(context);
    for (int i = 0; i < 3; i++) {
        block->right[i] = (float)((double)dx[i] / scale);
        block->up[i] = (is_top_down ? 1.0f : -1.0f) * (float)((double)dy[i] / scale);
        block->forward[i] = c->direction[i];
        block->eye[i] = c->origin[i];
    }
    block->eye[3] = c->is_orthographic ? 1.0f : 0.0f;
    block->size[0] = (float)(width * scale);
    block->size[1] = (float)(height * scale);
    block->size[2] = (float)corner_x;
    block->size[3] = (float)(is_top_down ? top : corner_y);
    block->pixel_scale = (float)scale;
    block->far_depth = context->has_clip_control ? 0.0f : 1.0f;
    depth_range(c, bounds_min, bounds_max, &low, &high);
    depth_terms(context, c, low, high, &a, &b);
    /* A point is at the drawn pixel size / 2 + dot(point, d) / (pixel^2 w), where d is as long as a pixel. */
    double pixel2 = (double)c->pixel_size * (double)c->pixel_size / scale;
    double step_x = 2.0 / (double)view->width, step_y = 2.0 / (double)view->height;
    double middle_x = (0.5 * width * scale - corner_x) * step_x - 1.0;
    double middle_y = (0.5 * height * scale - corner_y) * step_y - 1.0;
    double along = c->is_orthographic ? 0.0 : 1.0;
    float *m = block->view_projection;
    for (int i = 0; i < 3; i++) {
        double forward = (double)c->direction[i];
        m[4 * i + 0] = (float)((double)dx[i] * step_x / pixel2 + along * middle_x * forward);
        m[4 * i + 1] = (float)((double)-dy[i] * step_y / pixel2 + along * middle_y * forward);
        m[4 * i + 2] = (float)(forward * a);
        m[4 * i + 3] = (float)(along * forward);
    }
    m[12] = (float)((1.0 - along) * middle_x);
    m[13] = (float)((1.0 - along) * middle_y);
    m[14] = (float)b;
    m[15] = (float)(1.0 - along);
}

void gl_camera_begin_depth(const gl_context *context)
{
    if (context->has_clip_control)
        gl_api_clip_control(gl_context_is_top_down(context) ? GL_UPPER_LEFT : GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    gl_api_clear_depth(context->is_es, context->has_clip_control ? 0.0 : 1.0);
    glDepthFunc(context->has_clip_control ? GL_GEQUAL : GL_LEQUAL);
}

void gl_camera_end_depth(const gl_context *context)
{
    if (context->has_clip_control)
        gl_api_clip_control(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    gl_api_clear_depth(context->is_es, 1.0);
    glDepthFunc(GL_LESS);
}

/* ---- samples ---- */

enum { MAX_SAMPLES = 8 }; /* per drawn pixel; more cost memory, and passes give the same result */

gl_sampling gl_sampling_plan(uint32_t samples, facet_quality quality, uint32_t max_samples)
{
    gl_sampling plan = {.scale = quality == FACET_QUALITY_FINAL && samples >= 4 ? 2 : 1};
    uint32_t quarter = plan.scale * plan.scale;
    uint32_t wanted = (samples + quarter - 1) / quarter;
    uint32_t most = max_samples < MAX_SAMPLES ? max_samples : MAX_SAMPLES;
    plan.samples = 1;
    while (2 * plan.samples <= most && 2 * plan.samples <= wanted)
        plan.samples *= 2;
    plan.passes = (wanted + plan.samples - 1) / plan.samples;
    return plan;
}

/* The samples of a pass are about 1 / sqrt(samples) apart; the passes are spread over that distance. */
void gl_sampling_jitter(const gl_sampling *sampling, float *jitter)
{
    float gap = 1.0f / sqrtf((float)sampling->samples);
    sample_pattern(sampling->passes, jitter);
    for (uint32_t i = 0; i < 2 * sampling->passes; i++)
        jitter[i] = gap * (jitter[i] - 0.5f);
}
