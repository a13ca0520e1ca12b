/* mtl_test_support.h - files for tests, and libraries of materials from them. */
#ifndef IO_MTL_TEST_SUPPORT_H
#define IO_MTL_TEST_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "io/obj/mtl.h"

void test_put_text(const temporary_folder *folder, const char *name, const char *string);
/* The text of a file with 0 behind it; free() it. */
char *test_get(const temporary_folder *folder, const char *name);

/* Calls visit for every file below a folder whose name ends with extension; how many times it returned
 * true. */
int test_visit_files(const char *folder, const char *extension,
                     bool (*visit)(const char *folder, const char *name, void *context), void *context);

/* A scene with the materials of an mtllib statement; must succeed. desc NULL: {0}. */
facet_scene *mtl_load(const char *folder, const char *names, const facet_scene_desc *desc);
/* The same, from one library "a.mtl" of that text. */
facet_scene *mtl_load_text(const char *string, const facet_scene_desc *desc);
/* Number index of the scene. */
const legacy_material *mtl_get(const facet_scene *scene, uint32_t index);
/* How many warnings contain string. */
int mtl_count_warnings(const facet_scene *scene, const char *string);

#endif
