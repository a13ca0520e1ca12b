/* facet/facet.h - the public interface of libfacet: all of its headers. docs/c-api.md is the guide.
 *
 * Conventions
 *   Units      m, rad, s, cd, lx, cd/m^2; +Y up, right-handed, cameras look along -Z, as in glTF
 *   Color      linear Rec.709 unless a name says _srgb
 *   Images     texel (0, 0) is the top left one; rows from top to bottom
 *   Descs      {0} is valid for every desc struct and means the defaults that its comments give; NULL in place of a
 *              desc means {0}
 *   Failure    a function that can fail returns a facet_result and writes one sentence to *error (NULL: not wanted);
 *              its outputs are then NULL, and nothing leaks
 *   Threads    different objects may be used from different threads; one object may be read from several; results
 *              are equal to the last bit for every thread count
 *   State      the library never prints, exits, reads environment variables or keeps global state
 *   Versions   before 1.0 every minor version may add fields to any struct; programs are then compiled again. The number
 *              in the soname (libfacet.so.0) changes whenever that is so. Patch versions change no declaration */
#ifndef FACET_FACET_H
#define FACET_FACET_H

#include "base.h"
#include "arrays.h"
#include "bake.h"
#include "camera.h"
#include "compare.h"
#include "environment.h"
#include "image.h"
#include "legacy.h"
#include "part.h"
#include "plot.h"
#include "render.h"
#include "scene.h"
#include "sea.h"
#include "shaders.h"
#include "view.h"

#endif
