// loading.js - when a model is fetched, how far it is, and what is seen until then: poster, progress bar, visibility.
import { fetchModel } from './files.js';

// The progress of several activities as one number that never goes back.
class Progress {
  #activities = new Set();
  #total = 0;

  constructor(onChange) {
    this.onChange = onChange;
  }

  begin(reason) {
    const activity = { share: 0 };
    if (!this.#activities.size) this.#total = 0;
    this.#activities.add(activity);
    const set = (share) => {
      activity.share = Math.max(activity.share, Math.min(1, share));
      const all = [...this.#activities];
      const sum = all.reduce((total, { share: part }) => total + part, 0) / all.length;
      if (all.every(({ share: part }) => part === 1)) {
        this.#activities.clear();
        this.#total = 1;
      } else {
        this.#total = Math.max(this.#total, Math.min(sum, 0.99));
      }
      this.onChange(this.#total, reason);
    };
    set(0);
    return set;
  }
}

export class Loading {
  #intersection;
  #abort = null;
  #isNear = false;
  #isDismissed = false; // by a call, before the model was there
  #wasVisible = false;
  #wanted = null; // the address that is shown or being fetched
  #isReplaced = false; // by files, or it failed: setting the same address again fetches it
  #turn = 0; // of the models that were asked for; the last one is shown
  isLoaded = false;
  isRevealed = false;

  constructor(context) {
    this.context = context;
    this.progress = new Progress((share, reason) => this.#showProgress(share, reason));
    this.#intersection = new IntersectionObserver((entries) => this.#see(entries[entries.length - 1]), { threshold: 0.00001 });
    context.tree.poster.addEventListener('click', () => {
      if (context.element.reveal === 'auto') this.dismissPoster();
    });
  }

  attach() {
    this.#intersection.observe(this.context.element);
    document.addEventListener('visibilitychange', this.#updateDrawing);
  }

  detach() {
    this.#intersection.disconnect();
    document.removeEventListener('visibilitychange', this.#updateDrawing);
    this.#isNear = false;
    this.#updateDrawing();
  }

  drop() {
    this.#abort?.abort();
    this.#turn++;
    this.#wanted = null;
    this.isLoaded = false;
  }

  #see(entry) {
    this.#isNear = entry.isIntersecting;
    this.#updateDrawing();
    this.#consider();
  }

  #updateDrawing = () => {
    this.context.view.isVisible = this.#isNear && document.visibilityState === 'visible';
    this.context.view.isRevealed = this.isRevealed;
    this.context.view.touch();
    this.#announce();
  };

  get isVisible() { return this.isLoaded && this.#isNear && this.isRevealed; }

  #announce() {
    const isVisible = this.isVisible;
    if (isVisible === this.#wasVisible) return;
    this.#wasVisible = isVisible;
    this.context.emit('model-visibility', { visible: isVisible });
  }

  update(changed) {
    const { element, tree } = this.context;
    if (changed.has('poster')) {
      tree.posterImage.hidden = !element.poster;
      if (element.poster) tree.posterImage.src = element.poster;
      else tree.posterImage.removeAttribute('src');
    }
    if (changed.has('alt')) tree.posterImage.alt = element.alt ?? '';
    if (changed.has('src') && !element.src && this.#wanted) {
      this.drop();
      this.context.view.close();
      this.showPoster();
    }
    if (changed.has('src') && this.#isReplaced) this.#wanted = null;
    if (changed.has('src') || changed.has('loading') || changed.has('reveal')) this.#consider();
  }

  // Whether models and light are to be fetched now.
  get isWanted() {
    const { element } = this.context;
    return this.#isDismissed || element.loading === 'eager' || this.isLoaded || (element.reveal === 'auto' && this.#isNear);
  }

  #consider() {
    const { element } = this.context;
    if (!this.isWanted || !element.isConnected) return;
    this.context.want();
    if (!element.src || this.#wanted === element.src) return;
    this.#wanted = element.src;
    this.#fetch(element.src);
  }

  async #fetch(src) {
    const { element } = this.context;
    this.#abort?.abort();
    const abort = new AbortController();
    this.#abort = abort;
    this.#isReplaced = false;
    const turn = ++this.#turn;
    const report = this.progress.begin('model-load');
    this.isLoaded = false;
    try {
      const files = await fetchModel(src, {
        mapURL: (url) => element.mapURL(url), withCredentials: element.withCredentials, signal: abort.signal, onProgress: (share) => report(0.8 * share),
      });
      if (abort.signal.aborted) return;
      await this.show(files, files[0].path, src, turn);
      report(1);
    } catch (error) {
      report(1);
      if (error.name === 'AbortError' || abort.signal.aborted) return;
      this.#isReplaced = true;
      this.isLoaded = this.context.view.hasModel; // the last one is still shown
      this.context.fail(error, 'loadfailure');
    }
  }

  // Shows a model of files that are there, unless another one was asked for since. url: for the event. turn: see take().
  async show(files, path, url, turn) {
    const { context } = this;
    try {
      await context.view.open(files, path, () => turn === this.#turn);
    } catch (error) {
      if (turn === this.#turn) this.isLoaded = context.view.hasModel;
      throw error;
    }
    await context.modelOpened();
    this.isLoaded = true;
    if (this.context.element.reveal === 'auto' || this.#isDismissed) this.#reveal();
    this.#updateDrawing();
    context.emit('load', { url });
  }

  // A model that did not come from src. Returns its turn.
  take() {
    this.#abort?.abort();
    this.#wanted = this.context.element.src;
    this.#isReplaced = true;
    this.#isDismissed = true;
    return ++this.#turn;
  }

  // ---- the poster ----

  dismissPoster() {
    this.#isDismissed = true;
    if (this.isLoaded) this.#reveal();
    else this.#consider();
  }

  showPoster() {
    const { tree } = this.context;
    if (tree.poster.classList.contains('shown')) return;
    tree.poster.classList.add('shown');
    tree.input.classList.remove('shown');
    this.isRevealed = false;
    this.#updateDrawing();
  }

  #reveal() {
    const { tree, element, emit } = this.context;
    this.#isDismissed = false;
    if (this.isRevealed) return;
    this.isRevealed = true;
    const hadFocus = element.getRootNode().activeElement === element;
    tree.poster.classList.remove('shown');
    tree.input.classList.add('shown');
    this.#updateDrawing();
    if (hadFocus) tree.input.focus();
    emit('poster-dismissed');
  }

  #showProgress(share, reason) {
    const { bar } = this.context.tree;
    bar.style.transform = `scaleX(${share})`;
    bar.classList.toggle('done', share === 1);
    this.context.emit('progress', { totalProgress: share, reason });
  }
}
