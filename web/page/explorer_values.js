// explorer_values.js - the numbers of a plot under the pointer, and as tables. Places come from `facet plot --format json`.

const short = (value) => (value === null ? 'none' : Math.abs(value) >= 1e5 || (value !== 0 && Math.abs(value) < 1e-3) ? value.toExponential(2) : String(Number(value.toPrecision(4))));

const DEGREES = 180 / Math.PI;

export const named = (panel) => panel.curves.filter(({ name, x }) => name && x.length > 1);

// Between the numbers of a curve, linearly; null outside.
export function valueAt({ x, y }, at) {
  const i = x.findIndex((next) => next >= at);
  if (i < 0 || at < x[0]) return null;
  if (i === 0 || x[i] === at) return y[i];
  if (y[i - 1] === null || y[i] === null) return null;
  return y[i - 1] + ((y[i] - y[i - 1]) * (at - x[i - 1])) / (x[i] - x[i - 1]);
}

const share = ({ scale, range: [from, to] }, value) => (scale === 'log10' ? Math.log(Math.max(value, 1e-300) / from) / Math.log(to / from) : (value - from) / (to - from));
const inverse = ({ scale, range: [from, to] }, t) => (scale === 'log10' ? from * (to / from) ** t : from + (to - from) * t);

// The panel and the x of its curves at a point of the drawing; null: there is none. px: [x, y] of the chart.
export function findAt(data, [px, py]) {
  for (const panel of data.panels) {
    const [x, y, width, height] = panel.plot ?? [0, 0, 0, 0];
    if (!named(panel).length || px < x || px > x + width || py < y || py > y + height) continue;
    if (panel.kind === 'polar') return { panel, at: Math.atan2(px - panel.center[0], panel.center[1] - py) };
    if (panel.kind === 'xy') return { panel, at: inverse(panel.x, (px - x) / width) };
  }
  return null;
}

// Lines and points of a reading, in px of the chart: [[x1, y1, x2, y2]], [{x, y, color}].
export function marksOf({ panel, at }) {
  const [left, top, width, height] = panel.plot;
  const points = [];
  if (panel.kind === 'polar') {
    const place = (radius) => [panel.center[0] + radius * Math.sin(at), panel.center[1] - radius * Math.cos(at)];
    for (const curve of named(panel)) {
      const value = valueAt(curve, at);
      if (value === null) continue;
      const [x, y] = place(panel.radius * Math.min(Math.max(share(panel.y, value), 0), 1));
      points.push({ x, y, color: curve.color });
    }
    return { lines: [[...panel.center, ...place(panel.radius)]], points };
  }
  const x = left + width * share(panel.x, at);
  for (const curve of named(panel)) {
    const value = valueAt(curve, at);
    const t = value === null ? -1 : share(panel.y, value);
    if (t >= 0 && t <= 1) points.push({ x, y: top + height * (1 - t), color: curve.color });
  }
  return { lines: [[x, top, x, top + height]], points };
}

const nameOfX = (panel) => (panel.kind === 'polar' ? 'angle of the light, degrees' : panel.x.label);

// "angle of the light 30 degrees"; the unit of a label follows its last comma.
function phraseOfX(panel, at) {
  const [, quantity, unit] = nameOfX(panel).match(/^(.*?)(?:, ([^,]*))?$/);
  return [quantity, short(shownX(panel, at)), unit].filter(Boolean).join(' ');
}
const shownX = (panel, at) => (panel.kind === 'polar' ? at * DEGREES : at);

// A sentence with the values of all curves there.
export function sentenceOf({ panel, at }) {
  const values = named(panel).map((curve) => `${curve.name}: ${short(valueAt(curve, at))}`);
  return `${phraseOfX(panel, at)} – ${values.join('; ')}`;
}

// The range of x and a step for arrow keys.
export function stepsOf(panel) {
  const [from, to] = panel.kind === 'polar' ? [-Math.PI / 2, Math.PI / 2] : panel.x.range;
  return { from, to, step: (to - from) / 180 };
}

// A table of a panel: the header, and rows at even steps of x, or of a field its largest value.
function tableOf(panel) {
  const curves = named(panel);
  if (!curves.length) {
    const { values, label } = panel.field ?? panel.surface ?? { values: [], label: '' };
    const known = values.filter((value) => value !== null);
    return known.length ? { head: ['', label], rows: [['smallest', short(Math.min(...known))], ['largest', short(Math.max(...known))]] } : null;
  }
  const { from, to } = stepsOf(panel);
  const rows = [];
  for (let i = 0; i <= 24; i++) {
    const at = from + ((to - from) * i) / 24;
    rows.push([short(shownX(panel, at)), ...curves.map((curve) => short(valueAt(curve, at)))]);
  }
  return { head: [nameOfX(panel), ...curves.map(({ name }) => name)], rows };
}

// All panels as tables of HTML.
export function fillTables(data, root) {
  const make = (tag, text) => {
    const made = document.createElement(tag);
    if (text !== undefined) made.textContent = text;
    return made;
  };
  root.replaceChildren(...data.panels.flatMap((panel) => {
    const content = tableOf(panel);
    if (!content) return [];
    const table = make('table');
    const head = make('tr');
    for (const text of content.head) {
      const cell = make(text ? 'th' : 'td', text);
      if (text) cell.scope = 'col';
      head.append(cell);
    }
    const body = content.rows.map((row) => {
      const line = make('tr');
      line.append(...row.map((text, i) => {
        const cell = make(i ? 'td' : 'th', text);
        if (!i) cell.scope = 'row';
        return cell;
      }));
      return line;
    });
    table.append(make('caption', panel.title || data.title), head, ...body);
    return [table];
  }));
}
