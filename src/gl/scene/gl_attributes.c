/* gl_attributes.c - see gl_attributes.h. */
#include "gl/scene/gl_attributes.h"

#include "gl/core/gl_api.h"

#include <stddef.h>
#include <string.h>

/* ---- instances ---- */

/* A disc is drawn as a regular polygon of twelve sides with the same area: sqrt(pi / (6 sin(pi / 6))). */
static const float DISC_OF_TWELVE = 1.0233267f;

void gl_instance_load(const render_geometry *g, uint32_t number, gl_instance *out)
{
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++)
            out->world[4 * row + column] = g->world->m[4 * column + row];
    memcpy(out->normal_matrix, g->normal_matrix, sizeof out->normal_matrix);
    out->scale = g->scale;
    out->bitangent_sign = g->bitangent_sign;
    out->number = (float)number;
    out->sprite_radius =
        g->primitive->mode == SCENE_TRIANGLES ? 0.0f : render_geometry_sprite_radius(g->primitive->mode);
    if (g->primitive->mode == SCENE_POINTS)
        out->sprite_radius *= DISC_OF_TWELVE;
}

/* ---- vertex array objects ---- */

static void point_array(GLuint index, GLint size, size_t offset, GLsizei stride, GLuint divisor)
{
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, size, GL_FLOAT, GL_FALSE, stride, (const void *)(uintptr_t)offset);
    glVertexAttribDivisor(index, divisor);
}

/* Attributes of the second end of a sprite, in locations that sprites do not use otherwise. */
static const GLuint end_attributes[GL_VERTEX_ARRAYS] = {
    [GL_ATTRIBUTE_POSITION] = GL_ATTRIBUTE_TANGENT,
    [GL_ATTRIBUTE_NORMAL] = GL_ATTRIBUTE_NORMAL_MATRIX,
    [GL_ATTRIBUTE_COLOR] = GL_ATTRIBUTE_NORMAL_MATRIX + 1,
    [GL_ATTRIBUTE_TEXCOORD] = GL_ATTRIBUTE_TEXCOORD + 2,
    [GL_ATTRIBUTE_TEXCOORD + 1] = GL_ATTRIBUTE_TEXCOORD + 3,
};

static void point_arrays(const gl_vertices *v, scene_mode mode, size_t first)
{
    static const GLint widths[GL_VERTEX_ARRAYS] = {3, 3, 4, 4, 2, 2, 2, 2};
    glBindBuffer(GL_ARRAY_BUFFER, v->buffer);
    for (GLuint i = 0; i < GL_VERTEX_ARRAYS; i++) {
        if (!(v->arrays >> i & 1))
            continue;
        GLsizei size = widths[i] * (GLsizei)sizeof(float);
        size_t offset = v->offsets[i];
        if (mode == SCENE_TRIANGLES) {
            point_array(i, widths[i], offset, size, 0);
        } else if (i < GL_ATTRIBUTE_TEXCOORD + 2) {
            bool is_line = mode == SCENE_LINES;
            GLsizei stride = is_line ? 2 * size : size;
            offset += first * (size_t)stride;
            point_array(i, widths[i], offset, stride, 1);
            point_array(end_attributes[i], widths[i], offset + (is_line ? (size_t)size : 0), stride, 1);
        }
    }
}

void gl_attributes_point(const gl_batch *b, size_t first)
{
    scene_mode mode = b->geometry->primitive->mode;
    if (b->vertices.fixed.arrays)
        point_arrays(&b->vertices.fixed, mode, first);
    if (b->vertices.streamed.arrays)
        point_arrays(&b->vertices.streamed, mode, first);
}

static void point_instances(size_t first)
{
    enum { SIZE = sizeof(gl_instance) };
    size_t offset = first * SIZE;
    for (GLuint k = 0; k < 3; k++) {
        point_array(GL_ATTRIBUTE_WORLD + k, 4, offset + offsetof(gl_instance, world) + 16 * k, SIZE, 1);
        point_array(GL_ATTRIBUTE_NORMAL_MATRIX + k, 3, offset + offsetof(gl_instance, normal_matrix) + 12 * k,
                    SIZE, 1);
    }
    point_array(GL_ATTRIBUTE_INSTANCE, 4, offset + offsetof(gl_instance, scale), SIZE, 1);
}

static gl_vertex_array array_of(const gl_batch *b)
{
    gl_vertex_array array;
    memset(&array, 0, sizeof array);
    array.fixed = b->vertices.fixed;
    array.streamed = b->vertices.streamed;
    array.elements = b->vertices.elements.buffer;
    array.mode = b->geometry->primitive->mode;
    array.first_instance = b->is_sprites ? 0 : b->first_instance;
    return array;
}

static bool is_same_array(const gl_vertex_array *a, const gl_vertex_array *b)
{
    return a->fixed.buffer == b->fixed.buffer && a->fixed.arrays == b->fixed.arrays &&
           memcmp(a->fixed.offsets, b->fixed.offsets, sizeof a->fixed.offsets) == 0 &&
           a->streamed.buffer == b->streamed.buffer && a->streamed.arrays == b->streamed.arrays &&
           memcmp(a->streamed.offsets, b->streamed.offsets, sizeof a->streamed.offsets) == 0 &&
           a->elements == b->elements && a->mode == b->mode && a->first_instance == b->first_instance;
}

void gl_vertex_array_use(gl_vertex_array *array, gl_batch *b, uint32_t instance_buffer)
{
    gl_vertex_array wanted = array_of(b);
    b->vertex_array = array->name;
    if (array->name && is_same_array(array, &wanted))
        return;
    glDeleteVertexArrays(1, &array->name);
    *array = wanted;
    glGenVertexArrays(1, &array->name);
    glBindVertexArray(array->name);
    b->vertex_array = array->name;
    gl_attributes_point(b, 0);
    if (!b->is_sprites) {
        glBindBuffer(GL_ARRAY_BUFFER, instance_buffer);
        point_instances(b->first_instance);
    }
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, array->elements);
}

/* ---- constants ---- */

/* Constants for attributes without arrays: white colors, the rest is irrelevant. OpenGL may lose such
 * constants where an array used the location, so they are set for each draw. */
static void set_absent(const gl_batch *b)
{
    static const float white[4] = {1.0f, 1.0f, 1.0f, 1.0f}, zero[4] = {0.0f, 0.0f, 0.0f, 1.0f};
    uint32_t arrays = b->vertices.fixed.arrays | b->vertices.streamed.arrays;
    for (GLuint i = GL_ATTRIBUTE_NORMAL; i < GL_VERTEX_ARRAYS; i++) {
        if (arrays >> i & 1)
            continue;
        const float *value = i == GL_ATTRIBUTE_COLOR ? white : zero;
        if (!b->is_sprites)
            glVertexAttrib4fv(i, value);
        else if (end_attributes[i]) {
            glVertexAttrib4fv(i, value);
            glVertexAttrib4fv(end_attributes[i], value);
        }
    }
}

static void set_instance(const gl_instance *one, bool is_sprite)
{
    for (GLuint k = 0; k < 3; k++)
        glVertexAttrib4fv(GL_ATTRIBUTE_WORLD + k, one->world + 4 * k);
    for (GLuint k = 0; k < 3 && !is_sprite; k++)
        glVertexAttrib3fv(GL_ATTRIBUTE_NORMAL_MATRIX + k, one->normal_matrix + 3 * k);
    glVertexAttrib4fv(GL_ATTRIBUTE_INSTANCE, &one->scale);
}

void gl_attributes_set_constants(const gl_batch *b, const gl_instance *instance)
{
    set_absent(b);
    if (instance)
        set_instance(instance, b->is_sprites);
}
