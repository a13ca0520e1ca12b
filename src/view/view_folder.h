/* view_folder.h - the models, or the environments, that one steps through. */
#ifndef VIEW_VIEW_FOLDER_H
#define VIEW_VIEW_FOLDER_H

#include "facet/facet.h"

typedef struct view_list {
    facet_allocator allocator;
    char **names; /* each a block of mem_alloc() */
    size_t count, capacity;
    size_t at; /* which is shown; count: none of them */
} view_list;

bool view_path_is_model(const char *path); /* by its extension: .glb .gltf .obj */
bool view_path_is_folder(const char *path);
bool view_path_is_environment(const char *path); /* .hdr .exr .pfm .ktx2 and pictures */

/* What is given: models as they are, of folders the models in them, or where there are none those one or two folders below,
 * by name. One model alone: its folder's, and it is where the list stands. False: no memory. */
bool view_list_models(view_list *list, const char *const *paths, uint32_t path_count);
/* The names, and behind them the environments in the folder of path (NULL: none), where the list stands. */
bool view_list_environments(view_list *list, const char *const *names, uint32_t name_count, const char *path);
void view_list_clear(view_list *list);
/* The name that is steps further, around the end; NULL: the list is empty. The list then stands there. */
const char *view_list_step(view_list *list, int steps);

#endif
