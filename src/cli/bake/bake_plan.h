/* bake_plan.h - the plan of facet bake, cube maps and files, made before anything is read; and what is made
 * of it. */
#ifndef CLI_BAKE_PLAN_H
#define CLI_BAKE_PLAN_H

#include "cli/bake/bake_options.h"
#include "cli/shared/messages.h"

#include <jansson.h>
#include <stdio.h>

enum { BAKE_MAX_CUBES = 5 };

/* A cube map to bake, for one or more files. */
typedef struct bake_cube {
    facet_bake_desc desc;
    bool is_verified;
    facet_cube *cube;     /* NULL until it is baked */
    facet_cube *mirrored; /* for mirrored files; NULL: none */
    bool is_cut;          /* a warning of clamped light was given */
    facet_cube_error errors[FACET_CUBE_MAX_LEVELS];
    double seconds;
} bake_cube;

typedef enum bake_content {
    BAKE_CUBE,  /* all levels of a cube map */
    BAKE_LEVEL, /* one level as an image */
    BAKE_FACE,  /* one face of a level as an image */
    BAKE_SH,
    BAKE_TABLE,
    BAKE_SHEET
} bake_content;

typedef struct bake_file {
    char *path;
    bake_content content;
    bake_container container;
    uint32_t cube; /* index in the plan; also of BAKE_SHEET */
    uint32_t level, face;
    facet_layout projection;
    bool is_mirrored; /* of the mirrored cube map */
    facet_texel_format texels;
    facet_dfg_kind table;
    int table_channel; /* channel that holds the table's first one, the others 0; -1: unchanged */
    bool is_kept;      /* by --no-clobber */
    /* once encoded */
    unsigned char *bytes;
    size_t size;
    bool is_text; /* bytes are malloc()'s */
} bake_file;

typedef struct bake_plan {
    bake_cube cubes[BAKE_MAX_CUBES];
    uint32_t cube_count;
    bake_file *files;
    size_t file_count, file_capacity;
    char *folders[4]; /* folders to create if missing, in this order */
    size_t folder_count;
    bool has_sh, has_own_name; /* the output has a default name */
    float sh[3][9][3];         /* by facet_sh_form */
} bake_plan;

/* Makes the plan for o. FACET_ERROR_ARGUMENT, _MEMORY. */
facet_result bake_plan_make(const bake_options *o, bake_plan *out, facet_error *error);
void bake_plan_destroy(bake_plan *plan); /* {0} is allowed */

/* Checks that all files can be written: in existing or creatable folders, no file twice, no input. Marks
 * those that are kept and drops cube maps without a file. FACET_ERROR_ARGUMENT, _WRITE. */
facet_result bake_plan_check(const command_line *c, const bake_options *o, bake_plan *plan,
                             facet_error *error);

/* The output that represents the run in messages. */
const char *bake_plan_subject(const bake_plan *plan);

/* ---- parts of bake_plan_make() ---- */

/* Adds a cube map by desc, or finds an equal one. Returns its index. */
uint32_t bake_plan_add_cube(bake_plan *plan, const facet_bake_desc *desc, bool is_verified);
/* Adds a file, with a copy of path; NULL: no memory. */
bake_file *bake_plan_add_file(bake_plan *plan, const char *path, const bake_file *what);

/* Adds the files of o->layout to plan. stem is the environment's name. FACET_ERROR_ARGUMENT, _MEMORY. */
facet_result bake_layout_add(const bake_options *o, const char *stem, bake_plan *plan, facet_error *error);

/* The additional rotation, rad, for an engine that places the center of an equirectangular image elsewhere. */
float bake_layout_turn(const bake_options *o, const facet_environment_info *info);

/* ---- encoding files: bake_make.c ---- */

typedef struct bake_making {
    const bake_options *options;
    const bake_plan *plan;
    facet_environment *environment; /* NULL for tables */
    facet_allocator allocator;
    facet_progress progress; /* of slow steps: tables, the sheet */
} bake_making;

/* Encodes file. Fails as the functions of facet.h. */
facet_result bake_file_make(const bake_making *m, bake_file *file, facet_error *error);

/* The largest value of the file's format; 0: unlimited, or unknown. */
float bake_file_limit(const bake_file *file);

/* The share, [0, 1], of a level's light above limit, weighted by solid angle. */
double bake_cut_share(const facet_cube *cube, uint32_t level, float limit);

/* ---- reports: bake_report.c ---- */

extern const char *const bake_lobe_names[4];

/* Prints "studio.ktx2: cube map 256 x 256, 5 levels, rgba16f, 4 MiB" per file; is_news: also without -v. */
void bake_report_files(const messages *m, const bake_plan *plan, bool is_news, double seconds);

/* Prints the errors of --verify as a table. */
void bake_report_errors(FILE *stream, const bake_plan *plan);
/* Writes "level 3 of ggx: RMS error 0.02" for the worst level with an RMS error above limit, or NaN; "" if
 * there is none. */
void bake_report_worst(const bake_plan *plan, double limit, char *text, size_t size);

/* The verb's members of the JSON object; NULL: no memory. */
json_t *bake_report_json(const bake_options *o, const bake_plan *plan, const facet_environment_info *info,
                         bool is_done);

#endif
