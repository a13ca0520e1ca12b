/* video.h - pictures one after the other in one file or pipe, for programs that make videos: YUV4MPEG2, or bare RGBA. */
#ifndef CLI_VIDEO_H
#define CLI_VIDEO_H

#include "facet/facet.h"

typedef enum video_format {
    VIDEO_NONE,
    VIDEO_Y4M, /* 4:4:4, limited range; BT.709 from 1280 x 720 pixels on, BT.601 below, as players take it */
    VIDEO_RAW  /* RGBA, 8 bits, sRGB, straight alpha */
} video_format;

/* Where frames go. */
typedef struct video video;

/* Opens path ("-": standard output); a file appears under its name with video_close(). Fails with FACET_ERROR_WRITE. */
facet_result video_open(const char *path, video_format format, double fps, video **out, facet_error *error);
/* All frames must have one size. */
facet_result video_add(video *v, const facet_image *image, const facet_allocator *allocator,
                       uint32_t thread_count, facet_error *error);
/* keep false: a file is removed. Releases v in every case; NULL is allowed. */
facet_result video_close(video *v, bool keep, facet_error *error);

#endif
