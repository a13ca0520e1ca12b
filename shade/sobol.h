/* sobol.h - well distributed numbers for Monte Carlo integration: points of Sobol's (0, 2)-sequence, shuffled and
 * Owen-scrambled by hashes, so that every power of two of them is even in the strictest sense, each of them is uniform, and
 * point i needs no other.
 *
 * A number in [0, 1) is a row of binary digits. Here digit 0, the largest, is bit 0 of a uint, and reverse_bits() turns rows
 * into fractions: the hash that scrambles has to run from digit 0 on, and multiplications run from bit 0 on. */
#ifndef SHADE_SOBOL_H
#define SHADE_SOBOL_H

/* A well mixed number of 32 bits: every bit of the result depends on every bit of x. Wellons 2018, "lowbias32". */
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

/* Owen's scrambling of the digits of x: each is flipped or not by a hash of seed and of the digits before it. seed is to be
 * well mixed (hash_uint()). The form is Laine and Karras' (2011, section 3.1): additions, products and x ^= x * even only
 * pass digits on to later ones. Theirs leaves flips that go together; here seed enters six times, and over all seeds each
 * flip is even and every two are independent, on which the variance of an estimate rests (Owen 1997). Any constants of the
 * form 4n + 2 did equally well in the test. */
FN uint owen_scramble(uint x, uint seed)
{
    uint d = x + seed;
    d ^= d * (0x7a1f6c52u ^ ((seed >> 15u) & 0xfffffffeu));
    d += seed >> 8u;
    d *= (seed >> 23u) | 1u;
    d ^= d * (0xc3e9d1a6u ^ ((seed >> 4u) & 0xfffffffeu));
    return d;
}

/* Digits of Sobol's second dimension for digits i of the first: Pascal's triangle modulo 2 as a matrix, digit j = sum over
 * k of binomial(k, j) digit k. The triangle is the Kronecker power of that of two rows, hence five shifts (Ahmed 2024). */
FN uint sobol_second(uint i)
{
    uint d = i ^ ((i >> 1u) & 0x55555555u);
    d ^= (d >> 2u) & 0x33333333u;
    d ^= (d >> 4u) & 0x0f0f0f0fu;
    d ^= (d >> 8u) & 0x00ff00ffu;
    return d ^ (d >> 16u);
}

/* Point index of the sequence that belongs to seed, in [0, 1)^2. Points n 2^m to (n + 1) 2^m - 1 are a (0, m, 2)-net: each
 * box of area 2^-m that halving the square's edges leads to holds one of them. Sequences of different seeds are independent,
 * also in their order, and so may be paired to points of more dimensions. Burley 2020, "Practical Hash-based Owen
 * Scrambling". */
FN vec2 sobol_point(uint index, uint seed)
{
    uint h = hash_uint(seed); /* turned by a third, its bits play other parts in owen_scramble() */
    uint h_x = (h << 11u) | (h >> 21u);
    uint h_y = (h << 21u) | (h >> 11u);
    /* scrambling index, its largest digit first, keeps together what halves of the sequence hold */
    uint i = reverse_bits(owen_scramble(reverse_bits(index), h));
    uint x = reverse_bits(owen_scramble(i, h_x));
    uint y = reverse_bits(owen_scramble(sobol_second(i), h_y));
    return vec2(float(x >> 8u), float(y >> 8u)) * (1.0f / 16777216.0f); /* 24 bits: exact, never 1 */
}

#endif
