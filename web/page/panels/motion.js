// motion.js - the bar below the model: which animation runs, its time line, its speed.
import { button, choice, element, icon } from '../fields.js';

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];
const seconds = (time) => `${time.toFixed(2)} s`;

export function motionBar(app) {
  const play = button('', () => app.togglePlay(), { class: 'icon plain' });
  const line = element('input', { type: 'range', min: 0, max: 1, step: 0.001, 'aria-label': 'Time' });
  const time = element('output', { class: 'number quiet' });
  const animation = choice({ label: 'Animation', options: [], change: (which) => app.chooseAnimation(which) });
  const speed = choice({ label: 'Speed', options: SPEEDS.map((factor) => [String(factor), `${factor} ×`]), value: '1',
    change: (factor) => { app.viewer.timeScale = Number(factor); } });
  for (const field of [animation, speed]) field.root.querySelector('label').className = 'only-read';
  const root = element('div', { class: 'motion', role: 'group', 'aria-label': 'Animation', hidden: true }, play, line, time, animation.root, speed.root);
  line.addEventListener('input', () => {
    app.viewer.pause();
    app.viewer.currentTime = Number(line.value);
  });
  const showTime = ({ time: now, begin, end }) => {
    line.value = now;
    line.style.setProperty('--fill', `${end > begin ? (100 * (now - begin)) / (end - begin) : 0}%`);
    line.setAttribute('aria-valuetext', `${seconds(now)} of ${seconds(end)}`);
    time.textContent = `${seconds(now)} / ${seconds(end)}`;
  };
  // A time without an animation is the first one's.
  const valueOf = ({ animation: name, time: at }, animations) => {
    if (name === undefined) return at === undefined ? '' : '0';
    return app.indexOf(animations, name);
  };
  let wasPlaying = null;
  const showPlaying = (is) => {
    if (is === wasPlaying) return;
    wasPlaying = is;
    play.replaceChildren(icon(is ? 'pause' : 'play'));
    play.setAttribute('aria-label', is ? 'Pause' : 'Play');
  };
  return {
    root,
    update(options, now) {
      if (root.hidden) return;
      // at rest the range is that of the animation that would run
      const state = now.end > now.begin ? now : { ...now, begin: 0, end: app.viewer.duration, time: 0 };
      const isOn = state.end > state.begin;
      animation.value = valueOf(options, app.viewer.availableAnimations);
      line.disabled = !isOn;
      line.min = isOn ? state.begin : 0;
      line.max = isOn ? state.end : 1;
      line.step = isOn ? (state.end - state.begin) / 1000 : 1;
      const factor = String(state.speed ?? 1);
      if (![...speed.select.options].some(({ value }) => value === factor)) speed.options = [...SPEEDS, state.speed].sort((a, b) => a - b).map((x) => [String(x), `${x} ×`]);
      speed.value = factor;
      showPlaying(state.isPlaying);
      showTime(isOn ? state : { time: 0, begin: 0, end: 0 });
    },
    model() {
      const names = app.viewer.availableAnimations;
      root.hidden = !names.length;
      animation.options = [['', 'At rest'], ...names.map((name, i) => [String(i), name || `Animation ${i}`]), ...(names.length > 1 ? [['all', 'All at once']] : [])];
    },
  };
}
