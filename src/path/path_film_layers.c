/* path_film_layers.c - a film of path tracing as layers, whose words files keep bit for bit. */
#include "path/path_film_state.h"

#include <string.h>

_Static_assert(sizeof(path_pixel) == PATH_PIXEL_WORDS * sizeof(uint32_t), "a pixel is its words");
_Static_assert(sizeof(path_ground) == PATH_GROUND_WORDS * sizeof(uint32_t), "and so is its ground");

#define TEN(NAME, TENS)                                                                                      \
    NAME TENS "0", NAME TENS "1", NAME TENS "2", NAME TENS "3", NAME TENS "4", NAME TENS "5", NAME TENS "6", \
        NAME TENS "7", NAME TENS "8", NAME TENS "9"
static const char *const pixel_names[] = {TEN("sums.", "0"), TEN("sums.", "1"), TEN("sums.", "2"),
                                          TEN("sums.", "3"), "sums.40",         "sums.41",
                                          "sums.42",         "sums.43"};
static const char *const ground_names[] = {TEN("ground.", "0"), "ground.10", "ground.11", "ground.12",
                                           "ground.13",         "ground.14", "ground.15"};
_Static_assert(sizeof pixel_names / sizeof *pixel_names == PATH_PIXEL_WORDS &&
                   sizeof ground_names / sizeof *ground_names == PATH_GROUND_WORDS,
               "each word has a name");

uint32_t path_film_list_layers(const path_film *f, film_layer layers[PATH_FILM_LAYERS])
{
    layers[0] = (film_layer){.name = "sums",
                             .channel_names = pixel_names,
                             .channel_count = PATH_PIXEL_WORDS,
                             .is_integer = true,
                             .pixels = (float *)f->pixels};
    layers[1] = (film_layer){.name = "ground",
                             .channel_names = ground_names,
                             .channel_count = PATH_GROUND_WORDS,
                             .is_integer = true,
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
    for (size_t i = 1; i < MADE; i++)
        film_remove_layer(target, made[i]);
    path_film_resolve(f, 1.0f, target, 1);
    target->layer_count += path_film_list_layers(f, target->layers + target->layer_count);
    f->pixels = NULL;
    f->ground = NULL;
}
