/* bake.c - an environment as a prefiltered cube map in KTX2, and its spherical harmonics: bake CUBE.ktx2
 * [ENVIRONMENT] */
#include <facet/facet.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    facet_error error;
    facet_environment *environment = NULL;
    facet_cube *cube = NULL;
    unsigned char *file = NULL;
    size_t size = 0;
    float c[9][3];
    const facet_bake_desc bake = {.lobe = FACET_LOBE_GGX, .size = 64};
    const facet_ktx2_desc ktx2 = {.format = FACET_TEXEL_FORMAT_RGBA16F};
    const facet_sh_desc sh = {.form = FACET_SH_FORM_FOLDED}; /* Filament's */

    facet_result result = argc > 2 ? facet_environment_load(argv[2], NULL, &environment, &error)
                                   : facet_environment_create_studio(NULL, &environment, &error);
    if (result == FACET_OK)
        result = facet_cube_bake(environment, &bake, &cube, &error);
    if (result == FACET_OK)
        result = facet_cube_encode_ktx2(cube, &ktx2, &file, &size, &error);
    if (result == FACET_OK)
        result = facet_bytes_save(file, size, argc > 1 ? argv[1] : "environment.ktx2", &error);
    if (result == FACET_OK)
        result = facet_environment_project_sh(environment, &sh, c, &error);
    if (result == FACET_OK)
        printf("%u levels; mean irradiance / pi %.3f %.3f %.3f\n", facet_cube_get_level_count(cube),
               (double)c[0][0], (double)c[0][1], (double)c[0][2]);
    else
        fprintf(stderr, "%s\n", error.message);

    facet_bytes_destroy(file);
    facet_cube_destroy(cube);
    facet_environment_destroy(environment);
    return result == FACET_OK ? 0 : 1;
}
