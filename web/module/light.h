/* light.h - environments by the words of --env, shared by all viewers that have the same one. */
#ifndef WEB_LIGHT_H
#define WEB_LIGHT_H

#include "cli/shared/environment_input.h"

typedef struct web_light web_light;

/* The environment of text, which is parsed already; a file is one of the table (files.h), or, once it is gone from there,
 * that of last (NULL is allowed). Fails as facet_environment_load(). */
facet_result web_light_create(const char *text, const environment_input *input,
                              const facet_environment_desc *desc, web_light *last, web_light **out,
                              facet_error *error);
/* That of a model, used by one viewer only. */
facet_result web_light_create_from_scene(const facet_scene *scene, const facet_pose_desc *pose,
                                         const facet_environment_desc *desc, web_light **out,
                                         facet_error *error);
void web_light_release(web_light *light); /* NULL is allowed */
/* The new value of last, the light of the last file, when a viewer takes light and its --env says text: a file stays while
 * others light the model for a time, as its own lights do. */
web_light *web_light_keep_file(web_light *light, web_light *last, const char *text);

facet_environment *web_light_get(const web_light *light); /* NULL: there is no light */

#endif
