// light.js - environment, exposure, tone mapping and shadow as options of facet render.
import { addressOf, fetchFile, nameOf } from './files.js';

const TONE_MAPPINGS = {
  auto: 'neutral', neutral: 'neutral', commerce: 'neutral', aces: 'aces', agx: 'agx', reinhard: 'reinhard', cineon: 'hable', linear: 'none', none: 'none',
};
// What facet calls an environment; all else is an address.
const NAME = /^(neutral|white|none|#[0-9a-f]{3,8}|(sun|preetham):.*)$/i;
const OWN = { 'facet-channel': 'channel', 'facet-brdf': 'brdf', 'facet-transparency': 'transparency' };

export class Light {
  #abort = null;
  #shown = null; // the environment that is set, or being fetched
  #isWanted = false;

  constructor(context) {
    this.context = context;
    context.view.setOption('background', 'transparent');
  }

  attach() {}
  detach() {}

  update(changed) {
    const { element } = this.context;
    if (changed.has('exposure')) this.#set('exposure', `${Math.max(element.exposure, 1e-6)}x`);
    if (changed.has('tone-mapping')) this.#setToneMapping(element.toneMapping);
    if (changed.has('shadow-intensity')) this.#set('ground', element.shadowIntensity > 0 ? 'shadow' : null);
    for (const [attribute, option] of Object.entries(OWN)) if (changed.has(attribute)) this.#set(option, element.attributeValue(attribute));
    if (changed.has('environment-image') || changed.has('skybox-image')) this.#updateEnvironment();
  }

  #set(option, value) {
    try {
      this.context.view.setOption(option, value);
    } catch (error) {
      console.warn(`<facet-viewer> ${error.message}`);
    }
  }

  #setToneMapping(name) {
    if (!Object.hasOwn(TONE_MAPPINGS, name)) console.warn(`<facet-viewer> tone-mapping="${name}" is unknown; neutral is used`);
    this.#set('tone-mapping', Object.hasOwn(TONE_MAPPINGS, name) ? TONE_MAPPINGS[name] : 'neutral');
  }

  // The element is near the screen, or eager.
  want() {
    if (this.#isWanted) return;
    this.#isWanted = true;
    this.#updateEnvironment();
  }

  // A skybox lights the model, too.
  async #updateEnvironment() {
    const { element, view } = this.context;
    const wanted = element.skyboxImage || element.environmentImage || 'neutral';
    if (!this.#isWanted) return;
    const background = element.skyboxImage ? 'env' : 'transparent';
    if (wanted === this.#shown) {
      view.setOption('background', background);
      return;
    }
    this.#shown = wanted;
    this.#abort?.abort();
    if (wanted === 'neutral' && !view.hasOption('env')) {
      view.setOption('background', background);
      return;
    }
    this.#abort = new AbortController();
    const { signal } = this.#abort;
    const report = this.context.loading.progress.begin('environment-update');
    try {
      if (wanted === 'legacy' || NAME.test(wanted)) view.setOption('env', wanted === 'legacy' ? 'neutral' : wanted);
      else await this.#fetch(wanted, signal, report);
      if (signal.aborted) return;
      view.setOption('background', background);
      this.context.emit('environment-change');
    } catch (error) {
      if (error.name !== 'AbortError' && !signal.aborted) this.context.fail(error, 'loadfailure');
    } finally {
      report(1);
    }
  }

  async #fetch(address, signal, report) {
    const { element, view } = this.context;
    const url = addressOf(element.mapURL(address));
    const file = await fetchFile(url.href, { withCredentials: element.withCredentials, signal, onProgress: (share) => report(0.8 * share) });
    if (!signal.aborted) await view.setOptionFile('env', { path: nameOf(url) || 'environment', file });
  }
}
