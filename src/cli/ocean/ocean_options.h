/* ocean_options.h - the checked options of facet ocean. */
#ifndef CLI_OCEAN_OPTIONS_H
#define CLI_OCEAN_OPTIONS_H

#include "cli/render/render_options.h"

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

/* Parses "1500", "1.5km", "inf" to m. False: not a length. */
bool value_length(const char *text, double *metres);

#endif
