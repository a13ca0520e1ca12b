/* layers_sample.h - the layered surface for paths: one lobe is chosen, a direction is drawn from it, and the density is
 * that of all lobes together (one-sample multiple importance sampling, Veach 1997, section 9.2.4), so that
 *     f |N.L| / pdf
 * is right whatever the probabilities, as long as none is 0 where its lobe is not. */
#ifndef SHADE_LAYERS_SAMPLE_H
#define SHADE_LAYERS_SAMPLE_H

/* Probabilities of the lobes; they add up to 1, or are all 0 where the surface sends nothing to V. */
STRUCT(LayersLobes)
{
    float clearcoat;
    float sheen;
    float specular; /* reflection at the base's boundary, of dielectric and metal */
    float diffuse;
    float transmission; /* specular, through a thin wall or a volume's boundary */
    float diffuse_back;
};

/* A direction to go on in. */
STRUCT(LayersSample)
{
    vec3 L;    /* unit */
    float pdf; /* per sr, of all lobes that are not mirrors; of a mirror 0 */
    vec3
        weight; /* of a mirror: f |N.L| / pdf, with the probability of its choice in it; else not to be read */
    bool
        is_mirror; /* the lobe is too narrow to be evaluated: no other way of finding L has a density for it */
    bool is_through; /* L is on the other side of the surface */
    bool is_valid;   /* false: the path ends here */
};

FN LayersLobes layers_lobes(Layers m, vec3 V, int energy, LayerTables t)
{
    LayersLobes p;
    p.clearcoat = 0.0f;
    p.sheen = 0.0f;
    p.specular = 0.0f;
    p.diffuse = sel(energy >= 0 && t.dfg[0] >= 0.0f && dot(m.base.N, V) >= -2.0f, 1.0f, 0.0f);
    p.transmission = 0.0f;
    p.diffuse_back = 0.0f;
    return p;
}

/* L for u_lobe and u, uniform in [0, 1). A surface that disperses (LAYER_DISPERSION) is to be given one ior first:
 * layers_with_wavelength(). */
FN LayersSample layers_sample(Layers m, LayersLobes p, vec3 V, float u_lobe, vec2 u, int energy,
                              LayerTables t)
{
    LayersSample s;
    s.L = mul(basis_from_normal(m.base.N), sample_cosine(u));
    s.pdf = pdf_cosine(dot(m.base.N, s.L));
    s.weight = vec3(p.diffuse * u_lobe * t.dfg[0] * float(energy) * V[0]);
    s.is_mirror = false;
    s.is_through = false;
    s.is_valid = s.pdf > 0.0f;
    return s;
}

/* Density per sr with which layers_sample() draws L by lobes that are not mirrors. */
FN float layers_pdf(Layers m, LayersLobes p, vec3 V, vec3 L)
{
    return pdf_cosine(dot(m.base.N, L)) * sel(dot(m.base.N, V) > -2.0f, p.diffuse, 1.0f);
}

/* layers_brdf_cos() of all lobes that are not mirrors: what layers_pdf() is the density for. */
FN vec3 layers_scatter_cos(Layers m, vec3 V, vec3 L, int energy, LayerTables t, float sheen_E_L)
{
    return layers_brdf_cos(m, V, L, energy, t, sheen_E_L);
}

#endif
