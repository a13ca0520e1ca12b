/* primaries.h - conversion of other RGB spaces to linear Rec.709, and the CIE's color matching functions. */
#ifndef IMAGE_PRIMARIES_H
#define IMAGE_PRIMARIES_H

#include "image/image.h"

/* CIE 1931 x and y of red, green, blue and white. */
typedef struct primaries {
    double xy[4][2];
} primaries;

/* The matrix from linear RGB of these primaries to linear Rec.709: to XYZ (SMPTE RP 177), white adapted to
 * D65 by Bradford's transform (as in ICC v4 and OpenColorIO's configurations for ACES), to Rec.709. XYZ
 * itself, which red (1, 0), green (0, 1), blue (0, 0) with equal-energy white stand for, is not adapted: its
 * white is a unit, not an illuminant. False: the primaries do not form a color space (not finite, collinear,
 * white outside of the triangle). */
bool primaries_to_rec709(const primaries *p, double matrix[3][3]);

/* Converts the first three channels of an F32 image in place, unless the primaries are those of Rec.709, and
 * sets desc->note: a detail that names the color space, or a warning if the primaries do not form one and
 * colors stay as they are. Texels that are not finite are kept. */
void primaries_convert(image *i, const primaries *p, const image_decode_desc *desc);

/* ---- spectra ---- */

/* Relative spectral power of D65 (CIE 15), from CIE_D65_FIRST nm in steps of 10. */
enum { CIE_D65_FIRST = 380, CIE_D65_STEP = 10, CIE_D65_COUNT = 41 };
extern const double cie_d65[CIE_D65_COUNT];

/* The CIE 1931 color matching functions at a wavelength in nm, as Wyman, Sloan and Shirley fit them
 * ("Simple Analytic Approximations to the CIE XYZ Color Matching Functions", JCGT 2013, table 1; at most
 * 1.4 % off). */
void cie_match_color(double nm, double xyz[3]);

/* Linear Rec.709 (D65) of XYZ, IEC 61966-2-1. */
void cie_rec709_from_xyz(const double xyz[3], double rgb[3]);

#endif
