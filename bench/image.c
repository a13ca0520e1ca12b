/* image.c - time of reading and writing images. Usage: bench/image [FILE..]; without files only generated
 * images. Each number is the best of several runs; "T" is the number of threads. */
#include <math.h>
#include <stdio.h>

#include "base/clock.h"
#include "base/file.h"
#include "base/memory.h"
#include "image/image.h"

enum { RUNS = 15 };

/* Waves with noise, like photographs of surfaces; the alpha of a disc. */
static image make_texture(uint32_t size, uint32_t channel_count)
{
    image i;
    if (image_create(NULL, size, size, channel_count, IMAGE_U8, &i, NULL) != FACET_OK)
        return (image){0};
    i.is_srgb = true;
    uint32_t noise = 1;
    unsigned char *texel = i.pixels;
    for (uint32_t y = 0; y < size; y++)
        for (uint32_t x = 0; x < size; x++, texel += channel_count) {
            double u = (double)x / size, v = (double)y / size;
            double base = 120 + 50 * sin(40 * u + 9 * v) + 40 * cos(25 * v - 60 * u * v);
            bool is_inside = channel_count < 4 || hypot(u - 0.5, v - 0.5) < 0.4;
            for (uint32_t c = 0; c < channel_count; c++) {
                noise = noise * 1664525u + 1013904223u;
                double value = c == 3 ? 255 : base + 12 * c + (noise >> 28) - 8;
                texel[c] = is_inside ? (unsigned char)fmax(0, fmin(255, value)) : 0;
            }
        }
    return i;
}

static void report(const char *what, const char *detail, uint32_t threads, double seconds, size_t size)
{
    printf("%-28s %-18s T%u %9.3f ms %10zu bytes\n", what, detail, threads, seconds * 1e3, size);
}

static void time_decode(const char *what, const unsigned char *bytes, size_t size, uint32_t threads,
                        uint32_t reduction)
{
    double best = 1e9;
    image i = {0};
    facet_error error;
    for (int run = 0; run < RUNS; run++) {
        image_destroy(&i);
        double start = clock_seconds();
        image_decode_desc desc = {.thread_count = threads, .max_reduction = reduction};
        if (image_decode(bytes, size, what, &desc, &i, &error) != FACET_OK) {
            printf("%s\n", error.message);
            return;
        }
        best = fmin(best, clock_seconds() - start);
    }
    char detail[64];
    snprintf(detail, sizeof detail, "read %ux%ux%u", i.width, i.height, i.channel_count);
    report(what, detail, threads, best, size);
    image_destroy(&i);
}

/* Returns the bytes of the last run. */
static unsigned char *time_encode(const char *what, const image *i, image_codec codec, uint32_t level,
                                  uint32_t threads, size_t *size)
{
    double best = 1e9;
    unsigned char *bytes = NULL;
    for (int run = 0; run < RUNS; run++) {
        mem_free(bytes);
        double start = clock_seconds();
        image_encode_desc desc = {.thread_count = threads, .compression = level};
        if (image_encode(i, codec, &desc, &bytes, size, NULL) != FACET_OK)
            return NULL;
        best = fmin(best, clock_seconds() - start);
    }
    char detail[64];
    snprintf(detail, sizeof detail, "write %ux%ux%u", i->width, i->height, i->channel_count);
    report(what, detail, threads, best, *size);
    return bytes;
}

int main(int argc, char **argv)
{
    size_t size;
    image small = make_texture(512, 4);
    for (uint32_t level = 1; level <= 9; level += level < 6 ? 1 : 3) {
        char what[32];
        snprintf(what, sizeof what, "PNG level %u", level);
        mem_free(time_encode(what, &small, IMAGE_CODEC_PNG, level, 1, &size));
        mem_free(time_encode(what, &small, IMAGE_CODEC_PNG, level, 2, &size));
    }
    image texture = make_texture(2048, 3);
    unsigned char *png = time_encode("PNG level 4", &texture, IMAGE_CODEC_PNG, 4, 1, &size);
    if (png)
        time_decode("PNG", png, size, 1, 0);
    unsigned char *jpeg = time_encode("JPEG quality 92", &texture, IMAGE_CODEC_JPEG, 0, 1, &size);
    for (uint32_t reduction = 0; jpeg && reduction <= 3; reduction++)
        time_decode("JPEG", jpeg, size, 1, reduction);
    mem_free(png);
    mem_free(jpeg);
    image_destroy(&texture);
    image_destroy(&small);
    for (int k = 1; k < argc; k++) {
        file_bytes file;
        facet_error error;
        if (file_open(argv[k], 0, NULL, &file, &error) != FACET_OK) {
            printf("%s\n", error.message);
            continue;
        }
        time_decode(path_base_name(argv[k]), file.data, file.size, 1, 0);
        time_decode(path_base_name(argv[k]), file.data, file.size, 2, 0);
        file_close(&file);
    }
    return 0;
}
