/* budget.c - a limit on memory, warnings, progress and cancelling: budget MODEL */
#include <facet/facet.h>
#include <stdio.h>

static void print_message(void *user, facet_log_level level, const char *text)
{
    (void)user;
    fprintf(stderr, "%s: %s\n", level == FACET_LOG_LEVEL_WARNING ? "warning" : "note", text);
}

static bool is_wanted(void *user, const char *stage, double fraction)
{
    const bool *is_cancelled = user; /* set by another thread or a signal handler */
    printf("%s %3.0f %%\n", stage, 100.0 * fraction);
    return !*is_cancelled;
}

int main(int argc, char **argv)
{
    bool is_cancelled = false;
    facet_error error;
    facet_budget *budget = NULL;
    facet_scene *scene = NULL;
    facet_image *image = NULL;

    facet_result result = facet_budget_create(512u << 20, &budget, &error);
    if (result == FACET_OK) {
        const facet_scene_desc desc = {.allocator = facet_budget_allocator(budget),
                                       .log = {NULL, print_message}};
        result = facet_scene_load(argc > 1 ? argv[1] : "model.glb", &desc, &scene, &error);
    }
    if (result == FACET_OK) {
        const facet_render_desc desc = {.allocator = facet_budget_allocator(budget),
                                        .log = {NULL, print_message},
                                        .progress = {&is_cancelled, is_wanted},
                                        .width = 256,
                                        .height = 256};
        result = facet_render(scene, &desc, &image, &error);
        printf("at most %.1f MB\n", (double)facet_budget_peak_bytes(budget) / 1e6);
    }
    if (result == FACET_ERROR_MEMORY || result == FACET_ERROR_CANCELLED)
        printf("over the limit, or cancelled\n");
    if (result != FACET_OK)
        fprintf(stderr, "%s\n", error.message);

    facet_image_destroy(image);
    facet_scene_destroy(scene);
    facet_budget_destroy(budget); /* last */
    return result == FACET_OK ? 0 : 1;
}
