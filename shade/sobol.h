/* sobol.h - low-discrepancy points for Monte Carlo integration: Sobol's (0, 2)-sequence, shuffled and
 * Owen-scrambled by hashes. Every aligned block of 2^m points is a (0, m, 2)-net, each point is uniform, and
 * any point can be computed by itself.
 *
 * A number in [0, 1) is a row of binary digits. Digit 0, the most significant, is bit 0 of a uint, and
 * reverse_bits() converts rows to fractions: scrambling must propagate from digit 0 on, and multiplications
 * carry from bit 0 on. */
#ifndef SHADE_SOBOL_H
#define SHADE_SOBOL_H

/* A 32-bit hash with full avalanche: every bit of the result depends on every bit of x. Wellons 2018,
 * "lowbias32". */
FN uint hash_uint(uint x)
{
    uint h = x;
    h ^= h >> 16u;
    h *= 0x7feb352du;
    h ^= h >> 15u;
    h *= 0x846ca68bu;
    h ^= h >> 16u;
    return h;
}

/* Owen scrambling of the digits of x: each is flipped or not by a hash of the seed and of the digits
 * before it. The seed must be a hash (hash_uint()). The form is that of Laine and Karras (2011, section
 * 3.1): additions, products and x ^= x * even propagate to later digits only. Their flips are correlated;
 * here the seed enters six times, and over all seeds each flip is unbiased and every two are independent,
 * on which the variance of an estimate rests (Owen 1997). Any constants of the form 4n + 2 did equally
 * well in the test. */
FN uint owen_scramble(uint x, uint seed)
{
    uint d = x + seed;
    d ^= d * (0x7a1f6c52u ^ ((seed >> 15u) & 0xfffffffeu));
    d += seed >> 8u;
    d *= (seed >> 23u) | 1u;
    d ^= d * (0xc3e9d1a6u ^ ((seed >> 4u) & 0xfffffffeu));
    return d;
}

/* Digits of Sobol's second dimension from the digits i of the first: Pascal's triangle modulo 2 as a
 * matrix, digit j = sum over k of binomial(k, j) digit k. The matrix is a Kronecker power of its 2 x 2
 * case, hence five shifts (Ahmed 2024). */
FN uint sobol_second(uint i)
{
    uint d = i ^ ((i >> 1u) & 0x55555555u);
    d ^= (d >> 2u) & 0x33333333u;
    d ^= (d >> 4u) & 0x0f0f0f0fu;
    d ^= (d >> 8u) & 0x00ff00ffu;
    return d ^ (d >> 16u);
}

/* Another order of a sequence: digit j of index i becomes the sum, modulo 2, of the digits j, j + t1, .. j
 * + t4 (binary digits of i from the last one on), with the four numbers t from 1 to 31 as bytes of taps;
 * 31 is none for i below 2^31. A multiplication by the polynomial 1 + z^t1 + .. + z^t4. Blocks of 2^m
 * indices stay blocks of 2^m, so each order runs through nets as the plain one does; two orders side by
 * side give points of four dimensions, which are as well distributed as the quotient of their polynomials
 * is irregular (Niederreiter 1987). */
FN uint sobol_order(uint i, uint taps)
{
    return i ^ (i >> (taps & 31u)) ^ (i >> ((taps >> 8u) & 31u)) ^ (i >> ((taps >> 16u) & 31u)) ^
           (i >> (taps >> 24u));
}

/* Index i of a sequence in random order: scrambled, most significant digit first, which keeps blocks of 2^m
 * together. seed as for owen_scramble(). */
FN uint sobol_shuffle(uint i, uint seed)
{
    return reverse_bits(owen_scramble(reverse_bits(i), seed));
}

/* A row of digits as a fraction in [0, 1), to 24 digits: exact, never 1. */
FN float sobol_fraction(uint digits)
{
    return float(int(reverse_bits(digits) >> 8u)) * (1.0f / 16777216.0f);
}

/* The two coordinates of sobol_scrambled(). Rotated by a third, the bits of the seed enter owen_scramble() at
 * other places. */
FN float sobol_scrambled_first(uint i, uint seed)
{
    return sobol_fraction(owen_scramble(i, (seed << 11u) | (seed >> 21u)));
}
FN float sobol_scrambled_second(uint i, uint seed)
{
    return sobol_fraction(owen_scramble(sobol_second(i), (seed << 21u) | (seed >> 11u)));
}

/* Point i of the sequence in [0, 1)^2, its digits scrambled by seed (as for owen_scramble()). Points n 2^m to
 * (n + 1) 2^m - 1 are a (0, m, 2)-net: each elementary interval of area 2^-m contains one of them. */
FN vec2 sobol_scrambled(uint i, uint seed)
{
    return vec2(sobol_scrambled_first(i, seed), sobol_scrambled_second(i, seed));
}

/* Point `index` of the sequence of a seed (any number). Sequences of different seeds are independent, in
 * their order as well, and may be combined to points of more dimensions. Burley 2020, "Practical
 * Hash-based Owen Scrambling". */
FN vec2 sobol_point(uint index, uint seed)
{
    uint h = hash_uint(seed);
    return sobol_scrambled(sobol_shuffle(index, h), h);
}

#endif
