/* texture.c - nanoseconds per texture lookup, and time of decoding textures.
 *     build/release/bench/texture            lookups, on one thread
 *     build/release/bench/texture decode K..   five 2048 x 2048 JPEGs at minimum lod K on 2 threads, with facet's own memory */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "draw/texture.h"
#include "image/image.h"

enum { TEXTURE_COUNT = 5, JPEG_SIZE = 2048, LOOKUPS = 1 << 19, REPEATS = 9 };

/* Waves of all lengths with grain, as hard to decode as a photograph. */
static facet_result draw_image(uint32_t size, uint32_t channel_count, uint32_t seed, image *out)
{
    facet_result result = image_create(NULL, size, size, channel_count, IMAGE_U8, out, NULL);
    if (result != FACET_OK)
        return result;
    out->is_srgb = true;
    uint32_t random = seed;
    unsigned char *texel = out->pixels;
    for (uint32_t y = 0; y < size; y++)
        for (uint32_t x = 0; x < size; x++, texel += channel_count) {
            float value = 128.0f;
            for (uint32_t k = 0; k < 4; k++)
                value +=
                    20.0f * sinf((float)(x * (3 * k + seed) + y * (5 + 7 * k)) * 0.004f * (float)(1 + k * k));
            for (uint32_t c = 0; c < channel_count; c++) {
                random = random * 1664525u + 1013904223u;
                texel[c] = (unsigned char)(value + (float)(10 * c) + (float)(random >> 28));
            }
        }
    return FACET_OK;
}

/* ---- lookups ---- */

static void measure(const texture_set *set, const char *name, float major, float minor, uint32_t size,
                    bool as_color)
{
    const float scale = 1.0f / (float)size;
    double best = 1.0;
    float sum = 0.0f;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        double start = clock_seconds();
        for (uint32_t i = 0; i < LOOKUPS; i++) {
            /* pixels row by row, as in a renderer, on a plane rotated by half a radian */
            float x = (float)(i & 511) * 1.3f * minor * scale;
            float y = (float)(i >> 9) * 1.3f * major * scale;
            const float uv[2] = {0.8776f * x - 0.4794f * y, 0.4794f * x + 0.8776f * y};
            const float dx[2] = {0.8776f * minor * scale, 0.4794f * minor * scale};
            const float dy[2] = {-0.4794f * major * scale, 0.8776f * major * scale};
            float out[4];
            texture_sample(set, 0, as_color, uv, dx, dy, out);
            sum += out[0];
        }
        double time = clock_seconds() - start;
        best = time < best ? time : best;
    }
    printf("  %-28s %6.1f ns   (mean %.3f)\n", name, 1e9 * best / LOOKUPS, (double)sum / REPEATS / LOOKUPS);
}

static int bench_lookups(uint32_t size, uint32_t channel_count)
{
    image drawn;
    unsigned char *bytes;
    size_t byte_count;
    if (draw_image(size, channel_count, 1, &drawn) != FACET_OK ||
        image_encode(&drawn, IMAGE_CODEC_PNG, &(image_encode_desc){.compression = 1}, &bytes, &byte_count,
                     NULL) != FACET_OK)
        return 1;
    image_destroy(&drawn);
    scene_image encoded = {.name = "", .mime_type = "image/png", .bytes = bytes, .size = byte_count};
    scene_texture texture = {.name = "", .image = 0};
    facet_scene scene = {
        .source = "bench", .texture_count = 1, .textures = &texture, .image_count = 1, .images = &encoded};
    const texture_use use = {.is_read_as_color = true, .is_read_as_data = true};
    texture_set *set;
    facet_error error;
    if (texture_set_create(&scene, &use, NULL, NULL, 1, &set, &error) != FACET_OK) {
        fprintf(stderr, "%s\n", error.message);
        return 1;
    }
    printf("%u x %u texels, %u channels of 8 bits\n", size, size, channel_count);
    measure(set, "bilinear, color", 0.7f, 0.7f, size, true);
    measure(set, "bilinear, data", 0.7f, 0.7f, size, false);
    measure(set, "trilinear, color", 1.5f, 1.4f, size, true);
    measure(set, "trilinear, data", 1.5f, 1.4f, size, false);
    measure(set, "anisotropic 2, color", 3.0f, 1.5f, size, true);
    measure(set, "anisotropic 4, color", 6.0f, 1.5f, size, true);
    measure(set, "anisotropic 16, color", 24.0f, 1.5f, size, true);
    measure(set, "anisotropic 16, data", 24.0f, 1.5f, size, false);
    texture_set_destroy(set);
    mem_free(bytes);
    return 0;
}

/* ---- decoding ---- */

static int bench_decoding(float min_lod)
{
    scene_image images[TEXTURE_COUNT];
    scene_texture textures[TEXTURE_COUNT];
    texture_use uses[TEXTURE_COUNT];
    size_t total = 0;
    for (uint32_t i = 0; i < TEXTURE_COUNT; i++) {
        image drawn;
        unsigned char *bytes;
        size_t byte_count;
        if (draw_image(JPEG_SIZE, 3, i + 1, &drawn) != FACET_OK ||
            image_encode(&drawn, IMAGE_CODEC_JPEG, &(image_encode_desc){.quality = 90}, &bytes, &byte_count,
                         NULL) != FACET_OK)
            return 1;
        image_destroy(&drawn);
        images[i] = (scene_image){.name = "", .mime_type = "image/jpeg", .bytes = bytes, .size = byte_count};
        textures[i] = (scene_texture){.name = "", .image = i};
        uses[i] =
            (texture_use){.is_read_as_color = i % 2 == 0, .is_read_as_data = i % 2 == 1, .min_lod = min_lod};
        total += byte_count;
    }
    facet_scene scene = {.source = "bench",
                         .texture_count = TEXTURE_COUNT,
                         .textures = textures,
                         .image_count = TEXTURE_COUNT,
                         .images = images};
    double best = 10.0;
    uint64_t peak = 0;
    uint64_t kept = 0;
    uint64_t texels = 0;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        facet_budget *budget;
        if (facet_budget_create(0, &budget, NULL) != FACET_OK)
            return 1;
        facet_allocator allocator = facet_budget_allocator(budget);
        texture_set *set;
        double start = clock_seconds();
        if (texture_set_create(&scene, uses, &allocator, NULL, 2, &set, NULL) != FACET_OK)
            return 1;
        double time = clock_seconds() - start;
        best = time < best ? time : best;
        kept = facet_budget_used_bytes(budget);
        texels = texture_set_decoded_texels(set);
        texture_set_destroy(set);
        peak = facet_budget_peak_bytes(budget);
        facet_budget_destroy(budget);
    }
    printf("%u JPEGs of %u x %u (%.1f MB), minimum lod %g, 2 threads: %.1f ms, %.1f M texels decoded, %.1f "
           "MB kept, "
           "%.1f MB at peak\n",
           TEXTURE_COUNT, JPEG_SIZE, JPEG_SIZE, 1e-6 * (double)total, (double)min_lod, 1e3 * best,
           1e-6 * (double)texels, 1e-6 * (double)kept, 1e-6 * (double)peak);
    for (uint32_t i = 0; i < TEXTURE_COUNT; i++)
        mem_free((void *)(uintptr_t)images[i].bytes);
    return 0;
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "decode") == 0) {
        for (int i = 2; i < argc; i++)
            if (bench_decoding(strtof(argv[i], NULL)))
                return 1;
        return 0;
    }
    return bench_lookups(512, 3) || bench_lookups(512, 4) || bench_lookups(2048, 3) || bench_lookups(512, 1);
}
