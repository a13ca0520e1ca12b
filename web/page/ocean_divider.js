// ocean_divider.js - the border between two images: dragged by the pointer, or moved by the keyboard as a slider.

// move(share) is called with the new share of the width, 0 to 1. Returns { value, hidden }.
export function makeDivider(root, stage, move) {
  let share = 0.5;
  const show = () => {
    root.style.setProperty('--divider', `${100 * share}%`);
    root.setAttribute('aria-valuenow', String(Math.round(100 * share)));
    root.setAttribute('aria-valuetext', `${Math.round(100 * share)} % before`);
  };
  const put = (next) => {
    share = Math.min(1, Math.max(0, next));
    show();
    move(share);
  };
  root.addEventListener('pointerdown', (event) => {
    root.setPointerCapture(event.pointerId);
    event.preventDefault();
    root.focus();
  });
  root.addEventListener('pointermove', (event) => {
    if (!root.hasPointerCapture(event.pointerId)) return;
    const box = stage.getBoundingClientRect();
    put((event.clientX - box.left) / box.width);
  });
  root.addEventListener('keydown', (event) => {
    const step = event.shiftKey ? 0.1 : 0.01;
    const next = { ArrowLeft: share - step, ArrowDown: share - step, ArrowRight: share + step, ArrowUp: share + step, PageDown: share - 0.1, PageUp: share + 0.1, Home: 0, End: 1 }[event.key];
    if (next === undefined) return;
    event.preventDefault();
    put(next);
  });
  show();
  return {
    get value() { return share; },
    set value(next) { share = Math.min(1, Math.max(0, next)); show(); },
    set hidden(is) { root.hidden = is; },
  };
}
