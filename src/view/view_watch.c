/* view_watch.c - see view_watch.h. Programs replace files rather than write into them, so names in folders
 * are watched; the names of the scene's files are found while they are still the ones that were read. */
#define _GNU_SOURCE /* NAME_MAX, strdup */
#include "view/view_watch.h"

#include <dirent.h>
#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/result.h"
#include "scene/scene.h"

enum { MAX_NAMES = 1024, MAX_FOLDERS = 64, MAX_ENTRIES = 20000, CALM_MS = 150 };

typedef struct watched_name {
    int folder; /* inotify's */
    char *name; /* a block of malloc() */
} watched_name;

struct view_watcher {
    void (*wake)(void *user);
    void *user;
    int events, ending; /* inotify; an eventfd */
    pthread_t thread;
    bool is_started;

    pthread_mutex_t mutex; /* guards all below */
    watched_name names[MAX_NAMES];
    int name_count;
    int folders[MAX_FOLDERS];
    int folder_count;
    bool has_changed;
};

/* ---- the thread ---- */

static bool is_watched(view_watcher *w, const struct inotify_event *event)
{
    bool is_found = false;
    pthread_mutex_lock(&w->mutex);
    for (int i = 0; i < w->name_count && event->len; i++)
        is_found =
            is_found || (w->names[i].folder == event->wd && strcmp(w->names[i].name, event->name) == 0);
    pthread_mutex_unlock(&w->mutex);
    return is_found;
}

/* Whether inotify reports something that is watched. */
static bool read_events(view_watcher *w)
{
    _Alignas(struct inotify_event) char buffer[16 * (sizeof(struct inotify_event) + NAME_MAX + 1)];
    bool is_found = false;
    ssize_t size = read(w->events, buffer, sizeof buffer);
    for (ssize_t at = 0; at < size;) {
        const struct inotify_event *event = (const void *)(buffer + at);
        is_found = is_watched(w, event) || is_found;
        at += (ssize_t)(sizeof *event + event->len);
    }
    return is_found;
}

static void *run(void *user)
{
    view_watcher *w = user;
    bool is_pending = false;
    for (;;) {
        struct pollfd files[] = {{.fd = w->ending, .events = POLLIN}, {.fd = w->events, .events = POLLIN}};
        int count = poll(files, 2, is_pending ? CALM_MS : -1);
        if (files[0].revents)
            return NULL;
        if (count > 0) {
            is_pending = read_events(w) || is_pending;
            continue;
        }
        if (count == 0 && is_pending) {
            is_pending = false;
            pthread_mutex_lock(&w->mutex);
            w->has_changed = true;
            pthread_mutex_unlock(&w->mutex);
            w->wake(w->user);
        }
    }
}

/* ---- watched names ---- */

static void forget(view_watcher *w)
{
    for (int i = 0; i < w->folder_count; i++)
        inotify_rm_watch(w->events, w->folders[i]);
    for (int i = 0; i < w->name_count; i++)
        free(w->names[i].name);
    w->folder_count = w->name_count = 0;
    w->has_changed = false;
}

/* The scene's files in a folder; where subfolders is not NULL their names are added to it, as many as fit. */
static void add_folder(view_watcher *w, const facet_scene *scene, const char *folder, char **subfolders,
                       int *subfolder_count)
{
    DIR *directory = w->folder_count < MAX_FOLDERS ? opendir(folder) : NULL;
    if (!directory)
        return;
    int watch = -1;
    struct dirent *entry;
    for (int n = 0; n < MAX_ENTRIES && (entry = readdir(directory)) != NULL; n++) {
        char path[PATH_MAX];
        struct stat info;
        int length = snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (entry->d_name[0] == '.' || length >= (int)sizeof path || stat(path, &info) != 0)
            continue;
        if (S_ISDIR(info.st_mode) && subfolders && *subfolder_count < MAX_FOLDERS) {
            subfolders[*subfolder_count] = strdup(path);
            *subfolder_count += subfolders[*subfolder_count] != NULL;
        }
        if (!S_ISREG(info.st_mode) || w->name_count == MAX_NAMES || !scene_has_file(scene, path))
            continue;
        if (watch < 0)
            watch = inotify_add_watch(w->events, folder, IN_CLOSE_WRITE | IN_MOVED_TO | IN_ONLYDIR);
        char *name = watch >= 0 ? strdup(entry->d_name) : NULL;
        if (name)
            w->names[w->name_count++] = (watched_name){watch, name};
    }
    closedir(directory);
    if (watch >= 0)
        w->folders[w->folder_count++] = watch;
}

void view_watch_set(view_watcher *w, const facet_scene *scene, const char *path)
{
    pthread_mutex_lock(&w->mutex);
    forget(w);
    char *folder = path ? path_folder(NULL, path) : NULL;
    if (folder) {
        char *subfolders[MAX_FOLDERS];
        int count = 0;
        add_folder(w, scene, folder, subfolders, &count);
        for (int i = 0; i < count; i++) {
            add_folder(w, scene, subfolders[i], NULL, NULL);
            free(subfolders[i]);
        }
        mem_free(folder);
    }
    pthread_mutex_unlock(&w->mutex);
}

bool view_watch_take(view_watcher *w)
{
    pthread_mutex_lock(&w->mutex);
    bool has_changed = w->has_changed;
    w->has_changed = false;
    pthread_mutex_unlock(&w->mutex);
    return has_changed;
}

/* ---- create ---- */

facet_result view_watch_create(const facet_allocator *allocator, void (*wake)(void *user), void *user,
                               view_watcher **out, facet_error *error)
{
    view_watcher *w = mem_zalloc(allocator, 1, sizeof *w);
    *out = NULL;
    if (!w)
        return fail_memory(error, "watching files", sizeof *w);
    w->wake = wake;
    w->user = user;
    w->events = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    w->ending = eventfd(0, EFD_CLOEXEC);
    pthread_mutex_init(&w->mutex, NULL);
    if (w->events >= 0 && w->ending >= 0)
        w->is_started = pthread_create(&w->thread, NULL, run, w) == 0;
    if (!w->is_started) {
        view_watch_destroy(w);
        return fail(error, FACET_ERROR_SYSTEM, "window: the system cannot watch files (inotify)");
    }
    *out = w;
    return FACET_OK;
}

void view_watch_destroy(view_watcher *w)
{
    if (!w)
        return;
    const uint64_t one = 1;
    if (w->is_started && write(w->ending, &one, sizeof one) == (ssize_t)sizeof one)
        pthread_join(w->thread, NULL);
    forget(w);
    if (w->events >= 0)
        close(w->events);
    if (w->ending >= 0)
        close(w->ending);
    pthread_mutex_destroy(&w->mutex);
    mem_free(w);
}
