/* sequence.h - the images of one model: their times, turntable angles and cameras. */
#ifndef CLI_SEQUENCE_H
#define CLI_SEQUENCE_H

#include "cli/render/render_options.h"

/* {0}, then sequence_create(). */
typedef struct sequence {
    frame_list frames;
    facet_pose_desc pose; /* of the last sequence_at() */
    uint32_t *animations; /* malloc() block that pose refers to */
    bool moves;           /* the images differ in time */
    double begin_s, duration_s;
    double frame_s;             /* from one frame to the next */
    uint32_t frame_count_there; /* frames of the animation; 0: without an end */
    uint32_t turns;             /* images of the turntable; 0: none */
} sequence;

/* An image. */
typedef struct sequence_frame {
    uint32_t number; /* in its name */
    double turn;     /* of the camera, [0, 1) */
} sequence_frame;

/* Resolves scene, variant and animations by name, and chooses the origin for them; name is the model's,
 * for messages. Fails with FACET_ERROR_ARGUMENT for names that the model lacks. */
facet_result sequence_create(facet_scene *scene, const char *name, const render_options *options,
                             sequence *out, facet_error *error);
void sequence_destroy(sequence *s); /* {0} is allowed */
/* Image index; sets s->pose. */
sequence_frame sequence_at(sequence *s, uint32_t index);
/* Frame 1, whether it is rendered or not. */
sequence_frame sequence_first(sequence *s);

/* ---- cameras ---- */

/* The camera of an image at a pose, rotated around the model by turn, a fraction of a full turn. moves:
 * the same camera frames the whole motion. */
typedef struct render_view {
    const facet_pose_desc *pose;
    double turn;
    bool turns, moves;
} render_view;
facet_result render_camera(const facet_scene *scene, const render_view *view, const render_options *options,
                           facet_camera *camera, facet_error *error);

/* The orbit of the options, with its target if any coordinate is given. */
facet_orbit render_orbit(const facet_scene *scene, const facet_pose_desc *pose,
                         const render_options *options);
/* Keeps target and distance of the first camera for the following images. */
void render_keep_framing(render_options *options, const facet_scene *scene, const facet_camera *camera);

#endif
