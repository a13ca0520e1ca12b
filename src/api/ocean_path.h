/* ocean_path.h - facet_sea_render() by path tracing. */
#ifndef API_OCEAN_PATH_H
#define API_OCEAN_PATH_H

#include "facet/facet.h"

/* desc: resolved, with a camera; scene NULL: nothing but water. Fails as facet_render() and water_render(). */
facet_result ocean_path_render(const facet_sea *sea, const facet_scene *scene,
                               const facet_sea_render_desc *desc, facet_image **out, facet_error *error);

#endif
