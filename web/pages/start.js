// start.js - of a page beside its files: shows the model, or, where the page is opened from the disk and browsers load no modules, says so below
// the preview.
if (location.protocol === 'file:') {
  const note = document.getElementById('note');
  note.textContent = 'This is a preview: the folder is for a web server. facet view --html page.html makes a file that opens from the disk.';
  note.hidden = false;
  document.body.classList.add('still');
} else {
  import('./beside.js');
}
