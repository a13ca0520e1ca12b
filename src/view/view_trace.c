/* view_trace.c - see view_trace.h. */
#include "view/view_trace.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "image/srgb.h"

/* ---- images ---- */

facet_result view_image_create(const facet_image_view *v, const facet_allocator *allocator, view_image *out,
                               facet_error *error)
{
    size_t count = (size_t)v->width * v->height;
    srgb_tables tables;
    *out = (view_image){v->width, v->height, mem_alloc(allocator, count, 4)};
    if (!out->pixels)
        return fail_memory(error, "image", count * 4);
    srgb_tables_prepare(&tables);
    unsigned char *to = out->pixels;
    for (uint32_t y = 0; y < v->height; y++) {
        const float *from = (const float *)(const void *)((const char *)v->pixels + y * v->row_stride_bytes);
        for (uint32_t x = 0; x < v->width; x++, from += 4, to += 4) {
            float opacity = from[3] < 1.0f ? from[3] : 1.0f;
            float scale = opacity > 0.0f ? 1.0f / opacity : 0.0f;
            for (int c = 0; c < 3; c++)
                to[c] = srgb_encode_u8(&tables, from[c] * scale);
            to[3] = (unsigned char)(opacity > 0.0f ? opacity * 255.0f + 0.5f : 0.0f);
        }
    }
    return FACET_OK;
}

void view_image_destroy(view_image *p)
{
    mem_free(p->pixels);
    *p = (view_image){0};
}

float *view_image_to_linear(const view_image *p, const facet_allocator *allocator)
{
    size_t count = (size_t)p->width * p->height;
    srgb_tables tables;
    float *pixels = mem_alloc(allocator, count, 4 * sizeof *pixels);
    if (!pixels)
        return NULL;
    srgb_tables_prepare(&tables);
    for (size_t i = 0; i < count; i++) {
        float opacity = (float)p->pixels[4 * i + 3] / 255.0f;
        for (int c = 0; c < 3; c++)
            pixels[4 * i + (size_t)c] = opacity * tables.decoded[p->pixels[4 * i + (size_t)c]];
        pixels[4 * i + 3] = opacity;
    }
    return pixels;
}

/* ---- the tracer ---- */

enum { MAX_ANIMATIONS = 256 };

/* A desc that owns what it points to. */
typedef struct trace_job {
    const facet_scene *scene;
    facet_render_desc desc;
    facet_camera camera;
    uint32_t animations[MAX_ANIMATIONS];
} trace_job;

struct view_tracer {
    const gl_host *host;
    facet_allocator allocator;
    void (*wake)(void *user);
    void *user;
    pthread_t thread;
    facet_renderer *renderer; /* of rendered; used by the thread */
    const facet_scene *rendered;
    trace_job job; /* the job being traced; used by the thread while it is */

    pthread_mutex_t mutex; /* guards all below */
    pthread_cond_t changed;
    bool is_started, is_ending, is_working, is_cancelled, has_next;
    trace_job next;
    bool has_last;
    trace_job last; /* the last requested job */
    bool has_image;
    view_image display;
    view_trace_state state;
};

/* ---- jobs ---- */

static void fill_job(trace_job *job, const facet_scene *scene, const facet_render_desc *desc)
{
    memset(job, 0, sizeof *job); /* including padding: jobs are compared as bytes */
    job->scene = scene;
    job->desc = *desc;
    job->camera = *desc->camera;
    uint32_t count =
        desc->pose.animation_count < MAX_ANIMATIONS ? desc->pose.animation_count : MAX_ANIMATIONS;
    for (uint32_t i = 0; i < count; i++)
        job->animations[i] = desc->pose.animations[i];
    job->desc.pose.animation_count = count;
    job->desc.camera = NULL; /* the copy is set by the job that is traced */
    job->desc.pose.animations = NULL;
}

/* ---- the thread ---- */

static void give(view_tracer *t, const facet_image *image, uint32_t samples)
{
    facet_image_view view = t->host->image_get_layer(image, 0);
    view_image display;
    if (view_image_create(&view, &t->allocator, &display, NULL) != FACET_OK)
        return;
    pthread_mutex_lock(&t->mutex);
    bool is_wanted = !t->is_cancelled;
    if (is_wanted) {
        view_image_destroy(&t->display);
        t->display = display;
        t->has_image = true;
        t->state.samples = samples;
    }
    pthread_mutex_unlock(&t->mutex);
    if (is_wanted)
        t->wake(t->user);
    else
        view_image_destroy(&display);
}

static void on_pass(void *user, const facet_image *image, uint32_t samples)
{
    give(user, image, samples);
}

static bool on_progress(void *user, const char *stage, double fraction)
{
    view_tracer *t = user;
    (void)stage;
    (void)fraction;
    pthread_mutex_lock(&t->mutex);
    bool goes_on = !t->is_cancelled;
    pthread_mutex_unlock(&t->mutex);
    return goes_on;
}

static facet_result trace(view_tracer *t, facet_error *error)
{
    trace_job *job = &t->job;
    if (t->rendered != job->scene) {
        t->host->renderer_destroy(t->renderer);
        t->renderer = NULL;
        t->rendered = NULL;
    }
    facet_result result = FACET_OK;
    if (!t->renderer)
        result = t->host->renderer_create(job->scene, &t->allocator, &t->renderer, error);
    if (result != FACET_OK)
        return result;
    t->rendered = job->scene;
    facet_render_desc desc = job->desc;
    desc.allocator = t->allocator;
    desc.camera = &job->camera;
    desc.pose.animations = job->animations;
    desc.progress = (facet_progress){.user = t, .report = on_progress};
    desc.path.pass = on_pass;
    desc.path.pass_user = t;
    facet_image *image = NULL;
    result = t->host->renderer_render(t->renderer, &desc, &image, error);
    if (result == FACET_OK)
        give(t, image, desc.samples);
    t->host->image_destroy(image);
    return result;
}

static void *run(void *user)
{
    view_tracer *t = user;
    pthread_mutex_lock(&t->mutex);
    for (;;) {
        while (!t->is_ending && !t->has_next)
            pthread_cond_wait(&t->changed, &t->mutex);
        if (t->is_ending)
            break;
        t->job = t->next;
        t->has_next = false;
        t->is_working = true;
        t->is_cancelled = false;
        t->state = (view_trace_state){.wanted = t->job.desc.samples};
        pthread_mutex_unlock(&t->mutex);
        facet_error error = {0};
        facet_result result = trace(t, &error);
        pthread_mutex_lock(&t->mutex);
        t->is_working = false;
        t->state.is_done = !t->has_next;
        if (result != FACET_OK && result != FACET_ERROR_CANCELLED) {
            t->state.error = error;
            t->state.error.result = result;
        }
        pthread_cond_broadcast(&t->changed);
        pthread_mutex_unlock(&t->mutex);
        t->wake(t->user);
        pthread_mutex_lock(&t->mutex);
    }
    pthread_mutex_unlock(&t->mutex);
    return NULL;
}

/* ---- for the window ---- */

facet_result view_trace_create(const gl_host *host, const facet_allocator *allocator,
                               void (*wake)(void *user), void *user, view_tracer **out, facet_error *error)
{
    view_tracer *t = mem_zalloc(allocator, 1, sizeof *t);
    *out = NULL;
    if (!t)
        return fail_memory(error, "path tracing", sizeof *t);
    t->host = host;
    t->allocator = *allocator;
    t->wake = wake;
    t->user = user;
    pthread_mutex_init(&t->mutex, NULL);
    pthread_cond_init(&t->changed, NULL);
    t->is_started = pthread_create(&t->thread, NULL, run, t) == 0;
    if (!t->is_started) {
        view_trace_destroy(t);
        return fail(error, FACET_ERROR_MEMORY, "window: the system refuses a thread that traces paths");
    }
    *out = t;
    return FACET_OK;
}

void view_trace_destroy(view_tracer *t)
{
    if (!t)
        return;
    if (t->is_started) {
        pthread_mutex_lock(&t->mutex);
        t->is_ending = true;
        t->is_cancelled = true;
        pthread_cond_broadcast(&t->changed);
        pthread_mutex_unlock(&t->mutex);
        pthread_join(t->thread, NULL);
    }
    t->host->renderer_destroy(t->renderer);
    view_image_destroy(&t->display);
    pthread_cond_destroy(&t->changed);
    pthread_mutex_destroy(&t->mutex);
    mem_free(t);
}

bool view_trace_start(view_tracer *t, const facet_scene *scene, const facet_render_desc *desc)
{
    trace_job job;
    fill_job(&job, scene, desc);
    pthread_mutex_lock(&t->mutex);
    bool is_new = !t->has_last || memcmp(&t->last, &job, sizeof job) != 0;
    if (is_new) {
        memcpy(&t->last, &job, sizeof job);
        t->has_last = true;
        memcpy(&t->next, &job, sizeof job);
        t->has_next = true;
        t->is_cancelled = true; /* the current job */
        t->state = (view_trace_state){.wanted = desc->samples};
        t->has_image = false;
        pthread_cond_broadcast(&t->changed);
    }
    pthread_mutex_unlock(&t->mutex);
    return is_new;
}

bool view_trace_is_of(view_tracer *t, const facet_scene *scene, const facet_render_desc *desc)
{
    trace_job job;
    fill_job(&job, scene, desc);
    pthread_mutex_lock(&t->mutex);
    bool is_same = t->has_last && memcmp(&t->last, &job, sizeof job) == 0;
    pthread_mutex_unlock(&t->mutex);
    return is_same;
}

void view_trace_stop(view_tracer *t)
{
    pthread_mutex_lock(&t->mutex);
    t->has_next = false;
    t->has_last = false;
    t->has_image = false;
    t->is_cancelled = true;
    while (t->is_working)
        pthread_cond_wait(&t->changed, &t->mutex);
    t->host->renderer_destroy(t->renderer);
    t->renderer = NULL;
    t->rendered = NULL;
    t->state = (view_trace_state){0};
    pthread_mutex_unlock(&t->mutex);
}

bool view_trace_take(view_tracer *t, view_image *out, uint32_t *samples)
{
    pthread_mutex_lock(&t->mutex);
    bool has_image = t->has_image;
    if (has_image) {
        *out = t->display;
        *samples = t->state.samples;
        t->display = (view_image){0};
        t->has_image = false;
    }
    pthread_mutex_unlock(&t->mutex);
    return has_image;
}

view_trace_state view_trace_get(view_tracer *t)
{
    pthread_mutex_lock(&t->mutex);
    view_trace_state state = t->state;
    pthread_mutex_unlock(&t->mutex);
    return state;
}
