/* studio_generate.c - computes the harmonics of the built-in studio; runs when facet is built.
 * usage: studio_generate OUTPUT: the initializer of a studio_table. */
#include <stdio.h>

#include "ibl/harmonics_transform.h"
#include "ibl/studio_draw.h"

int main(int argc, char **argv)
{
    image panorama;
    harmonics h;
    if (argc != 2) {
        fprintf(stderr, "usage: studio_generate OUTPUT\n");
        return 1;
    }
    facet_error error;
    if (studio_draw(NULL, 1, &panorama, &error) != FACET_OK ||
        harmonics_create(&panorama, STUDIO_DEGREE, NULL, 1, &h, &error) != FACET_OK) {
        fprintf(stderr, "studio_generate: %s\n", error.message);
        return 1;
    }
    FILE *file = fopen(argv[1], "w");
    if (!file) {
        perror(argv[1]);
        return 1;
    }
    fprintf(file, "%u, %.8ef, %.8ef, {\n", h.column_count, (double)h.mean[0], (double)h.least[0]);
    for (size_t i = 0; i < STUDIO_COEFFICIENTS; i++) {
        const float *c = h.coefficients + i * HARMONICS_PARTS;
        if (c[0] < c[2] || c[0] > c[2] || c[1] < c[3] || c[1] > c[3]) {
            fprintf(stderr, "studio_generate: expected a grey studio\n");
            return 1;
        }
        fprintf(file, "%.8ef, %.8ef,\n", (double)c[0], (double)c[1]);
    }
    fprintf(file, "}\n");
    harmonics_destroy(&h);
    image_destroy(&panorama);
    return fclose(file) == 0 ? 0 : 1;
}
