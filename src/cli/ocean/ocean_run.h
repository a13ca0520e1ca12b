/* ocean_run.h - the state of facet ocean, and its parts. */
#ifndef CLI_OCEAN_RUN_H
#define CLI_OCEAN_RUN_H

#include "cli/render/render_options.h"
#include "cli/render/render_output.h"
#include "cli/render/video.h"
#include "cli/shared/output.h"
#include "cli/shared/verb_run.h"

/* ---- options ---- */

typedef struct ocean_options {
    /* output, format, size, environment, frames, limits; desc.exposure_ev is relative to the meter */
    render_options render;
    facet_sea_desc sea;
    facet_sky_desc sky;
    facet_sea_shading shading;
    bool has_ev100;
    double ev100;

    /* camera */
    float eye_height_m; /* 0: facet_sea_camera()'s */
    float heading_rad;  /* from +Z towards +X */
    bool has_target;
    float target[3]; /* eye and has_eye are in render */
    float fov_y_rad; /* 0: facet_sea_camera()'s */

    /* what is made */
    bool has_image, has_mesh, has_info;
    bool is_before_after;
    const char *maps;          /* folder or pattern; NULL: none */
    const char *const *models; /* of --with, including @ and what follows */
    uint32_t model_count;
    const char *sweep; /* NULL: none */
    facet_sea_mesh_desc mesh;
} ocean_options;

/* Fails with FACET_ERROR_ARGUMENT, and as facet_sea_create() where the water's coefficients are needed.
 * Text stays with c. */
facet_result ocean_options_read(const command_line *c, ocean_options *out, facet_error *error);

/* What --before-after shows side by side: the legacy style, and now. */
typedef struct ocean_half {
    facet_sea_shading shading;
    facet_tonemap tonemap;
} ocean_half;
void ocean_options_halves(const command_line *c, const ocean_options *o, ocean_half *before, ocean_half *now);

/* Parses "1500", "1.5km", "inf" to m. False: not a length. */
bool value_length(const char *text, double *metres);

/* ---- the run ---- */

/* A floating model: a part of ocean_run.model. */
typedef struct ocean_model {
    char path[4096];
    bool is_placed;        /* by the user, or else once it was put in view */
    double berth[3];       /* x, z in m; heading in degrees, from +Z towards +X */
    float low[3], high[3]; /* bounds in the file */
    float pose[16];        /* columns of a matrix */
} ocean_model;

typedef struct ocean_run {
    verb_run base;
    ocean_options options;
    facet_environment *environment; /* NULL: the sky */
    facet_sea *sea;
    facet_scene *model;       /* all of them in one scene; NULL: none */
    ocean_model *models;      /* options.model_count */
    facet_renderer *renderer; /* of model; NULL: not made yet */
    bool is_afloat;           /* placed before */
    bool has_camera;          /* of a model */
    uint32_t camera;
    double time_s;
    double ev100;                /* exposure of the images, with --exposure */
    video *video;                /* NULL: files */
    json_t *outputs;             /* NULL without --json */
    char name[RENDER_NAME_SIZE]; /* the current output; "": none yet */
} ocean_run;

/* The position of an image among all, for progress. */
typedef struct ocean_step {
    const char *output;
    uint32_t index, count;
} ocean_step;

/* Creates the sea of options and replaces the previous one. */
facet_result ocean_run_set_sea(ocean_run *run, const ocean_options *options, facet_error *error);

/* The camera of the options, above the sea at its current time. */
facet_camera ocean_run_camera(const ocean_run *run, const ocean_options *options);

/* Meters the sea as created, before its time is set: one exposure for all frames, which do not flicker. */
facet_result ocean_run_meter(ocean_run *run, const ocean_options *options, facet_error *error);

/* Renders an image of the sea at its current time; with --before-after a sheet of two. */
facet_result ocean_run_draw(ocean_run *run, const ocean_options *options, ocean_step step,
                            facet_image **image, facet_error *error);

/* Renders the sheet of --sweep over one or two options. Leaves another sea in run. */
facet_result ocean_sweep(ocean_run *run, const char *output, facet_image **image, facet_error *error);

/* Load the models of --with, if any, and place them on the sea at its current time. Those without a position
 * lie side by side in view of the first frame's camera. */
facet_result ocean_float_load(ocean_run *run, facet_error *error);
facet_result ocean_float_place(ocean_run *run, facet_error *error);

/* ---- what is known of a sea ---- */

/* Prints the properties of the sea as lines on standard output. */
void ocean_report_print(const ocean_run *run);
/* The same as JSON; NULL: no memory. */
json_t *ocean_report_json(const ocean_run *run);

/* report_image_json() with what another renderer needs for the same image: exposure, time, camera, pose
 * of the model. */
json_t *ocean_report_image_json(const ocean_run *run, const image_report *p);

#endif
