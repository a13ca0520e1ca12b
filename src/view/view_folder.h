/* view_folder.h - the lists of models and of environments to step through. */
#ifndef VIEW_VIEW_FOLDER_H
#define VIEW_VIEW_FOLDER_H

#include "facet/facet.h"

typedef struct view_list {
    facet_allocator allocator;
    char **names; /* each a block of mem_alloc() */
    size_t count, capacity;
    size_t at; /* index of the current one; count: none of them */
} view_list;

bool view_path_is_model(const char *path); /* by its extension: .glb .gltf .obj */
bool view_path_is_folder(const char *path);
bool view_path_is_environment(const char *path); /* .hdr .exr .pfm .ktx2 and other images */

/* From the given paths: models as they are; of folders the models in them, or where there are none those
 * one or two folders below, by name. For a single model: those of its folder, with it as the current one.
 * False: out of memory. */
bool view_list_models(view_list *list, const char *const *paths, uint32_t path_count);
/* The names, followed by the environments in the folder of path (NULL: none), which is the current one. */
bool view_list_environments(view_list *list, const char *const *names, uint32_t name_count, const char *path);
void view_list_clear(view_list *list);
/* Moves by that many steps, wrapping around, and returns the name; NULL: the list is empty. */
const char *view_list_step(view_list *list, int steps);

#endif
