/* shaders.c - GLSL of facet's specular and diffuse BRDFs, with all that they need: shaders FILE.glsl */
#include <facet/facet.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    facet_error error;
    unsigned char *glsl = NULL;
    size_t size = 0;
    const char *const parts[] = {"brdf"};
    const facet_shader_desc desc = {.version = "330", .parts = parts, .part_count = 1};

    facet_result result = facet_shader_text(&desc, &glsl, &size, &error);
    if (result == FACET_OK)
        result = facet_bytes_save(glsl, size, argc > 1 ? argv[1] : "brdf.glsl", &error);
    if (result != FACET_OK)
        fprintf(stderr, "%s\n", error.message);
    facet_bytes_destroy(glsl);
    return result == FACET_OK ? 0 : 1;
}
