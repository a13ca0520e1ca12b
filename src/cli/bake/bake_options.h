/* bake_options.h - the checked options of facet bake. */
#ifndef CLI_BAKE_OPTIONS_H
#define CLI_BAKE_OPTIONS_H

#include "cli/shared/command_line.h"
#include "cli/shared/environment_input.h"
#include "cli/shared/limits.h"

typedef enum bake_layout {
    BAKE_LAYOUT_NONE,
    BAKE_LAYOUT_FILAMENT,
    BAKE_LAYOUT_KHRONOS,
    BAKE_LAYOUT_THREE
} bake_layout;

/* Type of a file; FROM_NAME: by its extension. */
typedef enum bake_container {
    CONTAINER_FROM_NAME,
    CONTAINER_KTX2,
    CONTAINER_KTX1, /* of --layout filament only */
    CONTAINER_EXR,
    CONTAINER_EXR_FLOAT,
    CONTAINER_HDR,
    CONTAINER_PFM,
    CONTAINER_PNG,
    CONTAINER_JPEG,
    CONTAINER_WEBP,
    CONTAINER_JSON,
    CONTAINER_HEADER,
    CONTAINER_TEXT
} bake_container;

typedef struct bake_options {
    /* environment; nothing with --dfg */
    environment_input environment;
    const char *word; /* the environment as given */
    const char *faces[6];
    bool has_faces; /* six INPUTs */
    facet_layout input_layout;

    /* outputs; NULL: none. Without any, one with a default name is written */
    const char *output, *diffuse, *sheen, *sh, *preview;
    bake_layout layout;
    bake_container container; /* of output */
    bool has_texels;
    facet_texel_format texels;
    uint32_t zstd_level;
    bool has_projection;
    facet_layout projection;
    int level;             /* -1: all */
    float rgbm_range;      /* 0: none */
    facet_tonemap tonemap; /* of the sheet, as its exposure */
    bool meters_sheet;
    double sheet_ev;
    bool keeps_existing;

    /* filtering */
    facet_bake_desc bake; /* of the main cube map: level_count is set */
    facet_sh_desc harmonics;
    bool has_sh_window;
    bool is_verified, has_max_error;
    double max_error;

    bool is_table;
    facet_dfg_kind table;
    uint32_t table_size; /* 0: the library's default */

    limits limits;
} bake_options;

/* Reads and checks the command line; strings stay with it. FACET_ERROR_ARGUMENT. */
facet_result bake_options_read(const command_line *c, bake_options *out, facet_error *error);

/* Name of the environment in messages; "dfg" for a table. */
const char *bake_input_name(const bake_options *o);

#endif
