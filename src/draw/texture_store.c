/* texture_store.c - see texture_store.h. */
#include "draw/texture_store.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

/* An image as decoded with one reduction. */
typedef struct stored_image {
    uint32_t reduction;    /* what the decoder was allowed */
    uint32_t source_level; /* what it used: less, where it does not support more */
    texture_pyramid pyramids[2];
    struct stored_image *next;
} stored_image;

typedef struct image_record {
    image header; /* of the whole image; width 0: not read yet */
    image_codec codec;
    bool has_failed;
    stored_image *stored;
} image_record;

struct texture_store {
    const facet_scene *scene;
    facet_allocator allocator;
    image_record *records; /* per image of the scene */
    uint32_t record_count; /* the scene may have been given more images since */
    texture_tables *tables;
    bool has_tables;
};

/* An image to be decoded. */
typedef struct job {
    texture_want *want;
    stored_image *made; /* NULL: it failed */
    uint64_t texel_count, decoded_texels;
    image_note note; /* of an image that was decoded */
    facet_result result;
    facet_error error;
} job;

typedef struct batch {
    texture_store *store;
    job *jobs;
} batch;

facet_result texture_store_create(const facet_scene *scene, const facet_allocator *allocator,
                                  texture_store **out, facet_error *error)
{
    texture_store *store = mem_zalloc(allocator, 1, sizeof *store);
    *out = store;
    if (!store)
        return fail_memory(error, "textures", sizeof *store);
    store->scene = scene;
    store->record_count = scene->image_count;
    store->allocator = allocator ? *allocator : (facet_allocator){0};
    store->records = mem_zalloc(allocator, scene->image_count, sizeof *store->records);
    store->tables = mem_alloc(allocator, 1, sizeof *store->tables);
    if (store->records && store->tables)
        return FACET_OK;
    texture_store_destroy(store);
    *out = NULL;
    return fail_memory(error, "textures", sizeof *store->tables);
}

static void destroy_stored(stored_image *s)
{
    if (!s)
        return;
    texture_pyramid_destroy(&s->pyramids[0]);
    texture_pyramid_destroy(&s->pyramids[1]);
    mem_free(s);
}

void texture_store_destroy(texture_store *store)
{
    if (!store)
        return;
    for (uint32_t i = 0; store->records && i < store->record_count; i++)
        while (store->records[i].stored) {
            stored_image *next = store->records[i].stored->next;
            destroy_stored(store->records[i].stored);
            store->records[i].stored = next;
        }
    mem_free(store->records);
    mem_free(store->tables);
    mem_free(store);
}

/* ---- decoding one image ---- */

static void name_image(const facet_scene *scene, uint32_t index, char *text, size_t size)
{
    const char *name = scene->images[index].name;
    const scene_address at = scene_get_address(scene, SCENE_ITEM_IMAGE, index);
    if (name && name[0])
        snprintf(text, size, "%s: image %u \"%s\"", at.source, at.number, name);
    else
        snprintf(text, size, "%s: image %u", at.source, at.number);
}

/* The reduction that the decoder chose: full and decoded sizes differ by a power of two. False: they do not. */
static bool find_reduction(const image *header, const image *decoded, uint32_t *reduction)
{
    for (uint32_t r = 0; r < TEXTURE_MAX_LEVELS; r++)
        if (header->width >> r == decoded->width && header->height >> r == decoded->height) {
            *reduction = r;
            return true;
        }
    return false;
}

/* The largest reduction up to wanted that divides both sizes: only then the reduced image covers the same
 * area as the full one, with texels aligned to those of the mips. */
static uint32_t get_exact_reduction(const image_record *record, uint32_t wanted)
{
    uint32_t edges = record->header.width | record->header.height;
    uint32_t r = 0;
    switch (record->codec) {
    case IMAGE_CODEC_PNG:
    case IMAGE_CODEC_WEBP:
    case IMAGE_CODEC_TGA:
    case IMAGE_CODEC_BMP:
    case IMAGE_CODEC_GIF:
    case IMAGE_CODEC_DDS: /* decoded as a whole */
        return 0;
    default:
        break;
    }
    while (r < wanted && r < TEXTURE_MAX_LEVELS - 1 && (edges & ((2u << r) - 1)) == 0)
        r++;
    return r;
}

static facet_result copy_image(const image *in, const facet_allocator *allocator, image *out,
                               facet_error *error)
{
    TRY(image_create(allocator, in->width, in->height, in->channel_count, in->type, out, error));
    out->is_srgb = in->is_srgb;
    memcpy(out->pixels, in->pixels, image_row_size(in) * in->height);
    return FACET_OK;
}

/* Pyramids that grow while their image is decoded. */
typedef struct row_growth {
    const texture_store *store;
    bool is_read[2];
    uint32_t first_level;
    stored_image *made;
    texture_growth *growths[2]; /* NULL: not read that way */
} row_growth;

static facet_result begin_rows(void *user, const image *header, facet_error *error)
{
    row_growth *r = user;
    facet_result result = FACET_OK;
    for (int as_color = 0; as_color < 2 && result == FACET_OK; as_color++)
        if (r->is_read[as_color])
            result = texture_growth_create(header, r->first_level, as_color, r->store->tables,
                                           &r->store->allocator, &r->made->pyramids[as_color],
                                           &r->growths[as_color], error);
    return result;
}

static facet_result add_row(void *user, const void *texels, facet_error *error)
{
    row_growth *r = user;
    (void)error;
    for (int as_color = 0; as_color < 2; as_color++)
        if (r->growths[as_color])
            texture_growth_add_row(r->growths[as_color], texels);
    return FACET_OK;
}

static facet_result decode(const texture_store *store, job *j, const char *name, uint32_t reduction,
                           const image_row_sink *sink, image *out)
{
    const scene_image *i = &store->scene->images[j->want->image];
    const image_record *record = &store->records[j->want->image];
    image_decode_desc desc = {.allocator = store->allocator,
                              .thread_count = 1,
                              .max_size = store->scene->max_texture_size,
                              .max_reduction = reduction,
                              .note = &j->note,
                              .sink = sink};
    facet_result result = image_decode(i->bytes, i->size, name, &desc, out, &j->error);
    if (result != FACET_OK)
        return result;
    j->decoded_texels = (uint64_t)out->width * out->height;
    if (out->type == IMAGE_U8 || out->type == IMAGE_U16)
        return FACET_OK;
    if (record->codec != IMAGE_CODEC_KTX2)
        return fail(&j->error, FACET_ERROR_UNSUPPORTED,
                    "%s: expected an image of 8 or 16 bits per channel, this is %s", name,
                    image_codec_name(record->codec));
    /* Floats, which glTF does not have: in [0, 1], coded as their readers expect. */
    image codes;
    result = image_convert(out, &store->allocator, 1, out->channel_count, IMAGE_U16, !j->want->is_read[0],
                           &codes, &j->error);
    image_destroy(out);
    *out = codes;
    return result;
}

/* Pyramids from first_level on of the ways of reading that is_read asks for. */
static facet_result build(const texture_store *store, job *j, const bool is_read[2], uint32_t first_level,
                          const image *header, image *decoded, stored_image *out)
{
    image copy = {0};
    facet_result result = FACET_OK;
    if (is_read[0] && is_read[1])
        result = copy_image(decoded, &store->allocator, &copy, &j->error);
    for (int as_color = 0; as_color < 2 && result == FACET_OK; as_color++)
        if (is_read[as_color])
            result = texture_pyramid_create(copy.pixels ? &copy : decoded, out->source_level, header->width,
                                            header->height, first_level, as_color, store->tables,
                                            &store->allocator, &out->pyramids[as_color], &j->error);
    image_destroy(&copy);
    return result;
}

/* What is stored under that reduction; NULL: nothing. A decoder that used less than it was allowed does
 * not use more when allowed more. */
static stored_image *find_stored(const image_record *record, uint32_t reduction)
{
    for (stored_image *s = record->stored; s; s = s->next)
        if (s->reduction == reduction || (s->source_level < s->reduction && reduction >= s->source_level))
            return s;
    return NULL;
}

static bool has_all(const stored_image *s, const texture_want *want)
{
    for (int as_color = 0; as_color < 2; as_color++)
        if (want->is_read[as_color] &&
            (s->pyramids[as_color].level_count == 0 || s->pyramids[as_color].first_level > want->first_level))
            return false;
    return true;
}

/* Makes what want asks for, and what is stored of the image already, which it replaces. */
static void run_job(const texture_store *store, job *j)
{
    if (j->result != FACET_OK)
        return;
    const image_record *record = &store->records[j->want->image];
    char name[512];
    name_image(store->scene, j->want->image, name, sizeof name);
    image decoded = {0};
    uint32_t first_level = j->want->first_level;
    bool is_read[2] = {j->want->is_read[0], j->want->is_read[1]};
    uint32_t reduction = get_exact_reduction(record, first_level);
    const stored_image *old = find_stored(record, reduction);
    for (int as_color = 0; old && as_color < 2; as_color++)
        if (old->pyramids[as_color].level_count) {
            is_read[as_color] = true;
            if (old->pyramids[as_color].first_level < first_level)
                first_level = old->pyramids[as_color].first_level;
        }
    stored_image *made = mem_zalloc(&store->allocator, 1, sizeof *made);
    if (!made) {
        j->result = fail_memory(&j->error, "textures", sizeof *made);
        return;
    }
    made->reduction = reduction;
    row_growth rows = {
        .store = store, .is_read = {is_read[0], is_read[1]}, .first_level = first_level, .made = made};
    const image_row_sink sink = {.user = &rows, .begin = begin_rows, .add_row = add_row};
    j->result = decode(store, j, name, reduction, first_level > 0 ? &sink : NULL, &decoded);
    if (j->result == FACET_OK && !find_reduction(&record->header, &decoded, &made->source_level))
        j->result = fail(&j->error, FACET_ERROR_INVALID, "%s: expected %u x %u texels, decoded %u x %u", name,
                         record->header.width, record->header.height, decoded.width, decoded.height);
    if (j->result == FACET_OK && decoded.pixels)
        j->result = build(store, j, is_read, first_level, &record->header, &decoded, made);
    image_destroy(&decoded);
    texture_growth_destroy(rows.growths[0]);
    texture_growth_destroy(rows.growths[1]);
    if (j->result == FACET_OK)
        j->made = made;
    else
        destroy_stored(made);
}

static void run_jobs(void *context, size_t begin, size_t end)
{
    batch *b = context;
    for (size_t i = begin; i < end; i++)
        run_job(b->store, &b->jobs[i]);
}

/* ---- all images ---- */

static int compare_jobs(const void *a, const void *b) /* the largest first, so that it does not finish last */
{
    const job *first = a;
    const job *second = b;
    if (first->texel_count != second->texel_count)
        return first->texel_count > second->texel_count ? -1 : 1;
    return first->want->image < second->want->image ? -1 : 1;
}

static int compare_images(const void *a, const void *b)
{
    return ((const job *)a)->want->image < ((const job *)b)->want->image ? -1 : 1;
}

/* Reads the header if not done yet; writes want->first_level. */
static facet_result read_header(texture_store *store, texture_want *want, facet_error *error)
{
    image_record *record = &store->records[want->image];
    if (record->header.width == 0) {
        const scene_image *i = &store->scene->images[want->image];
        char name[512];
        name_image(store->scene, want->image, name, sizeof name);
        facet_result result = image_probe(i->bytes, i->size, name, &record->header, &record->codec, error);
        if (result != FACET_OK) {
            record->header = (image){0};
            return result;
        }
    }
    uint32_t last_level = texture_level_count(record->header.width, record->header.height) - 1;
    want->first_level = want->min_lod >= (float)last_level ? last_level
                        : want->min_lod > 0.0f             ? (uint32_t)want->min_lod
                                                           : 0;
    return FACET_OK;
}

/* One job for each want that nothing stored answers. */
static size_t collect_jobs(texture_store *store, texture_want *wants, size_t count, job *jobs)
{
    size_t job_count = 0;
    for (size_t i = 0; i < count; i++) {
        texture_want *want = &wants[i];
        const image_record *record = &store->records[want->image];
        if (record->has_failed)
            continue;
        job j = {.want = want};
        j.result = read_header(store, want, &j.error);
        if (j.result == FACET_OK) {
            const stored_image *s = find_stored(record, get_exact_reduction(record, want->first_level));
            if (s && has_all(s, want))
                continue;
            j.texel_count = (uint64_t)record->header.width * record->header.height;
        }
        jobs[job_count++] = j;
    }
    return job_count;
}

/* Replaces what a new image contains by it. */
static void keep(image_record *record, stored_image *made)
{
    stored_image **place = &record->stored;
    while (*place && (*place)->source_level != made->source_level)
        place = &(*place)->next;
    stored_image *old = *place;
    made->next = old ? old->next : NULL;
    if (old && old->reduction > made->reduction) /* what is known of the decoder is kept */
        made->reduction = old->reduction;
    *place = made;
    destroy_stored(old);
}

/* Reports the notes of images, and warns of those that cannot be decoded; fails for errors of the machine
 * rather than of the image. */
static facet_result report_jobs(texture_store *store, const job *jobs, size_t count, const facet_log *log,
                                facet_error *error)
{
    for (size_t i = 0; i < count; i++)
        if (jobs[i].result == FACET_ERROR_LIMIT || jobs[i].result == FACET_ERROR_MEMORY) {
            if (error)
                *error = jobs[i].error;
            return jobs[i].result;
        }
    for (size_t i = 0; i < count; i++)
        if (jobs[i].result != FACET_OK) {
            store->records[jobs[i].want->image].has_failed = true;
            log_warning(log, "%s; it reads as white", jobs[i].error.message);
        } else if (jobs[i].note.text[0]) {
            char name[256];
            name_image(store->scene, jobs[i].want->image, name, sizeof name);
            image_note_log(&jobs[i].note, name, log);
        }
    return FACET_OK;
}

size_t texture_wants_compact(texture_want *wants, size_t image_count)
{
    size_t count = 0;
    for (size_t i = 0; i < image_count; i++)
        if (wants[i].is_read[0] || wants[i].is_read[1]) {
            wants[count] = wants[i];
            wants[count++].image = (uint32_t)i;
        }
    return count;
}

facet_result texture_store_get(texture_store *store, texture_want *wants, size_t count, const facet_log *log,
                               uint32_t thread_count, uint64_t *decoded_texels, facet_error *error)
{
    job *jobs = mem_zalloc(&store->allocator, count, sizeof *jobs);
    if (!jobs)
        return fail_memory(error, "textures", count * sizeof *jobs);
    size_t job_count = collect_jobs(store, wants, count, jobs);
    if (job_count && !store->has_tables)
        texture_tables_fill(store->tables);
    store->has_tables = store->has_tables || job_count;
    qsort(jobs, job_count, sizeof *jobs, compare_jobs);
    batch b = {.store = store, .jobs = jobs};
    parallel_for(thread_count, job_count, 1, run_jobs, &b);
    qsort(jobs, job_count, sizeof *jobs, compare_images);
    for (size_t i = 0; i < job_count; i++) {
        *decoded_texels += jobs[i].decoded_texels;
        if (jobs[i].made)
            keep(&store->records[jobs[i].want->image], jobs[i].made);
    }
    facet_result result = report_jobs(store, jobs, job_count, log, error);
    mem_free(jobs);
    for (size_t i = 0; i < count && result == FACET_OK; i++) {
        const image_record *record = &store->records[wants[i].image];
        const stored_image *s = NULL;
        if (!record->has_failed)
            s = find_stored(record, get_exact_reduction(record, wants[i].first_level));
        for (int as_color = 0; as_color < 2; as_color++)
            wants[i].pyramid[as_color] = s && wants[i].is_read[as_color] ? &s->pyramids[as_color] : NULL;
    }
    return result;
}
