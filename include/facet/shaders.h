/* facet/shaders.h - facet's shader library (shade/) as GLSL for other renderers. docs/shaders.md is the
 * guide. */
#ifndef FACET_SHADERS_H
#define FACET_SHADERS_H

#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Names of the functions in GLSL. */
typedef enum facet_shader_names {
    FACET_SHADER_NAMES_FACET,
    /* facet's, and those of the Khronos Sample Viewer with its arguments: V_GGX, BRDF_lambertian,
     * Schlick_to_F0, ..; they bring the parts that they use. D_Charlie is then the viewer's. */
    FACET_SHADER_NAMES_KHRONOS
} facet_shader_names;

/* {0}: all parts. */
typedef struct facet_shader_desc {
    facet_allocator allocator;
    /* A line "#version ..": "300 es" to "320 es", "330" to "460", also "330 core"; NULL: no such line. */
    const char *version;
    /* names of facet_shader_get_part_name(); the parts that they depend on are added */
    const char *const *parts;
    uint32_t part_count; /* 0: all; with FACET_SHADER_NAMES_KHRONOS those that these names use */
    facet_shader_names names;
} facet_shader_desc;

/* Functions, structures and macros without main(), to be put before the text of any shader stage. Release
 * with facet_bytes_destroy(); a 0 follows the bytes and is not counted. desc NULL: {0}.
 * FACET_ERROR_ARGUMENT, _MEMORY. */
FACET_API facet_result facet_shader_text(const facet_shader_desc *desc, unsigned char **bytes, size_t *size,
                                         facet_error *error);

/* Parts, such as "fresnel"; NULL past the end. */
FACET_API uint32_t facet_shader_get_part_count(void);
FACET_API const char *facet_shader_get_part_name(uint32_t index);

#ifdef __cplusplus
}
#endif

#endif
