// ocean_module.js - ocean.wasm with strings, JSON and errors of JavaScript. What is drawn and how options are read is C
// (ocean.c, ocean_settings.c).
import createOcean from './facet-viewer/ocean.js';

// Draws into the canvas. Throws an Error with the sentence of C where something fails.
export async function loadOcean(canvas) {
  const ocean = await createOcean();
  ocean.specialHTMLTargets['!sea'] = canvas;

  const withText = (text, use) => {
    if (text === null) return use(0);
    const size = 4 * text.length + 1;
    const at = ocean._malloc(size);
    ocean.stringToUTF8(text, at, size);
    try {
      return use(at);
    } finally {
      ocean._free(at);
    }
  };
  const check = (failed) => {
    if (failed) throw new Error(ocean.UTF8ToString(ocean._facet_ocean_error()));
  };
  const take = (at) => {
    check(!at);
    const text = ocean.UTF8ToString(at);
    ocean._facet_ocean_free(at);
    return text;
  };
  check(withText('!sea', (name) => ocean._facet_ocean_start(name)));

  return {
    setOption: (name, text) => check(withText(name, (at) => withText(text, (value) => ocean._facet_ocean_set_option(at, value)))),
    reset: () => check(ocean._facet_ocean_reset()),
    get options() { return JSON.parse(take(ocean._facet_ocean_get_options())); },
    get help() { return JSON.parse(take(ocean._facet_ocean_get_help())); },
    get values() { return JSON.parse(take(ocean._facet_ocean_get_values())); },
    get state() { return JSON.parse(take(ocean._facet_ocean_state())); },
    command: (width, height) => take(ocean._facet_ocean_command(width, height)),
    takeWarning: () => ocean.UTF8ToString(ocean._facet_ocean_message()),
    // pixels: about how many; 0: one sample of all.
    draw: (width, height, divider, seconds, pixels) => check(ocean._facet_ocean_draw(width, height, divider, seconds, pixels)),
    get isCompiling() { return ocean._facet_ocean_is_compiling() !== 0; },
    get samples() { return ocean._facet_ocean_samples(); },
    get wantedSamples() { return ocean._facet_ocean_wanted_samples(); },
    get isSharp() { return ocean._facet_ocean_is_sharp() !== 0; },
    look: (azimuth, elevation) => check(ocean._facet_ocean_look(azimuth, elevation)),
    turn: (dx, dy, height) => check(ocean._facet_ocean_turn(dx, dy, height)),
    zoom: (steps) => check(ocean._facet_ocean_zoom(steps)),
    rise: (height) => check(ocean._facet_ocean_rise(height)),
    lose: () => ocean._facet_ocean_lose(),
    restore: () => check(ocean._facet_ocean_restore()),
    get memory() { return ocean.HEAPU8.length; },
  };
}
