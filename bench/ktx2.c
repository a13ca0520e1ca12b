/* ktx2.c - decoding speed of KTX2 images, by format. Usage: bench/ktx2 [FILE.ktx2..]; without files blocks of
 * random bits, 1024 x 1024 texels. Each number is the best of several runs; MB/s counts the bytes of the
 * decoded image, "T" is the number of threads. */
#include <math.h>
#include <stdio.h>

#include "base/clock.h"
#include "base/file.h"
#include "image/ktx2.h"
#include "image/ktx2_test_file.h"

enum { RUNS = 7, EDGE = 1024 };

static void time_decode(const char *name, const void *bytes, size_t size)
{
    facet_error error;
    for (uint32_t threads = 1; threads <= 2; threads++) {
        double best = 1e9;
        image i = {0};
        for (int run = 0; run < RUNS; run++) {
            image_destroy(&i);
            double start = clock_seconds();
            image_decode_desc desc = {.thread_count = threads};
            if (image_decode(bytes, size, name, &desc, &i, &error) != FACET_OK) {
                printf("%s\n", error.message);
                return;
            }
            best = fmin(best, clock_seconds() - start);
        }
        double megabytes = (double)(image_row_size(&i) * i.height) * 1e-6;
        printf("%-24s %5ux%ux%u T%u %9.3f ms %8.0f MB/s\n", name, i.width, i.height, i.channel_count, threads,
               best * 1e3, megabytes / best);
        image_destroy(&i);
    }
}

static void time_format(uint32_t vk_format, unsigned model)
{
    bool is_srgb, is_missing;
    const ktx2_format *f =
        vk_format ? ktx2_find_format(vk_format, &is_srgb, &is_missing) : ktx2_find_basis_format(model, 3, -1);
    ktx2_test_file file = {.vk_format = vk_format,
                           .width = EDGE,
                           .height = EDGE,
                           .faces = 1,
                           .levels = 1,
                           .model = (unsigned char)model,
                           .transfer = 1,
                           .channel = 3};
    const size_t columns = (EDGE + f->block_width - 1u) / f->block_width;
    const size_t rows = (EDGE + f->block_height - 1u) / f->block_height;
    file.sizes[0] = columns * rows * f->block_size;
    unsigned char *data = malloc(file.sizes[0]);
    if (!data)
        return;
    uint32_t random = 1;
    for (size_t i = 0; i < file.sizes[0]; i++) {
        random = random * 1664525u + 1013904223u;
        data[i] = (unsigned char)(random >> 24);
    }
    file.bytes[0] = data;
    size_t size;
    unsigned char *bytes = ktx2_test_write(&file, &size);
    time_decode(f->name, bytes, size);
    free(bytes);
    free(data);
}

int main(int argc, char **argv)
{
    static const uint32_t formats[] = {23,  37,  97,  109, 123, 131, 137, 141,
                                       143, 145, 147, 151, 155, 157, 165};
    for (size_t i = 0; argc < 2 && i < sizeof formats / sizeof *formats; i++)
        time_format(formats[i], 0);
    if (argc < 2)
        time_format(0, KDF_MODEL_UASTC);
    for (int k = 1; k < argc; k++) {
        file_bytes file;
        facet_error error;
        if (file_open(argv[k], 0, NULL, &file, &error) != FACET_OK) {
            printf("%s\n", error.message);
            continue;
        }
        time_decode(path_base_name(argv[k]), file.data, file.size);
        file_close(&file);
    }
    return 0;
}
