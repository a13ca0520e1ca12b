/* draw.c - frames, images of any size, and what is at a pixel. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/result.h"
#include "draw/camera_rays.h"
#include "film/film_image.h"
#include "film/meter.h"
#include "gl/core/gl_api.h"
#include "render/renderer.h"
#include "viewer.h"

/* An orbit that was found for another shape of the image is found again, unless it was moved by hand. */
static void follow_shape(viewer *v, float aspect)
{
    if (v->framed_aspect != aspect)
        view_state_follow_motion(&v->state);
    v->framed_aspect = aspect;
}

static facet_result update_camera(viewer *v, uint32_t width, uint32_t height, facet_error *error)
{
    view_state *s = &v->state;
    TRY(web_camera_settle(v, error));
    if (s->camera == VIEW_NO_CAMERA)
        return view_state_frame(s, (float)width / (float)height, error);
    return facet_camera_from_scene(v->scene, &s->pose, (uint32_t)s->camera, &s->file_camera, error);
}

facet_result web_draw_desc(viewer *v, uint32_t width, uint32_t height, facet_camera *camera,
                           facet_render_desc *out, facet_error *error)
{
    if (!v->scene)
        return fail(error, FACET_ERROR_ARGUMENT, "there is no model to draw");
    if (!v->renderer)
        return fail(error, FACET_ERROR_SYSTEM, "the browser has taken WebGL away");
    if (!width || !height)
        return fail(error, FACET_ERROR_ARGUMENT, "an image of %u x %u pixels has no pixels", width, height);
    TRY(update_camera(v, width, height, error));
    facet_render_desc desc = view_state_desc(&v->state, width, height, camera);
    desc.environment = web_light_get(v->light);
    return render_desc_resolve(&desc, out, error);
}

/* ---- frames ---- */

static facet_result make_side(viewer *v, uint32_t width, uint32_t height, facet_error *error)
{
    if (v->side_framebuffer && v->side_width == width && v->side_height == height)
        return FACET_OK;
    glDeleteTextures(1, &v->side_texture);
    if (!v->side_framebuffer)
        glGenFramebuffers(1, &v->side_framebuffer);
    glGenTextures(1, &v->side_texture);
    glBindTexture(GL_TEXTURE_2D, v->side_texture);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, (GLsizei)width, (GLsizei)height);
    glBindFramebuffer(GL_FRAMEBUFFER, v->side_framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, v->side_texture, 0);
    v->side_width = width;
    v->side_height = height;
    return gl_context_check(v->context, "the second side", error);
}

/* Both sides of the divider: the right one goes through a texture. */
static facet_result draw_sides(viewer *v, const facet_render_desc *desc, facet_error *error)
{
    facet_render_desc sides[2];
    const char *labels[2];
    GLint width = (GLint)desc->width, height = (GLint)desc->height;
    GLint border = (GLint)(v->state.divider.position * desc->width + 0.5);
    view_divider_sides(&v->state.divider, desc, sides, labels);
    TRY(make_side(v, desc->width, desc->height, error));
    TRY(gl_renderer_present(v->renderer, &sides[1], v->side_framebuffer, 0, 0, &v->stats, error));
    TRY(gl_renderer_present(v->renderer, &sides[0], 0, 0, 0, &v->stats, error));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, v->side_framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBlitFramebuffer(border, 0, width, height, border, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0); /* of which the page may read */
    return gl_context_check(v->context, "the second side", error);
}

facet_result web_draw(viewer *v, uint32_t width, uint32_t height, bool is_draft, facet_error *error)
{
    facet_camera camera;
    facet_render_desc desc;
    v->state.width = width;
    v->state.height = height;
    follow_shape(v, (float)width / (float)(height ? height : 1));
    TRY(web_draw_desc(v, width, height, &camera, &desc, error));
    desc.quality = is_draft ? FACET_QUALITY_DRAFT : FACET_QUALITY_NORMAL;
    if (v->state.divider.comparison != VIEW_COMPARE_NOTHING)
        return draw_sides(v, &desc, error);
    return gl_renderer_present(v->renderer, &desc, 0, 0, 0, &v->stats, error);
}

/* ---- images ---- */

static facet_result render(viewer *v, const facet_render_desc *desc, film *out, facet_error *error)
{
    facet_render_stats stats;
    TRY(film_create(&desc->allocator, desc->crop[2], desc->crop[3], desc->aovs, out, error));
    facet_result result = gl_renderer_render(v->renderer, desc, out, &stats, error);
    if (result != FACET_OK)
        film_destroy(out);
    return result;
}

static facet_result to_rgba(const film *f, const facet_render_desc *desc, void **rgba, facet_error *error)
{
    image shown = {0}, straight = {0};
    facet_result result =
        film_to_display_image(f, IMAGE_U8, true, &desc->allocator, desc->thread_count, &shown, error);
    if (result == FACET_OK)
        result =
            image_convert(&shown, &desc->allocator, desc->thread_count, 4, IMAGE_U8, true, &straight, error);
    image_destroy(&shown);
    if (result != FACET_OK)
        return result;
    size_t size = image_row_size(&straight) * straight.height;
    *rgba = malloc(size);
    if (*rgba)
        memcpy(*rgba, straight.pixels, size);
    else
        result = fail_memory(error, "image", size);
    image_destroy(&straight);
    return result;
}

facet_result web_draw_read(viewer *v, uint32_t width, uint32_t height, void **rgba, facet_error *error)
{
    facet_camera camera;
    facet_render_desc desc;
    film drawn = {0};
    *rgba = NULL;
    TRY(web_draw_desc(v, width, height, &camera, &desc, error));
    TRY(render(v, &desc, &drawn, error));
    film_develop(&drawn, &desc);
    facet_result result = to_rgba(&drawn, &desc, rgba, error);
    film_destroy(&drawn);
    return result;
}

/* ---- pixels ---- */

/* The layers of one pixel of the last frame. */
static facet_result render_pixel(viewer *v, double x, double y, camera_rays *rays, film *out,
                                 facet_error *error)
{
    facet_camera camera;
    facet_render_desc desc;
    const view_state *s = &v->state;
    TRY(web_draw_desc(v, s->width, s->height, &camera, &desc, error));
    if (!(x >= 0.0 && y >= 0.0 && x < s->width && y < s->height))
        return fail(error, FACET_ERROR_ARGUMENT, "%g, %g is outside of the image of %u x %u pixels", x, y,
                    s->width, s->height);
    desc.crop[0] = (uint32_t)x;
    desc.crop[1] = (uint32_t)y;
    desc.crop[2] = desc.crop[3] = 1;
    desc.samples = 1;
    desc.quality = FACET_QUALITY_DRAFT;
    desc.gl.bloom = 0.0f;
    desc.ground = FACET_GROUND_NONE;
    desc.aovs = FACET_AOV_DEPTH | FACET_AOV_NORMAL | FACET_AOV_MATERIAL_ID;
    TRY(camera_rays_create(&camera, s->width, s->height, rays, error));
    return render(v, &desc, out, error);
}

facet_result web_draw_pick(viewer *v, double x, double y, double out[8], facet_error *error)
{
    camera_rays rays;
    film pixel = {0};
    float origin[3], direction[3];
    double far[3] = {0.0, 0.0, 0.0};
    memset(out, 0, 8 * sizeof *out);
    TRY(render_pixel(v, x, y, &rays, &pixel, error));
    const float *normal = film_find(&pixel, "normal")->pixels;
    double depth = (double)*film_find(&pixel, "depth")->pixels;
    double material = (double)*film_find(&pixel, "material")->pixels;
    facet_scene_get_origin(v->scene, far);
    camera_rays_at(&rays, floorf((float)x) + 0.5f, floorf((float)y) + 0.5f, origin, direction);
    out[0] = isfinite(depth);
    for (int i = 0; i < 3 && out[0] != 0.0; i++) {
        out[1 + i] = far[i] + (double)origin[i] + depth * (double)direction[i];
        out[4 + i] = (double)normal[i];
    }
    out[7] = material - 1.0;
    film_destroy(&pixel);
    return FACET_OK;
}

static double dot(const double a[3], const float b[3])
{
    return a[0] * (double)b[0] + a[1] * (double)b[1] + a[2] * (double)b[2];
}

static double square(const float a[3])
{
    const double wide[3] = {(double)a[0], (double)a[1], (double)a[2]};
    return dot(wide, a);
}

facet_result web_draw_project(viewer *v, const double position[3], double out[4], facet_error *error)
{
    facet_camera camera;
    facet_render_desc desc;
    camera_rays rays;
    double from_eye[3], far[3];
    const view_state *s = &v->state;
    TRY(web_draw_desc(v, s->width, s->height, &camera, &desc, error));
    TRY(camera_rays_create(&camera, s->width, s->height, &rays, error));
    facet_scene_get_origin(v->scene, far);
    for (int i = 0; i < 3; i++)
        from_eye[i] = position[i] - far[i] - (double)rays.origin[i];
    double depth = dot(from_eye, rays.direction) / square(rays.direction);
    const float *right = rays.is_orthographic ? rays.origin_dx : rays.direction_dx;
    const float *down = rays.is_orthographic ? rays.origin_dy : rays.direction_dy;
    double scale = rays.is_orthographic ? 1.0 : depth;
    out[0] = (double)rays.middle[0] + dot(from_eye, right) / (scale * square(right));
    out[1] = (double)rays.middle[1] + dot(from_eye, down) / (scale * square(down));
    out[2] = depth;
    out[3] = depth > 0.0;
    return FACET_OK;
}

/* ---- light meter ---- */

facet_result web_draw_meter(viewer *v, float *stops, facet_error *error)
{
    enum { METER_SIZE = 128 }; /* pixels along the longer edge */
    const view_state *s = &v->state;
    uint32_t longer = s->width > s->height ? s->width : s->height;
    uint32_t width = longer ? (METER_SIZE * s->width + longer - 1) / longer : METER_SIZE;
    uint32_t height = longer ? (METER_SIZE * s->height + longer - 1) / longer : METER_SIZE;
    facet_camera camera;
    facet_render_desc desc;
    film metered = {0};
    TRY(web_draw_desc(v, width, height, &camera, &desc, error));
    desc.samples = 1;
    desc.quality = FACET_QUALITY_DRAFT;
    desc.exposure_ev = 0.0f;
    desc.energy = FACET_ENERGY_CONSERVING;
    desc.ground = FACET_GROUND_NONE;
    desc.gl = (facet_gl_desc){.channel = FACET_CHANNEL_LIGHT};
    TRY(render(v, &desc, &metered, error));
    double average = film_meter(&metered);
    film_destroy(&metered);
    *stops = average > 0.0 ? (float)(round(meter_exposure_ev(meter_ev100(average)) * 1e4) / 1e4) : 0.0f;
    return FACET_OK;
}
