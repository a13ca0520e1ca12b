// carried.js - bytes that a page carries inside: gzip as base64, in script elements that no browser runs.
const STEP = 4 * 65536; // characters decoded at once

export async function unpack(text) {
  const parts = [];
  for (let at = 0; at < text.length; at += STEP) parts.push(Uint8Array.from(atob(text.slice(at, at + STEP)), (letter) => letter.charCodeAt(0)));
  return new Response(new Blob(parts).stream().pipeThrough(new DecompressionStream('gzip'))).blob();
}
