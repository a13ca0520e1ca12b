// types.ts - what a program in TypeScript writes with the element; compiled by element.sh, never run.
import { FacetViewer, type HotspotData } from 'facet-viewer';
import { readFolder, writeFiles } from 'facet-viewer/node';
import { loadTools, FacetError, type Tools } from 'facet-viewer/tools';

const viewer: FacetViewer = document.createElement('facet-viewer');
viewer.cameraOrbit = '45deg 60deg 120%';
viewer.exposure = 1.2;
viewer.addEventListener('load', (event) => console.log(event.detail.url));
viewer.addEventListener('error', ({ detail }) => console.log(detail.type === 'loadfailure', detail.message));
viewer.addEventListener('camera-change', ({ detail }) => console.log(detail.source));
viewer.addEventListener('click', (event) => console.log(event.clientX));
FacetViewer.minimumRenderScale = 0.5;
const radius: number = viewer.getCameraOrbit().radius;
const hotspot: HotspotData | null = viewer.queryHotspot('hotspot-1');
const blob: Promise<Blob> = viewer.screenshot({ width: 1920, height: 1080 });
const models: Promise<string[]> = viewer.openFiles([{ path: 'a.glb', file: new Blob([]) }]);
viewer.play({ repetitions: 2, pingpong: true });
const clips: string[] = viewer.state.animations ?? [];
const [begin, end]: [number, number] = viewer.state.animationTimes?.[0] ?? [0, 0];
// @ts-expect-error names, not objects
clips.push({ name: 'walk' });
console.log(begin, end, viewer.renderInfo.seconds);
// @ts-expect-error there is no such value
viewer.loading = 'sometimes';
// @ts-expect-error read-only
viewer.loaded = true;
console.log(radius, hotspot, blob, models);

const tools: Tools = await loadTools();
const { files, warnings } = await tools.convert({ 'a.obj': 'v 0 0 0', 'b.png': new Uint8Array(4) }, 'a.obj', { output: 'b.glb', maxTexture: 512, glass: true });
const saved: Uint8Array = await tools.save(files, 'b.glb', { 0: { pbrMetallicRoughness: { roughnessFactor: 0.5 } } });
const { svg } = await tools.plot('slice', ['roughness=0.3'], { angle: [0, 30], fit: true });
await writeFiles('out', await readFolder('in', (path) => path.endsWith('.glb')));
console.log(new FacetError('no', 2).code + (await tools.run(['version'])).code + warnings.length + svg.length + saved.length);
// @ts-expect-error the output is missing
await tools.convert({}, 'a.obj', {});
