/* gl_mesh.c - see gl_mesh.h. */
#include "gl/gl_mesh.h"

#include <epoxy/gl.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"

struct gl_mesh_set {
    gl_context *context;
    facet_allocator allocator;
    uint32_t count;
    gl_batch *batches; /* by pass */
    uint32_t first[GL_PASS_COUNT + 1];
    GLuint *buffers; /* two per batch: vertices, instance; then indices */
};

facet_result gl_mesh_create(gl_context *context, const facet_allocator *allocator, gl_mesh_set **out,
                            facet_error *error)
{
    *out = mem_zalloc(allocator, 1, sizeof **out);
    if (!*out)
        return fail_memory(error, "geometry", sizeof **out);
    (*out)->context = context;
    (*out)->allocator = allocator ? *allocator : (facet_allocator){0};
    return FACET_OK;
}

static void clear(gl_mesh_set *set)
{
    for (uint32_t i = 0; i < set->count; i++) {
        glDeleteVertexArrays(1, &set->batches[i].vertex_array);
        glDeleteBuffers(3, set->buffers + 3 * (size_t)i);
    }
    mem_free(set->batches);
    mem_free(set->buffers);
    set->batches = NULL;
    set->buffers = NULL;
    set->count = 0;
    memset(set->first, 0, sizeof set->first);
}

void gl_mesh_destroy(gl_mesh_set *set)
{
    if (!set)
        return;
    clear(set);
    mem_free(set);
}

/* One vertex as it is uploaded. */
typedef struct vertex {
    float position[3], normal[3], tangent[4], color[4], texcoords[4][2];
} vertex;

static void load_vertex(const render_geometry *g, uint32_t index, uint32_t corner, vertex *out)
{
    const scene_primitive *p = g->primitive;
    *out = (vertex){.tangent = {0, 0, 0, 1}, .color = {1, 1, 1, 1}};
    memcpy(out->position, g->positions + 3 * (size_t)index, sizeof out->position);
    if (g->normals)
        memcpy(out->normal, g->normals + 3 * (size_t)index, sizeof out->normal);
    if (g->tangents)
        memcpy(out->tangent, g->tangents + 4 * (size_t)(g->has_corner_tangents ? corner : index),
               sizeof out->tangent);
    if (p->colors)
        memcpy(out->color, p->colors + 4 * (size_t)index, sizeof out->color);
    for (uint32_t set = 0; set < 4 && set < p->texcoord_count; set++)
        memcpy(out->texcoords[set], p->texcoords[set] + 2 * (size_t)index, sizeof out->texcoords[set]);
}

static void attribute(GLuint index, GLint size, size_t offset, GLsizei stride, GLuint divisor)
{
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, size, GL_FLOAT, GL_FALSE, stride, (const char *)0 + offset);
    glVertexAttribDivisor(index, divisor);
}

/* What an instance is drawn with; matrices by rows. */
typedef struct instance {
    float world[12], normal_matrix[9], rest[3];
} instance;

static void load_instance(const render_geometry *g, const float eye[3], instance *out)
{
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++)
            out->world[4 * row + column] = g->world->m[4 * column + row];
        out->world[4 * row + 3] = g->world->m[12 + row] - eye[row];
    }
    memcpy(out->normal_matrix, g->normal_matrix, sizeof out->normal_matrix);
    out->rest[0] = g->scale;
    out->rest[1] = g->bitangent_sign;
    out->rest[2] = (float)g->material_id;
}

static gl_pass pass_of(const render_geometry *g, const material_plan *plan)
{
    if (g->material->alpha_mode == SCENE_ALPHA_BLEND && g->is_see_through)
        return GL_PASS_BLENDED;
    return plan->lets_rays_through ? GL_PASS_TRANSMISSIVE : GL_PASS_OPAQUE;
}

static facet_result upload(gl_mesh_set *set, gl_batch *b, GLuint buffers[3], const float eye[3],
                           facet_error *error)
{
    const render_geometry *g = b->geometry;
    uint32_t count = g->primitive->index_count;
    vertex *vertices = mem_alloc(&set->allocator, count, sizeof *vertices);
    if (!vertices)
        return fail_memory(error, "vertices", count * sizeof *vertices);
    for (uint32_t i = 0; i < count; i++)
        load_vertex(g, g->primitive->indices[i], i, &vertices[i]);
    glGenVertexArrays(1, &b->vertex_array);
    glBindVertexArray(b->vertex_array);
    glGenBuffers(3, buffers);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(count * sizeof *vertices), vertices, GL_STATIC_DRAW);
    mem_free(vertices);
    enum { SIZE = sizeof(vertex), INSTANCE_SIZE = sizeof(instance) };
    attribute(GL_ATTRIBUTE_POSITION, 3, offsetof(vertex, position), SIZE, 0);
    attribute(GL_ATTRIBUTE_NORMAL, 3, offsetof(vertex, normal), SIZE, 0);
    attribute(GL_ATTRIBUTE_TANGENT, 4, offsetof(vertex, tangent), SIZE, 0);
    attribute(GL_ATTRIBUTE_COLOR, 4, offsetof(vertex, color), SIZE, 0);
    for (GLuint k = 0; k < 4; k++)
        attribute(GL_ATTRIBUTE_TEXCOORD + k, 2, offsetof(vertex, texcoords) + 8 * k, SIZE, 0);
    instance one;
    load_instance(g, eye, &one);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[1]);
    glBufferData(GL_ARRAY_BUFFER, sizeof one, &one, GL_DYNAMIC_DRAW);
    for (GLuint k = 0; k < 3; k++) {
        attribute(GL_ATTRIBUTE_WORLD + k, 4, 16 * k, INSTANCE_SIZE, 1);
        attribute(GL_ATTRIBUTE_NORMAL_MATRIX + k, 3, offsetof(instance, normal_matrix) + 12 * k,
                  INSTANCE_SIZE, 1);
    }
    attribute(GL_ATTRIBUTE_INSTANCE, 3, offsetof(instance, rest), INSTANCE_SIZE, 1);
    b->element_count = count;
    return gl_context_check(set->context, "vertices", error);
}

facet_result gl_mesh_update(gl_mesh_set *meshes, const render_geometry_set *set,
                            const material_plan_set *plans, const float eye[3], facet_error *error)
{
    clear(meshes);
    meshes->batches = mem_zalloc(&meshes->allocator, set->count, sizeof *meshes->batches);
    meshes->buffers = mem_zalloc(&meshes->allocator, 3 * (size_t)set->count, sizeof *meshes->buffers);
    if (!meshes->batches || !meshes->buffers)
        return fail_memory(error, "geometry", set->count * sizeof *meshes->batches);
    for (gl_pass pass = GL_PASS_OPAQUE; pass < GL_PASS_COUNT; pass++) {
        for (uint32_t i = 0; i < set->count; i++) {
            const render_geometry *g = &set->items[i];
            if (pass_of(g, &plans->items[i]) != pass)
                continue;
            static const uint32_t modes[] = {
                [SCENE_POINTS] = GL_POINTS, [SCENE_LINES] = GL_LINES, [SCENE_TRIANGLES] = GL_TRIANGLES};
            gl_batch *b = &meshes->batches[meshes->count];
            *b = (gl_batch){.geometry = g,
                            .plan = &plans->items[i],
                            .mode = modes[g->primitive->mode],
                            .instance_count = 1};
            facet_result result =
                upload(meshes, b, meshes->buffers + 3 * (size_t)meshes->count++, eye, error);
            if (result != FACET_OK)
                return result;
        }
        meshes->first[pass + 1] = meshes->count;
    }
    return FACET_OK;
}

const gl_batch *gl_mesh_batches(const gl_mesh_set *meshes, gl_pass pass, uint32_t *count)
{
    *count = meshes->first[pass + 1] - meshes->first[pass];
    return meshes->batches + meshes->first[pass];
}

void gl_mesh_draw(const gl_mesh_set *meshes, const gl_batch *b)
{
    (void)meshes;
    glBindVertexArray(b->vertex_array);
    glDrawArraysInstanced(b->mode, 0, (GLsizei)b->element_count, (GLsizei)b->instance_count);
}
