/* obj_test_support.h - small OBJ files as strings, for tests. */
#ifndef IO_OBJ_TEST_SUPPORT_H
#define IO_OBJ_TEST_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "io/obj/obj.h"

/* Loads bytes as test.obj; must succeed. desc NULL: {0}. */
facet_scene *obj_load_text(const char *bytes, const facet_scene_desc *desc);
/* Loads obj/... or malformed/obj/... of the shared test data; skips the test where there is none. */
facet_scene *obj_load_shared(const char *path);

/* Whether a warning contains text. */
bool obj_has_warning(const facet_scene *scene, const char *text);
/* The primitives of a mesh of that name, which must be there once. */
const scene_mesh *obj_find_mesh(const facet_scene *scene, const char *name);
/* The only primitive of the only mesh. */
const scene_primitive *obj_only_primitive(const facet_scene *scene);
/* Position, normal, texture coordinate of corner i. */
const float *obj_position(const scene_primitive *p, size_t i);
const float *obj_normal(const scene_primitive *p, size_t i);
const float *obj_texcoord(const scene_primitive *p, size_t i);
/* The sum of the areas of all triangles. */
double obj_area(const scene_primitive *p);
/* All that scene.h promises of primitives, meshes and nodes. */
void obj_check_scene(const facet_scene *scene);
/* Fails where one bit of geometry, structure or a warning differs. */
void obj_assert_equal(const facet_scene *a, const facet_scene *b);

#endif
