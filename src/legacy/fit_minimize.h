/* fit_minimize.h - the least value of a function of one, two or three variables within bounds. For fit*.c only. */
#ifndef LEGACY_FIT_MINIMIZE_H
#define LEGACY_FIT_MINIMIZE_H

enum { FIT_MAX_VARIABLES = 3 };

typedef double (*fit_function)(void *context, const double *x);

/* One variable in [low, high]: the best of count >= 3 values at even distances, then golden sections between its
 * neighbours until tolerance. Writes where it is to *x and returns f there; f is called last with it. */
double fit_minimize_1(fit_function f, void *context, double low, double high, int count, double tolerance,
                      double *x);

/* n variables in [0, 1] from x on with first steps of step[i], by the simplex method of Nelder and Mead 1965 until its
 * values agree to tolerance (relative) or f was called limit times. Values out of bounds are moved to them. Writes where
 * it is to x and returns f there; f is called last with it. */
double fit_minimize_n(fit_function f, void *context, int n, double *x, const double *step, double tolerance,
                      int limit);

#endif
