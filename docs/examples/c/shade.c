/* shade.c - facet's shading functions in a program of one's own:
 * cc shade.c -I$(pkg-config --variable=includedir facet) -lm -o shade */
#include <facet/shade/shade.h>
#include <stdio.h>

int main(void)
{
    float alpha = 0.3f * 0.3f; /* perceptual roughness 0.3 */
    float f = shade_D_GGX(1.0f, alpha) * shade_V_SmithGGX(1.0f, 1.0f, alpha);
    printf("BRDF of a white metal, seen and lit from the normal: %g / sr\n", (double)f);
    return f > 0.0f ? 0 : 1;
}
