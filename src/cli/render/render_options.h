/* render_options.h - what the options of facet render ask for, checked, before any model is read. */
#ifndef CLI_RENDER_OPTIONS_H
#define CLI_RENDER_OPTIONS_H

#include "cli/shared/command_line.h"
#include "cli/shared/environment_input.h"
#include "cli/render/frame_list.h"
#include "cli/shared/limits.h"
#include "cli/render/video.h"
#include "facet/facet.h"

typedef struct render_options {
    bool meters_exposure; /* --exposure auto: desc.exposure_ev is added to what is metered */
    char note[256];       /* how an option was read that might mean something else; "": nothing to say */
    /* picture */
    const char *output;   /* pattern; NULL: named after the model */
    const char *id_layer; /* IDs that are written in false color in place of the image; NULL: none */
    bool is_stdout;
    bool is_sequence;           /* several pictures of a model, as far as the options tell */
    video_format video;         /* all of them in one file */
    bool keeps_existing;        /* --no-clobber */
    const char *checkpoint;     /* pattern; NULL: none */
    facet_image_save_desc save; /* format is always named */
    facet_render_desc desc;     /* without allocator, log, progress, pose, camera, environment */

    /* camera */
    const char *camera; /* NULL: orbit or eye */
    facet_orbit orbit;  /* without target */
    bool has_target[3];
    double target[3]; /* target and eye are in the file's coordinates: facet_scene_get_origin() */
    bool has_eye;
    double eye[3];
    float up[3];        /* of a camera given as a matrix; {0}: by orbit.is_z_up */
    uint32_t turntable; /* frames; 0: none */
    float aperture;     /* diameter of the lens: m, or a share of the focus distance; 0: a pinhole */
    bool aperture_is_relative;
    float focus_m; /* 0: the point looked at */

    /* motion */
    const char *animation; /* NULL: see choose_animations() */
    bool has_time, has_frames, has_fps;
    double time_s, fps;
    frame_list frames;

    /* light */
    bool has_environment; /* false: nobody asked for one, and a model may bring its own */
    environment_input environment;
    const char *environment_cache;

    /* scene and limits */
    const char *scene;   /* NULL: the file's */
    const char *variant; /* NULL: none */
    limits limits;
} render_options;

/* Fails with FACET_ERROR_ARGUMENT. Text stays with c. */
facet_result render_options_read(const command_line *c, render_options *out, facet_error *error);

/* Whether the environment that a scene brings lights it: --env names no other, and lights of files are wanted. */
bool render_is_lit_by_scene(const render_options *o, const facet_scene *scene, const facet_pose_desc *pose);

/* The extension, without point, that files of a format have. */
const char *render_extension(facet_image_format format);

#endif
