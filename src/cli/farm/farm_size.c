/* farm_size.c - see farm_size.h. */
#define _GNU_SOURCE /* memmem() */
#include "cli/farm/farm_size.h"

#include "base/file.h"
#include "cli/shared/manifest_line.h"
#include "cli/shared/shard.h"

#include <jansson.h>
#include <math.h>
#include <string.h>

/* Adds a line of a manifest. Only lines with a cost are parsed: facet batch checks the others, in time that is needed
 * anyway. */
static facet_result add_line(farm_items *items, const char *path, uint64_t number, const char *line,
                             size_t size, facet_error *error)
{
    if (manifest_is_blank(line, size))
        return FACET_OK;
    items->count++;
    if (!memmem(line, size, "\"cost\"", 6))
        return FACET_OK;
    json_error_t at;
    json_t *object = json_loadb(line, size, 0, &at);
    json_t *cost = json_object_get(object, "cost");
    double seconds = json_number_value(cost);
    bool is_good = object && (!cost || (json_is_number(cost) && seconds >= 0.0 && isfinite(seconds)));
    if (is_good && cost) {
        items->cost_count++;
        items->cost_s += seconds;
    }
    json_decref(object);
    if (is_good)
        return FACET_OK;
    return fail(error, FACET_ERROR_INVALID, "%s: line %llu: %s", path, (unsigned long long)number,
                object ? "\"cost\" must be a number of seconds, 0 or more" : at.text);
}

facet_result farm_items_count(const char *path, farm_items *out, facet_error *error)
{
    static const facet_allocator allocator = {0};
    file_bytes file = {0};
    *out = (farm_items){0};
    TRY(file_open(path, 0, &allocator, &file, error));
    facet_result result = FACET_OK;
    const char *at = (const char *)file.data, *end = at + file.size;
    for (uint64_t number = 1; at < end && result == FACET_OK; number++) {
        const char *feed = memchr(at, '\n', (size_t)(end - at));
        const char *stop = feed ? feed : end;
        result = add_line(out, path, number, at, (size_t)(stop - at), error);
        at = stop + 1;
    }
    file_close(&file);
    if (result == FACET_OK && out->count == 0)
        return fail(error, FACET_ERROR_INVALID, "%s: the manifest has no items", path);
    return result;
}

double farm_items_cost(const farm_items *items)
{
    return items->cost_count ? items->cost_s / (double)items->cost_count * (double)items->count : 0.0;
}

uint32_t farm_shard_count(double core_seconds, double target_s, uint32_t cpu_count, uint64_t shard_max)
{
    double count = ceil(core_seconds / (target_s * cpu_count));
    if (shard_max > SHARD_COUNT_MAX)
        shard_max = SHARD_COUNT_MAX;
    return (uint32_t)fmax(1.0, fmin(count, (double)shard_max));
}

uint32_t farm_sample_count(uint64_t item_count, uint32_t cpu_count)
{
    uint64_t wanted = cpu_count < 2 ? 8 : 4 * (uint64_t)cpu_count;
    uint64_t count = item_count / wanted;
    return count < 1 ? 1 : count > SHARD_COUNT_MAX ? SHARD_COUNT_MAX : (uint32_t)count;
}
