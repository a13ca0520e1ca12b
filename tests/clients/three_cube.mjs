// three_cube.mjs - cube maps of facet bake in three.js, whose KTX2Loader makes 2D textures of all uncompressed KTX2 files: it
// parses and inflates the file, but does not look at its faces (three.js 0.187; pull request 26642). docs/bake.md shows
// this to users.
import { CompressedCubeTexture, CubeTexture, DataTexture, LinearFilter, LinearMipmapLinearFilter, NoColorSpace, RGBAFormat } from 'three';

// texture: of KTX2Loader, from a file of a cube map. Returns the cube map with its levels.
export function cube_of(texture) {
    const levels = texture.mipmaps, { format, type } = texture;
    const face_of = ({ data, width, height }, face) => {
        const count = data.length / 6;
        return { data: data.subarray(face * count, (face + 1) * count), width, height };
    };
    const faces = [0, 1, 2, 3, 4, 5];
    let cube;
    if (format === RGBAFormat) { // faces that hold their levels
        cube = new CompressedCubeTexture(faces.map((face) => {
            const mipmaps = levels.map((level) => face_of(level, face));
            return { mipmaps, width: mipmaps[0].width, height: mipmaps[0].height };
        }), format, type);
    } else { // levels that hold their faces: CompressedCubeTexture would take other formats for blocks
        const pictures = (level) => faces.map((face) => {
            const { data, width, height } = face_of(level, face);
            return new DataTexture(data, width, height, format, type);
        });
        cube = new CubeTexture(pictures(levels[0]));
        cube.format = format;
        cube.type = type;
        cube.mipmaps = levels.slice(1).map((level) => ({ image: pictures(level) }));
        cube.flipY = false;
    }
    cube.colorSpace = NoColorSpace;
    cube.magFilter = LinearFilter;
    cube.minFilter = levels.length > 1 ? LinearMipmapLinearFilter : LinearFilter;
    cube.generateMipmaps = false;
    cube.needsUpdate = true;
    return cube;
}

// The same as scene.environment, without filtering in the browser: baked with --size 256 --mips 6 --mapping filament, which
// are the levels that PMREMGenerator makes since r187. is_mirrored: pmrem.ktx2 of --layout three. three.js looks cube maps
// of files up with x negated, others as OpenGL does.
export function environment_of(texture, is_mirrored) {
    const cube = cube_of(texture);
    cube.isPMREMTexture = true;
    cube.isRenderTargetTexture = !is_mirrored;
    return cube;
}
