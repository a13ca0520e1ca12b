/* gl_sea.c - see gl_sea.h: what is kept from image to image, and the render passes. */
#include "gl/sea/gl_sea.h"

#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/result.h"
#include "draw/camera_rays.h"
#include "draw/render_watch.h"
#include "gl/core/gl_api.h"
#include "gl/core/gl_blocks.h"
#include "gl/scene/gl_camera.h"
#include "gl/scene/gl_film.h"
#include "gl/scene/gl_light_atlas.h"
#include "gl/core/gl_program.h"
#include "gl/sea/gl_sea_block.h"
#include "gl/sea/gl_sea_model.h"
#include "gl/sea/gl_sea_textures.h"
#include "gl/core/gl_target.h"
#include "ibl/environment.h"
#include "ibl/light.h"

struct gl_sea {
    facet_allocator allocator;
    gl_context own, *context; /* own: {0} before its creation or after its loss */
    gl_api api;               /* of own */
    gl_programs *programs;
    gl_sea_textures textures;
    gl_light_atlas atlas;
    gl_target grid, seen, target;
    /* those whose parts are in the atlas: referenced, so they do not change */
    facet_environment *environments[2];
    gl_sea_mesh mesh;
    GLuint frame_buffer, light_buffer, sea_buffer, empty_array;
};

/* ---- kept state ---- */

static void forget_light(gl_sea *s)
{
    gl_light_atlas_destroy(&s->atlas);
    gl_sea_textures_forget_light(&s->textures);
    for (int i = 0; i < 2; i++) {
        if (s->environments[i])
            environment_release(s->environments[i]);
        s->environments[i] = NULL;
    }
}

/* Frees all OpenGL objects, and its own context. */
static void stop(gl_sea *s)
{
    gl_context spare = {.context = NULL};
    bool is_own = s->context == &s->own;
    if (s->programs && gl_context_make_current_to_delete(s->context, &spare)) {
        gl_programs_destroy(s->programs);
        gl_target_destroy(&s->grid);
        gl_target_destroy(&s->seen);
        gl_target_destroy(&s->target);
        gl_sea_mesh_destroy(&s->mesh);
        const GLuint buffers[] = {s->frame_buffer, s->light_buffer, s->sea_buffer};
        glDeleteBuffers(3, buffers);
        glDeleteVertexArrays(1, &s->empty_array);
        forget_light(s);
        gl_sea_textures_destroy(&s->textures);
    }
    gl_context_destroy(&spare);
    if (is_own)
        gl_context_destroy(&s->own);
    *s = (gl_sea){.allocator = s->allocator, .api = s->api, .context = is_own ? &s->own : s->context};
}

static void set_block(GLuint buffer, GLuint point, const void *block, size_t size)
{
    glBindBuffer(GL_UNIFORM_BUFFER, buffer);
    glBufferData(GL_UNIFORM_BUFFER, (GLsizeiptr)size, block, GL_DYNAMIC_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, point, buffer);
}

static facet_result start(gl_sea *s, facet_error *error)
{
    bool is_own = s->context == &s->own;
    if (is_own && s->own.is_lost)
        stop(s);
    TRY(is_own && !s->own.context ? gl_context_create_api(&s->own, s->api, error)
                                  : gl_context_make_current(s->context, error));
    if (s->programs)
        return FACET_OK;
    TRY(gl_programs_create(s->context, &s->allocator, NULL, &s->programs, error));
    GLuint buffers[3];
    glGenBuffers(3, buffers);
    s->frame_buffer = buffers[0];
    s->light_buffer = buffers[1];
    s->sea_buffer = buffers[2];
    glGenVertexArrays(1, &s->empty_array);
    /* WebGL refuses to draw with a block that has no data, even if the program reads none of it */
    const gl_frame_block no_frame = {.channel = 0};
    const gl_light_block no_light = {.atlas = {0.0f}};
    set_block(s->frame_buffer, GL_BLOCK_FRAME, &no_frame, sizeof no_frame);
    set_block(s->light_buffer, GL_BLOCK_LIGHT, &no_light, sizeof no_light);
    return FACET_OK;
}

static facet_result create(gl_context *context, gl_api wanted, const facet_allocator *allocator, gl_sea **out,
                           facet_error *error)
{
    gl_sea *s = mem_zalloc(allocator, 1, sizeof *s);
    *out = NULL;
    if (!s)
        return fail_memory(error, "renderer", sizeof *s);
    s->allocator = allocator ? *allocator : (facet_allocator){0};
    s->api = wanted;
    s->context = context ? context : &s->own;
    facet_result result = start(s, error);
    if (result != FACET_OK) {
        gl_sea_destroy(s);
        return result;
    }
    gl_context_release(s->context);
    *out = s;
    return FACET_OK;
}

facet_result gl_sea_create(const facet_allocator *allocator, gl_sea **out, facet_error *error)
{
    return create(NULL, GL_API_ANY, allocator, out, error);
}

facet_result gl_sea_create_api(gl_api wanted, const facet_allocator *allocator, gl_sea **out,
                               facet_error *error)
{
    return create(NULL, wanted, allocator, out, error);
}

facet_result gl_sea_create_within(gl_context *context, const facet_allocator *allocator, gl_sea **out,
                                  facet_error *error)
{
    return create(context, GL_API_ANY, allocator, out, error);
}

void gl_sea_destroy(gl_sea *s)
{
    if (!s)
        return;
    stop(s);
    mem_free(s);
}

/* ---- what an image needs ---- */

/* For an image as the sky: the image itself and its filtered light. For the atmosphere, gl_sea_textures.c has
 * everything. */
static facet_result update_light(gl_sea *s, const water_frame *p, facet_error *error)
{
    ibl_light both = *p->reflected;
    if (p->background)
        both.background = p->background->background;
    facet_environment *wanted[2] = {both.environment, p->background ? p->background->environment : NULL};
    if (wanted[0] != s->environments[0] || wanted[1] != s->environments[1]) {
        forget_light(s);
        for (int i = 0; i < 2; i++) {
            s->environments[i] = wanted[i];
            if (wanted[i])
                environment_retain(wanted[i]);
        }
    }
    if (!p->background)
        return FACET_OK;
    gl_light_block block = {.atlas = {0.0f}};
    TRY(gl_light_atlas_update(&s->atlas, s->context, &s->allocator, &both, error));
    gl_light_atlas_describe(&s->atlas, &both, &block);
    set_block(s->light_buffer, GL_BLOCK_LIGHT, &block, sizeof block);
    return FACET_OK;
}

/* Creating a texture binds it to some unit, so this comes after all creations. */
static void bind_textures(const gl_sea *s)
{
    gl_sea_textures_bind(&s->textures);
    gl_sea_texture_bind(GL_UNIT_ENVIRONMENT, GL_TEXTURE_2D, s->atlas.texture);
    gl_sea_texture_bind(GL_UNIT_SHARP, GL_TEXTURE_2D, s->atlas.background);
    gl_sea_texture_bind(GL_UNIT_SEA_GRID, GL_TEXTURE_2D, s->grid.color);
    gl_sea_texture_bind(GL_UNIT_SEA_SEEN, GL_TEXTURE_2D, s->seen.color);
}

static uint64_t features_of(const water_frame *p)
{
    const facet_sea_shading *shading = &p->desc->sea_shading;
    if (sea_shading_is_legacy(shading))
        return GL_SEA_IS_LEGACY | (p->model ? GL_SEA_HAS_MODEL : 0u);
    bool has_bed = sea_has_bed(&p->sea->desc.bed);
    bool has_other_facets = shading->normals == FACET_SEA_NORMALS_GGX ||
                            shading->masking != FACET_SEA_MASKING_SCALES || shading->has_schlick_fresnel;
    bool has_glints = sea_shading_is_complete(shading) && !shading->omits_glints && !p->is_below;
    return (p->background ? GL_SEA_HAS_IMAGE : 0u) | (p->model ? GL_SEA_HAS_MODEL : 0u) |
           (has_other_facets ? GL_SEA_HAS_OTHER_MICROFACETS : 0u) |
           (shading->stage == 3 && !p->is_below ? GL_SEA_IS_PAINTED : 0u) |
           (p->is_below ? GL_SEA_IS_BELOW : 0u) | (has_bed ? GL_SEA_HAS_BED : 0u) |
           (p->foam ? GL_SEA_HAS_FOAM : 0u) | (has_glints ? GL_SEA_HAS_GLINTS : 0u);
}

/* Those that matter beside the water, and for layers. */
static const uint64_t BESIDE =
    GL_SEA_HAS_IMAGE | GL_SEA_IS_LEGACY | GL_SEA_IS_BELOW | GL_SEA_HAS_BED | GL_SEA_HAS_MODEL;
static const uint64_t LAYERS =
    GL_SEA_IS_BELOW | GL_SEA_HAS_BED | GL_SEA_HAS_FOAM | GL_SEA_HAS_MODEL | GL_SEA_HAS_OTHER_MICROFACETS;

/* ---- one image ---- */

/* Programs of GL_MAIN_SEA: for water that is read with cubic filtering and without, and for all other pixels. */
typedef struct pixel_programs {
    GLuint cubic, linear, beside;
} pixel_programs;

/* The state of one image. */
typedef struct drawing {
    gl_sea *s;
    const water_frame *frame;
    camera_rays camera;
    gl_sea_fan fan;
    gl_sea_block block;
    gl_sea_model model;
    bool has_model;
    GLuint grid, surface, sorting; /* programs */
    pixel_programs image, layers;
    bool is_clipped;  /* to the crop, within a target of the whole image */
    uint32_t earlier; /* images in the target, with which the next one is averaged */
} drawing;

static facet_result get_programs(drawing *d, facet_error *error)
{
    uint64_t features = features_of(d->frame), layers = (features & LAYERS) | GL_SEA_AOVS;
    enum { COUNT = 9, IMAGE_COUNT = 6 };
    const gl_program_key keys[COUNT] = {{GL_MAIN_SEA_GRID, 0},
                                        {GL_MAIN_SEA_SURFACE, 0},
                                        {GL_MAIN_SEA_CLASS, 0},
                                        {GL_MAIN_SEA, features | GL_SEA_HAS_CUBIC},
                                        {GL_MAIN_SEA, features},
                                        {GL_MAIN_SEA, (features & BESIDE) | GL_SEA_IS_BESIDE},
                                        {GL_MAIN_SEA, layers | GL_SEA_HAS_CUBIC},
                                        {GL_MAIN_SEA, layers},
                                        {GL_MAIN_SEA, (layers & (BESIDE | GL_SEA_AOVS)) | GL_SEA_IS_BESIDE}};
    GLuint *names[COUNT] = {&d->grid,         &d->surface,       &d->sorting,
                            &d->image.cubic,  &d->image.linear,  &d->image.beside,
                            &d->layers.cubic, &d->layers.linear, &d->layers.beside};
    int count = d->frame->desc->aovs ? COUNT : IMAGE_COUNT;
    gl_programs_set_log(d->s->programs, &d->frame->desc->log);
    for (int i = 0; i < count; i++)
        TRY(gl_programs_request(d->s->programs, keys[i], error));
    for (int i = 0; i < count; i++)
        TRY(gl_programs_get(d->s->programs, keys[i], names[i], error));
    return FACET_OK;
}

/* ---- pixel classes: sea_class.frag ---- */

/* How the tiles of waves are read: those from 0 to cubic_end may be read with cubic filtering, those from
 * linear_begin to linear_end linearly. */
typedef struct pixel_class {
    int32_t cubic_end, linear_begin, linear_end;
} pixel_class;

enum { MAX_CLASSES = 24 };
enum { CLASS_STEP = 8, CLASSES = CLASS_STEP * CLASS_STEP * CLASS_STEP }; /* as in sea_block.glsl */

/* The classes that exist with that many tiles; returns their number. */
static uint32_t list_classes(uint32_t tile_count, pixel_class classes[MAX_CLASSES])
{
    int32_t tiles = (int32_t)tile_count;
    uint32_t count = 0;
    for (int32_t end = 0; end <= tiles; end++)
        classes[count++] = (pixel_class){0, 0, end};
    for (int32_t cubic = 1; cubic <= tiles; cubic++)
        for (int32_t begin = 0; begin <= cubic; begin++)
            if (begin == 0 || begin >= cubic - 1)
                classes[count++] = (pixel_class){cubic, begin, tiles};
    return count;
}

/* What sea_class.frag writes for it, exact in floats. 0 is what is not water. */
static double depth_of(pixel_class c)
{
    return (double)(1 + c.linear_end + CLASS_STEP * (c.linear_begin + CLASS_STEP * c.cubic_end)) / CLASSES;
}

static void use(GLuint program, pixel_class reading)
{
    glUseProgram(program);
    glUniform3i(glGetUniformLocation(program, "u_sea_reading"), reading.cubic_end, reading.linear_begin,
                reading.linear_end);
}

/* The next image counts as much as each of the earlier ones. */
static void begin_mean(const drawing *d)
{
    if (!d->earlier)
        return;
    glEnable(GL_BLEND);
    glBlendColor(0.0f, 0.0f, 0.0f, 1.0f / (float)(1 + d->earlier));
    glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA);
}

/* Pixels of one class. */
static void draw_class(const drawing *d, double depth)
{
    gl_api_depth_range(d->s->context->is_es, depth, depth);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

/* Shades all pixels; the target's depths are their classes. */
static void draw_classes(const drawing *d, const pixel_programs *programs)
{
    pixel_class classes[MAX_CLASSES];
    uint32_t count = list_classes(d->frame->sea->waves.tile_count, classes);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_EQUAL);
    begin_mean(d);
    glUseProgram(programs->beside);
    draw_class(d, 0.0);
    for (uint32_t i = 0; i < count; i++) {
        use(classes[i].cubic_end ? programs->cubic : programs->linear, classes[i]);
        draw_class(d, depth_of(classes[i]));
    }
    gl_api_depth_range(d->s->context->is_es, 0.0, 1.0);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

/* ---- passes ---- */

/* Restricts drawing to the crop. */
static void clip(const drawing *d, const gl_target *t)
{
    const uint32_t *crop = d->frame->desc->crop;
    uint32_t y = gl_camera_is_top_down(d->s->context) ? crop[1] : t->height - crop[1] - crop[3];
    if (!d->is_clipped)
        return;
    glEnable(GL_SCISSOR_TEST);
    glScissor((GLint)crop[0], (GLint)y, (GLsizei)crop[2], (GLsizei)crop[3]);
}

static void begin_pass(const gl_target *t)
{
    glBindFramebuffer(GL_FRAMEBUFFER, t->framebuffer);
    glViewport(0, 0, (GLsizei)t->width, (GLsizei)t->height);
    glFrontFace(GL_CCW); /* a mirrored model leaves GL_CW */
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

/* Moves the nodes of the mesh to the waves. */
static facet_result draw_grid(drawing *d, facet_error *error)
{
    gl_sea *s = d->s;
    TRY(gl_target_update(&s->grid, s->context, GL_TARGET_LAYERED, d->fan.columns, d->fan.rows, 1, error));
    static const GLenum outputs[GL_TARGET_LAYERS] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_NONE};
    begin_pass(&s->grid);
    glDrawBuffers(GL_TARGET_LAYERS, outputs); /* WebGL refuses colors that a shader does not write */
    gl_sea_textures_bind(&s->textures);
    glBindBufferBase(GL_UNIFORM_BUFFER, GL_BLOCK_FRAME,
                     s->frame_buffer); /* WebGL refuses a block without data */
    use(d->grid, (pixel_class){.linear_end = (int32_t)d->frame->sea->waves.tile_count});
    glBindVertexArray(s->empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    return gl_context_check(s->context, "a sea's mesh", error);
}

static void set_frame(const drawing *d, const gl_view *view)
{
    const water_frame *p = d->frame;
    const float *eye = d->camera.origin;
    const float low[3] = {eye[0] - 1000.0f, eye[1] - 1000.0f, eye[2] - 1000.0f};
    const float high[3] = {eye[0] + 1000.0f, eye[1] + 1000.0f, eye[2] + 1000.0f};
    gl_frame_block block = {.channel = 0};
    gl_camera_set(d->s->context, &d->camera, low, high, p->desc->width, p->desc->height, view, &block);
    block.light[0] = p->light_scale;
    block.light[1] = p->rotation_cos;
    block.light[2] = p->rotation_sin;
    block.exposure = p->exposure;
    set_block(d->s->frame_buffer, GL_BLOCK_FRAME, &block, sizeof block);
}

/* First which water is visible, then its class, then its shading, or its layers. */
static void draw_water(const drawing *d, const pixel_programs *programs, const gl_target *target)
{
    const gl_sea *s = d->s;
    begin_pass(&s->seen);
    clip(d, &s->seen);
    gl_camera_begin_depth(s->context);
    glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    bind_textures(s);
    glBindTexture(GL_TEXTURE_2D, s->grid.layers[0]); /* instead of the texture that is rendered to */
    glEnable(GL_CULL_FACE); /* backs of waves are hidden by their fronts, and half of a distant mesh */
    glCullFace(d->frame->is_below ? GL_FRONT : GL_BACK);
    glUseProgram(d->surface);
    gl_sea_mesh_draw(&s->mesh);
    glCullFace(GL_BACK); /* the state other passes expect */
    glBindTexture(GL_TEXTURE_2D, s->seen.color);
    if (d->has_model)
        (programs == &d->layers ? gl_sea_model_bind_layers : gl_sea_model_bind)(&d->model);
    begin_pass(target);
    clip(d, target);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE,
                GL_FALSE); /* WebGL refuses colors that a shader does not write */
    glUseProgram(d->sorting);
    glBindVertexArray(s->empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    draw_classes(d, programs);
    glDisable(GL_SCISSOR_TEST);
    gl_camera_end_depth(s->context);
}

/* Changes OpenGL's bindings. */
static facet_result draw_model(drawing *d, const gl_view *view, bool is_layers, facet_error *error)
{
    if (!d->has_model)
        return FACET_OK;
    return is_layers ? gl_sea_model_draw_layers(&d->model, d->frame, &d->camera, view, error)
                     : gl_sea_model_draw(&d->model, d->frame, &d->camera, view, &d->block, error);
}

/* Layers have one sample per pixel, of its whole footprint. */
static facet_result draw(drawing *d, const gl_target *target, const gl_view *view, bool is_layers,
                         facet_error *error)
{
    gl_sea *s = d->s;
    TRY(gl_target_update(&s->seen, s->context, GL_TARGET_FILM, view->width, view->height, 1, error));
    TRY(draw_model(d, view, is_layers, error));
    gl_sea_block block = d->block;
    if (is_layers)
        block.ray[1] = 1.0f;
    set_block(s->sea_buffer, GL_BLOCK_SEA, &block, sizeof block);
    glBindBufferBase(GL_UNIFORM_BUFFER, GL_BLOCK_LIGHT, s->light_buffer);
    set_frame(d, view);
    draw_water(d, is_layers ? &d->layers : &d->image, target);
    return FACET_OK;
}

static facet_result draw_view(void *self, const gl_target *target, const gl_view *view, facet_error *error)
{
    return draw(self, target, view, false, error);
}

static facet_result draw_layers(void *self, const gl_target *target, const gl_view *view, facet_error *error)
{
    return draw(self, target, view, true, error);
}

static facet_result draw_film(drawing *d, double deadline_s, film *target, facet_error *error)
{
    const facet_render_desc *r = d->frame->desc;
    gl_film_desc drawn = {.context = d->s->context,
                          .render = r,
                          .target = &d->s->target,
                          .sampling = {.scale = 1, .samples = 1, .passes = r->samples ? r->samples : 1},
                          .deadline_s = deadline_s,
                          .self = d,
                          .draw = draw_view,
                          .draw_layers = draw_layers};
    scene_identity *identities = NULL;
    facet_result result = FACET_OK;
    if (r->aovs & SCENE_IDENTITY_AOVS)
        result = gl_sea_model_identify(&d->model, d->frame, &identities, &drawn.identity_count, error);
    drawn.identities = identities;
    if (result == FACET_OK)
        result = gl_film_draw(&drawn, target, error);
    mem_free(identities);
    return result;
}

/* ---- entry points ---- */

static facet_result prepare(drawing *d, facet_render_stats *stats, facet_error *error)
{
    gl_sea *s = d->s;
    const water_frame *p = d->frame;
    const facet_render_desc *r = p->desc;
    facet_result result = camera_rays_create(r->camera, r->width, r->height, &d->camera, error);
    if (result == FACET_OK && d->camera.is_orthographic)
        result = fail(error, FACET_ERROR_UNSUPPORTED,
                      "sea: OpenGL draws its waves as a mesh around one eye, which an orthographic camera "
                      "does not have; use the preview or path tracing");
    if (result == FACET_OK)
        result = start(s, error);
    if (result == FACET_OK)
        result = get_programs(d, error);
    if (result != FACET_OK)
        return result;
    d->fan = gl_sea_fan_of(p, &d->camera, (uint32_t)s->context->max_texture_size);
    gl_sea_block_fill(p, &d->camera, &d->fan, &d->block);
    d->has_model = (features_of(p) & GL_SEA_HAS_MODEL) != 0;
    if (d->has_model)
        result = gl_sea_model_begin(&d->model, s->context, p, &d->camera, &d->block, stats, error);
    if (result == FACET_OK)
        result = update_light(s, p, error);
    set_block(s->sea_buffer, GL_BLOCK_SEA, &d->block, sizeof d->block);
    if (result == FACET_OK)
        result = gl_sea_textures_update(&s->textures, s->context, p, &d->camera, error);
    if (result == FACET_OK)
        result = gl_sea_mesh_update(&s->mesh, s->context, &d->fan, &s->allocator, error);
    return result;
}

facet_result gl_sea_draw(gl_sea *s, const water_frame *frame, film *target, facet_render_stats *stats,
                         facet_error *error)
{
    double begin = clock_seconds();
    const facet_render_desc *r = frame->desc;
    double deadline_s = r->time_limit_s > 0.0 ? begin + r->time_limit_s : 0.0;
    drawing d = {.s = s, .frame = frame};
    facet_result result = render_check_limits(r, "prepare", 0.0, deadline_s, error);
    if (result == FACET_OK)
        result = prepare(&d, stats, error);
    double drawing_begin = clock_seconds();
    stats->geometry_s += drawing_begin - begin;
    if (result == FACET_OK)
        result = draw_grid(&d, error);
    if (result == FACET_OK)
        result = draw_film(&d, deadline_s, target, error);
    if (result == FACET_OK)
        result = render_check_limits(r, "shade", 1.0, 0.0, error);
    stats->shade_s += clock_seconds() - drawing_begin;
    stats->total_s = stats->light_s + (clock_seconds() - begin);
    gl_sea_model_end(&d.model);
    if (result == FACET_ERROR_MEMORY || s->context->is_lost)
        stop(s);
    gl_context_release(s->context);
    return result;
}

/* ---- a window's frame ---- */

/* Tone-maps the crop of a target into a framebuffer, where the whole image has its lower left corner at (x, y). */
static facet_result show(const drawing *d, const gl_target *mean, const gl_sea_place *to, facet_error *error)
{
    const gl_sea *s = d->s;
    const facet_render_desc *r = d->frame->desc;
    bool is_top_down = gl_camera_is_top_down(s->context);
    const gl_program_key key = {GL_MAIN_PRESENT,
                                is_top_down ? gl_program_feature(GL_MAIN_PRESENT, "IS_TOP_DOWN") : 0};
    const gl_frame_block block = {.size = {(float)r->width, (float)r->height, (float)to->x, (float)to->y},
                                  .tonemap = (float)r->tonemap};
    GLuint program;
    TRY(gl_programs_get(s->programs, key, &program, error));
    set_block(s->frame_buffer, GL_BLOCK_FRAME, &block, sizeof block);
    glBindFramebuffer(GL_FRAMEBUFFER, to->framebuffer);
    glViewport(to->x, to->y, (GLsizei)r->width, (GLsizei)r->height);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_SCISSOR_TEST);
    glScissor(to->x + (GLint)r->crop[0], to->y + (GLint)(r->height - r->crop[1] - r->crop[3]),
              (GLsizei)r->crop[2], (GLsizei)r->crop[3]);
    gl_sea_texture_bind(0, GL_TEXTURE_2D, mean->color);
    glUseProgram(program);
    glBindVertexArray(s->empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisable(GL_SCISSOR_TEST);
    gl_sea_texture_bind(0, GL_TEXTURE_2D, 0); /* the next image is rendered to it */
    return gl_context_check(s->context, "the window", error);
}

/* The samples of an image lie where those of gl_film_draw() do. */
static facet_result draw_sample(drawing *d, gl_target *mean, uint32_t pass, facet_error *error)
{
    const facet_render_desc *r = d->frame->desc;
    const gl_sampling sampling = {.scale = 1, .samples = 1, .passes = r->samples ? r->samples : 1};
    float *jitter = mem_alloc(&r->allocator, sampling.passes, 2 * sizeof *jitter);
    if (!jitter)
        return fail_memory(error, "samples", sampling.passes * 2 * sizeof *jitter);
    gl_sampling_jitter(&sampling, jitter);
    const gl_view all = {.scale = 1,
                         .width = r->width,
                         .height = r->height,
                         .jitter = {jitter[2 * pass], jitter[2 * pass + 1]}};
    mem_free(jitter);
    TRY(gl_target_update(mean, d->s->context, GL_TARGET_WINDOW, r->width, r->height, 1, error));
    return draw(d, mean, &all, false, error);
}

facet_result gl_sea_present(gl_sea *s, const water_frame *frame, gl_target *mean, uint32_t pass,
                            const gl_sea_place *to, facet_render_stats *stats, facet_error *error)
{
    double begin = clock_seconds();
    drawing d = {.s = s, .frame = frame, .is_clipped = true, .earlier = pass};
    bool is_complete = pass > 0 && pass >= frame->desc->samples;
    facet_result result = is_complete ? start(s, error) : prepare(&d, stats, error);
    if (result == FACET_OK && !is_complete)
        result = draw_grid(&d, error);
    if (result == FACET_OK && !is_complete)
        result = draw_sample(&d, mean, pass, error);
    if (result == FACET_OK)
        result = show(&d, mean, to, error);
    gl_sea_model_end(&d.model);
    stats->shade_s += clock_seconds() - begin;
    return result;
}
