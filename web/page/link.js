// link.js - a view as the readable hash of the page's address, which browsers never send to a server:
//     #model=bottle.glb&orbit=30deg,75deg,105%25&exposure=0.5&env=sun:45,135&material.3.roughnessFactor=0.2
//
// model     a file of the page's own server, relative to the page;  file: one that the reader of the link drops
// material  an edited value by its glTF name
// others    options of facet render, by their long names

const ALIASES = { tone: 'tone-mapping' };
const NAME = /^[a-z][a-z0-9-]*$/;
const MATERIAL = /^material\.(\d+)\.([A-Za-z][\w.]*)$/;

// Only what would end a value or that browsers rewrite is escaped.
const escapeText = (text) => String(text).replace(/[%&#+"'<>`\s]/g, (character) => encodeURIComponent(character).replace("'", '%27'));

// A lone % stands for itself, as people type it in 105%.
const unescapeText = (text) => decodeURIComponent(text.replace(/%(?![0-9a-fA-F]{2})/g, '%25'));

// edits: [[material, name, value]]
export function writeLink({ model, file, options = {}, edits = [] }) {
  const pairs = [['model', model], ['file', file], ...Object.entries(options),
    ...edits.map(([index, name, value]) => [`material.${index}.${name}`, [value].flat().join(',')])];
  return pairs.filter(([, value]) => value !== undefined && value !== null).map(([name, value]) => `${name}=${escapeText(value)}`).join('&');
}

const valueOf = (text) => {
  const parts = text.split(',').map((part) => (part === 'true' ? true : part === 'false' ? false : part.trim() !== '' && Number.isFinite(Number(part)) ? Number(part) : part));
  return parts.length === 1 ? parts[0] : parts;
};

// Returns { model, file, options, edits, faults }; faults: a sentence for each part that cannot be read.
export function readLink(hash) {
  const view = { options: {}, edits: [], faults: [] };
  for (const part of hash.replace(/^#/, '').split('&').filter(Boolean)) {
    const at = part.indexOf('=');
    try {
      if (at < 1) throw new Error('it has no value');
      readPair(view, unescapeText(part.slice(0, at)), unescapeText(part.slice(at + 1)));
    } catch (error) {
      view.faults.push(`The link's part "${part.slice(0, 60)}" cannot be read: ${error instanceof URIError ? 'its escapes are not UTF-8' : error.message}.`);
    }
  }
  return view;
}

function readPair(view, name, text) {
  const material = MATERIAL.exec(name);
  if (name === 'model' || name === 'file') view[name] = text;
  else if (material) view.edits.push([Number(material[1]), material[2], valueOf(text)]);
  else if (NAME.test(name)) view.options[Object.hasOwn(ALIASES, name) ? ALIASES[name] : name] = text;
  else throw new Error('it is not the name of an option');
}

// Models load without a question only from the page's own server, by a relative name.
export function isOwnModel(name, base) {
  if (name !== name.trim() || /^([a-z][a-z0-9+.-]*:|\/\/|\\)/i.test(name)) return false;
  return new URL(name, base).origin === new URL(base).origin;
}
