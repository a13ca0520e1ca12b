/* plot.c - the BRDF of a metal over the angle of the light as an SVG: plot FILE.svg */
#include <facet/facet.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    facet_error error;
    unsigned char *svg = NULL;
    size_t size = 0;
    facet_plot_material metal = facet_plot_material_default();
    metal.metallic = 1.0f;
    metal.perceptual_roughness = 0.3f;
    facet_plot_fit fits[FACET_PLOT_MAX_MATERIALS];
    const facet_plot_desc desc = {.kind = FACET_PLOT_KIND_SLICE,
                                  .material_count = 1,
                                  .materials = &metal,
                                  .has_fit = true,
                                  .fits = fits};

    facet_result result = facet_plot_encode(&desc, FACET_PLOT_FORMAT_SVG, &svg, &size, &error);
    if (result == FACET_OK) {
        printf("%s, error %.3f\n", fits[0].description, (double)fits[0].E);
        result = facet_bytes_save(svg, size, argc > 1 ? argv[1] : "metal.svg", &error);
    }
    if (result != FACET_OK)
        fprintf(stderr, "%s\n", error.message);
    facet_bytes_destroy(svg);
    return result == FACET_OK ? 0 : 1;
}
