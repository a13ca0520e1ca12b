/* cache.h - prepared parts of lights kept on disk between runs.
 *
 * An entry is a file facet-HASH-PART.light in the environment's cache folder: HASH of the environment's source, and of
 * what the part is made like. Entries appear whole or not at all, each says how long it is and what its bytes add up
 * to, and one that does not fit is as good as none. All that goes wrong here is a warning: a light is prepared anew. */
#ifndef IBL_CACHE_H
#define IBL_CACHE_H

#include <stddef.h>

#include "facet/facet.h"

/* Reads the part into data; false: there is no cache or no entry of exactly size bytes. recipe changes whenever the
 * part would be prepared differently. */
bool cache_read(const facet_environment *environment, const char *part, uint64_t recipe, void *data,
                size_t size);
/* Keeps the part, then removes the entries that were not used for longest until the folder holds no more than the
 * environment's cache_bytes. */
void cache_write(const facet_environment *environment, const char *part, uint64_t recipe, const void *data,
                 size_t size);

/* Distinguishes the entries of an environment by these bytes of its source and by the source's layout. */
void cache_identify(facet_environment *environment, const void *bytes, size_t size);
/* Ends the creation of an environment: with result FACET_OK *environment is `made`, identified by its texels; with another
 * one `made` is released. Returns result. */
facet_result cache_finish(facet_result result, facet_environment *made, facet_environment **environment);

/* 64 bits of the bytes, starting from seed. */
uint64_t cache_hash(uint64_t seed, const void *bytes, size_t size);

#endif
