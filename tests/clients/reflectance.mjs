// reflectance.mjs - what tables of reflectance hold, by the midpoint rule in double: nothing of it is facet's. N.V and perceptual
// roughness go in, the channels come out.
const grid = (rows, columns, add) => {
    let sums = [];
    for (let i = 0; i < rows; i++)
        for (let k = 0; k < columns; k++)
            sums = add((i + 0.5) / rows, (k + 0.5) / columns).map((x, c) => x + (sums[c] ?? 0));
    return sums.map((x) => x / (rows * columns));
};

// Scale and bias of F0: the integrals of (1 - Fc) D V N.L and of Fc D V N.L over directions of light, Fc = (1 - V.H)^5, with
// GGX for D. visibility(alpha, NdotV, NdotL): G / (4 N.L N.V).
function scale_and_bias(NdotV, perceptual_roughness, visibility) {
    const alpha2 = perceptual_roughness ** 4, alpha = Math.sqrt(alpha2), V = [Math.sqrt(1 - NdotV ** 2), NdotV];
    return grid(200, 200, (u, v) => {
        const NdotL = u * u, s = Math.sqrt(1 - NdotL ** 2), phi = Math.PI * v; // N.L = u^2: closer where light grazes
        const VdotL = V[0] * s * Math.cos(phi) + V[1] * NdotL, length = Math.sqrt(2 + 2 * VdotL);
        const NdotH = (NdotV + NdotL) / length, Fc = (1 - length / 2) ** 5;
        const D = alpha2 / (Math.PI * (NdotH * NdotH * (alpha2 - 1) + 1) ** 2);
        const f = D * visibility(alpha, NdotV, NdotL) * NdotL * 2 * Math.PI * 2 * u;
        return [(1 - Fc) * f, Fc * f];
    });
}
// Heitz 2014, equation 99, over 4 N.L N.V.
const correlated = (alpha, v, l) => {
    const part = (x, y) => x * Math.sqrt(y * y * (1 - alpha * alpha) + alpha * alpha);
    return 0.5 / (part(l, v) + part(v, l));
};
const schlick = (alpha, v, l) => {
    const k = alpha / 2, part = (x) => 1 / (x * (1 - k) + k);
    return part(v) * part(l) / 4;
};

// The albedo of sheen: the integral of D V N.L over directions of light, D of Charlie (Estevez and Kulla 2017).
function sheen_albedo(NdotV, perceptual_roughness, visibility) {
    const alpha = perceptual_roughness ** 2, sin_v = Math.sqrt(1 - NdotV ** 2);
    return grid(400, 200, (u, v) => {
        const NdotL = u * u, VdotL = sin_v * Math.sqrt(1 - NdotL ** 2) * Math.cos(Math.PI * v) + NdotV * NdotL;
        const NdotH2 = (NdotV + NdotL) ** 2 / (2 + 2 * VdotL);
        const D = (2 + 1 / alpha) * Math.max(1 - NdotH2, 0) ** (0.5 / alpha) / (2 * Math.PI);
        return [D * visibility(alpha, NdotV, NdotL) * NdotL * 2 * Math.PI * 2 * u];
    });
}
const lambda = (x, alpha) => {
    const w = (1 - alpha) ** 2, at = (rough, smooth) => rough + (smooth - rough) * w;
    const L = (y) => at(21.5473, 25.3245) / (1 + at(3.82987, 3.32435) * y ** at(0.19823, 0.16801)) +
        at(-1.97760, -1.27393) * y + at(-4.32054, -4.85967);
    return Math.exp(x < 0.5 ? L(x) : 2 * L(0.5) - L(1 - x));
};
const charlie = (alpha, v, l) => 1 / ((1 + lambda(v, alpha) + lambda(l, alpha)) * 4 * v * l);
const neubelt = (alpha, v, l) => 1 / (4 * (l + v - l * v));

const multiscatter = (v, r) => {
    const [scale, bias] = scale_and_bias(v, r, correlated);
    return [bias, scale + bias];
};
export const tables = {
    ggx: (v, r) => scale_and_bias(v, r, correlated),
    schlick: (v, r) => scale_and_bias(v, r, schlick),
    multiscatter,
    charlie: (v, r) => sheen_albedo(v, r, charlie),
    'charlie-neubelt': (v, r) => sheen_albedo(v, r, neubelt),
    average: (v, r) => {
        let sum = 0;
        for (let i = 0; i < 32; i++) {
            const mu = (i + 0.5) / 32;
            sum += 2 * mu * multiscatter(mu, r)[1] / 32;
        }
        return [sum];
    },
    filament: (v, r) => [...multiscatter(v, r), ...sheen_albedo(v, r, neubelt)],
};
