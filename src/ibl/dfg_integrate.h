/* dfg_integrate.h - directional albedos of reflection lobes by quadrature, for the LUTs that are computed
 * when facet is built and those that are baked. */
#ifndef IBL_DFG_INTEGRATE_H
#define IBL_DFG_INTEGRATE_H

/* Masking and shadowing of GGX (shade/brdf.h). */
typedef enum dfg_masking {
    DFG_SMITH_CORRELATED, /* V_SmithGGX */
    DFG_SMITH_SEPARABLE,  /* V_SmithGGX_separable */
    DFG_SCHLICK_IBL,      /* V_SchlickGGX with k_ibl */
    DFG_SCHLICK_DIRECT /* with k_direct, which is not for image-based light: identifies LUTs that are too dark */
} dfg_masking;

/* The split sum: reflectance = F0 scale + F90 bias; their sum is the albedo for F = 1. */
typedef struct dfg_terms {
    double scale, bias;
} dfg_terms;

/* NdotV in [0, 1], clamped to NDOTV_MIN; perceptual_roughness in [0, 1], 0 is a mirror. Error below 2e-6. */
dfg_terms dfg_integrate(dfg_masking masking, float perceptual_roughness, double NdotV);

/* Average albedo for F = 1, Eavg = 2 int E mu dmu. Error below 1e-5. */
double dfg_integrate_average(dfg_masking masking, float perceptual_roughness);

/* Shared by the albedos of sheen of one roughness: nodes of N.L, and D as a table, because powers dominate
 * the cost. */
enum { SHEEN_NODES = 72, SHEEN_TABLE = 4096 };
typedef struct sheen_nodes {
    float alpha; /* 0: roughness 0, a rim without width, which reflects nothing */
    float NdotL[SHEEN_NODES], weight[SHEEN_NODES];
    float Lambda[SHEEN_NODES]; /* Lambda_Charlie() of NdotL */
    float least_sine, D_scale; /* entry of the table: (sin(N, H) - least_sine) D_scale */
    float D[SHEEN_TABLE + 2];  /* D_Charlie(); below entry 0 it is less than 1e-10 of its maximum */
} sheen_nodes;
void sheen_prepare(float sheen_roughness, sheen_nodes *out);

/* E = int D_Charlie V N.L dL for sheen of color 1. */
typedef struct sheen_albedos {
    double charlie; /* V_Charlie */
    double neubelt; /* V_Neubelt */
} sheen_albedos;

/* NdotV as above. Not clamped: the model exceeds 1 for smooth rims. Error below 1e-5, or 1e-4 relative above
 * 4, at smooth rims and grazing views. */
sheen_albedos sheen_integrate(const sheen_nodes *nodes, double NdotV);

#endif
