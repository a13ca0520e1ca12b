/* view_watch.h - detects changes to the files of the displayed model: inotify, read by a thread. */
#ifndef VIEW_VIEW_WATCH_H
#define VIEW_VIEW_WATCH_H

#include "facet/facet.h"

typedef struct view_watcher view_watcher;

/* wake is called after a change, from another thread. Fails with FACET_ERROR_MEMORY, FACET_ERROR_SYSTEM (no
 * inotify). */
facet_result view_watch_create(const facet_allocator *allocator, void (*wake)(void *user), void *user,
                               view_watcher **out, facet_error *error);
void view_watch_destroy(view_watcher *w); /* NULL is allowed */

/* Watches from now on the files of scene in the folder of path and in its subfolders; path NULL: none. */
void view_watch_set(view_watcher *w, const facet_scene *scene, const char *path);
/* Whether one of them changed since the last call, and none did for a short while: programs write several
 * files. */
bool view_watch_take(view_watcher *w);

#endif
