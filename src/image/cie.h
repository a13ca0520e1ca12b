/* cie.h - what an eye makes of a spectrum: the CIE's color matching functions and daylight. */
#ifndef IMAGE_CIE_H
#define IMAGE_CIE_H

/* Relative power of daylight D65 (CIE 15), CIE_D65_FIRST nm and on in steps of 10. */
enum { CIE_D65_FIRST = 380, CIE_D65_STEP = 10, CIE_D65_COUNT = 41 };
extern const double cie_d65[CIE_D65_COUNT];

/* The CIE 1931 color matching functions at a wavelength in nm, as Wyman, Sloan and Shirley fit them ("Simple Analytic
 * Approximations to the CIE XYZ Color Matching Functions", JCGT 2013, table 1; at most 1.4 % off). */
void cie_match_color(double nm, double xyz[3]);

/* Linear Rec.709 (D65) of XYZ, IEC 61966-2-1. */
void cie_rec709_from_xyz(const double xyz[3], double rgb[3]);

#endif
