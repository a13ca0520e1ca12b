/* gl_transparency.c - see gl_transparency.h. */
#include "gl/scene/gl_transparency.h"

#include <epoxy/gl.h>
#include <math.h>

#include "base/memory.h"
#include "base/result.h"

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

/* Textures of the target's size, and their framebuffers. */
typedef struct blend_layers {
    facet_transparency mode;
    uint32_t width, height, samples;
    uint32_t sum, layer;       /* peeled: the composite so far, one layer; weighted: light, weights */
    uint32_t depths[2];        /* peeled: of the last layer and of this one, alternating */
    uint32_t renderbuffers[2]; /* weighted, multisampled: of sum and layer */
    /* peeled: a layer with either depth, sum; weighted: both, then sum and layer resolved */
    uint32_t framebuffers[3];
} blend_layers;

struct gl_transparency {
    gl_context *context;
    facet_allocator allocator;
    sorted_triangles sorted;
    blend_layers layers;
    uint32_t empty_array;
    uint32_t query;
    uint64_t weighted_feature, peeled_feature;
};

typedef enum compose_mode { COMPOSE_LAYER, COMPOSE_SUM, COMPOSE_WEIGHTED } compose_mode;

/* ---- batches ---- */

static facet_result use_batch(const gl_transparency_view *view, const gl_batch *b, uint64_t features,
                              facet_error *error)
{
    uint32_t program;
    gl_program_key key = {gl_material_main(view->materials, b), b->features | view->features | features};
    TRY(gl_programs_get(view->programs, key, &program, error));
    glUseProgram(program);
    gl_material_bind(view->materials, b);
    return FACET_OK;
}

static facet_result draw_all(const gl_transparency_view *view, uint64_t features, facet_error *error)
{
    uint32_t count;
    const gl_batch *batches = gl_mesh_batches(view->meshes, GL_PASS_BLENDED, &count);
    for (uint32_t i = 0; i < count; i++) {
        if (batches[i].is_outside)
            continue;
        TRY(use_batch(view, &batches[i], features, error));
        gl_mesh_draw(view->meshes, &batches[i]);
    }
    return FACET_OK;
}

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
        gl_mesh_point_arrays(&batches[i], 0);
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
        gl_mesh_point_arrays(&sorted, run->first);
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
            TRY(use_batch(view, b, 0, error));
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

/* ---- layers beside the image ---- */

static void layers_destroy(blend_layers *l)
{
    glDeleteFramebuffers(3, l->framebuffers);
    glDeleteRenderbuffers(2, l->renderbuffers);
    glDeleteTextures(2, l->depths);
    glDeleteTextures(1, &l->sum);
    glDeleteTextures(1, &l->layer);
    *l = (blend_layers){.width = 0};
}

static GLuint make_texture(GLenum format, uint32_t width, uint32_t height)
{
    GLuint name;
    GLenum layout = format == GL_DEPTH_COMPONENT32F          ? GL_DEPTH_COMPONENT
                    : format == GL_R32F || format == GL_R16F ? GL_RED
                                                             : GL_RGBA;
    glGenTextures(1, &name);
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_MATERIAL);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexImage2D(GL_TEXTURE_2D, 0, (GLint)format, (GLsizei)width, (GLsizei)height, 0, layout, GL_FLOAT, NULL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return name;
}

static void attach(GLuint framebuffer, GLuint color, GLuint depth)
{
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color, 0);
    if (depth)
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
}

static void make_peeled(blend_layers *l, GLenum format)
{
    l->layer = make_texture(format, l->width, l->height);
    for (int i = 0; i < 2; i++) {
        l->depths[i] = make_texture(GL_DEPTH_COMPONENT32F, l->width, l->height);
        attach(l->framebuffers[i], l->layer, l->depths[i]);
    }
    attach(l->framebuffers[2], l->sum, 0);
}

static void make_weighted(blend_layers *l, GLenum format)
{
    static const GLenum both[2] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    const GLenum formats[2] = {format, format == GL_RGBA32F ? GL_R32F : GL_R16F};
    l->layer = make_texture(formats[1], l->width, l->height);
    const GLuint textures[2] = {l->sum, l->layer};
    if (l->samples > 1)
        glGenRenderbuffers(2, l->renderbuffers);
    for (int i = 0; i < 2; i++) {
        attach(l->framebuffers[1 + i], textures[i], 0);
        glBindFramebuffer(GL_FRAMEBUFFER, l->framebuffers[0]);
        if (l->samples == 1) {
            glFramebufferTexture2D(GL_FRAMEBUFFER, both[i], GL_TEXTURE_2D, textures[i], 0);
            continue;
        }
        glBindRenderbuffer(GL_RENDERBUFFER, l->renderbuffers[i]);
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, (GLsizei)l->samples, formats[i], (GLsizei)l->width,
                                         (GLsizei)l->height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, both[i], GL_RENDERBUFFER, l->renderbuffers[i]);
    }
    glDrawBuffers(2, both);
}

static facet_result layers_update(gl_transparency *t, const gl_transparency_view *view, facet_error *error)
{
    blend_layers *l = &t->layers;
    const gl_target *target = view->target;
    if (l->width == target->width && l->height == target->height && l->samples == target->samples &&
        l->mode == view->mode)
        return FACET_OK;
    bool blends_floats =
        t->context->has_float_target && (!t->context->is_es || epoxy_has_gl_extension("GL_EXT_float_blend"));
    GLenum format = blends_floats ? GL_RGBA32F : GL_RGBA16F;
    layers_destroy(l);
    *l = (blend_layers){
        .mode = view->mode, .width = target->width, .height = target->height, .samples = target->samples};
    glGenFramebuffers(3, l->framebuffers);
    l->sum = make_texture(format, l->width, l->height);
    if (view->mode == FACET_TRANSPARENCY_PEELED)
        make_peeled(l, format);
    else
        make_weighted(l, format);
    bool is_complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    facet_result result = gl_context_check(t->context, "blended surfaces", error);
    if (result == FACET_OK && !is_complete)
        result = fail(error, FACET_ERROR_SYSTEM,
                      "OpenGL (%s): blending into floating point images is not supported", t->context->name);
    if (result != FACET_OK)
        layers_destroy(l);
    return result;
}

static void layers_bind(uint32_t unit, uint32_t texture)
{
    glBindSampler(unit, 0); /* without a sampler that expects mips */
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, texture);
}

/* Blends a layer texture over the bound framebuffer, with the current blend function. */
static facet_result compose(gl_transparency *t, const gl_transparency_view *view, compose_mode what,
                            facet_error *error)
{
    static const char *const features[] = {
        [COMPOSE_LAYER] = "", [COMPOSE_SUM] = "IS_SUM", [COMPOSE_WEIGHTED] = "IS_WEIGHTED"};
    uint32_t program;
    gl_program_key key = {GL_MAIN_COMPOSE, gl_program_feature(GL_MAIN_COMPOSE, features[what])};
    TRY(gl_programs_get(view->programs, key, &program, error));
    glUseProgram(program);
    if (what == COMPOSE_WEIGHTED)
        layers_bind(GL_UNIT_MATERIAL + 1, t->layers.layer);
    layers_bind(GL_UNIT_MATERIAL, what == COMPOSE_LAYER ? t->layers.layer : t->layers.sum);
    glDisable(GL_CULL_FACE);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBindVertexArray(t->empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    return FACET_OK;
}

/* ---- depth peeling ---- */

static void clear_color(GLint buffer, float rgb, float alpha)
{
    const float value[4] = {rgb, rgb, rgb, alpha};
    glClearBufferfv(GL_COLOR, buffer, value);
}

/* Draws the next layer: the nearest surfaces behind the last layer and in front of opaque ones. False:
 * there is none. */
static bool draw_layer(gl_transparency *t, const gl_transparency_view *view, int number, facet_result *result,
                       facet_error *error)
{
    const blend_layers *l = &t->layers;
    GLint w = (GLint)l->width, h = (GLint)l->height;
    GLuint framebuffer = l->framebuffers[number & 1];
    glBindFramebuffer(GL_READ_FRAMEBUFFER, view->target->framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    glBlitFramebuffer(0, 0, w, h, 0, 0, w, h, GL_DEPTH_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    clear_color(0, 0.0f, 0.0f);
    layers_bind(GL_UNIT_PEELED, l->depths[1 - (number & 1)]);
    glBeginQuery(GL_ANY_SAMPLES_PASSED, t->query);
    *result = draw_all(view, t->peeled_feature, error);
    glEndQuery(GL_ANY_SAMPLES_PASSED);
    GLuint is_seen = 0;
    glGetQueryObjectuiv(t->query, GL_QUERY_RESULT, &is_seen);
    return is_seen && *result == FACET_OK;
}

/* Composites the layer under the previous ones. */
static facet_result add_layer(gl_transparency *t, const gl_transparency_view *view, facet_error *error)
{
    glBindFramebuffer(GL_FRAMEBUFFER, t->layers.framebuffers[2]);
    glBlendFuncSeparate(GL_DST_ALPHA, GL_ONE, GL_ZERO, GL_ONE_MINUS_SRC_ALPHA);
    return compose(t, view, COMPOSE_LAYER, error);
}

static facet_result peeled_draw(gl_transparency *t, const gl_transparency_view *view, facet_error *error)
{
    facet_result result = layers_update(t, view, error);
    if (result != FACET_OK)
        return result;
    const float nearest = t->context->has_clip_control ? 1.0f : 0.0f;
    glBindFramebuffer(GL_FRAMEBUFFER, t->layers.framebuffers[1]);
    glClearBufferfv(GL_DEPTH, 0, &nearest);
    glBindFramebuffer(GL_FRAMEBUFFER, t->layers.framebuffers[2]);
    clear_color(0, 0.0f, 1.0f);
    for (int i = 0; i < GL_TRANSPARENCY_LAYERS && draw_layer(t, view, i, &result, error); i++) {
        result = add_layer(t, view, error);
        if (result != FACET_OK)
            return result;
    }
    if (result != FACET_OK)
        return result;
    glBindFramebuffer(GL_FRAMEBUFFER, view->target->framebuffer);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    return compose(t, view, COMPOSE_SUM, error);
}

/* ---- weighted blending ---- */

/* Nearest depth of blended batches, and 1 over the range of depths. */
static void find_depths(const gl_transparency_view *view, float out[2])
{
    uint32_t count;
    const gl_batch *batches = gl_mesh_batches(view->meshes, GL_PASS_BLENDED, &count);
    float low = INFINITY, high = -INFINITY;
    for (uint32_t i = 0; i < count; i++)
        for (int corner = 0; corner < 8; corner++) {
            float depth = 0.0f;
            for (int k = 0; k < 3; k++)
                depth += view->frame->forward[k] *
                         ((corner >> k & 1 ? batches[i].bounds_max[k] : batches[i].bounds_min[k]) -
                          view->frame->eye[k]);
            low = fminf(low, depth);
            high = fmaxf(high, depth);
        }
    if (!(view->frame->eye[3] > 0.0f))
        low = fmaxf(low, 0.0f);
    out[0] = low;
    out[1] = high > low ? 1.0f / (high - low) : 0.0f;
}

static facet_result draw_weighted(gl_transparency *t, const gl_transparency_view *view, facet_error *error)
{
    uint32_t count;
    const gl_batch *batches = gl_mesh_batches(view->meshes, GL_PASS_BLENDED, &count);
    float depths[2];
    find_depths(view, depths);
    for (uint32_t i = 0; i < count; i++) {
        if (batches[i].is_outside)
            continue;
        TRY(use_batch(view, &batches[i], t->weighted_feature, error));
        GLint program;
        glGetIntegerv(GL_CURRENT_PROGRAM, &program);
        glUniform2fv(glGetUniformLocation((GLuint)program, "u_depths"), 1, depths);
        gl_mesh_draw(view->meshes, &batches[i]);
    }
    return FACET_OK;
}

static void resolve(const blend_layers *l)
{
    GLint w = (GLint)l->width, h = (GLint)l->height;
    for (GLuint i = 0; i < 2 && l->samples > 1; i++) {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, l->framebuffers[0]);
        glReadBuffer(GL_COLOR_ATTACHMENT0 + i);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, l->framebuffers[1 + i]);
        glBlitFramebuffer(0, 0, w, h, 0, 0, w, h, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    }
}

static facet_result weighted_draw(gl_transparency *t, const gl_transparency_view *view, facet_error *error)
{
    facet_result result = layers_update(t, view, error);
    if (result != FACET_OK)
        return result;
    glBindFramebuffer(GL_FRAMEBUFFER, t->layers.framebuffers[0]);
    if (t->layers.samples > 1)
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                                  view->target->renderbuffers[1]);
    else
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, view->target->depth, 0);
    clear_color(0, 0.0f, 1.0f);
    clear_color(1, 0.0f, 0.0f);
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    /* Light and weights are summed, transmittance is multiplied, with one blend function: OpenGL 3.3 has
     * no second one. */
    glBlendFuncSeparate(GL_ONE, GL_ONE, GL_ZERO, GL_ONE_MINUS_SRC_ALPHA);
    result = draw_weighted(t, view, error);
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
    resolve(&t->layers);
    glBindFramebuffer(GL_FRAMEBUFFER, view->target->framebuffer);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    return result == FACET_OK ? compose(t, view, COMPOSE_WEIGHTED, error) : result;
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
    (*out)->weighted_feature = gl_program_feature(GL_MAIN_SURFACE, "IS_WEIGHTED");
    (*out)->peeled_feature = gl_program_feature(GL_MAIN_SURFACE, "IS_PEELED");
    glGenVertexArrays(1, &(*out)->empty_array);
    glGenQueries(1, &(*out)->query);
    return FACET_OK;
}

void gl_transparency_destroy(gl_transparency *t)
{
    if (!t)
        return;
    sorted_destroy(&t->sorted);
    layers_destroy(&t->layers);
    glDeleteVertexArrays(1, &t->empty_array);
    glDeleteQueries(1, &t->query);
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

static uint64_t mode_features(const gl_transparency *t, facet_transparency mode)
{
    return mode == FACET_TRANSPARENCY_WEIGHTED ? t->weighted_feature
           : mode == FACET_TRANSPARENCY_PEELED ? t->peeled_feature
                                               : 0;
}

facet_result gl_transparency_request(const gl_transparency *t, const gl_transparency_view *view,
                                     facet_error *error)
{
    uint32_t count;
    const gl_batch *batches = gl_mesh_batches(view->meshes, GL_PASS_BLENDED, &count);
    facet_result result = FACET_OK;
    for (uint32_t i = 0; i < count && result == FACET_OK; i++) {
        gl_program_key key = {gl_material_main(view->materials, &batches[i]),
                              gl_material_features(view->materials, &batches[i]) |
                                  gl_mesh_features(view->meshes, &batches[i]) | view->features |
                                  mode_features(t, possible_mode(t->context, view->mode))};
        result = gl_programs_request(view->programs, key, error);
    }
    return result;
}

facet_result gl_transparency_draw(gl_transparency *t, const gl_transparency_view *view, facet_error *error)
{
    uint32_t count;
    gl_mesh_batches(view->meshes, GL_PASS_BLENDED, &count);
    if (count == 0)
        return FACET_OK;
    facet_result result;
    switch (possible_mode(t->context, view->mode)) {
    case FACET_TRANSPARENCY_PEELED:
        result = peeled_draw(t, view, error);
        break;
    case FACET_TRANSPARENCY_WEIGHTED:
        result = weighted_draw(t, view, error);
        break;
    default:
        result = sorted_draw(t, view, error);
        break;
    }
    glBindFramebuffer(GL_FRAMEBUFFER, view->target->framebuffer);
    return result == FACET_OK ? gl_context_check(t->context, "blended surfaces", error) : result;
}
