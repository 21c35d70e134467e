// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The text of every page, for the page "Find a word": Doxygen's own search knows names and titles only.
//   node full_text.cjs <folder of the pages>    writes full_text.js there
'use strict';
const fs = require('fs'), path = require('path');
const folder = process.argv[2];
const plain = html => html.replace(/<(script|style|svg|annotation)[\s\S]*?<\/\1>/g, ' ').replace(/<span class="katex-html"[\s\S]*?<\/span><\/span>/g, ' ')
  .replace(/<[^>]*>/g, ' ').replace(/&#160;|&nbsp;|&#8203;/g, ' ').replace(/&lt;/g, '<').replace(/&gt;/g, '>').replace(/&quot;/g, '"').replace(/&#39;/g, "'")
  .replace(/&amp;/g, '&').replace(/\s+/g, ' ').trim();
const list = [];
for (const name of fs.readdirSync(folder).sort()) {
  // Lists of members repeat what stands elsewhere.
  if (!name.endsWith('.html') || /(-members|functions.*|globals.*|namespacemembers.*|dir_.*|annotated|hierarchy|classes|files|pages|modules|namespaces|find)\.html$/.test(name)) continue;
  const html = fs.readFileSync(path.join(folder, name), 'utf8');
  const title = /<div class="title">([\s\S]*?)<\/div>/.exec(html), begin = html.indexOf('<div class="contents">');
  const end = html.indexOf('<!-- contents -->');
  if (!title || begin < 0) continue;
  const text = plain(html.slice(begin, end < 0 ? html.length : end));
  if (text) list.push([name, plain(title[1]), text]);
}
fs.writeFileSync(path.join(folder, 'full_text.js'), '"use strict";\nconst thermopower_pages = ' + JSON.stringify(list).replace(/<\//g, '<\\/') + ';\n');
console.log(list.length + ' pages can be searched');
