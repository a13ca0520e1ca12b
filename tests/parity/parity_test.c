/* parity_test.c - runs the parity cases as GLSL ES 3.00 (Mesa's software driver will do) and in C, and
 * compares. Argument: the GLSL text of the shader library and of the cases. Exits with 77 where there is no
 * GLES 3 context. */
#include <GLES3/gl3.h>
#include <stdio.h>
#include <stdlib.h>

#include "context.h"
#include "shade/shade.h"

#include "shade/lang/lang_c_begin.h"

#include "common.h"
#include "ogl1_host.h"
#include "surface_host.h"
#include "water_host.h"

#include "shade/lang/lang_c_end.h"

#include "shade/compose/surface_tables.h"
#include "shade/compose/surface_radiance.h"
#include "shade/compose/ogl1_light.h"
#include "shade/compose/ogl1_fragment.h"
#include "shade/compose/sea_radiance.h"

#include "shade/lang/lang_c_begin.h"

#include "layers.h"
#include "light.h"
#include "phong.h"
#include "ogl1.h"
#include "sky.h"
#include "surface.h"
#include "surface_radiance.h"
#include "water.h"
#include "sea_radiance.h"

#include "shade/lang/lang_c_end.h"

typedef vec3 case_function(vec2 u);

typedef struct parity_case {
    const char *header; /* of shade/, without .h */
    const char *name;
    case_function *evaluate;
} parity_case;

#include "parity_cases.h" /* by registry.sh */

enum { SIZE = 64, MAX_TEXT = 1 << 19, CASE_COUNT = sizeof parity_cases / sizeof *parity_cases };

/* Largest difference, relative to the value plus FLOOR. */
static const float tolerance = 1e-4f, FLOOR = 1e-3f;
/* Mean of the differences, where sin(), exp() and pow() of the driver are less precise than floats. */
static const double mean_tolerance = 1e-3;

static float gpu[SIZE * SIZE][4];

static int skip(const char *why)
{
    printf("0 passed, 0 failed, %d skipped: %s\n", CASE_COUNT, why);
    return 77;
}

static GLuint compile(GLenum stage, GLsizei count, const char *const *texts)
{
    GLuint shader = glCreateShader(stage);
    glShaderSource(shader, count, texts, NULL);
    glCompileShader(shader);
    GLint ok = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (!ok) {
        char log[4096];
        glGetShaderInfoLog(shader, sizeof log, NULL, log);
        fprintf(stderr, "%s\n", log);
        exit(1);
    }
    return shader;
}

static char *read_text(const char *path)
{
    static char text[MAX_TEXT];
    FILE *file = fopen(path, "rb");
    size_t size = file ? fread(text, 1, sizeof text - 1, file) : 0;
    if (file)
        fclose(file);
    return size > 0 && size < sizeof text - 1 ? text : NULL;
}

/* A main function that chooses among the cases from first to end - 1 by u_case. */
static const char *main_text(int first, int end)
{
    static char text[1 << 14];
    size_t length = (size_t)snprintf(text, sizeof text,
                                     "uniform int u_case;\n"
                                     "out vec4 out_color;\n"
                                     "vec3 chosen(vec2 u)\n"
                                     "{\n");
    for (int i = first; i < end && length < sizeof text; ++i)
        length += (size_t)snprintf(text + length, sizeof text - length,
                                   "    if (u_case == %d) return case_%s(u);\n", i, parity_cases[i].name);
    if (length < sizeof text)
        length += (size_t)snprintf(text + length, sizeof text - length,
                                   "    return vec3(0.0);\n"
                                   "}\n"
                                   "void main()\n"
                                   "{\n"
                                   "    out_color = vec4(chosen(gl_FragCoord.xy / float(%d)), 1.0);\n"
                                   "}\n",
                                   SIZE);
    if (length >= sizeof text) {
        fprintf(stderr, "too many cases of %s.h\n", parity_cases[first].header);
        exit(1);
    }
    return text;
}

/* One program per header: drivers inline every function that a program calls, and take minutes for all of
 * them. */
static GLuint link_cases(const char *library, int first, int end)
{
    static const char *const vertex = "#version 300 es\n"
                                      "void main()\n"
                                      "{\n"
                                      "    vec2 p = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
                                      "    gl_Position = vec4(p * 4.0 - 1.0, 0.0, 1.0);\n"
                                      "}\n";
    const char *const fragment[2] = {library, main_text(first, end)};
    GLuint program = glCreateProgram();
    glAttachShader(program, compile(GL_VERTEX_SHADER, 1, &vertex));
    glAttachShader(program, compile(GL_FRAGMENT_SHADER, 2, fragment));
    glLinkProgram(program);
    return program;
}

static void draw_into_float_texture(void)
{
    GLuint texture, framebuffer;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, SIZE, SIZE);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    glViewport(0, 0, SIZE, SIZE);
}

static vec3 evaluate(const parity_case *c, int x, int y)
{
    return c->evaluate(vec2(((float)x + 0.5f) / SIZE, ((float)y + 0.5f) / SIZE));
}

/* Of all values of the grid; a NaN on either side counts as infinite. */
typedef struct difference {
    float largest;
    double mean;
    int at[3]; /* x, y, channel of the largest */
} difference;

static difference compare(const parity_case *c)
{
    difference d = {.largest = -1.0f};
    for (int y = 0; y < SIZE; ++y)
        for (int x = 0; x < SIZE; ++x) {
            vec3 cpu = evaluate(c, x, y);
            for (int channel = 0; channel < 3; ++channel) {
                float e = fabsf(gpu[y * SIZE + x][channel] - cpu[channel]) / (fabsf(cpu[channel]) + FLOOR);
                d.mean += (double)e / (3.0 * SIZE * SIZE);
                if (!(e <= d.largest)) {
                    d.largest = isnan(e) ? INFINITY : e;
                    d.at[0] = x;
                    d.at[1] = y;
                    d.at[2] = channel;
                }
            }
        }
    return d;
}

/* Draws a case with the program in use; true: CPU and GPU agree. */
static bool passes(const parity_case *c, GLint u_case, int number)
{
    glUniform1i(u_case, number);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glReadPixels(0, 0, SIZE, SIZE, GL_RGBA, GL_FLOAT, gpu);
    difference d = compare(c);
    bool ok = parity_context_is_precise() ? d.largest <= tolerance : d.mean <= mean_tolerance;
    const int *at = d.at;
    printf("%s.h, %s: largest relative difference %.1e, mean %.1e%s", c->header, c->name, (double)d.largest,
           d.mean, ok ? "\n" : " TOO LARGE");
    if (!ok)
        printf(" at (%d, %d), channel %d: GPU %.9g, C %.9g\n", at[0], at[1], at[2],
               (double)gpu[at[1] * SIZE + at[0]][at[2]], (double)evaluate(c, at[0], at[1])[at[2]]);
    return ok;
}

int main(int argc, char **argv)
{
    if (argc != 2)
        return 2;
    char *library = read_text(argv[1]);
    if (!library) {
        fprintf(stderr, "%s: cannot be read, or is too long\n", argv[1]);
        return 2;
    }
    if (!parity_context_create())
        return skip("no EGL display without a surface, or no GLES 3 context");
    printf("%s\n", (const char *)glGetString(GL_RENDERER));
    draw_into_float_texture();
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return skip("no rendering into float textures");

    int failed = 0;
    for (int first = 0, end = 0; first < CASE_COUNT; first = end) {
        while (end < CASE_COUNT && strcmp(parity_cases[end].header, parity_cases[first].header) == 0)
            ++end;
        GLuint program = link_cases(library, first, end);
        glUseProgram(program);
        for (int i = first; i < end; ++i)
            failed += !passes(&parity_cases[i], glGetUniformLocation(program, "u_case"), i);
        glDeleteProgram(program);
    }
    if (glGetError() != GL_NO_ERROR) {
        printf("GL reports an error\n");
        ++failed;
    }
    printf("%d passed, %d failed\n", CASE_COUNT - failed, failed);
    return failed != 0;
}
