/* page_preview.h - the image of a model that stands for it in a page: rendered on the CPU by the options of the view; by OpenGL where only
 * that draws what they ask for, and it is there. */
#ifndef CLI_PAGE_PREVIEW_H
#define CLI_PAGE_PREVIEW_H

#include "cli/render/render_options.h"
#include "cli/shared/verb_run.h"

/* The environment of --env, read once for all models. {0} initially. */
typedef struct page_light {
    facet_environment *environment;
    bool is_read;
} page_light;

/* Renders the scene to a PNG, which facet_bytes_destroy() releases. name: the page, for messages. */
facet_result page_preview_render(verb_run *run, const render_options *options, page_light *light,
                                 facet_scene *scene, const char *model, const char *name, unsigned char **png,
                                 size_t *size, facet_error *error);

#endif
