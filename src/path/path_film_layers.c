/* path_film_layers.c - a film of path tracing as layers, whose channels files keep bit for bit. The first channels
 * are the means as R, G, B, A, which any viewer shows. */
#include "path/path_film_state.h"

#include <math.h>
#include <string.h>

static const char *const pixel_names[] = {
    "R",        "G",        "B",        "A",        "rest.R",   "rest.G",
    "rest.B",   "rest.A",   "spread.R", "spread.G", "spread.B", "albedo.R",
    "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z", "filter.excess",
    "samples.N"};
static const char *const ground_names[] = {"ground.open", "ground.taken", "ground.spread", "ground.samples"};
_Static_assert(sizeof pixel_names / sizeof *pixel_names == PATH_PIXEL_CHANNELS &&
                   sizeof(path_pixel) == PATH_PIXEL_CHANNELS * sizeof(float),
               "a pixel is its channels");
_Static_assert(sizeof ground_names / sizeof *ground_names == PATH_GROUND_CHANNELS &&
                   sizeof(path_ground) == PATH_GROUND_CHANNELS * sizeof(float),
               "and so is its ground");

uint32_t path_film_list_layers(const path_film *f, film_layer layers[PATH_FILM_LAYERS])
{
    layers[0] = (film_layer){.name = "sums",
                             .channel_names = pixel_names,
                             .channel_count = PATH_PIXEL_CHANNELS,
                             .needs_float = true,
                             .pixels = (float *)f->pixels};
    layers[1] = (film_layer){.name = "ground",
                             .channel_names = ground_names,
                             .channel_count = PATH_GROUND_CHANNELS,
                             .needs_float = true,
                             .pixels = (float *)f->ground};
    return f->ground ? 2 : 1;
}

static const char *const made[] = {"", "albedo", "normal", "variance", "samples"};
enum { MADE = sizeof made / sizeof *made };

bool path_film_makes_layer(const char *name)
{
    for (size_t i = 0; i < MADE; i++)
        if (strcmp(name, made[i]) == 0)
            return true;
    return false;
}

void path_film_give_layers(path_film *f, film *target)
{
    for (size_t i = 0; i < MADE; i++)
        film_remove_layer(target, made[i]);
    target->layer_count += path_film_list_layers(f, target->layers + target->layer_count);
    f->pixels = NULL;
    f->ground = NULL;
}

static bool are_finite(const float *values, size_t count)
{
    float sum = 0.0f; /* 0 times a finite value stays 0 */
    for (size_t i = 0; i < count; i++)
        sum += 0.0f * values[i];
    return sum == 0.0f;
}

static bool is_count(float samples)
{
    return samples >= 0.0f && samples <= (float)PATH_FILM_MAX_SAMPLES && floorf(samples) == samples;
}

bool path_film_is_sound(const path_film *f)
{
    size_t count = (size_t)f->width * f->height;
    bool is = are_finite((const float *)f->pixels, count * PATH_PIXEL_CHANNELS) &&
              (!f->ground || are_finite((const float *)f->ground, count * PATH_GROUND_CHANNELS));
    for (size_t i = 0; i < count; i++) {
        const path_pixel *p = &f->pixels[i];
        is = is && is_count(p->samples) && p->spread[0] >= 0.0f && p->spread[1] >= 0.0f &&
             p->spread[2] >= 0.0f;
        if (f->ground)
            is = is && is_count(f->ground[i].samples) && f->ground[i].samples <= p->samples &&
                 f->ground[i].spread >= 0.0f;
    }
    return is;
}
