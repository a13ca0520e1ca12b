/* part_merge.c - parts to the image: their values are read into one film, which is finished like that of one process. */
#include "base/file.h"
#include "base/memory.h"
#include "base/result.h"
#include "film/film_channels.h"
#include "film/matte.h"
#include "path/path_film.h"
#include "render/part.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* ---- which parts there are ---- */

typedef struct part_entry {
    const char *path;
    part_header header;
} part_entry;

/* The merging of an image. */
typedef struct merging {
    const facet_merge_desc *desc;
    part_entry *parts; /* part_count of them so far, in the order of the paths */
    uint32_t part_count;
    /* of path tracing, where finishing needs the whole image or all samples; else NULL */
    path_film *sums, *one; /* of all parts, of one part by samples */
} merging;

static facet_result read_header(const merging *m, const char *path, part_header *out, facet_error *error)
{
    file_bytes file;
    TRY(part_open(path, &m->desc->allocator, &file, error));
    facet_result result = part_header_read(file.data, file.size, path, out, error);
    file_close(&file);
    return result;
}

/* The instruction set alone, which a comma separates from the vendor. */
static bool has_same_set(const char *a, const char *b)
{
    size_t length = strcspn(a, ",");
    return length == strcspn(b, ",") && memcmp(a, b, length) == 0;
}

/* Refuses a part of another image than the first. */
static facet_result check_same(const part_entry *a, const part_entry *b, facet_error *error)
{
    const facet_part_info *p = &a->header.info, *q = &b->header.info;
    if (strcmp(p->version, q->version) != 0)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: it was rendered by facet %s, and %s by facet %s",
                    b->path, q->version, a->path, p->version);
    if (!has_same_set(p->machine, q->machine))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "%s: it was rendered with another instruction set (--isa) than %s: %.*s, not %.*s",
                    b->path, a->path, (int)strcspn(q->machine, ","), q->machine,
                    (int)strcspn(p->machine, ","), p->machine);
    static const char *const kinds[] = {"a tile", "a range of samples"};
    if (p->split != q->split)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: it is %s, and %s %s; parts of one kind were expected",
                    b->path, kinds[q->split], a->path, kinds[p->split]);
    if (p->count != q->count)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: it is one of %u parts, and %s one of %u", b->path,
                    q->count, a->path, p->count);
    if (strcmp(p->settings, q->settings) != 0 || p->width != q->width || p->height != q->height)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "%s: it is part of another image than %s: the model or an option was different", b->path,
                    a->path);
    return FACET_OK;
}

/* A part that is there twice counts once if both say the same. */
static facet_result check_twice(const merging *m, const part_entry *there, const part_entry *again,
                                facet_error *error)
{
    if (strcmp(there->header.info.digest, again->header.info.digest) != 0)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: it is part %u again, with other pixels than %s",
                    again->path, again->header.info.index, there->path);
    log_message(&m->desc->log, FACET_LOG_LEVEL_DETAIL, "%s: it is the same part as %s", again->path,
                there->path);
    return FACET_OK;
}

/* Whether parts may differ in a few pixels by one code value. */
static void warn_of_vendors(const merging *m)
{
    const char *machine = m->parts[0].header.info.machine;
    for (uint32_t i = 0; i < m->part_count; i++)
        if (strcmp(m->parts[i].header.info.machine, machine) != 0) {
            log_warning(&m->desc->log,
                        "%s and %s were rendered on processors of different vendors; pixels may differ by "
                        "one code value "
                        "from those of one machine",
                        m->parts[0].path, m->parts[i].path);
            return;
        }
}

static facet_result add_part(merging *m, const char *path, facet_error *error)
{
    part_entry *found = &m->parts[m->part_count];
    *found = (part_entry){.path = path};
    TRY(read_header(m, path, &found->header, error));
    if (m->part_count > 0)
        TRY(check_same(&m->parts[0], found, error));
    for (uint32_t i = 0; i < m->part_count; i++)
        if (m->parts[i].header.info.index == found->header.info.index)
            return check_twice(m, &m->parts[i], found, error);
    m->part_count++;
    return FACET_OK;
}

static facet_result check_complete(const merging *m, facet_error *error)
{
    const facet_part_info *whole = &m->parts[0].header.info;
    if (m->part_count < whole->count)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: it is one of %u parts, of which only %u are there",
                    m->parts[0].path, whole->count, m->part_count);
    uint64_t area = 0;
    for (uint32_t i = 0; i < m->part_count; i++)
        area += (uint64_t)m->parts[i].header.info.rectangle[2] * m->parts[i].header.info.rectangle[3];
    if (area != (uint64_t)whole->width * whole->height *
                    (whole->split == FACET_PART_SPLIT_SAMPLES ? m->part_count : 1))
        return fail(error, FACET_ERROR_INVALID, "%s: the parts overlap or leave pixels out",
                    m->parts[0].path);
    return FACET_OK;
}

static facet_result find_parts(merging *m, const char *const *paths, size_t path_count, facet_error *error)
{
    if (path_count == 0)
        return fail(error, FACET_ERROR_ARGUMENT, "there are no parts");
    m->parts = mem_zalloc(&m->desc->allocator, path_count, sizeof *m->parts);
    if (!m->parts)
        return fail_memory(error, "parts", path_count * sizeof *m->parts);
    for (size_t i = 0; i < path_count; i++)
        TRY(add_part(m, paths[i], error));
    TRY(check_complete(m, error));
    warn_of_vendors(m);
    return FACET_OK;
}

/* ---- values ---- */

/* The layers of a film into which the values of parts are read, with the sums in place of those that are made of them. */
static film list_places(const film *f, const path_film *sums)
{
    film places = {.width = f->width, .height = f->height};
    for (uint32_t i = 0; i < f->layer_count; i++)
        if (!sums || i == 0 || !path_film_makes_layer(f->layers[i].name))
            places.layers[places.layer_count++] = f->layers[i];
    if (sums)
        places.layer_count += path_film_list_layers(sums, places.layers + places.layer_count);
    return places;
}

/* Reads the values of a part into a rectangle. */
static facet_result read_values(const merging *m, const part_entry *part, const film *to, const uint32_t r[4],
                                facet_error *error)
{
    image_channel channels[FILM_MAX_LAYERS * 4 + PATH_FILM_MAX_CHANNELS];
    uint32_t count = 0;
    char digest[17];
    file_bytes file;
    for (uint32_t i = 0; i < to->layer_count; i++) {
        film_layer l = to->layers[i];
        l.pixels += ((size_t)r[1] * to->width + r[0]) * l.channel_count;
        count += film_layer_list_channels(&l, to->width, channels + count);
    }
    TRY(part_open(part->path, &m->desc->allocator, &file, error));
    facet_result result = image_read_exr_channels(file.data, file.size, part->path, &m->desc->allocator, r[2],
                                                  r[3], channels, count, error);
    file_close(&file);
    if (result != FACET_OK)
        return result;
    snprintf(digest, sizeof digest, "%016" PRIx64, part_digest(to, r));
    if (strcmp(digest, part->header.info.digest) != 0)
        return fail(error, FACET_ERROR_INVALID,
                    "%s: the part is damaged: its values differ from those that were written", part->path);
    return FACET_OK;
}

static facet_result read_sums(const merging *m, const part_entry *part, const film *f, path_film *sums,
                              facet_error *error)
{
    const film to = list_places(f, sums);
    TRY(read_values(m, part, &to, (const uint32_t[]){0, 0, f->width, f->height}, error));
    path_film_set_dropped(sums, part->header.dropped);
    return path_film_is_sound(sums) ? FACET_OK
                                    : fail(error, FACET_ERROR_INVALID,
                                           "%s: the part is damaged: it holds no valid sums", part->path);
}

/* ---- tiles that are finished one by one ---- */

static void copy_tile(const film *tile, const uint32_t r[4], film *to)
{
    for (uint32_t i = 0; i < tile->layer_count; i++) {
        size_t texel = tile->layers[i].channel_count;
        for (uint32_t y = 0; y < tile->height; y++)
            memcpy(to->layers[i].pixels + ((size_t)(r[1] + y) * to->width + r[0]) * texel,
                   tile->layers[i].pixels + (size_t)y * tile->width * texel,
                   tile->width * texel * sizeof(float));
    }
}

/* Without denoising pixels are finished independently of each other: only the sums of one tile are in memory. */
static facet_result finish_tile(const merging *m, const part_entry *part, const facet_render_desc *finishing,
                                film *target, facet_render_stats *stats, facet_error *error)
{
    const part_header *h = &part->header;
    const uint32_t *r = h->info.rectangle;
    film tile = {.width = 0};
    path_film *sums = NULL;
    facet_result result = film_create(&m->desc->allocator, r[2], r[3], h->aovs, &tile, error);
    if (result == FACET_OK)
        result = path_film_create(&m->desc->allocator, r[2], r[3], h->has_ground, &sums, error);
    if (result == FACET_OK)
        result = read_sums(m, part, &tile, sums, error);
    if (result == FACET_OK) {
        stats->samples += path_film_total_samples(sums);
        stats->dropped_samples += path_film_dropped(sums);
        result = path_film_finish(sums, finishing, &tile, &stats->denoise_s, error);
    }
    if (result == FACET_OK)
        copy_tile(&tile, r, target);
    path_film_destroy(sums);
    film_destroy(&tile);
    return result;
}

/* ---- all parts ---- */

/* Reads the sums of a tile to their place in those of the image, or adds samples. */
static facet_result add_sums(const merging *m, const part_entry *part, const film *target, facet_error *error)
{
    if (part->header.info.split == FACET_PART_SPLIT_TILES) {
        const film to = list_places(target, m->sums);
        path_film_set_dropped(m->sums, path_film_dropped(m->sums) + part->header.dropped);
        return read_values(m, part, &to, part->header.info.rectangle, error);
    }
    TRY(read_sums(m, part, target, m->one, error));
    return path_film_add_film(m->sums, m->one)
               ? FACET_OK
               : fail(error, FACET_ERROR_INVALID, "%s: the part is damaged: its pixels have too many samples",
                      part->path);
}

static facet_result create_sums(merging *m, facet_error *error)
{
    const part_header *h = &m->parts[0].header;
    const facet_part_info *p = &h->info;
    const facet_allocator *allocator = &m->desc->allocator;
    TRY(path_film_create(allocator, p->width, p->height, h->has_ground, &m->sums, error));
    return p->split == FACET_PART_SPLIT_SAMPLES
               ? path_film_create(allocator, p->width, p->height, h->has_ground, &m->one, error)
               : FACET_OK;
}

static facet_result finish_sums(const merging *m, const facet_render_desc *finishing, film *target,
                                facet_render_stats *stats, facet_error *error)
{
    if (!path_film_is_sound(m->sums))
        return fail(error, FACET_ERROR_INVALID, "%s: the parts are damaged: they hold no valid sums",
                    m->parts[0].path);
    stats->samples = path_film_total_samples(m->sums);
    stats->dropped_samples = path_film_dropped(m->sums);
    return path_film_finish(m->sums, finishing, target, &stats->denoise_s, error);
}

static facet_result read_parts(merging *m, const facet_render_desc *finishing, film *target,
                               facet_render_stats *stats, facet_error *error)
{
    const facet_progress *progress = &m->desc->progress;
    const part_header *h = &m->parts[0].header;
    const film pixels = list_places(target, NULL);
    bool is_path = renderer_get(h->renderer)->info.features & FACET_RENDERER_FEATURE_PATH;
    if (is_path && (h->denoises || h->info.split == FACET_PART_SPLIT_SAMPLES))
        TRY(create_sums(m, error));
    for (uint32_t i = 0; i < m->part_count; i++) {
        const part_entry *part = &m->parts[i];
        TRY(m->sums   ? add_sums(m, part, target, error)
            : is_path ? finish_tile(m, part, finishing, target, stats, error)
                      : read_values(m, part, &pixels, part->header.info.rectangle, error));
        if (progress->report && !progress->report(progress->user, "merge", (i + 1.0) / m->part_count))
            return fail(error, FACET_ERROR_CANCELLED, "merging was cancelled");
    }
    return m->sums ? finish_sums(m, finishing, target, stats, error) : FACET_OK;
}

/* ---- texts that the image has, too ---- */

enum { MAX_TEXT = 1 << 26 };

/* Adds a text of a part to the image, if it has it. */
static facet_result copy_text(const merging *m, const file_bytes *file, const char *name, film *target,
                              facet_error *error)
{
    size_t size = 256;
    facet_result result;
    do {
        char *value = mem_alloc(&m->desc->allocator, size *= 4, 1);
        if (!value)
            return fail_memory(error, "metadata", size);
        result = image_read_exr_text(file->data, file->size, m->parts[0].path, name, value, size, error);
        facet_result added =
            result == FACET_OK ? film_add_text(target, name, value, &m->desc->allocator, error) : FACET_OK;
        mem_free(value);
        TRY(added);
    } while (result != FACET_OK && size < file->size && size < MAX_TEXT);
    return result;
}

static facet_result copy_texts(const merging *m, film *target, facet_error *error)
{
    static const uint32_t aovs[MATTE_KINDS] = {FACET_AOV_CRYPTO_OBJECT, FACET_AOV_CRYPTO_MATERIAL,
                                               FACET_AOV_CRYPTO_INSTANCE};
    file_bytes file;
    facet_result result = part_open(m->parts[0].path, &m->desc->allocator, &file, error);
    for (uint32_t kind = 0; kind < MATTE_KINDS && result == FACET_OK; kind++)
        for (uint32_t i = 0; m->parts[0].header.aovs & aovs[kind] && i < MATTE_TEXTS && result == FACET_OK;
             i++) {
            char name[MATTE_TEXT_NAME_SIZE];
            matte_text_name(kind, i, name);
            result = copy_text(m, &file, name, target, error);
        }
    file_close(&file);
    return result;
}

/* ---- the image ---- */

/* The part of a desc that finishing reads. */
static facet_render_desc finishing_of(const merging *m)
{
    const part_header *h = &m->parts[0].header;
    facet_render_desc d = {.allocator = m->desc->allocator,
                           .thread_count = m->desc->thread_count,
                           .exposure_ev = h->exposure_ev,
                           .tonemap = m->desc->has_tonemap ? m->desc->tonemap : h->info.tonemap,
                           .background = h->background,
                           .shading = h->shading};
    d.path.denoises = h->denoises;
    d.ogl1.is_linear = h->is_ogl1_linear;
    memcpy(d.background_color, h->background_color, sizeof d.background_color);
    return d;
}

static facet_result merge(merging *m, const char *const *paths, size_t path_count, film *target,
                          facet_render_stats *stats, facet_error *error)
{
    TRY(find_parts(m, paths, path_count, error));
    const facet_render_desc finishing = finishing_of(m);
    const part_header *h = &m->parts[0].header;
    TRY(film_create(&m->desc->allocator, h->info.width, h->info.height, h->aovs, target, error));
    TRY(read_parts(m, &finishing, target, stats, error));
    TRY(copy_texts(m, target, error));
    film_develop(target, &finishing);
    return FACET_OK;
}

facet_result part_merge(const char *const *paths, size_t path_count, const facet_merge_desc *desc, film *out,
                        facet_render_stats *stats, facet_error *error)
{
    merging m = {.desc = desc};
    *out = (film){.width = 0};
    facet_result result = merge(&m, paths, path_count, out, stats, error);
    path_film_destroy(m.one);
    path_film_destroy(m.sums);
    mem_free(m.parts);
    if (result != FACET_OK)
        film_destroy(out);
    return result;
}
