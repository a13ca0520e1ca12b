// ocean_frames.js - when the sea is drawn, and how much of it at once. One step is in flight at a time: the next one waits for
// its fence, so that the GPU never has a queue, and a change is answered after one step at most.

const MOVING_MS = [30, 60]; // a frame in motion should take longer than the first, less than the second
const STEP_MS = 200; // what a step of an image at rest should take
const LEAST_PIXELS = 4096; // in such a step
const REST_MS = 250; // after a change the coarse image stays for so long
const PATIENCE_MS = 500; // what takes longer shows its progress
const LEAST_SCALE = 0.125;
const MOST_RATIO = 2; // drawn pixels per CSS pixel: more of them cannot be told apart

// read() gives { divider, isPlaying }; attempt(f) runs f and shows its error; report({ isWaiting, isCompiling, share, isSharp })
// is called after each step; share: 0 to 1, null while it is not known.
export function makeFrames({ canvas, ocean, read, attempt, report }) {
  const gl = canvas.getContext('webgl2'); // the context that the module made
  let isAsked = false;
  let isLost = false;
  let isLeft = false; // the page
  let fence = null; // of the step in flight
  let begun = 0; // that step, ms
  let answered = 0; // the change that it shows
  let isWhole = false; // that step drew a whole coarse image
  let since = performance.now(); // the image is drawn, ms
  let lastTime = 0; // of the last frame in motion, ms
  let lastChange = -REST_MS;
  let isChanged = true; // since the last whole image
  let scale = LEAST_SCALE; // of the size along an edge, in motion
  let level = LEAST_SCALE; // the same, of the image at rest
  let pixels = 10000; // in a step at rest
  let steps = 0;
  let waiters = []; // for a sharp image

  const fullSize = () => {
    const ratio = Math.min(MOST_RATIO, window.devicePixelRatio || 1);
    return [canvas.clientWidth, canvas.clientHeight].map((edge) => Math.max(1, Math.round(edge * ratio)));
  };

  function fit(by) {
    const [width, height] = fullSize().map((edge) => Math.max(1, Math.round(edge * by)));
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
  }

  // How much the machine draws in the time that a step should take.
  function adapt(ms) {
    const drawn = canvas.width * canvas.height;
    if (isWhole) {
      const [fast, slow] = MOVING_MS;
      pixels = drawn * STEP_MS / ms;
      if (ms > slow) scale = Math.max(LEAST_SCALE, scale * Math.max(0.6, Math.sqrt(45 / ms)));
      else if (ms < fast) scale = Math.min(1, scale * 1.25);
    } else pixels = Math.min(drawn, Math.max(LEAST_PIXELS, pixels) * Math.min(2, Math.max(0.5, STEP_MS / ms)));
  }

  // False: the step in flight is not finished.
  function finish() {
    if (!fence) return true;
    if (gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED) return false;
    gl.deleteSync(fence);
    fence = null;
    if (isWhole && answered === lastChange) isChanged = false;
    adapt(performance.now() - begun);
    return true;
  }

  function step(by, count, seconds) {
    fit(by);
    begun = performance.now();
    answered = lastChange;
    const isDrawn = attempt(() => ocean.draw(canvas.width, canvas.height, read().divider, seconds, count));
    if (!isDrawn || ocean.isCompiling) {
      lastTime = 0;
      return isDrawn;
    }
    steps++;
    isWhole = count === 0;
    fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    return true;
  }

  // The whole image with one sample per pixel, small enough for the machine.
  function drawCoarse(time, isPlaying) {
    const seconds = isPlaying && lastTime ? Math.min(time - lastTime, 1000) / 1000 : 0;
    lastTime = time;
    level = scale;
    return step(scale, 0, seconds);
  }

  // Some rows of the image at rest, whose size grows until it is the full one.
  function refine() {
    if (level < 1 && ocean.samples >= 1) level = Math.min(1, 2 * level);
    return step(level, Math.round(Math.max(LEAST_PIXELS, pixels)), 0);
  }

  const isFull = () => level === 1 && canvas.width === fullSize()[0] && canvas.height === fullSize()[1];

  function tell(isSharp, isPlaying) {
    const isWaiting = !isSharp && (!isPlaying || isChanged) && performance.now() - since > PATIENCE_MS;
    const share = level < 1 ? 0 : ocean.samples / ocean.wantedSamples;
    report({ isWaiting, isCompiling: ocean.isCompiling, isSharp, share: isPlaying || isChanged || ocean.isCompiling ? null : share });
    if (isSharp) settle(true);
  }

  function settle(isSharp) {
    for (const done of waiters) done(isSharp);
    waiters = [];
  }

  function frame(time) {
    isAsked = false;
    if (isLost || isLeft || document.hidden) return;
    const { isPlaying } = read();
    if (!finish()) {
      tell(false, isPlaying);
      ask();
      return;
    }
    const isMoving = isPlaying || isChanged;
    const isWaiting = !isMoving && performance.now() - lastChange < REST_MS;
    const isSharp = !isMoving && isFull() && ocean.isSharp;
    const isDrawn = isSharp || isWaiting || (isMoving ? drawCoarse(time, isPlaying) : refine());
    tell(isSharp, isPlaying);
    if (!isSharp && isDrawn) ask();
  }

  function ask() {
    if (isAsked || isLost || isLeft) return;
    isAsked = true;
    requestAnimationFrame(frame);
  }

  // A setting, the view or the size has changed: the image is drawn anew.
  function restart() {
    lastChange = since = performance.now();
    isChanged = true;
    lastTime = 0;
    ask();
  }

  document.addEventListener('visibilitychange', () => {
    lastTime = 0;
    if (!document.hidden) ask();
  });
  window.addEventListener('pagehide', () => { isLeft = true; });
  window.addEventListener('pageshow', () => {
    isLeft = false;
    ask();
  });

  return {
    fullSize,
    restart,
    // The sea moves, or rests.
    turn(isPlaying) {
      lastTime = 0;
      since = performance.now();
      if (isPlaying) settle(false);
      ask();
    },
    // The last image stays until the browser gives the context back.
    lose() {
      isLost = true;
      fence = null;
      settle(false);
    },
    restore() {
      isLost = false;
      restart();
    },
    get steps() { return steps; },
    // Whether the image at rest became sharp; false: the sea moved on before.
    sharpen: () => new Promise((resolve) => {
      waiters.push(resolve);
      ask();
    }),
  };
}
