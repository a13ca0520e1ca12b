/* render_options.h - the checked options of facet render. */
#ifndef CLI_RENDER_OPTIONS_H
#define CLI_RENDER_OPTIONS_H

#include "cli/shared/command_line.h"
#include "cli/shared/environment_input.h"
#include "cli/shared/value.h"
#include "cli/shared/limits.h"
#include "cli/shared/shard.h"
#include "cli/render/video.h"
#include "facet/facet.h"

typedef struct render_options {
    bool meters_exposure; /* --exposure auto: desc.exposure_ev is relative to the meter */
    char note[256];       /* reading of an ambiguous option, for a message; "": none */
    /* image */
    const char *output;   /* pattern; NULL: named after the model */
    const char *id_layer; /* layer of IDs to write in false color; NULL: none */
    bool is_stdout;
    bool is_sequence;             /* several images of a model, by the options */
    video_format video;           /* all of them in one file */
    bool keeps_existing;          /* --no-clobber */
    const char *checkpoint;       /* pattern; NULL: none */
    facet_image_save_desc save;   /* with a format */
    facet_render_desc desc;       /* without allocator, log, progress, pose, camera, environment */
    facet_renderer_info renderer; /* of desc.renderer */

    /* camera */
    const char *camera; /* NULL: orbit or eye */
    facet_orbit orbit;  /* without target */
    bool has_target[3];
    double target[3]; /* target and eye are in the file's coordinates: facet_scene_get_origin() */
    bool has_eye;
    double eye[3];
    float up[3];        /* of a camera matrix; {0}: by orbit.is_z_up */
    uint32_t turntable; /* frames; 0: none */
    float aperture;     /* lens diameter: m, or a share of the focus distance; 0: pinhole */
    bool aperture_is_relative;
    float focus_m; /* 0: the target */

    /* motion */
    const char *animation; /* NULL: see choose_animations() */
    bool has_time, has_frames, has_fps;
    double time_s, fps;
    frame_list frames;

    /* light */
    bool has_environment; /* --env is given; else a model's own is used */
    environment_input environment;
    const char *environment_cache;

    /* several processes */
    bool has_shard; /* --shard: of frames, or desc.part */
    shard shard;
    char part_output[4096]; /* output with the number of the part */
    char part_command[FACET_PART_COMMAND_SIZE];

    /* scene and limits */
    const char *scene;   /* NULL: the file's */
    const char *variant; /* NULL: none */
    limits limits;
} render_options;

/* Fails with FACET_ERROR_ARGUMENT. Text stays with c. */
facet_result render_options_read(const command_line *c, render_options *out, facet_error *error);

/* Whether a scene is lit by its own environment: without --env, and with lights of the file. */
bool render_is_lit_by_scene(const render_options *o, const facet_scene *scene, const facet_pose_desc *pose);

/* The extension of a format, without the dot. */
const char *render_extension(facet_image_format format);

/* ---- parts, in files of their own ---- */

/* --renderer. Refuses the first of the options (up to OPTION_ID_COUNT) that is given and needs a feature
 * that the renderer lacks: FACET_ERROR_ARGUMENT, "--NAME: it needs --renderer path or gl". */
facet_result image_options_renderer(const command_line *c, render_options *out, facet_error *error);
facet_result image_options_need(const command_line *c, const option_id *options, facet_renderer_feature need,
                                const render_options *o, facet_error *error);
/* --aov, after format and renderer. FACET_ERROR_ARGUMENT: the renderer lacks a layer, or the file has no room
 * for one. */
facet_result image_options_aov(const command_line *c, render_options *out, facet_error *error);
/* --shading and what belongs to ogl1. */
facet_result image_options_shading(const command_line *c, render_options *out, facet_error *error);

facet_result image_options_output(const command_line *c, render_options *out, facet_error *error);
facet_result image_options_format(const command_line *c, render_options *out, facet_error *error);
/* --size (default: otherwise), --crop. */
facet_result image_options_size(const command_line *c, const char *otherwise, render_options *out,
                                facet_error *error);
/* --exposure, as stops. */
facet_result image_options_exposure(const command_line *c, render_options *out, facet_error *error);
/* --tone-mapping (default: otherwise, none for linear files), --quality, --jpeg-quality, --png-compression. */
void image_options_quality(const command_line *c, facet_tonemap otherwise, render_options *out);
/* --time, --frames, --fps. */
facet_result image_options_frames(const command_line *c, render_options *out, facet_error *error);
/* --env and the options of the environment. */
facet_result image_options_environment(const command_line *c, render_options *out, facet_error *error);

/* --shard, --shard-by, before the output is read: has_shard, desc.part. part_options_name(): after it, the name of a
 * part and its command. part_options_check(): after all others; refuses what cannot be divided. */
facet_result part_options_read(const command_line *c, render_options *out, facet_error *error);
facet_result part_options_name(const command_line *c, render_options *out, facet_error *error);
facet_result part_options_check(const render_options *o, facet_error *error);
/* Whether this process renders image number index, from 0, of a sequence; how many of frame_count it renders. */
bool part_options_has_frame(const render_options *o, uint32_t index);
uint32_t part_options_frame_count(const render_options *o, uint32_t frame_count);

/* Checks that all images have a name; needs is_sequence. */
facet_result image_options_check_sequence(const command_line *c, const render_options *o, facet_error *error);

/* The camera, without its lens. */
facet_result camera_options_read(const command_line *c, render_options *out, facet_error *error);
/* "AZIMUTH,POLAR,RADIUS", separated by commas or blanks; later parts may be left out, and a part may be
 * "auto", which keeps that of orbit. Angles are in deg (the default) or rad, the radius in % of the
 * framing distance, m (the default), cm or mm. False, with orbit untouched, where text is none of these,
 * polar is not in [0 deg, 180 deg] or the radius is not above 0. */
bool orbit_parse(const char *text, facet_orbit *orbit);
/* "X,Y,Z" in m (the default), cm, mm; "auto" for all or for one keeps target[i] and clears is_given[i]. */
bool target_parse(const char *text, double target[3], bool is_given[3]);

/* Reads --renderer and the options that depend on it, after all others. Fails with FACET_ERROR_ARGUMENT,
 * also for an option without effect on the renderer. */
facet_result path_options_read(const command_line *c, render_options *out, facet_error *error);

/* Sets the lens of the camera. */
void path_options_set_lens(const render_options *o, const facet_scene *scene, const facet_pose_desc *pose,
                           facet_camera *camera);

#endif
