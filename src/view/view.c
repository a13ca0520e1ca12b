/* view.c - the viewer: facet_view(). The loop sleeps until an event, applies it to the state, and redraws
 * what changed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/result.h"
#include "view/view_app.h"

static const double longest_step_s = 0.25; /* of an animation: after a sleep it does not jump */
/* after the last camera movement, before the image is drawn in full resolution */
static const double rest_s = 0.2;
static const double patience_s = 0.3; /* before a window is shown whose model is still being read */

void view_app_say(view_app *a, const char *text, double seconds)
{
    snprintf(a->message, sizeof a->message, "%s", text);
    a->message_until_s = a->time_s + seconds;
    a->is_hint = false;
    a->needs_frame = true;
    if (a->has_no_text)
        a->desc->source.print(a->desc->source.user, text);
}

/* ---- warnings of renderers ---- */

static void wake(void *user);

static void receive_warning(void *user, facet_log_level level, const char *text)
{
    view_app *a = user;
    if (level != FACET_LOG_LEVEL_WARNING)
        return;
    pthread_mutex_lock(&a->warning_mutex);
    snprintf(a->warning, sizeof a->warning, "%s", text);
    pthread_mutex_unlock(&a->warning_mutex);
    wake(a);
}

/* Once per warning, not with every frame. */
static void show_warning(view_app *a)
{
    char text[sizeof a->warning];
    pthread_mutex_lock(&a->warning_mutex);
    memcpy(text, a->warning, sizeof text);
    a->warning[0] = 0;
    bool is_new = text[0] && strcmp(text, a->shown_warning) != 0;
    if (is_new)
        memcpy(a->shown_warning, text, sizeof text);
    pthread_mutex_unlock(&a->warning_mutex);
    if (is_new)
        view_app_say(a, text, 6.0);
}

void view_app_forget_warning(view_app *a)
{
    pthread_mutex_lock(&a->warning_mutex);
    a->shown_warning[0] = 0;
    pthread_mutex_unlock(&a->warning_mutex);
}

/* Called from threads. */
static void wake(void *user)
{
    view_app *a = user;
    view_window *w = atomic_load(&a->window);
    if (w)
        view_window_wake(w);
}

/* ---- events ---- */

static void press_key(view_app *a, const view_event *e)
{
    const view_binding *b = view_binding_find(e->key, e->modifiers);
    if (!b)
        return;
    if (view_state_apply(&a->state, b->action, b->amount)) {
        a->needs_image = true;
        view_app_forget_warning(a);
        if (a->state.message[0])
            view_app_say(a, a->state.message, 2.0);
        return;
    }
    switch (b->action) {
    case VIEW_ACTION_MODEL:
        view_files_step_model(a, b->amount);
        break;
    case VIEW_ACTION_RELOAD:
        view_files_reload(a, false);
        break;
    case VIEW_ACTION_ENVIRONMENT:
        view_files_step_environment(a, b->amount);
        break;
    case VIEW_ACTION_FULL_SCREEN:
        view_window_toggle_full_screen(a->window);
        break;
    case VIEW_ACTION_SCREENSHOT:
        view_shot_key(a);
        break;
    case VIEW_ACTION_COPY:
        view_shot_copy(a);
        break;
    case VIEW_ACTION_PRINT:
        view_shot_print(a);
        break;
    case VIEW_ACTION_QUIT:
        a->is_closing = true;
        break;
    default:
        break;
    }
}

/* The hint at the start disappears with the first input; pointer movement does not count. */
static void end_hint(view_app *a, const view_event *e)
{
    if (!a->is_hint || e->kind == VIEW_MOVE || e->kind == VIEW_RELEASE)
        return;
    a->is_hint = false;
    a->message[0] = 0;
    a->needs_frame = true;
}

static void handle_events(view_app *a)
{
    view_event e;
    while (view_queue_take(&a->queue, &e)) {
        end_hint(a, &e);
        bool was_held = a->state.is_held;
        switch (e.kind) {
        case VIEW_KEY:
            press_key(a, &e);
            break;
        case VIEW_DROP:
            view_files_drop(a, e.path);
            break;
        case VIEW_CLOSE:
            a->is_closing = true;
            break;
        default:
            if (view_state_point(&a->state, &e)) {
                a->needs_image = true;
                a->moves_until_s = a->state.divider.is_dragged ? 0.0 : clock_seconds() + rest_s;
            }
            /* after a movement path tracing starts when the button is released */
            a->needs_image = a->needs_image || (was_held && !a->state.is_held);
        }
        free(e.path);
    }
}

/* ---- the loop ---- */

/* Seconds until something is due that does not wake the loop itself. */
static double time_to_sleep(const view_app *a)
{
    bool is_visible = a->state.width > 0;
    if (a->desc->script)
        return 0.02; /* steps wait for threads, windows, files */
    if (a->needs_image || a->needs_frame)
        return 0.0;
    if (!a->is_shown)
        return 0.01;
    if (a->state.is_playing && is_visible)
        return 0.0;
    double rest = a->divisor > 1 || a->is_draft ? a->moves_until_s - a->clock_s : (double)INFINITY;
    double message = a->message[0] ? a->message_until_s - a->time_s : (double)INFINITY;
    return fmax(fmin(rest, message), 0.001);
}

static void advance_clock(view_app *a)
{
    double now = clock_seconds();
    double passed = now - a->clock_s;
    a->clock_s = now;
    if (!a->desc->script) {
        a->time_s += passed;
        if (view_state_advance(&a->state, fmin(passed, longest_step_s)))
            a->needs_image = true;
    }
    if ((a->divisor > 1 || a->is_draft) && now >= a->moves_until_s)
        a->needs_image = true;
    if (a->message[0] && a->time_s >= a->message_until_s) {
        a->message[0] = 0;
        a->needs_frame = true;
    }
}

/* Shows the window with its first image, or without one where that takes longer. */
static void show_window(view_app *a, double start)
{
    if (a->is_shown || (!a->scene && clock_seconds() - start < patience_s))
        return;
    view_window_show(a->window);
    a->is_shown = true;
    a->needs_image = true;
}

static void draw(view_app *a)
{
    uint32_t width;
    uint32_t height;
    view_window_size(a->window, &width, &height);
    if (!a->is_shown || !width || !height) {
        a->state.width = a->is_shown ? 0 : 1;
        return;
    }
    if (view_window_needs_drawing(a->window))
        a->needs_image = true;
    if (view_state_accumulating_sides(&a->state))
        a->needs_frame = true; /* the tracer may have a newer image */
    facet_error error;
    if ((a->needs_image || a->needs_frame) && view_show(a, &error) != FACET_OK) {
        a->needs_image = a->needs_frame = false;
        view_app_say(a, error.message, 8.0);
        if (a->desc->script) { /* a script has no reader of messages */
            a->error = error;
            a->result = error.result;
        }
    }
}

static void loop(view_app *a)
{
    double start = clock_seconds();
    a->clock_s = start;
    while (!a->is_closing && a->result == FACET_OK) {
        if (view_play(a))
            view_window_wait(a->window, 0.0);
        else if (a->desc->script && a->script_at == a->script.count)
            a->is_closing = true;
        else
            view_window_wait(a->window, time_to_sleep(a));
        if (a->result == FACET_OK) { /* otherwise the script has failed */
            advance_clock(a);
            handle_events(a);
            a->result = view_files_update(a, &a->error);
        }
        if (a->result != FACET_OK)
            break;
        show_window(a, start);
        show_warning(a);
        draw(a);
    }
}

/* ---- begin and end ---- */

static facet_result begin(view_app *a, facet_error *error)
{
    const facet_view_desc *d = a->desc;
    view_window *window = NULL;
    view_state_create(&a->state, d);
    a->divisor = 1;
    a->state.render.log = (facet_log){.user = a, .message = receive_warning};
    if (d->script)
        TRY(view_script_load(d->script, &d->allocator, &a->script, error));
    TRY(view_load_create(a->host, d, wake, a, &a->loader, error));
    TRY(view_files_begin(a, error)); /* the model is read while the window opens */
    TRY(view_window_create(&d->allocator, d->render.width, d->render.height, &a->queue, &window, error));
    atomic_store(&a->window, window);
    TRY(gl_context_adopt(&a->context, error));
    TRY(view_draw_create(&a->context, &d->allocator, &a->draw, error));
    for (int i = 0; i < 2; i++)
        TRY(view_trace_create(a->host, &d->allocator, wake, a, &a->traced[i].tracer, error));
    return view_watch_create(&d->allocator, wake, a, &a->watcher, error);
}

static void end(view_app *a)
{
    view_window *window = atomic_load(&a->window);
    for (int i = 0; i < 2; i++)
        view_trace_destroy(a->traced[i].tracer);
    view_load_destroy(a->loader);
    view_watch_destroy(a->watcher);
    if (window) {
        gl_renderer_destroy(a->renderer);
        view_show_end(a);
        view_draw_destroy(a->draw);
    }
    view_files_end(a);
    view_queue_clear(&a->queue);
    view_script_destroy(&a->script);
    atomic_store(&a->window, NULL);
    view_window_destroy(window);
}

facet_result view_run(const gl_host *host, const facet_view_desc *desc, facet_error *error)
{
    view_app *a = mem_zalloc(&desc->allocator, 1, sizeof *a);
    if (!a)
        return fail_memory(error, "window", sizeof *a);
    a->host = host;
    a->desc = desc;
    pthread_mutex_init(&a->warning_mutex, NULL);
    a->result = begin(a, &a->error);
    if (a->result == FACET_OK)
        loop(a);
    facet_result result = a->result;
    if (result != FACET_OK && error) {
        *error = a->error;
        error->result = result;
    }
    end(a);
    pthread_mutex_destroy(&a->warning_mutex);
    mem_free(a);
    return result;
}
