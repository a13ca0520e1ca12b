/* value.h - parsers of option values. Each returns false, with its outputs untouched, if text is not such
 * a value. */
#ifndef CLI_VALUE_H
#define CLI_VALUE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A finite decimal number at the start of *text, after blanks; *text advances past it. */
bool scan_number(const char **text, double *number);

bool value_number(const char *text, double *number);
/* count numbers, at most 16, separated by commas or blanks. */
bool value_numbers(const char *text, size_t count, double *numbers);
/* "640x480", "640,480", "512" (a square); 1 to 65536. */
bool value_size(const char *text, uint32_t *width, uint32_t *height);
/* Whole numbers "X,Y,W,H", W and H at least 1. */
bool value_rectangle(const char *text, uint32_t rectangle[4]);
/* "1500000", "512M", "2G", "1.5GiB"; K, M, G, T are powers of 1024. */
bool value_bytes(const char *text, uint64_t *bytes);
/* "30", "30s", "500ms", "5m", "1h"; more than 0. */
bool value_seconds(const char *text, double *seconds);
/* "+0.5" stops; "2x" the factor 2. */
bool value_exposure(const char *text, double *stops);
/* The same, or "auto", "auto+0.5", "auto2x": stops are added to what is metered. */
bool value_metered_exposure(const char *text, bool *is_metered, double *stops);
/* "30", "30deg", "0.5rad"; in rad. */
bool value_angle(const char *text, double *radians);

/* Parses "#rgb", "#rrggbb" or a CSS color name (in any case) to linear Rec.709, [0, 1]. Returns false and
 * leaves linear untouched otherwise. */
bool color_parse(const char *text, float linear[3]);

/* ---- lists of frame numbers: "1-10", "1-100x4,120", Blender's "1,3,5..10" ---- */

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
