/* camera_matrix.h - a camera as a matrix, for images that are compared with another renderer's. */
#ifndef CLI_CAMERA_MATRIX_H
#define CLI_CAMERA_MATRIX_H

#include "cli/render/render_options.h"

/* Reads --camera-matrix (from the camera's space to the world, as the matrix of a glTF node) or --view-matrix (its inverse): 16
 * numbers, column by column. Writes eye, target and up of out, if one is given. Fails with FACET_ERROR_ARGUMENT, for what
 * is no rotation with a place, mirrored, or written row by row, too. */
facet_result camera_matrix_read(const command_line *c, render_options *out, facet_error *error);

#endif
