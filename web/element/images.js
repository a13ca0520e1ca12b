// images.js - images of a view as files, at any size.
function toCanvas(image) {
  const canvas = document.createElement('canvas');
  canvas.width = image.width;
  canvas.height = image.height;
  canvas.getContext('2d').putImageData(image, 0, 0);
  return canvas;
}

const toBlob = (canvas, type, quality) => new Promise((resolve, reject) => {
  canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error(`the browser cannot write ${type || 'image/png'} of ${canvas.width} x ${canvas.height} pixels`))), type, quality);
});

export class Images {
  constructor(context) {
    this.context = context;
  }

  // Where there is no context, the last image.
  #draw(width, height) {
    const { view, tree } = this.context;
    if (view.isLost) return tree.canvas;
    if (!view.hasModel) return toCanvas(new ImageData(width, height));
    return toCanvas(view.use((module, viewer) => module.readImage(viewer, width, height)));
  }

  toDataURL(type, quality) {
    const { width, height } = this.context.view.size;
    return this.#draw(width, height).toDataURL(type, quality);
  }

  async toBlob({ mimeType, qualityArgument, idealAspect = false } = {}) {
    const { view, camera } = this.context;
    let { width, height } = view.size;
    const ideal = camera.getIdealAspect();
    if (idealAspect && ideal > 0) {
      if (ideal > width / height) height = Math.max(1, Math.round(width / ideal));
      else width = Math.max(1, Math.round(height * ideal));
    }
    return toBlob(this.#draw(width, height), mimeType, qualityArgument);
  }

  // Without a size that of the element.
  async screenshot({ width, height, type = 'image/png', quality } = {}) {
    const { size } = this.context.view;
    const w = Math.max(1, Math.round(width ?? (height ? (height * size.width) / size.height : size.width)));
    const h = Math.max(1, Math.round(height ?? (w * size.height) / size.width));
    return toBlob(this.#draw(w, h), type, quality);
  }
}
