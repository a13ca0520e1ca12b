// tree.js - a tree in the ARIA pattern: up and down go through the items, right and left open and close, Home and End, letters jump
// to names, Enter and Space select. It is a flat list with levels; items are made when their parent opens, so that large scenes stay
// quick.
import { element } from '../fields.js';

// items: [{ name, kind, children: () => items, isOpen }]; children absent: a leaf. select(item) is called for the chosen one.
export function createTree(label, select) {
  const root = element('ul', { class: 'tree', role: 'tree', 'aria-label': label });
  const itemOf = new WeakMap();
  const levelOf = (node) => Number(node.getAttribute('aria-level'));
  const isOpen = (node) => node.getAttribute('aria-expanded') === 'true';
  let chosen = null;

  function make(item, level, position, count) {
    const node = element('li', { role: 'treeitem', tabindex: -1, 'aria-selected': 'false', 'aria-level': level, 'aria-posinset': position, 'aria-setsize': count,
      'aria-expanded': item.children ? 'false' : null },
    element('span', { class: 'twig', 'aria-hidden': 'true' }), element('span', { class: 'name' }, item.name), element('span', { class: 'only-read' }, ', '),
    element('span', { class: 'kind' }, item.kind));
    node.style.setProperty('--level', level - 1);
    itemOf.set(node, item);
    return node;
  }

  const makeAll = (items, level) => items.flatMap((item, i) => {
    const node = make(item, level, i + 1, items.length);
    if (!item.children || !item.isOpen) return [node];
    node.setAttribute('aria-expanded', 'true');
    return [node, ...makeAll(item.children(), level + 1)];
  });

  function expand(node, is) {
    if (!node.hasAttribute('aria-expanded') || isOpen(node) === is) return;
    const item = itemOf.get(node);
    item.isOpen = is;
    node.setAttribute('aria-expanded', String(is));
    if (is) node.after(...makeAll(item.children(), levelOf(node) + 1));
    else while (node.nextElementSibling && levelOf(node.nextElementSibling) > levelOf(node)) node.nextElementSibling.remove();
  }

  function parentOf(node) {
    let before = node;
    while (before && levelOf(before) >= levelOf(node)) before = before.previousElementSibling;
    return before;
  }

  function focusOn(node) {
    root.querySelector('[tabindex="0"]')?.setAttribute('tabindex', '-1');
    node.tabIndex = 0;
    node.focus();
  }

  function choose(node) {
    chosen?.setAttribute('aria-selected', 'false');
    chosen = node;
    node.setAttribute('aria-selected', 'true');
    select(itemOf.get(node));
  }

  function open(node) {
    if (isOpen(node)) return node.nextElementSibling;
    expand(node, true);
    return node;
  }

  function close(node) {
    if (!isOpen(node)) return parentOf(node);
    expand(node, false);
    return node;
  }

  function jump(node, letter) {
    const list = [...root.children];
    const at = list.indexOf(node);
    return [...list.slice(at + 1), ...list.slice(0, at)].find((other) => itemOf.get(other).name.toLowerCase().startsWith(letter.toLowerCase()));
  }

  const KEYS = {
    ArrowDown: (node) => node.nextElementSibling,
    ArrowUp: (node) => node.previousElementSibling,
    ArrowRight: open,
    ArrowLeft: close,
    Home: () => root.firstElementChild,
    End: () => root.lastElementChild,
  };
  root.addEventListener('keydown', (event) => {
    const node = event.target.closest('[role=treeitem]');
    if (!node || event.ctrlKey || event.metaKey || event.altKey) return;
    const isChoice = event.key === 'Enter' || event.key === ' ';
    if (!isChoice && !KEYS[event.key] && event.key.length > 1) return;
    event.preventDefault();
    event.stopPropagation();
    if (isChoice) {
      choose(node);
      return;
    }
    const next = KEYS[event.key] ? KEYS[event.key](node) : jump(node, event.key);
    if (next) focusOn(next);
  });

  root.addEventListener('click', (event) => {
    const node = event.target.closest('[role=treeitem]');
    if (!node) return;
    focusOn(node);
    if (event.target.closest('.twig')) expand(node, !isOpen(node));
    else choose(node);
  });
  root.addEventListener('dblclick', (event) => {
    const node = event.target.closest('[role=treeitem]');
    if (node && !event.target.closest('.twig')) expand(node, !isOpen(node));
  });

  return {
    root,
    fill(items) {
      chosen = null;
      root.replaceChildren(...makeAll(items, 1));
      root.firstElementChild?.setAttribute('tabindex', '0');
    },
  };
}
