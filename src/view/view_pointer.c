/* view_pointer.c - what the pointer changes of a view_state. */
#include "view/view_camera.h"
#include "view/view_state.h"

/* model-viewer's and Blender's habits: left and middle orbit; right, or either with shift, moves; with control comes
 * nearer. */
static void drag(view_state *s, double dx, double dy, unsigned modifiers)
{
    view_state_leave_file_camera(s);
    s->is_framed = false;
    if (modifiers & VIEW_CONTROL)
        view_camera_dolly(&s->orbit, -dy * 40.0 / (s->height ? s->height : 1), (double)view_state_size(s));
    else if (s->button == VIEW_RIGHT_BUTTON || modifiers & VIEW_SHIFT)
        view_camera_pan(&s->orbit, dx, dy, s->height);
    else
        view_camera_turn(&s->orbit, dx, dy, s->height);
}

static void scroll(view_state *s, const view_event *e)
{
    const double pixels = 40.0 * (double)s->scale; /* of a step, of two fingers or a wheel */
    view_state_leave_file_camera(s);
    s->is_framed = false;
    if (e->modifiers & VIEW_SHIFT)
        view_camera_pan(&s->orbit, pixels * e->x, pixels * e->y, s->height);
    else if (e->modifiers & VIEW_ALT)
        view_camera_turn(&s->orbit, pixels * e->x, pixels * e->y, s->height);
    else
        view_camera_dolly(&s->orbit, e->y, (double)view_state_size(s));
}

bool view_state_point(view_state *s, const view_event *e)
{
    double dx = e->x - s->x;
    double dy = e->y - s->y;
    switch (e->kind) {
    case VIEW_PRESS:
        s->x = e->x;
        s->y = e->y;
        s->is_held = true;
        s->button = e->button;
        s->held_modifiers = e->modifiers;
        s->divider.is_dragged = e->button == VIEW_LEFT_BUTTON &&
                                view_divider_is_at(&s->divider, e->x, s->width, 8.0 * (double)s->scale);
        return false;
    case VIEW_RELEASE:
        s->is_held = s->is_held && e->button != s->button;
        s->divider.is_dragged = s->divider.is_dragged && s->is_held;
        return false;
    case VIEW_MOVE:
        s->x = e->x;
        s->y = e->y;
        if (!s->is_held || !s->scene || (dx == 0.0 && dy == 0.0))
            return false;
        if (s->divider.is_dragged)
            view_divider_drag(&s->divider, e->x, s->width);
        else
            drag(s, dx, dy, s->held_modifiers);
        return true;
    case VIEW_SCROLL:
        if (s->scene)
            scroll(s, e);
        return s->scene != NULL;
    default:
        return false;
    }
}
