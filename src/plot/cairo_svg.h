/* cairo_svg.h - what is left to do on an SVG file that cairo wrote. */
#ifndef PLOT_CAIRO_SVG_H
#define PLOT_CAIRO_SVG_H

#include "base/text.h"

/* Numbers the ids of pictures and groups from 1 (cairo counts on from file to file, so that the same drawing would
 * give other bytes) and adds <title> (UTF-8; NULL, "": none), which readers aloud and tooltips take: cairo writes
 * text as outlines. False: out of memory; svg is as it was. */
bool cairo_svg_tidy(text *svg, const char *title);

#endif
