/* sample_pattern.c - see sample_pattern.h. Rank-1 lattices (Korobov 1959) whose generator is the one that keeps the
 * points farthest apart, the pixel taken as periodic; for 4 the rotated grid, which is no lattice of that form. */
#include "draw/sample_pattern.h"

/* Smallest squared distance of point i to point 0, in units of (1 / count)^2. */
static uint64_t lattice_distance2(uint32_t count, uint32_t generator)
{
    uint64_t nearest = UINT64_MAX;
    for (uint32_t i = 1; i <= count / 2; i++) {
        uint64_t x = i;
        uint64_t y = (uint64_t)i * generator % count;
        if (y > count - y)
            y = count - y;
        uint64_t distance2 = x * x + y * y;
        nearest = distance2 < nearest ? distance2 : nearest;
        if (x * x >= nearest)
            break;
    }
    return nearest;
}

static uint32_t greatest_common_divisor(uint32_t a, uint32_t b)
{
    while (b) {
        uint32_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

static uint32_t best_generator(uint32_t count)
{
    uint32_t best = 1;
    uint64_t best_distance2 = 0;
    for (uint32_t generator = 1; generator < count; generator++) {
        if (greatest_common_divisor(generator, count) != 1)
            continue;
        uint64_t distance2 = lattice_distance2(count, generator);
        if (distance2 > best_distance2) {
            best = generator;
            best_distance2 = distance2;
        }
    }
    return best;
}

void sample_pattern(uint32_t count, float *points)
{
    static const uint8_t rotated_grid[4] = {2, 0, 3, 1};
    uint32_t generator = best_generator(count);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t row = count == 4 ? rotated_grid[i] : (uint32_t)((uint64_t)i * generator % count);
        points[2 * i] = ((float)i + 0.5f) / (float)count;
        points[2 * i + 1] = ((float)row + 0.5f) / (float)count;
    }
}
