/* view_export.h - facet view --html: pages that show models in a browser instead of a window. */
#ifndef CLI_VIEW_EXPORT_H
#define CLI_VIEW_EXPORT_H

#include "cli/shared/command_line.h"

/* Runs facet view with --html; returns the exit code. Needs no display and no OpenGL. */
int view_export(command_line *c);

#endif
