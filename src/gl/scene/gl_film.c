/* gl_film.c - see gl_film.h. Passes and finer grids are averaged on the CPU, in floats, in a fixed order. */
#include "gl/scene/gl_film.h"

#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "film/matte.h"

/* Pixels per tile: some 170 MB with 4 samples; the caller may cancel between tiles. */
static const uint64_t TILE_PIXELS = 1u << 21;

/* A part of the image, in image pixels. */
typedef struct tile {
    uint32_t x, y, width, height; /* the part that is kept */
    uint32_t margin[4];           /* left, top, right, bottom: drawn around it */
} tile;

typedef struct drawing {
    const gl_film_desc *desc;
    float *jitter; /* per pass */
    uint32_t tile_width, tile_height, columns, rows;
    gl_target layers;
    matte_layers mattes;
    float *pixels; /* of one tile, as drawn */
    film *film;
    render_watch watch;
} drawing;

static uint32_t smaller(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* ---- tiles ---- */

/* Tiles as wide as the crop where possible: each tile processes the vertices again. */
static void plan_tiles(drawing *d)
{
    const uint32_t *crop = d->desc->render->crop;
    uint32_t scale = d->desc->sampling.scale;
    uint32_t most = (uint32_t)d->desc->context->max_texture_size / scale;
    uint64_t pixels = d->desc->looks_around ? UINT64_MAX : TILE_PIXELS / ((uint64_t)scale * scale);
    if (d->desc->looks_around && (d->desc->render->width > most || d->desc->render->height > most))
        most /= 2; /* half of the texture is for the margin */
    d->tile_width = smaller(crop[2], most);
    uint64_t height = pixels / d->tile_width;
    d->tile_height = smaller(crop[3], height < most ? (uint32_t)(height ? height : 1) : most);
    d->columns = (crop[2] + d->tile_width - 1) / d->tile_width;
    d->rows = (crop[3] + d->tile_height - 1) / d->tile_height;
}

/* How far the drawn part extends before and behind [begin, begin + size) within a limit of `most` pixels. */
static void choose_margin(uint32_t begin, uint32_t size, uint32_t whole, uint32_t most, uint32_t *before,
                          uint32_t *behind)
{
    uint32_t room = most - size;
    *before = smaller(begin, whole <= most ? begin : room / 2);
    *behind = smaller(whole - begin - size, room - *before);
}

static tile get_tile(const drawing *d, uint32_t number)
{
    const facet_render_desc *r = d->desc->render;
    uint32_t left = number % d->columns * d->tile_width, top = number / d->columns * d->tile_height;
    tile t = {.x = r->crop[0] + left,
              .y = r->crop[1] + top,
              .width = smaller(d->tile_width, r->crop[2] - left),
              .height = smaller(d->tile_height, r->crop[3] - top)};
    uint32_t most = (uint32_t)d->desc->context->max_texture_size / d->desc->sampling.scale;
    if (d->desc->looks_around) {
        choose_margin(t.x, t.width, r->width, most, &t.margin[0], &t.margin[2]);
        choose_margin(t.y, t.height, r->height, most, &t.margin[1], &t.margin[3]);
    }
    return t;
}

static gl_view view_of(const tile *t, uint32_t scale)
{
    return (gl_view){.scale = scale,
                     .x = (t->x - t->margin[0]) * scale,
                     .y = (t->y - t->margin[1]) * scale,
                     .width = (t->width + t->margin[0] + t->margin[2]) * scale,
                     .height = (t->height + t->margin[1] + t->margin[3]) * scale};
}

/* Reads the tile without its margin; rows run from the top afterwards. */
static void read_tile(const drawing *d, const gl_target *target, uint32_t layer, const tile *t,
                      uint32_t scale)
{
    bool is_top_down = gl_context_is_top_down(d->desc->context);
    uint32_t w = t->width * scale, h = t->height * scale;
    gl_target_read(target, layer, t->margin[0] * scale, t->margin[is_top_down ? 1 : 3] * scale, w, h,
                   d->pixels);
    for (uint32_t y = 0; !is_top_down && y < h / 2; y++) {
        float *a = d->pixels + 4 * (size_t)w * y, *b = d->pixels + 4 * (size_t)w * (h - 1 - y);
        for (size_t i = 0; i < 4 * (size_t)w; i++) {
            float kept = a[i];
            a[i] = b[i];
            b[i] = kept;
        }
    }
}

/* ---- the image ---- */

static void add_tile(const drawing *d, const tile *t)
{
    const uint32_t *crop = d->desc->render->crop;
    uint32_t scale = d->desc->sampling.scale;
    float weight = 1.0f / (float)(scale * scale * d->desc->sampling.passes);
    for (uint32_t y = 0; y < t->height * scale; y++) {
        const float *from = d->pixels + 4 * (size_t)y * t->width * scale;
        size_t row = (size_t)(t->y - crop[1]) + y / scale;
        float *to = d->film->layers[0].pixels + 4 * (row * crop[2] + (t->x - crop[0]));
        for (size_t x = 0; x < t->width; x++)
            for (size_t k = 0; k < 4 * (size_t)scale; k++)
                to[4 * x + k % 4] += weight * from[4 * x * scale + k];
    }
}

static facet_result check_watch(drawing *d, facet_error *error)
{
    render_watch_look(&d->watch);
    return render_watch_explain(&d->watch, error);
}

static facet_result draw_tile(drawing *d, const tile *t, facet_error *error)
{
    const gl_film_desc *desc = d->desc;
    gl_view view = view_of(t, desc->sampling.scale);
    TRY(gl_target_update(desc->target, desc->context, GL_TARGET_FILM, view.width, view.height,
                         desc->sampling.samples, error));
    for (uint32_t pass = 0; pass < desc->sampling.passes; pass++) {
        memcpy(view.jitter, d->jitter + 2 * pass, sizeof view.jitter);
        TRY(desc->draw(desc->self, desc->target, &view, error));
        read_tile(d, desc->target, 0, t, desc->sampling.scale);
        TRY(gl_context_check(desc->context, "the image", error));
        add_tile(d, t);
        render_watch_add(&d->watch, (uint64_t)t->width * t->height);
        TRY(check_watch(d, error));
    }
    return FACET_OK;
}

/* ---- layers ---- */

enum { NUMBER_LAYER = 2, MATTE_SAMPLES = 16 };

/* Components of the drawn AOVs that make up a layer of the film. */
static const struct layer_source {
    const char *name;
    uint8_t layer, first, count;
} layer_sources[] = {{"normal", 0, 0, 3},
                     {"depth", 0, 3, 1},
                     {"albedo", 1, 0, 3},
                     {"occlusion", 1, 3, 1},
                     {"uv", NUMBER_LAYER, 1, 2}};

/* The number of an identity that makes up a layer. */
static const struct identity_source {
    const char *name;
    scene_identity_kind kind;
} identity_sources[] = {{"object", SCENE_IDENTITY_OBJECT},
                        {"material", SCENE_IDENTITY_MATERIAL},
                        {"instance", SCENE_IDENTITY_INSTANCE}};

/* Index in the film of pixel (x, y) of a tile. */
static size_t place_of(const drawing *d, const tile *t, uint32_t x, uint32_t y)
{
    const uint32_t *crop = d->desc->render->crop;
    return (size_t)(t->y - crop[1] + y) * crop[2] + (t->x - crop[0]) + x;
}

/* Pixels without a surface keep the value that the film was initialized with. */
static void store_layer(const drawing *d, const struct layer_source *source, const tile *t,
                        const uint8_t *is_there)
{
    const film_layer *layer = film_find(d->film, source->name);
    if (!layer)
        return;
    for (uint32_t y = 0; y < t->height; y++)
        for (uint32_t x = 0; x < t->width; x++) {
            size_t from = (size_t)y * t->width + x;
            if (is_there[from])
                memcpy(layer->pixels + place_of(d, t, x, y) * layer->channel_count,
                       d->pixels + 4 * from + source->first, source->count * sizeof(float));
        }
}

/* Identity of the surface at a pixel; NULL: none. */
static const scene_identity *find_identity(const drawing *d, const float *pixel)
{
    return pixel[3] > 0.0f && pixel[0] < (float)d->desc->identity_count
               ? &d->desc->identities[(uint32_t)(pixel[0] + 0.5f)]
               : NULL;
}

static void store_identities(const drawing *d, const struct identity_source *source, const tile *t)
{
    const film_layer *layer = film_find(d->film, source->name);
    if (!layer)
        return;
    for (uint32_t y = 0; y < t->height; y++)
        for (uint32_t x = 0; x < t->width; x++) {
            const scene_identity *one = find_identity(d, d->pixels + 4 * ((size_t)y * t->width + x));
            if (one)
                layer->pixels[place_of(d, t, x, y)] = one->numbers[source->kind];
        }
}

static void store_layers(const drawing *d, const tile *t, uint8_t *is_there)
{
    read_tile(d, &d->layers, NUMBER_LAYER, t, 1);
    for (size_t i = 0; i < (size_t)t->width * t->height; i++)
        is_there[i] = d->pixels[4 * i + 3] > 0.0f;
    for (size_t i = 0; d->desc->identities && i < sizeof identity_sources / sizeof *identity_sources; i++)
        store_identities(d, &identity_sources[i], t);
    for (uint8_t layer = 0; layer < GL_TARGET_LAYERS; layer++) {
        read_tile(d, &d->layers, layer, t, 1);
        for (size_t i = 0; i < sizeof layer_sources / sizeof *layer_sources; i++)
            if (layer_sources[i].layer == layer)
                store_layer(d, &layer_sources[i], t, is_there);
    }
}

/* Adds one sample per pixel of the tile to the Cryptomatte layers. */
static void add_mattes(const drawing *d, const tile *t)
{
    read_tile(d, &d->layers, NUMBER_LAYER, t, 1);
    for (uint32_t y = 0; y < t->height; y++)
        for (uint32_t x = 0; x < t->width; x++) {
            const float *pixel = d->pixels + 4 * ((size_t)y * t->width + x);
            const scene_identity *one = find_identity(d, pixel);
            if (one)
                matte_add(&d->mattes, place_of(d, t, x, y), one->hashes, pixel[3]);
        }
}

/* Draws one sample per pixel, offset from its center by jitter. */
static facet_result sample_layers(drawing *d, const tile *t, const float jitter[2], facet_error *error)
{
    const gl_film_desc *desc = d->desc;
    gl_view view = view_of(t, 1);
    memcpy(view.jitter, jitter, sizeof view.jitter);
    TRY(gl_target_update(&d->layers, desc->context, GL_TARGET_LAYERED, view.width, view.height, 1, error));
    return desc->draw_layers(desc->self, &d->layers, &view, error);
}

/* Opaque surfaces and the nearest transparent ones; nothing behind a transparent surface counts. */
static facet_result draw_mattes(drawing *d, const tile *t, facet_error *error)
{
    float points[2 * MATTE_SAMPLES];
    sample_pattern(MATTE_SAMPLES, points);
    for (int i = 0; i < MATTE_SAMPLES; i++) {
        const float jitter[2] = {points[2 * i] - 0.5f, points[2 * i + 1] - 0.5f};
        TRY(sample_layers(d, t, jitter, error));
        add_mattes(d, t);
        TRY(check_watch(d, error));
    }
    for (uint32_t y = 0; y < t->height; y++)
        for (uint32_t x = 0; x < t->width; x++)
            matte_finish(&d->mattes, place_of(d, t, x, y), 1.0f / (float)MATTE_SAMPLES);
    return FACET_OK;
}

/* One sample at the center of each pixel, and those of Cryptomatte. */
static facet_result draw_layers(drawing *d, const tile *t, facet_error *error)
{
    static const float middle[2] = {0.0f, 0.0f};
    const gl_film_desc *desc = d->desc;
    uint8_t *is_there = mem_alloc(&desc->render->allocator, (size_t)t->width * t->height, 1);
    if (!is_there)
        return fail_memory(error, "layers", (size_t)t->width * t->height);
    facet_result result = FACET_OK;
    if (desc->render->aovs & ~(uint32_t)FACET_AOV_CRYPTOMATTE)
        result = sample_layers(d, t, middle, error);
    if (result == FACET_OK && desc->render->aovs & ~(uint32_t)FACET_AOV_CRYPTOMATTE)
        store_layers(d, t, is_there);
    if (result == FACET_OK && d->mattes.aovs)
        result = draw_mattes(d, t, error);
    if (result == FACET_OK)
        result = gl_context_check(desc->context, "the layers", error);
    mem_free(is_there);
    return result;
}

/* ---- the film ---- */

static facet_result prepare(drawing *d, facet_error *error)
{
    const facet_render_desc *r = d->desc->render;
    const gl_sampling *sampling = &d->desc->sampling;
    plan_tiles(d);
    size_t scale = sampling->scale;
    size_t count = (size_t)d->tile_width * d->tile_height * scale * scale;
    d->pixels = mem_alloc(&r->allocator, count, 4 * sizeof *d->pixels);
    d->jitter = mem_alloc(&r->allocator, sampling->passes, 2 * sizeof *d->jitter);
    if (!d->pixels || !d->jitter)
        return fail_memory(error, "image", count * 4 * sizeof *d->pixels);
    gl_sampling_jitter(sampling, d->jitter);
    memset(d->film->layers[0].pixels, 0,
           /* a failed attempt may have left values */
           4 * sizeof(float) * (size_t)d->film->width * d->film->height);
    d->mattes = matte_find(d->film);
    matte_clear(&d->mattes, (size_t)d->film->width * d->film->height);
    render_watch_init(&d->watch, &r->progress, "shade", d->desc->deadline_s,
                      (double)r->crop[2] * (double)r->crop[3] * (double)sampling->passes);
    return FACET_OK;
}

facet_result gl_film_draw(const gl_film_desc *desc, film *target, facet_error *error)
{
    drawing d = {.desc = desc, .film = target};
    facet_result result = prepare(&d, error);
    for (uint32_t i = 0; result == FACET_OK && i < d.columns * d.rows; i++) {
        tile t = get_tile(&d, i);
        result = draw_tile(&d, &t, error);
        if (result == FACET_OK && desc->render->aovs)
            result = draw_layers(&d, &t, error);
        if (result == FACET_OK)
            result = check_watch(&d, error);
    }
    gl_target_destroy(&d.layers);
    mem_free(d.pixels);
    mem_free(d.jitter);
    return result;
}
