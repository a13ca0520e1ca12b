// files.js - files and folders that are dropped on the page or picked: [{ path, file }], with paths relative to what was dropped.

export const MODEL = /\.(glb|gltf|obj|stl|ply)$/i;
const MAX_FILES = 10000; // a folder with more was hardly meant

const OTHER_MODEL = /\.(fbx|blend|dae|3ds|max|ma|mb|usd|usda|usdc|usdz|stp|step|x3d|3mf|c4d)$/i;

// A sentence, if none of the files can be shown but some are models of other kinds; else ''.
export function faultOf(files) {
  const other = files.find(({ path }) => OTHER_MODEL.test(path));
  if (!other || files.some(({ path }) => MODEL.test(path))) return '';
  return `${other.path}: facet reads glTF (.glb, .gltf), OBJ, STL and PLY. Open the file in the program that made it, or in Blender, export it as .glb, and drop that.`;
}

const fileOf = (entry) => new Promise((resolve, reject) => entry.file(resolve, reject));
const someOf = (reader) => new Promise((resolve, reject) => reader.readEntries(resolve, reject));

// A folder gives its entries by the hundred.
async function collect(entries, files) {
  for (const entry of entries) {
    if (files.length > MAX_FILES) throw new Error(`The folder has more than ${MAX_FILES} files; drop the model's own folder.`);
    if (entry.isFile) {
      files.push({ path: entry.fullPath.replace(/^\//, ''), file: await fileOf(entry) });
    } else if (entry.isDirectory) {
      const reader = entry.createReader();
      for (let some = await someOf(reader); some.length; some = await someOf(reader)) await collect(some, files);
    }
  }
  return files;
}

// Entries must be asked for before the event returns. They give files as they are on the disk then: reread() reads them again.
async function filesOfDrop(transfer) {
  const items = [...transfer.items].filter((item) => item.kind === 'file');
  const entries = items.map((item) => item.webkitGetAsEntry?.() ?? null);
  const loose = items.flatMap((item, i) => (entries[i] ? [] : [item.getAsFile()])).filter(Boolean).map((file) => ({ path: file.name, file }));
  const found = entries.filter(Boolean);
  const reread = () => collect(found, []);
  return loose.length ? { files: await collect(found, loose) } : { files: await reread(), reread };
}

export const filesOfInput = (input) => [...input.files].map((file) => ({ path: file.webkitRelativePath || file.name, file }));

const hasFiles = (event) => [...event.dataTransfer.types].includes('Files');

// Calls open({ files, reread }) after a drop anywhere on the page; cover is shown while files are dragged over it.
export function listenForDrops(cover, open, fail) {
  let depth = 0; // of the elements entered
  const show = (is) => { cover.hidden = !is; };
  window.addEventListener('dragenter', (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault();
    depth++;
    show(true);
  });
  window.addEventListener('dragover', (event) => {
    if (hasFiles(event)) event.preventDefault();
  });
  window.addEventListener('dragleave', () => {
    depth = Math.max(0, depth - 1);
    show(depth > 0);
  });
  window.addEventListener('drop', (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault();
    depth = 0;
    show(false);
    filesOfDrop(event.dataTransfer).then(open).catch(fail);
  });
}

// Inputs that stay out of sight, and the functions that open their dialogs.
export function listenForPicks(fileInput, folderInput, open) {
  for (const input of [fileInput, folderInput])
    input.addEventListener('change', () => {
      const files = filesOfInput(input);
      input.value = ''; // the same file again is a change, too
      if (files.length) open({ files });
    });
}

export function save(blob, name) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
