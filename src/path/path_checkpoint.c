/* path_checkpoint.c - see path_checkpoint.h. The sums of a film are words of 32 bits, and each of them is a channel of an
 * OpenEXR file, so nothing is converted; the image is there for viewers. Attributes are texts: the file's kind, the key of its image, and a digest
 * of its values, since stored channels have no checksums. */
#include "path/path_checkpoint.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/result.h"
#include "ibl/cache.h"
#include "film/film_channels.h"
#include "path/path_film_state.h"

/* ---- the file ---- */

static const char VERSION[] = "3";
enum { KEY_SIZE = 65, DIGEST_SIZE = 17, COUNT_SIZE = 21, VERSION_SIZE = 16 };

/* Lists the channels of a film in memory; returns their number. */
static uint32_t list_channels(const path_film *f, image_channel channels[PATH_FILM_MAX_CHANNELS])
{
    film_layer layers[PATH_FILM_LAYERS];
    uint32_t count = 0, layer_count = path_film_list_layers(f, layers);
    for (uint32_t i = 0; i < layer_count; i++)
        count += film_layer_list_channels(&layers[i], f->width, channels + count);
    return count;
}

static uint64_t digest_of(const path_film *f, const char *key, uint64_t dropped)
{
    size_t count = (size_t)f->width * f->height;
    uint64_t hash = cache_hash(dropped, key, strlen(key));
    hash = cache_hash(hash, f->pixels, count * sizeof *f->pixels);
    return f->ground ? cache_hash(hash, f->ground, count * sizeof *f->ground) : hash;
}

/* ---- the path of the file ---- */

/* Refuses what is neither file nor folder: a pipe may never be read, nor written. */
static facet_result check_place(const char *path, bool *exists, facet_error *error)
{
    struct stat info;
    *exists = stat(path, &info) == 0;
    if (*exists && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode))
        return fail(error, FACET_ERROR_WRITE, "%s: is not a regular file, as a checkpoint has to be", path);
    return FACET_OK;
}

/* ---- writing ---- */

facet_result path_film_save(const path_film *f, const char *key, const char *path, uint32_t thread_count,
                            facet_error *error)
{
    char digest[DIGEST_SIZE], dropped[COUNT_SIZE];
    snprintf(digest, sizeof digest, "%016" PRIx64, digest_of(f, key, path_film_dropped(f)));
    snprintf(dropped, sizeof dropped, "%" PRIu64, path_film_dropped(f));
    const image_text texts[] = {
        {"facetCheckpoint", VERSION}, {"facetKey", key}, {"facetDropped", dropped}, {"facetDigest", digest}};
    film_layer layers[PATH_FILM_LAYERS];
    image_layer encoded[PATH_FILM_LAYERS + 1];
    film seen; /* for viewers */
    TRY(film_create(&f->allocator, f->width, f->height, 0, &seen, error));
    path_film_resolve(f, 1.0f, &seen, thread_count);
    uint32_t layer_count = path_film_list_layers(f, layers);
    for (uint32_t i = 0; i < layer_count; i++)
        encoded[i] = film_layer_to_image(&layers[i], f->width);
    encoded[layer_count++] = film_layer_to_image(&seen.layers[0], f->width);
    const image_encode_desc desc = {.allocator = f->allocator,
                                    .thread_count = thread_count,
                                    .is_stored = true,
                                    .texts = texts,
                                    .text_count = sizeof texts / sizeof *texts};
    unsigned char *bytes;
    size_t size;
    facet_result result =
        image_encode_exr(f->width, f->height, encoded, layer_count, false, &desc, &bytes, &size, error);
    film_destroy(&seen);
    if (result == FACET_OK)
        result = file_write(path, bytes, size, error);
    mem_free(bytes);
    return result;
}

/* ---- reading ---- */

typedef struct checkpoint {
    const char *path;
    file_bytes file;
} checkpoint;

static facet_result read_text(const checkpoint *c, const char *name, char *value, size_t size,
                              facet_error *error)
{
    return image_read_exr_text(c->file.data, c->file.size, c->path, name, value, size, error);
}

/* Whether the file is a checkpoint at all. The codec reports a damaged OpenEXR file. */
static facet_result check_kind(const checkpoint *c, facet_error *error)
{
    char version[VERSION_SIZE] = "";
    image header;
    if (image_codec_detect(c->file.data, c->file.size) != IMAGE_CODEC_EXR)
        return fail(error, FACET_ERROR_INVALID, "%s: not a checkpoint: an OpenEXR file was expected",
                    c->path);
    TRY(image_probe(c->file.data, c->file.size, c->path, &header, NULL, error));
    if (read_text(c, "facetCheckpoint", version, sizeof version, NULL) != FACET_OK)
        return fail(error, FACET_ERROR_INVALID, "%s: is an OpenEXR image, but not a checkpoint", c->path);
    if (strcmp(version, VERSION) != 0)
        return fail(error, FACET_ERROR_INVALID,
                    "%s: is a checkpoint of version %s; this build of facet resumes version %s", c->path,
                    version, VERSION);
    return FACET_OK;
}

/* Whether it is one of this image. */
static facet_result check_image(const checkpoint *c, const path_film *f, const char *key, facet_error *error)
{
    char found[KEY_SIZE] = "";
    image header;
    TRY(image_probe(c->file.data, c->file.size, c->path, &header, NULL, error));
    TRY(read_text(c, "facetKey", found, sizeof found, error));
    if (header.width != f->width || header.height != f->height)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "%s: is the checkpoint of an image of %u x %u pixels, not %u x %u", c->path, header.width,
                    header.height, f->width, f->height);
    if (strcmp(found, key) != 0)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "%s: is the checkpoint of another image: model, view, light and sampling options have to "
                    "be the same",
                    c->path);
    return FACET_OK;
}

static facet_result read_values(const checkpoint *c, path_film *into, const char *key, facet_error *error)
{
    image_channel channels[PATH_FILM_MAX_CHANNELS];
    uint32_t count = list_channels(into, channels);
    char digest[DIGEST_SIZE] = "", dropped[COUNT_SIZE] = "", expected[DIGEST_SIZE];
    TRY(read_text(c, "facetDigest", digest, sizeof digest, error));
    TRY(read_text(c, "facetDropped", dropped, sizeof dropped, error));
    TRY(image_read_exr_channels(c->file.data, c->file.size, c->path, &into->allocator, into->width,
                                into->height, channels, count, error));
    uint64_t dropped_count = strtoull(dropped, NULL, 10);
    snprintf(expected, sizeof expected, "%016" PRIx64, digest_of(into, key, dropped_count));
    if (strcmp(digest, expected) != 0 || !path_film_is_sound(into))
        return fail(error, FACET_ERROR_INVALID,
                    "%s: the checkpoint is damaged: its values differ from those that were written", c->path);
    path_film_set_dropped(into, dropped_count);
    return FACET_OK;
}

/* Reads into a film of its own first, so that f is unchanged on failure. */
static facet_result read_film(const checkpoint *c, path_film *f, const char *key, facet_error *error)
{
    path_film *made;
    facet_result result =
        path_film_create(&f->allocator, f->width, f->height, f->ground != NULL, &made, error);
    if (result == FACET_OK)
        result = read_values(c, made, key, error);
    if (result == FACET_OK) {
        path_pixel *pixels = f->pixels;
        path_ground *ground = f->ground;
        f->pixels = made->pixels;
        f->ground = made->ground;
        made->pixels = pixels;
        made->ground = ground;
        atomic_store(&f->dropped, atomic_load(&made->dropped));
    }
    path_film_destroy(made);
    return result;
}

facet_result path_film_load(path_film *f, const char *key, const char *path, bool *exists, facet_error *error)
{
    checkpoint c = {.path = path};
    facet_result result = check_place(path, exists, error);
    if (result != FACET_OK || !*exists)
        return result;
    result = file_open(path, 0, &f->allocator, &c.file, error);
    if (result == FACET_OK)
        result = check_kind(&c, error);
    if (result == FACET_OK)
        result = check_image(&c, f, key, error);
    if (result == FACET_OK)
        result = read_film(&c, f, key, error);
    file_close(&c.file);
    return result;
}

facet_result path_checkpoint_check(const char *path, facet_error *error)
{
    bool exists;
    TRY(check_place(path, &exists, error));
    if (exists)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "%s: the checkpoint exists and would be lost; resume it, remove it, or name another file",
                    path);
    return FACET_OK;
}
