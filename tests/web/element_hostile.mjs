// element_hostile.mjs - element.mjs: values, addresses and pages that are not as one would wish.

// tools: see element.mjs
export const cases = ({ page, check, equal, open }) => ({
    async 'a property takes any value of a script'() {
        const found = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf' }), warnings = [], { warn } = console;
            await event(viewer, 'load');
            console.warn = (text) => warnings.push(text);
            const values = { exposure: NaN, shadowIntensity: 'x', interpolationDecay: 'x', autoRotateDelay: Symbol('x'), orbitSensitivity: {}, loading: 'sometimes',
                alt: 5, cameraOrbit: 5, fieldOfView: 30, timeScale: NaN };
            const read = {};
            for (const [name, value] of Object.entries(values)) {
                viewer[name] = value;
                await viewer.updateComplete;
                read[name] = viewer[name];
            }
            window.dispatchEvent(new Event('scroll')); // reads the texts of the camera
            viewer.exposure = 1e300; // no factor that facet knows; the rest is set all the same
            viewer.cameraControls = true;
            await viewer.updateComplete;
            await frames();
            console.warn = warn;
            const input = viewer.shadowRoot.querySelector('.input');
            return { read, warnings, label: input.getAttribute('aria-label'), isControlled: input.classList.contains('controlled'), covered: (await image(viewer)).covered };
        });
        equal(found.read, { exposure: 1, shadowIntensity: 0, interpolationDecay: 50, autoRotateDelay: 3000, orbitSensitivity: 1, loading: 'auto', alt: '5', cameraOrbit: '5',
            fieldOfView: '30', timeScale: 1 });
        check(found.warnings.some((text) => /exposure/.test(text)), `no warning: ${found.warnings}`);
        check(found.isControlled && /^5\./.test(found.label) && found.covered > 0.05, 'a wrong value keeps others from being set');
    },

    async 'addresses without an ending, that are none, and that a script maps'() {
        const found = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'api/model' });
            await event(viewer, 'load');
            const { covered } = await image(viewer), files = viewer.files.map(({ path }) => path);
            const { message } = await event(viewer, 'error', () => { viewer.src = 'http://['; });
            const light = await event(viewer, 'error', () => { viewer.environmentImage = 'http://['; });
            const seen = [];
            viewer.constructor.mapURLs((url) => { seen.push(url.split('/').pop()); return url.replace('mapped', 'models'); });
            await event(viewer, 'load', () => { viewer.src = 'mapped/apart.gltf'; });
            viewer.constructor.mapURLs((url) => url);
            return { covered, files, message, light: light.message, seen };
        });
        check(found.covered > 0.05, 'a model without an ending is empty');
        equal(found.files, ['model', 'the box.bin']);
        equal([found.message, found.light], ['"http://[" is no address of a file', '"http://[" is no address of a file']);
        equal(found.seen, ['apart.gltf', 'the%20box.bin'], 'addresses that mapURLs() gets');
    },

    async 'the light that was set last'() {
        const found = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf' });
            await event(viewer, 'load');
            const { fetchFile } = await import('./facet-viewer/files.js');
            await fetchFile(new URL('blue.hdr', document.baseURI).href);
            viewer.environmentImage = 'blue.hdr';
            await viewer.updateComplete;
            await Promise.resolve(); // the file is there, and waits for its turn
            viewer.environmentImage = 'sun:45,135';
            await viewer.updateComplete;
            await new Promise((resolve) => setTimeout(resolve, 500));
            const file = { path: 'blue.hdr', file: await (await fetch('blue.hdr')).blob() };
            const slow = viewer.openFiles([file]);
            await viewer.setOption('env', 'white');
            await slow;
            return [viewer.log.filter(([type]) => type === 'error'), viewer.options.env];
        });
        equal(found, [[], 'white']);
    },

    async 'a model whose name looks like an option'() {
        const command = await page.evaluate(async () => {
            await clear();
            const viewer = make({});
            await viewer.openFiles([{ path: '--output=x.gltf', file: await (await fetch('box.gltf')).blob() }]);
            return viewer.command(64, 64);
        });
        check(/^facet render \.\/--output=x\.gltf -o \.\/--output=x\.png /.test(command), command);
    },

    async 'points of a frame that was coarse'() {
        const found = await page.evaluate(async () => {
            await clear();
            const { engine } = await import('./facet-viewer/engine.js');
            await engine.start();
            const viewer = make({ src: 'box.gltf', 'camera-controls': '' }), early = event(viewer, 'load').then(() => viewer.pick(160, 120));
            const isEarly = (await early) === null;
            await frames(4);
            const sharp = viewer.pick(160, 120).position, box = viewer.getBoundingClientRect();
            let coarse = null;
            engine.module.pace = (_, isMoving) => (isMoving ? 4 : 1);
            viewer.addEventListener('render-scale', ({ detail }) => { if (detail.renderedDpr === 1) coarse ??= viewer.positionAndNormalFromPoint(box.x + 160, box.y + 120).position; });
            viewer.zoom(0.01);
            await event(viewer, 'render-scale');
            await settled(viewer);
            await frames(3);
            delete engine.module.pace;
            return { isEarly, sharp, coarse: coarse && [coarse.x, coarse.y, coarse.z], outside: viewer.pick(-1, 5) };
        });
        check(found.isEarly && found.coarse && found.outside === null, JSON.stringify(found));
        check(found.sharp.every((value, i) => Math.abs(value - found.coarse[i]) < 0.05), `a point of the frame before: ${JSON.stringify(found)}`);
    },

    async 'a viewer.wasm that does not start'() {
        const messages = [];
        for (const [name, answer] of [['test', { status: 404, body: '' }], ['test', { contentType: 'text/html', body: '<!doctype html>' }], ['strict', null]]) {
            const other = await page.context().browser().newPage();
            if (answer) await other.route('**/viewer.wasm', (route) => route.fulfill(answer));
            await other.goto(new URL(`/site/${name}.html`, page.url()).href);
            messages.push(await other.evaluate(async () => {
                await customElements.whenDefined('facet-viewer');
                const viewer = document.createElement('facet-viewer');
                return new Promise((resolve) => {
                    viewer.addEventListener('error', ({ detail }) => resolve(detail.message.replace(location.origin, '')));
                    viewer.src = 'box.gltf';
                    document.body.append(viewer);
                });
            }));
            await other.close();
        }
        equal(messages, ['it cannot be fetched; it belongs beside the scripts of facet', 'the server has another file there, perhaps a web page; it belongs beside the scripts of facet',
            'the content security policy of the page lacks \'wasm-unsafe-eval\' in script-src'].map((why) => `/site/facet-viewer/viewer.wasm does not start: ${why}`));
    },

    async 'an element that is larger than any image'() {
        const found = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf' }, [30000, 300]);
            await event(viewer, 'load');
            await frames(4);
            const canvas = viewer.shadowRoot.querySelector('.stage canvas:not(.unused)');
            return { size: [canvas.width, canvas.height], errors: viewer.log.filter(([type]) => type === 'error'), hit: viewer.pick(15000, 150) !== null };
        });
        equal(found, { size: [8192, 82], errors: [], hit: true });
    },

    async 'a page that requires trusted types'() {
        const home = page.url();
        await open('/site/trusted.html');
        const covered = await page.evaluate(async () => {
            const viewer = make({ src: 'box.gltf' });
            await event(viewer, 'load');
            return (await image(viewer)).covered;
        });
        await open(home);
        check(covered > 0.05, 'the image is empty');
    },
});
