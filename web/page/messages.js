// messages.js - sentences about what went wrong, above the stage: they stay until they are closed, and can be copied.
import { button, element, icon } from './fields.js';

const MAX_SHOWN = 5;

export function createMessages(root) {
  const shown = new Map(); // text -> element

  const close = (text) => {
    shown.get(text)?.remove();
    shown.delete(text);
  };

  const show = (text, kind) => {
    close(text);
    if (shown.size >= MAX_SHOWN) close(shown.keys().next().value);
    const copy = button('', () => copyText(text), { class: 'plain icon', 'aria-label': 'Copy this message', title: 'Copy' });
    const end = button('', () => close(text), { class: 'plain icon', 'aria-label': 'Close this message', title: 'Close' });
    copy.append(icon('copy'));
    end.append(icon('close'));
    const made = element('div', { class: `message ${kind}`, role: kind === 'error' ? 'alert' : 'status' }, element('p', {}, text), copy, end);
    shown.set(text, made);
    root.append(made);
  };

  return {
    error: (what) => show(sentenceOf(what), 'error'),
    note: (text) => show(text, 'note'),
    close,
  };
}

// What an exception says, never "[object Event]".
export function sentenceOf(what) {
  const text = typeof what === 'string' ? what : what?.message ?? what?.detail?.sourceError?.message ?? what?.detail?.text;
  return text ? String(text) : 'Something failed, and the browser gives no reason.';
}

// Without the clipboard of secure pages, the old command of the browser.
export async function copyText(text) {
  if (navigator.clipboard) {
    await navigator.clipboard.writeText(text);
    return;
  }
  const area = element('textarea', { class: 'only-read' });
  area.value = text;
  document.body.append(area);
  area.select();
  document.execCommand('copy');
  area.remove();
}

// A button that says for a moment that it has copied.
export function copyButton(label, textOf, messages) {
  const made = button(label, async () => {
    try {
      await copyText(await textOf());
      made.textContent = 'Copied';
      setTimeout(() => { made.textContent = label; }, 1500);
    } catch (error) {
      messages.error(`The browser did not copy the text: ${sentenceOf(error)}`);
    }
  });
  return made;
}
