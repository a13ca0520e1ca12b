/* lights.c - lights of OpenGL 1 to KHR_lights_punctual and back. */
#include "legacy/convert_state.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/result.h"

#define PI 3.14159265358979323846

/* Name prefix of lights made from legacy ones, by which a later conversion finds them. */
static const char MADE_PREFIX[] = "legacy light ";

static double distance(const float a[3], const float b[3])
{
    double sum = 0;
    for (int k = 0; k < 3; k++)
        sum += ((double)a[k] - (double)b[k]) * ((double)a[k] - (double)b[k]);
    return sqrt(sum);
}

static bool normalize3(double v[3])
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3 && length > 0; k++)
        v[k] /= length;
    return length > 0;
}

/* ---- places ---- */

/* Center and radius of the scene, and the space of the default camera. */
typedef struct stage {
    float center[3];
    double radius;
    float eye[3];
    double axes[3][3]; /* right, up, backward: unit, world space */
    double origin[3];  /* of the scene: lights of OpenGL 1 are in coordinates of the file, as nodes are */
} stage;

static void set_camera(stage *s, const facet_camera *camera)
{
    double *right = s->axes[0];
    double *up = s->axes[1];
    double *back = s->axes[2];
    for (int k = 0; k < 3; k++) {
        s->eye[k] = camera->eye[k];
        back[k] = (double)camera->eye[k] - (double)camera->target[k];
    }
    /* An orbit camera never looks along its up vector. */
    if (!normalize3(back))
        back[2] = 1;
    const double y[3] = {0, 1, 0};
    for (int k = 0; k < 3; k++)
        right[k] = y[(k + 1) % 3] * back[(k + 2) % 3] - y[(k + 2) % 3] * back[(k + 1) % 3];
    if (!normalize3(right))
        right[0] = 1;
    for (int k = 0; k < 3; k++)
        up[k] = back[(k + 1) % 3] * right[(k + 2) % 3] - back[(k + 2) % 3] * right[(k + 1) % 3];
}

static facet_result set_stage(const facet_scene *scene, stage *s, facet_error *error)
{
    *s = (stage){.radius = 1};
    memcpy(s->origin, scene->origin, sizeof s->origin);
    facet_camera camera = {.eye = {0, 0, 1}};
    const facet_orbit orbit = scene_orbit_default();
    scene_pose pose;
    facet_result result =
        scene_pose_create(scene, NULL, &scene->allocator, scene->thread_count, &pose, error);
    if (result != FACET_OK)
        return result;
    if (pose.has_bounds) {
        for (int k = 0; k < 3; k++)
            s->center[k] = 0.5f * pose.bounds_min[k] + 0.5f * pose.bounds_max[k];
        s->radius = 0.5 * distance(pose.bounds_min, pose.bounds_max);
        result = scene_fit_pose(scene, &pose, &orbit, 4.0f / 3.0f, scene->thread_count, &camera, error);
    }
    scene_pose_destroy(&pose);
    set_camera(s, &camera);
    return result == FACET_ERROR_MEMORY ? result : FACET_OK;
}

static void to_world(const stage *s, const float in[3], bool is_point, double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = (double)in[0] * s->axes[0][k] + (double)in[1] * s->axes[1][k] +
                 (double)in[2] * s->axes[2][k] + (is_point ? (double)s->eye[k] : 0.0);
}

/* The rotation from -Z, the direction of punctual lights, to a direction. */
static void turn_to(const double direction[3], float q[4])
{
    /* (from x to, 1 + from . to), normalised; from = (0, 0, -1). */
    double v[4] = {direction[1], -direction[0], 0, 1.0 - direction[2]};
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[3] * v[3]);
    if (length < 1e-9) { /* opposite: half a turn about y */
        v[0] = v[3] = 0;
        v[1] = length = 1;
    }
    for (int k = 0; k < 4; k++)
        q[k] = (float)(v[k] / length);
}

/* ---- to punctual lights ---- */

static void make_light(conversion *c, const stage *s, const legacy_light *in, scene_light *light,
                       scene_node *node)
{
    facet_legacy_colors colors = c->scene->legacy->colors;
    double place[3] = {(double)in->position[0], (double)in->position[1], (double)in->position[2]};
    float color[3];
    legacy_color_to_linear(in->diffuse, colors, color);
    float most = highest_of(color);
    double illuminance = (double)most * (c->desc.keeps_light ? 1.0 : PI);
    *light = (scene_light){
        .type = SCENE_LIGHT_DIRECTIONAL, .intensity = (float)illuminance, .outer_cone_rad = 0.785398f};
    for (int k = 0; k < 3; k++)
        light->color[k] = most > 0.0f ? color[k] / most : 1.0f;
    if (memcmp(in->diffuse, in->specular, sizeof in->diffuse) != 0)
        note_add(&c->notes, SCENE_NONE, NOTE_LIGHT_SIMPLIFIED,
                 "lights of glTF have one color for diffuse and specular light: that of diffuse light");
    if (in->is_viewpoint_relative) {
        to_world(s, in->position, in->is_point, place);
        note_add(&c->notes, SCENE_NONE, NOTE_VIEWPOINT_LIGHT,
                 "lights that move with the camera are placed for the default camera");
    }
    *node = scene_node_default(NULL);
    if (in->is_point) {
        float at[3];
        for (int k = 0; k < 3; k++) {
            at[k] = (float)(in->is_viewpoint_relative ? place[k] : place[k] - s->origin[k]);
            node->translation[k] = s->origin[k] + (double)at[k];
        }
        /* Inside the scene distances vary: a light at its center is right at half its radius. */
        double reach = fmax(distance(at, s->center), 0.5 * s->radius);
        light->type = SCENE_LIGHT_POINT;
        light->intensity = (float)(illuminance * reach * reach);
        note_add(
            &c->notes, SCENE_NONE, NOTE_POINT_LIGHT_ATTENUATION,
            "point lights of OpenGL 1 do not fade, those of glTF do: their intensity is right at the middle "
            "of the scene");
        return;
    }
    double direction[3] = {-place[0], -place[1], -place[2]};
    if (normalize3(direction))
        turn_to(direction, node->rotation);
}

static bool is_made(const facet_scene *scene, const scene_node *node)
{
    return node->light != SCENE_NONE &&
           strncmp(scene->lights[node->light].name, MADE_PREFIX, sizeof MADE_PREFIX - 1) == 0;
}

/* Lights of an earlier conversion keep their indices. */
static bool replace_lights(conversion *c, const stage *s)
{
    facet_scene *scene = c->scene;
    uint32_t found = 0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        scene_node *node = &scene->nodes[i];
        if (!is_made(scene, node) || found >= scene->legacy->light_count)
            continue;
        scene_light *light = &scene->lights[node->light];
        scene_node made_node;
        scene_light made;
        make_light(c, s, &scene->legacy->lights[found++], &made, &made_node);
        made.name = light->name;
        *light = made;
        memcpy(node->translation, made_node.translation, sizeof node->translation);
        memcpy(node->rotation, made_node.rotation, sizeof node->rotation);
    }
    return found > 0;
}

/* Extends arrays by count; false: out of memory. */
typedef struct longer {
    scene_node *nodes;
    scene_light *lights;
    uint32_t *roots;
    scene_root *scenes;
} longer;

static bool make_room(const facet_scene *scene, uint32_t count, const scene_root *root, longer *out)
{
    arena *a = scene->arena;
    size_t root_count = root ? root->node_count : 0;
    out->nodes = arena_alloc(a, (size_t)scene->node_count + count, sizeof *out->nodes);
    out->lights = arena_alloc(a, (size_t)scene->light_count + count, sizeof *out->lights);
    out->roots = arena_alloc(a, root_count + count, sizeof *out->roots);
    out->scenes = arena_alloc(a, (size_t)scene->scene_count + 1, sizeof *out->scenes);
    if (!out->nodes || !out->lights || !out->roots || !out->scenes)
        return false;
    if (scene->node_count > 0)
        memcpy(out->nodes, scene->nodes, scene->node_count * sizeof *out->nodes);
    if (scene->light_count > 0)
        memcpy(out->lights, scene->lights, scene->light_count * sizeof *out->lights);
    if (root_count > 0)
        memcpy(out->roots, root->nodes, root_count * sizeof *out->roots);
    if (scene->scene_count > 0)
        memcpy(out->scenes, scene->scenes, scene->scene_count * sizeof *out->scenes);
    return true;
}

facet_result lights_from_legacy(conversion *c, facet_error *error)
{
    facet_scene *scene = c->scene;
    uint32_t count = scene->legacy->light_count;
    stage s;
    if (count == 0)
        return FACET_OK;
    facet_result result = set_stage(scene, &s, error);
    if (result != FACET_OK || replace_lights(c, &s))
        return result;
    scene_root *root =
        scene->default_scene < scene->scene_count ? &scene->scenes[scene->default_scene] : NULL;
    longer to;
    if (!make_room(scene, count, root, &to))
        return fail_memory(error, "lights", count * sizeof(scene_light));
    for (uint32_t i = 0; i < count; i++) {
        char name[sizeof MADE_PREFIX + 16];
        scene_light *light = &to.lights[scene->light_count + i];
        scene_node *node = &to.nodes[scene->node_count + i];
        make_light(c, &s, &scene->legacy->lights[i], light, node);
        snprintf(name, sizeof name, "%s%u", MADE_PREFIX, i + 1);
        light->name = node->name = arena_strdup(scene->arena, name);
        if (!light->name)
            return fail_memory(error, "lights", sizeof name);
        node->light = scene->light_count + i;
        to.roots[(root ? root->node_count : 0) + i] = scene->node_count + i;
    }
    if (root) {
        to.scenes[scene->default_scene].nodes = to.roots;
        to.scenes[scene->default_scene].node_count += count;
        scene->scenes = to.scenes;
    }
    scene->nodes = to.nodes;
    scene->lights = to.lights;
    scene->node_count += count;
    scene->light_count += count;
    return FACET_OK;
}

/* ---- to legacy lights ---- */

static void make_legacy(conversion *c, const stage *s, const scene_posed_light *in, legacy_light *out)
{
    const scene_light *light = &in->light;
    double illuminance = (double)light->intensity / (c->desc.keeps_light ? 1.0 : PI);
    *out = legacy_light_default();
    out->is_viewpoint_relative = false;
    out->is_point = light->type != SCENE_LIGHT_DIRECTIONAL;
    for (int k = 0; k < 3; k++)
        out->position[k] =
            out->is_point ? (float)(s->origin[k] + (double)in->position[k]) : -in->direction[k];
    if (out->is_point) {
        double reach = fmax(distance(in->position, s->center), 0.5 * s->radius);
        illuminance /= reach > 0 ? reach * reach : 1.0;
        note_add(
            &c->notes, SCENE_NONE, NOTE_POINT_LIGHT_ATTENUATION,
            "point lights of glTF fade, those of OpenGL 1 do not: their color is right at the middle of the "
            "scene");
    }
    if (light->type == SCENE_LIGHT_SPOT)
        note_add(&c->notes, SCENE_NONE, NOTE_LIGHT_SIMPLIFIED, "spot lights become point lights");
    for (int k = 0; k < 3; k++) {
        out->ambient[k] = 0.0f;
        out->diffuse[k] =
            legacy_from_linear((float)((double)light->color[k] * illuminance), c->legacy->colors);
        out->specular[k] = out->diffuse[k];
    }
}

facet_result lights_to_legacy(conversion *c, facet_error *error)
{
    facet_scene *scene = c->scene;
    stage s;
    scene_pose pose;
    if (scene->light_count == 0 || c->legacy->light_count > 0)
        return FACET_OK;
    facet_result result = set_stage(scene, &s, error);
    if (result == FACET_OK)
        result = scene_pose_create(scene, NULL, &scene->allocator, scene->thread_count, &pose, error);
    if (result != FACET_OK)
        return result == FACET_ERROR_MEMORY ? result : FACET_OK;
    legacy_light *lights = arena_alloc(scene->arena, (size_t)pose.light_count + 1, sizeof *lights);
    for (uint32_t i = 0; lights && i < pose.light_count; i++)
        make_legacy(c, &s, &pose.lights[i], &lights[i]);
    if (lights) {
        c->legacy->lights = lights;
        c->legacy->light_count = pose.light_count;
    }
    scene_pose_destroy(&pose);
    return lights ? FACET_OK : fail_memory(error, "lights", pose.light_count * sizeof *lights);
}
