/* gl_sea_model.c - see gl_sea_model.h. */
#include "gl/sea/gl_sea_model.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "gl/core/gl_api.h"
#include "gl/sea/gl_sea_textures.h"

static const uint32_t MAX_PIXELS = 2048; /* of a cut per axis */

/* ---- cuts: gl_sea_block.h ---- */

/* The eye mirrored at the water's plane; turned around its axis, so that it is not left-handed. */
static camera_rays mirrored(const camera_rays *c, float plane_m)
{
    camera_rays m = *c;
    m.origin[1] = 2.0f * plane_m - c->origin[1];
    m.direction[1] = -c->direction[1];
    m.direction_dx[1] = -c->direction_dx[1];
    m.direction_dy[0] = -c->direction_dy[0];
    m.direction_dy[2] = -c->direction_dy[2];
    return m;
}

/* The depth, relative to the eye's depth, at which an eye would see the same without water: of a point
 * height_m above flat water, away_m away. Snell's law by bisection. */
static double apparent_depth(double depth_m, double height_m, double away_m, double ior)
{
    double low = 0.0, high = 1.0; /* sine in the air */
    for (int i = 0; i < 40; i++) {
        double out = 0.5 * (low + high), in = out / ior;
        double reach = depth_m * in / sqrt(1.0 - in * in) + height_m * out / sqrt(1.0 - out * out);
        *(reach < away_m ? &low : &high) = out;
    }
    double in = low / ior;
    return sqrt(1.0 - low * low) / (ior * sqrt(1.0 - in * in));
}

/* From the eye, as deep as flat water raises it for the middle of what is above the water; no wider than
 * needed to see that. */
static facet_camera window_camera(const water_frame *p, const float eye[3], float ior)
{
    facet_camera c = {.eye = {eye[0], 0.0f, eye[2]}, .fov_y_rad = 0.0f};
    float low = fmaxf(p->model_low[1], p->model_water_m), radius = 0.0f;
    float depth = fmaxf(p->model_water_m - eye[1], 1e-3f);
    for (int i = 0; i < 3; i++) {
        float first = i == 1 ? low : p->model_low[i], half = 0.5f * fmaxf(p->model_high[i] - first, 1e-3f);
        c.target[i] = first + half;
        radius += half * half;
    }
    float away = hypotf(c.target[0] - eye[0], c.target[2] - eye[2]);
    double lifted =
        apparent_depth((double)depth, (double)(c.target[1] - p->model_water_m), (double)away, (double)ior);
    c.eye[1] = p->model_water_m - depth * fmaxf((float)lifted, 0.1f);
    c.eye[1] = fmaxf(fminf(c.eye[1], p->model_water_low_m - 0.05f * depth), eye[1]);
    float distance = hypotf(away, c.target[1] - c.eye[1]), sine = sqrtf(radius) / fmaxf(distance, 1e-3f);
    c.fov_y_rad = sine < 0.95f ? 2.0f * asinf(sine) : 2.5f;
    return c;
}

/* Height of a near plane that leaves the eye at y on the other side and all free water around the model on
 * this one. */
static float cut_height(const water_frame *p, float y, float side)
{
    float middle = p->model_water_m, least = y + 0.1f * (middle - y);
    return side > 0.0f ? fmaxf(p->model_water_low_m, least) : fminf(p->model_water_high_m, least);
}

/* The near plane lies in the water, so that what is on its other side does not hide the rest (Lengyel
 * 2005): the nearness of a point to the far plane is scale times its height over the plane, divided by its
 * depth. Chosen so that the whole model is nearer than the far plane. side: 1: what is above is visible,
 * -1: below. */
static float plane_scale(const water_frame *p, const camera_rays *c, float plane_m, float side)
{
    double scale = 1.0;
    for (int corner = 0; corner < 8; corner++) {
        double depth = 0.0, height = 0.0;
        for (int i = 0; i < 3; i++) {
            double at = (double)(corner >> i & 1 ? p->model_high[i] : p->model_low[i]);
            depth += (at - (double)c->origin[i]) * (double)c->direction[i];
            height = i == 1 ? (double)side * (at - (double)plane_m) : height;
        }
        if (height > 0.0)
            scale = fmin(scale, 0.9 * fmax(depth, 1e-3) / height);
    }
    return side * (float)scale;
}

static void lay_near_plane(gl_frame_block *block, float scale, float below_m, bool is_reversed)
{
    float *m = block->view_projection, sign = is_reversed ? 1.0f : -1.0f;
    for (int i = 0; i < 4; i++)
        m[4 * i + 2] = sign * m[4 * i + 3];
    m[4 * 1 + 2] -= sign * scale;
    m[4 * 3 + 2] += sign * scale * below_m;
}

/* As large as the image, if that is not too large. */
static gl_view view_of(const facet_render_desc *r)
{
    double edge = r->width > r->height ? r->width : r->height;
    double share = fmin(1.0, (double)MAX_PIXELS / edge);
    return (gl_view){.scale = 1,
                     .width = (uint32_t)fmax((double)r->width * share, 1.0),
                     .height = (uint32_t)fmax((double)r->height * share, 1.0)};
}

/* c: from where; eye: that of the image. */
static facet_result draw_cut(gl_sea_model *m, const water_frame *p, const camera_rays *c, const gl_view *v,
                             const float eye[3], int cut, gl_sea_block *b, facet_error *error)
{
    gl_target *target = &m->cuts[cut];
    facet_result result = gl_target_update(target, m->context, GL_TARGET_FILM, v->width, v->height, 1, error);
    if (result != FACET_OK)
        return result;
    gl_frame_block block = {.channel = 0};
    bool is_reversed = gl_context_is_top_down(m->context);
    float side = p->is_below && cut == GL_SEA_MIRRORED ? -1.0f : 1.0f;
    float plane_m = cut_height(p, c->origin[1], side), below_m = plane_m - c->origin[1];
    float scale = plane_scale(p, c, plane_m, side);
    gl_camera_set(m->context, c, p->model_low, p->model_high, v->width, v->height, v, &block);
    lay_near_plane(&block, scale, below_m, is_reversed);
    result = gl_frame_draw(&m->frame, target, &m->desc, &block, error);
    memcpy(b->cut[cut], block.view_projection, sizeof b->cut[cut]);
    memcpy(b->cut_axis[cut], c->direction, sizeof c->direction);
    b->cut_axis[cut][3] = is_reversed ? 1.0f : 0.0f;
    b->cut_plane[cut][0] = scale;
    b->cut_plane[cut][1] = below_m;
    b->cut_plane[cut][2] = eye[1] - c->origin[1];
    return result;
}

static facet_result draw_cuts(gl_sea_model *m, const water_frame *p, gl_sea_block *b, facet_error *error)
{
    gl_view v = view_of(p->desc);
    camera_rays eye, window;
    facet_result result = camera_rays_create(p->desc->camera, v.width, v.height, &eye, error);
    if (result != FACET_OK)
        return result;
    camera_rays mirror = mirrored(&eye, p->model_water_m);
    result = draw_cut(m, p, &mirror, &v, eye.origin, GL_SEA_MIRRORED, b, error);
    if (result != FACET_OK || !p->is_below)
        return result;
    facet_camera camera = window_camera(p, eye.origin, p->sea->optics.ior);
    float edge = 2.0f * tanf(0.5f * camera.fov_y_rad) / eye.pixel_size; /* pixels as large as the image's */
    v.width = v.height = (uint32_t)fminf(fmaxf(edge, 1.0f), (float)MAX_PIXELS);
    result = camera_rays_create(&camera, v.width, v.height, &window, error);
    return result == FACET_OK ? draw_cut(m, p, &window, &v, eye.origin, GL_SEA_WINDOW, b, error) : result;
}

/* ---- the water around ---- */

static void upload_contact(gl_sea_model *m, const water_frame *p, const camera_rays *camera, gl_sea_block *b)
{
    m->contact = gl_sea_texture_make(GL_UNIT_SEA_CONTACT, GL_TEXTURE_2D, GL_LINEAR, GL_CLAMP_TO_EDGE,
                                     GL_CLAMP_TO_EDGE);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, SEA_CONTACT_EDGE, SEA_CONTACT_EDGE, 0, GL_RGBA, GL_FLOAT,
                 p->contact);
    for (int i = 0; i < 2; i++) {
        b->contact[i] = p->contact_low[i] - camera->origin[2 * i];
        b->contact[2 + i] = 1.0f / (p->contact_high[i] - p->contact_low[i]);
        b->shadow[i] = p->shadow_low[i] - camera->origin[2 * i];
        b->shadow[2 + i] = p->has_shadow ? 1.0f / (p->shadow_high[i] - p->shadow_low[i]) : 0.0f;
    }
}

/* ---- parts of a model ---- */

/* Rays are marched through a bounding sphere, in steps that are short enough for a model, and too long for several
 * models far from each other. */
typedef struct part_box {
    float low[3], high[3];
} part_box;

static float diagonal(const part_box *b)
{
    float square = 0.0f;
    for (int i = 0; i < 3; i++)
        square += (b->high[i] - b->low[i]) * (b->high[i] - b->low[i]);
    return sqrtf(square);
}

static float gap(const part_box *a, const part_box *b)
{
    float square = 0.0f;
    for (int i = 0; i < 3; i++) {
        float apart = fmaxf(fmaxf(a->low[i] - b->high[i], b->low[i] - a->high[i]), 0.0f);
        square += apart * apart;
    }
    return sqrtf(square);
}

static void join(part_box *to, const part_box *from)
{
    for (int i = 0; i < 3; i++) {
        to->low[i] = fminf(to->low[i], from->low[i]);
        to->high[i] = fmaxf(to->high[i], from->high[i]);
    }
}

/* Index of the nearest box; *apart: the gap over the larger diagonal. */
static uint32_t nearest_part(const part_box *parts, uint32_t count, const part_box *box, float *apart)
{
    uint32_t nearest = 0;
    *apart = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        float share = gap(&parts[i], box) / fmaxf(fmaxf(diagonal(&parts[i]), diagonal(box)), 1e-6f);
        if (share < *apart) {
            *apart = share;
            nearest = i;
        }
    }
    return nearest;
}

/* Instances are one part where the gap between them is smaller than the larger one; with more parts than there
 * are spheres the nearest ones are joined. */
static uint32_t find_parts(const scene_pose *pose, part_box parts[GL_SEA_BALLS])
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < pose->instance_count; i++) {
        part_box box;
        gl_mesh_instance_box(&pose->instances[i], box.low, box.high);
        float apart;
        uint32_t nearest = nearest_part(parts, count, &box, &apart);
        while (count > 0 && (apart < 1.0f || count == GL_SEA_BALLS)) {
            join(&box, &parts[nearest]);
            parts[nearest] = parts[--count];
            nearest = nearest_part(parts, count, &box, &apart);
        }
        parts[count++] = box;
    }
    return count;
}

static void describe_ball(const part_box *box, const camera_rays *camera, float ball[4])
{
    float square = 0.0f;
    for (int i = 0; i < 3; i++) {
        float half = 0.5f * (box->high[i] - box->low[i]);
        ball[i] = box->low[i] + half - camera->origin[i];
        square += half * half;
    }
    ball[3] = sqrtf(square);
}

static void describe_bounds(const scene_pose *pose, const water_frame *p, const camera_rays *camera,
                            gl_sea_block *b)
{
    part_box parts[GL_SEA_BALLS], whole;
    memcpy(whole.low, p->model_low, sizeof whole.low);
    memcpy(whole.high, p->model_high, sizeof whole.high);
    uint32_t count = find_parts(pose, parts);
    if (count < 2)
        parts[0] = whole;
    count = count < 2 ? 1 : count;
    for (uint32_t i = 0; i < count; i++)
        describe_ball(&parts[i], camera, b->model_balls[i]);
    describe_ball(&whole, camera, b->model_middle);
    b->model_middle[3] = (float)count;
    for (int i = 0; i < 3; i++)
        b->model_half[i] = 0.5f * (p->model_high[i] - p->model_low[i]);
}

/* ---- entry points ---- */

/* The model is exposed together with the water. Display values of OpenGL 1 count as the radiance that the
 * exposure turns into them; nothing casts shadows there. */
static facet_render_desc desc_of(const water_frame *p)
{
    facet_render_desc d = *p->model_desc;
    bool is_ogl1 = d.shading == FACET_SHADING_OGL1;
    d.renderer = FACET_RENDERER_KIND_GL;
    d.exposure_ev = is_ogl1 ? -p->desc->exposure_ev : 0.0f;
    d.gl = (facet_gl_desc){.has_shadows = !is_ogl1};
    d.aovs = p->desc->aovs;
    return d;
}

facet_result gl_sea_model_begin(gl_sea_model *m, gl_context *context, const water_frame *p,
                                const camera_rays *camera, gl_sea_block *b, facet_render_stats *stats,
                                facet_error *error)
{
    const facet_render_desc *r = p->desc;
    *m = (gl_sea_model){.context = context, .allocator = r->allocator, .desc = desc_of(p)};
    gl_scene_init(&m->prepared, p->model, &m->allocator);
    facet_result result = gl_frame_create(&m->frame, context, p->model, &m->allocator, error);
    if (result == FACET_OK)
        result = gl_scene_update(&m->prepared, &m->desc, error);
    if (result == FACET_OK)
        result = gl_frame_update(&m->frame, &m->prepared, camera, &m->desc, stats, error);
    if (result == FACET_OK)
        describe_bounds(&m->prepared.pose, p, camera, b);
    if (result == FACET_OK)
        result = draw_cuts(m, p, b, error);
    if (result == FACET_OK)
        upload_contact(m, p, camera, b);
    return result;
}

facet_result gl_sea_model_identify(const gl_sea_model *m, const water_frame *p, scene_identity **out,
                                   uint32_t *count, facet_error *error)
{
    scene_identity *model = NULL;
    uint32_t model_count = m->prepared.pose.instance_count;
    *count = 2 + model_count;
    *out = mem_zalloc(&p->desc->allocator, *count, sizeof **out);
    if (!*out)
        return fail_memory(error, "identities", *count * sizeof **out);
    (*out)[0] = *p->water_identity;
    if (p->bed_identity)
        (*out)[1] = *p->bed_identity;
    if (model_count > 0)
        TRY(scene_identities_create(p->model, &m->prepared.pose, &p->desc->allocator, &model, error));
    if (model_count > 0)
        memcpy(*out + 2, model, model_count * sizeof *model);
    mem_free(model);
    return FACET_OK;
}

static gl_frame_block frame_block(const gl_sea_model *m, const water_frame *p, const camera_rays *camera,
                                  const gl_view *view)
{
    gl_frame_block block = {.channel = 0};
    gl_camera_set(m->context, camera, p->model_low, p->model_high, p->desc->width, p->desc->height, view,
                  &block);
    return block;
}

facet_result gl_sea_model_draw(gl_sea_model *m, const water_frame *p, const camera_rays *camera,
                               const gl_view *view, gl_sea_block *b, facet_error *error)
{
    TRY(gl_target_update(&m->seen, m->context, GL_TARGET_FILM, view->width, view->height, 1, error));
    gl_frame_block block = frame_block(m, p, camera, view);
    float along = 0.0f; /* depth in clip space is along * depth + block.view_projection[14] */
    for (int i = 0; i < 3; i++)
        along += block.view_projection[4 * i + 2] * block.forward[i];
    b->model_depth[0] = along;
    b->model_depth[1] = block.view_projection[14];
    b->model_depth[2] = gl_context_is_top_down(m->context) ? 1.0f : 0.0f;
    return gl_frame_draw(&m->frame, &m->seen, &m->desc, &block, error);
}

facet_result gl_sea_model_draw_layers(gl_sea_model *m, const water_frame *p, const camera_rays *camera,
                                      const gl_view *view, facet_error *error)
{
    TRY(gl_target_update(&m->layers, m->context, GL_TARGET_LAYERED, view->width, view->height, 1, error));
    gl_frame_block block = frame_block(m, p, camera, view);
    return gl_frame_draw_layers(&m->frame, &m->layers, &m->desc, &block, error);
}

static void bind_image(uint32_t unit, uint32_t texture)
{
    gl_sea_texture_bind(unit, GL_TEXTURE_2D, texture);
}

void gl_sea_model_bind(const gl_sea_model *m)
{
    const gl_target *mirrored = &m->cuts[GL_SEA_MIRRORED], *window = &m->cuts[GL_SEA_WINDOW];
    bind_image(GL_UNIT_SEA_MODEL, m->seen.color);
    bind_image(GL_UNIT_SEA_MODEL_DEPTH, m->seen.depth);
    bind_image(GL_UNIT_SEA_MIRRORED, mirrored->color);
    bind_image(GL_UNIT_SEA_MIRRORED_DEPTH, mirrored->depth);
    if (window->color) {
        bind_image(GL_UNIT_SEA_WINDOW, window->color);
        bind_image(GL_UNIT_SEA_WINDOW_DEPTH, window->depth);
    }
    bind_image(GL_UNIT_SEA_CONTACT, m->contact);
}

void gl_sea_model_bind_layers(const gl_sea_model *m)
{
    bind_image(GL_UNIT_SEA_MODEL_NORMAL, m->layers.color);
    bind_image(GL_UNIT_SEA_MODEL_ALBEDO, m->layers.layers[0]);
    bind_image(GL_UNIT_SEA_MODEL_NUMBER, m->layers.layers[1]);
    bind_image(GL_UNIT_SEA_CONTACT, m->contact);
}

void gl_sea_model_end(gl_sea_model *m)
{
    if (!m->context)
        return;
    gl_frame_destroy(&m->frame);
    gl_scene_clear(&m->prepared);
    gl_target_destroy(&m->seen);
    gl_target_destroy(&m->layers);
    for (int i = 0; i < GL_SEA_CUTS; i++)
        gl_target_destroy(&m->cuts[i]);
    glDeleteTextures(1, &m->contact);
    *m = (gl_sea_model){.context = NULL};
}
