/* model_image.c - see model_image.h. */
#include "model_image.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static bool find_model(const char *path, char *full, size_t size)
{
    const char *folder = getenv("FACET_TEST_DATA");
    snprintf(full, size, "%s/models/%s", folder ? folder : "", path);
    FILE *file = folder ? fopen(full, "rb") : NULL;
    if (!file) {
        print_message("skipped: FACET_TEST_DATA has no models/%s\n", path);
        return false;
    }
    fclose(file);
    return true;
}

facet_scene *model_load(const char *path)
{
    char full[1024];
    if (!find_model(path, full, sizeof full))
        return NULL;
    facet_scene *scene = NULL;
    facet_error error;
    if (facet_scene_load(full, NULL, &scene, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return scene;
}

static unsigned char *read_file(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    unsigned char *bytes = malloc(*size);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    fclose(file);
    return bytes;
}

unsigned char *model_read(const char *path, size_t *size)
{
    char full[1024];
    return find_model(path, full, sizeof full) ? read_file(full, size) : NULL;
}

static uint32_t word_at(const unsigned char *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static void put_word(unsigned char *bytes, size_t word)
{
    for (int i = 0; i < 4; i++)
        bytes[i] = (unsigned char)(word >> 8 * i & 255);
}

/* Writes json with text replaced, padded with blanks to a multiple of 4; its length. out: large enough. */
static size_t replace(const char *json, size_t length, const char *text, const char *by, char *out)
{
    size_t written = 0, found = 0;
    for (size_t i = 0; i < length;) {
        if (length - i >= strlen(text) && memcmp(json + i, text, strlen(text)) == 0) {
            memcpy(out + written, by, strlen(by));
            written += strlen(by);
            i += strlen(text);
            found++;
        } else {
            out[written++] = json[i++];
        }
    }
    if (found == 0)
        fail_msg("the model has no %s", text);
    while (written % 4 != 0)
        out[written++] = ' ';
    return written;
}

facet_scene *model_load_edited(const char *path, const char *text, const char *by)
{
    size_t size;
    unsigned char *bytes = model_read(path, &size);
    if (!bytes)
        return NULL;
    assert_true(size > 20 && memcmp(bytes, "glTF", 4) == 0);
    size_t length = word_at(bytes + 12);
    assert_true(length <= size - 20);
    unsigned char *edited = malloc(size + length * (strlen(by) + 1) + 4);
    assert_non_null(edited);
    memcpy(edited, bytes, 20);
    size_t written = replace((const char *)bytes + 20, length, text, by, (char *)edited + 20);
    size_t rest = size - 20 - length;
    memcpy(edited + 20 + written, bytes + 20 + length, rest);
    put_word(edited + 8, 20 + written + rest);
    put_word(edited + 12, written);
    facet_scene *scene = NULL;
    facet_error error;
    if (facet_scene_load_memory(edited, 20 + written + rest, path, NULL, &scene, &error) != FACET_OK)
        fail_msg("%s", error.message);
    free(edited);
    free(bytes);
    return scene;
}

static model_image copy_layers(const facet_image *image)
{
    facet_image_view color = facet_image_get_layer(image, 0);
    model_image p = {.width = color.width, .height = color.height, .count = color.width * color.height};
    p.rgba = malloc(p.count * 4 * sizeof *p.rgba);
    p.material = malloc(p.count * sizeof *p.material);
    assert_non_null(p.rgba);
    assert_non_null(p.material);
    assert_int_equal(facet_image_get_layer_count(image), 2);
    facet_image_view id = facet_image_get_layer(image, 1);
    assert_int_equal(id.channel_count, 1);
    for (uint32_t y = 0; y < p.height; y++) {
        const float *row =
            (const float *)(const void *)((const char *)color.pixels + y * color.row_stride_bytes);
        const float *ids = (const float *)(const void *)((const char *)id.pixels + y * id.row_stride_bytes);
        memcpy(p.rgba + y * p.width * 4, row, p.width * 4 * sizeof *row);
        for (uint32_t x = 0; x < p.width; x++)
            p.material[y * p.width + x] = (int)ids[x] - 1;
    }
    for (uint32_t i = 0; i < p.count * 4; i++)
        if (!isfinite(p.rgba[i]))
            fail_msg("pixel %u is not finite", i / 4);
    return p;
}

model_image model_image_render(const facet_scene *scene, const view *v, const facet_render_desc *desc)
{
    facet_render_desc filled = desc ? *desc : (facet_render_desc){0};
    facet_environment *studio = NULL;
    facet_image *image = NULL;
    facet_error error;
    if (filled.width == 0)
        filled.width = filled.height = 64;
    filled.aovs = FACET_AOV_MATERIAL_ID;
    if (!filled.environment) {
        assert_int_equal(facet_environment_create_studio(NULL, &studio, &error), FACET_OK);
        filled.environment = studio;
    }
    facet_camera camera = {0};
    facet_orbit orbit = facet_orbit_default();
    float back = v->back > 0.0f ? v->back : 10.0f;
    if (v->height > 0.0f)
        camera = (facet_camera){
            .eye = {v->x, v->y, back}, .target = {v->x, v->y, back - 1.0f}, .ortho_height = v->height};
    else if (facet_camera_from_orbit(scene, &filled.pose, &orbit, (float)filled.width / (float)filled.height,
                                     &camera, &error) != FACET_OK)
        fail_msg("%s", error.message);
    if (!filled.camera)
        filled.camera = &camera;
    if (facet_render(scene, &filled, &image, &error) != FACET_OK)
        fail_msg("%s", error.message);
    model_image p = copy_layers(image);
    facet_image_destroy(image);
    facet_environment_destroy(studio);
    return p;
}

#define SPHERE_VIEW 1.02f /* m, height of the image of a sphere of diameter 1 */

model_image model_image_of_sphere(const char *path, float x, const facet_render_desc *desc, const char *text,
                                  const char *by)
{
    facet_scene *scene = text ? model_load_edited(path, text, by) : model_load(path);
    if (!scene)
        return (model_image){0};
    model_image p = model_image_render(scene, &(view){.x = x, .height = SPHERE_VIEW}, desc);
    facet_scene_destroy(scene);
    return p;
}

void model_image_destroy(model_image *p)
{
    free(p->rgba);
    free(p->material);
    *p = (model_image){0};
}

double model_image_luminance(const model_image *p, uint32_t i)
{
    const float *c = p->rgba + i * 4;
    return 0.2126 * (double)c[0] + 0.7152 * (double)c[1] + 0.0722 * (double)c[2];
}

double model_image_chroma(const model_image *p, uint32_t i)
{
    const float *c = p->rgba + i * 4;
    return (double)(fmaxf(c[0], fmaxf(c[1], c[2])) - fminf(c[0], fminf(c[1], c[2])));
}

static bool belongs(const model_image *p, uint32_t i, int material)
{
    return material < 0 ? p->material[i] >= 0 : p->material[i] == material;
}

uint32_t model_image_pixels(const model_image *p, int material)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < p->count; i++)
        count += belongs(p, i, material);
    return count;
}

static double channel_of(const model_image *p, uint32_t i, int channel)
{
    return (double)p->rgba[i * 4 + (uint32_t)channel];
}

double model_image_mean(const model_image *p, int material, int channel)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < p->count; i++)
        sum += belongs(p, i, material) ? channel_of(p, i, channel) : 0.0;
    return sum / model_image_pixels(p, material);
}

double model_image_mean_luminance(const model_image *p, int material)
{
    return 0.2126 * model_image_mean(p, material, 0) + 0.7152 * model_image_mean(p, material, 1) +
           0.0722 * model_image_mean(p, material, 2);
}

double model_image_mean_chroma(const model_image *p, int material)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < p->count; i++)
        sum += belongs(p, i, material) ? model_image_chroma(p, i) : 0.0;
    return sum / model_image_pixels(p, material);
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double model_image_percentile(const model_image *p, int material, double share)
{
    double *values = malloc(p->count * sizeof *values);
    assert_non_null(values);
    uint32_t count = 0;
    for (uint32_t i = 0; i < p->count; i++)
        if (belongs(p, i, material))
            values[count++] = model_image_luminance(p, i);
    assert_true(count > 0);
    qsort(values, count, sizeof *values, compare_doubles);
    double value = values[(uint32_t)(share * (count - 1))];
    free(values);
    return value;
}

double model_image_detail(const model_image *p, int material)
{
    double sum = 0.0;
    uint32_t count = 0;
    for (uint32_t y = 0; y + 1 < p->height; y++)
        for (uint32_t x = 0; x + 1 < p->width; x++) {
            uint32_t i = y * p->width + x, others[2] = {i + 1, i + p->width};
            for (int k = 0; k < 2; k++)
                if (belongs(p, i, material) && belongs(p, others[k], material)) {
                    sum += fabs(model_image_luminance(p, i) - model_image_luminance(p, others[k]));
                    count++;
                }
        }
    assert_true(count > 0);
    return sum / count;
}

double model_image_radius(const model_image *p, uint32_t i)
{
    double x = (i % p->width + 0.5) / p->width * 2.0 - 1.0;
    double y = (i / p->width + 0.5) / p->height * 2.0 - 1.0;
    return sqrt(x * x + y * y) * (double)SPHERE_VIEW;
}

double model_image_cosine(const model_image *p, uint32_t i)
{
    double r = model_image_radius(p, i);
    return sqrt(fmax(0.0, 1.0 - r * r));
}

double model_image_ring(const model_image *p, int material, int channel, double from, double to)
{
    double sum = 0.0, count = 0.0;
    for (uint32_t i = 0; i < p->count; i++) {
        double r = model_image_radius(p, i);
        if (belongs(p, i, material) && r >= from && r < to) {
            sum += channel_of(p, i, channel);
            count++;
        }
    }
    assert_true(count > 0.0);
    return sum / count;
}

/* [0, 6): red at 0, green at 2, blue at 4. */
static double hue_of(const float *c, double chroma)
{
    double r = (double)c[0], g = (double)c[1], b = (double)c[2];
    if (r >= g && r >= b)
        return fmod((g - b) / chroma + 6.0, 6.0);
    return g >= b ? 2.0 + (b - r) / chroma : 4.0 + (r - g) / chroma;
}

uint32_t model_image_hues(const model_image *p, int material)
{
    uint32_t bins[12] = {0}, used = 0;
    for (uint32_t i = 0; i < p->count; i++) {
        double chroma = model_image_chroma(p, i);
        if (belongs(p, i, material) && chroma >= 0.05)
            bins[(uint32_t)(hue_of(p->rgba + i * 4, chroma) * 2.0) % 12]++;
    }
    for (int k = 0; k < 12; k++)
        used += bins[k] * 50 >= model_image_pixels(p, material);
    return used;
}

static facet_image *image_of(const model_image *p)
{
    facet_image *image = NULL;
    const facet_image_view pixels = {
        .width = p->width, .height = p->height, .channel_count = 4, .pixels = p->rgba};
    assert_int_equal(facet_image_create(&pixels, NULL, &image, NULL), FACET_OK);
    return image;
}

double model_image_distance(const model_image *a, const model_image *b)
{
    facet_image *first = image_of(a), *second = image_of(b);
    facet_comparison c;
    facet_error error;
    const facet_compare_desc desc = {.space = FACET_COMPARE_SPACE_LINEAR,
                                     .skipped_metrics = FACET_METRIC_SSIM | FACET_METRIC_FLIP};
    if (facet_compare(first, second, &desc, &c, NULL, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_true(c.invalid_count == 0);
    facet_image_destroy(first);
    facet_image_destroy(second);
    return c.nrmse;
}
