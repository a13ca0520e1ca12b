// element_life.mjs - element.mjs: many elements, loss of the context and of the module, resolution, memory.

// tools: see element.mjs
export const cases = ({ page, check, equal, near, requests }) => ({
    async 'many elements share one context'() {
        requests.length = 0;
        const found = await page.evaluate(async () => {
            await clear();
            let contexts = 0;
            const { getContext } = HTMLCanvasElement.prototype;
            HTMLCanvasElement.prototype.getContext = function (type, ...rest) {
                if (/webgl/.test(type)) contexts++;
                return getContext.call(this, type, ...rest);
            };
            const viewers = [];
            for (let i = 0; i < 20; i++) {
                viewers.push(make({ src: 'box.gltf?many', 'camera-orbit': `${18 * i}deg 75deg auto` }, [60, 60]));
                viewers[i].style.display = 'inline-block';
            }
            const space = document.createElement('div');
            space.style.height = '3000px';
            document.body.append(space);
            const lazy = make({ src: 'box-lazy.gltf', loading: 'lazy', poster: 'poster.svg' }), auto = make({ src: 'box-auto.gltf' });
            const eager = make({ src: 'box-eager.gltf', loading: 'eager' }), manual = viewers[0].cloneNode();
            manual.reveal = 'manual';
            manual.src = 'box-manual.gltf';
            document.body.prepend(manual);
            await Promise.all([...viewers, eager].map((viewer) => viewer.loaded || event(viewer, 'load')));
            await frames(6);
            // what is on the screen, not a new image
            const drawn = viewers.map((viewer) => {
                const canvas = viewer.shadowRoot.querySelector('.image'), { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
                let hash = 0, covered = 0;
                for (let i = 0; i < data.length; i += 4) { hash = (hash * 31 + data[i] + 7 * data[i + 3]) | 0; covered += data[i + 3] > 128; }
                return [hash, covered / (data.length / 4)];
            });
            HTMLCanvasElement.prototype.getContext = getContext;
            const { length } = document.querySelectorAll('facet-viewer');
            const loaded = [lazy, auto, eager, manual].map((viewer) => viewer.loaded);
            manual.log = [];
            await event(manual, 'load', () => manual.dismissPoster());
            await event(lazy, 'load', () => lazy.scrollIntoView());
            return { contexts, length, loaded, drawn, late: [manual.loaded, lazy.loaded, manual.modelIsVisible] };
        });
        check(found.contexts <= 1, `${found.contexts} contexts for ${found.length} elements`);
        equal(found.loaded, [false, false, true, false], 'lazy, auto, eager, manual');
        equal(new Set(found.drawn.map(([hash]) => hash)).size > 5, true, 'the elements show the same');
        check(found.drawn.every(([, covered]) => covered > 0.05), 'an element is empty');
        check(found.late[0] && found.late[1], 'lazy and manual models come late');
        equal(requests.filter((url) => url === '/site/box.gltf').length, 1, 'equal addresses are fetched once');
    },

    async 'loss of the context'() {
        const found = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf' });
            await event(viewer, 'load');
            await frames(6);
            const before = await image(viewer);
            const canvas = viewer.shadowRoot.querySelector('.stage > canvas:not(.image)');
            const loss = canvas.getContext('webgl2').getExtension('WEBGL_lose_context');
            await new Promise((resolve) => { canvas.addEventListener('webglcontextlost', () => setTimeout(resolve, 50), { once: true }); loss.loseContext(); });
            const during = await image(viewer), isShown = !viewer.shadowRoot.querySelector('.image').classList.contains('unused');
            await new Promise((resolve) => { canvas.addEventListener('webglcontextrestored', () => setTimeout(resolve, 50), { once: true }); loss.restoreContext(); });
            await frames(4);
            const after = await image(viewer);
            const error = event(viewer, 'error');
            loss.loseContext();
            const started = performance.now(), { type } = await error, waited = performance.now() - started;
            await new Promise((resolve) => { canvas.addEventListener('webglcontextrestored', () => setTimeout(resolve, 50), { once: true }); loss.restoreContext(); });
            await frames(4);
            return { before, during, isShown, after, type, waited, late: await image(viewer) };
        });
        check(found.isShown, 'the last image does not stay');
        check(Math.abs(found.during.covered - found.before.covered) < 0.01, 'the last image is gone');
        equal(found.after.hash, found.before.hash, 'the image after the loss differs');
        equal(found.type, 'webglcontextlost');
        check(found.waited > 4500, 'the error came early');
        equal(found.late.hash, found.before.hash);
    },

    async 'loss of the context while a model is opened'() {
        const found = await page.evaluate(async () => {
            await clear();
            const box = await (await fetch('box.gltf')).blob(), viewer = make({ src: 'box.gltf' });
            await event(viewer, 'load');
            await frames(4);
            const before = await image(viewer), { View } = await import('./facet-viewer/view.js');
            const canvas = viewer.shadowRoot.querySelector('.stage > canvas:not(.image)');
            const loss = canvas.getContext('webgl2').getExtension('WEBGL_lose_context');
            const { use } = View.prototype; // the loss comes just before the model is read
            View.prototype.use = function (act) {
                if (/open/.test(String(act))) { View.prototype.use = use; loss.loseContext(); setTimeout(() => loss.restoreContext(), 200); }
                return use.call(this, act);
            };
            await viewer.openFiles([{ path: 'late.gltf', file: box }]);
            await new Promise((resolve) => setTimeout(resolve, 400));
            await frames(4);
            return { errors: viewer.log.filter(([type]) => type === 'error'), path: viewer.modelPath, isSame: (await image(viewer)).hash === before.hash };
        });
        equal(found, { errors: [], path: 'late.gltf', isSame: true });
    },

    async 'without WebGL 2'() {
        const other = await (await page.context().browser().newContext()).newPage();
        await other.addInitScript(() => { HTMLCanvasElement.prototype.getContext = () => null; });
        await other.goto(page.url());
        const found = await other.evaluate(async () => {
            await customElements.whenDefined('facet-viewer');
            const viewer = document.createElement('facet-viewer');
            viewer.src = 'box.gltf';
            viewer.poster = 'poster.svg';
            const failed = new Promise((resolve) => { viewer.addEventListener('error', (event) => resolve(event.detail.message)); });
            document.body.append(viewer);
            const message = await failed;
            return [message, viewer.loaded, viewer.shadowRoot.querySelector('.poster').classList.contains('shown')];
        });
        await other.close();
        check(/WebGL 2/.test(found[0]) && !found[1] && found[2], `without WebGL 2: ${found}`);
    },

    async 'a module that stops is replaced'() {
        const found = await page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf', exposure: '2', 'camera-orbit': '30deg 60deg auto' });
            await event(viewer, 'load');
            await frames(4);
            const before = await image(viewer);
            const { engine } = await import('./facet-viewer/engine.js');
            const old = engine.module;
            let message = '';
            await event(viewer, 'load', () => {
                try { engine.call((module) => module.destroy(0x7ffffff0)); } catch (error) { message = error.message; }
            });
            await frames(6);
            return { before, message, isNew: engine.module !== old, after: await image(viewer), orbit: { ...viewer.getCameraOrbit() } };
        });
        check(found.message.length > 10 && found.isNew, `"${found.message}"`);
        equal(found.after.hash, found.before.hash, 'the image of the new module differs');
        near(found.orbit.theta, Math.PI / 6, 'the orbit of the new module');
    },

    async 'a model that always stops the module is given up'() {
        const found = await page.evaluate(async () => {
            await clear();
            const { engine } = await import('./facet-viewer/engine.js'), viewer = make({ src: 'box.gltf' });
            await event(viewer, 'load');
            const { prototype } = engine.module.constructor, { draw } = prototype;
            prototype.draw = function (handle) { return this.destroy(0x7ffffff0 + 0 * handle); };
            const failed = new Promise((resolve) => viewer.addEventListener('error', ({ detail }) => { if (/not loaded again/.test(detail.message)) resolve(detail.message); }));
            viewer.exposure = 2;
            const message = await failed;
            prototype.draw = draw;
            const { module } = engine;
            await new Promise((resolve) => setTimeout(resolve, 300));
            const isKept = engine.module === module;
            await viewer.openFiles([{ path: 'again.gltf', file: await (await fetch('box.gltf')).blob() }]);
            await frames();
            return { message, isKept, covered: (await image(viewer)).covered };
        });
        check(/3 times/.test(found.message) && found.isKept && found.covered > 0.05, JSON.stringify(found));
    },

    async 'reduced motion and the turntable'() {
        const run = () => page.evaluate(async () => {
            await clear();
            const viewer = make({ src: 'box.gltf', 'auto-rotate': '', 'auto-rotate-delay': '0', 'rotation-per-second': '90deg' });
            await event(viewer, 'load');
            await frames(12);
            const turned = viewer.turntableRotation, orbit = viewer.getCameraOrbit().theta;
            viewer.autoRotate = false;
            viewer.resetTurntableRotation();
            viewer.cameraOrbit = '90deg auto auto';
            await viewer.updateComplete;
            await frames(2);
            return { turned, orbit, theta: viewer.getCameraOrbit().theta, reset: viewer.turntableRotation };
        });
        const moving = await run();
        check(moving.turned > 0.01 && moving.orbit === 0 && moving.reset === 0, `the turntable is at ${moving.turned}`);
        check(moving.theta < 1.5, 'the camera jumps');
        await page.emulateMedia({ reducedMotion: 'reduce' });
        const reduced = await run();
        await page.emulateMedia({ reducedMotion: null });
        equal(reduced.turned, 0, 'the turntable turns for users who want less motion');
        near(reduced.theta, Math.PI / 2, 'the camera glides for users who want less motion');
    },

    async 'coarse while slow frames move, sharp at rest'() {
        const found = await page.evaluate(async () => {
            await clear();
            const { engine } = await import('./facet-viewer/engine.js');
            await engine.start();
            const handle = engine.module.create(), divisors = [0.03, 0.1, 0.45, 0.55].map((seconds) => engine.module.pace(handle, true, 1, seconds));
            engine.module.destroy(handle);
            engine.module.pace = (_, isMoving) => (isMoving ? 4 : 1); // as after frames of 400 ms
            const viewer = make({ src: 'box.gltf', 'auto-rotate': '', 'auto-rotate-delay': '0' });
            const coarse = await event(viewer, 'render-scale');
            await frames(3);
            const size = () => { const { width, height } = viewer.shadowRoot.querySelector('.stage canvas:not(.unused)'); return [width, height]; };
            const stage = viewer.shadowRoot.querySelector('.stage'), moving = size(), isCopied = stage.querySelectorAll('canvas').length === 1;
            viewer.autoRotate = false;
            const sharp = await event(viewer, 'render-scale');
            await frames(3);
            const rest = size();
            viewer.constructor.minimumRenderScale = 1;
            viewer.autoRotate = true;
            await frames(8);
            const full = size();
            viewer.constructor.minimumRenderScale = 0.25;
            delete engine.module.pace;
            return { divisors, coarse, moving, isCopied, sharp, rest, full };
        });
        equal([found.coarse.renderedDpr, found.moving], [0.25, [80, 60]]);
        equal(found.divisors, [1, 2, 2, 4], 'frames of 30, 100, 450 and 550 ms');
        check(found.isCopied, 'a coarse image with straight alpha is enlarged');
        equal([found.sharp.renderedDpr, found.rest], [1, [320, 240]]);
        equal(found.full, [320, 240], 'minimumRenderScale = 1');
    },

    async 'drafts while slow frames move, the whole image at rest'() {
        const found = await page.evaluate(async () => {
            await clear();
            const { engine } = await import('./facet-viewer/engine.js');
            await engine.start();
            const { module } = engine, drawn = [];
            module.pace = () => 1;
            module.drafts = (_, isMoving) => isMoving; // as after frames of 30 ms
            module.draw = (...words) => { drawn.push(words[4]); return module.constructor.prototype.draw.apply(module, words); };
            const viewer = make({ src: 'box.gltf' });
            await event(viewer, 'load');
            await frames(4);
            const hash = async () => (await image(viewer)).hash, first = await hash(), still = drawn.splice(0);
            viewer.autoRotateDelay = 0;
            viewer.autoRotate = true;
            await frames(6);
            const moving = drawn.splice(0);
            viewer.autoRotate = false;
            viewer.resetTurntableRotation();
            await viewer.updateComplete;
            await frames(6);
            const ending = drawn.splice(0), shown = viewer.shadowRoot.querySelector('.image');
            const rest = shown.toDataURL();
            for (const name of ['pace', 'drafts', 'draw']) delete module[name];
            viewer.setOption('exposure', '0'); // draws again
            await frames(4);
            return { still, moving, ending, same: shown.width > 100 && shown.toDataURL() === rest, equal: first === await hash() };
        });
        check(found.still.length > 0 && found.still.every((isDraft) => !isDraft), `still images are drafts: ${found.still}`);
        check(found.moving.filter(Boolean).length > 2, `no drafts while it moves: ${found.moving}`);
        check(found.ending.at(-1) === false, `the last image is a draft: ${found.ending}`);
        check(found.same && found.equal, 'the image at rest is not the whole one');
    },

    async 'removal frees everything, and an idle page draws nothing'() {
        const found = await page.evaluate(async () => {
            await clear();
            const { engine } = await import('./facet-viewer/engine.js');
            const sizes = [];
            for (let i = 0; i < 6; i++) {
                const viewer = make({ src: 'box.gltf' });
                await event(viewer, 'load');
                await frames(2);
                await clear();
                sizes.push(engine.module.memorySize);
            }
            const left = engine.viewCount;
            const viewer = make({ src: 'box.gltf' });
            await event(viewer, 'load');
            await frames(10);
            let count = 0;
            viewer.addEventListener('before-render', () => count++);
            await frames(20);
            const idle = count;
            viewer.exposure = 1.5;
            await frames(4);
            const moved = document.createElement('div');
            document.body.append(moved);
            moved.append(viewer); // moving is no removal
            await new Promise((resolve) => setTimeout(resolve, 1200));
            return { sizes, left, idle, after: count, kept: viewer.loaded && (await image(viewer)).covered > 0.05 };
        });
        equal(found.left, 0, 'removed elements keep their views');
        equal(found.sizes[5], found.sizes[1], `memory grows: ${found.sizes}`);
        equal(found.idle, 0, 'an idle page draws');
        check(found.after > 0 && found.after < 5, `${found.after} frames for a change`);
        check(found.kept, 'an element that was moved lost its model');
    },
});
