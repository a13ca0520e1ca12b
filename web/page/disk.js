// disk.js - a classic script: pages that are opened from the disk say why they stay empty, because browsers load no modules from there.
if (location.protocol === 'file:') {
  const note = document.createElement('p');
  note.className = 'unavailable';
  note.setAttribute('role', 'alert');
  note.textContent = 'This page needs a web server: browsers load no modules from the disk. "./run web" in facet\u2019s folder starts one. "facet view model.glb --html page.html" makes a page that opens from the disk.';
  document.querySelector('main').append(note);
}
