// element_page.mjs - helpers of element.mjs in the page: elements with a log of their events.
export const prepare = (page) => page.evaluate(() => {
    window.make = (attributes = {}, size = [320, 240]) => {
        const viewer = document.createElement('facet-viewer');
        viewer.log = [];
        for (const type of ['load', 'error', 'progress', 'model-visibility', 'poster-dismissed', 'camera-change', 'environment-change', 'variant-applied',
            'play', 'pause', 'loop', 'finished', 'render-scale', 'facet-change', 'facet-message'])
            viewer.addEventListener(type, (event) => viewer.log.push([type, event.detail]));
        for (const [name, value] of Object.entries(attributes)) viewer.setAttribute(name, value);
        viewer.style.width = `${size[0]}px`;
        viewer.style.height = `${size[1]}px`;
        document.body.append(viewer);
        return viewer;
    };
    window.event = (viewer, type, act = () => {}) => new Promise((resolve, reject) => {
        const late = setTimeout(() => reject(new Error(`no event ${type} after ${JSON.stringify(viewer.log.slice(-4))}`)), 20000);
        viewer.addEventListener(type, (found) => { clearTimeout(late); resolve(found.detail); }, { once: true });
        act();
    });
    window.frames = async (n = 2) => { for (let i = 0; i < n; i++) await new Promise((resolve) => requestAnimationFrame(resolve)); };
    window.settled = async (viewer) => {
        for (let last = ''; ;) {
            await window.frames(4);
            const now = JSON.stringify([viewer.getCameraOrbit(), viewer.getCameraTarget(), viewer.getFieldOfView()]);
            if (now === last) return;
            last = now;
        }
    };
    // Of the image: its pixels as a text, how many are not transparent, and the mean color of those.
    window.image = async (viewer) => {
        const bitmap = await createImageBitmap(await viewer.toBlob());
        const canvas = new OffscreenCanvas(bitmap.width, bitmap.height), context = canvas.getContext('2d');
        context.drawImage(bitmap, 0, 0);
        const { data } = context.getImageData(0, 0, canvas.width, canvas.height), sum = [0, 0, 0];
        let covered = 0, hash = 0;
        for (let i = 0; i < data.length; i += 4) {
            hash = (hash * 31 + data[i] + 3 * data[i + 1] + 7 * data[i + 2] + 11 * data[i + 3]) | 0;
            if (data[i + 3] < 128) continue;
            covered++;
            for (let c = 0; c < 3; c++) sum[c] += data[i + c];
        }
        return { hash, covered: covered / (data.length / 4), color: sum.map((value) => value / covered), size: [canvas.width, canvas.height] };
    };
    window.clear = async () => { document.body.replaceChildren(); await new Promise((resolve) => setTimeout(resolve, 1100)); };
});
