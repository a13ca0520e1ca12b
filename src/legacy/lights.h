/* lights.h - lights of OpenGL 1 to KHR_lights_punctual and back. A white surface that faces a white light shows 1 in
 * OpenGL 1 and 1 / pi in glTF: illuminances are pi times legacy colors (reference, section 3). */
#ifndef LEGACY_LIGHTS_H
#define LEGACY_LIGHTS_H

#include "legacy/convert_state.h"

/* Punctual lights, each with a node in the default scene, of scene->legacy; those of an earlier conversion are replaced.
 * Lights that are relative to the viewer are placed for the default camera, point lights get the intensity that is right
 * at the middle of the scene. Fails with FACET_ERROR_MEMORY, and then leaves the scene as it was. */
facet_result lights_from_legacy(conversion *c, facet_error *error);

/* c->legacy's lights of the punctual ones of the default scene at rest. */
facet_result lights_to_legacy(conversion *c, facet_error *error);

#endif
