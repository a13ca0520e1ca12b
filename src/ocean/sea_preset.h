/* sea_preset.h - seas that have names. */
#ifndef OCEAN_SEA_PRESET_H
#define OCEAN_SEA_PRESET_H

#include "facet/facet.h"

/* See facet_sea_default(). */
facet_sea_desc sea_default(void);

uint32_t sea_preset_count(void);
const char *sea_preset_name(uint32_t index); /* NULL: there is none */
/* FACET_ERROR_ARGUMENT: no such name; the sentence lists those there are. */
facet_result sea_preset(const char *name, facet_sea_desc *desc, facet_error *error);

#endif
