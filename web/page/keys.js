// keys.js - keys of the whole page, by the letters of facet view's window, and their list in the help.

const isTyping = (target) => target.closest?.('input, select, textarea, [contenteditable], [role=tree], dialog');

// actions: [[keys, what it does, run(key)], ..]; keys: 'T Shift+T'
export function connectKeys(actions, list) {
  const table = new Map(actions.flatMap(([keys, , run]) => keys.split(' ').map((key) => [key, run])));
  list.replaceChildren(...actions.flatMap(([keys, text]) => {
    const term = document.createElement('dt');
    keys.split(' ').forEach((key, i) => term.append(i ? ', ' : '', kbd(key)));
    const said = document.createElement('dd');
    said.textContent = text;
    return [term, said];
  }));
  document.addEventListener('keydown', (event) => {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey || isTyping(event.target)) return;
    const isButton = event.target.closest?.('button, a, summary, [role=slider]');
    if (isButton && (event.key === ' ' || event.key === 'Home')) return; // theirs
    const name = event.key === ' ' ? 'Space' : event.key.length === 1 ? event.key.toUpperCase() : event.key;
    const run = table.get(event.shiftKey && /^[A-Z]$/.test(name) ? `Shift+${name}` : name);
    if (!run) return;
    event.preventDefault();
    run(event.shiftKey ? -1 : 1);
  });
}

function kbd(key) {
  const made = document.createElement('kbd');
  made.textContent = key;
  return made;
}
