/* file_set.h - writes the files of one model, all or nothing. */
#ifndef IO_FILE_SET_H
#define IO_FILE_SET_H

#include "scene/scene.h"

/* Files that are staged but not yet in place. {.main} starts it. */
typedef struct file_set {
    const facet_allocator *allocator;
    const char *main;          /* path of the file that refers to the others, which go into its folder */
    const facet_scene *inputs; /* scene whose files must not be replaced; NULL: any may be */
    facet_progress progress;   /* called before each file, and before file_set_commit() does anything */
    file_stage *stages;        /* block of mem_alloc() */
    size_t count, capacity;
} file_set;

/* Begins a set for the model path of a scene by desc; nothing is written yet. */
file_set file_set_begin(const facet_scene *scene, const char *path, const facet_scene_save_desc *desc);

/* Stages a file beside main (name NULL: main itself, which should come last, so that its presence implies
 * the others). Fails as file_stage_write(), with FACET_ERROR_MEMORY, with _ARGUMENT where an input would
 * be replaced, and with _CANCELLED. */
facet_result file_set_add(file_set *set, const char *name, const void *bytes, size_t size,
                          facet_error *error);
/* Moves all files into place, in the order in which they were added. */
facet_result file_set_commit(file_set *set, facet_error *error);
void file_set_destroy(file_set *set); /* removes files that were not committed */

#endif
