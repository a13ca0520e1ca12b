/* bake_make.h - encodes the files of facet bake from baked cube maps. */
#ifndef CLI_BAKE_MAKE_H
#define CLI_BAKE_MAKE_H

#include "cli/bake/bake_plan.h"

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

#endif
