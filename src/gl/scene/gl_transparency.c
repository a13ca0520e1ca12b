/* gl_transparency.c - see gl_transparency.h: the choice, and what is common to the ways. */
#include "gl/scene/gl_transparency_set.h"

#include <epoxy/gl.h>

#include "base/memory.h"
#include "base/result.h"

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
    gl_sorted_destroy(&t->sorted);
    gl_layers_destroy(&t->layers);
    glDeleteVertexArrays(1, &t->empty_array);
    glDeleteQueries(1, &t->query);
    mem_free(t);
}

/* Peeling takes a texture unit beside those of materials. */
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

facet_result gl_transparency_use(const gl_transparency_view *view, const gl_batch *b, uint64_t features,
                                 facet_error *error)
{
    uint32_t program;
    gl_program_key key = {gl_material_main(view->materials, b), b->features | view->features | features};
    facet_result result = gl_programs_get(view->programs, key, &program, error);
    if (result != FACET_OK)
        return result;
    glUseProgram(program);
    gl_material_bind(view->materials, b);
    return FACET_OK;
}

facet_result gl_transparency_draw_all(const gl_transparency_view *view, uint64_t features, facet_error *error)
{
    uint32_t count;
    const gl_batch *batches = gl_mesh_batches(view->meshes, GL_PASS_BLENDED, &count);
    for (uint32_t i = 0; i < count; i++) {
        if (batches[i].is_outside)
            continue;
        facet_result result = gl_transparency_use(view, &batches[i], features, error);
        if (result != FACET_OK)
            return result;
        gl_mesh_draw(view->meshes, &batches[i]);
    }
    return FACET_OK;
}

facet_result gl_transparency_compose(gl_transparency *t, const gl_transparency_view *view, gl_compose what,
                                     facet_error *error)
{
    static const char *const features[] = {
        [GL_COMPOSE_LAYER] = "", [GL_COMPOSE_SUM] = "IS_SUM", [GL_COMPOSE_WEIGHTED] = "IS_WEIGHTED"};
    uint32_t program;
    gl_program_key key = {GL_MAIN_COMPOSE, gl_program_feature(GL_MAIN_COMPOSE, features[what])};
    facet_result result = gl_programs_get(view->programs, key, &program, error);
    if (result != FACET_OK)
        return result;
    glUseProgram(program);
    if (what == GL_COMPOSE_WEIGHTED)
        gl_layers_bind(GL_UNIT_MATERIAL + 1, t->layers.layer);
    gl_layers_bind(GL_UNIT_MATERIAL, what == GL_COMPOSE_LAYER ? t->layers.layer : t->layers.sum);
    glDisable(GL_CULL_FACE);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBindVertexArray(t->empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    return FACET_OK;
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
        result = gl_peeled_draw(t, view, error);
        break;
    case FACET_TRANSPARENCY_WEIGHTED:
        result = gl_weighted_draw(t, view, error);
        break;
    default:
        result = gl_sorted_draw(t, view, error);
        break;
    }
    glBindFramebuffer(GL_FRAMEBUFFER, view->target->framebuffer);
    return result == FACET_OK ? gl_context_check(t->context, "blended surfaces", error) : result;
}
