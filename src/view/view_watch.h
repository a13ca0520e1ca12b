/* view_watch.h - tells when files of the model that is shown change: inotify, asked by a thread that sleeps otherwise. */
#ifndef VIEW_VIEW_WATCH_H
#define VIEW_VIEW_WATCH_H

#include "facet/facet.h"

typedef struct view_watcher view_watcher;

/* wake is called after a change, from another thread. Fails with FACET_ERROR_MEMORY, FACET_ERROR_SYSTEM (no inotify). */
facet_result view_watch_create(const facet_allocator *allocator, void (*wake)(void *user), void *user,
                               view_watcher **out, facet_error *error);
void view_watch_destroy(view_watcher *w); /* NULL is allowed */

/* From now on the files of scene that lie in the folder of path or in a folder of that; path NULL: none. */
void view_watch_set(view_watcher *w, const facet_scene *scene, const char *path);
/* Whether one of them changed since the last question, and a moment has passed in which none did: programs write
 * several files. */
bool view_watch_take(view_watcher *w);

#endif
