/* dfg.c - lookups in the LUTs of directional albedo. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "ibl/dfg.h"
#include "ibl/ibl.h"

#include "shade/shade.h"

/* Index of the node of a LUT of size nodes at or before x in [0, 1], and the fraction to the next one. */
typedef struct table_place {
    int first;
    float weight;
} table_place;

static inline table_place find_place(float x, int size)
{
    float node = (x > 0.0f ? x : 0.0f) * (float)(size - 1);
    node = node < (float)(size - 1) ? node : (float)(size - 1);
    int first = node < (float)(size - 2) ? (int)node : size - 2;
    return (table_place){first, node - (float)first};
}

void ibl_dfg(float NdotV, float perceptual_roughness, float out[2])
{
    table_place x = find_place(sqrtf(NdotV > 0.0f ? NdotV : 0.0f), DFG_SIZE);
    table_place y = find_place(perceptual_roughness, DFG_SIZE);
    const float *low = ibl_dfg_nodes() + 2 * (y.first * DFG_SIZE + x.first);
    const float *high = low + 2 * DFG_SIZE;
    for (int i = 0; i < 2; i++) {
        float a = low[i] + (low[i + 2] - low[i]) * x.weight;
        float b = high[i] + (high[i + 2] - high[i]) * x.weight;
        out[i] = a + (b - a) * y.weight;
    }
}

float ibl_sheen_albedo(float NdotV, float sheen_roughness)
{
    table_place x = find_place(sqrtf(NdotV > 0.0f ? NdotV : 0.0f), SHEEN_SIZE);
    table_place y = find_place(sheen_roughness, SHEEN_SIZE);
    const float *low = ibl_sheen_nodes() + y.first * SHEEN_SIZE + x.first;
    const float *high = low + SHEEN_SIZE;
    float a = low[0] + (low[1] - low[0]) * x.weight;
    float b = high[0] + (high[1] - high[0]) * x.weight;
    return a + (b - a) * y.weight;
}

/* Bilinear in one layer of the glass LUT. */
static void glass_layer(int layer, table_place x, table_place y, float out[3])
{
    const uint16_t *low =
        ibl_glass_nodes() + (size_t)(((layer * GLASS_SIZE + y.first) * GLASS_SIZE + x.first) * 3);
    const uint16_t *high = low + (size_t)GLASS_SIZE * 3;
    for (int i = 0; i < 3; i++) {
        float a = (float)low[i] + (float)(low[i + 3] - low[i]) * x.weight;
        float b = (float)high[i] + (float)(high[i + 3] - high[i]) * x.weight;
        out[i] = (a + (b - a) * y.weight) * (1.0f / GLASS_UNIT);
    }
}

void ibl_glass(float NdotV, float perceptual_roughness, float eta, float out[3])
{
    float root = fabsf(eta - 1.0f) / (eta + 1.0f);
    table_place x = find_place(sqrtf(NdotV > 0.0f ? NdotV : 0.0f), GLASS_SIZE);
    table_place y = find_place(perceptual_roughness, GLASS_SIZE);
    table_place z = find_place(sqrtf(root / GLASS_ROOT_MAX), GLASS_IORS);
    int layer = z.first + (eta < 1.0f ? GLASS_IORS : 0);
    float near[3];
    float far[3];
    glass_layer(layer, x, y, near);
    glass_layer(layer + 1, x, y, far);
    for (int i = 0; i < 3; i++)
        out[i] = near[i] + (far[i] - near[i]) * z.weight;
}
