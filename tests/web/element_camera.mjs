// element_camera.mjs - element.mjs: attributes, models, the camera, mouse, touch and keys.

// tools: see element.mjs
export const cases = ({ page, check, equal, near, requests }) => ({
    async 'attributes and properties'() {
        const found = await page.evaluate(() => {
            const viewer = document.createElement('facet-viewer');
            const defaults = ['src', 'alt', 'poster', 'loading', 'reveal', 'cameraControls', 'cameraOrbit', 'cameraTarget', 'fieldOfView', 'minCameraOrbit', 'interpolationDecay',
                'touchAction', 'autoRotateDelay', 'exposure', 'toneMapping', 'shadowIntensity', 'shadowSoftness', 'animationCrossfadeDuration', 'orientation', 'scale',
                'interactionPromptThreshold', 'loaded', 'modelIsVisible', 'paused', 'duration', 'canActivateAR'].map((name) => viewer[name]);
            viewer.setAttribute('exposure', '1.5');
            viewer.setAttribute('camera-controls', '');
            viewer.setAttribute('touch-action', 'pan-y');
            viewer.setAttribute('loading', 'bogus');
            viewer.setAttribute('shadow-intensity', 'much');
            const parsed = [viewer.exposure, viewer.cameraControls, viewer.touchAction, viewer.loading, viewer.shadowIntensity];
            viewer.removeAttribute('camera-controls');
            viewer.cameraOrbit = '1deg 2deg 3m';
            viewer.cameraOrbit = null;
            return { defaults, parsed, after: [viewer.cameraControls, viewer.cameraOrbit], observed: viewer.constructor.observedAttributes.length };
        });
        equal(found.defaults, [null, null, null, 'auto', 'auto', false, '0deg 75deg 105%', 'auto auto auto', 'auto', 'auto', 50, 'none', 3000, 1, 'auto', 0, 1, 300, '0 0 0',
            '1 1 1', 3000, false, false, true, 0, false]);
        equal(found.parsed, [1.5, true, 'pan-y', 'auto', 0]);
        equal(found.after, [false, '0deg 75deg 105%']);
        check(found.observed > 45, 'attributes are missing');
    },

    async 'a model from src'() {
        const { log, image, empty, poster, methods } = await page.evaluate(async () => {
            const viewer = make({ src: 'box.gltf', alt: 'A box.', poster: 'poster.svg' });
            const empty = viewer.shadowRoot.querySelector('.poster').classList.contains('shown');
            await event(viewer, 'load');
            await frames();
            const poster = viewer.shadowRoot.querySelector('.poster').classList.contains('shown');
            return {
                log: viewer.log, empty, poster, image: await image(viewer),
                methods: { loaded: viewer.loaded, visible: viewer.modelIsVisible, size: { ...viewer.getDimensions() }, text: `${viewer.getBoundingBoxCenter()}`, path: viewer.modelPath,
                    url: viewer.toDataURL('image/jpeg').slice(0, 22), materials: viewer.describe().materials?.length },
            };
        });
        const types = log.map(([type]) => type), shares = log.filter(([type]) => type === 'progress').map(([, { totalProgress }]) => totalProgress);
        check(empty && !poster, 'the poster goes with the model');
        check(types.includes('poster-dismissed') && types.includes('model-visibility'), 'the model is revealed');
        check(shares.at(-1) === 1 && shares.every((share, i) => i === 0 || share >= shares[i - 1]), `progress goes back: ${shares}`);
        check(image.covered > 0.05 && image.covered < 0.9, `${image.covered} of the image is covered`);
        check(Math.max(...image.color) - Math.min(...image.color) < 12, `a gray box is ${image.color}`);
        equal(image.size, [320, 240]);
        check(methods.loaded && methods.visible, 'loaded, modelIsVisible');
        equal([methods.size.x, methods.size.y, methods.size.z], [1, 2, 3]);
        check(/^\S+m \S+m \S+m$/.test(methods.text), methods.text);
        equal(methods.path, 'box.gltf');
        equal(methods.url, 'data:image/jpeg;base64');
        equal(methods.materials, 3);
    },

    async 'a file that cannot be read'() {
        const { error, before, after } = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf' });
            await event(viewer, 'load');
            const before = await image(viewer);
            const error = await event(viewer, 'error', () => { viewer.src = 'broken.glb'; });
            return { error: { type: error.type, message: error.message }, before, after: await image(viewer) };
        });
        equal(error.type, 'loadfailure');
        check(/broken\.glb/.test(error.message), error.message);
        equal(after.hash, before.hash, 'a broken file changed the image');
        const missing = await page.evaluate(async () => (await event(document.querySelector('facet-viewer'), 'error', () => { document.querySelector('facet-viewer').src = 'none/such.glb'; })).message);
        check(/such\.glb.*404/.test(missing), missing);
    },

    async 'the camera by attributes'() {
        const found = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf', 'interpolation-decay': '50' });
            await event(viewer, 'load');
            const state = () => ({ ...viewer.getCameraOrbit(), fov: viewer.getFieldOfView(), target: `${viewer.getCameraTarget()}` });
            const start = state();
            viewer.cameraOrbit = '90deg 45deg 80%';
            const slow = (await frames(1), state());
            await settled(viewer);
            const after = state();
            viewer.cameraOrbit = '-450deg 10deg 1000m';
            viewer.jumpCameraToGoal();
            await viewer.updateComplete;
            await frames();
            const limited = state();
            viewer.minFieldOfView = '20deg';
            viewer.fieldOfView = '5deg';
            viewer.cameraTarget = '0m 0.5m auto';
            await viewer.updateComplete;
            await settled(viewer);
            const zoomed = state();
            const limits = [viewer.getMinimumFieldOfView(), viewer.getMaximumFieldOfView()];
            viewer.maxCameraOrbit = 'auto 60deg auto';
            viewer.cameraOrbit = 'auto 80deg auto';
            await viewer.updateComplete;
            await settled(viewer);
            return { start, slow, after, limited, zoomed, limits, low: state(), sources: viewer.log.filter(([type]) => type === 'camera-change').map(([, detail]) => detail.source) };
        });
        const radius = Math.hypot(0.5, 1, 1.5) / Math.sin(Math.PI / 12);
        near(found.start.theta, 0, 'theta');
        near(found.start.phi, 75 * Math.PI / 180, 'phi');
        near(found.start.radius, 1.05 * radius, 'radius');
        equal(found.start.target, '0m 1m 0m');
        check(found.slow.theta < 1.5, 'the camera jumped');
        near(found.after.theta, Math.PI / 2, 'theta');
        near(found.after.radius, 0.8 * radius, 'radius');
        near(found.limited.radius, 1.05 * radius, 'the largest radius');
        near(found.limited.theta, -2.5 * Math.PI, 'theta of several turns');
        near(found.zoomed.fov, 20, 'field of view');
        equal(found.zoomed.target, '0m 0.5m 0m');
        near(found.limits[0], 20, 'least field of view');
        near(found.low.phi, Math.PI / 3, 'largest polar angle');
        check(found.sources.length > 4 && found.sources.every((source) => source === 'none'), `${found.sources}`);
    },

    async 'mouse, wheel and keyboard'() {
        await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf', 'camera-controls': '', alt: 'A box' });
            await event(viewer, 'load');
            await settled(viewer);
        });
        const read = () => page.evaluate(async () => {
            const viewer = document.querySelector('facet-viewer');
            await settled(viewer);
            return { ...viewer.getCameraOrbit(), fov: viewer.getFieldOfView(), target: { ...viewer.getCameraTarget() }, source: viewer.log.filter(([type]) => type === 'camera-change').at(-1)?.[1].source };
        });
        const box = await page.locator('facet-viewer').boundingBox();
        const drag = async (dx, dy, button = 'left') => {
            await page.mouse.move(box.x + 20, box.y + 200);
            await page.mouse.down({ button });
            await page.mouse.move(box.x + 20 + dx, box.y + 200 + dy, { steps: 4 });
            await page.mouse.up({ button });
        };
        const start = await read();
        await page.keyboard.press('Tab');
        check(await page.evaluate(() => document.activeElement === document.querySelector('facet-viewer')), 'Tab does not reach the element');
        await drag(30, 0);
        const turned = await read();
        near(turned.theta, start.theta - 2 * Math.PI * 30 / 240, 'a drag');
        equal(turned.source, 'user-interaction');
        await drag(0, -24, 'right');
        const panned = await read();
        check(panned.target.y !== turned.target.y && Math.abs(panned.theta - turned.theta) < 1e-9, 'the right button did not pan');
        await page.mouse.wheel(0, -240);
        const zoomed = await read();
        check(zoomed.fov < panned.fov && zoomed.radius < panned.radius, 'the wheel did not zoom');
        await page.keyboard.press('ArrowLeft');
        const left = await read();
        near(left.theta, zoomed.theta + Math.PI / 8, 'an arrow');
        await page.keyboard.press('ArrowUp');
        check((await read()).phi > left.phi, 'an arrow up');
        await page.keyboard.press('PageUp');
        check((await read()).fov > left.fov, 'Page Up');
        const before = await read();
        await page.keyboard.press('Shift+ArrowRight');
        const moved = await read();
        check(Math.abs(moved.theta - before.theta) < 1e-9 && JSON.stringify(moved.target) !== JSON.stringify(before.target), 'Shift and an arrow did not pan');
        await page.keyboard.press('a');
        equal((await read()).theta, moved.theta);
        for (let i = 0; i < 4; i++) await page.keyboard.press('ArrowLeft');
        await read();
        const aria = await page.evaluate(async () => {
            await new Promise((resolve) => setTimeout(resolve, 400));
            const { shadowRoot } = document.querySelector('facet-viewer'), input = shadowRoot.querySelector('.input');
            const all = ['role', 'aria-roledescription', 'aria-label', 'aria-keyshortcuts', 'tabindex'].map((name) => input.getAttribute(name));
            return { all, status: shadowRoot.querySelector('[role=status]').textContent };
        });
        equal(aria.all.slice(0, 3), ['img', '3D model', 'A box. Use mouse, touch or arrow keys to move.']);
        check(/ArrowLeft/.test(aria.all[3]) && aria.all[4] === '0', 'keys are not announced');
        check(/^View from (lower |upper )?right$/.test(aria.status), `the view is not announced: "${aria.status}"`);
        await page.keyboard.press('Escape');
        check(await page.evaluate(() => document.activeElement !== document.querySelector('facet-viewer')), 'Escape does not leave');
        // attributes that take controls away
        await page.evaluate(async () => {
            const viewer = document.querySelector('facet-viewer');
            viewer.disableZoom = viewer.disablePan = true;
            viewer.a11y = JSON.stringify({ 'interaction-prompt': 'Ziehen dreht.', back: 'Ansicht von hinten' });
            viewer.cameraOrbit = '180deg auto auto';
            await viewer.updateComplete;
            await settled(viewer);
            await new Promise((resolve) => setTimeout(resolve, 400));
        });
        const phrases = await page.evaluate(() => {
            const { shadowRoot } = document.querySelector('facet-viewer');
            return [shadowRoot.querySelector('.input').getAttribute('aria-label'), shadowRoot.querySelector('[role=status]').textContent];
        });
        equal(phrases, ['A box. Ziehen dreht.', 'Ansicht von hinten'], 'a11y');
        const fixed = await read();
        await page.mouse.move(box.x + 20, box.y + 200);
        await page.mouse.wheel(0, 240);
        await drag(0, -24, 'right');
        const still = await read();
        equal([still.fov, still.target], [fixed.fov, fixed.target], 'disable-zoom, disable-pan');
    },

    async touch() {
        const client = await page.context().newCDPSession(page);
        const touch = async (type, points) => client.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
        await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf', 'camera-controls': '', 'touch-action': 'pan-y' });
            const space = document.createElement('div');
            space.style.height = '3000px';
            document.body.append(space);
            await event(viewer, 'load');
            await settled(viewer);
        });
        const read = () => page.evaluate(async () => {
            const viewer = document.querySelector('facet-viewer');
            await settled(viewer);
            return { ...viewer.getCameraOrbit(), fov: viewer.getFieldOfView(), target: { ...viewer.getCameraTarget() }, scroll: window.scrollY };
        });
        const { x, y } = await page.locator('facet-viewer').boundingBox();
        const start = await read();
        await touch('touchStart', [[x + 100, y + 120]]);
        for (let i = 1; i <= 5; i++) await touch('touchMove', [[x + 100 + 10 * i, y + 120]]);
        await touch('touchEnd', []);
        const turned = await read();
        check(turned.theta < start.theta - 0.5, 'a finger does not turn');
        equal(turned.scroll, 0);
        await touch('touchStart', [[x + 100, y + 120], [x + 140, y + 120]]);
        for (let i = 1; i <= 5; i++) await touch('touchMove', [[x + 100 - 8 * i, y + 120], [x + 140 + 8 * i, y + 120]]);
        await touch('touchEnd', []);
        const zoomed = await read();
        check(zoomed.fov < turned.fov - 0.5, `a pinch does not zoom: ${turned.fov} to ${zoomed.fov}`);
        await touch('touchStart', [[x + 100, y + 120], [x + 140, y + 120]]);
        for (let i = 1; i <= 5; i++) await touch('touchMove', [[x + 100 + 8 * i, y + 120], [x + 140 + 8 * i, y + 120]]);
        await touch('touchEnd', []);
        const panned = await read();
        check(Math.abs(panned.target.x - zoomed.target.x) + Math.abs(panned.target.z - zoomed.target.z) > 0.01, 'two fingers do not pan');
        check(Math.abs(panned.fov - zoomed.fov) < 0.5 && Math.abs(panned.theta - zoomed.theta) < 1e-6, 'two fingers side by side zoom or turn');
        await touch('touchStart', [[x + 100, y + 200]]);
        for (let i = 1; i <= 8; i++) await touch('touchMove', [[x + 100, y + 200 - 15 * i]]);
        await touch('touchEnd', []);
        const scrolled = await read();
        check(scrolled.scroll > 20, 'with pan-y the page does not scroll');
        check(Math.abs(scrolled.phi - zoomed.phi) < 1e-6, 'scrolling turned the camera');
        // two pixels of the screen per pixel of the page: the same gesture is the same turn
        const { width, height } = page.viewportSize();
        await client.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 2, mobile: false });
        await page.evaluate(() => window.scrollTo(0, 0));
        const sharp = await read();
        await touch('touchStart', [[x + 100, y + 120]]);
        for (let i = 1; i <= 5; i++) await touch('touchMove', [[x + 100 + 10 * i, y + 120]]);
        await touch('touchEnd', []);
        const again = await read();
        check(Math.abs(again.theta - sharp.theta - (turned.theta - start.theta)) < 0.05, `a finger turns by ${again.theta - sharp.theta} on a screen of twice the pixels, elsewhere by ${turned.theta - start.theta}`);
        await client.send('Emulation.clearDeviceMetricsOverride');
        await client.detach();
    },
});
