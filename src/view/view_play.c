/* view_play.c - plays a script in place of a user: its steps become events, and its clock the viewer's. */
#define _POSIX_C_SOURCE 200809L /* strdup */
#include "view/view_app.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/result.h"

/* Timeout of a step, s. */
static double patience_of(const view_step *s)
{
    const double patience_s = 60.0;
    return s->kind == VIEW_STEP_TRACE && s->numbers[1] > 0.0 ? s->numbers[1] : patience_s;
}

static void drag(view_app *a, const view_step *s)
{
    const double *n = s->numbers;
    view_event event = {
        .kind = VIEW_PRESS, .button = s->button, .modifiers = s->modifiers, .x = n[0], .y = n[1]};
    view_queue_put(&a->queue, event);
    event.kind = VIEW_MOVE;
    event.x = n[2];
    event.y = n[3];
    view_queue_put(&a->queue, event);
    event.kind = VIEW_RELEASE;
    view_queue_put(&a->queue, event);
}

static void give_up(view_app *a, const view_step *s)
{
    char what[96] = "the model";
    if (s->kind == VIEW_STEP_TRACE) {
        view_trace_state trace = view_trace_get(a->traced[1].tracer);
        uint32_t wanted = s->numbers[0] > 0.0 ? (uint32_t)fmin(s->numbers[0], 4e9) : trace.wanted;
        snprintf(what, sizeof what, "the path traced image (%u of %u samples)", trace.samples, wanted);
    }
    a->result = fail(&a->error, FACET_ERROR_LIMIT, "%s: line %u: %s did not come within %g s",
                     a->desc->script, s->line, what, patience_of(s));
}

/* Whether a side has the samples that a step waits for. */
static bool is_traced(view_app *a, const view_step *s, int side)
{
    const view_traced *t = &a->traced[side];
    view_trace_state trace = view_trace_get(t->tracer);
    if (trace.error.result != FACET_OK) {
        a->result = trace.error.result;
        a->error = trace.error;
    }
    return t->is_current && (trace.is_done || (s->numbers[0] > 0.0 && t->samples >= s->numbers[0]));
}

/* Whether a step's condition holds. */
static bool is_ready(view_app *a, const view_step *s)
{
    switch (s->kind) {
    case VIEW_STEP_LOAD:
        return a->scene && !view_load_is_busy(a->loader);
    case VIEW_STEP_RELOAD:
        return a->reload_count > a->script_reload_count;
    case VIEW_STEP_TRACE:
        return is_traced(a, s, 1) &&
               (!(view_state_accumulating_sides(&a->state) & VIEW_SIDE_LEFT) || is_traced(a, s, 0));
    default:
        return true;
    }
}

static void save(view_app *a, const view_step *s)
{
    facet_result result = view_shot_save(a, s->path, s->kind == VIEW_STEP_WINDOW, &a->error);
    if (result != FACET_OK)
        a->result = result;
}

static void play_step(view_app *a, const view_step *s)
{
    switch (s->kind) {
    case VIEW_STEP_KEY:
        view_queue_put(&a->queue, (view_event){.kind = VIEW_KEY, .key = s->key, .modifiers = s->modifiers});
        break;
    case VIEW_STEP_DRAG:
        drag(a, s);
        break;
    case VIEW_STEP_SCROLL:
        view_queue_put(&a->queue, (view_event){.kind = VIEW_SCROLL,
                                               .x = s->numbers[0],
                                               .y = s->numbers[1],
                                               .modifiers = s->modifiers});
        break;
    case VIEW_STEP_DROP:
        view_queue_put(&a->queue, (view_event){.kind = VIEW_DROP, .path = strdup(s->path)});
        break;
    case VIEW_STEP_SIZE:
        view_window_resize(a->window, (uint32_t)fmin(fmax(s->numbers[0], 1.0), 16384.0),
                           (uint32_t)fmin(fmax(s->numbers[1], 1.0), 16384.0));
        break;
    case VIEW_STEP_WAIT:
        a->time_s += s->numbers[0];
        a->needs_image = view_state_advance(&a->state, s->numbers[0]) || a->needs_image;
        break;
    case VIEW_STEP_IMAGE:
    case VIEW_STEP_WINDOW:
        save(a, s);
        break;
    case VIEW_STEP_PRINT:
        view_shot_print(a);
        break;
    case VIEW_STEP_MINIMISE:
    case VIEW_STEP_RESTORE:
        view_window_minimise(a->window, s->kind == VIEW_STEP_MINIMISE);
        break;
    case VIEW_STEP_CLOSE:
        view_queue_put(&a->queue, (view_event){.kind = VIEW_CLOSE});
        break;
    default:
        break;
    }
}

bool view_play(view_app *a)
{
    if (!a->scene || !a->is_shown || a->script_at >= a->script.count || a->result != FACET_OK)
        return false;
    const view_step *s = &a->script.steps[a->script_at];
    if (!is_ready(a, s)) {
        if (a->script_wait_s == 0.0)
            a->script_wait_s = clock_seconds() + patience_of(s);
        else if (clock_seconds() > a->script_wait_s && a->result == FACET_OK)
            give_up(a, s);
        return false;
    }
    a->script_wait_s = 0.0;
    if (s->kind == VIEW_STEP_RELOAD)
        a->script_reload_count = a->reload_count;
    play_step(a, s);
    a->script_at++;
    return true;
}
