/* empty_view.c - see empty_view.h. Each triangle, line and point is counted under the first reason that
 * keeps it from being seen; the most frequent reason is reported. */
#include "draw/empty_view.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/unseen.h"

typedef enum reason {
    REASON_BEHIND,
    REASON_OUTSIDE,
    REASON_CLIPPED,
    REASON_BACK,
    REASON_EDGE_ON,
    REASON_TRANSPARENT,
    REASON_FLAT,
    REASON_COUNT
} reason;

typedef struct view {
    const camera_rays *camera;
    double axes[3][3]; /* right and down, scaled such that dot products are pixels at depth 1; forward */
    double frame[4];   /* left, top, right, bottom: pixels from the middle */
    uint64_t counts[REASON_COUNT];
    uint64_t seen;        /* elements without a reason */
    uint64_t see_through; /* of these: those whose material is not opaque */
} view;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static view make_view(const facet_render_desc *desc, const camera_rays *camera)
{
    view v = {.camera = camera};
    const float *dx = camera->is_orthographic ? camera->origin_dx : camera->direction_dx;
    const float *dy = camera->is_orthographic ? camera->origin_dy : camera->direction_dy;
    double x2 = 0.0;
    double y2 = 0.0;
    for (int i = 0; i < 3; i++) {
        x2 += (double)dx[i] * (double)dx[i];
        y2 += (double)dy[i] * (double)dy[i];
    }
    for (int i = 0; i < 3; i++) {
        v.axes[0][i] = (double)dx[i] / x2;
        v.axes[1][i] = (double)dy[i] / y2;
        v.axes[2][i] = (double)camera->direction[i];
    }
    for (int i = 0; i < 4; i++)
        v.frame[i] =
            (double)desc->crop[i % 2] + (i < 2 ? 0.0 : (double)desc->crop[i]) - (double)camera->middle[i % 2];
    return v;
}

/* ---- one element ---- */

/* Its corners in camera space: pixels from the middle, times the depth for a perspective camera, and the
 * depth. */
typedef struct element {
    uint32_t count;
    double world[3][3], seen[3][3];
} element;

static element read_element(const view *v, const scene_instance *instance, uint32_t first, uint32_t count)
{
    element e = {.count = count};
    for (uint32_t i = 0; i < count; i++) {
        float p[3];
        size_t vertex = instance->primitive->indices[first + i];
        mat4_transform_point(&instance->world, instance->positions + 3 * vertex, p);
        double from_eye[3];
        for (int k = 0; k < 3; k++) {
            e.world[i][k] = (double)p[k];
            from_eye[k] = (double)p[k] - (double)v->camera->origin[k];
        }
        for (int k = 0; k < 3; k++)
            e.seen[i][k] = dot(from_eye, v->axes[k]);
    }
    return e;
}

/* Whether the depths of all corners are outside (low, high). */
static bool is_beside(const element *e, double low, double high)
{
    bool is_low = true;
    bool is_high = true;
    for (uint32_t i = 0; i < e->count; i++) {
        is_low = is_low && e->seen[i][2] <= low;
        is_high = is_high && e->seen[i][2] > high;
    }
    return is_low || is_high;
}

/* Whether all corners of the frame are on the outer side of an edge of a triangle in front of the eye. */
static bool is_frame_outside(const view *v, const element *e)
{
    double at[3][2];
    for (uint32_t i = 0; i < 3; i++) {
        if (e->count < 3 || !(e->seen[i][2] > 0.0))
            return false;
        for (int k = 0; k < 2; k++)
            at[i][k] = e->seen[i][k] / (v->camera->is_orthographic ? 1.0 : e->seen[i][2]);
    }
    for (int i = 0; i < 3; i++) {
        const double *a = at[i];
        const double *b = at[(i + 1) % 3];
        const double *c = at[(i + 2) % 3];
        double inside = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        bool is_beyond = true;
        for (int k = 0; k < 4; k++) {
            double x = v->frame[k & 1 ? 2 : 0];
            double y = v->frame[k & 2 ? 3 : 1];
            double side = (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
            is_beyond = is_beyond && (inside > 0.0 ? side < 0.0 : side > 0.0);
        }
        if (is_beyond)
            return true;
    }
    return false;
}

/* Whether no pixel of the frame can be inside the element. */
static bool is_outside(const view *v, const element *e)
{
    for (int side = 0; side < 4; side++) {
        bool is_beyond = true;
        for (uint32_t i = 0; i < e->count; i++) {
            double w = v->camera->is_orthographic ? 1.0 : e->seen[i][2];
            double over = e->seen[i][side % 2] - v->frame[side] * w;
            is_beyond = is_beyond && (side < 2 ? over < 0.0 : over > 0.0);
        }
        if (is_beyond)
            return true;
    }
    return is_frame_outside(v, e);
}

/* The cosine between the triangle's front and the direction to the eye. */
static double facing(const view *v, const element *e, bool is_mirrored)
{
    double a[3];
    double b[3];
    double to_eye[3];
    for (int k = 0; k < 3; k++) {
        a[k] = e->world[1][k] - e->world[0][k];
        b[k] = e->world[2][k] - e->world[0][k];
        to_eye[k] =
            v->camera->is_orthographic ? -v->axes[2][k] : (double)v->camera->origin[k] - e->world[0][k];
    }
    const double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    double lengths = sqrt(dot(n, n) * dot(to_eye, to_eye));
    double cosine = lengths > 0.0 ? dot(n, to_eye) / lengths : 0.0;
    return is_mirrored ? -cosine : cosine;
}

/* REASON_COUNT: none. */
static reason find_reason(const view *v, const scene_instance *instance, bool is_double_sided, uint32_t first,
                          uint32_t count)
{
    element e = read_element(v, instance, first, count);
    if (count == 3 && unseen_is_flat(instance->positions, instance->primitive->indices + first))
        return REASON_FLAT;
    if (is_beside(&e, 0.0, HUGE_VAL))
        return REASON_BEHIND;
    if (is_outside(v, &e))
        return REASON_OUTSIDE;
    if (is_beside(&e, (double)v->camera->near_m, (double)v->camera->far_m))
        return REASON_CLIPPED;
    if (count < 3)
        return REASON_COUNT;
    double cosine = facing(v, &e, instance->is_mirrored);
    if (fabs(cosine) < 1e-6)
        return REASON_EDGE_ON;
    return cosine < 0.0 && !is_double_sided ? REASON_BACK : REASON_COUNT;
}

static void look_at(view *v, const facet_scene *scene, const scene_pose *pose, const scene_instance *instance)
{
    const scene_primitive *p = instance->primitive;
    const scene_material *material = scene_pose_material(scene, pose, instance);
    uint32_t corners = p->mode == SCENE_TRIANGLES ? 3 : p->mode == SCENE_LINES ? 2 : 1;
    if (instance->is_unseen) {
        v->counts[p->is_flat ? REASON_FLAT : REASON_TRANSPARENT] += p->index_count / corners;
        return;
    }
    for (uint32_t i = 0; i + corners <= p->index_count; i += corners) {
        reason why = find_reason(v, instance, material->is_double_sided, i, corners);
        if (why < REASON_COUNT) {
            v->counts[why]++;
            continue;
        }
        v->seen++;
        v->see_through += material->alpha_mode != SCENE_ALPHA_OPAQUE;
    }
}

/* ---- the sentence ---- */

/* Why a scene draws nothing at all. */
static const char *explain_nothing(const facet_scene *scene)
{
    bool has_geometry = false;
    bool has_node = false;
    bool has_hidden = false;
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++)
            has_geometry = has_geometry || scene->meshes[i].primitives[k].index_count > 0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        has_node = has_node || scene->nodes[i].mesh != SCENE_NONE;
        has_hidden = has_hidden || scene->nodes[i].is_hidden;
    }
    if (!has_geometry)
        return "there is no geometry in the file; facet inspect lists what there is";
    if (!has_node)
        return "no node of the file has a mesh; facet inspect --json lists the nodes";
    if (has_hidden)
        return "the nodes that have a mesh are hidden (KHR_node_visibility), scaled to 0, or in another "
               "scene "
               "(--scene)";
    if (scene->scene_count > 1)
        return "no node of this scene has a mesh that is not scaled to 0; the file has other scenes "
               "(--scene)";
    return "the nodes that have a mesh are scaled to 0, or not in the scene; give them a scale, or another "
           "--time if "
           "an animation scales them";
}

static bool is_inside(const view *v, const scene_pose *pose)
{
    for (int i = 0; i < 3; i++)
        if (!(v->camera->origin[i] > pose->bounds_min[i] && v->camera->origin[i] < pose->bounds_max[i]))
            return false;
    return true;
}

static void explain(const view *v, const scene_pose *pose, const facet_render_desc *desc, char *why,
                    size_t size)
{
    bool has_crop = desc->crop[2] < desc->width || desc->crop[3] < desc->height;
    const char *const texts[REASON_COUNT] = {
        [REASON_BEHIND] =
            "it is behind the camera; turn the camera round, or leave --camera, --eye and --target away, "
            "which frames the model",
        [REASON_OUTSIDE] = has_crop ? "it is outside the part of the image that --crop names"
                                    : "it is outside the image; aim the camera at it, or leave --camera, "
                                      "--eye and --target away, which "
                                      "frames the model",
        [REASON_BACK] = is_inside(v, pose) ? "the camera is inside it, and its surfaces are drawn from "
                                             "the other side only; move the camera out, "
                                             "or set doubleSided in its materials"
                                           : "it is seen from behind, and its surfaces are drawn from the "
                                             "front only; look from the opposite side, "
                                             "--orbit AZ+180,180-POLAR, or set doubleSided in its materials",
        [REASON_EDGE_ON] = "it is flat and seen edge-on; look from another direction, as with --orbit 30,45",
        [REASON_TRANSPARENT] =
            "its opacity is 0; give its materials or vertex colors an alpha above 0, or alphaMode "
            "OPAQUE",
        [REASON_FLAT] = "its triangles have no area: their corners coincide or lie on a line"};
    reason most = REASON_BEHIND;
    for (int i = 0; i < REASON_COUNT; i++)
        if (v->counts[i] > v->counts[most])
            most = (reason)i;
    if (v->seen)
        snprintf(
            why, size, "%s",
            v->see_through
                ? "all of it that the camera could see is made transparent by textures or vertex colors; "
                  "look at their alpha, or set alphaMode OPAQUE"
                : "it is smaller than a pixel; move the camera nearer, as with --orbit, or draw a larger "
                  "image (--size)");
    else if (most == REASON_CLIPPED)
        snprintf(
            why, size,
            "it is nearer or farther than the camera draws (%g m to %g m); use another camera, or --orbit",
            (double)v->camera->near_m, (double)v->camera->far_m);
    else
        snprintf(why, size, "%s", texts[most]);
}

bool empty_view_explain(const facet_scene *scene, const scene_pose *pose, const facet_render_desc *desc,
                        const camera_rays *camera, char *why, size_t size)
{
    if (pose->instance_count == 0) {
        snprintf(why, size, "%s", explain_nothing(scene));
        return true;
    }
    view v = make_view(desc, camera);
    bool has_alpha = desc->background != FACET_BACKGROUND_ENVIRONMENT;
    for (uint32_t i = 0; i < pose->instance_count && (has_alpha || !v.seen); i++)
        look_at(&v, scene, pose, &pose->instances[i]);
    explain(&v, pose, desc, why, size);
    return v.seen == 0;
}
