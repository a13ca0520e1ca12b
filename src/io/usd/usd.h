/* usd.h - writes Universal Scene Description. */
#ifndef IO_USD_H
#define IO_USD_H

#include "scene/scene.h"

/* Writes a .usdz file: the default scene with its hierarchy, triangles, materials as UsdPreviewSurface, textures as
 * PNG and JPEG, and the first animation of nodes. What USD or this writer lacks is named in one warning. Fails as
 * file_set_add(), and with FACET_ERROR_LIMIT above 4 GiB. */
facet_result usdz_save(const facet_scene *scene, const char *path, const char *generator,
                       const facet_scene_save_desc *desc, facet_error *error);

#endif
