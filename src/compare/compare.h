/* compare.h - how far two pictures are from each other: errors per pixel, structure, and what an eye sees. See facet.h. */
#ifndef COMPARE_COMPARE_H
#define COMPARE_COMPARE_H

#include "facet/facet.h"
#include "image/image.h"

#endif
