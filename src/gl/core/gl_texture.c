/* gl_texture.c - see gl_texture.h. An image becomes one texture per interpretation (as color, as data),
 * shared by all textures of the scene that refer to it. Wrapping and filtering are in sampler objects. */
#include "gl/core/gl_texture.h"

#include "base/memory.h"
#include "base/result.h"
#include "draw/texture_store.h"
#include "gl/core/gl_api.h"
#include "image/half.h"

enum {
    WRAPS = 3,
    FILTERS = 2,
    BAND_TEXELS = 1 << 20, /* texels that are converted at a time */
    MIP_FILTERS = 3,
    SAMPLER_COUNT = WRAPS * WRAPS * FILTERS * FILTERS * MIP_FILTERS
};

/* An image as data and as color. */
typedef struct gl_image {
    GLuint names[2];
    uint32_t sizes[2][2]; /* texels: width and height */
    float means[2][4];    /* linear RGBA */
    bool is_known[2];     /* uploaded, or failed */
    bool lacks_red;       /* read as data */
} gl_image;

struct gl_texture_set {
    gl_context *context;
    const facet_scene *scene;
    facet_allocator allocator;
    gl_image *images;     /* of the scene */
    uint32_t image_count; /* the scene may have been given more images since */
    GLuint samplers[SAMPLER_COUNT];
    uint64_t decoded_texels;
};

facet_result gl_texture_create(gl_context *context, const facet_scene *scene,
                               const facet_allocator *allocator, gl_texture_set **out, facet_error *error)
{
    gl_texture_set *set = mem_zalloc(allocator, 1, sizeof *set);
    *out = set;
    if (!set)
        return fail_memory(error, "textures", sizeof *set);
    set->context = context;
    set->scene = scene;
    set->image_count = scene->image_count;
    set->allocator = allocator ? *allocator : (facet_allocator){0};
    set->images = mem_zalloc(allocator, scene->image_count, sizeof *set->images);
    if (set->images)
        return FACET_OK;
    gl_texture_destroy(set);
    *out = NULL;
    return fail_memory(error, "textures", scene->image_count * sizeof *set->images);
}

void gl_texture_destroy(gl_texture_set *set)
{
    if (!set)
        return;
    for (uint32_t i = 0; set->images && i < set->image_count; i++)
        glDeleteTextures(2, set->images[i].names);
    glDeleteSamplers(SAMPLER_COUNT, set->samplers);
    mem_free(set->images);
    mem_free(set);
}

/* ---- texels as they are uploaded ---- */

/* Expands gray to RGB and missing alpha to 1: channel swizzles are not available everywhere. */
static void expand_8(const unsigned char *in, size_t count, uint32_t channel_count, unsigned char *out)
{
    bool is_gray = channel_count < 3;
    bool has_alpha = channel_count == 2 || channel_count == 4;
    for (size_t i = 0; i < count; i++, in += channel_count, out += 4) {
        out[0] = in[0];
        out[1] = in[is_gray ? 0 : 1];
        out[2] = in[is_gray ? 0 : 2];
        out[3] = has_alpha ? in[channel_count - 1] : 255;
    }
}

static void expand_16(const uint16_t *in, size_t count, uint32_t channel_count, uint16_t *out)
{
    bool is_gray = channel_count < 3;
    bool has_alpha = channel_count == 2 || channel_count == 4;
    for (size_t i = 0; i < count; i++, in += channel_count, out += 4) {
        const uint16_t rgba[4] = {in[0], in[is_gray ? 0 : 1], in[is_gray ? 0 : 2],
                                  has_alpha ? in[channel_count - 1] : 65535};
        for (int c = 0; c < 4; c++)
            out[c] = half_from_float((float)rgba[c] * (1.0f / 65535.0f));
    }
}

/* Rows that are converted at a time. */
static uint32_t band_rows(uint32_t width)
{
    return width < BAND_TEXELS ? BAND_TEXELS / width : 1;
}

static GLenum internal_format(const texture_pyramid *p, bool as_color)
{
    return p->type != IMAGE_U8 ? GL_RGBA16F : as_color ? GL_SRGB8_ALPHA8 : GL_RGBA8;
}

void gl_texture_allocate(const gl_context *context, uint32_t level_count, uint32_t format, uint32_t width,
                         uint32_t height)
{
    if (context->has_texture_storage) {
        glTexStorage2D(GL_TEXTURE_2D, (GLsizei)level_count, format, (GLsizei)width, (GLsizei)height);
        return;
    }
    const GLenum type = format == GL_RGBA16F ? GL_HALF_FLOAT : GL_UNSIGNED_BYTE;
    for (uint32_t level = 0; level < level_count; level++)
        glTexImage2D(GL_TEXTURE_2D, (GLint)level, (GLint)format,
                     (GLsizei)(width >> level ? width >> level : 1),
                     (GLsizei)(height >> level ? height >> level : 1), 0, GL_RGBA, type, NULL);
}

/* Uploads one level; buffer holds one band of it. */
static void upload_level(const texture_pyramid *p, uint32_t level, GLint gl_level, void *buffer)
{
    const texture_level *l = &p->levels[level];
    const bool is_8 = p->type == IMAGE_U8;
    const GLenum type = is_8 ? GL_UNSIGNED_BYTE : GL_HALF_FLOAT;
    const size_t row_size = (size_t)l->width * p->channel_count * image_type_size(p->type);
    for (uint32_t y = 0, rows; y < l->height; y += rows) {
        const unsigned char *from = l->texels + y * row_size;
        const void *texels = buffer;
        rows = band_rows(l->width) < l->height - y ? band_rows(l->width) : l->height - y;
        const size_t count = (size_t)l->width * rows;
        if (!is_8)
            expand_16((const uint16_t *)(const void *)from, count, p->channel_count, buffer);
        else if (p->channel_count == 4)
            texels = from;
        else
            expand_8(from, count, p->channel_count, buffer);
        glTexSubImage2D(GL_TEXTURE_2D, gl_level, 0, (GLint)y, (GLsizei)l->width, (GLsizei)rows, GL_RGBA, type,
                        texels);
    }
}

/* Uploads the levels from first on. */
static facet_result upload(gl_texture_set *set, const texture_pyramid *p, uint32_t first, bool as_color,
                           GLuint *name, facet_error *error)
{
    size_t texel_size = p->type == IMAGE_U8 ? 4 : 8;
    const texture_level *l = &p->levels[first];
    const size_t whole = (size_t)l->width * l->height;
    const size_t band = l->width < BAND_TEXELS ? BAND_TEXELS : l->width;
    const size_t count = band < whole ? band : whole;
    void *buffer = mem_alloc(&set->allocator, count, texel_size);
    if (!buffer)
        return fail_memory(error, "textures", count * texel_size);
    glGenTextures(1, name);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, *name);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl_texture_allocate(set->context, p->level_count - first, internal_format(p, as_color), l->width,
                        l->height);
    for (uint32_t level = first; level < p->level_count; level++)
        upload_level(p, level, (GLint)(level - first), buffer);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, (GLint)(p->level_count - 1 - first));
    mem_free(buffer);
    return gl_context_check(set->context, "textures", error);
}

/* Linear RGBA of the coarsest level. */
static void find_mean(const texture_pyramid *p, float mean[4])
{
    const unsigned char *texel = p->levels[p->level_count - 1].texels;
    const bool is_gray = p->channel_count < 3, has_alpha = p->channel_count == 2 || p->channel_count == 4;
    for (uint32_t c = 0; c < 4; c++) {
        const uint32_t from = c == 3 ? p->channel_count - 1 : is_gray ? 0 : c;
        if (c == 3 && !has_alpha)
            mean[c] = 1.0f;
        else if (p->type == IMAGE_U8)
            mean[c] = (c == 3 ? p->alpha_values : p->color_values)[texel[from]];
        else
            mean[c] = (float)((const uint16_t *)(const void *)texel)[from] * (1.0f / 65535.0f);
    }
}

/* ---- selection ---- */

/* The finest level within OpenGL's size limit. */
static uint32_t find_first_level(const gl_texture_set *set, uint32_t width, uint32_t height)
{
    uint32_t most = (uint32_t)set->context->max_texture_size;
    uint32_t level = 0;
    while (width >> level > most || height >> level > most)
        level++;
    return level;
}

/* Adds the missing images to wants, each once; returns their number. */
static size_t collect_wants(const gl_texture_set *set, const texture_use *uses, texture_want *wants)
{
    const facet_scene *scene = set->scene;
    for (uint32_t t = 0; t < scene->texture_count; t++) {
        uint32_t number = scene->textures[t].image;
        if (number >= scene->image_count || !scene->images[number].bytes)
            continue;
        const bool is_read[2] = {uses[t].is_read_as_data, uses[t].is_read_as_color};
        for (int as_color = 0; as_color < 2; as_color++) {
            if (!is_read[as_color] || set->images[number].is_known[as_color])
                continue;
            wants[number].is_read[as_color] = true;
            float size[2];
            if (texture_full_size(scene, t, size))
                wants[number].min_lod = (float)find_first_level(set, (uint32_t)size[0], (uint32_t)size[1]);
        }
    }
    return texture_wants_compact(wants, scene->image_count);
}

static void warn_reduced(const gl_texture_set *set, const texture_want *want, const texture_pyramid *p,
                         const facet_log *log)
{
    const texture_level *l = &p->levels[want->first_level];
    const scene_address at = scene_get_address(set->scene, SCENE_ITEM_IMAGE, want->image);
    log_warning(log, "%s: image %u: %u x %u texels exceed OpenGL's maximum of %d; it is drawn with %u x %u",
                at.source, at.number, p->width, p->height, set->context->max_texture_size, l->width,
                l->height);
}

static facet_result upload_want(gl_texture_set *set, const texture_want *want, const facet_log *log,
                                facet_error *error)
{
    gl_image *record = &set->images[want->image];
    bool is_reported = false;
    for (int as_color = 0; as_color < 2; as_color++) {
        if (!want->is_read[as_color])
            continue;
        const texture_pyramid *p = want->pyramid[as_color];
        if (p) {
            if (want->first_level && !is_reported)
                warn_reduced(set, want, p, log);
            is_reported = true;
            TRY(upload(set, p, want->first_level, as_color, &record->names[as_color], error));
            record->sizes[as_color][0] = p->levels[want->first_level].width;
            record->sizes[as_color][1] = p->levels[want->first_level].height;
            find_mean(p, record->means[as_color]);
        }
        record->is_known[as_color] = true;
        record->lacks_red |= p && p->lacks_red;
    }
    return FACET_OK;
}

facet_result gl_texture_update(gl_texture_set *set, const texture_use *uses, const facet_log *log,
                               uint32_t thread_count, facet_error *error)
{
    texture_store *store = NULL; /* destroyed after the upload */
    texture_want *wants = mem_zalloc(&set->allocator, set->scene->image_count, sizeof *wants);
    if (!wants)
        return fail_memory(error, "textures", set->scene->image_count * sizeof *wants);
    size_t count = collect_wants(set, uses, wants);
    facet_result result = FACET_OK;
    if (count)
        result = texture_store_create(set->scene, &set->allocator, &store, error);
    if (count && result == FACET_OK)
        result = texture_store_get(store, wants, count, log, thread_count, &set->decoded_texels, error);
    for (size_t i = 0; i < count && result == FACET_OK; i++)
        result = upload_want(set, &wants[i], log, error);
    texture_store_destroy(store);
    mem_free(wants);
    return result;
}

uint32_t gl_texture_name(const gl_texture_set *set, uint32_t texture, bool as_color)
{
    uint32_t number = texture < set->scene->texture_count ? set->scene->textures[texture].image : SCENE_NONE;
    return number < set->scene->image_count ? set->images[number].names[as_color] : 0;
}

const uint32_t *gl_texture_size(const gl_texture_set *set, uint32_t texture, bool as_color)
{
    static const uint32_t none[2];
    uint32_t number = texture < set->scene->texture_count ? set->scene->textures[texture].image : SCENE_NONE;
    return number < set->scene->image_count ? set->images[number].sizes[as_color] : none;
}

void gl_texture_mean(const gl_texture_set *set, uint32_t texture, bool as_color, float mean[4])
{
    uint32_t number = texture < set->scene->texture_count ? set->scene->textures[texture].image : SCENE_NONE;
    bool is_there = number < set->scene->image_count && set->images[number].names[as_color];
    for (int c = 0; c < 4; c++)
        mean[c] = is_there ? set->images[number].means[as_color][c] : 1.0f;
}

bool gl_texture_lacks_red(const gl_texture_set *set, uint32_t texture)
{
    uint32_t number = texture < set->scene->texture_count ? set->scene->textures[texture].image : SCENE_NONE;
    return number < set->scene->image_count && set->images[number].lacks_red;
}

uint64_t gl_texture_decoded_texels(const gl_texture_set *set)
{
    return set->decoded_texels;
}

/* ---- samplers ---- */

static void set_sampler(GLuint name, const scene_texture *t)
{
    static const GLint wraps[WRAPS] = {[SCENE_WRAP_REPEAT] = GL_REPEAT,
                                       [SCENE_WRAP_CLAMP] = GL_CLAMP_TO_EDGE,
                                       [SCENE_WRAP_MIRROR] = GL_MIRRORED_REPEAT};
    static const GLint filters[FILTERS] = {
        [SCENE_FILTER_LINEAR] = GL_LINEAR, [SCENE_FILTER_NEAREST] = GL_NEAREST};
    static const GLint minifiers[FILTERS][MIP_FILTERS] = {
        [SCENE_FILTER_LINEAR] = {[SCENE_MIP_LINEAR] = GL_LINEAR_MIPMAP_LINEAR,
                                 [SCENE_MIP_NEAREST] = GL_LINEAR_MIPMAP_NEAREST,
                                 [SCENE_MIP_NONE] = GL_LINEAR},
        [SCENE_FILTER_NEAREST] = {[SCENE_MIP_LINEAR] = GL_NEAREST_MIPMAP_LINEAR,
                                  [SCENE_MIP_NEAREST] = GL_NEAREST_MIPMAP_NEAREST,
                                  [SCENE_MIP_NONE] = GL_NEAREST}};
    glSamplerParameteri(name, GL_TEXTURE_WRAP_S, wraps[t->wrap_u]);
    glSamplerParameteri(name, GL_TEXTURE_WRAP_T, wraps[t->wrap_v]);
    glSamplerParameteri(name, GL_TEXTURE_MAG_FILTER, filters[t->mag_filter]);
    glSamplerParameteri(name, GL_TEXTURE_MIN_FILTER, minifiers[t->min_filter][t->mip_filter]);
}

uint32_t gl_texture_sampler(gl_texture_set *set, uint32_t texture)
{
    static const scene_texture plain = {.wrap_u = SCENE_WRAP_REPEAT};
    const scene_texture *t = texture < set->scene->texture_count ? &set->scene->textures[texture] : &plain;
    uint32_t i = (uint32_t)t->wrap_u;
    i = WRAPS * i + (uint32_t)t->wrap_v;
    i = FILTERS * i + (uint32_t)t->mag_filter;
    i = FILTERS * i + (uint32_t)t->min_filter;
    i = MIP_FILTERS * i + (uint32_t)t->mip_filter;
    if (!set->samplers[i]) {
        glGenSamplers(1, &set->samplers[i]);
        set_sampler(set->samplers[i], t);
    }
    return set->samplers[i];
}
