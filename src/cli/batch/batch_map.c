/* batch_map.c - see batch_map.h: open addressing. */
#include "cli/batch/batch_map.h"

#include "base/hash.h"

#include <stdlib.h>
#include <string.h>

uint64_t batch_map_hash(const char *text)
{
    size_t size = strlen(text);
    uint64_t hash = (uint64_t)murmur3(text, size, 1) << 32 | murmur3(text, size, 2);
    return hash ? hash : 1;
}

static struct batch_map_entry *find_place(const batch_map *map, uint64_t key)
{
    size_t at = (size_t)key & (map->capacity - 1);
    while (map->entries[at].key && map->entries[at].key != key)
        at = (at + 1) & (map->capacity - 1);
    return &map->entries[at];
}

const uint64_t *batch_map_find(const batch_map *map, const char *text)
{
    const struct batch_map_entry *entry = map->capacity ? find_place(map, batch_map_hash(text)) : NULL;
    return entry && entry->key ? &entry->value : NULL;
}

static bool grow(batch_map *map)
{
    batch_map larger = {.count = map->count, .capacity = map->capacity ? 2 * map->capacity : 1024};
    larger.entries = calloc(larger.capacity, sizeof *larger.entries);
    if (!larger.entries)
        return false;
    for (size_t i = 0; i < map->capacity; i++)
        if (map->entries[i].key)
            *find_place(&larger, map->entries[i].key) = map->entries[i];
    free(map->entries);
    *map = larger;
    return true;
}

bool batch_map_set(batch_map *map, const char *text, uint64_t value)
{
    if (2 * (map->count + 1) > map->capacity && !grow(map))
        return false;
    struct batch_map_entry *entry = find_place(map, batch_map_hash(text));
    map->count += entry->key == 0;
    *entry = (struct batch_map_entry){batch_map_hash(text), value};
    return true;
}

void batch_map_destroy(batch_map *map)
{
    free(map->entries);
    *map = (batch_map){0};
}
