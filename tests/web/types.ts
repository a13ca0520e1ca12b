// types.ts - what a program in TypeScript writes with the element; compiled by element.sh, never run.
import { FacetViewer, type HotspotData } from 'facet-viewer';

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
// @ts-expect-error there is no such value
viewer.loading = 'sometimes';
// @ts-expect-error read-only
viewer.loaded = true;
console.log(radius, hotspot, blob, models);
