/* page_files.h - the files that a page needs to show a model: those that the model was read from and those that options
 * name, under relative names that keep their places beside each other. */
#ifndef CLI_PAGE_FILES_H
#define CLI_PAGE_FILES_H

#include "cli/shared/environment_input.h"

typedef struct page_file {
    char *path;    /* on the disk */
    char *name;    /* in the page, relative: "model.gltf", "textures/wood.png" */
    bool is_light; /* of the environment, which models share */
} page_file;

/* {0}, then page_files_create(). */
typedef struct page_files {
    page_file *items;
    size_t count, capacity;
    const char *model;  /* name of the model; "": none, the built-in scene */
    char *temporary;    /* a folder to be removed; NULL: none */
    size_t root_length; /* of the folder that all files of the model are in */
} page_files;

/* Of what files are listed. */
typedef struct page_files_desc {
    const facet_scene *scene;
    const char *path; /* of the model; NULL: the built-in scene */
    /* the scene is in no files that read alike without options: it is written as stem.glb to a temporary folder */
    bool is_written;
    const char *stem;
    const environment_input *environment; /* NULL: none */
} page_files_desc;

/* Fails with FACET_ERROR_MEMORY, and with FACET_ERROR_READ or _WRITE if the current or the temporary folder cannot be used. */
facet_result page_files_create(const page_files_desc *desc, page_files *out, facet_error *error);
void page_files_destroy(page_files *files); /* {0} is allowed */

/* The name in the page of the file at path; NULL: it is not one of them. */
const char *page_files_name(const page_files *files, const char *path);

#endif
