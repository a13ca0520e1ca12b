/* ocean_names.h - what the files of facet ocean are called, and which they must not be. */
#ifndef CLI_OCEAN_NAMES_H
#define CLI_OCEAN_NAMES_H

#include "cli/ocean/ocean_run.h"

/* Of --maps: a folder, or a pattern with a place for the tile's number; in a folder, maps of a sequence have the frame's number behind it.
 * size bytes. FACET_ERROR_ARGUMENT. */
facet_result ocean_map_name(const ocean_options *o, uint32_t tile, uint32_t frame, char *name, size_t size,
                            facet_error *error);

/* Whether a file can be written, and is nothing that is read. */
facet_result ocean_check_name(const ocean_run *run, const char *name, facet_error *error);

/* Whether a picture or mesh of that frame has the name of one of its maps. */
facet_result ocean_check_maps(const ocean_run *run, const char *name, uint32_t frame, facet_error *error);

#endif
