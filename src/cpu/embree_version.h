/* embree_version.h - which Embree there is, for `facet version -v`. */
#ifndef CPU_EMBREE_VERSION_H
#define CPU_EMBREE_VERSION_H

#include <stddef.h>

/* "3.13.5": the version of Embree that facet was built for; "": it was built without. */
const char *embree_scene_version(void);
/* That of the Embree on this machine; "": there is none that runs. */
void embree_find_version(char *version, size_t size);

#endif
