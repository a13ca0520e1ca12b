/* gl_timers.c - see gl_timers.h. A ring of pending queries, so that nothing waits for the GPU. */
#include "gl/core/gl_timers.h"

#include "gl/core/gl_api.h"

const char *gl_timer_name(gl_timer timer)
{
    static const char *const names[GL_TIMER_COUNT] = {"shadows",      "opaque",  "background",
                                                      "transmission", "blended", "bloom",
                                                      "resolve",      "layers",  "present"};
    return names[timer];
}

static bool has_answer(const gl_timers *t)
{
    GLuint is_available = 0;
    glGetQueryObjectuiv(t->ring[t->first].query, GL_QUERY_RESULT_AVAILABLE, &is_available);
    return is_available;
}

/* Takes the result of the oldest query, waiting for it. */
static void take(gl_timers *t)
{
    const uint64_t ns = gl_api_query_ns(t->context->is_es, t->ring[t->first].query);
    t->sum.ms[t->ring[t->first].timer] += 1e-6 * (double)ns;
    if (t->ring[t->first].ends_image) {
        t->last = t->sum;
        t->last.is_known = true;
        t->sum = (gl_times){.is_known = false};
    }
    t->first = (t->first + 1) % GL_TIMERS_PENDING;
    t->count--;
}

void gl_timers_begin(gl_timers *t, gl_timer timer)
{
    if (!t->context->has_timer_query)
        return;
    if (t->count == GL_TIMERS_PENDING)
        take(t);
    uint32_t place = (t->first + t->count) % GL_TIMERS_PENDING;
    if (!t->ring[place].query)
        glGenQueries(1, &t->ring[place].query);
    t->ring[place].timer = timer;
    t->ring[place].ends_image = false;
    glBeginQuery(GL_TIME_ELAPSED, t->ring[place].query);
    t->is_running = true;
}

void gl_timers_end(gl_timers *t)
{
    if (!t->is_running)
        return;
    glEndQuery(GL_TIME_ELAPSED);
    t->is_running = false;
    t->count++;
}

gl_times gl_timers_finish(gl_timers *t, bool waits)
{
    gl_timers_end(t);
    if (t->count)
        t->ring[(t->first + t->count - 1) % GL_TIMERS_PENDING].ends_image = true;
    while (t->count && (waits || has_answer(t)))
        take(t);
    return t->last;
}

void gl_timers_destroy(gl_timers *t)
{
    for (uint32_t i = 0; i < GL_TIMERS_PENDING; i++)
        if (t->ring[i].query)
            glDeleteQueries(1, &t->ring[i].query);
    *t = (gl_timers){.context = t->context};
}
