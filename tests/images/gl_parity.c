/* gl_parity.c - every model of the test data rendered with OpenGL and with the preview: equal images. A line
 * for each; transmissive models are listed apart, because OpenGL does not trace rays to any depth.
 *     gl_parity [-v] [MODEL...]      -v: a line for every model, not only for large differences, and more on transmissive ones
 *
 * Display values (8-bit sRGB, not rounded) are compared twice: with one sample a pixel, where both shade
 * the same points, in pixels away from edges, where neighboring pixels differ in material, in depth by
 * more than a plane would, or in normal by more than 25 degrees; and with four, edges included, both
 * against the preview's image of 64 samples, shaded four times a pixel. The preview shades once per
 * surface in a pixel; OpenGL shades each triangle, so that pixels of small triangles with sharp
 * reflections differ: neither may be much farther from the reference than the other. */
#define _XOPEN_SOURCE 700 /* nftw */
#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "facet/facet.h"

enum { WIDTH = 256, HEIGHT = 192, COUNT = WIDTH * HEIGHT, MAX_MODELS = 1024 };

/* In 8-bit codes. */
static const double MAX_MEAN = 1.0, MAX_PERCENTILE = 4.0;
/* Allowed excess over the other error: factor and offset. */
static const double MAX_TIMES = 1.5, MAX_MORE = 0.25;

static char *models[MAX_MODELS];
static int model_count;

static int add_model(const char *path, const struct stat *status, int type, struct FTW *place)
{
    (void)status, (void)place;
    size_t length = strlen(path);
    bool is_model =
        length > 5 && (strcmp(path + length - 4, ".glb") == 0 || strcmp(path + length - 5, ".gltf") == 0);
    if (type == FTW_F && is_model && model_count < MAX_MODELS)
        models[model_count++] = strdup(path);
    return 0;
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* ---- two images ---- */

static facet_result draw(const facet_scene *scene, facet_environment *environment,
                         facet_renderer_kind renderer, uint32_t samples, facet_image **drawn,
                         facet_error *error)
{
    facet_render_desc desc = {.width = WIDTH,
                              .height = HEIGHT,
                              .environment = environment,
                              .renderer = renderer,
                              .background = FACET_BACKGROUND_ENVIRONMENT,
                              .decodes_whole_textures = true,
                              .samples = samples,
                              .quality = samples > 4 ? FACET_QUALITY_FINAL : FACET_QUALITY_NORMAL,
                              .aovs = renderer == FACET_RENDERER_KIND_PREVIEW
                                          ? FACET_AOV_DEPTH | FACET_AOV_NORMAL | FACET_AOV_MATERIAL_ID
                                          : 0,
                              .pose.time_s = 0.4};
    static const uint32_t first[1] = {0};
    if (facet_scene_get_counts(scene).animations > 0) {
        desc.pose.animations = first;
        desc.pose.animation_count = 1;
    }
    return facet_render(scene, &desc, drawn, error);
}

static const float *layer(const facet_image *i, const char *name)
{
    for (uint32_t k = 0; k < facet_image_get_layer_count(i); k++)
        if (strcmp(facet_image_get_layer(i, k).name, name) == 0)
            return facet_image_get_layer(i, k).pixels;
    return NULL;
}

static double code(float linear)
{
    double x = fmax((double)linear, 0.0);
    return 255.0 * (x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055);
}

/* Whether the surface in pixel i continues in its neighbor k. */
static bool is_continuous(const float *depth, const float *normal, const float *material, size_t i, size_t k)
{
    if (isinf(depth[i]) || isinf(depth[k]))
        return isinf(depth[i]) && isinf(depth[k]);
    const float *n = normal + 3 * i, *m = normal + 3 * k;
    return fabsf(material[i] - material[k]) < 0.5f && fabsf(depth[i] - depth[k]) < 0.03f * depth[i] &&
           n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > 0.9f;
}

static bool is_edge(const facet_image *reference, size_t i)
{
    const float *depth = layer(reference, "depth"), *normal = layer(reference, "normal"),
                *material = layer(reference, "material");
    size_t x = i % WIDTH, y = i / WIDTH;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++) {
            size_t u = x + (size_t)dx, v = y + (size_t)dy; /* beyond the border: huge */
            if (u < WIDTH && v < HEIGHT && !is_continuous(depth, normal, material, i, v * WIDTH + u))
                return true;
        }
    return false;
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

typedef struct distance {
    double mean, percentile, largest; /* 99.5th percentile */
    size_t count;
} distance;

/* differences: of the channel with the largest one. */
static distance summarize(double *differences, size_t count, double sum)
{
    if (count == 0)
        return (distance){1e9, 1e9, 1e9, 0};
    qsort(differences, count, sizeof *differences, compare_doubles);
    return (distance){sum / (3.0 * (double)count), differences[count * 995 / 1000], differences[count - 1],
                      count};
}

/* Adds a pair of colors to the sums. */
static void add_difference(const double a[3], const double b[3], double *differences, size_t *count,
                           double *sum)
{
    double most = 0.0;
    for (int c = 0; c < 3; c++) {
        double difference = fabs(a[c] - b[c]);
        *sum += isnan(difference) ? 1e9 : difference;
        most = difference > most || isnan(difference) ? difference : most;
    }
    differences[(*count)++] = isnan(most) ? 1e9 : most;
}

static double display(float linear)
{
    return fmin(code(linear), 255.0);
}

static distance compare_pixels(const facet_image *reference, const facet_image *other)
{
    static double differences[COUNT];
    const float *a = layer(reference, ""), *b = layer(other, "");
    size_t count = 0;
    double sum = 0.0;
    for (size_t i = 0; i < COUNT; i++) {
        if (is_edge(reference, i))
            continue;
        const float *p = a + 4 * i, *q = b + 4 * i;
        add_difference((double[3]){display(p[0]), display(p[1]), display(p[2])},
                       (double[3]){display(q[0]), display(q[1]), display(q[2])}, differences, &count, &sum);
    }
    return summarize(differences, count, sum);
}

/* Mean over all pixels and channels. */
static double mean_error(const facet_image *reference, const facet_image *other)
{
    const float *a = layer(reference, ""), *b = layer(other, "");
    double sum = 0.0;
    for (size_t i = 0; i < COUNT; i++)
        for (size_t c = 0; c < 3; c++)
            sum += fabs(display(a[4 * i + c]) - display(b[4 * i + c]));
    return sum / (3.0 * COUNT);
}

/* ---- a model ---- */

static bool has_transmission(const facet_scene *scene)
{
    char *text = NULL;
    facet_error error;
    bool has = facet_scene_describe_json(scene, &text, &error) == FACET_OK &&
               strstr(text, "\"KHR_materials_transmission\"");
    facet_text_destroy(text);
    return has;
}

typedef enum outcome { SAME, DIFFERENT, LISTED, NOT_LOADED, NO_GL } outcome;

/* Differences between a scene's images. */
typedef struct comparison {
    distance pixels;            /* of one sample */
    double gl_error, cpu_error; /* of four samples; infinite and 0 if not rendered */
} comparison;

static facet_result measure(const facet_scene *scene, facet_environment *environment, bool is_whole,
                            comparison *out, facet_error *error)
{
    static const struct {
        facet_renderer_kind renderer;
        uint32_t samples;
    } passes[] = {{FACET_RENDERER_KIND_GL, 1},
                  {FACET_RENDERER_KIND_PREVIEW, 1},
                  {FACET_RENDERER_KIND_GL, 4},
                  {FACET_RENDERER_KIND_PREVIEW, 4},
                  {FACET_RENDERER_KIND_PREVIEW, 64}};
    facet_image *drawn[5] = {NULL};
    facet_result result = FACET_OK;
    int count = is_whole ? 5 : 2;
    for (int i = 0; i < count && result == FACET_OK; i++)
        result = draw(scene, environment, passes[i].renderer, passes[i].samples, &drawn[i], error);
    if (result == FACET_OK && is_whole)
        *out = (comparison){compare_pixels(drawn[1], drawn[0]), mean_error(drawn[4], drawn[2]),
                            mean_error(drawn[4], drawn[3])};
    else if (result == FACET_OK)
        *out = (comparison){compare_pixels(drawn[1], drawn[0]), HUGE_VAL, 0.0};
    for (int i = 0; i < 5; i++)
        facet_image_destroy(drawn[i]);
    return result;
}

/* Smooth metal made of triangles smaller than a pixel: OpenGL snaps vertices to a grid of 1/256 pixel, which tilts
 * them. The percentile does not apply. */
static bool has_subpixel_triangles(const char *name)
{
    return strcmp(name, "core/NormalTangentTest.glb") == 0;
}

static bool is_same(const comparison *c, const char *name)
{
    const distance *d = &c->pixels;
    return d->mean < MAX_MEAN && (d->percentile < MAX_PERCENTILE || has_subpixel_triangles(name)) &&
           d->count > COUNT / 20 && c->gl_error < MAX_TIMES * c->cpu_error + MAX_MORE;
}

static outcome check(const char *path, facet_environment *environment, bool is_verbose)
{
    facet_scene *scene = NULL;
    facet_error error = {0};
    comparison c = {.gl_error = 0.0};
    const char *name = strstr(path, "/models/") ? strstr(path, "/models/") + 8 : path;
    if (facet_scene_load(path, NULL, &scene, &error) != FACET_OK)
        return NOT_LOADED;
    bool is_clear = has_transmission(scene);
    facet_result result = measure(scene, environment, !is_clear || is_verbose, &c, &error);
    outcome v;
    if (result != FACET_OK) {
        v = result == FACET_ERROR_SYSTEM ? NO_GL : DIFFERENT;
        printf("%s: %s\n", name, error.message);
    } else {
        v = is_same(&c, name) ? SAME : is_clear ? LISTED : DIFFERENT;
        if (is_verbose || v != SAME)
            printf("%-48s %6.3f %7.2f %7.2f  of %5zu pixels;  %6.3f %6.3f%s\n", name, c.pixels.mean,
                   c.pixels.percentile, c.pixels.largest, c.pixels.count, c.gl_error, c.cpu_error,
                   v == LISTED      ? "  (transmission)"
                   : v == DIFFERENT ? "  DIFFERENT"
                                    : "");
    }
    facet_scene_destroy(scene);
    return v;
}

int main(int argc, char **argv)
{
    const char *folder = getenv("FACET_TEST_DATA");
    char path[1024];
    int counts[NO_GL + 1] = {0};
    bool is_verbose = argc > 1 && strcmp(argv[1], "-v") == 0;
    if (!folder) {
        printf("skipped: FACET_TEST_DATA names no folder with models\n");
        return 77;
    }
    snprintf(path, sizeof path, "%s/models", folder);
    for (int i = 1 + is_verbose; i < argc && model_count < MAX_MODELS; i++)
        models[model_count++] = strdup(argv[i]);
    if (model_count == 0)
        nftw(path, add_model, 16, FTW_PHYS);
    qsort(models, (size_t)model_count, sizeof *models, compare_names);
    facet_environment *environment = NULL;
    facet_error error;
    snprintf(path, sizeof path, "%s/env/leadenhall_market_1k.hdr", folder);
    if (facet_environment_load(path, NULL, &environment, &error) != FACET_OK) {
        printf("%s\n", error.message);
        return 1;
    }
    printf("differences in 8-bit codes: mean, 99.5th percentile, largest; OpenGL and preview from a better "
           "image\n");
    for (int i = 0; i < model_count; i++) {
        counts[check(models[i], environment, is_verbose)] += 1;
        free(models[i]);
        fflush(stdout);
        if (counts[NO_GL])
            break;
    }
    facet_environment_destroy(environment);
    printf("%d models the same, %d different, %d with transmission, %d not loaded\n", counts[SAME],
           counts[DIFFERENT], counts[LISTED], counts[NOT_LOADED]);
    return counts[NO_GL] ? 77 : counts[DIFFERENT] ? 1 : 0;
}
