/* view_framing.c - see view_framing.h. */
#include "view/view_framing.h"

#include <math.h>

#include "base/result.h"
#include "scene/scene.h"

/* Calls use with every vertex of the pose in world space. */
static void for_each_vertex(const scene_pose *pose, void (*use)(void *context, const double vertex[3]),
                            void *context)
{
    for (uint32_t i = 0; i < pose->instance_count; i++) {
        const scene_instance *instance = &pose->instances[i];
        const scene_primitive *primitive = instance->primitive;
        for (uint32_t k = 0; k < primitive->vertex_count; k++) {
            float world[3];
            mat4_transform_point(&instance->world, instance->positions + 3 * (size_t)k, world);
            if (isfinite(world[0]) && isfinite(world[1]) && isfinite(world[2]))
                use(context, (const double[3]){(double)world[0], (double)world[1], (double)world[2]});
        }
    }
}

static void add_to_bounds(void *context, const double v[3])
{
    view_framing *f = context;
    for (int i = 0; i < 3; i++) {
        f->low[i] = fmin(f->low[i], v[i]);
        f->high[i] = fmax(f->high[i], v[i]);
    }
}

static void add_to_radius(void *context, const double v[3])
{
    view_framing *f = context;
    double length2 = 0.0;
    for (int i = 0; i < 3; i++)
        length2 += (v[i] - f->target[i]) * (v[i] - f->target[i]);
    f->radius = fmax(f->radius, sqrt(length2));
}

typedef struct width_search {
    const view_framing *framing;
    double distance;
    double tangent; /* the largest, of the angle from the axis to a vertex, wherever it turns around +Y */
} width_search;

static void add_to_width(void *context, const double v[3])
{
    width_search *s = context;
    const double *target = s->framing->target;
    double sideways = hypot(v[0] - target[0], v[2] - target[2]);
    s->tangent = fmax(s->tangent, sideways / (s->distance - fabs(v[1] - target[1])));
}

double view_framing_distance(const view_framing *f, double fov_y_rad)
{
    return f->radius / sin(0.5 * fov_y_rad);
}

double view_framing_fov(const view_framing *f, double fov_y_rad, double aspect)
{
    return 2.0 * atan(tan(0.5 * fov_y_rad) * fmax(1.0, f->aspect / aspect));
}

facet_result view_framing_measure(const facet_scene *scene, const facet_pose_desc *desc, const double *target,
                                  double fov_y_rad, view_framing *framing, facet_error *error)
{
    scene_pose pose;
    view_framing f = {.low = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, .high = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
    TRY(scene_pose_create(scene, desc, &scene->allocator, scene->thread_count, &pose, error));
    for_each_vertex(&pose, add_to_bounds, &f);
    for (int i = 0; i < 3; i++) {
        if (f.low[i] > f.high[i])
            f.low[i] = f.high[i] = 0.0;
        f.target[i] = target ? target[i] : 0.5 * (f.low[i] + f.high[i]);
    }
    for_each_vertex(&pose, add_to_radius, &f);
    f.radius = f.radius > 0.0 ? f.radius : 1.0;
    width_search search = {.framing = &f, .distance = view_framing_distance(&f, fov_y_rad)};
    for_each_vertex(&pose, add_to_width, &search);
    f.aspect = search.tangent / tan(0.5 * fov_y_rad);
    scene_pose_destroy(&pose);
    *framing = f;
    return FACET_OK;
}
