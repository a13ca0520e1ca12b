/* parity_test.c - runs probe.h as GLSL ES 3.00 (EGL without a window; Mesa's software driver will do) and in C, and
 * compares. Argument: the fragment shader that glsl.sh made. Exits with 77 where there is no GLES 3 context. */
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>
#include <stdio.h>
#include <stdlib.h>

#include "shade/shade.h"

#include "lang/lang_c_begin.h"

#include "probe.h"

#include "lang/lang_c_end.h"

enum { SIZE = 64, TEXT_MAX = 1 << 19 };

/* Largest difference, relative to the value plus FLOOR. */
static const float tolerance = 1e-4f, FLOOR = 1e-3f;

static float gpu[SIZE * SIZE][4];

static int skip(const char *why)
{
    printf("0 passed, 0 failed, %d skipped: %s\n", PROBE_COUNT, why);
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
    static char text[TEXT_MAX];
    FILE *file = fopen(path, "rb");
    size_t size = file ? fread(text, 1, sizeof text - 1, file) : 0;
    if (file)
        fclose(file);
    return size > 0 && size < sizeof text - 1 ? text : NULL;
}

/* A GLES 3 context without a window; false: there is none. */
static bool create_context(void)
{
    const char *extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!extensions || !strstr(extensions, "EGL_MESA_platform_surfaceless"))
        return false;
    EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, NULL, NULL) || !eglBindAPI(EGL_OPENGL_ES_API))
        return false;
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    return context != EGL_NO_CONTEXT && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context);
}

/* The functions that probe() chooses from, and the number of the probe after the last of each: its lines
 *     if (which < END)
 *         return NAME(which, u); */
typedef struct probe_group {
    char name[40];
    int end;
} probe_group;

static int find_groups(const char *text, probe_group *groups, int most)
{
    const char *at = strstr(text, "vec3 probe(int which, vec2 u)");
    int count = 0;
    while (at && count < most && (at = strstr(at, "return "))) {
        probe_group *g = &groups[count];
        const char *bound = at;
        while (bound > text && *bound != '(' && *bound != '{' && *bound != ';')
            bound--;
        if (sscanf(at, "return %39[a-z_](which, u);", g->name) != 1)
            break;
        if (sscanf(bound, "(which < %d)", &g->end) != 1)
            g->end = PROBE_COUNT;
        count++;
        at++;
    }
    return count;
}

/* A program of one group: drivers inline all functions that a program calls, and take minutes for all of them. */
static GLuint link_group(const char *text, const char *name)
{
    static const char *const vertex = "#version 300 es\n"
                                      "void main()\n"
                                      "{\n"
                                      "    vec2 p = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
                                      "    gl_Position = vec4(p * 4.0 - 1.0, 0.0, 1.0);\n"
                                      "}\n";
    static const char call[] = "probe(u_which";
    static char head[TEXT_MAX];
    const char *at = strstr(text, call);
    if (!at) {
        fprintf(stderr, "the shader does not call probe(u_which)\n");
        exit(1);
    }
    snprintf(head, sizeof head, "%.*s%s", (int)(at - text), text, name);
    const char *const fragment[2] = {head, at + strlen("probe")};
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

/* Largest difference over the grid and where; a NaN on either side counts as infinite. */
static float compare(int which, int at[3])
{
    float worst = -1.0f;
    for (int y = 0; y < SIZE; ++y)
        for (int x = 0; x < SIZE; ++x) {
            vec3 cpu = probe(which, vec2(((float)x + 0.5f) / SIZE, ((float)y + 0.5f) / SIZE));
            for (int c = 0; c < 3; ++c) {
                float e = fabsf(gpu[y * SIZE + x][c] - cpu[c]) / (fabsf(cpu[c]) + FLOOR);
                if (!(e <= worst)) {
                    worst = isnan(e) ? INFINITY : e;
                    at[0] = x;
                    at[1] = y;
                    at[2] = c;
                }
            }
        }
    return worst;
}

int main(int argc, char **argv)
{
    if (argc != 2)
        return 2;
    char *text = read_text(argv[1]);
    if (!text) {
        fprintf(stderr, "%s: cannot be read, or is too long\n", argv[1]);
        return 2;
    }
    if (!create_context())
        return skip("no EGL display without a surface, or no GLES 3 context");
    printf("%s\n", (const char *)glGetString(GL_RENDERER));

    probe_group groups[32];
    int group_count = find_groups(text, groups, 32);
    if (group_count == 0 || groups[group_count - 1].end != PROBE_COUNT) {
        fprintf(stderr, "the choices of probe() cannot be read\n");
        return 2;
    }
    draw_into_float_texture();
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return skip("no rendering into float textures");

    int failed = 0;
    GLuint program = 0;
    for (int which = 0, group = -1; which < PROBE_COUNT; ++which) {
        while (group < 0 || which >= groups[group].end) {
            glDeleteProgram(program);
            program = link_group(text, groups[++group].name);
            glUseProgram(program);
        }
        glUniform1i(glGetUniformLocation(program, "u_which"), which);
        glDrawArrays(GL_TRIANGLES, 0, 3);
        glReadPixels(0, 0, SIZE, SIZE, GL_RGBA, GL_FLOAT, gpu);
        int at[3] = {0, 0, 0};
        float worst = compare(which, at);
        bool ok = worst <= tolerance;
        failed += !ok;
        printf("probe %2d: largest relative difference %.1e%s", which, (double)worst,
               ok ? "\n" : " TOO LARGE");
        if (!ok) {
            vec3 cpu = probe(which, vec2(((float)at[0] + 0.5f) / SIZE, ((float)at[1] + 0.5f) / SIZE));
            printf(" at (%d, %d), channel %d: GPU %.9g, C %.9g\n", at[0], at[1], at[2],
                   (double)gpu[at[1] * SIZE + at[0]][at[2]], (double)cpu[at[2]]);
        }
    }
    if (glGetError() != GL_NO_ERROR) {
        printf("GL reports an error\n");
        ++failed;
    }
    printf("%d passed, %d failed\n", PROBE_COUNT - failed, failed);
    return failed != 0;
}
