// snippet.js - a view as HTML: the attributes of <facet-viewer> that say the same as options of facet render.

const ATTRIBUTES = {
  env: 'environment-image', orbit: 'camera-orbit', target: 'camera-target', fov: 'field-of-view', 'tone-mapping': 'tone-mapping',
  channel: 'facet-channel', brdf: 'facet-brdf', transparency: 'facet-transparency', variant: 'variant-name', animation: 'animation-name',
};
const escapeText = (text) => String(text).replace(/[&"<>]/g, (character) => ({ '&': '&amp;', '"': '&quot;', '<': '&lt;', '>': '&gt;' })[character]);

// options that no attribute says are in the comment's list.
export function htmlOf({ src, alt, options, exposure }) {
  const attributes = [['src', src], ['alt', alt], ['camera-controls', true]];
  const rest = [];
  for (const [name, value] of Object.entries(options)) {
    if (name in ATTRIBUTES) attributes.push([ATTRIBUTES[name], value]);
    else if (name === 'ground') attributes.push(['shadow-intensity', '1']);
    else if (name === 'background' && value === 'env') attributes.push(['skybox-image', options.env ?? 'neutral']);
    else if (name !== 'exposure' && name !== 'background') rest.push(name);
  }
  if (exposure !== undefined && exposure !== 1) attributes.push(['exposure', exposure]);
  const text = attributes.map(([name, value]) => `  ${name}${value === true ? '' : `="${escapeText(value)}"`}`).join('\n');
  return { html: `<script type="module" src="facet-viewer/facet-viewer.js"></script>\n<facet-viewer\n${text}></facet-viewer>`, rest };
}
