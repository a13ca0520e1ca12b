/* gl_transparency.c - see gl_transparency.h: the sorted mode, and the choice of the mode. */
#include "gl/scene/gl_transparency.h"

#include "base/memory.h"
#include "base/result.h"
#include "gl/core/gl_api.h"
#include "gl/scene/gl_attributes.h"
#include "gl/scene/gl_layers.h"

/* The order of gl_sort.h in GPU memory. */
typedef struct sorted_triangles {
    gl_sort sort;
    uint64_t revision; /* scene revision of the arrays */
    uint32_t elements; /* buffer: triangle indices of the units, one after the other */
    uint32_t batch_count;
    uint32_t *arrays;      /* vertex array objects, per batch */
    size_t *first_element; /* per unit */
    gl_vertices *sprites;  /* per unit */
    uint32_t unit_count;
} sorted_triangles;

struct gl_transparency {
    gl_context *context;
    facet_allocator allocator;
    sorted_triangles sorted;
    gl_layers layers;
};

/* ---- sorted ---- */

static void drop_arrays(sorted_triangles *s)
{
    if (s->arrays)
        glDeleteVertexArrays((GLsizei)s->batch_count, s->arrays);
    for (uint32_t i = 0; i < s->unit_count; i++)
        glDeleteBuffers(1, &s->sprites[i].buffer);
    mem_free(s->arrays);
    mem_free(s->first_element);
    mem_free(s->sprites);
    s->arrays = NULL;
    s->first_element = NULL;
    s->sprites = NULL;
    s->batch_count = s->unit_count = 0;
    s->revision = 0;
}

static void sorted_destroy(sorted_triangles *s)
{
    drop_arrays(s);
    glDeleteBuffers(1, &s->elements);
    gl_sort_destroy(&s->sort);
}

/* Vertex array objects of the batches, with the sorted indices and without instances. */
static facet_result make_arrays(gl_transparency *t, const gl_transparency_view *view, facet_error *error)
{
    sorted_triangles *s = &t->sorted;
    const gl_batch *batches = gl_mesh_batches(view->meshes, GL_PASS_BLENDED, &s->batch_count);
    s->arrays = mem_zalloc(&t->allocator, s->batch_count, sizeof *s->arrays);
    s->first_element = mem_zalloc(&t->allocator, s->sort.unit_count, sizeof *s->first_element);
    s->sprites = mem_zalloc(&t->allocator, s->sort.unit_count, sizeof *s->sprites);
    if (!s->arrays || !s->first_element || !s->sprites) {
        s->batch_count = s->arrays ? s->batch_count : 0;
        drop_arrays(s);
        return fail_memory(error, "blended triangles", s->sort.unit_count * sizeof *s->first_element);
    }
    s->unit_count = s->sort.unit_count;
    if (!s->elements)
        glGenBuffers(1, &s->elements);
    for (uint32_t i = 0; i < s->batch_count; i++) {
        glGenVertexArrays(1, &s->arrays[i]);
        glBindVertexArray(s->arrays[i]);
        gl_attributes_point(&batches[i], 0);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, s->elements);
    }
    glBindVertexArray(0);
    size_t first = 0;
    for (uint32_t i = 0; i < s->unit_count; i++) {
        s->first_element[i] = first;
        first += batches[s->sort.units[i].batch].is_sprites ? 0 : 3 * (size_t)s->sort.units[i].count;
    }
    s->revision = s->sort.revision;
    return FACET_OK;
}

/* Uploads the sorted indices and sprites. */
static facet_result upload_order(gl_transparency *t, const gl_transparency_view *view, facet_error *error)
{
    sorted_triangles *s = &t->sorted;
    const gl_sort *sort = &s->sort;
    uint32_t batch_count;
    const gl_batch *batches = gl_mesh_batches(view->meshes, GL_PASS_BLENDED, &batch_count);
    uint32_t *indices = mem_alloc(&t->allocator, sort->count, 3 * sizeof *indices);
    facet_result result = indices ? FACET_OK : fail_memory(error, "order", sort->count * sizeof *indices);
    size_t count = 0;
    for (uint32_t i = 0; i < sort->unit_count && result == FACET_OK; i++) {
        const gl_sort_unit *unit = &sort->units[i];
        const gl_batch *b = &batches[unit->batch];
        const uint32_t *order = sort->order + unit->first;
        if (b->is_sprites) {
            result = gl_mesh_reorder(view->meshes, b, order, &s->sprites[i], error);
            continue;
        }
        for (uint32_t k = 0; k < unit->count; k++)
            for (int corner = 0; corner < 3; corner++)
                indices[count++] = b->vertices.elements.indices[3 * (size_t)order[k] + (size_t)corner];
    }
    if (result == FACET_OK) {
        glBindVertexArray(0);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, s->elements);
        glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(count * sizeof *indices), indices, GL_STREAM_DRAW);
    }
    mem_free(indices);
    return result;
}

static void draw_run(const sorted_triangles *s, const gl_batch *b, const gl_sort_run *run)
{
    if (b->is_sprites) {
        gl_batch sorted = *b;
        sorted.vertices.fixed = s->sprites[run->unit];
        sorted.vertices.streamed.arrays = 0;
        gl_attributes_point(&sorted, run->first);
        glDrawArraysInstanced(b->mode, 0, (GLsizei)b->element_count, (GLsizei)run->count);
        return;
    }
    size_t offset = (s->first_element[run->unit] + 3 * (size_t)run->first) * sizeof(uint32_t);
    glDrawElements(GL_TRIANGLES, (GLsizei)(3 * run->count), GL_UNSIGNED_INT, (const void *)(uintptr_t)offset);
}

static facet_result draw_runs(const gl_transparency *t, const gl_transparency_view *view, facet_error *error)
{
    const sorted_triangles *s = &t->sorted;
    uint32_t count, batch = UINT32_MAX, unit = UINT32_MAX;
    const gl_batch *batches = gl_mesh_batches(view->meshes, GL_PASS_BLENDED, &count);
    for (uint32_t i = 0; i < s->sort.run_count; i++) {
        const gl_sort_run *run = &s->sort.runs[i];
        const gl_sort_unit *u = &s->sort.units[run->unit];
        const gl_batch *b = &batches[u->batch];
        if (b->is_outside)
            continue;
        if (batch != u->batch) {
            TRY(gl_material_use(view->materials, view->programs, b, b->features | view->features, error));
            glBindVertexArray(s->arrays[u->batch]);
            batch = u->batch;
            unit = UINT32_MAX;
        }
        if (unit != run->unit)
            gl_mesh_set_constants(view->meshes, b, u->instance);
        unit = run->unit;
        draw_run(s, b, run);
    }
    return FACET_OK;
}

static facet_result sorted_draw(gl_transparency *t, const gl_transparency_view *view, facet_error *error)
{
    sorted_triangles *s = &t->sorted;
    bool is_new;
    s->sort.allocator = t->allocator;
    facet_result result =
        gl_sort_update(&s->sort, view->meshes, view->scene, view->frame, view->thread_count, &is_new, error);
    if (result == FACET_OK && s->revision != s->sort.revision) {
        drop_arrays(s);
        result = make_arrays(t, view, error);
    }
    if (result == FACET_OK && is_new)
        result = upload_order(t, view, error);
    if (result != FACET_OK) {
        s->sort.revision = 0; /* sort again next time */
        return result;
    }
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    result = draw_runs(t, view, error);
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
    glBindVertexArray(0);
    return result;
}

/* ---- dispatch ---- */

facet_result gl_transparency_create(gl_context *context, const facet_allocator *allocator,
                                    gl_transparency **out, facet_error *error)
{
    *out = mem_zalloc(allocator, 1, sizeof **out);
    if (!*out)
        return fail_memory(error, "transparency", sizeof **out);
    (*out)->context = context;
    (*out)->allocator = allocator ? *allocator : (facet_allocator){0};
    gl_layers_create(&(*out)->layers, context);
    return FACET_OK;
}

void gl_transparency_destroy(gl_transparency *t)
{
    if (!t)
        return;
    sorted_destroy(&t->sorted);
    gl_layers_destroy(&t->layers);
    mem_free(t);
}

/* Peeling takes a texture unit beyond those of materials. */
static facet_transparency possible_mode(const gl_context *context, facet_transparency mode)
{
    bool can_peel = context->max_texture_units > GL_UNIT_PEELED;
    return mode == FACET_TRANSPARENCY_PEELED && !can_peel ? FACET_TRANSPARENCY_SORTED : mode;
}

uint32_t gl_transparency_max_samples(const gl_context *context, facet_transparency mode,
                                     const gl_mesh_set *meshes)
{
    uint32_t count;
    gl_mesh_batches(meshes, GL_PASS_BLENDED, &count);
    bool is_peeled = count && possible_mode(context, mode) == FACET_TRANSPARENCY_PEELED;
    return is_peeled ? 1 : (uint32_t)context->max_samples;
}

facet_result gl_transparency_request(const gl_transparency *t, const gl_transparency_view *view,
                                     facet_error *error)
{
    uint32_t count;
    const gl_batch *batches = gl_mesh_batches(view->meshes, GL_PASS_BLENDED, &count);
    for (uint32_t i = 0; i < count; i++) {
        gl_program_key key = {gl_material_main(view->materials, &batches[i]),
                              gl_material_features(view->materials, &batches[i]) |
                                  gl_mesh_features(view->meshes, &batches[i]) | view->features |
                                  gl_layers_features(&t->layers, possible_mode(t->context, view->mode))};
        TRY(gl_programs_request(view->programs, key, error));
    }
    return FACET_OK;
}

facet_result gl_transparency_draw(gl_transparency *t, const gl_transparency_view *view, facet_error *error)
{
    uint32_t count;
    gl_mesh_batches(view->meshes, GL_PASS_BLENDED, &count);
    if (count == 0)
        return FACET_OK;
    bool is_sorted = possible_mode(t->context, view->mode) == FACET_TRANSPARENCY_SORTED;
    facet_result result = is_sorted ? sorted_draw(t, view, error) : gl_layers_draw(&t->layers, view, error);
    glBindFramebuffer(GL_FRAMEBUFFER, view->target->framebuffer);
    return result == FACET_OK ? gl_context_check(t->context, "blended surfaces", error) : result;
}
