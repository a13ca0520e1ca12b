/* fuzz_material.c - materials of facet plot as text: "roughness=0.3,metallic=1", "ogl1,shininess=20". */
#include "fuzz_support.h"

#include <string.h>

#include "cli/plot/plot_material.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    if (!text)
        abort();
    memcpy(text, data, size);
    text[size] = 0;
    const facet_scene_desc desc = {.log = {.message = fuzz_ignore}};
    plot_materials materials = {0};
    facet_error error = {0};
    /* the others name files */
    if (strchr(text, '=') || strncmp(text, "ogl1", 4) == 0)
        fuzz_check_error(plot_materials_add(&materials, text, &desc, &error), &error);
    plot_materials_destroy(&materials);
    free(text);
    return 0;
}
