/* bake_make.h - the bytes of the files of facet bake, made of cube maps that are baked. */
#ifndef CLI_BAKE_MAKE_H
#define CLI_BAKE_MAKE_H

#include "cli/bake/bake_plan.h"

typedef struct bake_making {
    const bake_options *options;
    const bake_plan *plan;
    facet_environment *environment; /* NULL for tables */
    facet_allocator allocator;
    facet_progress progress; /* of what takes long: tables, the sheet */
} bake_making;

/* Fills file's bytes. Fails as the functions of facet.h. */
facet_result bake_file_make(const bake_making *m, bake_file *file, facet_error *error);

/* The largest number that a file of light holds; 0: any, or not known. */
float bake_file_limit(const bake_file *file);

/* The share, [0, 1], of a level's light that is above limit, texels weighted by their solid angle. */
double bake_cut_share(const facet_cube *cube, uint32_t level, float limit);

#endif
