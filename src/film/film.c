/* film.c - see film.h: the layers of a film, and tone mapping from radiance to display values. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "film/film.h"

#include "shade/lang/lang_c_load.h"

/* ---- layers ---- */

/* The layers that a film can have beside the image. */
typedef struct layer_kind {
    uint32_t aov; /* 0: always there */
    const char *name;
    uint32_t channel_count;
    const char *channel_names[4];
    float background;
    bool needs_float;
} layer_kind;

#define CRYPTOMATTE_RANKS(NAME, RANK)                                                                        \
    {                                                                                                        \
        NAME RANK ".R", NAME RANK ".G", NAME RANK ".B", NAME RANK ".A"                                       \
    }
#define CRYPTOMATTE_LAYER(AOV, NAME, RANK)                                                                   \
    {                                                                                                        \
        AOV, NAME RANK, 4, CRYPTOMATTE_RANKS(NAME, RANK), 0.0f, true                                         \
    }
#define CRYPTOMATTE_LAYERS(AOV, NAME)                                                                        \
    CRYPTOMATTE_LAYER(AOV, NAME, "00"), CRYPTOMATTE_LAYER(AOV, NAME, "01"), CRYPTOMATTE_LAYER(AOV, NAME, "02")

static const layer_kind layer_kinds[] = {
    {0, "", 4, {"R", "G", "B", "A"}, 0.0f, false},
    {FACET_AOV_DEPTH, "depth", 1, {"Z"}, INFINITY, true},
    {FACET_AOV_NORMAL, "normal", 3, {"normal.X", "normal.Y", "normal.Z"}, 0.0f, false},
    {FACET_AOV_ALBEDO, "albedo", 3, {"albedo.R", "albedo.G", "albedo.B"}, 0.0f, false},
    {FACET_AOV_MATERIAL_ID, "material", 1, {"material.id"}, 0.0f, true},
    {FACET_AOV_OBJECT_ID, "object", 1, {"object.id"}, 0.0f, true},
    {FACET_AOV_INSTANCE_ID, "instance", 1, {"instance.id"}, 0.0f, true},
    {FACET_AOV_UV, "uv", 2, {"uv.U", "uv.V"}, 0.0f, true},
    {FACET_AOV_OCCLUSION, "occlusion", 1, {"occlusion.A"}, 0.0f, false},
    {FACET_AOV_VARIANCE, "variance", 3, {"variance.R", "variance.G", "variance.B"}, 0.0f, false},
    {FACET_AOV_SAMPLES, "samples", 1, {"samples.N"}, 0.0f, true},
    CRYPTOMATTE_LAYERS(FACET_AOV_CRYPTO_OBJECT, "CryptoObject"),
    CRYPTOMATTE_LAYERS(FACET_AOV_CRYPTO_MATERIAL, "CryptoMaterial"),
    CRYPTOMATTE_LAYERS(FACET_AOV_CRYPTO_INSTANCE, "CryptoInstance"),
};
enum { LAYER_KIND_COUNT = sizeof layer_kinds / sizeof *layer_kinds };
_Static_assert((int)LAYER_KIND_COUNT <= (int)FILM_MAX_LAYERS, "a film has room for every layer");

facet_result film_create(const facet_allocator *allocator, uint32_t width, uint32_t height, uint32_t aovs,
                         film *out, facet_error *error)
{
    *out = (film){0};
    if (width == 0 || height == 0)
        return fail(error, FACET_ERROR_ARGUMENT, "film: %u x %u pixels: at least 1 x 1 were expected", width,
                    height);
    film f = {.width = width, .height = height};
    size_t pixel_count = (size_t)width * height;
    for (size_t k = 0; k < LAYER_KIND_COUNT; k++) {
        const layer_kind *kind = &layer_kinds[k];
        if (kind->aov && !(aovs & kind->aov))
            continue;
        size_t pixel_size = kind->channel_count * sizeof(float);
        bool is_zero = kind->background == 0.0f;
        float *pixels = is_zero ? mem_zalloc(allocator, pixel_count, pixel_size)
                                : mem_alloc(allocator, pixel_count, pixel_size);
        if (!pixels) {
            film_destroy(&f);
            return fail(error, FACET_ERROR_MEMORY, "out of memory: film of %u x %u pixels", width, height);
        }
        if (!is_zero)
            for (size_t i = 0; i < pixel_count * kind->channel_count; i++)
                pixels[i] = kind->background;
        f.layers[f.layer_count++] = (film_layer){.name = kind->name,
                                                 .channel_names = kind->channel_names,
                                                 .channel_count = kind->channel_count,
                                                 .needs_float = kind->needs_float,
                                                 .pixels = pixels};
    }
    *out = f;
    return FACET_OK;
}

void film_destroy(film *f)
{
    for (uint32_t i = 0; i < f->layer_count; i++)
        mem_free(f->layers[i].pixels);
    for (uint32_t i = 0; i < f->text_count; i++) {
        mem_free(f->texts[i].name);
        mem_free(f->texts[i].value);
    }
    *f = (film){0};
}

film_layer *film_find(film *f, const char *name)
{
    for (uint32_t i = 0; i < f->layer_count; i++)
        if (strcmp(f->layers[i].name, name) == 0)
            return &f->layers[i];
    return NULL;
}

void film_remove_layer(film *f, const char *name)
{
    film_layer *layer = film_find(f, name);
    if (!layer)
        return;
    mem_free(layer->pixels);
    f->layer_count--;
    for (; layer < f->layers + f->layer_count; layer++)
        layer[0] = layer[1];
}

static char *copy_text(const char *from, const facet_allocator *allocator)
{
    size_t size = strlen(from) + 1;
    char *copy = mem_alloc(allocator, size, 1);
    return copy ? memcpy(copy, from, size) : NULL;
}

facet_result film_add_text(film *f, const char *name, const char *value, const facet_allocator *allocator,
                           facet_error *error)
{
    film_text *text = &f->texts[f->text_count++]; /* film_destroy() releases a partly created film */
    text->name = copy_text(name, allocator);
    text->value = copy_text(value, allocator);
    return text->name && text->value ? FACET_OK : fail_memory(error, "metadata", strlen(value));
}

/* ---- tone_mapping ---- */

_Static_assert(TONEMAP_NEUTRAL == (int)FACET_TONEMAP_NEUTRAL && TONEMAP_ACES == (int)FACET_TONEMAP_ACES &&
                   TONEMAP_ACES_NARKOWICZ == (int)FACET_TONEMAP_ACES_NARKOWICZ &&
                   TONEMAP_AGX == (int)FACET_TONEMAP_AGX && TONEMAP_REINHARD == (int)FACET_TONEMAP_REINHARD &&
                   TONEMAP_REINHARD_EXTENDED == (int)FACET_TONEMAP_REINHARD_EXTENDED &&
                   TONEMAP_HABLE == (int)FACET_TONEMAP_HABLE,
               "the shader library numbers operators as the interface does");

typedef struct tone_mapping {
    film *film;
    vec3 behind; /* display-linear */
    bool has_behind;
    facet_tonemap operator_;
} tone_mapping;

/* Develops pixels begin to end - 1. NaN is black; uncovered parts of a pixel do not contribute. operator_ is
 * a constant at each call site, so that each operator is inlined in a loop of its own. */
static inline __attribute__((always_inline)) void tone_map_pixels(const tone_mapping *d, size_t begin,
                                                                  size_t end, facet_tonemap operator_)
{
    float *pixel = d->film->layers[0].pixels + 4 * begin;
    for (size_t i = begin; i < end; i++, pixel += 4) {
        float opacity = clamp(pixel[3], 0.0f, 1.0f);
        vec3 color = vec3(0.0f);
        if (opacity > 0.0f) {
            color = load3(pixel);
            if (opacity < 1.0f)
                color = color / opacity;
            color = operator_ == FACET_TONEMAP_NONE ? clamp(color, 0.0f, FLT_MAX)
                                                    : tonemap((int)operator_, color);
            color = color * opacity;
        }
        if (d->has_behind) {
            color = color + d->behind * (1.0f - opacity);
            opacity = 1.0f;
        }
        store3(color, pixel);
        pixel[3] = opacity;
    }
}

static void tone_map_range(void *context, size_t begin, size_t end)
{
    const tone_mapping *d = context;
    switch (d->operator_) {
    case FACET_TONEMAP_NEUTRAL:
        tone_map_pixels(d, begin, end, FACET_TONEMAP_NEUTRAL);
        break;
    case FACET_TONEMAP_ACES:
        tone_map_pixels(d, begin, end, FACET_TONEMAP_ACES);
        break;
    case FACET_TONEMAP_ACES_NARKOWICZ:
        tone_map_pixels(d, begin, end, FACET_TONEMAP_ACES_NARKOWICZ);
        break;
    case FACET_TONEMAP_AGX:
        tone_map_pixels(d, begin, end, FACET_TONEMAP_AGX);
        break;
    case FACET_TONEMAP_REINHARD:
        tone_map_pixels(d, begin, end, FACET_TONEMAP_REINHARD);
        break;
    case FACET_TONEMAP_REINHARD_EXTENDED:
        tone_map_pixels(d, begin, end, FACET_TONEMAP_REINHARD_EXTENDED);
        break;
    case FACET_TONEMAP_HABLE:
        tone_map_pixels(d, begin, end, FACET_TONEMAP_HABLE);
        break;
    case FACET_TONEMAP_NONE:
        tone_map_pixels(d, begin, end, FACET_TONEMAP_NONE);
        break;
    }
}

/* pixels; about 0.1 ms of the quickest operator, to be worth a thread's start of 20 us */
enum { GRAIN = 16384 };

void film_tone_map(film *f, facet_tonemap operator_, const float color[3], uint32_t thread_count)
{
    tone_mapping d = {.film = f, .operator_ = operator_, .has_behind = color != NULL};
    if (color)
        d.behind = load3(color);
    parallel_for(thread_count, (size_t)f->width * f->height, GRAIN, tone_map_range, &d);
}

/* ---- blending of encoded values ---- */

typedef struct encoded_blend {
    film *film;
    vec3 behind; /* encoded */
} encoded_blend;

static void blend_range(void *context, size_t begin, size_t end)
{
    const encoded_blend *b = context;
    float *pixel = b->film->layers[0].pixels + 4 * begin;
    for (size_t i = begin; i < end; i++, pixel += 4) {
        float opacity = pixel[3];
        if (opacity >= 1.0f)
            continue;
        vec3 color = b->behind;
        if (opacity > 0.0f) {
            vec3 straight = load3(pixel) / opacity;
            color = mix(b->behind, srgb_from_linear(straight), opacity);
        }
        color = linear_from_srgb(color);
        store3(color, pixel);
        pixel[3] = 1.0f;
    }
}

void film_blend_encoded(film *f, const float color[3], uint32_t thread_count)
{
    encoded_blend b = {.film = f, .behind = srgb_from_linear(load3(color))};
    parallel_for(thread_count, (size_t)f->width * f->height, GRAIN, blend_range, &b);
}

void film_develop(film *f, const facet_render_desc *desc)
{
    const float *behind = desc->background == FACET_BACKGROUND_COLOR ? desc->background_color : NULL;
    bool is_encoded = desc->shading == FACET_SHADING_OGL1 && !desc->ogl1.is_linear;
    film_tone_map(f, desc->tonemap, is_encoded ? NULL : behind, desc->thread_count);
    if (is_encoded && behind)
        film_blend_encoded(f, behind, desc->thread_count);
}
