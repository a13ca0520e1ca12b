/* view.c - a window with a model, and optionally a script of input: view MODEL [SCRIPT] */
#include <facet/facet.h>
#include <stdio.h>

static void print_line(void *user, const char *text)
{
    (void)user;
    puts(text);
}

int main(int argc, char **argv)
{
    facet_error error;
    const char *const paths[] = {argc > 1 ? argv[1] : "model.glb"};
    const facet_view_desc desc = {.source = {.print = print_line},
                                  .paths = paths,
                                  .path_count = 1,
                                  .render = {.renderer = FACET_RENDERER_KIND_GL, .width = 640, .height = 480},
                                  .script = argc > 2 ? argv[2] : NULL};
    facet_result result = facet_view(&desc, &error); /* on the first thread, until the window is closed */
    if (result != FACET_OK)
        fprintf(stderr, "%s\n", error.message);
    return result == FACET_OK ? 0 : 1;
}
