/* fit_minimize.h - minimization of a function of one to three variables within bounds. For fit*.c only. */
#ifndef LEGACY_FIT_MINIMIZE_H
#define LEGACY_FIT_MINIMIZE_H

enum { FIT_MAX_VARIABLES = 3 };

typedef double (*fit_function)(void *context, const double *x);

/* One variable in [low, high]: the best of count >= 3 even values, then golden section search between its
 * neighbors until tolerance. Writes the position to *x and returns the minimum; the last call of f is
 * there. */
double fit_minimize_1(fit_function f, void *context, double low, double high, int count, double tolerance,
                      double *x);

/* n variables in [0, 1], starting from x with steps step[i], by the simplex method of Nelder and Mead 1965
 * until its values agree to tolerance (relative) or f was called limit times. Positions out of bounds are
 * clamped. Writes the position to x and returns the minimum; the last call of f is there. */
double fit_minimize_n(fit_function f, void *context, int n, double *x, const double *step, double tolerance,
                      int limit);

#endif
