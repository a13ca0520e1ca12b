/* model_needs.h - the decoders that a file needs beyond those in every build: pages fetch them one by one. */
#ifndef IO_MODEL_NEEDS_H
#define IO_MODEL_NEEDS_H

#include "scene/scene.h"

typedef enum model_need {
    MODEL_NEED_DRACO = 1 << 0,
    MODEL_NEED_WEBP = 1 << 1,
    MODEL_NEED_AVIF = 1 << 2,
    MODEL_NEED_EXR = 1 << 3,
    MODEL_NEED_ZSTD = 1 << 4, /* KTX2 with that compression */
    MODEL_NEED_COUNT = 5      /* of bits */
} model_need;

/* "draco", "webp", .. of a bit: the name of the module. */
const char *model_need_name(model_need need);

/* Or-ed model_need. By extensions and the bytes of images, whether or not textures use them. */
unsigned model_needs_of_scene(const facet_scene *scene);
/* The same of an image: a texture or an environment. */
unsigned model_needs_of_image(const void *bytes, size_t size);
/* The same of a glTF file before it is read, without its geometry, or of an image file; 0 for other models. FACET_ERROR_*: the
 * file cannot be read. */
facet_result model_needs_of_file(const char *path, const facet_scene_desc *desc, unsigned *needs,
                                 facet_error *error);

#endif
