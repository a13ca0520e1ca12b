/* ocean_run.h - what a run of facet ocean holds, and how its pictures are made. */
#ifndef CLI_OCEAN_RUN_H
#define CLI_OCEAN_RUN_H

#include "cli/ocean/ocean_options.h"
#include "cli/shared/output_name.h"
#include "cli/render/render_output.h"
#include "cli/shared/verb_run.h"
#include "cli/render/video.h"

/* Where a model floats. */
typedef struct ocean_berth {
    bool has_place;    /* else: in view */
    double numbers[3]; /* x, z in m; heading in degrees, from +Z towards +X */
} ocean_berth;

typedef struct ocean_run {
    verb_run base;
    ocean_options options;
    facet_environment *environment; /* NULL: the sky */
    facet_sea *sea;
    facet_scene *model;                /* NULL: none */
    facet_renderer *renderer;          /* of model; NULL: not made yet */
    float model_low[3], model_high[3]; /* where it is before it floats */
    ocean_berth berth;
    bool is_afloat;       /* it has been placed before */
    float model_pose[16]; /* where it floats: columns of a matrix */
    double time_s;
    double ev100;                /* that pictures are exposed for, --exposure included */
    video *video;                /* NULL: files */
    json_t *outputs;             /* NULL without --json */
    char name[RENDER_NAME_SIZE]; /* what is being made; "": nothing yet */
} ocean_run;

/* How far a picture is, of all. */
typedef struct ocean_step {
    const char *output;
    uint32_t index, count;
} ocean_step;

/* Makes the sea of options, in place of the one before. */
facet_result ocean_run_set_sea(ocean_run *run, const ocean_options *options, facet_error *error);

/* That of the options, over the sea as it is. */
facet_camera ocean_run_camera(const ocean_run *run, const ocean_options *options);

/* Exposes for the sea as it is: as it was made, so that every moment of it has one exposure and frames do not flicker. */
facet_result ocean_run_meter(ocean_run *run, const ocean_options *options, facet_error *error);

/* One picture of the sea as it is, developed: with --before-after a sheet of two. */
facet_result ocean_run_draw(ocean_run *run, const ocean_options *options, ocean_step step,
                            facet_image **image, facet_error *error);

/* --sweep: sheets of pictures over one or two options. Leaves another sea. */
facet_result ocean_sweep(ocean_run *run, const char *output, facet_image **image, facet_error *error);

/* Reads --with, and floats it on the sea as it is. Without a place it lies in view of the camera of the first moment. */
facet_result ocean_float_load(ocean_run *run, facet_error *error);
facet_result ocean_float_place(ocean_run *run, facet_error *error);

/* ---- what is known of a sea ---- */

/* Lines on standard output. */
void ocean_report_print(const ocean_run *run);
/* The same; NULL: no memory. */
json_t *ocean_report_json(const ocean_run *run);

/* report_picture_json() with what another program needs to draw the same: exposure, time, camera, where the model floats. */
json_t *ocean_report_picture_json(const ocean_run *run, const picture_report *p);

#endif
