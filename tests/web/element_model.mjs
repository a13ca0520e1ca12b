// element_model.mjs - element.mjs: light, animations, hotspots, images, files, materials.

// tools: see element.mjs
export const cases = ({ page, check, equal, near, requests }) => ({
    async 'light, exposure and background'() {
        const found = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf' });
            await event(viewer, 'load');
            const of = async (change) => { Object.assign(viewer, change); await viewer.updateComplete; await frames(); return image(viewer); };
            const plain = await of({});
            const bright = await of({ exposure: 2 });
            const tone = await of({ exposure: 1, toneMapping: 'aces' });
            const linear = await of({ toneMapping: 'auto' });
            await event(viewer, 'environment-change', () => { viewer.environmentImage = '#ff0000'; });
            const red = await of({});
            await event(viewer, 'environment-change', () => { viewer.skyboxImage = 'sun:45,135'; });
            const sky = await of({});
            await event(viewer, 'environment-change', () => { viewer.environmentImage = null; viewer.skyboxImage = null; });
            const again = await of({});
            const ground = await of({ shadowIntensity: 1 });
            const normal = await of({ shadowIntensity: 0, facetChannel: 'normal' });
            await event(viewer, 'environment-change', () => { viewer.facetChannel = null; viewer.environmentImage = 'blue.hdr'; });
            const blue = await of({});
            await event(viewer, 'load', async () => { viewer.src = null; await viewer.updateComplete; viewer.src = 'box.gltf'; });
            const still = await of({});
            return { plain, bright, tone, linear, red, sky, again, ground, normal, blue, still };
        });
        const light = ({ color }) => color[0] + color[1] + color[2];
        check(light(found.bright) > 1.2 * light(found.plain), 'exposure');
        check(found.tone.hash !== found.plain.hash && found.linear.hash === found.plain.hash, 'tone-mapping');
        check(found.red.color[0] > 3 * found.red.color[1], `a red environment gives ${found.red.color}`);
        equal(found.sky.covered, 1, 'a skybox is not seen');
        equal(found.again.hash, found.plain.hash, 'the light does not come back');
        check(found.ground.hash !== found.plain.hash, 'shadow-intensity');
        check(found.normal.hash !== found.plain.hash, 'facet-channel');
        check(found.blue.color[2] > 3 * found.blue.color[0], `a blue panorama gives ${found.blue.color}`);
        equal(found.still.hash, found.blue.hash, 'the light of a file is lost with the model');
    },

    async 'the light of a file stays for every model'() {
        const found = await page.evaluate(async () => {
            await clear();
            const blob = async (name) => (await fetch(name)).blob(), sky = await blob('blue.hdr'), box = await blob('box.gltf');
            const viewer = make({ 'environment-image': 'blue.hdr', loading: 'eager' }), colors = [];
            const look = async () => { await frames(); colors.push((await image(viewer)).color); };
            await event(viewer, 'environment-change'); // before there is a model
            await event(viewer, 'load', () => { viewer.src = 'box.gltf'; });
            await look();
            await viewer.openFiles([{ path: 'room.hdr', file: sky }]);
            await viewer.openFiles([{ path: 'a.gltf', file: box }]);
            await look();
            const bad = await viewer.openFiles([{ path: 'bad.gltf', file: new Blob(['{']) }]).then(() => '', (error) => error.message);
            colors.push((await image(viewer)).color);
            const kept = [viewer.modelPath, /room\.hdr/.test(viewer.command())];
            await viewer.setOption('shading', 'ogl1');
            await viewer.setOption('shading', null);
            await look();
            await viewer.openFiles([{ path: 'b.obj', file: new Blob(['v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n']) }]);
            await look();
            await viewer.openModel('');
            await look();
            return { colors, bad, kept, errors: viewer.log.filter(([type]) => type === 'error'), seconds: viewer.renderInfo.seconds };
        });
        for (const color of found.colors) check(color[2] > 1.5 * color[0], `a blue panorama gives ${JSON.stringify(found.colors)}`);
        check(/bad\.gltf/.test(found.bad), `a broken model: "${found.bad}"`);
        equal(found.kept, ['a.gltf', true], 'the last model does not stay');
        equal(found.errors, []);
        check(found.seconds > 0, 'the time of a frame');
    },

    async 'the model that was asked for last is shown'() {
        const found = await page.evaluate(async () => {
            await clear();
            const box = await (await fetch('box.gltf')).blob(), viewer = make({ src: 'box.gltf' }), say = (error) => error.name;
            await event(viewer, 'load');
            const slow = { arrayBuffer: async () => { await new Promise((resolve) => setTimeout(resolve, 300)); return box.arrayBuffer(); } };
            const first = viewer.openFiles([{ path: 'slow.gltf', file: slow }]).catch(say), second = viewer.openFiles([{ path: 'fast.gltf', file: box }]);
            const race = [await first, await second, viewer.modelPath];
            await event(viewer, 'load', () => { viewer.src = 'box.gltf'; }); // the same address, after a drop
            const back = viewer.modelPath, errors = [];
            for (let i = 0; i < 2; i++) errors.push((await event(viewer, 'error', () => { viewer.src = 'broken.glb'; })).type, viewer.loaded, viewer.modelPath);
            await event(viewer, 'load', () => { viewer.src = 'box.gltf'; });
            viewer.src = 'box.gltf?late'; // aborted by the drop
            await viewer.openFiles([{ path: 'dropped.gltf', file: box }]);
            await new Promise((resolve) => setTimeout(resolve, 200));
            return { race, back, errors, last: viewer.modelPath };
        });
        equal(found.race, ['AbortError', ['fast.gltf'], 'fast.gltf']);
        equal(found.back, 'box.gltf');
        equal(found.errors, ['loadfailure', true, 'box.gltf', 'loadfailure', true, 'box.gltf'], 'an address that fails, twice');
        equal(found.last, 'dropped.gltf');
    },

    async 'values and files of any kind stop nothing'() {
        const found = await page.evaluate(async () => {
            await clear();
            const { engine } = await import('./facet-viewer/engine.js'), { fetchModel, fileCache } = await import('./facet-viewer/files.js');
            const viewer = make({ src: 'box.gltf' });
            await event(viewer, 'load');
            await frames();
            const { module } = engine, before = await image(viewer), loop = {};
            loop.loop = loop;
            const say = async (act) => { try { await act(); return ''; } catch (error) { return error.message; } };
            const bad = [];
            for (const values of [loop, { roughness: 1n }, null, undefined, 5, Object.create(null, { toJSON: { value() { throw new Error('no'); } } })])
                bad.push(await say(() => viewer.setMaterial(0, values)));
            for (const index of [NaN, 0.5, 4294967296, -1, '0', Object.create(null)]) bad.push(await say(() => viewer.setMaterial(index, {})));
            bad.push(await say(() => viewer.setOption(Object.create(null), '1')), await say(() => viewer.setOption('exposure', Object.create(null))));
            const { View } = await import('./facet-viewer/view.js'), view = new View({ canvas: document.createElement('canvas') }, {});
            view.revive();
            await view.open(viewer.files, viewer.modelPath);
            for (const value of [1, 2]) view.setMaterial(0, JSON.parse(`{"extras": {"__proto__": {"polluted": ${value}}}}`));
            const edit = JSON.stringify(view.edits[0]);
            view.destroy();
            const start = performance.now();
            const models = { 'slow.obj': `mtllib ${' '.repeat(2e5)}\u2028x\nmtllib ${' '.repeat(2e5)}.mtl\n`, 'many.gltf': JSON.stringify({ images: Array(2e5).fill({ uri: 'data:,' }), buffers: [{ uri: 'http://[' }, { uri: 'box.bin' }] }) };
            const original = window.fetch, names = [];
            window.fetch = (url, ...rest) => {
                const name = url.split('/').pop();
                names.push(name);
                return name in models ? Promise.resolve(new Response(models[name])) : name === 'box.bin' ? Promise.resolve(new Response('x')) : original(url, ...rest);
            };
            const many = await fetchModel('many.gltf', { onProgress() {} }), signal = AbortSignal.abort();
            await fetchModel('slow.obj', { onProgress() {} });
            const count = names.length, late = await say(() => fetchModel('late.gltf', { onProgress() {}, signal }));
            const aborted = names.length - count;
            await fetchModel('many.gltf', { onProgress() {}, withCredentials: true });
            const again = names.filter((name) => name === 'many.gltf').length;
            window.fetch = original;
            fileCache.clear();
            return { bad, edit, isSame: engine.module === module && !module.isLost, hash: (await image(viewer)).hash === before.hash, polluted: {}.polluted, spent: performance.now() - start, many: many.map(({ path }) => path), late, aborted, again };
        });
        check(found.bad.every((text) => text.length > 10 && !/stopped/.test(text)), JSON.stringify(found.bad));
        check(found.isSame && found.hash, 'a bad value stops the module or changes the image');
        equal([found.polluted, found.edit, found.many, found.aborted, found.again], [undefined, '{"extras":{"__proto__":{"polluted":2}}}', ['many.gltf', 'box.bin'], 0, 2]);
        check(found.late && found.spent < 3000, `files take ${found.spent} ms`);
    },

    async 'animations and variants'() {
        const found = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf', 'camera-orbit': '90deg 90deg auto' });
            await event(viewer, 'load');
            await frames();
            const rest = await image(viewer);
            const lists = [viewer.availableAnimations, viewer.availableVariants, viewer.paused, viewer.duration];
            viewer.currentTime = 1;
            const high = await image(viewer);
            await event(viewer, 'finished', () => viewer.play({ repetitions: 2, pingpong: true }));
            const after = [viewer.paused, viewer.currentTime, viewer.log.filter(([type]) => type === 'loop').length, viewer.log.filter(([type]) => type === 'play').length];
            viewer.animationName = 'aside';
            viewer.timeScale = 2;
            await viewer.updateComplete;
            const other = viewer.duration;
            viewer.play();
            await event(viewer, 'loop');
            await event(viewer, 'pause', () => viewer.pause());
            const stopped = viewer.currentTime;
            await frames(5);
            const same = viewer.currentTime === stopped;
            viewer.currentTime = 0;
            await event(viewer, 'variant-applied', () => { viewer.variantName = 'red'; });
            const red = await image(viewer);
            await event(viewer, 'variant-applied', () => { viewer.variantName = null; });
            const gray = await image(viewer);
            return { rest, high, lists, after, other, same, red, gray };
        });
        equal(found.lists, [['rise', 'aside'], ['red', 'blue'], true, 1]);
        check(found.high.hash !== found.rest.hash, 'currentTime does not pose');
        equal(found.after, [true, 0, 1, 1], 'play({repetitions: 2, pingpong: true})');
        equal(found.other, 0.5);
        check(found.same, 'pause() does not stop');
        check(found.red.color[0] > 2 * found.red.color[1] && Math.abs(found.gray.color[0] - found.gray.color[1]) < 12, 'variant-name');
    },

    async 'hotspots and points'() {
        const found = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf', 'camera-orbit': '0deg 90deg auto' });
            viewer.innerHTML = '<button slot="hotspot-front" data-position="0 1 1.5" data-normal="0 0 1" data-visibility-attribute="visible">front</button>' +
                '<button slot="hotspot-back" data-position="0m 1m -1.5m" data-normal="0m 0m -1m">back</button>';
            const seen = [];
            for (const button of viewer.children) button.addEventListener('hotspot-visibility', (e) => seen.push([button.slot, e.detail.visible]));
            await event(viewer, 'load');
            await frames(4);
            const box = viewer.getBoundingClientRect(), place = viewer.children[0].getBoundingClientRect();
            const middle = [place.x + place.width / 2 - box.x, place.y + place.height / 2 - box.y];
            const query = viewer.queryHotspot('hotspot-front'), hit = viewer.positionAndNormalFromPoint(box.x + 160, box.y + 120);
            const out = { seen, middle, visible: viewer.children[0].hasAttribute('data-visible'), query: JSON.parse(JSON.stringify(query)), hit: [`${hit.position}`, `${hit.normal}`],
                miss: viewer.positionAndNormalFromPoint(box.x + 2, box.y + 2), surface: viewer.surfaceFromPoint(box.x + 160, box.y + 120), pick: viewer.pick(160, 120) };
            viewer.updateHotspot({ name: 'hotspot-front', position: '0 2 0', normal: '0 1 0' });
            await frames(4);
            out.moved = viewer.children[0].getBoundingClientRect().y - place.y;
            out.hidden = !viewer.children[0].hasAttribute('data-visible');
            viewer.children[1].remove();
            await frames(2);
            out.none = [viewer.queryHotspot('hotspot-back'), viewer.shadowRoot.querySelectorAll('.hotspot').length];
            return out;
        });
        equal(found.seen, [['hotspot-front', true], ['hotspot-back', false], ['hotspot-front', false]]);
        near(found.middle[0], 160, 'x of a hotspot', 0.01);
        near(found.middle[1], 120, 'y of a hotspot', 0.01);
        check(found.visible && found.query.facingCamera, 'the front is visible');
        near(found.query.canvasPosition.x, 160, 'canvasPosition', 1e-3);
        check(/^\S+m 1\.?\d*m 1\.5\d*m$|^\S+m (0\.99|1)\S*m 1\.(5|49)\S*m$/.test(found.hit[0]), `hit at ${found.hit[0]}`);
        near(found.pick.normal[2], 1, 'normal', 1e-2);
        equal(found.pick.material, 0);
        equal(found.miss, null);
        equal(found.surface.split(' ').length, 6);
        check(found.moved < -20 && found.hidden, 'updateHotspot');
        equal(found.none, [null, 1]);
    },

    async 'images'() {
        const found = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf' });
            await event(viewer, 'load');
            const size = async (blob) => { const bitmap = await createImageBitmap(blob); return [blob.type, bitmap.width, bitmap.height]; };
            return {
                shot: await size(await viewer.screenshot({ width: 200, height: 100 })), half: await size(await viewer.screenshot({ width: 160 })),
                jpeg: await size(await viewer.toBlob({ mimeType: 'image/jpeg', qualityArgument: 0.5 })), ideal: await size(await viewer.toBlob({ idealAspect: true })), aspect: viewer.getIdealAspect(),
            };
        });
        equal(found.shot, ['image/png', 200, 100]);
        equal(found.half, ['image/png', 160, 120]);
        equal(found.jpeg, ['image/jpeg', 320, 240]);
        near(found.ideal[1] / found.ideal[2], found.aspect, 'idealAspect', 0.02);
    },

    async 'files, options and commands'() {
        const found = await page.evaluate(async () => {
            await clear();
            const text = await (await fetch('box.gltf')).text(), gltf = JSON.parse(text);
            const bytes = Uint8Array.from(atob(gltf.buffers[0].uri.split(',')[1]), (c) => c.charCodeAt(0));
            gltf.buffers[0].uri = 'data/the%20box.bin';
            const viewer = make({}, [320, 240]);
            const list = await viewer.openFiles([{ path: 'a/box.gltf', file: new Blob([JSON.stringify(gltf)]) }, { path: 'a/data/the box.bin', file: new Blob([bytes]) },
                { path: 'b.gltf', file: new Blob([text]) }, { path: 'note.txt', file: new Blob(['x']) }]);
            await frames();
            const first = await image(viewer), path = viewer.modelPath;
            await viewer.openModel('b.gltf');
            const second = await image(viewer);
            await viewer.openModel('');
            const builtin = await image(viewer);
            const fail = async (act) => { try { await act(); return ''; } catch (error) { return error.message; } };
            const errors = [await fail(() => viewer.openModel('c.gltf')), await fail(() => viewer.openFiles([{ path: 'x.txt', file: new Blob(['x']) }])),
                await fail(() => viewer.setOption('tone-mapping', 'bogus')), await fail(() => viewer.setOption('no-such', '1'))];
            await viewer.openModel('b.gltf');
            await viewer.setOption('shading', 'ogl1'); // reads the files again
            await viewer.setOption('shading', null);
            await viewer.setOption('tone-mapping', 'agx');
            await viewer.setOption('compare', 'tone-mapping');
            await viewer.setOption('divider', '0.25');
            const both = viewer.options, wrong = [await fail(() => viewer.setOption('compare', 'bogus')), await fail(() => viewer.setOption('divider', '2'))];
            await viewer.setOption('compare', null);
            viewer.setMaterial(0, { pbrMetallicRoughness: { baseColorFactor: [0, 1, 0, 1] } });
            const green = await image(viewer);
            await viewer.setOption('shading', 'ogl1');
            await viewer.setOption('shading', null);
            const kept = await image(viewer);
            const faces = [];
            for (const names of [['px', 'nx', 'py', 'ny', 'pz', 'nz'], ['a', 'b', 'c', 'd', 'e', 'f']])
                faces.push(await fail(() => viewer.openFiles(names.map((name) => ({ path: `sky/${name}.png`, file: new Blob(['x']) })))));
            return { kept, faces, list, path, first, second, builtin, errors, both, wrong, green, options: viewer.options, command: viewer.command(640, 480), state: viewer.state, changes: viewer.log.filter(([type]) => type === 'facet-change').length };
        });
        equal(found.list, ['a/box.gltf', 'b.gltf']);
        equal(found.path, 'a/box.gltf');
        equal(found.first.hash, found.second.hash, 'a model of two files differs from that of one');
        check(found.builtin.hash !== found.first.hash && found.builtin.covered > 0.05, 'the built-in scene');
        check(/c\.gltf/.test(found.errors[0]) && /x\.txt/.test(found.errors[1]) && /bogus/.test(found.errors[2]) && /no-such/.test(found.errors[3]), `${found.errors}`);
        equal([found.both.compare, found.both.divider, found.options.compare], ['tone-mapping', '0.25', undefined]);
        check(/bogus/.test(found.wrong[0]) && /divider.*2/.test(found.wrong[1]), `${found.wrong}`);
        equal(found.options['tone-mapping'], 'agx');
        equal(found.path, 'a/box.gltf');
        check(/^facet render b\.gltf/.test(found.command) && /agx/.test(found.command) && /640x480/.test(found.command), found.command);
        check(Array.isArray(found.state.animations) && found.state.isPlaying === false, 'state');
        check(found.green.color[1] > 1.3 * found.green.color[0], `setMaterial gives ${found.green.color}`);
        equal(found.kept.hash, found.green.hash, 'an edited material, or the tone mapping, is lost when the shading changes');
        check(found.faces[0].includes('facet bake "faces:sky/{face}.png"') && /none of the 6 files/.test(found.faces[1]), `${found.faces}`);
        check(found.changes >= 2, 'facet-change');
    },

    async 'addresses of blobs, and edited models as .glb'() {
        const found = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: URL.createObjectURL(await (await fetch('box.gltf')).blob()) });
            await event(viewer, 'load');
            const gray = await image(viewer);
            viewer.setMaterial(0, { pbrMetallicRoughness: { baseColorFactor: [1, 0, 0, 1] } });
            const red = await image(viewer), blob = await viewer.exportScene();
            await viewer.openFiles([{ path: 'saved.glb', file: blob }]);
            const saved = await image(viewer);
            await event(viewer, 'load', () => { viewer.src = 'models/apart.gltf'; });
            const parts = [(await image(viewer)).hash === gray.hash, viewer.modelPath, viewer.files.map(({ path }) => path)];
            return { gray, parts, red, type: blob.type, saved };
        });
        check(found.gray.covered > 0.05 && found.red.color[0] > 1.5 * found.red.color[1], `a blob is shown and edited: ${JSON.stringify(found)}`);
        equal(found.parts, [true, 'models/apart.gltf', ['models/apart.gltf', 'buffers/the box.bin']], 'a model of two folders');
        equal(found.type, 'model/gltf-binary');
        equal(found.saved.hash, found.red.hash, 'the saved model differs from the edited one');
    },
});
