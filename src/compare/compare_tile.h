/* compare_tile.h - how filters go over a picture: in tiles, each with what lies around it, so that memory does not grow with
 * the picture and what is worked on stays in a core's cache. */
#ifndef COMPARE_COMPARE_TILE_H
#define COMPARE_COMPARE_TILE_H

#include "compare/compare_source.h"

enum {
    TILE_WIDTH = 128, /* a multiple of 32, see compare_filter.h */
    TILE_HEIGHT = 64,
    TILE_GRAIN = 4 /* tiles that share their memory */
};

typedef struct compare_tile {
    uint32_t x, y, width, height; /* in the crop; at most TILE_WIDTH x TILE_HEIGHT */
} compare_tile;

static inline size_t compare_tile_count(const compare_source *s)
{
    return (size_t)((s->width - 1) / TILE_WIDTH + 1) * ((s->height - 1) / TILE_HEIGHT + 1);
}

static inline compare_tile compare_tile_at(const compare_source *s, size_t index)
{
    const uint32_t columns = (s->width - 1) / TILE_WIDTH + 1;
    compare_tile t = {.x = (uint32_t)(index % columns) * TILE_WIDTH,
                      .y = (uint32_t)(index / columns) * TILE_HEIGHT};
    t.width = s->width - t.x < TILE_WIDTH ? s->width - t.x : TILE_WIDTH;
    t.height = s->height - t.y < TILE_HEIGHT ? s->height - t.y : TILE_HEIGHT;
    return t;
}

#endif
