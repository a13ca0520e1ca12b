// share.js - taking the view elsewhere: link, command, HTML, image, edited model.
import { button, choice, element, line, section } from '../fields.js';
import { copyButton } from '../messages.js';

const SIZES = [['', 'As on the screen'], ['1024x768', '1024 × 768'], ['1920x1080', '1920 × 1080'], ['2048x2048', '2048 × 2048'], ['3840x2160', '3840 × 2160'], ['other', 'Other…']];
const MAX_EDGE = 16384;

const area = (label) => element('textarea', { readonly: true, rows: 4, 'aria-label': label, spellcheck: 'false' });

export function sharePanel(app) {
  const size = choice({ label: 'Size', options: SIZES, change: () => { other.root.hidden = size.value !== 'other'; refresh(); } });
  const other = line({ label: 'Pixels', value: '1600x900', change: () => refresh() });
  other.root.hidden = true;
  const wanted = () => {
    if (!size.value) return app.size();
    const match = /^\s*(\d+)\s*[x×*, ]\s*(\d+)\s*$/.exec(size.value === 'other' ? other.value : size.value);
    const [width, height] = match ? [Number(match[1]), Number(match[2])] : [0, 0];
    if (!(width >= 1 && height >= 1 && width <= MAX_EDGE && height <= MAX_EDGE)) throw new Error(`The size "${other.value}" is not two numbers from 1 to ${MAX_EDGE}, as in 1600x900.`);
    return { width, height };
  };
  const linkText = area('Link to this view');
  const command = area('facet command of this view');
  const html = area('HTML of this view');
  const hint = element('p', { class: 'hint' });
  const commandHint = element('p', { class: 'hint' });
  const htmlHint = element('p', { class: 'hint' });
  const save = button('Save PNG', () => app.attempt(() => app.saveImage(wanted())), { class: 'primary' });
  const copyLink = copyButton('Copy link', () => app.shareLink(), app.messages);
  const saveModel = button('Save .glb', () => app.saveModel());
  const root = element('div', {},
    section('Image', true, size.root, other.root, element('div', { class: 'buttons' }, save)).root,
    section('Link', true, linkText, hint, element('div', { class: 'buttons' }, copyLink)).root,
    section('Command', true, command, commandHint,
      element('div', { class: 'buttons' }, copyButton('Copy facet command', () => command.value, app.messages))).root,
    section('HTML', true, html, htmlHint, element('div', { class: 'buttons' }, copyButton('Copy HTML', () => html.value, app.messages))).root,
    section('Model', true, element('p', { class: 'hint' }, 'With the materials as they are edited here.'), element('div', { class: 'buttons' }, saveModel)).root);

  function refresh() {
    if (root.closest('[hidden]')) return;
    let pixels;
    try {
      pixels = wanted();
      other.input.removeAttribute('aria-invalid');
    } catch {
      other.input.setAttribute('aria-invalid', 'true');
      return;
    }
    linkText.value = app.linkOfView();
    const texts = [[command, commandHint, app.commandOfView(pixels)], [html, htmlHint, app.htmlOfView()]];
    for (const [field, below, { text, hint: about }] of texts) {
      field.value = text;
      below.textContent = about;
      below.hidden = !about;
    }
    hint.textContent = app.hintOfLink();
  }
  return { root, refresh, update: refresh, model: refresh };
}
