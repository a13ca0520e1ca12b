/* part_file.c - the texts of a part's file, written and read: what it is part of, and how it is finished. */
#define _POSIX_C_SOURCE 200809L
#include "base/memory.h"
#include "base/result.h"
#include "ibl/cache.h"
#include "image/image.h"
#include "path/path_film.h"
#include "path/path_render.h"
#include "render/part.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static const char FORMAT[] = "1";
enum { MAX_SIZE = 65536, MAX_COUNT = 1000000, NUMBERS_SIZE = 1024 };

uint64_t part_digest(const film *f, const uint32_t rectangle[4])
{
    uint64_t hash = 0;
    for (uint32_t i = 0; i < f->layer_count; i++) {
        const film_layer *l = &f->layers[i];
        for (uint32_t y = 0; y < rectangle[3]; y++) {
            size_t first = (size_t)(rectangle[1] + y) * f->width + rectangle[0];
            hash = cache_hash(hash, l->pixels + first * l->channel_count,
                              (size_t)rectangle[2] * l->channel_count * sizeof(float));
        }
    }
    return hash;
}

/* ---- numbers ---- */

/* All numbers of a header as text. */
static void print_numbers(const part_header *h, char out[NUMBERS_SIZE])
{
    const facet_part_info *p = &h->info;
    const uint32_t *r = p->rectangle;
    snprintf(out, NUMBERS_SIZE,
             "%u %u %d %u %u %u %u %u %u %u %u %u %d %u %d %" PRIu64 " %.9g %d %d %.9g %.9g %.9g %d %d %d %d",
             p->index, p->count, (int)p->split, p->width, p->height, r[0], r[1], r[2], r[3], p->first_sample,
             p->sample_count, h->samples, (int)h->renderer, h->aovs, h->has_ground, h->dropped,
             (double)h->exposure_ev, h->denoises, (int)h->background, (double)h->background_color[0],
             (double)h->background_color[1], (double)h->background_color[2], (int)h->shading,
             h->is_ogl1_linear, (int)p->tonemap, p->has_display_tonemap);
}

static bool scan_numbers(const char *from, part_header *h)
{
    facet_part_info *p = &h->info;
    uint32_t *r = p->rectangle;
    unsigned split, renderer, ground, denoises, background, shading, linear, tonemap, display;
    float *color = h->background_color;
    int count = sscanf(
        from, "%u %u %u %u %u %u %u %u %u %u %u %u %u %u %u %" SCNu64 " %f %u %u %f %f %f %u %u %u %u",
        &p->index, &p->count, &split, &p->width, &p->height, &r[0], &r[1], &r[2], &r[3], &p->first_sample,
        &p->sample_count, &h->samples, &renderer, &h->aovs, &ground, &h->dropped, &h->exposure_ev, &denoises,
        &background, &color[0], &color[1], &color[2], &shading, &linear, &tonemap, &display);
    p->split = (facet_part_split)split;
    h->renderer = (facet_renderer_kind)renderer;
    h->has_ground = ground != 0;
    h->denoises = denoises != 0;
    h->background = (facet_background)background;
    h->shading = (facet_shading)shading;
    h->is_ogl1_linear = linear != 0;
    p->tonemap = (facet_tonemap)tonemap;
    p->has_display_tonemap = display != 0;
    return count == 26;
}

static bool is_inside(const uint32_t r[4], uint32_t width, uint32_t height)
{
    return r[2] > 0 && r[3] > 0 && r[0] < width && r[1] < height && r[2] <= width - r[0] &&
           r[3] <= height - r[1];
}

/* Whether the numbers describe a part that facet makes. */
static bool is_sound(const part_header *h)
{
    const facet_part_info *p = &h->info;
    const renderer_row *r = renderer_get(h->renderer);
    bool is_path = r && r->info.features & FACET_RENDERER_FEATURE_PATH;
    if (!r || r->info.features & FACET_RENDERER_FEATURE_GL || h->aovs & ~r->info.aovs ||
        (h->has_ground && !is_path))
        return false;
    return p->index < p->count && p->count <= MAX_COUNT && (unsigned)p->split <= FACET_PART_SPLIT_SAMPLES &&
           p->width <= MAX_SIZE && p->height <= MAX_SIZE && is_inside(p->rectangle, p->width, p->height) &&
           (is_path || p->split == FACET_PART_SPLIT_TILES) && h->samples <= r->info.max_samples &&
           p->first_sample < h->samples && p->sample_count <= h->samples - p->first_sample &&
           isfinite(h->exposure_ev) && (unsigned)h->background <= FACET_BACKGROUND_ENVIRONMENT &&
           (unsigned)h->shading <= FACET_SHADING_OGL1 && (unsigned)p->tonemap <= FACET_TONEMAP_HABLE;
}

/* ---- writing ---- */

static part_header header_of(const facet_render_desc *whole, const facet_render_desc *part, uint64_t dropped,
                             const film *f)
{
    const facet_part_desc *p = &whole->part;
    part_header h = {.info = {.index = p->index,
                              .count = p->count,
                              .split = p->split,
                              .width = whole->crop[2],
                              .height = whole->crop[3],
                              .rectangle = {part->crop[0] - whole->crop[0], part->crop[1] - whole->crop[1],
                                            f->width, f->height},
                              .sample_count = whole->samples,
                              .tonemap = whole->tonemap,
                              .has_display_tonemap = p->has_display_tonemap},
                     .samples = whole->samples,
                     .renderer = whole->renderer,
                     .aovs = whole->aovs,
                     .dropped = dropped,
                     .exposure_ev = whole->exposure_ev,
                     .denoises = f->keeps_sums && whole->path.denoises,
                     .background = whole->background,
                     .shading = whole->shading,
                     .is_ogl1_linear = whole->ogl1.is_linear};
    bool is_path = renderer_get(whole->renderer)->info.features & FACET_RENDERER_FEATURE_PATH;
    h.has_ground = is_path && whole->ground == FACET_GROUND_SHADOW;
    memcpy(h.background_color, whole->background_color, sizeof h.background_color);
    if (p->split == FACET_PART_SPLIT_SAMPLES) {
        uint32_t end;
        path_part_get_samples(p, whole->samples, &h.info.first_sample, &end);
        h.info.sample_count = end - h.info.first_sample;
    }
    return h;
}

facet_result part_describe(renderer_set *set, const facet_render_desc *whole, const facet_render_desc *part,
                           uint64_t dropped, film *f, facet_error *error)
{
    const part_header h = header_of(whole, part, dropped, f);
    char numbers[NUMBERS_SIZE], settings[65], machine[64], digest[17];
    print_numbers(&h, numbers);
    TRY(part_key_create(set, whole, settings, error));
    part_describe_machine(whole, machine, sizeof machine);
    snprintf(digest, sizeof digest, "%016" PRIx64,
             part_digest(f, (const uint32_t[]){0, 0, f->width, f->height}));
    const struct {
        const char *name, *value;
    } texts[] = {
        {"facetPart", FORMAT},           {"facetPartNumbers", numbers},
        {"facetPartSettings", settings}, {"facetPartVersion", FACET_VERSION},
        {"facetPartMachine", machine},   {"facetPartCommand", whole->part.command ? whole->part.command : ""},
        {"facetPartDigest", digest}};
    facet_result result = FACET_OK;
    for (size_t i = 0; i < sizeof texts / sizeof *texts && result == FACET_OK; i++)
        result = film_add_text(f, texts[i].name, texts[i].value, &whole->allocator, error);
    return result;
}

/* ---- reading ---- */

facet_result part_open(const char *path, const facet_allocator *allocator, file_bytes *file,
                       facet_error *error)
{
    struct stat info;
    if (stat(path, &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode))
        return fail(error, FACET_ERROR_READ, "%s: it is a pipe or a device; the file of a part was expected",
                    path);
    return file_open(path, 0, allocator, file, error);
}

/* Whether the file is a part that this version reads. The codec reports a damaged OpenEXR file. */
static facet_result check_kind(const unsigned char *bytes, size_t size, const char *path, facet_error *error)
{
    char format[16] = "";
    image header;
    if (image_codec_detect(bytes, size) != IMAGE_CODEC_EXR)
        return fail(error, FACET_ERROR_INVALID, "%s: not a part of an image: an OpenEXR file was expected",
                    path);
    TRY(image_probe(bytes, size, path, &header, NULL, error));
    if (image_read_exr_text(bytes, size, path, "facetPart", format, sizeof format, NULL) != FACET_OK)
        return fail(error, FACET_ERROR_INVALID, "%s: is an OpenEXR image, but not a part of one", path);
    if (strcmp(format, FORMAT) != 0)
        return fail(error, FACET_ERROR_INVALID,
                    "%s: is a part in format %s; this version of facet reads format %s", path, format,
                    FORMAT);
    return FACET_OK;
}

facet_result part_header_read(const unsigned char *bytes, size_t size, const char *path, part_header *out,
                              facet_error *error)
{
    *out = (part_header){.samples = 0};
    facet_part_info *p = &out->info;
    char numbers[NUMBERS_SIZE];
    const struct {
        const char *name;
        char *value;
        size_t size;
    } texts[] = {{"facetPartNumbers", numbers, sizeof numbers},
                 {"facetPartSettings", p->settings, sizeof p->settings},
                 {"facetPartVersion", p->version, sizeof p->version},
                 {"facetPartMachine", p->machine, sizeof p->machine},
                 {"facetPartCommand", p->command, sizeof p->command},
                 {"facetPartDigest", p->digest, sizeof p->digest}};
    TRY(check_kind(bytes, size, path, error));
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        TRY(image_read_exr_text(bytes, size, path, texts[i].name, texts[i].value, texts[i].size, error));
    if (!scan_numbers(numbers, out) || !is_sound(out))
        return fail(error, FACET_ERROR_INVALID,
                    "%s: the part is damaged: its description is not one that facet writes", path);
    p->has_layers = out->aovs != 0;
    image header;
    TRY(image_probe(bytes, size, path, &header, NULL, error));
    if (header.width != p->rectangle[2] || header.height != p->rectangle[3])
        return fail(error, FACET_ERROR_INVALID, "%s: the part is damaged: it has %u x %u pixels, not %u x %u",
                    path, header.width, header.height, p->rectangle[2], p->rectangle[3]);
    return FACET_OK;
}
