/* gltf_components.h - the components of accessors: sizes and values. */
#ifndef IO_GLTF_COMPONENTS_H
#define IO_GLTF_COMPONENTS_H

#include "io/gltf/gltf_reader.h"

size_t gltf_component_size(gltf_component component); /* bytes */
/* Whether components are floating-point numbers of any size. */
bool gltf_is_float(gltf_component component);

/* Little-endian loads from unaligned addresses. */
static inline uint16_t gltf_load_u16(const unsigned char *p)
{
    return (uint16_t)(p[0] | p[1] << 8);
}

static inline uint32_t gltf_load_u32(const unsigned char *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

double gltf_load_f64(const unsigned char *p);
/* An unsigned component that is not normalized. */
uint32_t gltf_load_unsigned(const unsigned char *p, gltf_component component);
/* Converts components in order. The compiler turns each case into a loop. */
void gltf_convert_components(const unsigned char *in, gltf_component component, bool is_normalized,
                             size_t count, float *out);

#endif
