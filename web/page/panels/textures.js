// textures.js - the textures of a material: a thumbnail of the image, its size and format, how it is sampled and placed.
import { element, facts, shortNumber } from '../fields.js';

const WRAPS = { repeat: 'repeats', clamp: 'clamped', mirror: 'mirrored' };

// What the browser can show as it is stored.
const SHOWN = new Set(['image/png', 'image/jpeg', 'image/webp', 'image/avif', 'image/gif', 'image/bmp']);

const urls = new Set();

// The thumbnails of the last model are no longer needed.
export function forgetThumbnails() {
  urls.forEach((url) => URL.revokeObjectURL(url));
  urls.clear();
}

async function fill(frame, app, index, image) {
  try {
    const blob = await app.viewer.imageBlob(index);
    const url = URL.createObjectURL(blob);
    urls.add(url);
    const picture = element('img', { alt: '', src: url, loading: 'lazy', onerror: () => frame.replaceChildren(formatOf(image)) });
    frame.replaceChildren(picture);
  } catch {
    frame.replaceChildren(formatOf(image));
  }
}

const formatOf = (image) => (image.mime_type ?? 'image').replace('image/', '');

function wrapOf(texture) {
  const [u, v] = [WRAPS[texture.wrap_u], WRAPS[texture.wrap_v]];
  return u === v ? u : `${u}, ${v}`;
}

function filterOf(texture) {
  const mips = texture.mip_filter === 'none' ? 'no mips' : `${texture.mip_filter} mips`;
  return texture.mag_filter === texture.min_filter ? `${texture.mag_filter}, ${mips}` : `${texture.min_filter}, ${texture.mag_filter} enlarged, ${mips}`;
}

const placeOf = (transform) => (transform ? transform.map((x) => shortNumber(x, 3)).join(' ') : null);

function textureItem(app, scene, ref, label) {
  const texture = scene.textures[ref.texture];
  const image = texture.image === null ? null : scene.images[texture.image];
  const frame = element('div', { class: 'thumbnail', 'aria-hidden': 'true' });
  if (image?.readable && SHOWN.has(image.mime_type)) fill(frame, app, texture.image, image);
  else frame.append(image ? formatOf(image) : 'none');
  return element('div', { class: 'texture' }, frame, element('div', {}, element('strong', {}, label),
    facts([['Image', image ? image.name || `Image ${texture.image}` : 'missing'], ['Size', image && image.width ? `${image.width} × ${image.height}` : null],
      ['Format', image && formatOf(image)], ['Coordinates', `set ${ref.texcoord}`], ['Edges', wrapOf(texture)], ['Filter', filterOf(texture)],
      ['Transform', placeOf(ref.transform)]])));
}

// keys: [[member of own, label], ..]
export const textureList = (app, scene, own, keys) => keys.filter(([key]) => own[key]).map(([key, label]) => textureItem(app, scene, own[key], `${label} texture`));
