/* orbit.h - camera positions in the notation of <model-viewer>: camera-orbit and camera-target. */
#ifndef CLI_ORBIT_H
#define CLI_ORBIT_H

#include "facet/facet.h"

/* "AZIMUTH,POLAR,RADIUS", separated by commas or blanks; later parts may be left out, each may be "auto": then
 * orbit keeps what it has. Angles in deg (also without unit) or rad, the radius in % of what frames the model or
 * in m (also without unit), cm, mm. False where text is none of these, polar is not in [0 deg, 180 deg] or the
 * radius is not more than 0; orbit is then untouched. */
bool orbit_parse(const char *text, facet_orbit *orbit);

/* "X,Y,Z" in m (also without unit), cm, mm; "auto" for all or for one keeps target[i] and clears is_given[i]. */
bool target_parse(const char *text, double target[3], bool is_given[3]);

#endif
