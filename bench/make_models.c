/* make_models.c - writes the inputs of bench/still into a folder: three models and an environment.
 *     small.glb       a cube, one material
 *     textured.glb    about 15 000 triangles, five 2048 x 2048 JPEG textures (base color, roughness and metallic,
 *                     normal, occlusion, emission): a typical game or shop asset
 *     heavy.glb       about a million triangles, no textures
 *     light_1k.hdr    1024 x 512 sky with a sun, RLE
 * usage: make_models FOLDER */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/text.h"
#include "image/image.h"

enum { TEXTURE_SIZE = 2048 };

static const float pi = 3.14159265f;

/* ---- noise: a hash on a lattice, smoothed, five octaves ---- */

static float lattice(uint32_t x, uint32_t y, uint32_t seed)
{
    uint32_t h = x * 0x9E3779B1u ^ y * 0x85EBCA77u ^ seed * 0xC2B2AE3Du;
    h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
    h = (h ^ (h >> 12)) * 0x297A2D39u;
    h ^= h >> 15;
    return (float)(h >> 8) / 16777216.0f;
}

/* Value noise of the given period, which tiles; x and y in periods. */
static float smooth_noise(float x, float y, uint32_t period, uint32_t seed)
{
    float fx = floorf(x);
    float fy = floorf(y);
    float tx = x - fx;
    float ty = y - fy;
    uint32_t x0 = (uint32_t)fx % period;
    uint32_t y0 = (uint32_t)fy % period;
    uint32_t x1 = (x0 + 1) % period;
    uint32_t y1 = (y0 + 1) % period;
    tx = tx * tx * (3.0f - 2.0f * tx);
    ty = ty * ty * (3.0f - 2.0f * ty);
    float top = lattice(x0, y0, seed) + (lattice(x1, y0, seed) - lattice(x0, y0, seed)) * tx;
    float bottom = lattice(x0, y1, seed) + (lattice(x1, y1, seed) - lattice(x0, y1, seed)) * tx;
    return top + (bottom - top) * ty;
}

/* About [0, 1], u and v in [0, 1). */
static float fractal(float u, float v, uint32_t seed)
{
    float sum = 0.0f;
    float weight = 0.5f;
    for (uint32_t octave = 0, period = 8; octave < 8; octave++, period *= 2) {
        sum += weight * smooth_noise(u * (float)period, v * (float)period, period, seed + octave);
        weight *= 0.55f;
    }
    return sum;
}

/* ---- textures ---- */

typedef enum texture_kind {
    BASE_COLOR,
    ROUGHNESS_METALLIC,
    NORMAL,
    OCCLUSION,
    EMISSION,
    KIND_COUNT
} texture_kind;

typedef struct painter {
    texture_kind kind;
    unsigned char *pixels;
} painter;

static unsigned char byte_of(float x)
{
    return (unsigned char)(fminf(fmaxf(x, 0.0f), 1.0f) * 255.0f + 0.5f);
}

static void paint_rows(void *context, size_t begin, size_t end)
{
    painter *p = context;
    const float step = 1.0f / TEXTURE_SIZE;
    for (size_t y = begin; y < end; y++)
        for (size_t x = 0; x < TEXTURE_SIZE; x++) {
            float u = (float)x * step;
            float v = (float)y * step;
            float n = fractal(u, v, 1);
            float r = 0, g = 0, b = 0;
            switch (p->kind) {
            case BASE_COLOR:
                r = 0.25f + 0.55f * n;
                g = 0.2f + 0.4f * fractal(u, v, 11);
                b = 0.15f + 0.3f * n * n;
                break;
            case ROUGHNESS_METALLIC:
                r = 1.0f;
                g = 0.2f + 0.6f * fractal(u, v, 21);
                b = n > 0.55f ? 1.0f : 0.0f;
                break;
            case NORMAL: {
                float right = fractal(u + step < 1.0f ? u + step : 0.0f, v, 1);
                float down = fractal(u, v + step < 1.0f ? v + step : 0.0f, 1);
                float nx = (n - right) * 12.0f;
                float ny = (down - n) * 12.0f;
                float length = sqrtf(nx * nx + ny * ny + 1.0f);
                r = 0.5f + 0.5f * nx / length;
                g = 0.5f + 0.5f * ny / length;
                b = 0.5f + 0.5f / length;
                break;
            }
            case OCCLUSION:
                r = g = b = 0.5f + 0.5f * n;
                break;
            default:
                r = n > 0.7f ? 1.0f : 0.0f;
                g = 0.4f * r;
                break;
            }
            unsigned char *out = p->pixels + 3 * (y * TEXTURE_SIZE + x);
            out[0] = byte_of(r);
            out[1] = byte_of(g);
            out[2] = byte_of(b);
        }
}

static void stop(const facet_error *error)
{
    fprintf(stderr, "make_models: %s\n", error->message);
    exit(1);
}

/* A JPEG of that kind: bytes and size. */
static unsigned char *paint(texture_kind kind, size_t *size)
{
    facet_error error;
    image texture;
    if (image_create(NULL, TEXTURE_SIZE, TEXTURE_SIZE, 3, IMAGE_U8, &texture, &error) != FACET_OK)
        stop(&error);
    texture.is_srgb = true;
    painter p = {.kind = kind, .pixels = texture.pixels};
    parallel_for(0, TEXTURE_SIZE, 16, paint_rows, &p);
    unsigned char *bytes;
    if (image_encode(&texture, IMAGE_CODEC_JPEG, &(image_encode_desc){.quality = 90}, &bytes, size, &error) !=
        FACET_OK)
        stop(&error);
    image_destroy(&texture);
    return bytes;
}

/* ---- geometry: a bumpy sphere of columns x rows quads ---- */

typedef struct vertex {
    float position[3], normal[3], uv[2];
} vertex;

static void sphere_point(float u, float v, float bump, float out[3])
{
    float radius = 1.0f + bump * (fractal(u < 1.0f ? u : 0.0f, v < 1.0f ? v : 0.0f, 31) - 0.5f);
    float theta = pi * v;
    float phi = 2.0f * pi * u;
    out[0] = -radius * cosf(phi) * sinf(theta);
    out[1] = radius * cosf(theta);
    out[2] = radius * sinf(phi) * sinf(theta);
}

/* Vertices, then indices, in the binary chunk of the GLB. */
static void add_sphere(text *bin, uint32_t columns, uint32_t rows, float bump)
{
    for (uint32_t row = 0; row <= rows; row++)
        for (uint32_t column = 0; column <= columns; column++) {
            float u = (float)column / (float)columns;
            float v = (float)row / (float)rows;
            vertex w = {.uv = {u, v}};
            sphere_point(u, v, bump, w.position);
            float length = sqrtf(w.position[0] * w.position[0] + w.position[1] * w.position[1] +
                                 w.position[2] * w.position[2]);
            for (int k = 0; k < 3; k++)
                w.normal[k] = w.position[k] / length;
            text_add_bytes(bin, &w, sizeof w);
        }
    for (uint32_t row = 0; row < rows; row++)
        for (uint32_t column = 0; column < columns; column++) {
            uint32_t a = row * (columns + 1) + column;
            uint32_t b = a + columns + 1;
            const uint32_t quad[6] = {a, b, a + 1, a + 1, b, b + 1};
            text_add_bytes(bin, quad, sizeof quad);
        }
}

static void pad(text *t, char with)
{
    while (t->length % 4)
        text_add_bytes(t, &with, 1);
}

static void add_u32(text *t, uint32_t value)
{
    const unsigned char bytes[4] = {(unsigned char)value, (unsigned char)(value >> 8),
                                    (unsigned char)(value >> 16), (unsigned char)(value >> 24)};
    text_add_bytes(t, bytes, sizeof bytes);
}

static void write_glb(const char *folder, const char *name, uint32_t columns, uint32_t rows, float bump,
                      bool has_textures)
{
    text bin = {0};
    add_sphere(&bin, columns, rows, bump);
    uint32_t vertices = (columns + 1) * (rows + 1);
    uint32_t indices = columns * rows * 6;
    size_t vertex_bytes = vertices * sizeof(vertex);

    text json = {0};
    text_add(&json, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"facet bench\"},\"scene\":0,\"scenes\":"
                    "[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":"
                    "{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2},\"indices\":3,\"material\":0}]}],");
    text_addf(
        &json,
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":%u,\"type\":\"VEC3\",\"min\":"
        "[-2,-2,-2],\"max\":[2,2,2]},{\"bufferView\":0,\"byteOffset\":12,\"componentType\":5126,\"count\":%u,"
        "\"type\":\"VEC3\"},{\"bufferView\":0,\"byteOffset\":24,\"componentType\":5126,\"count\":%u,\"type\":"
        "\"VEC2\"},{\"bufferView\":1,\"componentType\":5125,\"count\":%u,\"type\":\"SCALAR\"}],",
        vertices, vertices, vertices, indices);
    text_addf(&json,
              "\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu,\"byteStride\":%zu},{\"buffer\":0,"
              "\"byteOffset\":%zu,"
              "\"byteLength\":%zu}",
              vertex_bytes, sizeof(vertex), vertex_bytes, indices * sizeof(uint32_t));
    if (has_textures) {
        for (int kind = 0; kind < KIND_COUNT; kind++) {
            size_t size;
            unsigned char *bytes = paint((texture_kind)kind, &size);
            text_addf(&json, ",{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", bin.length, size);
            text_add_bytes(&bin, bytes, size);
            pad(&bin, 0);
            mem_free(bytes);
        }
        text_add(&json, "],\"images\":[");
        for (int kind = 0; kind < KIND_COUNT; kind++)
            text_addf(&json, "%s{\"bufferView\":%d,\"mimeType\":\"image/jpeg\"}", kind ? "," : "", 2 + kind);
        text_add(
            &json,
            "],\"textures\":[{\"source\":0},{\"source\":1},{\"source\":2},{\"source\":3},{\"source\":4}],"
            "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},"
            "\"metallicRoughnessTexture\":{\"index\":1}},\"normalTexture\":{\"index\":2},"
            "\"occlusionTexture\":{\"index\":3},\"emissiveTexture\":{\"index\":4},\"emissiveFactor\":"
            "[1,1,1]}]");
    } else {
        text_add(&json, "],\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.8,0.5,0.3,1],"
                        "\"metallicFactor\":0,\"roughnessFactor\":0.4}}]");
    }
    pad(&bin, 0);
    text_addf(&json, ",\"buffers\":[{\"byteLength\":%zu}]}", bin.length);
    pad(&json, ' ');

    text glb = {0};
    text_add(&glb, "glTF");
    add_u32(&glb, 2);
    add_u32(&glb, (uint32_t)(12 + 8 + json.length + 8 + bin.length));
    add_u32(&glb, (uint32_t)json.length);
    add_u32(&glb, 0x4E4F534Au);
    text_add_bytes(&glb, json.data, json.length);
    add_u32(&glb, (uint32_t)bin.length);
    add_u32(&glb, 0x004E4942u);
    text_add_bytes(&glb, bin.data, bin.length);

    char *path = path_join(NULL, folder, name);
    facet_error error;
    if (!path || glb.has_failed || file_write(path, glb.data, glb.length, &error) != FACET_OK)
        stop(&error);
    printf("%s: %u triangles, %.1f MB\n", path, columns * rows * 2, (double)glb.length * 1e-6);
    mem_free(path);
    text_destroy(&glb);
    text_destroy(&json);
    text_destroy(&bin);
}

static void write_light(const char *folder)
{
    facet_error error;
    image panorama;
    if (image_create(NULL, 1024, 512, 3, IMAGE_F32, &panorama, &error) != FACET_OK)
        stop(&error);
    float *pixels = panorama.pixels;
    for (uint32_t y = 0; y < 512; y++)
        for (uint32_t x = 0; x < 1024; x++) {
            float u = ((float)x + 0.5f) / 1024.0f;
            float v = ((float)y + 0.5f) / 512.0f;
            float cloud = fractal(u, v, 41);
            float sun = expf(-((u - 0.6f) * (u - 0.6f) * 4.0f + (v - 0.27f) * (v - 0.27f)) * 60000.0f) * 4e4f;
            float *out = pixels + 3 * (y * 1024 + x);
            bool is_sky = v < 0.5f;
            out[0] = (is_sky ? 0.35f + 0.6f * cloud : 0.25f * cloud) + sun;
            out[1] = (is_sky ? 0.5f + 0.5f * cloud : 0.22f * cloud) + 0.95f * sun;
            out[2] = (is_sky ? 0.9f + 0.2f * cloud : 0.18f * cloud) + 0.85f * sun;
        }
    unsigned char *bytes;
    size_t size;
    char *path = path_join(NULL, folder, "light_1k.hdr");
    if (image_encode(&panorama, IMAGE_CODEC_HDR, &(image_encode_desc){0}, &bytes, &size, &error) !=
            FACET_OK ||
        file_write(path, bytes, size, &error) != FACET_OK)
        stop(&error);
    printf("%s: %.1f MB\n", path, (double)size * 1e-6);
    mem_free(bytes);
    mem_free(path);
    image_destroy(&panorama);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: make_models FOLDER\n");
        return 2;
    }
    write_glb(argv[1], "small.glb", 4, 3, 0.0f, false);
    write_glb(argv[1], "textured.glb", 100, 75, 0.25f, true);
    write_glb(argv[1], "heavy.glb", 1000, 500, 0.25f, false);
    write_light(argv[1]);
    return 0;
}
