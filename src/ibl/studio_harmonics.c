/* studio_harmonics.c - the harmonics of the built-in studio, from studio_generate.c. */
#include "ibl/studio_draw.h"

#include "base/memory.h"
#include "base/result.h"

typedef struct studio_table {
    uint32_t column_count;
    float mean, least; /* grey */
    float coefficients
        [2 * STUDIO_COEFFICIENTS]; /* real and imaginary parts, in the order of harmonics.coefficients */
} studio_table;

static const studio_table table = {
#include "ibl_studio_table.h"
};

facet_result studio_harmonics(const image *panorama, const facet_allocator *allocator, uint32_t thread_count,
                              harmonics *out, facet_error *error)
{
    (void)panorama;
    (void)thread_count;
    const size_t count = STUDIO_COEFFICIENTS;
    *out = (harmonics){.degree = STUDIO_DEGREE,
                       .is_grey = true,
                       .column_count = table.column_count,
                       .mean = {table.mean, table.mean, table.mean},
                       .least = {table.least, table.least, table.least}};
    out->allocator = allocator ? *allocator : out->allocator;
    out->coefficients = mem_alloc(allocator, count, 6 * sizeof *out->coefficients);
    if (!out->coefficients)
        return fail_memory(error, "harmonics", count * 6 * sizeof *out->coefficients);
    for (size_t i = 0; i < 6 * count; i++)
        out->coefficients[i] = table.coefficients[i / 6 * 2 + i % 2];
    return FACET_OK;
}
