/* water_picture.h - what is prepared for a picture of a sea, for a renderer that is not this one: ocean/sea_picture.h. */
#ifndef WATER_WATER_PICTURE_H
#define WATER_WATER_PICTURE_H

#include "ocean/sea_picture.h"

typedef struct water_picture water_picture;

/* desc: resolved, as of water_render(); it and the sea stay as long. *out NULL where it fails, as water_render() does. */
facet_result water_picture_create(const facet_sea *sea, const facet_scene *scene /* NULL: water only */,
                                  const facet_sea_render_desc *desc, water_picture **out,
                                  facet_render_stats *stats, facet_error *error);
void water_picture_destroy(water_picture *p); /* NULL is allowed */
const sea_picture *water_picture_get(const water_picture *p);

#endif
