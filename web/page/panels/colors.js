// colors.js - linear factors of glTF as colors of the screen and back; the browser converts.

const probe = document.createElement('span');
probe.hidden = true;

function numbersOf(cssColor) {
  if (!probe.isConnected) document.body.append(probe);
  probe.style.color = cssColor;
  return getComputedStyle(probe).color.match(/-?[\d.]+(e-?\d+)?/gi).map(Number);
}

const linear = (rgb) => `color(srgb-linear ${rgb.slice(0, 3).map((x) => x.toFixed(6)).join(' ')})`;

// "#rrggbb"; what is brighter than the screen is clipped.
export function toScreen(rgb) {
  const css = linear(rgb);
  const codes = numbersOf(`color-mix(in srgb, ${css}, ${css})`).map((x) => Math.round(255 * Math.min(1, Math.max(0, x))));
  return `#${codes.slice(0, 3).map((code) => code.toString(16).padStart(2, '0')).join('')}`;
}

// [r, g, b] in 0 to 1
export const toLinear = (hex) => numbersOf(`color-mix(in srgb-linear, ${hex}, ${hex})`).slice(0, 3).map((x) => Number(x.toFixed(5)));
