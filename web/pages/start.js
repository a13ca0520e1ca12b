// disk.js - of a page beside its files that is opened from the disk, where browsers load no modules: says so.
if (location.protocol === 'file:') {
  const note = document.getElementById('note');
  note.textContent = 'This is a preview: the folder is for a web server. facet view --html page.html makes a file that opens from the disk.';
  note.hidden = false;
}
