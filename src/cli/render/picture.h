/* picture.h - thumbnails of images: HDR, OpenEXR, KTX2 and other formats, and cube maps as panoramas. */
#ifndef CLI_PICTURE_H
#define CLI_PICTURE_H

#include "cli/render/render_options.h"

/* Loads path, an image or a cube map, as a thumbnail of the size of o. Fails as facet_image_load(). */
facet_result picture_load(const char *path, const render_options *o, const facet_allocator *allocator,
                          facet_image **image, facet_error *error);

#endif
