/* dfg_integrate.h - directional albedos of reflection lobes by quadrature: what tables of them are made of, those that are
 * computed when facet is built and those that are baked. */
#ifndef IBL_DFG_INTEGRATE_H
#define IBL_DFG_INTEGRATE_H

/* Masking and shadowing of GGX (shade/brdf.h). */
typedef enum dfg_masking {
    DFG_SMITH_CORRELATED, /* V_SmithGGX */
    DFG_SMITH_SEPARABLE,  /* V_SmithGGX_separable */
    DFG_SCHLICK_IBL,      /* V_SchlickGGX with k_ibl */
    DFG_SCHLICK_DIRECT /* with k_direct: not for image based light; what to compare a table with that is too dark */
} dfg_masking;

/* The split sum: reflectance = F0 scale + F90 bias; their sum is the albedo for F = 1. */
typedef struct dfg_terms {
    double scale, bias;
} dfg_terms;

/* NdotV in [0, 1], taken as NDOTV_MIN below that; perceptual_roughness in [0, 1], 0 is a mirror. Within 2e-6. */
dfg_terms dfg_integrate(dfg_masking masking, float perceptual_roughness, double NdotV);

/* The albedo for F = 1 averaged over the cosine, Eavg = 2 int E mu dmu. Within 1e-5. */
double dfg_integrate_average(dfg_masking masking, float perceptual_roughness);

/* What albedos of sheen of one roughness have in common: nodes of N.L, and D as a table, because powers are most of the work. */
enum { SHEEN_NODES = 72, SHEEN_TABLE = 4096 };
typedef struct sheen_nodes {
    float alpha; /* 0: roughness 0, a rim without width, which reflects nothing */
    float NdotL[SHEEN_NODES], weight[SHEEN_NODES];
    float Lambda[SHEEN_NODES]; /* Lambda_Charlie() of NdotL */
    float least_sine, D_scale; /* entry of the table: (sin(N, H) - least_sine) D_scale */
    float D[SHEEN_TABLE + 2];  /* D_Charlie(); below entry 0 it is less than 1e-10 of its largest */
} sheen_nodes;
void sheen_prepare(float sheen_roughness, sheen_nodes *out);

/* E = int D_Charlie V N.L dL for sheen of color 1. */
typedef struct sheen_albedos {
    double charlie; /* V_Charlie */
    double neubelt; /* V_Neubelt */
} sheen_albedos;

/* NdotV as above. Not clamped: above 1 where the model is. Within 1e-5, or 1e-4 of what is above 4, smooth rims at grazing
 * views. */
sheen_albedos sheen_integrate(const sheen_nodes *nodes, double NdotV);

#endif
