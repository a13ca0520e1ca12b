/* gltf_test_support.h - small models for tests, from JSON written with ' for " and a binary chunk. */
#ifndef IO_GLTF_TEST_SUPPORT_H
#define IO_GLTF_TEST_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/near_test.h"
#include "io/gltf.h"

/* Bytes of a binary chunk that grow. */
typedef struct test_bin {
    unsigned char bytes[4096];
    size_t size;
} test_bin;

/* Appends at the next multiple of 4; returns where. */
size_t bin_add(test_bin *bin, const void *bytes, size_t size);

/* Loads "{'asset':{'version':'2.0'},'buffers':[{'byteLength':SIZE}], BODY}" as a .glb with that chunk (NULL: none). */
facet_result try_load(const char *body, const test_bin *bin, facet_scene **scene, facet_error *error);
/* The same, which must succeed. */
facet_scene *load(const char *body, const test_bin *bin);
/* The same, which must fail with that result and a message that contains text. */
void assert_refused(const char *body, const test_bin *bin, facet_result result, const char *text);
/* Whether a warning of scene contains text. */
bool has_warning(const facet_scene *scene, const char *text);
/* The first primitive. */
const scene_primitive *first_primitive(const facet_scene *scene);
/* Loads JSON text as it is, ' for ", as a .gltf. */
facet_result try_load_text(const char *json, facet_scene **scene, facet_error *error);

/* Each of count pairs. */
#define assert_floats(actual, expected, count, tolerance)                                                    \
    do {                                                                                                     \
        for (size_t i_ = 0; i_ < (count); i_++)                                                              \
            assert_near((actual)[i_], (expected)[i_], tolerance);                                            \
    } while (0)

#endif
