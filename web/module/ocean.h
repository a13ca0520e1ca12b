/* ocean.h - the one sea of the ocean page, for the files behind ocean.wasm: its options in ocean.c, what follows from them
 * in ocean_sea.c, images in ocean_draw.c, the camera in ocean_camera.c. */
#ifndef WEB_OCEAN_H
#define WEB_OCEAN_H

#include "base/text.h"
#include "gl/core/gl_context.h"
#include "gl/sea/gl_sea.h"
#include "ocean/sea.h"
#include "ocean_settings.h"
#include "render/renderer.h"
#include "water/water_frame.h"

/* One of the two images that a divider separates; alone it is OCEAN_NOW. */
typedef struct ocean_side {
    facet_render_desc desc;
    facet_camera camera;
    water_frame *frame; /* of desc; NULL: not prepared */
    gl_target mean;     /* of the samples drawn so far */
} ocean_side;

enum { OCEAN_BEFORE, OCEAN_NOW, OCEAN_SIDES };

typedef struct ocean_page {
    gl_context context;
    gl_sea *renderer;
    ocean_settings settings;
    facet_sea_desc sea_desc; /* of settings.run.sea */
    water_cache cache;
    double time_s, ev100;
    uint32_t metered_width, metered_height; /* of the view whose ev100 that is; 0: of none */
    ocean_side sides[OCEAN_SIDES];
    uint32_t passes; /* samples in the last image */
    int side;        /* of the next sample, that is being drawn, */
    uint32_t row;    /* and its rows that are drawn */
    facet_error error;
    char message[512]; /* the last warning */
} ocean_page;

extern ocean_page ocean;

/* Frames refer to the sea, and to the light in the cache. */
void ocean_forget_frames(void);

/* As what the page calls, for the camera. text NULL: the default again. */
int ocean_set_option(const char *name, const char *text);

/* The text for the page, which frees it; NULL, with an error in ocean.error: out of memory. */
char *ocean_finish_text(text *t);

/* The sea of the options, without its state at a time. */
facet_result ocean_update_sea(facet_error *error);

/* What an image of that size needs: the sea at its time, and the exposure. is_moving: nearly the same proportions keep
 * the exposure. */
facet_result ocean_prepare(uint32_t width, uint32_t height, bool is_moving, facet_error *error);

/* The desc of a side's image, resolved. */
facet_result ocean_describe_side(ocean_side *side, const ocean_half *half, uint32_t width, uint32_t height,
                                 facet_error *error);

#endif
