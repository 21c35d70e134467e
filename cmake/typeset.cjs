// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Typesets the formulas in Doxygen's pages where they stand, once, so that a browser needs no script for them and asks
// nobody for anything. A formula that KaTeX does not understand is an error, with its page.
//   node typeset.cjs <folder of the pages> <folder of katex.js, katex.min.css and fonts/>
'use strict';
const fs = require('fs'), path = require('path');
const [pages, from] = process.argv.slice(2);
const katex = require(path.resolve(from, 'katex.js'));

const style = '<link href="katex/katex.min.css" rel="stylesheet" type="text/css"/>\n';
const plain = text => text.replace(/<br ?\/?>/g, '\n').replace(/&lt;/g, '<').replace(/&gt;/g, '>').replace(/&quot;/g, '"')
  .replace(/&#39;/g, "'").replace(/&#160;|&nbsp;/g, ' ').replace(/&amp;/g, '&');
let formulas = 0, wrong = 0;
for (const name of fs.readdirSync(pages)) {
  if (!name.endsWith('.html')) continue;
  const file = path.join(pages, name), before = fs.readFileSync(file, 'utf8');
  const one = (display, text) => {
    ++formulas;
    try {
      return katex.renderToString(plain(text).trim(), {displayMode: display, output: 'htmlAndMathml', strict: 'error', throwOnError: true});
    } catch (error) {
      ++wrong;
      console.error(`${name}: ${error.message}`);
      return text;
    }
  };
  // What is code stays code.
  const after = before.split(/(<pre[\s\S]*?<\/pre>|<code>[\s\S]*?<\/code>|<script[\s\S]*?<\/script>|<div class="fragment">[\s\S]*?<\/div><!-- fragment -->)/)
    .map((part, i) => i % 2 ? part : part.replace(/\\\[([\s\S]*?)\\\]/g, (_, text) => one(true, text))
      .replace(/\\\(([\s\S]*?)\\\)/g, (_, text) => one(false, text))).join('');
  if (after !== before) fs.writeFileSync(file, after.replace('</head>', style + '</head>'));
}
const to = path.join(pages, 'katex');
fs.mkdirSync(path.join(to, 'fonts'), {recursive: true});
// Every browser of the last ten years reads woff2.
const css = fs.readFileSync(path.join(from, 'katex.min.css'), 'utf8');
fs.writeFileSync(path.join(to, 'katex.min.css'), css.replace(/,url\([^)]*\.(woff|ttf)\) format\("[a-z]*"\)/g, ''));
for (const font of fs.readdirSync(path.join(from, 'fonts')))
  if (font.endsWith('.woff2')) fs.copyFileSync(path.join(from, 'fonts', font), path.join(to, 'fonts', font));
console.log(`${formulas} formulas typeset, ${wrong} refused`);
process.exit(wrong ? 1 : 0);
