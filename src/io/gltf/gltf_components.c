/* gltf_components.c - the components of accessors: their sizes, and their values as floats or indices (glTF 2.0
 * sections 3.6.2.2 and 3.11; KHR_accessor_float64, KHR_accessor_float16). */
#include "io/gltf/gltf_components.h"

#include <string.h>

#include "image/half.h"

size_t gltf_component_size(gltf_component component)
{
    switch (component) {
    case GLTF_I8:
    case GLTF_U8:
        return 1;
    case GLTF_I16:
    case GLTF_U16:
    case GLTF_F16:
        return 2;
    case GLTF_F64:
        return 8;
    default:
        return 4;
    }
}

bool gltf_is_float(gltf_component component)
{
    return component == GLTF_F32 || component == GLTF_F64 || component == GLTF_F16;
}

double gltf_load_f64(const unsigned char *p)
{
    const uint64_t bits = (uint64_t)gltf_load_u32(p) | (uint64_t)gltf_load_u32(p + 4) << 32;
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

uint32_t gltf_load_unsigned(const unsigned char *p, gltf_component component)
{
    return component == GLTF_U8 ? p[0] : component == GLTF_U16 ? gltf_load_u16(p) : gltf_load_u32(p);
}

void gltf_convert_components(const unsigned char *in, gltf_component component, bool is_normalized,
                             size_t count, float *out)
{
    switch (component) {
    case GLTF_I8:
        for (size_t i = 0; i < count; i++) {
            float value = (float)(int8_t)in[i];
            out[i] = !is_normalized ? value : value < -127.0f ? -1.0f : value / 127.0f;
        }
        break;
    case GLTF_U8:
        for (size_t i = 0; i < count; i++)
            out[i] = is_normalized ? (float)in[i] / 255.0f : (float)in[i];
        break;
    case GLTF_I16:
        for (size_t i = 0; i < count; i++) {
            float value = (float)(int16_t)gltf_load_u16(in + 2 * i);
            out[i] = !is_normalized ? value : value < -32767.0f ? -1.0f : value / 32767.0f;
        }
        break;
    case GLTF_U16:
        for (size_t i = 0; i < count; i++) {
            float value = (float)gltf_load_u16(in + 2 * i);
            out[i] = is_normalized ? value / 65535.0f : value;
        }
        break;
    case GLTF_U32:
        for (size_t i = 0; i < count; i++)
            out[i] = (float)gltf_load_u32(in + 4 * i);
        break;
    case GLTF_F32:
        for (size_t i = 0; i < count; i++) {
            uint32_t bits = gltf_load_u32(in + 4 * i);
            memcpy(&out[i], &bits, sizeof bits);
        }
        break;
    case GLTF_F64:
        for (size_t i = 0; i < count; i++)
            out[i] = (float)gltf_load_f64(in + 8 * i);
        break;
    case GLTF_F16:
        for (size_t i = 0; i < count; i++)
            out[i] = half_to_float(gltf_load_u16(in + 2 * i));
        break;
    }
}
