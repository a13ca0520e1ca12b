/* video.h - frames in one file or pipe, for video encoders: YUV4MPEG2, or raw RGBA. */
#ifndef CLI_VIDEO_H
#define CLI_VIDEO_H

#include "facet/facet.h"

typedef enum video_format {
    VIDEO_NONE,
    VIDEO_Y4M, /* 4:4:4, limited range; BT.709 from 1280 x 720 pixels on, BT.601 below, as players assume */
    VIDEO_RAW  /* RGBA, 8 bits, sRGB, straight alpha */
} video_format;

/* An open video. */
typedef struct video video;

/* Opens path ("-": standard output); a file appears under its name with video_close(). Fails with
 * FACET_ERROR_WRITE. */
facet_result video_open(const char *path, video_format format, double fps, video **out, facet_error *error);
/* Adds a frame; all frames have the same size. */
facet_result video_add(video *v, const facet_image *image, const facet_allocator *allocator,
                       uint32_t thread_count, facet_error *error);
/* Completes the file, or removes it without keep. Releases v in any case; NULL is allowed. */
facet_result video_close(video *v, bool keep, facet_error *error);

#endif
