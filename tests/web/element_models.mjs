// element_models.mjs - small models for element.mjs, as text of glTF.

// A box of 1 x 2 x 3 m around (0, 1, 0), gray; two animations (it rises by 1 m in 1 s; it moves aside in 0.5 s) and two variants.
export function box_model() {
    const half = [0.5, 1, 1.5], places = [], normals = [];
    for (let axis = 0; axis < 3; axis++)
        for (const sign of [-1, 1]) {
            const normal = [0, 0, 0];
            normal[axis] = sign;
            const [a, b] = [(axis + 1) % 3, (axis + 2) % 3];
            for (const [u, v] of [[-1, -1], [1, -1], [1, 1], [-1, -1], [1, 1], [-1, 1]]) {
                const place = [0, 0, 0];
                place[axis] = sign * half[axis];
                place[a] = sign * u * half[a];
                place[b] = v * half[b];
                places.push(...place);
                normals.push(...normal);
            }
        }
    const floats = Buffer.from(Float32Array.from([...places, ...normals, 0, 1, 0, 1, 0, 0, 2, 0, 0, 0.5, 0, 1, 0, 1, 1, 0]).buffer);
    const material = (name, color) => ({ name, pbrMetallicRoughness: { baseColorFactor: color, metallicFactor: 0, roughnessFactor: 0.8 } });
    const animation = (name, input, output) => ({
        name, samplers: [{ input, output }], channels: [{ sampler: 0, target: { node: 0, path: 'translation' } }],
    });
    return JSON.stringify({
        asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0, translation: [0, 1, 0] }],
        extensionsUsed: ['KHR_materials_variants'],
        extensions: { KHR_materials_variants: { variants: [{ name: 'red' }, { name: 'blue' }] } },
        meshes: [{
            primitives: [{
                attributes: { POSITION: 0, NORMAL: 1 }, material: 0,
                extensions: { KHR_materials_variants: { mappings: [{ material: 1, variants: [0] }, { material: 2, variants: [1] }] } },
            }],
        }],
        materials: [material('gray', [0.5, 0.5, 0.5, 1]), material('red', [1, 0, 0, 1]), material('blue', [0, 0, 1, 1])],
        animations: [animation('rise', 2, 3), animation('aside', 4, 5)],
        accessors: [
            { bufferView: 0, componentType: 5126, count: 36, type: 'VEC3', min: half.map((x) => -x), max: half },
            { bufferView: 0, byteOffset: 432, componentType: 5126, count: 36, type: 'VEC3' },
            { bufferView: 0, byteOffset: 864, componentType: 5126, count: 2, type: 'SCALAR', min: [0], max: [1] },
            { bufferView: 0, byteOffset: 872, componentType: 5126, count: 2, type: 'VEC3' },
            { bufferView: 0, byteOffset: 896, componentType: 5126, count: 2, type: 'SCALAR', min: [0], max: [0.5] },
            { bufferView: 0, byteOffset: 904, componentType: 5126, count: 2, type: 'VEC3' },
        ],
        bufferViews: [{ buffer: 0, byteLength: floats.length }],
        buffers: [{ byteLength: floats.length, uri: `data:application/octet-stream;base64,${floats.toString('base64')}` }],
    });
}
