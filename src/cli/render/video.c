/* video.c - see video.h. */
#define _POSIX_C_SOURCE 200809L
#include "cli/render/video.h"

#include "cli/shared/failure.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/output.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct video {
    FILE *file;
    video_format format;
    double fps;
    uint32_t width, height; /* 0: no frame yet */
    unsigned char *planes;  /* Y, Cb, Cr of one frame */
    char *path, *temporary; /* NULL: a stream, which is written directly */
};

static facet_result fail_write(const video *v, facet_error *error)
{
    return fail(error, FACET_ERROR_WRITE, "%s: cannot be written: %s", v->path ? v->path : "stdout",
                errno ? strerror(errno) : "it is closed");
}

/* Creates a temporary file beside path, with the mode of a new file. */
static FILE *open_beside(video *v)
{
    enum { MAX_NAME = 240 }; /* of the 255 bytes of a name */
    const char *slash = strrchr(v->path, '/');
    const char *base = slash ? slash + 1 : v->path;
    size_t size = strlen(v->path) + 16;
    v->temporary = malloc(size);
    if (!v->temporary)
        return NULL;
    interrupt_file_begin();
    snprintf(v->temporary, size, "%.*s%.*s.XXXXXX", (int)(base - v->path), v->path, MAX_NAME, base);
    int fd = mkstemp(v->temporary);
    if (fd < 0)
        return NULL;
    mode_t mask = umask(0);
    umask(mask);
    FILE *file = fchmod(fd, 0666 & ~mask) == 0 ? fdopen(fd, "wb") : NULL;
    if (!file) {
        close(fd);
        unlink(v->temporary);
    }
    return file;
}

static FILE *open_output(video *v)
{
    struct stat info;
    if (strcmp(v->path, "-") == 0) {
        free(v->path);
        v->path = NULL;
        return stdout;
    }
    if (stat(v->path, &info) == 0 && !S_ISREG(info.st_mode))
        return fopen(v->path, "wb");
    return open_beside(v);
}

facet_result video_open(const char *path, video_format format, double fps, video **out, facet_error *error)
{
    *out = NULL;
    if (output_make_folders(path, error) != FACET_OK)
        return FACET_ERROR_WRITE;
    video *v = calloc(1, sizeof *v);
    if (v)
        v->path = malloc(strlen(path) + 1);
    if (!v || !v->path) {
        free(v);
        return fail(error, FACET_ERROR_MEMORY, "out of memory: %s", path);
    }
    memcpy(v->path, path, strlen(path) + 1);
    v->format = format;
    v->fps = fps;
    errno = 0;
    v->file = open_output(v);
    if (!v->file) {
        facet_result result = fail_write(v, error);
        if (v->temporary)
            interrupt_file_end();
        free(v->temporary);
        free(v->path);
        free(v);
        return result;
    }
    *out = v;
    return FACET_OK;
}

/* ---- Y'CbCr ---- */

/* Rec. ITU-R BT.601 and BT.709, 8 bits, limited range: Y = 16 + 219 Y', C = 128 + 224 C'. */
static void convert(const video *v, const unsigned char *rgba)
{
    bool is_high = v->width >= 1280 || v->height >= 720;
    const float kr = is_high ? 0.2126f : 0.299f, kb = is_high ? 0.0722f : 0.114f;
    size_t count = (size_t)v->width * v->height;
    unsigned char *y = v->planes, *cb = y + count, *cr = cb + count;
    for (size_t i = 0; i < count; i++, rgba += 4) {
        float a = (float)rgba[3] / 255.0f; /* over white, as in JPEG files */
        float r = 1.0f + a * ((float)rgba[0] / 255.0f - 1.0f);
        float g = 1.0f + a * ((float)rgba[1] / 255.0f - 1.0f);
        float b = 1.0f + a * ((float)rgba[2] / 255.0f - 1.0f);
        float luma = kr * r + (1.0f - kr - kb) * g + kb * b;
        y[i] = (unsigned char)(16.5f + 219.0f * luma);
        cb[i] = (unsigned char)(128.5f + 224.0f * 0.5f * (b - luma) / (1.0f - kb));
        cr[i] = (unsigned char)(128.5f + 224.0f * 0.5f * (r - luma) / (1.0f - kr));
    }
}

/* Frame rate as a ratio: 24 is 24:1, 29.97 is 2997:100. */
static void begin_y4m(video *v)
{
    unsigned long denominator = 1;
    while (denominator < 1000 &&
           fabs(v->fps * (double)denominator - rint(v->fps * (double)denominator)) > 1e-9)
        denominator *= 10;
    fprintf(v->file, "YUV4MPEG2 W%u H%u F%lu:%lu Ip A1:1 C444 XCOLORRANGE=LIMITED\n", v->width, v->height,
            (unsigned long)rint(v->fps * (double)denominator), denominator);
}

static facet_result begin(video *v, uint32_t width, uint32_t height, facet_error *error)
{
    if (v->width)
        return v->width == width && v->height == height
                   ? FACET_OK
                   : fail(error, FACET_ERROR_ARGUMENT, "--output: the frames of a video must have one size");
    v->width = width;
    v->height = height;
    if (v->format != VIDEO_Y4M)
        return FACET_OK;
    v->planes = malloc(3 * (size_t)width * height);
    if (!v->planes)
        return fail(error, FACET_ERROR_MEMORY, "out of memory: video frame");
    begin_y4m(v);
    return FACET_OK;
}

facet_result video_add(video *v, const facet_image *image, const facet_allocator *allocator,
                       uint32_t thread_count, facet_error *error)
{
    facet_image_view view = facet_image_get_layer(image, 0);
    const facet_image_save_desc desc = {
        .allocator = *allocator, .thread_count = thread_count, .format = FACET_IMAGE_FORMAT_RAW};
    unsigned char *bytes = NULL;
    size_t size;
    facet_result result = begin(v, view.width, view.height, error);
    if (result == FACET_OK)
        result = facet_image_encode(image, &desc, &bytes, &size, error);
    if (result != FACET_OK)
        return result;
    errno = 0;
    if (!v->temporary) /* a pipe may never get a reader */
        interrupt_begin("facet", "writing", false);
    bool is_written;
    if (v->format == VIDEO_Y4M) {
        convert(v, bytes);
        is_written = fputs("FRAME\n", v->file) >= 0 && fwrite(v->planes, size / 4 * 3, 1, v->file) == 1;
    } else {
        is_written = fwrite(bytes, size, 1, v->file) == 1;
    }
    is_written = is_written && fflush(v->file) == 0;
    interrupt_end();
    facet_bytes_destroy(bytes);
    return is_written ? FACET_OK : fail_write(v, error);
}

facet_result video_close(video *v, bool keep, facet_error *error)
{
    if (!v)
        return FACET_OK;
    facet_result result = FACET_OK;
    errno = 0;
    bool is_written = fflush(v->file) == 0 && (!v->temporary || fsync(fileno(v->file)) == 0);
    if (v->file != stdout)
        is_written = fclose(v->file) == 0 && is_written;
    if (v->temporary && keep && is_written)
        is_written = rename(v->temporary, v->path) == 0;
    if (v->temporary && (!keep || !is_written))
        unlink(v->temporary);
    if (v->temporary)
        interrupt_file_end();
    if (keep && !is_written)
        result = fail_write(v, error);
    free(v->temporary);
    free(v->path);
    free(v->planes);
    free(v);
    return result;
}
