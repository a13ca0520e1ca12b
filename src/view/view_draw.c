/* view_draw.c - see view_draw.h. */
#include "view/view_draw.h"

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "gl/core/gl_api.h"

/* ---- surfaces ---- */

static void make_texture(view_surface *s)
{
    if (!s->texture)
        glGenTextures(1, &s->texture);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, s->texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

/* The renderer's unpack state would change the row length. */
static void fill(uint32_t width, uint32_t height, const unsigned char *pixels)
{
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, (GLsizei)width, (GLsizei)height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 pixels);
}

facet_result view_surface_resize(view_surface *s, gl_context *context, uint32_t width, uint32_t height,
                                 facet_error *error)
{
    s->is_upside_down = false;
    if (s->framebuffer && s->width == width && s->height == height)
        return FACET_OK;
    make_texture(s);
    fill(width, height, NULL);
    if (!s->framebuffer)
        glGenFramebuffers(1, &s->framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, s->framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, s->texture, 0);
    s->width = width;
    s->height = height;
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return fail(error, FACET_ERROR_SYSTEM, "OpenGL (%s): images of %u x %u pixels cannot be drawn",
                    context->name, width, height);
    return gl_context_check(context, "the window's image", error);
}

void view_surface_upload(view_surface *s, uint32_t width, uint32_t height, const unsigned char *pixels)
{
    make_texture(s);
    fill(width, height, pixels);
    s->width = width;
    s->height = height;
    s->is_upside_down = true;
}

void view_surface_read(const view_surface *s, unsigned char *pixels)
{
    size_t row = (size_t)s->width * 4;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, s->framebuffer);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    for (uint32_t y = 0; y < s->height; y++)
        glReadPixels(0, (GLint)(s->height - 1 - y), (GLsizei)s->width, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                     pixels + y * row);
}

void view_surface_destroy(view_surface *s)
{
    glDeleteTextures(1, &s->texture);
    glDeleteFramebuffers(1, &s->framebuffer);
    *s = (view_surface){0};
}

/* ---- the program ---- */

/* u_place: left, bottom, right, top in [-1, 1]. */
static const char vertex_text[] =
    "uniform vec4 u_place;\n"
    "uniform float u_is_upside_down;\n"
    "out vec2 v_place;\n"
    "void main()\n"
    "{\n"
    "    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));\n"
    "    v_place = vec2(corner.x, mix(corner.y, 1.0 - corner.y, u_is_upside_down));\n"
    "    gl_Position = vec4(mix(u_place.xy, u_place.zw, corner), 0.0, 1.0);\n"
    "}\n";

/* The checkerboard is blended in display values, as browsers blend transparent images over a page. */
static const char fragment_text[] =
    "uniform sampler2D u_image;\n"
    "uniform vec4 u_color;   /* times the image; with u_square < 0 instead of it */\n"
    "uniform float u_square; /* pixels; 0: no checkerboard */\n"
    "in vec2 v_place;\n"
    "out vec4 fragment;\n"
    "void main()\n"
    "{\n"
    "    if (u_square < 0.0) {\n"
    "        fragment = u_color;\n"
    "        return;\n"
    "    }\n"
    "    vec4 c = texture(u_image, v_place);\n"
    "    if (u_square > 0.0) {\n"
    "        vec2 square = floor(gl_FragCoord.xy / u_square);\n"
    "        float light = mod(square.x + square.y, 2.0) < 0.5 ? 0.56 : 0.64;\n"
    "        c = vec4(mix(vec3(light), c.xyz, c.w), 1.0);\n"
    "    }\n"
    "    fragment = c * u_color;\n"
    "}\n";

struct view_draw {
    gl_context *context;
    GLuint program, array;
    GLint place, is_upside_down, color, square;
    uint32_t width, height;
    float square_size;
};

static GLuint compile(const gl_context *context, GLenum stage, const char *text, facet_error *error)
{
    char head[128];
    snprintf(head, sizeof head, "#version %s\nprecision highp float;\n", context->glsl_version);
    const char *texts[] = {head, text};
    GLuint shader = glCreateShader(stage);
    GLint is_compiled = 0;
    glShaderSource(shader, 2, texts, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &is_compiled);
    if (is_compiled)
        return shader;
    char why[512] = "";
    glGetShaderInfoLog(shader, sizeof why, NULL, why);
    glDeleteShader(shader);
    fail(error, FACET_ERROR_SYSTEM, "OpenGL (%s): the window's shader was refused: %s", context->name, why);
    return 0;
}

static facet_result link_program(view_draw *d, facet_error *error)
{
    GLuint vertex = compile(d->context, GL_VERTEX_SHADER, vertex_text, error);
    GLuint fragment = vertex ? compile(d->context, GL_FRAGMENT_SHADER, fragment_text, error) : 0;
    GLint is_linked = 0;
    if (fragment) {
        d->program = glCreateProgram();
        glAttachShader(d->program, vertex);
        glAttachShader(d->program, fragment);
        glLinkProgram(d->program);
        glGetProgramiv(d->program, GL_LINK_STATUS, &is_linked);
        if (!is_linked)
            fail(error, FACET_ERROR_SYSTEM, "OpenGL (%s): the window's program was refused",
                 d->context->name);
    }
    glDeleteShader(vertex);
    glDeleteShader(fragment);
    if (!is_linked)
        return FACET_ERROR_SYSTEM;
    d->place = glGetUniformLocation(d->program, "u_place");
    d->is_upside_down = glGetUniformLocation(d->program, "u_is_upside_down");
    d->color = glGetUniformLocation(d->program, "u_color");
    d->square = glGetUniformLocation(d->program, "u_square");
    glUseProgram(d->program);
    glUniform1i(glGetUniformLocation(d->program, "u_image"), 0);
    return FACET_OK;
}

facet_result view_draw_create(gl_context *context, const facet_allocator *allocator, view_draw **out,
                              facet_error *error)
{
    view_draw *d = mem_zalloc(allocator, 1, sizeof *d);
    *out = NULL;
    if (!d)
        return fail_memory(error, "window", sizeof *d);
    d->context = context;
    glGenVertexArrays(1, &d->array);
    facet_result result = link_program(d, error);
    if (result != FACET_OK) {
        view_draw_destroy(d);
        return result;
    }
    *out = d;
    return FACET_OK;
}

void view_draw_destroy(view_draw *d)
{
    if (!d)
        return;
    glDeleteProgram(d->program);
    glDeleteVertexArrays(1, &d->array);
    mem_free(d);
}

/* ---- drawing ---- */

void view_draw_begin(view_draw *d, uint32_t framebuffer, uint32_t width, uint32_t height, float square)
{
    d->width = width;
    d->height = height;
    d->square_size = square;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, (GLsizei)width, (GLsizei)height);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glUseProgram(d->program);
    glBindVertexArray(d->array);
    glActiveTexture(GL_TEXTURE0);
    glBindSampler(0, 0);
}

/* From pixels from the top left to the corners of a rectangle. */
static void set_place(const view_draw *d, float x, float y, float width, float height)
{
    float w = 2.0f / (float)d->width;
    float h = 2.0f / (float)d->height;
    glUniform4f(d->place, x * w - 1.0f, 1.0f - (y + height) * h, (x + width) * w - 1.0f, 1.0f - y * h);
}

void view_draw_surface(view_draw *d, const view_surface *s, view_laying laying, int x, int y, uint32_t width,
                       uint32_t height, int left, int right)
{
    if (!s->texture || right <= left)
        return;
    glBindTexture(GL_TEXTURE_2D, s->texture);
    bool is_stretched = s->width != width || s->height != height;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, is_stretched ? GL_LINEAR : GL_NEAREST);
    set_place(d, (float)x, (float)y, (float)width, (float)height);
    glUniform1f(d->is_upside_down, s->is_upside_down ? 1.0f : 0.0f);
    glUniform4f(d->color, 1.0f, 1.0f, 1.0f, 1.0f);
    glUniform1f(d->square, laying == VIEW_LAY_IMAGE ? d->square_size : 0.0f);
    glEnable(GL_SCISSOR_TEST);
    glScissor(left, 0, right - left, (GLsizei)d->height);
    if (laying == VIEW_LAY_PANEL) {
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    }
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
}

void view_draw_bar(view_draw *d, int x, int width, const float color[4])
{
    set_place(d, (float)x - 0.5f * (float)width, 0.0f, (float)width, (float)d->height);
    glUniform4fv(d->color, 1, color);
    glUniform1f(d->square, -1.0f);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisable(GL_BLEND);
}
