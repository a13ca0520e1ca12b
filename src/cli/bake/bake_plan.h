/* bake_plan.h - which cube maps facet bake makes and which files become of them, known before anything is read. */
#ifndef CLI_BAKE_PLAN_H
#define CLI_BAKE_PLAN_H

#include "cli/bake/bake_options.h"

enum { BAKE_MAX_CUBES = 5 };

/* One cube map that is baked; several files may come of it. */
typedef struct bake_cube {
    facet_bake_desc desc;
    bool is_verified;
    facet_cube *cube;     /* NULL until it is baked */
    facet_cube *mirrored; /* for files that are; NULL: there are none */
    bool is_cut;          /* a warning told of light that a file cannot hold */
    facet_cube_error errors[FACET_CUBE_MAX_LEVELS];
    double seconds;
} bake_cube;

typedef enum bake_content {
    BAKE_CUBE,  /* all levels of a cube map */
    BAKE_LEVEL, /* one level as a picture */
    BAKE_FACE,  /* one face of a level as a picture */
    BAKE_SH,
    BAKE_TABLE,
    BAKE_SHEET
} bake_content;

typedef struct bake_file {
    char *path;
    bake_content content;
    bake_container container;
    uint32_t cube; /* index among the plan's; of BAKE_SHEET, too */
    uint32_t level, face;
    facet_layout projection;
    bool is_mirrored; /* of the mirrored cube map */
    facet_texel_format texels;
    facet_dfg_kind table;
    int table_channel; /* the one that has the table's first, the others being 0; -1: as they are */
    bool is_kept;      /* by --no-clobber */
    /* once it is made */
    unsigned char *bytes;
    size_t size;
    bool is_text; /* bytes are malloc()'s */
} bake_file;

typedef struct bake_plan {
    bake_cube cubes[BAKE_MAX_CUBES];
    uint32_t cube_count;
    bake_file *files;
    size_t file_count, file_capacity;
    char *folders[4]; /* to be made, in this order, where they are not there */
    size_t folder_count;
    bool has_sh, has_own_name; /* the output's name was not given */
    float sh[3][9][3];         /* by facet_sh_form */
} bake_plan;

/* What o asks for. FACET_ERROR_ARGUMENT, _MEMORY. */
facet_result bake_plan_make(const bake_options *o, bake_plan *out, facet_error *error);
void bake_plan_destroy(bake_plan *plan); /* {0} is allowed */

/* Whether all of it can be written: folders are there or can be made, no file twice, none that is read. Finds out which are
 * kept, and drops cube maps that then nobody needs. FACET_ERROR_ARGUMENT, _WRITE. */
facet_result bake_plan_check(const command_line *c, const bake_options *o, bake_plan *plan,
                             facet_error *error);

/* The file that stands for the run in messages. */
const char *bake_plan_subject(const bake_plan *plan);

/* ---- parts of bake_plan_make() ---- */

/* A cube map for a lobe, as desc says; the same one twice is one. */
uint32_t bake_plan_add_cube(bake_plan *plan, const facet_bake_desc *desc, bool is_verified);
/* A file, with path copied; NULL: no memory. */
bake_file *bake_plan_add_file(bake_plan *plan, const char *path, const bake_file *what);

/* Adds the files of o->layout to plan. stem: what the environment is called. FACET_ERROR_ARGUMENT, _MEMORY. */
facet_result bake_layout_add(const bake_options *o, const char *stem, bake_plan *plan, facet_error *error);

/* Turns plan's cube maps and harmonics for an engine that has the middle of an equirectangular picture elsewhere. */
float bake_layout_turn(const bake_options *o, const facet_environment_info *info);

#endif
