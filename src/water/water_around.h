/* water_around.h - what a model sees around it: the sky, and the sea on average. */
#ifndef WATER_WATER_AROUND_H
#define WATER_WATER_AROUND_H

#include "water/water_setup.h"

/* Makes s->cache->light->around, once for a light. FACET_ERROR_MEMORY. */
facet_result water_around_prepare(water_setup *s, facet_error *error);

#endif
