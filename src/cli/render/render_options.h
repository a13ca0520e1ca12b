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

/* ---- parts, in files of their own ---- */

facet_result picture_options_output(const command_line *c, render_options *out, facet_error *error);
facet_result picture_options_format(const command_line *c, render_options *out, facet_error *error);
/* --size (otherwise: where it is not given), --crop. */
facet_result picture_options_size(const command_line *c, const char *otherwise, render_options *out,
                                  facet_error *error);
/* --exposure, as stops. */
facet_result picture_options_exposure(const command_line *c, render_options *out, facet_error *error);
/* --tone-mapping (otherwise: where nothing is given and the file is for a display), --quality, --jpeg-quality, --png-compression. */
void picture_options_look(const command_line *c, facet_tonemap otherwise, render_options *out);
/* --time, --frames, --fps. */
facet_result picture_options_frames(const command_line *c, render_options *out, facet_error *error);
/* --env and what belongs to it. */
facet_result picture_options_environment(const command_line *c, render_options *out, facet_error *error);

/* Whether all pictures have a place to go, is_sequence being known. */
facet_result picture_options_check_sequence(const command_line *c, const render_options *o,
                                            facet_error *error);

/* The camera, without its lens. */
facet_result camera_options_read(const command_line *c, render_options *out, facet_error *error);
/* "AZIMUTH,POLAR,RADIUS", separated by commas or blanks; later parts may be left out, and a part may be "auto", which
 * keeps that of orbit. Angles are in deg (the default) or rad, the radius in % of the framing distance, m (the default),
 * cm or mm. False, with orbit untouched, where text is none of these, polar is not in [0 deg, 180 deg] or the radius is
 * not above 0. */
bool orbit_parse(const char *text, facet_orbit *orbit);
/* "X,Y,Z" in m (the default), cm, mm; "auto" for all or for one keeps target[i] and clears is_given[i]. */
bool target_parse(const char *text, double target[3], bool is_given[3]);

/* Reads --renderer and what depends on it, after all that is not about it. Fails with FACET_ERROR_ARGUMENT, also where an
 * option says nothing to the renderer. */
facet_result path_options_read(const command_line *c, render_options *out, facet_error *error);

/* Gives the camera its lens. */
void path_options_set_lens(const render_options *o, const facet_scene *scene, const facet_pose_desc *pose,
                           facet_camera *camera);

#endif
