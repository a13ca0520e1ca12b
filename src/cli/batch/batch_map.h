/* batch_map.h - a map from texts to numbers that keeps hashes of the texts alone, 16 bytes for each: for millions of items. */
#ifndef CLI_BATCH_MAP_H
#define CLI_BATCH_MAP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* {0}: empty. */
typedef struct batch_map {
    struct batch_map_entry {
        uint64_t key, value; /* key 0: a free place */
    } * entries;
    size_t count, capacity; /* a power of two, or 0 */
} batch_map;

/* A hash of text that is not 0. */
uint64_t batch_map_hash(const char *text);
/* The value of text; NULL: there is none. Valid until the next batch_map_set(). */
const uint64_t *batch_map_find(const batch_map *map, const char *text);
/* False: no memory. */
bool batch_map_set(batch_map *map, const char *text, uint64_t value);
void batch_map_destroy(batch_map *map);

#endif
