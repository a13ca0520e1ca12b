// filament_page.mjs - what filament.html does for filament.mjs: Filament's web build (WebAssembly, WebGL 2) with the image
// based lights that facet bake --layout filament writes, on spheres that its gltfio loads.
let Filament;
const canvas = document.getElementById('canvas');

// Draws count spheres in a row, size pixels each, seen from yaw (rad) around the middle one, in the light of ibl, a file of KTX;
// has_harmonics: with what it says under "sh", else with what Filament takes in their place, the roughest level. With sky, a
// file of KTX, instead that sky in a square of count x size pixels, 90 degrees wide. turn: of the light around +Y (rad). Filament
// maps tones and encodes as sRGB. Returns the picture as RGBA bytes, rows from the top.
window.draw = async ({ model, ibl, sky, has_harmonics, count, size, yaw, intensity, tone_mapping = 'LINEAR', turn = 0, clear = 0 }) => {
    canvas.width = count * size;
    canvas.height = sky ? count * size : size;
    const fetched = async (name) => new Uint8Array(await (await fetch(`/work/${name}`)).arrayBuffer());
    const engine = Filament.Engine.create(canvas, { preserveDrawingBuffer: true, antialias: false });
    const scene = engine.createScene(), view = engine.createView(), renderer = engine.createRenderer();
    const chain = engine.createSwapChain(), eye = Filament.EntityManager.get().create(), camera = engine.createCamera(eye);
    view.setScene(scene);
    view.setCamera(camera);
    view.setViewport([0, 0, canvas.width, canvas.height]);
    view.setColorGrading(Filament.ColorGrading.Builder().toneMapping(Filament.ColorGrading$ToneMapping[tone_mapping])
        .quality(Filament.ColorGrading$QualityLevel.ULTRA).build(engine));
    view.setAntiAliasing(Filament['View$AntiAliasing'].NONE);
    renderer.setClearOptions({ clearColor: [clear, clear, clear, 1], clear: true });
    const from_ktx = engine.createIblFromKtx1(await fetched(ibl));
    const texture = from_ktx.getReflectionsTexture();
    const builder = Filament.IndirectLight.Builder().reflections(texture).intensity(intensity);
    builder.rotation([Math.cos(turn), 0, -Math.sin(turn), 0, 1, 0, Math.sin(turn), 0, Math.cos(turn)]);
    if (has_harmonics) builder.irradianceSh(3, from_ktx.shfloats);
    scene.setIndirectLight(builder.build(engine));
    if (sky) scene.setSkybox(engine.createSkyFromKtx1(await fetched(sky)));
    const sin = Math.sin(yaw), cos = Math.cos(yaw);
    if (sky) {
        camera.setProjectionFov(90, 1, 0.1, 100, Filament.Camera$Fov.VERTICAL);
        camera.lookAt([0, 0, 0], [-sin, 0, -cos], [0, 1, 0]);
    } else {
        const asset = engine.createAssetLoader().createAsset(await fetched(model));
        await new Promise((resolve) => asset.loadResources(resolve, null, '', null));
        scene.addEntities(asset.getEntities());
        const middle = (count - 1) / 2, distance = 100;
        camera.setProjection(Filament.Camera$Projection.ORTHO, -count / 2, count / 2, -0.5, 0.5, 1, 200);
        camera.lookAt([middle + distance * sin, 0, distance * cos], [middle, 0, 0], [0, 1, 0]);
    }
    camera.setExposureDirect(1);
    const pixels = document.createElement('canvas');
    pixels.width = canvas.width;
    pixels.height = canvas.height;
    const context = pixels.getContext('2d');
    for (let i = 0; i < 6; i++) { // the first frames wait for textures and programs
        renderer.render(chain, view);
        engine.execute();
        context.drawImage(canvas, 0, 0);
        await new Promise(requestAnimationFrame);
    }
    const { data } = context.getImageData(0, 0, pixels.width, pixels.height);
    const sh = [...from_ktx.shfloats], levels = texture.getLevels(engine), width = texture.getWidth(engine);
    const url = pixels.toDataURL('image/png');
    Filament.Engine.destroy(engine);
    return { pixels: [...data], height: pixels.height, url, sh, levels, width };
};
try {
    window.Filament.init([], () => { // replaces window.Filament
        Filament = window.Filament;
        window.ready = true;
    });
} catch (error) {
    window.failure = String(error.stack ?? error);
}
