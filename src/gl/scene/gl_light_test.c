/* gl_light_test.c - shaders look up the same light and LUTs as the CPU: the same directions and
 * roughnesses through a program and through light_setup.h, with OpenGL and OpenGL ES. Exits with 77 where
 * there is neither. */
#include <epoxy/gl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "tests/support/support.h"
#include "gl/scene/gl_light.h"
#include "gl/core/gl_program.h"
#include "ibl/light_fixture.h"

#include "shade/shade.h"

enum { EDGE = 64, COUNT = EDGE * EDGE };

/* A context, the light under test, and the input and output rows of a program. */
typedef struct bench {
    gl_context context;
    gl_light *light;
    GLuint target, framebuffer, input, frame, array;
    float in[COUNT][4], out[COUNT][4];
} bench;

static bench on[2]; /* OpenGL, OpenGL ES */
static int bench_count;

static GLuint float_texture(void)
{
    GLuint name;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, EDGE, EDGE, 0, GL_RGBA, GL_FLOAT, NULL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return name;
}

/* False: there is no such context. */
static bool bench_create(bench *b, gl_api api)
{
    if (gl_context_create_api(&b->context, api, NULL) != FACET_OK)
        return false;
    if (!b->context.has_float_target) {
        gl_context_destroy(&b->context);
        return false;
    }
    assert_int_equal(gl_light_create(&b->context, NULL, &b->light, NULL), FACET_OK);
    b->target = float_texture();
    b->input = float_texture();
    glGenFramebuffers(1, &b->framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, b->framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, b->target, 0);
    glGenBuffers(1, &b->frame);
    glGenVertexArrays(1, &b->array);
    return true;
}

static void bench_destroy(bench *b)
{
    if (gl_context_make_current(&b->context, NULL) == FACET_OK)
        gl_light_destroy(b->light);
    gl_context_destroy(&b->context);
}

/* ---- programs ---- */

static const char light_loop[] =
    "vec3 lights_sum(vec3 P)\n{\n    vec3 sum = vec3(0.0);\n    int count = light_count(P);\n"
    "    for (int i = 0; i < count; i++)\n"
    "        sum += light_illuminate(light_at(i), P).E;\n    return sum;\n}\n";

/* The fragment shader of a main up to and including the file `last`, followed by `expression` of vec4 q. */
static char *shader_text(const bench *b, gl_program_key key, const char *last, const char *expression)
{
    text t = {0};
    char head[64];
    assert_int_equal(gl_program_text(b->context.glsl_version, key, GL_FRAGMENT_SHADER, &t, NULL), FACET_OK);
    snprintf(head, sizeof head, "/* %s - ", last);
    char *end = strstr(t.data, head);
    assert_non_null(end);
    for (end++; *end; end++) { /* to the first comment of the next file */
        char name[40], extension[8];
        if (sscanf(end, "/* %39[a-z_].%4[a-z] - ", name, extension) == 2 && strstr(end, extension))
            break;
    }
    *end = 0;
    size_t size = strlen(t.data) + strlen(expression) + sizeof light_loop + 300;
    char *source = malloc(size);
    assert_non_null(source);
    snprintf(source, size,
             "%s\n%suniform highp sampler2D u_input;\nout vec4 probe;\nvoid main()\n{\n"
             "    vec4 q = texelFetch(u_input, ivec2(gl_FragCoord.xy), 0);\n    probe = vec4(%s);\n}\n",
             t.data, strcmp(last, "lights.glsl") == 0 ? light_loop : "", expression);
    text_destroy(&t);
    return source;
}

static GLuint compile(GLenum stage, const char *source)
{
    GLuint shader = glCreateShader(stage);
    GLint is_good = 0;
    glShaderSource(shader, 1, &source, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &is_good);
    if (!is_good) {
        char log[2048];
        glGetShaderInfoLog(shader, sizeof log, NULL, log);
        fail_msg("%s", log);
    }
    return shader;
}

static void bind_names(GLuint program)
{
    static const struct {
        const char *name;
        GLint unit;
    } samplers[] = {{"u_environment", GL_UNIT_ENVIRONMENT}, {"u_sharp", GL_UNIT_SHARP},
                    {"u_tables", GL_UNIT_TABLES},           {"u_glass", GL_UNIT_GLASS},
                    {"u_lights", GL_UNIT_LIGHTS},           {"u_input", GL_UNIT_MATERIAL}};
    glUseProgram(program);
    for (size_t i = 0; i < sizeof samplers / sizeof *samplers; i++)
        glUniform1i(glGetUniformLocation(program, samplers[i].name), samplers[i].unit);
    GLuint index = glGetUniformBlockIndex(program, "Frame");
    if (index != GL_INVALID_INDEX)
        glUniformBlockBinding(program, index, GL_BLOCK_FRAME);
    index = glGetUniformBlockIndex(program, "Lighting");
    if (index != GL_INVALID_INDEX)
        glUniformBlockBinding(program, index, GL_BLOCK_LIGHT);
}

/* Evaluates expression per row of in. eye: of the frame. */
static void run(bench *b, gl_program_key key, const char *last, const char *expression, const float eye[3])
{
    static const char vertex[] = "void main()\n{\n    vec2 p = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
                                 "    gl_Position = vec4(p * 4.0 - 1.0, 0.0, 1.0);\n}\n";
    char head[400];
    char *source = shader_text(b, key, last, expression);
    snprintf(head, sizeof head, "#version %s\n%s", b->context.glsl_version, vertex);
    GLuint shaders[2] = {compile(GL_VERTEX_SHADER, head), compile(GL_FRAGMENT_SHADER, source)};
    GLuint program = glCreateProgram();
    free(source);
    for (int i = 0; i < 2; i++) {
        glAttachShader(program, shaders[i]);
        glDeleteShader(shaders[i]);
    }
    glLinkProgram(program);
    bind_names(program);
    gl_frame_block frame = {.eye = {eye[0], eye[1], eye[2]}};
    gl_light_bind(b->light, &frame);
    glBindBuffer(GL_UNIFORM_BUFFER, b->frame);
    glBufferData(GL_UNIFORM_BUFFER, sizeof frame, &frame, GL_DYNAMIC_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, GL_BLOCK_FRAME, b->frame);
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_MATERIAL);
    glBindTexture(GL_TEXTURE_2D, b->input);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, EDGE, EDGE, GL_RGBA, GL_FLOAT, b->in);
    glBindFramebuffer(GL_FRAMEBUFFER, b->framebuffer);
    glViewport(0, 0, EDGE, EDGE);
    glBindVertexArray(b->array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glReadPixels(0, 0, EDGE, EDGE, GL_RGBA, GL_FLOAT, b->out);
    glDeleteProgram(program);
    facet_error error = {0};
    if (gl_context_check(&b->context, "the test", &error) != FACET_OK)
        fail_msg("%s", error.message);
}

/* ---- comparison ---- */

static facet_result update(gl_light *light, const light_setup *setup)
{
    return gl_light_update(light, setup, &(facet_render_desc){0}, (float[3]){0.0f},
                           (float[3]){1.0f, 1.0f, 1.0f}, NULL);
}

static uint32_t random_state = 1;
static float uniform_number(float low, float high)
{
    lcg_next(&random_state);
    return low + (high - low) * (float)(random_state >> 8) * 0x1p-24f;
}

/* Directions evenly over the sphere, along its axes and the cube's edges; w: in [0, 1], often its ends. */
static void fill_directions(bench *b)
{
    for (int i = 0; i < COUNT; i++) {
        float *q = b->in[i];
        test_direction(i, COUNT, q);
        if (i % 64 == 0) {
            vec3 d = normalize(
                vec3((float)(i / 64 % 3) - 1.0f, (float)(i / 192 % 3) - 1.0f, (float)(i / 576 % 3) - 1.0f));
            for (int k = 0; k < 3; k++)
                q[k] = i / 64 % 27 == 13 ? (float)(k == 1) : d[k];
        }
        q[3] = i % 16 == 0 ? 0.0f : i % 16 == 8 ? 1.0f : uniform_number(0.0f, 1.0f);
    }
}

typedef void lookup(const light_setup *setup, const float d[3], float x, float out[3]);

static void look_up_specular(const light_setup *setup, const float d[3], float x, float out[3])
{
    light_specular(setup, d, x, out);
}

static void look_up_sheen(const light_setup *setup, const float d[3], float x, float out[3])
{
    light_sheen(setup, d, x, out);
}

static void look_up_irradiance(const light_setup *setup, const float d[3], float x, float out[3])
{
    (void)x;
    light_irradiance_over_pi(setup, d, out);
}

static void look_up_background(const light_setup *setup, const float d[3], float x, float out[3])
{
    (void)x;
    light_background(setup, d, 0.0f, out);
}

/* How much a lookup changes within 1e-4 rad, a 60th of the finest texel: OpenGL may round the position of
 * a lookup to a 512th of a texel. */
static void find_slack(const light_setup *setup, lookup *on_cpu, const float q[4], const float expected[3],
                       float slack[3])
{
    slack[0] = slack[1] = slack[2] = 0.0f;
    for (int i = 0; i < 6; i++) {
        vec3 d = vec3(q[0], q[1], q[2]);
        d[i / 2] += i & 1 ? 1e-4f : -1e-4f;
        d = normalize(d);
        float moved[3];
        on_cpu(setup, (float[3]){d[0], d[1], d[2]}, q[3], moved);
        for (int k = 0; k < 3; k++)
            slack[k] = max(slack[k], fabsf(moved[k] - expected[k]));
    }
}

/* Half floats are accurate to 2^-11 (4.9e-4) or 2^-40 of the brightest texel (gl_light_atlas.h), and a
 * lookup is a mean of texels that are not negative: 1e-3 covers that and sums in another order. */
static void compare(bench *b, const light_setup *setup, lookup *on_cpu, const char *expression,
                    float brightest)
{
    float worst = 0.0f;
    int where = 0;
    run(b, (gl_program_key){GL_MAIN_BACKGROUND, GL_BACKGROUND_HAS_ENVIRONMENT}, "environment.glsl",
        expression, (float[3]){0.0f, 0.0f, 0.0f});
    for (int i = 0; i < COUNT; i++) {
        const float *q = b->in[i];
        float expected[3], slack[3];
        on_cpu(setup, q, q[3], expected);
        find_slack(setup, on_cpu, q, expected, slack);
        for (int k = 0; k < 3; k++) {
            float allowed = 1e-3f * expected[k] + slack[k] + 0x1p-40f * brightest;
            float error = fabsf(b->out[i][k] - expected[k]) / max(allowed, 1e-30f);
            if (!(error <= worst)) {
                worst = error;
                where = i;
            }
        }
    }
    if (!(worst <= 1.0f))
        fail_msg("%s: %g times what is allowed off (%g) at direction %g %g %g, %g", expression, (double)worst,
                 (double)b->out[where][0], (double)b->in[where][0], (double)b->in[where][1],
                 (double)b->in[where][2], (double)b->in[where][3]);
}

/* A colored sky with hills, 1 to 3. */
static void gentle(const float d[3], float out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = 2.0f + sin(7.0f * d[k] + 3.0f * d[(k + 1) % 3]) * cos(5.0f * d[(k + 2) % 3]);
}

/* The same over black ground, with a sun a million times as bright. */
static void harsh(const float d[3], float out[3])
{
    bool is_sun = d[0] * 0.6f + d[1] * 0.64f + d[2] * 0.48f > 0.999f;
    gentle(d, out);
    for (int k = 0; k < 3; k++)
        out[k] = is_sun ? 2e6f : d[1] < -0.2f ? 0.0f : out[k];
}

static light_setup prepare_setup(facet_environment *e, ibl_light_desc desc)
{
    return (light_setup){.ibl = prepare(e, desc),
                         .has_irradiance = desc.needs_irradiance,
                         .has_specular = desc.needs_specular,
                         .has_sheen = desc.needs_sheen,
                         .has_background = desc.needs_background,
                         .scale = 0.75f,
                         .rotation_cos = cos(1.0f),
                         .rotation_sin = sin(1.0f)};
}

static void compare_all(bench *b, const light_setup *setup, float brightest)
{
    assert_int_equal(update(b->light, setup), FACET_OK);
    fill_directions(b);
    compare(b, setup, look_up_specular, "light_specular(q.xyz, q.w), 1.0", brightest);
    compare(b, setup, look_up_sheen, "light_sheen(q.xyz, q.w), 1.0", brightest);
    compare(b, setup, look_up_irradiance, "light_irradiance_over_pi(q.xyz), 1.0", brightest);
    compare(b, setup, look_up_background, "light_background(q.xyz), 1.0", brightest);
    for (int i = 0; i < COUNT; i++) /* the transition from the unfiltered image to the first level */
        b->in[i][3] *= 0.2f;
    compare(b, setup, look_up_specular, "light_specular(q.xyz, q.w), 1.0", brightest);
}

static const ibl_light_desc everything = {.needs_irradiance = true,
                                          .needs_specular = true,
                                          .max_roughness = 1.0f,
                                          .needs_sheen = true,
                                          .max_sheen_roughness = 1.0f,
                                          .needs_background = true};

static void environment_lookups_match_the_cpu(void **state)
{
    (void)state;
    facet_environment *e = make_environment(1024, 512, gentle);
    light_setup setup = prepare_setup(e, everything);
    for (int i = 0; i < bench_count; i++) {
        assert_int_equal(gl_context_make_current(&on[i].context, NULL), FACET_OK);
        compare_all(&on[i], &setup, 3.0f);
    }
    light_setup_destroy(&setup);
    facet_environment_destroy(e);
}

static void dark_texels_beside_a_sun_stay_accurate(void **state)
{
    (void)state;
    facet_environment *e = make_environment(600, 301, harsh); /* a size that cannot be halved */
    light_setup setup = prepare_setup(e, everything);
    for (int i = 0; i < bench_count; i++) {
        assert_int_equal(gl_context_make_current(&on[i].context, NULL), FACET_OK);
        compare_all(&on[i], &setup, 2e6f);
    }
    light_setup_destroy(&setup);
    facet_environment_destroy(e);
}

/* Roughness beyond the prepared levels uses the last level; unprepared light is black. */
static void missing_levels_are_as_on_the_cpu(void **state)
{
    (void)state;
    static const ibl_light_desc some[] = {
        {.needs_specular = true, .min_roughness = 0.35f, .max_roughness = 0.6f},
        {.needs_specular = true}, /* sharp reflections */
        {.needs_sheen = true,
         .min_sheen_roughness = 0.3f,
         .max_sheen_roughness = 0.3f,
         .needs_background = true},
        {.needs_irradiance = true}};
    facet_environment *e[2] = {make_environment(64, 32, gentle), make_environment(40, 20, gentle)};
    for (int i = 0; i < bench_count; i++) {
        assert_int_equal(gl_context_make_current(&on[i].context, NULL), FACET_OK);
        /* the atlas keeps what it has, and is replaced where something is missing */
        for (int k = 0; k < 8; k++) {
            light_setup setup = prepare_setup(e[k / 4], some[k % 4]);
            compare_all(&on[i], &setup, 3.0f);
            light_setup_destroy(&setup);
        }
    }
    facet_environment_destroy(e[0]);
    facet_environment_destroy(e[1]);
}

/* ---- tables ---- */

static void albedo_luts_match_the_cpu(void **state)
{
    (void)state;
    light_setup none = {.scale = 1.0f};
    for (int i = 0; i < bench_count; i++) {
        bench *b = &on[i];
        assert_int_equal(gl_context_make_current(&b->context, NULL), FACET_OK);
        assert_int_equal(update(b->light, &none), FACET_OK);
        for (int k = 0; k < COUNT; k++) {
            float *q = b->in[k];
            for (int c = 0; c < 2; c++)
                q[c] = k % 8 == c ? (float)(k / 8 % 2) : uniform_number(0.0f, 1.0f);
            q[2] = k % 32 == 4 ? 1.0f : k % 2 ? uniform_number(0.08f, 1.0f) : uniform_number(1.0f, 12.0f);
        }
        gl_program_key key = {GL_MAIN_BACKGROUND, 0};
        float origin[3] = {0.0f, 0.0f, 0.0f};
        run(b, key, "environment.glsl", "table_dfg(q.x, q.y), table_sheen_albedo(q.x, q.y), 1.0", origin);
        for (int k = 0; k < COUNT; k++) {
            const float *q = b->in[k];
            float dfg[2];
            ibl_dfg(q[0], q[1], dfg);
            assert_near(b->out[k][0], dfg[0], 1e-3f * dfg[0] + 1e-6f);
            assert_near(b->out[k][1], dfg[1], 1e-3f * dfg[1] + 1e-6f);
            float E = ibl_sheen_albedo(q[0], q[1]);
            assert_near(b->out[k][2], E, 1e-3f * E + 1e-6f);
        }
        run(b, key, "environment.glsl", "table_glass(q.x, q.y, q.z), 1.0", origin);
        for (int k = 0; k < COUNT; k++) {
            const float *q = b->in[k];
            float expected[3];
            ibl_glass(q[0], q[1], q[2], expected);
            for (int c = 0; c < 3; c++)
                assert_near(b->out[k][c], expected[c], 1e-3f * expected[c] + 1e-6f);
        }
    }
}

/* ---- punctual lights ---- */

enum { LIGHTS = 1000 };

/* Lights of all kinds in a box of 20 m around (30, 0, 0), few of which reach far. */
static void make_lights(light_setup *setup, uint32_t count, bool have_range)
{
    setup->punctual = mem_alloc(NULL, count, sizeof *setup->punctual);
    assert_non_null(setup->punctual);
    setup->punctual_count = count;
    for (uint32_t i = 0; i < count; i++) {
        vec3 at =
            vec3(uniform_number(20.0f, 40.0f), uniform_number(-10.0f, 10.0f), uniform_number(-10.0f, 10.0f));
        vec3 color = vec3(uniform_number(0.0f, 2.0f), uniform_number(0.0f, 2.0f), 1.0f);
        float range = have_range && i % 100 ? uniform_number(0.5f, 3.0f) : 0.0f;
        vec3 down = normalize(vec3(0.1f, -1.0f, uniform_number(-0.5f, 0.5f)));
        Light *l = &setup->punctual[i];
        *l = light_point(at, color, range);
        if (i % 3 == 1)
            *l = light_spot(at, down, color * 3.0f, range, 0.3f, 0.9f);
        if (i % 200 == 50)
            *l = light_directional(down, color * 0.01f);
    }
    assert_int_equal(light_grid_create(setup->punctual, count, NULL, &setup->grid, NULL), FACET_OK);
}

/* Irradiance of a surface that faces each of the lights, and the number of lights evaluated. */
static const char *const sum_of_lights = "lights_sum(q.xyz), float(light_count(q.xyz))";

static double compare_lights(bench *b, const light_setup *setup)
{
    const float eye[3] = {31.0f, -3.0f, 7.0f};
    double looked_at = 0.0;
    assert_int_equal(update(b->light, setup), FACET_OK);
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < 3; k++)
            b->in[i][k] = uniform_number(-14.0f, 14.0f); /* some outside the box */
    run(b, (gl_program_key){GL_MAIN_SURFACE, GL_SURFACE_HAS_LIGHTS}, "lights.glsl", sum_of_lights, eye);
    for (int i = 0; i < COUNT; i++) {
        vec3 P = vec3(b->in[i][0] + eye[0], b->in[i][1] + eye[1], b->in[i][2] + eye[2]);
        vec3 sum = vec3(0.0f);
        for (uint32_t k = 0; k < setup->punctual_count; k++)
            sum += light_illuminate(setup->punctual[k], P).E;
        for (int k = 0; k < 3; k++) /* a point near 30 m is known to 2e-6 m */
            assert_near(b->out[i][k], sum[k], 1e-3f * sum[k] + 1e-3f);
        looked_at += (double)b->out[i][3] / COUNT;
    }
    return looked_at;
}

static void punctual_lights_match_the_cpu(void **state)
{
    (void)state;
    for (int i = 0; i < bench_count; i++) {
        assert_int_equal(gl_context_make_current(&on[i].context, NULL), FACET_OK);
        light_setup setup = {.scale = 1.0f};
        make_lights(&setup, LIGHTS, true);
        /* 10 lights have no range, 5 no position; the spheres of 12 others reach a point of the box, the
         * bounding boxes of their cells some more. */
        double looked_at = compare_lights(&on[i], &setup);
        assert_true(looked_at > 10.0 && looked_at < 100.0);
        light_setup_destroy(&setup);
        make_lights(&setup, 7, false);
        assert_near(compare_lights(&on[i], &setup), 7.0, 1e-9);
        light_setup_destroy(&setup);
        assert_int_equal(gl_light_features(on[i].light), GL_SURFACE_HAS_LIGHTS);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(environment_lookups_match_the_cpu),
        cmocka_unit_test(dark_texels_beside_a_sun_stay_accurate),
        cmocka_unit_test(missing_levels_are_as_on_the_cpu),
        cmocka_unit_test(albedo_luts_match_the_cpu),
        cmocka_unit_test(punctual_lights_match_the_cpu),
    };
    static const gl_api apis[2] = {GL_API_CORE, GL_API_ES};
    for (int i = 0; i < 2; i++)
        bench_count += bench_create(&on[bench_count], apis[i]);
    if (bench_count == 0) {
        printf("0 passed, 0 failed, all skipped: there is no OpenGL that draws floats without a window\n");
        return 77;
    }
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    for (int i = 0; i < bench_count; i++)
        bench_destroy(&on[i]);
    return failed;
}
