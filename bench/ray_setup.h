/* ray_setup.h - what the benchmarks of rays trace: a wavy sphere or a model, and a camera beside it. */
#ifndef BENCH_RAY_SETUP_H
#define BENCH_RAY_SETUP_H

#include "draw/camera_rays.h"
#include "draw/render_geometry.h"

typedef struct ray_setup {
    render_geometry_set set;
    camera_rays camera; /* size x size pixels */
    uint32_t size;      /* set by the caller */
    /* what set refers to */
    scene_primitive sphere;
    render_geometry geometry;
    scene_material material;
    facet_scene *scene;
    scene_pose pose;
} ray_setup;

/* A unit sphere whose radius varies by the amplitude: 2 * columns * rows triangles. */
facet_result ray_setup_sphere(ray_setup *s, uint32_t columns, uint32_t rows, double amplitude,
                              facet_error *error);
/* A glTF model at rest. */
facet_result ray_setup_load(ray_setup *s, const char *path, facet_error *error);

#endif
