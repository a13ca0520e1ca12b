/* fuzz_merl.c - measured BRDFs of the MERL database: the header from the input, then changes of single
 * cells, 12 bytes each. The file has its full size, which the reader checks first; it is truncated if the
 * last byte of the input is odd. */
#include "fuzz_support.h"

#include <string.h>

#include "plot/merl.h"

enum { HEADER_SIZE = 12 };

static uint8_t *make_file(const uint8_t *data, size_t size, size_t *file_size)
{
    *file_size = HEADER_SIZE + 3 * MERL_CELLS * sizeof(double);
    uint8_t *file = calloc(*file_size, 1);
    if (!file)
        abort();
    fuzz_take(&data, &size, file, HEADER_SIZE);
    while (size >= 12) {
        uint32_t cell;
        fuzz_take(&data, &size, &cell, 4);
        fuzz_take(&data, &size, file + HEADER_SIZE + cell % (3 * MERL_CELLS) * sizeof(double), 8);
    }
    if (size && data[size - 1] % 2)
        *file_size -= data[0];
    return file;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    facet_budget *budget = fuzz_begin((uint64_t)64 << 20);
    facet_allocator allocator = facet_budget_allocator(budget);
    size_t file_size;
    uint8_t *file = make_file(data, size, &file_size);
    merl *m = NULL;
    facet_error error = {0};
    facet_result result = merl_open(fuzz_file(file, file_size), &allocator, &m, &error);
    fuzz_check_error(result, &error);
    for (int i = 0; result == FACET_OK && i < 90; i++) {
        float V[3];
        float L[3];
        double brdf[3];
        merl_directions(0.017 * i, 0.008 * (90 - i), 0.03 * i, V, L);
        merl_brdf(m, V, L, brdf);
    }
    merl_close(m);
    free(file);
    fuzz_end(budget);
    return 0;
}
