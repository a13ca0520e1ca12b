// fidelity_images.mjs - what fidelity.mjs does with images, in a page of the browser: they come as URLs of PNG and leave as URLs.

async function load(url) {
    const image = new Image();
    image.src = url;
    await image.decode();
    return image;
}

function canvas_of(width, height) {
    const canvas = document.createElement('canvas');
    Object.assign(canvas, { width, height });
    return canvas;
}

async function pixels_of(url) {
    const image = await load(url), context = canvas_of(image.width, image.height).getContext('2d', { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, image.width, image.height);
}

// Half the size: every pixel is the mean code of 2 x 2.
window.reduce = async (url) => {
    const { data, width, height } = await pixels_of(url), canvas = canvas_of(width >> 1, height >> 1);
    const small = new ImageData(canvas.width, canvas.height), row = 4 * width;
    for (let y = 0; y < small.height; y++)
        for (let x = 0; x < small.width; x++)
            for (let k = 0; k < 4; k++) {
                const at = 2 * y * row + 8 * x + k;
                small.data[4 * (y * small.width + x) + k] = Math.round((data[at] + data[at + 4] + data[at + row] + data[at + row + 4]) / 4);
            }
    canvas.getContext('2d').putImageData(small, 0, 0);
    return canvas.toDataURL('image/png');
};

// The mean difference of the largest channel, in codes of 8 bits, over all pixels on which one of the two images is not white.
window.mean_difference = async (a, b) => {
    const [x, y] = [(await pixels_of(a)).data, (await pixels_of(b)).data];
    const is_white = (data, i) => Math.min(data[i], data[i + 1], data[i + 2]) > 252;
    let sum = 0, count = 0;
    for (let i = 0; i < x.length; i += 4) {
        if (is_white(x, i) && is_white(y, i)) continue;
        sum += Math.max(...[0, 1, 2].map((k) => Math.abs(x[i + k] - y[i + k])));
        count++;
    }
    return count ? sum / count : 0;
};

// A JPEG with a row of images for each { title, urls }, below the titles of the columns. A URL of null leaves its place empty.
window.sheet = async (columns, rows, width) => {
    const head = 22, foot = 18, height = width + foot, canvas = canvas_of(columns.length * width, head + rows.length * height);
    const context = canvas.getContext('2d');
    Object.assign(context, { fillStyle: 'white', imageSmoothingQuality: 'high' });
    context.fillRect(0, 0, canvas.width, canvas.height);
    Object.assign(context, { fillStyle: 'black', font: '13px sans-serif' });
    columns.forEach((title, x) => context.fillText(title, x * width + 6, 15));
    for (const [y, { title, urls }] of rows.entries()) {
        for (const [x, url] of urls.entries())
            if (url) context.drawImage(await load(url), x * width, head + y * height, width, width);
        context.fillText(title, 6, head + y * height + width + 12);
    }
    return canvas.toDataURL('image/jpeg', 0.87);
};

window.ready = true;
