/* fourier.c - see fourier.h. */
#include "ibl/fourier.h"

#include <math.h>

void fourier_init(fourier *f, uint32_t size)
{
    uint32_t bits = 30u - (uint32_t)__builtin_clz(size); /* of an index below size / 2 */
    f->size = size;
    for (uint32_t k = 0; k < size / 2; k++) {
        double angle = 2.0 * 3.14159265358979323846 * k / size;
        f->cosine[k] = (float)cos(angle);
        f->sine[k] = (float)sin(angle);
        uint32_t mirrored = 0;
        for (uint32_t b = 0; b < bits; b++)
            mirrored |= (k >> b & 1u) << (bits - 1 - b);
        f->mirrored[k] = (uint16_t)mirrored;
    }
}
