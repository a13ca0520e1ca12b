/* ogl1_test_support.h - documents of rgl's parameters for tests, written with ' for ", and a folder for
 * them. */
#ifndef IO_OGL1_TEST_SUPPORT_H
#define IO_OGL1_TEST_SUPPORT_H

#include "io/gltf/gltf_test_support.h"
#include "io/ogl1/ogl1_json.h"

/* Loads JSON text from memory. */
facet_result ogl1_try(const char *json, facet_scene **scene, facet_error *error);
/* The same, which must succeed. */
facet_scene *ogl1_load(const char *json);
/* The same, which must fail with that result and a message that contains both texts. */
void ogl1_assert_refused(const char *json, facet_result result, const char *place, const char *what);
void ogl1_assert_color(const float color[3], unsigned rgb); /* 0xrrggbb */

/* A temporary_folder as *state, for each test. */
int ogl1_folder_create(void **state);
int ogl1_folder_remove(void **state);
const char *ogl1_write_json(const temporary_folder *f, const char *name, const char *json);

#endif
