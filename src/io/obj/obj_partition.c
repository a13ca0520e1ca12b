/* obj_partition.c - corners sorted by blocks of positions: what is done for each position then stays in the cache of one
 * core, and threads need not agree about anything. */
#include "base/parallel.h"
#include "io/obj/obj_reader.h"

enum {
    RANGE = 1 << 16,         /* corners that one thread takes at once */
    BLOCK_CORNERS = 1 << 15, /* about so many in a block */
    MOST_BLOCKS = 4096
};

typedef struct sorting {
    obj_partition *p;
    uint32_t *counts; /* per range and block: corners, then where they go in the block */
} sorting;

static inline bool is_left_out(const obj_partition *p, size_t corner)
{
    return (p->taken_n && p->taken_n[corner] != OBJ_ABSENT) || (p->groups && p->groups[corner / 3] == 0);
}

static inline uint32_t block_of(const obj_partition *p, size_t corner)
{
    return (p->v[corner] - p->v_minimum) >> p->shift;
}

static void count_ranges(void *context, size_t begin, size_t end)
{
    const sorting *s = context;
    const obj_partition *p = s->p;
    for (size_t range = begin; range < end; range++) {
        uint32_t *counts = s->counts + range * p->block_count;
        size_t first = p->begin + range * RANGE;
        size_t last = p->end - first > RANGE ? first + RANGE : p->end;
        for (uint32_t b = 0; b < p->block_count; b++)
            counts[b] = 0;
        for (size_t i = first; i < last; i++)
            if (!is_left_out(p, i))
                counts[block_of(p, i)]++;
    }
}

static void sort_ranges(void *context, size_t begin, size_t end)
{
    const sorting *s = context;
    const obj_partition *p = s->p;
    for (size_t range = begin; range < end; range++) {
        uint32_t *places = s->counts + range * p->block_count;
        size_t first = p->begin + range * RANGE;
        size_t last = p->end - first > RANGE ? first + RANGE : p->end;
        for (size_t i = first; i < last; i++)
            if (!is_left_out(p, i)) {
                uint32_t b = block_of(p, i);
                p->order[p->block_begins[b] + places[b]++] = (uint32_t)i;
            }
    }
}

void obj_partition_plan(obj_partition *p, uint32_t v_minimum, uint32_t v_maximum)
{
    size_t wanted = (p->end - p->begin) / BLOCK_CORNERS + 1;
    wanted = wanted < MOST_BLOCKS ? wanted : MOST_BLOCKS;
    uint32_t span = v_maximum - v_minimum;
    p->v_minimum = v_minimum;
    p->shift = 0;
    while ((span >> p->shift) + 1 > wanted)
        p->shift++;
    p->block_count = (span >> p->shift) + 1;
}

bool obj_partition_run(obj_partition *p, uint32_t thread_count, const facet_allocator *allocator)
{
    size_t ranges = (p->end - p->begin + RANGE - 1) / RANGE;
    sorting s = {.p = p, .counts = mem_alloc(allocator, ranges * p->block_count, sizeof *s.counts)};
    if (!s.counts)
        return false;
    parallel_for(thread_count, ranges, 1, count_ranges, &s);
    size_t sum = p->block_begins[0];
    for (uint32_t b = 0; b < p->block_count; b++) {
        uint32_t in_block = 0;
        p->block_begins[b] = sum;
        for (size_t range = 0; range < ranges; range++) {
            uint32_t count = s.counts[range * p->block_count + b];
            s.counts[range * p->block_count + b] = in_block;
            in_block += count;
        }
        sum += in_block;
    }
    p->block_begins[p->block_count] = sum;
    parallel_for(thread_count, ranges, 1, sort_ranges, &s);
    mem_free(s.counts);
    return true;
}
