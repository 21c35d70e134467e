// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Finds words in the text of every page (full_text.js). Pages that people wrote come before those of the code.
(() => {
'use strict';
const field = document.getElementById('find-word'), count = document.getElementById('find-count'), list = document.getElementById('find-list');
if (!field) return;
if (typeof thermopower_pages === 'undefined') {
  count.textContent = 'This copy of the documentation was built without its text (it needs nodejs).';
  return;
}
const most = 60;
const of_code = name => /^(class|struct|namespace|group__)|_8hpp|_8h\.html/.test(name);
const show = () => {
  const words = field.value.toLowerCase().split(/\s+/).filter(w => w);
  list.replaceChildren();
  count.textContent = '';
  if (!words.length) return;
  const found = [];
  for (const [name, title, text] of thermopower_pages) {
    const low = text.toLowerCase(), head = title.toLowerCase();
    if (!words.every(w => low.includes(w) || head.includes(w))) continue;
    const times = low.split(words[0]).length - 1;
    found.push([(words.every(w => head.includes(w)) ? 1000 : 0) + (of_code(name) ? 0 : 300) + Math.min(times, 200), name, title, text, low.indexOf(words[0])]);
  }
  found.sort((a, b) => b[0] - a[0] || (a[1] < b[1] ? -1 : 1));
  count.textContent = found.length === 1 ? '1 page' : found.length + ' pages' + (found.length > most ? ', the first ' + most + ' of them:' : '');
  for (const [, name, title, text, at] of found.slice(0, most)) {
    const item = document.createElement('li'), link = document.createElement('a'), small = document.createElement('small');
    link.href = name;
    link.textContent = title;
    const from = Math.max(0, at - 70), mark = document.createElement('mark');
    mark.textContent = text.slice(at, at + words[0].length);
    if (at >= 0) small.append((from > 0 ? '\u2026' : '') + text.slice(from, at), mark, text.slice(at + words[0].length, at + 130) + '\u2026');
    item.append(link, small);
    list.append(item);
  }
};
field.value = decodeURIComponent(location.hash.slice(1));
field.addEventListener('input', show);
show();
if (!field.value) count.textContent = thermopower_pages.length + ' pages, every word of them.';
field.focus();
})();
