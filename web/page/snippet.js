// snippet.js - a view as HTML: the attributes of <facet-viewer> that say the same as options of facet render.

const ATTRIBUTES = {
  env: 'environment-image', orbit: 'camera-orbit', target: 'camera-target', fov: 'field-of-view', 'tone-mapping': 'tone-mapping',
  channel: 'facet-channel', brdf: 'facet-brdf', transparency: 'facet-transparency', variant: 'variant-name', animation: 'animation-name',
};
const escapeText = (text) => String(text).replace(/[&"<>]/g, (character) => ({ '&': '&amp;', '"': '&quot;', '<': '&lt;', '>': '&gt;' })[character]);

const isStops = (text) => text !== undefined && text.trim() !== '' && Number.isFinite(Number(text));

// Returns { html, rest }; rest: the options that no attribute says. names: { variants, animations }, for options that give an index.
export function htmlOf({ src, alt, options, names }) {
  const attributes = [['src', src], ['alt', alt], ['camera-controls', true]];
  const rest = [];
  const named = (list, text) => (Object.hasOwn(list, text) ? list[text] || text : text);
  for (const [name, text] of Object.entries(options)) {
    const value = name === 'variant' ? named(names.variants, text) : name === 'animation' ? named(names.animations, text) : text;
    if (Object.hasOwn(ATTRIBUTES, name)) attributes.push([ATTRIBUTES[name], value]);
    else if (name === 'ground') attributes.push(['shadow-intensity', '1']);
    else if (name === 'background' && value === 'env') attributes.push(['skybox-image', options.env ?? 'neutral']);
    else if (name === 'exposure' && isStops(value)) attributes.push(['exposure', String(Number((2 ** Number(value)).toPrecision(6)))]);
    else if (name !== 'background' || value !== 'transparent') rest.push(name);
  }
  const text = attributes.map(([name, value]) => `  ${name}${value === true ? '' : `="${escapeText(value)}"`}`).join('\n');
  return { html: `<script type="module" src="facet-viewer/facet-viewer.js"></script>\n<facet-viewer\n${text}></facet-viewer>`, rest };
}
