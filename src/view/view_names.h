/* view_names.h - what people read of settings. */
#ifndef VIEW_VIEW_NAMES_H
#define VIEW_VIEW_NAMES_H

#include "facet/facet.h"

const char *view_tonemap_name(facet_tonemap tonemap);
const char *view_channel_name(facet_channel channel);
const char *view_brdf_name(facet_brdf brdf);
const char *view_energy_name(facet_energy energy);
const char *view_transparency_name(facet_transparency transparency);
const char *view_background_name(facet_background background);

#endif
