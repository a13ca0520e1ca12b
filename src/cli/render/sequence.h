/* sequence.h - the pictures that are made of one model: their moments, and how far the camera has turned. */
#ifndef CLI_SEQUENCE_H
#define CLI_SEQUENCE_H

#include "cli/render/render_options.h"

/* {0}, then sequence_create(). */
typedef struct sequence {
    frame_list frames;
    facet_pose_desc pose; /* of the picture that sequence_frame() was last asked for */
    uint32_t *animations; /* block of malloc(), what pose refers to */
    bool moves;           /* pictures differ in time */
    double begin_s, duration_s;
    double frame_s;             /* from one frame to the next */
    uint32_t frame_count_there; /* frames that the animation has; 0: none that ends */
    uint32_t turns;             /* pictures once around the model; 0: the camera stands */
} sequence;

/* One picture. */
typedef struct sequence_frame {
    uint32_t number; /* in its name */
    double turn;     /* of the camera, [0, 1) */
} sequence_frame;

/* Resolves scene, variant and animations by name, and chooses the origin by what they show; name is the model's, for messages. Fails with FACET_ERROR_ARGUMENT for what the model lacks. */
facet_result sequence_create(facet_scene *scene, const char *name, const render_options *options,
                             sequence *out, facet_error *error);
void sequence_destroy(sequence *s); /* {0} is allowed */
/* Picture number index; sets s->pose. */
sequence_frame sequence_at(sequence *s, uint32_t index);
/* Frame number 1, whichever are drawn. */
sequence_frame sequence_first(sequence *s);

#endif
