/* gl_program_test.c - the text of every program in every configuration that an image may need, through
 * glslangValidator where it is installed and through the drivers at hand. */
#define _XOPEN_SOURCE 700 /* mkdtemp */
#include <epoxy/gl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "gl/core/gl_blocks.h"
#include "gl/core/gl_program.h"

static const char *const versions[] = {"330", "300 es"};
static const uint32_t stages[] = {GL_VERTEX_SHADER, GL_FRAGMENT_SHADER};
enum { MAX_KEYS = 512, RANDOM_KEYS = 48, COMPILED_RANDOM_KEYS = 8 };

/* ---- configurations ---- */

/* Drops the textures beyond the number of units, the least important first, as gl_material.c does. */
static uint64_t drop_textures(uint64_t features)
{
    int8_t units[SCENE_TEXTURE_SLOT_COUNT];
    for (int i = 0; i < SCENE_TEXTURE_SLOT_COUNT; i++)
        if (gl_material_slot_units(features, units) > GL_MATERIAL_UNITS)
            features &= ~(UINT64_C(1) << (GL_SURFACE_TEXTURES + gl_slots_by_loss[i]));
    return features;
}

static uint64_t all_features(gl_main main)
{
    uint32_t count = gl_program_feature_count(main);
    assert_true(count < 64);
    return (UINT64_C(1) << count) - 1;
}

static uint64_t next_random(uint64_t *state) /* xorshift64*, Vigna 2016 */
{
    *state ^= *state >> 12;
    *state ^= *state << 25;
    *state ^= *state >> 27;
    return *state * UINT64_C(2685821657736338717);
}

/* No feature, each alone, all; then, for surfaces, each with the features of lit materials, and random sets. */
static size_t list_keys(gl_program_key keys[MAX_KEYS])
{
    size_t count = 0;
    uint64_t state = 1;
    for (gl_main main = 0; main < GL_MAIN_COUNT; main++) {
        uint64_t all = all_features(main);
        keys[count++] = (gl_program_key){main, 0};
        keys[count++] = (gl_program_key){main, main == GL_MAIN_SURFACE ? drop_textures(all) : all};
        for (uint32_t i = 0; i < gl_program_feature_count(main); i++)
            if (gl_program_feature_name(main, i)[0])
                keys[count++] = (gl_program_key){main, UINT64_C(1) << i};
        if (main != GL_MAIN_SURFACE)
            continue;
        uint64_t lit = UINT64_C(1) << GL_SURFACE_IS_LIT | GL_SURFACE_HAS_ENVIRONMENT | GL_SURFACE_HAS_LIGHTS |
                       GL_SURFACE_HAS_TANGENTS;
        for (uint32_t i = 0; i < gl_program_feature_count(main); i++)
            keys[count++] = (gl_program_key){main, lit | UINT64_C(1) << i};
        for (int i = 0; i < RANDOM_KEYS; i++)
            keys[count++] = (gl_program_key){main, drop_textures((lit | next_random(&state)) & all)};
    }
    assert_true(count <= MAX_KEYS);
    return count;
}

static text assemble(const char *version, gl_program_key key, uint32_t stage)
{
    text t = {.data = NULL};
    facet_error error;
    if (gl_program_text(version, key, stage, &t, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return t;
}

/* ---- compilers ---- */

static gl_api apis[] = {GL_API_CORE, GL_API_ES};

static int run_on_drivers(void (*check)(gl_context *context))
{
    int count = 0;
    for (int i = 0; i < 2; i++) {
        gl_context context;
        if (gl_context_create_api(&context, apis[i], NULL) != FACET_OK)
            continue;
        assert_int_equal(context.is_es, apis[i] == GL_API_ES);
        check(&context);
        gl_context_destroy(&context);
        count++;
    }
    if (count == 0)
        skip();
    return count;
}

static void compile_all(gl_context *context)
{
    static gl_program_key keys[MAX_KEYS];
    size_t count = list_keys(keys), kept = 0;
    gl_programs *programs;
    facet_error error;
    assert_int_equal(gl_programs_create(context, NULL, NULL, &programs, &error), FACET_OK);
    uint32_t surfaces = gl_program_feature_count(GL_MAIN_SURFACE);
    for (size_t i = 0; i < count; i++) { /* a sixth of the lit ones: glslangValidator takes all */
        bool is_rest = keys[i].main == GL_MAIN_SURFACE && i >= 2 + surfaces;
        if (i % (IS_SLOW ? 10 : is_rest ? 6 : 1) == 0)
            keys[kept++] = keys[i];
    }
    for (size_t i = 0; i < kept; i++)
        assert_int_equal(gl_programs_request(programs, keys[i], &error), FACET_OK);
    for (size_t i = 0; i < kept; i++) {
        uint32_t name, again;
        if (gl_programs_get(programs, keys[i], &name, &error) != FACET_OK)
            fail_msg("features %llx: %s", (unsigned long long)keys[i].features, error.message);
        assert_int_equal(gl_programs_get(programs, keys[i], &again, &error), FACET_OK);
        assert_int_equal(name, again);
    }
    gl_programs_destroy(programs);
    assert_int_equal(gl_context_check(context, "test", &error), FACET_OK);
}

static void drivers_compile_every_program(void **state)
{
    (void)state;
    run_on_drivers(compile_all);
}

/* A program that does not compile is reported in one sentence, with its numbered source in the log. */
static void compile_broken(gl_context *context)
{
    captured_messages messages = {.count = 0};
    const facet_log log = capture_log(&messages);
    gl_programs *programs;
    facet_error error;
    uint32_t name = 0;
    assert_int_equal(gl_programs_create(context, NULL, NULL, &programs, &error), FACET_OK);
    gl_programs_set_log(programs, &log);
    gl_programs_set_prelude(programs,
                            "precision highp float;\nfloat broken() { return no_such_function(1.0); }\n");
    gl_program_key key = {GL_MAIN_PRESENT, 0};
    assert_int_equal(gl_programs_get(programs, key, &name, &error), FACET_ERROR_SYSTEM);
    assert_non_null(strstr(error.message, "the shader \"present\" does not compile"));
    assert_non_null(strstr(error.message, "no_such_function"));
    assert_null(strchr(error.message, '\n'));
    assert_non_null(strstr(messages.text, "   1  #version "));
    const char *line = strstr(messages.text, "  float broken()");
    assert_non_null(line);
    int number = 0; /* the driver's line number is that of the log */
    while (line > messages.text && line[-1] != '\n')
        line--;
    number = atoi(line);
    assert_int_equal(number, 3);
    char place[32];
    snprintf(place, sizeof place, ":%d(", number); /* Mesa's format; other drivers have their own */
    if (strstr(context->name, "Mesa"))
        assert_non_null(strstr(error.message, place));
    assert_int_equal(gl_programs_get(programs, key, &name, &error), FACET_ERROR_SYSTEM);
    gl_programs_set_prelude(programs, NULL);
    key.main = GL_MAIN_BACKGROUND;
    assert_int_equal(gl_programs_get(programs, key, &name, &error), FACET_OK);
    gl_programs_destroy(programs);
}

static void compile_errors_come_with_the_source(void **state)
{
    (void)state;
    run_on_drivers(compile_broken);
}

/* Uniform blocks have the same layout in shaders and in C. */
static void check_frame_block(gl_context *context)
{
    static const struct {
        const char *name;
        size_t offset;
    } members[] = {{"eye", offsetof(gl_frame_block, eye)},
                   {"frame_size", offsetof(gl_frame_block, size)},
                   {"frame_light", offsetof(gl_frame_block, light)},
                   {"exposure", offsetof(gl_frame_block, exposure)},
                   {"channel", offsetof(gl_frame_block, channel)},
                   {"background_blur", offsetof(gl_frame_block, background_blur)},
                   {"far_depth", offsetof(gl_frame_block, far_depth)},
                   {"pixel_scale", offsetof(gl_frame_block, pixel_scale)},
                   {"is_draft", offsetof(gl_frame_block, is_draft)},
                   {"background", offsetof(gl_frame_block, background)}};
    gl_programs *programs;
    uint32_t name;
    facet_error error;
    assert_int_equal(gl_programs_create(context, NULL, NULL, &programs, &error), FACET_OK);
    assert_int_equal(gl_programs_get(programs, (gl_program_key){GL_MAIN_PRESENT, 0}, &name, &error),
                     FACET_OK);
    for (size_t i = 0; i < sizeof members / sizeof *members; i++) {
        GLuint index = GL_INVALID_INDEX;
        GLint offset = -1;
        const char *const names[] = {members[i].name};
        glGetUniformIndices(name, 1, names, &index);
        if (index == GL_INVALID_INDEX)
            fail_msg("the block Frame has no \"%s\"", members[i].name);
        glGetActiveUniformsiv(name, 1, &index, GL_UNIFORM_OFFSET, &offset);
        assert_int_equal(offset, (int)members[i].offset);
    }
    GLint size = 0;
    glGetActiveUniformBlockiv(name, glGetUniformBlockIndex(name, "Frame"), GL_UNIFORM_BLOCK_DATA_SIZE, &size);
    assert_int_equal(size, (int)sizeof(gl_frame_block));
    gl_programs_destroy(programs);
}

static void the_frame_block_has_the_same_layout_in_c_and_glsl(void **state)
{
    (void)state;
    run_on_drivers(check_frame_block);
}

/* ---- glslangValidator ---- */

static void write_text(const char *path, const text *t)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_int_equal(fwrite(t->data, 1, t->length, file), t->length);
    assert_int_equal(fclose(file), 0);
}

/* Every configuration, version and stage: the reference compiler rejects what is used before its
 * definition, which drivers may let through. One process with a thread per core (-t) takes all files. */
static void glslang_accepts_every_configuration(void **state)
{
    (void)state;
    static gl_program_key keys[MAX_KEYS];
    size_t count = list_keys(keys);
    if (system("command -v glslangValidator >/dev/null 2>&1") != 0) {
        print_message("skipped: glslangValidator (glslang-tools) is not installed\n");
        skip();
    }
    char folder[] = "/tmp/facet_gl_program_XXXXXX", path[160], command[256];
    assert_non_null(mkdtemp(folder));
    for (size_t i = 0; i < count; i += IS_SLOW ? 10 : 1)
        for (int k = 0; k < 4; k++) { /* version, stage */
            text t = assemble(versions[k >> 1], keys[i], stages[k & 1]);
            snprintf(path, sizeof path, "%s/%s_%llx_%d.%s", folder, gl_program_main_name(keys[i].main),
                     (unsigned long long)keys[i].features, k >> 1, k & 1 ? "frag" : "vert");
            write_text(path, &t);
            text_destroy(&t);
        }
    snprintf(command, sizeof command,
             "cd %s && glslangValidator -t *.vert *.frag >log || { grep -m 4 ERROR log; false; }", folder);
    assert_int_equal(system(command), 0);
    snprintf(command, sizeof command, "rm -r %s", folder);
    assert_int_equal(system(command), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(drivers_compile_every_program),
                                       cmocka_unit_test(compile_errors_come_with_the_source),
                                       cmocka_unit_test(the_frame_block_has_the_same_layout_in_c_and_glsl),
                                       cmocka_unit_test(glslang_accepts_every_configuration)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
