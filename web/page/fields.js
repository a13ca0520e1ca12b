// fields.js - form fields for the panels: plain inputs with their labels. Each maker returns { root, value, disabled }: the element
// to insert, and its value to read and set; setting does not call change.

let lastId = 0;

// element('p', { class: 'quiet', onclick: f }, 'text', child): properties that begin with "on" are listeners, others attributes;
// true is an empty attribute, false and null none.
export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) made.addEventListener(name.slice(2), value);
    else if (value !== false && value !== null && value !== undefined) made.setAttribute(name, value === true ? '' : value);
  }
  made.append(...children.filter((child) => child !== null && child !== undefined));
  return made;
}

// An icon of the file's <symbol>s.
export function icon(name) {
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  svg.setAttribute('viewBox', '0 0 20 20');
  svg.setAttribute('aria-hidden', 'true');
  const path = document.createElementNS('http://www.w3.org/2000/svg', 'path');
  path.setAttribute('d', ICONS[name]);
  svg.append(path);
  return svg;
}

const ICONS = {
  open: 'M3 6.5V15a1 1 0 0 0 1 1h12a1 1 0 0 0 1-1V7.5a1 1 0 0 0-1-1h-6L8 4.5H4a1 1 0 0 0-1 1Z',
  share: 'M10 12V3m0 0L6.5 6.5M10 3l3.5 3.5M4 10v6a1 1 0 0 0 1 1h10a1 1 0 0 0 1-1v-6',
  copy: 'M7 7V4a1 1 0 0 1 1-1h8a1 1 0 0 1 1 1v8a1 1 0 0 1-1 1h-3M4 7h8a1 1 0 0 1 1 1v8a1 1 0 0 1-1 1H4a1 1 0 0 1-1-1V8a1 1 0 0 1 1-1Z',
  close: 'm5 5 10 10M15 5 5 15',
  reset: 'M4 10a6 6 0 1 0 2-4.5M4 3v3.5h3.5',
  play: 'M6 4v12l10-6Z',
  pause: 'M7 4v12M13 4v12',
  whole: 'M3 7V4a1 1 0 0 1 1-1h3m6 0h3a1 1 0 0 1 1 1v3m0 6v3a1 1 0 0 1-1 1h-3m-6 0H4a1 1 0 0 1-1-1v-3M7.5 7.5h5v5h-5Z',
  reload: 'M16 10a6 6 0 1 1-2-4.5M16 3v3.5h-3.5',
  camera: 'M3 7a1 1 0 0 1 1-1h2l1.5-2h5L14 6h2a1 1 0 0 1 1 1v8a1 1 0 0 1-1 1H4a1 1 0 0 1-1-1Zm7 7a3 3 0 1 0 0-6 3 3 0 0 0 0 6Z',
};

const labelled = (label, control, kind, ...rest) => {
  const id = `field-${++lastId}`;
  control.id = id;
  return element('div', { class: `field ${kind}` }, element('label', { for: id, id: `${id}-label` }, label), control, ...rest);
};

// The number in few digits, as people write it.
export const shortNumber = (value, digits = 6) => String(Number(Number(value).toPrecision(digits)));

// A slider with a number field beside it, which takes values beyond the slider's ends unless limits says otherwise.
//     min, max, step   of the slider; step also of the number's arrow keys
//     limits           [min, max] of the number; default: those of the slider
//     value            null: infinite
//     unit             spoken after the value, "degrees"
//     symbol           of the unit, shown after the label
//     change(value)    while the slider moves, and when the number was entered
export function range({ label, min, max, step, value = min, limits = [min, max], unit = '', symbol = '', change }) {
  const slider = element('input', { type: 'range', min, max, step });
  const number = element('input', { type: 'number', min: Number.isFinite(limits[0]) && limits[0], max: Number.isFinite(limits[1]) && limits[1], step: 'any' });
  const root = labelled(label, slider, 'range', number);
  number.setAttribute('aria-label', unit ? `${label}, ${unit}` : label);
  if (symbol) root.querySelector('label').dataset.unit = symbol;
  const show = (next) => {
    if (next === null) return showInfinite();
    slider.value = next;
    slider.style.setProperty('--fill', `${(100 * (Number(slider.value) - min)) / (max - min)}%`);
    if (unit) slider.setAttribute('aria-valuetext', `${shortNumber(next)} ${unit}`);
    number.value = shortNumber(next);
    number.removeAttribute('aria-invalid');
  };
  const showInfinite = () => {
    slider.value = max;
    slider.style.setProperty('--fill', '100%');
    slider.setAttribute('aria-valuetext', 'infinite');
    number.value = '';
    number.placeholder = '∞';
    return undefined;
  };
  const enter = () => {
    const wanted = number.valueAsNumber;
    if (!(wanted >= limits[0] && wanted <= limits[1])) {
      number.setAttribute('aria-invalid', 'true');
      return;
    }
    show(wanted);
    change(wanted);
  };
  slider.addEventListener('input', () => {
    show(slider.value);
    change(Number(slider.value));
  });
  number.addEventListener('change', enter);
  number.addEventListener('keydown', (event) => {
    const direction = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (!direction) return;
    event.preventDefault();
    number.value = shortNumber(Math.min(limits[1], Math.max(limits[0], (number.valueAsNumber || 0) + direction * step)));
    enter();
  });
  show(value);
  return {
    root,
    get value() { return number.valueAsNumber; },
    set value(next) { if (document.activeElement !== number || number.valueAsNumber !== Number(next)) show(next); },
    set disabled(is) { slider.disabled = number.disabled = is; },
  };
}

// options: [[value, text], ..], or groups { label, options }.
export function choice({ label, options, value, change }) {
  const select = element('select');
  const root = labelled(label, select, 'choice');
  const fill = (list) => select.replaceChildren(...list.map(toOption));
  fill(options);
  if (value !== undefined) select.value = value;
  select.addEventListener('change', () => change(select.value));
  return {
    root,
    select,
    set options(list) { fill(list); },
    get value() { return select.value; },
    set value(next) { select.value = next; },
    set disabled(is) { select.disabled = is; },
  };
}

const toOption = (entry) => (Array.isArray(entry) ? element('option', { value: entry[0] }, entry[1])
  : element('optgroup', { label: entry.label }, ...entry.options.map(toOption)));

export function check({ label, value = false, change }) {
  const box = element('input', { type: 'checkbox' });
  const root = labelled(label, box, 'check');
  box.checked = value;
  box.addEventListener('change', () => change(box.checked));
  return {
    root,
    get value() { return box.checked; },
    set value(next) { box.checked = next; },
    set disabled(is) { box.disabled = is; },
  };
}

// A line of text; change(text) when it was entered.
export function line({ label, value = '', change = () => {}, placeholder }) {
  const input = element('input', { type: 'text', placeholder, spellcheck: 'false', autocomplete: 'off' });
  const root = labelled(label, input, 'line');
  input.value = value;
  input.addEventListener('change', () => change(input.value));
  return {
    root,
    input,
    get value() { return input.value; },
    set value(next) { if (document.activeElement !== input) input.value = next; },
    set disabled(is) { input.disabled = is; },
  };
}

// A color as #rrggbb of the screen.
export function color({ label, value = '#ffffff', change }) {
  const input = element('input', { type: 'color' });
  const root = labelled(label, input, 'color');
  input.value = value;
  input.addEventListener('input', () => change(input.value));
  return {
    root,
    get value() { return input.value; },
    set value(next) { input.value = next; },
    set disabled(is) { input.disabled = is; },
  };
}

// A section that opens and closes.
export function section(title, isOpen, ...children) {
  const count = element('span', { class: 'count' });
  const body = element('div', { class: 'section' }, ...children);
  const root = element('details', { open: isOpen }, element('summary', {}, title, count), body);
  return { root, body, set count(text) { count.textContent = text; } };
}

// Names and values; values may be elements.
export const facts = (pairs) => element('dl', { class: 'facts' },
  ...pairs.filter(([, value]) => value !== null && value !== undefined && value !== '').flatMap(([name, value]) =>
    [element('dt', {}, name), element('dd', {}, value instanceof Node ? value : String(value))]));

export const button = (text, press, attributes = {}) => element('button', { type: 'button', onclick: press, ...attributes }, text);

// ---- tabs, as in the ARIA pattern: arrow keys, Home and End go from tab to tab. tabs: [[id, name, panel element], ..] ----

// A press of the selected tab calls again(); select(id) selects it by program.
export function tabs(label, list, { selected = list[0][0], again = () => {}, change = () => {} } = {}) {
  const items = list.map(([id, name, panel]) => {
    panel.id = `tab-${id}-panel`;
    panel.setAttribute('role', 'tabpanel');
    panel.setAttribute('aria-labelledby', `tab-${id}`);
    return { id, panel, tab: element('button', { type: 'button', role: 'tab', id: `tab-${id}`, 'aria-controls': panel.id }, name) };
  });
  const root = element('div', { role: 'tablist', 'aria-label': label }, ...items.map(({ tab }) => tab));
  let current = null;
  const select = (id) => {
    current = id;
    for (const item of items) {
      const is = item.id === id;
      item.tab.setAttribute('aria-selected', String(is));
      item.tab.tabIndex = is ? 0 : -1;
      item.panel.hidden = !is;
    }
    change(id);
  };
  items.forEach(({ id, tab }, i) => {
    tab.addEventListener('click', () => (id === current ? again() : select(id)));
    tab.addEventListener('keydown', (event) => {
      const next = { ArrowLeft: i - 1, ArrowRight: i + 1, Home: 0, End: items.length - 1 }[event.key];
      if (next === undefined) return;
      event.preventDefault();
      const item = items[(next + items.length) % items.length];
      select(item.id);
      item.tab.focus();
    });
  });
  select(selected);
  return { root, select, get current() { return current; } };
}
