/* view_load.c - see view_load.h. At most one request waits: a user who steps through a folder wants the last
 * model, not all of them. */
#define _POSIX_C_SOURCE 200809L /* strdup */
#include "view/view_load.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "scene/scene.h"

/* A request that owns its names. */
typedef struct request_copy {
    view_request request;
    char *path, *environment;
    facet_view_model model;
} request_copy;

struct view_loader {
    const gl_host *host;
    const facet_view_desc *desc;
    void (*wake)(void *user);
    void *user;
    pthread_t thread;
    pthread_mutex_t mutex; /* guards all below */
    pthread_cond_t changed;
    bool is_started, is_ending, has_next, is_reading, has_result;
    request_copy next;
    view_loaded result;
};

static char *copy_of(const char *text)
{
    return text ? strdup(text) : NULL;
}

static void clear_copy(request_copy *c)
{
    free(c->path);
    free(c->environment);
    *c = (request_copy){0};
}

void view_loaded_destroy(const gl_host *host, view_loaded *loaded)
{
    if (loaded->has_model)
        host->scene_destroy(loaded->model.scene);
    host->environment_destroy(loaded->environment);
    free(loaded->path);
    free(loaded->environment_name);
    *loaded = (view_loaded){0};
}

/* ---- the thread ---- */

/* Radius and target of the orbit that frames the model, before it is moved by hand. */
static facet_result frame(const facet_view_desc *desc, view_loaded *out, facet_error *error)
{
    facet_view_model *m = &out->model;
    facet_camera camera;
    scene_pose pose;
    TRY(scene_pose_create(m->scene, &m->pose, &desc->allocator, desc->render.thread_count, &pose, error));
    memcpy(out->low, pose.bounds_min, sizeof out->low);
    memcpy(out->high, pose.bounds_max, sizeof out->high);
    scene_pose_destroy(&pose);
    /* an orbit that cannot frame the model fails now; the fit to a wider window is found when it is drawn */
    return scene_fit_orbit(m->scene, &m->pose, &m->orbit,
                           (float)desc->render.width / (float)desc->render.height, &camera, error);
}

static void load(view_loader *l, request_copy *c, view_loaded *out)
{
    const facet_view_source *s = &l->desc->source;
    facet_result result = FACET_OK;
    facet_view_model model = c->model;
    *out = (view_loaded){.wanted_model = c->request.wants_model,
                         .wanted_environment = c->request.wants_environment,
                         .path = c->path,
                         .environment_name = c->environment};
    if (c->request.wants_model) {
        result = s->load_model(s->user, c->path, &out->model, &out->error);
        out->has_model = result == FACET_OK;
        if (result == FACET_OK)
            result = frame(l->desc, out, &out->error);
        model = out->model;
    }
    if (result == FACET_OK && c->request.wants_environment) {
        result = s->load_environment(s->user, c->environment, &model, &out->environment, &out->error);
        out->has_environment = result == FACET_OK;
    }
    out->error.result = result;
    if (result != FACET_OK && out->has_model) {
        l->host->scene_destroy(out->model.scene);
        out->has_model = false;
    }
}

static void *run(void *user)
{
    view_loader *l = user;
    pthread_mutex_lock(&l->mutex);
    for (;;) {
        while (!l->is_ending && (!l->has_next || l->has_result))
            pthread_cond_wait(&l->changed, &l->mutex);
        if (l->is_ending)
            break;
        request_copy c = l->next;
        l->next = (request_copy){0};
        l->has_next = false;
        l->is_reading = true;
        pthread_mutex_unlock(&l->mutex);
        view_loaded loaded;
        load(l, &c, &loaded);
        pthread_mutex_lock(&l->mutex);
        l->is_reading = false;
        l->result = loaded;
        l->has_result = true;
        pthread_mutex_unlock(&l->mutex);
        l->wake(l->user);
        pthread_mutex_lock(&l->mutex);
    }
    pthread_mutex_unlock(&l->mutex);
    return NULL;
}

/* ---- for the window ---- */

facet_result view_load_create(const gl_host *host, const facet_view_desc *desc, void (*wake)(void *user),
                              void *user, view_loader **out, facet_error *error)
{
    view_loader *l = mem_zalloc(&desc->allocator, 1, sizeof *l);
    *out = NULL;
    if (!l)
        return fail_memory(error, "loader", sizeof *l);
    *l = (view_loader){.host = host, .desc = desc, .wake = wake, .user = user};
    pthread_mutex_init(&l->mutex, NULL);
    pthread_cond_init(&l->changed, NULL);
    l->is_started = pthread_create(&l->thread, NULL, run, l) == 0;
    if (!l->is_started) {
        view_load_destroy(l);
        return fail(error, FACET_ERROR_MEMORY, "window: the system refuses a thread that reads models");
    }
    *out = l;
    return FACET_OK;
}

void view_load_destroy(view_loader *l)
{
    if (!l)
        return;
    if (l->is_started) {
        pthread_mutex_lock(&l->mutex);
        l->is_ending = true;
        pthread_cond_signal(&l->changed);
        pthread_mutex_unlock(&l->mutex);
        pthread_join(l->thread, NULL);
    }
    clear_copy(&l->next);
    view_loaded_destroy(l->host, &l->result);
    pthread_cond_destroy(&l->changed);
    pthread_mutex_destroy(&l->mutex);
    mem_free(l);
}

bool view_load_request(view_loader *l, const view_request *request)
{
    request_copy c = {
        .request = *request, .path = copy_of(request->path), .environment = copy_of(request->environment)};
    if (request->model)
        c.model = *request->model;
    c.request.model = NULL;
    if ((request->path && !c.path) || (request->environment && !c.environment)) {
        clear_copy(&c);
        return false;
    }
    pthread_mutex_lock(&l->mutex);
    if (l->has_next) { /* parts that only the older request names are still wanted */
        request_copy *old = &l->next;
        if (old->request.wants_model && !c.request.wants_model) {
            c.request.wants_model = true;
            c.path = old->path;
            old->path = NULL;
        }
        if (old->request.wants_environment && !c.request.wants_environment) {
            c.request.wants_environment = true;
            c.environment = old->environment;
            old->environment = NULL;
        }
        clear_copy(old);
    }
    l->next = c;
    l->has_next = true;
    pthread_cond_signal(&l->changed);
    pthread_mutex_unlock(&l->mutex);
    return true;
}

bool view_load_is_busy(view_loader *l)
{
    pthread_mutex_lock(&l->mutex);
    bool is_busy = l->has_next || l->is_reading || l->has_result;
    pthread_mutex_unlock(&l->mutex);
    return is_busy;
}

bool view_load_take(view_loader *l, view_loaded *out)
{
    pthread_mutex_lock(&l->mutex);
    bool has_result = l->has_result;
    if (has_result) {
        *out = l->result;
        l->result = (view_loaded){0};
        l->has_result = false;
        pthread_cond_signal(&l->changed);
    }
    pthread_mutex_unlock(&l->mutex);
    return has_result;
}
