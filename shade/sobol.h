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

/* Index i of a sequence moved to another place of it: digit j becomes the sum, modulo 2, of the digits j, j + t1, .. j + t4
 * (binary digits of i from the last one on), with the four numbers t from 1 to 31 as bytes of taps; 31 is none for i below
 * 2^31. A multiplication by the polynomial 1 + z^t1 + .. + z^t4. Blocks of 2^m indices stay blocks of 2^m, so each of these
 * orders runs through nets as the plain one does; two orders side by side give points of four dimensions, which are as
 * even as the quotient of their polynomials is irregular (Niederreiter 1987). */
FN uint sobol_order(uint i, uint taps)
{
    return i ^ (i >> (taps & 31u)) ^ (i >> ((taps >> 8u) & 31u)) ^ (i >> ((taps >> 16u) & 31u)) ^
           (i >> (taps >> 24u));
}

/* Index i of a sequence in an order of its own: scrambled, its largest digit first, which keeps blocks of 2^m together.
 * seed as that of owen_scramble(). */
FN uint sobol_shuffle(uint i, uint seed)
{
    return reverse_bits(owen_scramble(reverse_bits(i), seed));
}

/* Point i of the sequence whose digits are scrambled by seed, which is as that of owen_scramble(), in [0, 1)^2. Points n 2^m
 * to (n + 1) 2^m - 1 are a (0, m, 2)-net: each box of area 2^-m that halving the square's edges leads to holds one of them. */
FN vec2 sobol_scrambled(uint i, uint seed)
{
    /* turned by a third, the seed's bits play other parts in owen_scramble() */
    uint x = reverse_bits(owen_scramble(i, (seed << 11u) | (seed >> 21u)));
    uint y = reverse_bits(owen_scramble(sobol_second(i), (seed << 21u) | (seed >> 11u)));
    return vec2(float(x >> 8u), float(y >> 8u)) * (1.0f / 16777216.0f); /* 24 bits: exact, never 1 */
}

/* Point index of the sequence that belongs to seed (any number). Sequences of different seeds are independent, also in
 * their order, and so may be paired to points of more dimensions. Burley 2020, "Practical Hash-based Owen Scrambling". */
FN vec2 sobol_point(uint index, uint seed)
{
    uint h = hash_uint(seed);
    return sobol_scrambled(sobol_shuffle(index, h), h);
}

#endif
