/* gl_sea_image.c - see gl_sea_image.h. */
#include "gl/sea/gl_sea_image.h"

#include <string.h>

#include "base/result.h"
#include "gl/core/gl_blocks.h"
#include "ibl/environment.h"
#include "ibl/light.h"

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
        gl_sea_forget_light(s);
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
    gl_sea_set_block(s->light_buffer, GL_BLOCK_LIGHT, &block, sizeof block);
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

enum { PROGRAMS = 9, IMAGE_PROGRAMS = 6 };

/* The programs of a frame, those of layers last; returns their number. */
static int list_programs(const water_frame *frame, gl_program_key keys[PROGRAMS])
{
    uint64_t features = features_of(frame), layers = (features & LAYERS) | GL_SEA_AOVS;
    const gl_program_key all[PROGRAMS] = {
        {GL_MAIN_SEA_GRID, 0},
        {GL_MAIN_SEA_SURFACE, 0},
        {GL_MAIN_SEA_CLASS, 0},
        {GL_MAIN_SEA, features | GL_SEA_HAS_CUBIC},
        {GL_MAIN_SEA, features},
        {GL_MAIN_SEA, (features & BESIDE) | GL_SEA_IS_BESIDE},
        {GL_MAIN_SEA, layers | GL_SEA_HAS_CUBIC},
        {GL_MAIN_SEA, layers},
        {GL_MAIN_SEA, (layers & (BESIDE | GL_SEA_AOVS)) | GL_SEA_IS_BESIDE}};
    memcpy(keys, all, sizeof all);
    return frame->desc->aovs ? PROGRAMS : IMAGE_PROGRAMS;
}

facet_result gl_sea_image_request(gl_sea *s, const water_frame *frame, bool *is_ready, facet_error *error)
{
    gl_program_key keys[PROGRAMS];
    int count = list_programs(frame, keys);
    *is_ready = true;
    gl_programs_set_log(s->programs, &frame->desc->log);
    for (int i = 0; i < count; i++)
        TRY(gl_programs_request(s->programs, keys[i], error));
    for (int i = 0; i < count; i++)
        *is_ready &= gl_programs_is_ready(s->programs, keys[i]);
    return FACET_OK;
}

static facet_result get_programs(gl_sea_image *d, facet_error *error)
{
    gl_program_key keys[PROGRAMS];
    GLuint *names[PROGRAMS] = {&d->grid,         &d->surface,       &d->sorting,
                               &d->image.cubic,  &d->image.linear,  &d->image.beside,
                               &d->layers.cubic, &d->layers.linear, &d->layers.beside};
    int count = list_programs(d->frame, keys);
    bool is_ready;
    TRY(gl_sea_image_request(d->s, d->frame, &is_ready, error));
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
static void begin_mean(const gl_sea_image *d)
{
    if (!d->earlier)
        return;
    glEnable(GL_BLEND);
    glBlendColor(0.0f, 0.0f, 0.0f, 1.0f / (float)(1 + d->earlier));
    glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA);
}

/* Pixels of one class. */
static void draw_class(const gl_sea_image *d, double depth)
{
    gl_api_depth_range(d->s->context->is_es, depth, depth);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

/* Shades all pixels; the target's depths are their classes. */
static void draw_classes(const gl_sea_image *d, const gl_sea_programs *programs)
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

/* Restricts drawing to a part of the image, {x, y, width, height}. */
static void clip(const gl_sea_image *d, const gl_target *t, const uint32_t part[4])
{
    uint32_t y = gl_context_is_top_down(d->s->context) ? part[1] : t->height - part[1] - part[3];
    if (!d->is_clipped)
        return;
    glEnable(GL_SCISSOR_TEST);
    glScissor((GLint)part[0], (GLint)y, (GLsizei)part[2], (GLsizei)part[3]);
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

facet_result gl_sea_image_draw_grid(gl_sea_image *d, facet_error *error)
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

static void set_frame(const gl_sea_image *d, const gl_view *view)
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
    gl_sea_set_block(d->s->frame_buffer, GL_BLOCK_FRAME, &block, sizeof block);
}

/* Which water is visible. */
static void draw_seen(const gl_sea_image *d)
{
    const gl_sea *s = d->s;
    begin_pass(&s->seen);
    clip(d, &s->seen, d->frame->desc->crop);
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
    gl_camera_end_depth(s->context);
}

/* First which water is visible, then its class, then its shading, or its layers. */
static void draw_water(const gl_sea_image *d, const gl_sea_programs *programs, const gl_target *target)
{
    const gl_sea *s = d->s;
    if (!d->is_continued)
        draw_seen(d);
    bind_textures(s);
    if (d->has_model)
        (programs == &d->layers ? gl_sea_model_bind_layers : gl_sea_model_bind)(&d->model);
    begin_pass(target);
    clip(d, target, d->part);
    gl_camera_begin_depth(s->context);
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
static facet_result draw_model(gl_sea_image *d, const gl_view *view, bool is_layers, facet_error *error)
{
    if (!d->has_model)
        return FACET_OK;
    return is_layers ? gl_sea_model_draw_layers(&d->model, d->frame, &d->camera, view, error)
                     : gl_sea_model_draw(&d->model, d->frame, &d->camera, view, &d->block, error);
}

facet_result gl_sea_image_draw(gl_sea_image *d, const gl_target *target, const gl_view *view, bool is_layers,
                               facet_error *error)
{
    gl_sea *s = d->s;
    TRY(gl_target_update(&s->seen, s->context, GL_TARGET_FILM, view->width, view->height, 1, error));
    TRY(draw_model(d, view, is_layers, error));
    gl_sea_block block = d->block;
    if (is_layers)
        block.ray[1] = 1.0f;
    gl_sea_set_block(s->sea_buffer, GL_BLOCK_SEA, &block, sizeof block);
    glBindBufferBase(GL_UNIFORM_BUFFER, GL_BLOCK_LIGHT, s->light_buffer);
    set_frame(d, view);
    draw_water(d, is_layers ? &d->layers : &d->image, target);
    return FACET_OK;
}

/* ---- preparation ---- */

facet_result gl_sea_image_prepare(gl_sea_image *d, facet_render_stats *stats, facet_error *error)
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
        result = gl_sea_start(s, error);
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
    gl_sea_set_block(s->sea_buffer, GL_BLOCK_SEA, &d->block, sizeof d->block);
    if (result == FACET_OK)
        result = gl_sea_textures_update(&s->textures, s->context, p, &d->camera, error);
    if (result == FACET_OK)
        result = gl_sea_mesh_update(&s->mesh, s->context, &d->fan, &s->allocator, error);
    return result;
}
