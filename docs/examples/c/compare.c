/* compare.c - whether an image is near enough to a reference: compare REFERENCE IMAGE DIFFERENCE */
#include <facet/facet.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    if (argc < 3)
        return 2;
    facet_error error;
    facet_image *reference = NULL, *image = NULL, *difference = NULL;
    facet_comparison c = {0};
    const facet_compare_desc desc = {.difference = FACET_DIFFERENCE_HEAT_MAP, .is_sheet = true};

    facet_result result = facet_image_load(argv[1], NULL, &reference, &error);
    if (result == FACET_OK)
        result = facet_image_load(argv[2], NULL, &image, &error);
    if (result == FACET_OK)
        result = facet_compare(reference, image, &desc, &c, &difference, &error);
    if (result == FACET_OK)
        printf("FLIP %.4f, SSIM %.4f, PSNR %.1f dB, %llu pixels differ\n", c.flip, c.ssim, c.psnr,
               (unsigned long long)c.differing_count);
    if (result == FACET_OK && argc > 3)
        result = facet_image_save(difference, argv[3], NULL, &error);
    if (result != FACET_OK)
        fprintf(stderr, "%s\n", error.message);

    facet_image_destroy(difference);
    facet_image_destroy(image);
    facet_image_destroy(reference);
    return result == FACET_OK && c.invalid_count == 0 && c.flip < 0.02 ? 0 : 1;
}
