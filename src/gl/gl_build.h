/* gl_build.h - the identity of a build; structures may differ between builds. */
#ifndef GL_GL_BUILD_H
#define GL_GL_BUILD_H

#include "build_config.h"

#define GL_ENTRY_BUILD FACET_VERSION " " FACET_BUILD_ID " " FACET_BUILD_TYPE " " __VERSION__

#endif
