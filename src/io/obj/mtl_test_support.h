/* mtl_test_support.h - libraries of materials for tests, in a folder of their own. */
#ifndef IO_MTL_TEST_SUPPORT_H
#define IO_MTL_TEST_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "io/obj/mtl.h"

/* A new folder for a test; test_folder_remove() at its end. */
typedef struct test_folder {
    char path[64];
} test_folder;

test_folder test_folder_make(void);
void test_folder_remove(const test_folder *folder);
/* "FOLDER/name" in a buffer that the next but three calls use again. */
const char *test_path(const test_folder *folder, const char *name);
void test_put(const test_folder *folder, const char *name, const void *bytes, size_t size);
void test_put_text(const test_folder *folder, const char *name, const char *string);
/* A PNG image of one texel. */
void test_put_png(const test_folder *folder, const char *name);
/* The text of a file with 0 behind it; free() it. */
char *test_get(const test_folder *folder, const char *name);

/* A scene with the materials of an mtllib statement; must succeed. desc NULL: {0}. */
facet_scene *mtl_load(const char *folder, const char *names, const facet_scene_desc *desc);
/* One library "a.mtl" of that text. */
facet_scene *mtl_load_text(const char *string, const facet_scene_desc *desc);
/* Number index of the scene. */
const legacy_material *mtl_get(const facet_scene *scene, uint32_t index);
/* How many warnings contain string. */
int mtl_count_warnings(const facet_scene *scene, const char *string);

#endif
