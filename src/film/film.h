/* film.h - the framebuffer of renderers: float RGBA, premultiplied, and one layer per AOV. */
#ifndef FILM_FILM_H
#define FILM_FILM_H

#include "facet/facet.h"

enum { FILM_MAX_LAYERS = 20, FILM_MAX_TEXTS = 24 };

typedef struct film_layer {
    const char *name;                 /* "", "normal" .. */
    const char *const *channel_names; /* full names as in an EXR file */
    uint32_t channel_count;
    bool needs_float; /* depth, texture coordinates, IDs and counts, which halves would round */
    bool is_integer;  /* pixels are 32-bit integers, for files that keep the state of a renderer */
    float *pixels;    /* interleaved, width * height * channel_count; block of mem_alloc() */
} film_layer;

/* Text about the layers: an attribute of an EXR file. */
typedef struct film_text {
    char *name, *value; /* blocks of mem_alloc() */
} film_text;

/* Layer 0 is the image, RGBA premultiplied. */
typedef struct film {
    uint32_t width, height;
    /* A part of an image: path tracing leaves the sums of its samples as layers in place of what it makes of them
     * (path_film_give_layers()), and Cryptomatte's layers as sums. */
    bool keeps_sums;
    uint32_t layer_count;
    film_layer layers[FILM_MAX_LAYERS];
    uint32_t text_count;
    film_text texts[FILM_MAX_TEXTS];
} film;

/* Layers for the facet_aov bits of aovs, all 0 (depth: infinity). */
facet_result film_create(const facet_allocator *allocator, uint32_t width, uint32_t height, uint32_t aovs,
                         film *out, facet_error *error);
void film_destroy(film *f);                        /* {0} is allowed */
film_layer *film_find(film *f, const char *name);  /* NULL: the film has no such layer */
void film_remove_layer(film *f, const char *name); /* if there is one */
/* Adds copies. FACET_ERROR_MEMORY. */
facet_result film_add_text(film *f, const char *name, const char *value, const facet_allocator *allocator,
                           facet_error *error);

/* Tone-maps the image in place: unpremultiplies, applies operator_, clamps negative values to 0,
 * premultiplies again, and composites it over color (display-linear RGB; NULL: it stays transparent). */
void film_tone_map(film *f, facet_tonemap operator_, const float color[3], uint32_t thread_count);
/* Composites a tone-mapped image over color (display-linear RGB) as programs without linear light do: by
 * blending the sRGB-encoded values. */
void film_blend_encoded(film *f, const float color[3], uint32_t thread_count);
/* Both as a resolved desc says: tone-maps the film and blends the background in, linearly, or, where the shading wrote
 * display values, in those. */
void film_develop(film *f, const facet_render_desc *desc);

/* ---- denoising of Monte Carlo renderings (denoise.c) ---- */

/* Filters layer "" of f in place, guided by the layers "albedo", "normal" and "variance" and by opacity,
 * which stays as it is: radiance is averaged where surface and color agree, as widely as the variance asks
 * for. Biased: detail below the noise is lost. The result does not depend on thread_count.
 * FACET_ERROR_MEMORY; FACET_ERROR_ARGUMENT if a layer is missing. */
facet_result film_denoise(film *f, const facet_allocator *allocator, uint32_t thread_count,
                          facet_error *error);

#endif
