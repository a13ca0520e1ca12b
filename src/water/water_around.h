/* water_around.h - the environment that a model sees: the sky, and the mean radiance of the sea. */
#ifndef WATER_WATER_AROUND_H
#define WATER_WATER_AROUND_H

#include "water/water_setup.h"

/* Makes s->cache->light->around, once per light. FACET_ERROR_MEMORY. */
facet_result water_around_prepare(water_setup *s, facet_error *error);

#endif
