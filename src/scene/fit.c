/* fit.c - cameras on an orbit, at the distance that frames the model exactly. */
#include <math.h>

#include "base/parallel.h"
#include "base/result.h"
#include "scene/keyframes.h"
#include "scene/stray.h"
#include "scene/unseen.h"
#include "scene/vertex_tree.h"

facet_orbit scene_orbit_default(void)
{
    const float degree = 3.14159265f / 180.0f;
    return (facet_orbit){.polar_rad = 75.0f * degree, .radius_scale = 1.05f, .fov_y_rad = 30.0f * degree};
}

/* The view of an orbit: unit vectors in world space, and the tangents of the half angles of view. */
typedef struct view {
    double target[3];
    double right[3], up[3], back[3]; /* back: from the target to the eye */
    double vertical[3];              /* the axis of the orbit */
    double sin_polar, cos_polar;
    double tan_x, tan_y; /* orthographic: the aspect, and 1 */
    bool is_orthographic;
    bool fits_all_azimuths;
} view;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* From +Y up to +Z up, a quarter turn around X: +Z, the front, becomes -Y, the front in tools with +Z up. */
static void orient(const double y_up[3], bool is_z_up, double out[3])
{
    out[0] = y_up[0];
    out[1] = is_z_up ? -y_up[2] : y_up[1];
    out[2] = is_z_up ? y_up[1] : y_up[2];
}

static void aim(view *v, const facet_orbit *orbit, float aspect)
{
    double sin_azimuth = sin((double)orbit->azimuth_rad);
    double cos_azimuth = cos((double)orbit->azimuth_rad);
    v->sin_polar = sin((double)orbit->polar_rad);
    v->cos_polar = cos((double)orbit->polar_rad);
    const double back[3] = {v->sin_polar * sin_azimuth, v->cos_polar, v->sin_polar * cos_azimuth};
    /* The negative derivative of back by the polar angle, so that looking straight down has an up vector. */
    const double up[3] = {-v->cos_polar * sin_azimuth, v->sin_polar, -v->cos_polar * cos_azimuth};
    const double right[3] = {cos_azimuth, 0.0, -sin_azimuth};
    const double vertical[3] = {0.0, 1.0, 0.0};
    orient(back, orbit->is_z_up, v->back);
    orient(up, orbit->is_z_up, v->up);
    orient(right, orbit->is_z_up, v->right);
    orient(vertical, orbit->is_z_up, v->vertical);
    v->is_orthographic = orbit->is_orthographic;
    v->tan_y = orbit->is_orthographic ? 1.0 : tan(0.5 * (double)orbit->fov_y_rad);
    v->tan_x = v->tan_y * (double)aspect;
}

/* ---- how far ---- */

/* The result of measuring vertices. Perspective: extent is the distance from eye to target at which all
 * vertices are in the image. Orthographic: half the height that shows them. nearest: the largest
 * coordinate towards the eye. */
typedef struct extent {
    double extent, nearest;
} extent;

static void extent_add(extent *e, double value, double nearest)
{
    e->extent = value > e->extent ? value : e->extent;
    e->nearest = nearest > e->nearest ? nearest : e->nearest;
}

/* A vertex at (x, y, z) right, up and back of the target is in the image from distance d on when |x| <= (d
 * - z) / tan_x and |y| <= (d - z) tan_y. */
static void add_point(const view *v, const double p[3], extent *e)
{
    double x = dot(p, v->right);
    double y = dot(p, v->up);
    double z = dot(p, v->back);
    double x_size = fabs(x) / v->tan_x;
    double y_size = fabs(y) / v->tan_y;
    double sideways = x_size > y_size ? x_size : y_size;
    extent_add(e, v->is_orthographic ? sideways : z + sideways, z);
}

/* The same for all azimuths. With height h and distance r from the vertical, and phi the angle between the
 * vertex and the eye, x = r sin phi, y = h sin p - r cos phi cos p, z = h cos p + r cos phi sin p. Each
 * bound above is a sum A + B cos phi + C |sin phi|, largest at A + sqrt(B^2 + C^2). */
static void add_circle(const view *v, const double p[3], extent *e)
{
    double h = dot(p, v->vertical);
    double r2 = dot(p, p) - h * h;
    double r = r2 > 0.0 ? sqrt(r2) : 0.0;
    double s = v->sin_polar;
    double c = v->cos_polar;
    double nearest = h * c + r * fabs(s);
    if (v->is_orthographic) {
        extent_add(e, fmax(r / v->tan_x, (fabs(h * s) + r * fabs(c)) / v->tan_y), nearest);
        return;
    }
    double side = h * c + r * sqrt(s * s + 1.0 / (v->tan_x * v->tan_x));
    double top = h * c + h * s / v->tan_y + r * fabs(s - c / v->tan_y);
    double bottom = h * c - h * s / v->tan_y + r * fabs(s + c / v->tan_y);
    extent_add(e, fmax(side, fmax(top, bottom)), nearest);
}

static void add_vertex(const view *v, const float world[3], extent *e)
{
    double p[3];
    for (int axis = 0; axis < 3; axis++)
        p[axis] = (double)world[axis] - v->target[axis];
    if (v->fits_all_azimuths)
        add_circle(v, p, e);
    else
        add_point(v, p, e);
}

/* A search over the vertices of an instance. */
typedef struct search {
    const view *view;
    const scene_instance *instance;
    const box *kept; /* NULL: all vertices */
    extent *extent;
} search;

static void search_vertex(void *context, const float position[3])
{
    const search *s = context;
    float world[3];
    mat4_transform_point(&s->instance->world, position, world);
    if (!s->kept || box_holds(s->kept, world))
        add_vertex(s->view, world, s->extent);
}

static void search_blocks(void *context, const vertex_block *blocks, uint32_t count)
{
    for (uint32_t k = 0; k < count; k++)
        for (int i = 0; i < VERTEX_LANES; i++)
            search_vertex(context,
                          (const float[3]){blocks[k].xyz[0][i], blocks[k].xyz[1][i], blocks[k].xyz[2][i]});
}

/* How far a transformed vertex in float may deviate: four roundings of the products and their sum. */
static double rounding(const mat4 *world, const float low[3], const float high[3])
{
    double largest = 0.0;
    for (int row = 0; row < 3; row++) {
        double size = fabs((double)world->m[12 + row]);
        for (int k = 0; k < 3; k++)
            size += fabs((double)world->m[4 * k + row]) * fmax(fabs((double)low[k]), fabs((double)high[k]));
        largest = fmax(largest, size);
    }
    return 4.0 * 0x1p-24 * largest;
}

/* An upper bound of how much the vertices in a box can widen e: all bounds are convex, and so largest at a
 * corner. The margin covers the rounding of vertices and corners: bounds change at most sqrt(2) (1 + 1 /
 * tan) times as fast as a point moves, which deviates by up to sqrt(3). In scenes of many instances most
 * are inside. */
static double excess(const search *s, const float low[3], const float high[3], const extent *e)
{
    extent corners = {-HUGE_VAL, -HUGE_VAL};
    for (unsigned corner = 0; corner < 8; corner++) {
        float local[3];
        float world[3];
        for (unsigned axis = 0; axis < 3; axis++)
            local[axis] = corner >> axis & 1 ? high[axis] : low[axis];
        mat4_transform_point(&s->instance->world, local, world);
        add_vertex(s->view, world, &corners);
    }
    double margin = 2.0 * 2.5 * rounding(&s->instance->world, low, high);
    double narrow = fmin(s->view->tan_x, s->view->tan_y);
    double wider = corners.extent + margin * (1.0 + 1.0 / narrow) - e->extent;
    double nearer = corners.nearest + margin - e->nearest;
    return s->view->is_orthographic && nearer > wider
               ? nearer
               : wider; /* nearest is needed for orthographic cameras only */
}

static double gain(void *context, const box *local)
{
    const search *s = context;
    return excess(s, local->minimum, local->maximum, s->extent);
}

enum { GRAIN = 1 << 14 };

typedef struct fit_job {
    search search;
    extent *extents; /* one per work item */
} fit_job;

static void fit_body(void *context, size_t begin, size_t end)
{
    const fit_job *job = context;
    const scene_instance *instance = job->search.instance;
    const scene_primitive *primitive = instance->primitive;
    extent e = {-HUGE_VAL, -HUGE_VAL};
    search s = job->search;
    s.extent = &e;
    for (size_t i = begin; i < end; i++) {
        if (primitive->has_flat_triangles &&
            unseen_is_flat(instance->positions, primitive->indices + i / 3 * 3))
            continue;
        search_vertex(&s, instance->positions + 3 * (size_t)primitive->indices[i]);
    }
    job->extents[begin / GRAIN] = e;
}

static void measure_instance(const search *s, vertex_trees *trees, extent *extents, uint32_t thread_count)
{
    const vertex_tree *tree = vertex_trees_get(trees, s->instance);
    if (tree) {
        search found = *s;
        vertex_tree_visit(tree, &(vertex_visitor){&found, gain, search_blocks});
        return;
    }
    size_t count = s->instance->primitive->index_count;
    fit_job job = {.search = *s, .extents = extents};
    parallel_for(thread_count, count, GRAIN, fit_body, &job);
    for (size_t k = 0; k < (count + GRAIN - 1) / GRAIN; k++)
        extent_add(s->extent, extents[k].extent, extents[k].nearest);
}

/* Widens *out by the visible vertices of the pose within kept (NULL: everywhere). False: no memory. */
static bool measure(const facet_scene *scene, const scene_pose *pose, const view *v, const box *kept,
                    uint32_t thread_count, extent *out)
{
    size_t most = 0;
    for (uint32_t i = 0; i < pose->instance_count; i++)
        if (pose->instances[i].primitive->index_count > most)
            most = pose->instances[i].primitive->index_count;
    extent *extents = mem_alloc(NULL, most / GRAIN + 1, sizeof *extents);
    if (!extents)
        return false;
    vertex_trees trees = {.scene = scene};
    for (uint32_t i = 0; i < pose->instance_count; i++) {
        const scene_instance *instance = &pose->instances[i];
        const search s = {.view = v, .instance = instance, .kept = kept, .extent = out};
        if (bounds_count(pose, instance) && excess(&s, instance->bounds_min, instance->bounds_max, out) > 0.0)
            measure_instance(&s, &trees, extents, thread_count);
    }
    vertex_trees_destroy(&trees);
    mem_free(extents);
    return true;
}

static bool is_in(float value, float minimum, float maximum)
{
    return value >= minimum && value <= maximum; /* false for NaN */
}

static facet_result check(const facet_orbit *orbit, float aspect, facet_error *error)
{
    const float most = 1e18f;
    if (!is_in(aspect, 1e-6f, 1e6f))
        return fail(error, FACET_ERROR_ARGUMENT, "orbit: an aspect ratio of %g is not in [1e-6, 1e6]",
                    (double)aspect);
    if (!is_in(orbit->azimuth_rad, -most, most) || !is_in(orbit->polar_rad, -most, most))
        return fail(error, FACET_ERROR_ARGUMENT, "orbit: azimuth and polar angle must be finite");
    if (!is_in(orbit->radius, 0.0f, most))
        return fail(error, FACET_ERROR_ARGUMENT, "orbit: radius %g is not in [0, 1e18] m",
                    (double)orbit->radius);
    if (orbit->radius == 0.0f && !is_in(orbit->radius_scale, 1e-6f, 1e6f))
        return fail(error, FACET_ERROR_ARGUMENT, "orbit: radius scale %g is not in [1e-6, 1e6]",
                    (double)orbit->radius_scale);
    if (!is_in(orbit->fov_y_rad, 1e-4f, 3.1f) && !orbit->is_orthographic)
        return fail(error, FACET_ERROR_ARGUMENT, "orbit: field of view %g is not in [0.0001, 3.1] rad",
                    (double)orbit->fov_y_rad);
    for (int i = 0; i < 3; i++)
        if (orbit->has_target && !is_in(orbit->target[i], -most, most))
            return fail(error, FACET_ERROR_ARGUMENT, "orbit: the target must be finite");
    return FACET_OK;
}

/* ---- the camera ---- */

/* The subject of a frame, at one time or at several. */
typedef struct subject {
    box bounds;
    bool has_bounds;
    extent extent;
    stray_parts stray; /* count 0: none at any time */
} subject;

static subject empty_subject(void)
{
    return (subject){.bounds = box_empty(), .extent = {-HUGE_VAL, -HUGE_VAL}};
}

/* Adds the bounds of a pose to s, of its kept part if it has stray ones; *kept: that part, or NULL. */
static void add_bounds(subject *s, const scene_pose *pose, const facet_orbit *orbit, stray_parts *stray,
                       const box **kept)
{
    *kept = NULL;
    if (!pose->has_bounds)
        return;
    s->has_bounds = true;
    if (!orbit->includes_far_parts && stray_find(pose, stray)) {
        *kept = &stray->kept;
        box_join(&s->bounds, &stray->kept);
        if (stray->count > s->stray.count)
            s->stray = *stray;
        return;
    }
    box_add(&s->bounds, pose->bounds_min);
    box_add(&s->bounds, pose->bounds_max);
}

static void warn_of_stray(const facet_scene *scene, const facet_orbit *orbit, const stray_parts *stray)
{
    if (!stray->count)
        return;
    log_warning(&orbit->log,
                "%s: the frame leaves out %.2g %% of the model, which lies %.3g m from the rest, that is "
                "%.3g m wide; "
                "--framing all includes it, --orbit and --target look elsewhere",
                scene->source, 100.0 * (double)stray->count / (double)stray->whole, stray->distance_m,
                stray->diagonal_m);
}

static view make_view(const facet_orbit *orbit, float aspect, const subject *s)
{
    view v = {.fits_all_azimuths = orbit->fits_all_azimuths};
    aim(&v, orbit, aspect);
    for (int i = 0; i < 3; i++) {
        double middle =
            s->has_bounds ? 0.5 * ((double)s->bounds.minimum[i] + (double)s->bounds.maximum[i]) : 0.0;
        v.target[i] = orbit->has_target ? (double)orbit->target[i] : middle;
    }
    return v;
}

static facet_result stand(const view *v, const subject *s, const facet_orbit *orbit, float aspect,
                          facet_camera *camera, facet_error *error)
{
    /* An empty subject is framed like a sphere of radius 1 m, and so is a single point (extent 0). */
    extent e = s->extent;
    double narrow = fmin(1.0, (double)aspect);
    double smallest = v->is_orthographic ? 1.0 / narrow : 1.0 / sin(atan(v->tan_y * narrow));
    double diagonal = 0.0;
    for (int i = 0; i < 3 && s->has_bounds; i++)
        diagonal = fmax(diagonal, (double)s->bounds.maximum[i] - (double)s->bounds.minimum[i]);
    if (!(e.extent > 1e-7 * diagonal))
        e = (extent){smallest, 1.0};

    double distance = e.extent * (double)orbit->radius_scale;
    if (v->is_orthographic) {
        double half =
            orbit->radius > 0.0f ? (double)orbit->radius * tan(0.5 * (double)orbit->fov_y_rad) : distance;
        if (!(half > 0.0))
            return fail(error, FACET_ERROR_ARGUMENT,
                        "orbit: an orthographic camera with a radius needs a field of view");
        camera->ortho_height = (float)(2.0 * half);
        distance = orbit->radius > 0.0f ? (double)orbit->radius : 2.0 * half;
        /* In front of everything, as the distance is arbitrary for parallel rays. */
        distance = fmax(distance, e.nearest + fmax(diagonal, half));
    } else {
        camera->fov_y_rad = orbit->fov_y_rad;
        if (orbit->radius > 0.0f)
            distance = (double)orbit->radius;
    }
    for (int i = 0; i < 3; i++) {
        camera->target[i] = (float)v->target[i];
        camera->eye[i] = (float)(v->target[i] + distance * v->back[i]);
        camera->up[i] = (float)v->up[i];
    }
    camera->aspect = aspect;
    return FACET_OK;
}

/* A perspective camera at a given distance needs no measurement. Parallel rays begin in front of
 * everything. */
static bool is_measured(const facet_orbit *orbit)
{
    return orbit->is_orthographic || !(orbit->radius > 0.0f);
}

facet_result scene_fit_pose(const facet_scene *scene, const scene_pose *pose, const facet_orbit *orbit,
                            float aspect, uint32_t thread_count, facet_camera *camera, facet_error *error)
{
    *camera = (facet_camera){0};
    TRY(check(orbit, aspect, error));
    subject s = empty_subject();
    stray_parts stray;
    const box *kept = NULL;
    if (is_measured(orbit) || !orbit->has_target)
        add_bounds(&s, pose, orbit, &stray, &kept);
    view v = make_view(orbit, aspect, &s);
    if (s.has_bounds && is_measured(orbit) && !measure(scene, pose, &v, kept, thread_count, &s.extent))
        return fail_memory(error, "camera", sizeof s.extent);
    warn_of_stray(scene, orbit, &s.stray);
    return stand(&v, &s, orbit, aspect, camera, error);
}

/* ---- all times ---- */

/* Bounds of the scene at all times, and with a view the extent that frames them. */
static facet_result measure_times(const facet_scene *scene, const facet_pose_desc *desc,
                                  const keyframe_times *list, const facet_orbit *orbit, const view *v,
                                  subject *s, facet_error *error)
{
    facet_pose_desc at = *desc;
    for (uint32_t i = 0; i < list->count; i++) {
        scene_pose pose;
        stray_parts stray;
        const box *kept;
        at.time_s = list->times[i];
        TRY(scene_pose_create(scene, &at, &scene->allocator, scene->thread_count, &pose, error));
        add_bounds(s, &pose, orbit, &stray, &kept);
        bool has_extent =
            !v || !pose.has_bounds || measure(scene, &pose, v, kept, scene->thread_count, &s->extent);
        scene_pose_destroy(&pose);
        if (!has_extent)
            return fail_memory(error, "camera", sizeof s->extent);
    }
    return FACET_OK;
}

static facet_result fit_motion(const facet_scene *scene, const facet_pose_desc *desc,
                               const facet_orbit *orbit, float aspect, facet_camera *camera,
                               facet_error *error)
{
    TRY(check(orbit, aspect, error));
    for (uint32_t i = 0; i < desc->animation_count; i++)
        if (desc->animations[i] >= scene->animation_count)
            return fail(error, FACET_ERROR_ARGUMENT, "%s: has no animation %u", scene->source,
                        desc->animations[i]);
    keyframe_times list;
    keyframes_list_times(scene, desc, &list);
    subject s = empty_subject();
    if (!orbit->has_target)
        TRY(measure_times(scene, desc, &list, orbit, NULL, &s, error));
    view v = make_view(orbit, aspect, &s);
    if (is_measured(orbit))
        TRY(measure_times(scene, desc, &list, orbit, &v, &s, error));
    warn_of_stray(scene, orbit, &s.stray);
    return stand(&v, &s, orbit, aspect, camera, error);
}

facet_result scene_fit_orbit(const facet_scene *scene, const facet_pose_desc *desc, const facet_orbit *orbit,
                             float aspect, facet_camera *camera, facet_error *error)
{
    *camera = (facet_camera){0};
    if (orbit->fits_all_times && desc && desc->animation_count > 0)
        return fit_motion(scene, desc, orbit, aspect, camera, error);
    scene_pose pose;
    TRY(scene_pose_create(scene, desc, &scene->allocator, scene->thread_count, &pose, error));
    facet_result result = scene_fit_pose(scene, &pose, orbit, aspect, scene->thread_count, camera, error);
    scene_pose_destroy(&pose);
    return result;
}
