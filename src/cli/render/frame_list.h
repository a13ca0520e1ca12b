/* frame_list.h - lists of frame numbers: "1-10", "1-100x4,120", Blender's "1,3,5..10". */
#ifndef CLI_FRAME_LIST_H
#define CLI_FRAME_LIST_H

#include <stdbool.h>
#include <stdint.h>

enum { FRAME_LIST_RANGES = 64, FRAME_LIST_FRAMES = 1000000 };

/* first, first + step, .. up to last. */
typedef struct frame_range {
    uint32_t first, last, step;
} frame_range;

typedef struct frame_list {
    uint32_t range_count;
    uint32_t frame_count; /* of all ranges, at most FRAME_LIST_FRAMES */
    frame_range ranges[FRAME_LIST_RANGES];
} frame_list;

/* False, with *out untouched: not a list of numbers from 1, or more than FRAME_LIST_FRAMES. */
bool frame_list_parse(const char *text, frame_list *out);
/* The frames first to last. */
frame_list frame_list_all(uint32_t first, uint32_t last);
/* The number of frame index of the list. */
uint32_t frame_list_at(const frame_list *list, uint32_t index);

#endif
