/* gltf_test_support.h - small models for tests, from JSON written with ' for " and a binary chunk. */
#ifndef IO_GLTF_TEST_SUPPORT_H
#define IO_GLTF_TEST_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "io/gltf/gltf.h"

/* Bytes of a binary chunk that grow. */
typedef struct test_bin {
    unsigned char bytes[4096];
    size_t size;
} test_bin;

/* Appends at the next multiple of 4; returns where. */
size_t bin_add(test_bin *bin, const void *bytes, size_t size);

/* Loads "{'asset':{'version':'2.0'},'buffers':[{'byteLength':SIZE}], BODY}" as a .glb with that chunk
 * (NULL: none). */
facet_result try_load(const char *body, const test_bin *bin, facet_scene **scene, facet_error *error);
/* The same, which must succeed. */
facet_scene *load(const char *body, const test_bin *bin);
/* The same, which must succeed with a warning that contains text. */
void assert_left_out(const char *body, const test_bin *bin, const char *text);
/* The same, which must fail with that result and a message that contains text. Where the body has no
 * nodes, one uses the first mesh, or the first material. */
void assert_refused(const char *body, const test_bin *bin, facet_result result, const char *text);
/* Whether a warning or a note of scene contains text. */
bool has_warning(const facet_scene *scene, const char *text);
bool has_note(const facet_scene *scene, const char *text);
/* The first primitive. */
const scene_primitive *first_primitive(const facet_scene *scene);
/* Loads JSON text unchanged, with ' for ", as a .gltf. */
facet_result try_load_text(const char *json, facet_scene **scene, facet_error *error);

/* ---- models with arrays ---- */

/* Arrays that become accessors, each in its own buffer view. */
typedef struct test_model {
    test_bin bin;
    char views[4096], accessors[4096];
    uint32_t count;
} test_model;

/* Adds count elements of a type ("VEC3") whose components are of size bytes and number component (5126:
 * float); members: more members of the accessor (",'normalized':true"). Returns its number. */
uint32_t model_add(test_model *model, const void *elements, size_t count, const char *type,
                   unsigned component, const char *members);
uint32_t model_add_floats(test_model *model, const float *floats, size_t count, const char *type);
/* load() and try_load() of BODY (a format) with the model's buffer views and accessors. */
facet_scene *model_load(const test_model *model, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void model_assert_left_out(const test_model *model, const char *text, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void model_assert_refused(const test_model *model, const char *text, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* A model from the shared test data, "animation/Fox.glb"; skips the test where there is none. */
facet_scene *load_shared(const char *path);

/* Each of count pairs. */
#define assert_floats(actual, expected, count, tolerance)                                                    \
    do {                                                                                                     \
        for (size_t i_ = 0; i_ < (count); i_++)                                                              \
            assert_near((actual)[i_], (expected)[i_], tolerance);                                            \
    } while (0)

#endif
