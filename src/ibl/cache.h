/* cache.h - prepared parts of lights, kept on disk between runs.
 *
 * An entry is a file facet-HASH-PART.light in the environment's cache folder, where HASH identifies the
 * environment's source and the part's recipe. Entries are written atomically and hold their length and a
 * checksum; one that does not match is ignored. All failures are warnings: the light is prepared again. */
#ifndef IBL_CACHE_H
#define IBL_CACHE_H

#include <stddef.h>

#include "facet/facet.h"

/* Reads the part into data; false: there is no cache, or no entry of exactly size bytes. recipe identifies
 * how the part is prepared. */
bool cache_read(const facet_environment *environment, const char *part, uint64_t recipe, void *data,
                size_t size);
/* Stores the part, then removes the least recently used entries until the folder holds at most the
 * environment's cache_bytes. */
void cache_write(const facet_environment *environment, const char *part, uint64_t recipe, const void *data,
                 size_t size);

/* Distinguishes the entries of an environment by these bytes of its source and by the source's layout. */
void cache_identify(facet_environment *environment, const void *bytes, size_t size);
/* Ends the creation of an environment: with result FACET_OK *environment is `made`, identified by its
 * texels; with another one `made` is released. Returns result. */
facet_result cache_finish(facet_result result, facet_environment *made, facet_environment **environment);

/* 64-bit hash of the bytes, starting from seed. */
uint64_t cache_hash(uint64_t seed, const void *bytes, size_t size);

#endif
