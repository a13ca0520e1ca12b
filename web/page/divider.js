// divider.js - the handle over the border between two sides of the image, for pointer and arrow keys; it sets the option "divider".

import { element } from './fields.js';

const STEP = 0.02;

export function connectDivider(handle, app) {
  let position = 0.5;
  const sides = ['left', 'right'].map((side) => [side, element('p', { class: `side ${side}`, hidden: true })]);
  handle.before(...sides.map(([, label]) => label));
  const move = (next) => {
    position = Math.min(1, Math.max(0, next));
    show();
    app.set('divider', String(Number(position.toFixed(4))));
  };
  const show = () => {
    const percent = Math.round(100 * position);
    handle.style.setProperty('--at', `${100 * position}%`);
    handle.setAttribute('aria-valuenow', percent);
    handle.setAttribute('aria-valuetext', `${percent} %`);
  };
  handle.addEventListener('pointerdown', (event) => {
    handle.setPointerCapture(event.pointerId);
    event.preventDefault();
    handle.focus();
  });
  handle.addEventListener('pointermove', (event) => {
    if (!handle.hasPointerCapture(event.pointerId)) return;
    const { left, width } = handle.parentElement.getBoundingClientRect();
    move((event.clientX - left) / width);
  });
  handle.addEventListener('keydown', (event) => {
    const next = { ArrowLeft: position - STEP, ArrowDown: position - STEP, ArrowRight: position + STEP, ArrowUp: position + STEP, Home: 0, End: 1 }[event.key];
    if (next === undefined) return;
    event.preventDefault();
    move(next);
  });
  return {
    update(options, { comparison }) {
      handle.hidden = !options.compare;
      for (const [side, label] of sides) {
        label.textContent = comparison?.[side] ?? '';
        label.hidden = handle.hidden || !label.textContent;
      }
      position = Number(options.divider ?? 0.5);
      show();
    },
  };
}
