/* gauss.h - Gauss-Legendre quadrature, exact for polynomials of degree 15 and 31 (Abramowitz and Stegun 1964,
 * table 25.4). */
#ifndef IBL_GAUSS_H
#define IBL_GAUSS_H

/* Node i of 8 in (from, to), in ascending order, and its weight. */
static inline double gauss_8(int i, double from, double to, double *weight)
{
    static const double nodes[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                    0.9602898564975363};
    static const double weights[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                      0.1012285362903763};
    double x = i < 4 ? -nodes[3 - i] : nodes[i - 4];
    *weight = 0.5 * (to - from) * weights[i < 4 ? 3 - i : i - 4];
    return 0.5 * (from + to) + 0.5 * (to - from) * x;
}

/* Node i of 16. */
static inline double gauss_16(int i, double from, double to, double *weight)
{
    static const double nodes[8] = {0.0950125098376374, 0.2816035507792589, 0.4580167776572274,
                                    0.6178762444026438, 0.7554044083550030, 0.8656312023878318,
                                    0.9445750230732326, 0.9894009349916499};
    static const double weights[8] = {0.1894506104550685, 0.1826034150449236, 0.1691565193950025,
                                      0.1495959888165767, 0.1246289712555339, 0.0951585116824928,
                                      0.0622535239386479, 0.0271524594117541};
    double x = i < 8 ? -nodes[7 - i] : nodes[i - 8];
    *weight = 0.5 * (to - from) * weights[i < 8 ? 7 - i : i - 8];
    return 0.5 * (from + to) + 0.5 * (to - from) * x;
}

#endif
