/* gl_layers.c - see gl_layers.h. */
#include "gl/scene/gl_layers.h"

#include <math.h>

#include "base/result.h"
#include "gl/core/gl_api.h"

typedef enum compose_mode { COMPOSE_LAYER, COMPOSE_SUM, COMPOSE_WEIGHTED } compose_mode;

/* ---- textures ---- */

void gl_layers_create(gl_layers *l, gl_context *context)
{
    *l = (gl_layers){.context = context,
                     .weighted_feature = gl_program_feature(GL_MAIN_SURFACE, "IS_WEIGHTED"),
                     .peeled_feature = gl_program_feature(GL_MAIN_SURFACE, "IS_PEELED")};
    glGenVertexArrays(1, &l->empty_array);
    glGenQueries(1, &l->query);
}

/* Deletes textures and framebuffers. */
static void clear(gl_layers *l)
{
    glDeleteFramebuffers(3, l->framebuffers);
    glDeleteRenderbuffers(2, l->renderbuffers);
    glDeleteTextures(2, l->depths);
    glDeleteTextures(1, &l->sum);
    glDeleteTextures(1, &l->layer);
    *l = (gl_layers){.context = l->context,
                     .empty_array = l->empty_array,
                     .query = l->query,
                     .weighted_feature = l->weighted_feature,
                     .peeled_feature = l->peeled_feature};
}

void gl_layers_destroy(gl_layers *l)
{
    clear(l);
    glDeleteVertexArrays(1, &l->empty_array);
    glDeleteQueries(1, &l->query);
    *l = (gl_layers){.width = 0};
}

uint64_t gl_layers_features(const gl_layers *l, facet_transparency mode)
{
    return mode == FACET_TRANSPARENCY_WEIGHTED ? l->weighted_feature
           : mode == FACET_TRANSPARENCY_PEELED ? l->peeled_feature
                                               : 0;
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

static void make_peeled(gl_layers *l, GLenum format)
{
    l->layer = make_texture(format, l->width, l->height);
    for (int i = 0; i < 2; i++) {
        l->depths[i] = make_texture(GL_DEPTH_COMPONENT32F, l->width, l->height);
        attach(l->framebuffers[i], l->layer, l->depths[i]);
    }
    attach(l->framebuffers[2], l->sum, 0);
}

static void make_weighted(gl_layers *l, GLenum format)
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

static facet_result update(gl_layers *l, const gl_transparency_view *view, facet_error *error)
{
    const gl_target *target = view->target;
    if (l->width == target->width && l->height == target->height && l->samples == target->samples &&
        l->mode == view->mode)
        return FACET_OK;
    bool blends_floats =
        l->context->has_float_target && (!l->context->is_es || gl_api_has_extension("GL_EXT_float_blend"));
    GLenum format = blends_floats ? GL_RGBA32F : GL_RGBA16F;
    clear(l);
    l->mode = view->mode;
    l->width = target->width;
    l->height = target->height;
    l->samples = target->samples;
    glGenFramebuffers(3, l->framebuffers);
    l->sum = make_texture(format, l->width, l->height);
    if (view->mode == FACET_TRANSPARENCY_PEELED)
        make_peeled(l, format);
    else
        make_weighted(l, format);
    facet_result result = gl_context_check_framebuffer(
        l->context, "blended surfaces", "blending into floating point images is not supported", error);
    if (result != FACET_OK)
        clear(l);
    return result;
}

static void bind(uint32_t unit, uint32_t texture)
{
    glBindSampler(unit, 0); /* without a sampler that expects mips */
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, texture);
}

/* Blends a layer texture over the bound framebuffer, with the current blend function. */
static facet_result compose(const gl_layers *l, const gl_transparency_view *view, compose_mode what,
                            facet_error *error)
{
    static const char *const features[] = {
        [COMPOSE_LAYER] = "", [COMPOSE_SUM] = "IS_SUM", [COMPOSE_WEIGHTED] = "IS_WEIGHTED"};
    uint32_t program;
    gl_program_key key = {GL_MAIN_COMPOSE, gl_program_feature(GL_MAIN_COMPOSE, features[what])};
    TRY(gl_programs_get(view->programs, key, &program, error));
    glUseProgram(program);
    if (what == COMPOSE_WEIGHTED)
        bind(GL_UNIT_MATERIAL + 1, l->layer);
    bind(GL_UNIT_MATERIAL, what == COMPOSE_LAYER ? l->layer : l->sum);
    glDisable(GL_CULL_FACE);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBindVertexArray(l->empty_array);
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

static facet_result draw_all(const gl_transparency_view *view, uint64_t features, facet_error *error)
{
    uint32_t count;
    const gl_batch *batches = gl_mesh_batches(view->meshes, GL_PASS_BLENDED, &count);
    for (uint32_t i = 0; i < count; i++) {
        if (batches[i].is_outside)
            continue;
        TRY(gl_material_use(view->materials, view->programs, &batches[i],
                            batches[i].features | view->features | features, error));
        gl_mesh_draw(view->meshes, &batches[i]);
    }
    return FACET_OK;
}

/* Draws the next layer: the nearest surfaces behind the last layer and in front of opaque ones. False:
 * there is none. Browsers do not say, and draw empty layers. */
static bool draw_layer(const gl_layers *l, const gl_transparency_view *view, int number, facet_result *result,
                       facet_error *error)
{
    GLint w = (GLint)l->width, h = (GLint)l->height;
    GLuint framebuffer = l->framebuffers[number & 1];
    glBindFramebuffer(GL_READ_FRAMEBUFFER, view->target->framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    glBlitFramebuffer(0, 0, w, h, 0, 0, w, h, GL_DEPTH_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    clear_color(0, 0.0f, 0.0f);
    bind(GL_UNIT_PEELED, l->depths[1 - (number & 1)]);
    if (!gl_api_has_query_results()) {
        *result = draw_all(view, l->peeled_feature, error);
        return *result == FACET_OK;
    }
    glBeginQuery(GL_ANY_SAMPLES_PASSED, l->query);
    *result = draw_all(view, l->peeled_feature, error);
    glEndQuery(GL_ANY_SAMPLES_PASSED);
    GLuint is_seen = 0;
    glGetQueryObjectuiv(l->query, GL_QUERY_RESULT, &is_seen);
    return is_seen && *result == FACET_OK;
}

/* Composites the layer under the previous ones. */
static facet_result add_layer(const gl_layers *l, const gl_transparency_view *view, facet_error *error)
{
    glBindFramebuffer(GL_FRAMEBUFFER, l->framebuffers[2]);
    glBlendFuncSeparate(GL_DST_ALPHA, GL_ONE, GL_ZERO, GL_ONE_MINUS_SRC_ALPHA);
    return compose(l, view, COMPOSE_LAYER, error);
}

static facet_result draw_peeled(const gl_layers *l, const gl_transparency_view *view, facet_error *error)
{
    const float nearest = l->context->has_clip_control ? 1.0f : 0.0f;
    glBindFramebuffer(GL_FRAMEBUFFER, l->framebuffers[1]);
    glClearBufferfv(GL_DEPTH, 0, &nearest);
    glBindFramebuffer(GL_FRAMEBUFFER, l->framebuffers[2]);
    clear_color(0, 0.0f, 1.0f);
    facet_result result = FACET_OK;
    for (int i = 0; i < GL_TRANSPARENCY_LAYERS && draw_layer(l, view, i, &result, error); i++)
        TRY(add_layer(l, view, error));
    TRY(result);
    glBindFramebuffer(GL_FRAMEBUFFER, view->target->framebuffer);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    return compose(l, view, COMPOSE_SUM, error);
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

static facet_result draw_weighted_batches(const gl_layers *l, const gl_transparency_view *view,
                                          facet_error *error)
{
    uint32_t count;
    const gl_batch *batches = gl_mesh_batches(view->meshes, GL_PASS_BLENDED, &count);
    float depths[2];
    find_depths(view, depths);
    for (uint32_t i = 0; i < count; i++) {
        if (batches[i].is_outside)
            continue;
        TRY(gl_material_use(view->materials, view->programs, &batches[i],
                            batches[i].features | view->features | l->weighted_feature, error));
        GLint program;
        glGetIntegerv(GL_CURRENT_PROGRAM, &program);
        glUniform2fv(glGetUniformLocation((GLuint)program, "u_depths"), 1, depths);
        gl_mesh_draw(view->meshes, &batches[i]);
    }
    return FACET_OK;
}

static void resolve(const gl_layers *l)
{
    GLint w = (GLint)l->width, h = (GLint)l->height;
    for (GLuint i = 0; i < 2 && l->samples > 1; i++) {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, l->framebuffers[0]);
        glReadBuffer(GL_COLOR_ATTACHMENT0 + i);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, l->framebuffers[1 + i]);
        glBlitFramebuffer(0, 0, w, h, 0, 0, w, h, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    }
}

static facet_result draw_weighted(const gl_layers *l, const gl_transparency_view *view, facet_error *error)
{
    glBindFramebuffer(GL_FRAMEBUFFER, l->framebuffers[0]);
    if (l->samples > 1)
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
    facet_result result = draw_weighted_batches(l, view, error);
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
    resolve(l);
    glBindFramebuffer(GL_FRAMEBUFFER, view->target->framebuffer);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    return result == FACET_OK ? compose(l, view, COMPOSE_WEIGHTED, error) : result;
}

facet_result gl_layers_draw(gl_layers *l, const gl_transparency_view *view, facet_error *error)
{
    TRY(update(l, view, error));
    return view->mode == FACET_TRANSPARENCY_PEELED ? draw_peeled(l, view, error)
                                                   : draw_weighted(l, view, error);
}
