/* gl_build.h - tells builds of facet apart whose structures may differ. */
#ifndef GL_GL_BUILD_H
#define GL_GL_BUILD_H

#include "build_config.h"

#define GL_ENTRY_BUILD FACET_VERSION " " FACET_BUILD_TYPE " " __VERSION__

#endif
